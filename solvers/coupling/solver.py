"""Finite elements lead, particles follow: periods of one structural step, motion there and forces back.

In a period T the structure takes a step under the forces of contact, constant in it. Its wetted nodes move from where
they were to where they are at constant velocity; the particles take as many steps of their own as they need,
and the impulse of their contact over T is the force of the next period, or, iterated, of the same one. Impulses are
handed over whole: what has been received and not yet handed on is `pending`.

Sources: [T] ch. 5; strong coupling with Aitken's relaxation (Kuettler & Wall 2008).
"""

from __future__ import annotations

import logging
import math
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import fem, sph
from ..frame import Cells, Frame
from .pressure import pressure

Floats = NDArray[np.float64]
log = logging.getLogger("zrno")
NOTED = 10  # periods between looks at the energies
SLICE = 1_000_000  # particle steps at a time: all that a period takes
SMALL = 1e-3  # of the largest force so far: changes of less are not iterated on
LEAST_RELAXATION, FIRST_RELAXATION = 0.05, 0.5


@dataclass(frozen=True, slots=True)
class Exchange:
    """What is exchanged, and how.

    nodes: (m,) indices of the wetted nodes, in the order of the driven particles; tolerance: of the force in a period,
    relative, where it is iterated (strong coupling), 0 for once (weak); most: iterations; relaxation: share of what is
    received that the next period gets, the rest comes later (weak coupling with a structure without inertia, which
    otherwise jumps from under the grain); original: hand back what the original programs do, accelerations at the end
    of the period, to other nodes, none with kernel contact. offset: added to the numbers of the structure's materials,
    which follow the particles'. area: (m,) of each node, reach: of the disc that a particle bears on, for frames.
    """

    nodes: NDArray[np.int64]
    tolerance: float = 0.0
    most: int = 30
    relaxation: float = 1.0
    original: bool = False
    offset: int = 0
    area: Floats | None = None
    reach: float = 0.0


@dataclass(frozen=True, slots=True)
class CoupledProblem:
    """What a run needs to know of it. end_time: the structure's; step_factor: of the particles."""

    end_time: float
    dimension: int
    step_factor: float


class Coupled:
    """A structure and particles. `advance` takes one period; between calls both are at `time`."""

    def __init__(self, structure: fem.Solver, particles: sph.Solver, exchange: Exchange) -> None:
        if particles.driven is None:
            raise ValueError("the particles have neither driven nodes nor facets")
        self.structure, self.particles, self.exchange = structure, particles, exchange
        self._driven = particles.driven
        p = particles.problem
        self.problem = CoupledProblem(structure.problem.end_time, p.dimension, p.step_factor)
        self.threads = particles.threads
        m = len(exchange.nodes)
        self.force = np.zeros((m, 3))  # on the wetted nodes in the last period
        self.pending = np.zeros((m, 3))  # impulse received and not yet handed on
        self.work = 0.0  # of the contact on the structure
        self.iterations = 0
        self._largest = 0.0  # force of a period so far
        self._relaxation = FIRST_RELAXATION
        self._told = False
        self._moved = np.zeros((m, 3))  # of the nodes in the last period
        self._behind = 0.0  # time by which the particles are late, as the original's are
        self.seconds = {"structure": 0.0, "particles": 0.0}
        self._ledger = sph.Ledger(self.energies())

    @property
    def time(self) -> float:
        """Time of the structure's last step."""
        return self.structure.time

    @property
    def step(self) -> int:
        """Periods done."""
        return self.structure.step

    @property
    def dt(self) -> float:
        """Length of the last period."""
        return self.structure.dt

    def kernels(self) -> str:
        """What a run is built of, for the log."""
        e = self.exchange
        how = f"iterated to {e.tolerance:g}" if e.tolerance else "once a period"
        if e.original:
            handed = f"{self._shift} nodes further on" if self.particles.problem.apart else "as zero: of kernel contact"
            how = f"as the original programs ({handed}), a step of particles lost in each period"
        return (
            f"structure: {self.structure.kernels()}; particles: {self.particles.kernels()}; "
            f"{len(e.nodes)} wetted nodes, forces handed over {how}"
        )

    # a period

    def advance(self, until: float, max_steps: int, pause: float = math.inf) -> None:
        """Take one of the structure's steps, whole. Raises Diverged of either solver."""
        s = self.structure
        if max_steps <= 0 or s.time >= until or s.done:
            return
        if self.exchange.original:
            self._as_original()
        else:
            self._period()
        if self.step % NOTED == 0:
            self._ledger.note(self.energies())

    def _period(self) -> None:
        """One of the structure's steps, and the particles after it."""
        s = self.structure
        period, carried = s.period, self.pending
        if s.guided:  # it goes its way whatever pushes it: the force is that of the period itself
            _, impulse = self._exchange(self.force)
            force = impulse / period
            work = float(np.sum(force * self._moved))
            self._press(force)
        elif self.exchange.tolerance:
            force, work, impulse = self._iterated(carried, period)
        else:
            share = self.exchange.relaxation
            force = (1.0 - share) * self.force + share * carried / period
            work, impulse = self._exchange(force)
        self.work += work
        self.pending = carried + impulse - force * period
        self.force = force
        self._largest = max(self._largest, float(np.linalg.norm(force)))

    def _iterated(self, carried: Floats, period: float) -> tuple[Floats, float, Floats]:
        """The period with the force that its own contact makes: (force, work, impulse)."""
        held = self.structure.snapshot(), self.particles.checkpoint()
        force, last = self.force, None
        relaxation = max(abs(self._relaxation), LEAST_RELAXATION)
        for left in reversed(range(self.exchange.most)):
            work, impulse = self._exchange(force)
            self.iterations += 1
            missing = (carried + impulse) / period - force
            size = float(np.linalg.norm(missing))
            scale = max(float(np.linalg.norm(force + missing)), SMALL * self._largest)
            if size <= self.exchange.tolerance * scale:
                break
            if not left:
                self._tell(size / scale)
                break
            if last is not None and (change := missing - last).any():
                relaxation *= -float(np.sum(last * change)) / float(np.sum(change * change))
                relaxation = math.copysign(min(max(abs(relaxation), LEAST_RELAXATION), 1.0), relaxation)
            last = missing
            force = force + relaxation * missing
            self.structure.restore(held[0])
            self.particles.restore(held[1])
        self._relaxation = relaxation
        return force, work, impulse

    def _tell(self, missing: float) -> None:
        """A period that did not settle is told, the first time."""
        if not self._told:
            log.warning(
                "coupling: the force of the period to t = %g is %.2g off after %d iterations; what is missing is "
                "handed over in the next one", self.time, missing, self.exchange.most,
            )  # fmt: skip
        self._told = True

    def _exchange(self, force: Floats) -> tuple[float, Floats]:
        """One structural step under these forces (m, 3), the particles after it; the work done and their impulse."""
        s, nodes = self.structure, self.exchange.nodes
        u = s.shape.u[nodes, :3]
        before = np.zeros_like(force) if s.loads.contact is None else s.loads.contact[nodes, :3]
        self._press(force)
        self._lead()
        self._moved = moved = s.shape.u[nodes, :3] - u
        mean = force if s.moving else 0.5 * (force + before)
        self._follow()
        return float(np.sum(mean * moved)), self._driven.take_impulse()

    def _press(self, force: Floats, *, at_once: bool = True) -> None:
        loads = np.zeros((self.structure.n, 6))
        loads[self.exchange.nodes, :3] = force
        self.structure.press(loads, at_once=at_once)

    def _lead(self) -> None:
        """The structure takes its step."""
        began = time.perf_counter()
        self.structure.advance(math.inf, 1)
        self.seconds["structure"] += time.perf_counter() - began

    def _follow(self) -> None:
        """The particles go where the structure has gone, and to its time."""
        self._go(self.structure.time - self.particles.time)
        self._run(self.structure.time)

    def _go(self, period: float) -> None:
        """The driven nodes set out for where the structure is."""
        s, nodes = self.structure, self.exchange.nodes
        self._driven.go((s.problem.x[nodes] + s.shape.u[nodes, :3] - self._driven.read("x")) / period)

    def _run(self, until: float) -> None:
        """The particles' steps."""
        began = time.perf_counter()
        while self.particles.time < until:
            self.particles.advance(until, SLICE)
        self.seconds["particles"] += time.perf_counter() - began

    def _as_original(self) -> None:
        """A period as the original programs take it: what they lose and misplace is lost and misplaced here too.

        Its particles leave a period when they have passed its end, with the next step counted and not taken: they
        fall behind by a step a period. (Here `until` is the label of a state, a step ahead of it.)
        """
        s, p = self.structure, self.particles
        period = s.period
        self._press(self.force, at_once=False)
        self._lead()
        self._go(period)
        self._run(s.time - self._behind + p.dt)
        self._behind += p.dt
        self._driven.take_impulse()
        self.force = _misplaced(self._driven.read("c"), self._shift) if p.problem.apart else np.zeros_like(self.force)

    @property
    def _shift(self) -> int:
        """How many nodes further on the original hands a node's force over.

        It takes the number of nodes off that of the particle, where that of the particles before them was meant.
        """
        return self.particles.n - 2 * len(self.exchange.nodes)

    # what it shows

    def frame(self) -> Frame:
        """Particles, nodes and elements; the structure's materials are numbered after the particles'.

        Nodes have the force of the grain in the last period, and its pressure, see `pressure`: friction is in both.
        """
        grain, steel = self.particles.frame(), self.structure.frame()
        cells = [
            Cells(c.kind, c.nodes, {**c.data, "material": c.data["material"] + self.exchange.offset})
            for c in steel.cells
        ]
        place, at = steel.nodes["position"], self.exchange.nodes
        force = np.zeros((len(place), 3))
        force[at] = self.force
        nodes = steel.nodes | {"contact_force": force}
        if self.exchange.area is not None:
            nodes["contact_pressure"] = np.zeros(len(force))
            found = pressure(place[at], self.force, self.exchange.area, self.exchange.reach)
            nodes["contact_pressure"][at] = found
        return Frame(steel.time, steel.step, grain.particles, nodes, cells)

    def _interface_energy(self) -> float:
        """What the interface has made: work on the structure less what the particles have done."""
        return self.work + self._driven.work

    def energies(self) -> dict[str, float]:
        """Energies of both, without what they exchange."""
        grain, steel = self.particles.energies(), self.structure.energies()
        both = {name: grain.get(name, 0.0) + steel.get(name, 0.0) for name in {**grain, **steel}}
        both["external_work"] -= self._interface_energy()
        return both

    def history(self) -> dict[str, float]:
        """One row of history.csv: sums over both; the mean force on the structure in the period; the interface."""
        row, steel = self.particles.history(), self.structure.history()
        for name in ("kinetic", "internal", "dissipated", "momentum_x", "momentum_y", "momentum_z"):
            row[name] += steel[name]
        row["external_work"] += steel["external_work"] - self._interface_energy()
        row["particle_step"] = row.pop("step")
        row["particle_dt"], row["dt"], row["time"] = row["dt"], self.dt, self.time
        force, pending = self.force.sum(axis=0), self.pending.sum(axis=0)
        for k, axis in enumerate("xyz"):
            row[f"structure_force_{axis}"] = float(force[k])
            row[f"pending_impulse_{axis}"] = float(pending[k])
            row[f"reaction_{axis}"] = steel[f"reaction_{axis}"]
        row["interface_energy"] = self._interface_energy()
        row["max_displacement"] = steel["max_displacement"]
        row["iterations"] = float(self.iterations)
        row["step"] = float(self.step)
        return row

    def energy_report(self) -> dict[str, float]:
        """Energies at the start and now; balance_error has in it what the interface made."""
        return self._ledger.report(self.energies())

    # to be continued

    def checkpoint(self) -> dict[str, Any]:
        """Everything that another process needs to go on."""
        data: dict[str, Any] = {f"structure_{k}": v for k, v in self.structure.checkpoint().items()}
        data |= {f"particles_{k}": v for k, v in self.particles.checkpoint().items()}
        return data | self._ledger.kept() | {
            "force": self.force.copy(), "pending": self.pending.copy(), "work": self.work,
            "iterations": self.iterations, "largest": self._largest, "relaxation": self._relaxation,
            "behind": self._behind, "time": self.time, "step": self.step,
        }  # fmt: skip

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint of the same problem. ValueError when it is of another one."""
        for solver, prefix in ((self.structure, "structure_"), (self.particles, "particles_")):
            own = {k.removeprefix(prefix): v for k, v in data.items() if k.startswith(prefix)}
            if not own:
                raise ValueError("the checkpoint does not fit this run: it is not of a structure with particles")
            solver.restore(own)
        self.force, self.pending = np.array(data["force"]), np.array(data["pending"])
        self.work, self.iterations = float(data["work"]), int(data["iterations"])
        self._largest, self._relaxation = float(data["largest"]), float(data["relaxation"])
        self._behind = float(data["behind"])
        self._ledger.restore(data)


def _misplaced(force: Floats, shift: int) -> Floats:
    """Forces (m, 3) that many nodes further on; what passes the last one is lost."""
    to = np.arange(len(force)) + shift
    there = (to >= 0) & (to < len(force))
    out = np.zeros_like(force)
    out[to[there]] = force[there]
    return out
