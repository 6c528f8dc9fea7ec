"""The finite element solver: takes the steps of a problem, shows its state, keeps and restores it."""

from __future__ import annotations

import logging
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Diverged
from ..frame import Frame
from . import output
from .arc import PathFollowing
from .assembly import AXES, Assembly, Mechanism
from .centres import with_centres
from .equilibrium import NotConverged
from .groups.timed import has_life
from .guided import Guided
from .loads import Loads
from .problem import Problem
from .procedures import Explicit, Increments, Procedure, Superposition, Vibrations
from .shape import Shape

Floats = NDArray[np.float64]
log = logging.getLogger("zrno")
_KEPT = ("reaction", "internal_forces", "external_forces")


class Solver:
    """A structure in time. What a step is, the problem says.

    given: what it was asked; problem: what is computed, with nodes of its own behind those given where elements need
    them; threads: None for all where the system is large; shape: the last one accepted; reaction: (n, 6) of supports;
    internal_forces, external_forces: (n, 6) of stresses and of loads there.
    """

    def __init__(self, problem: Problem, *, threads: int | None = None) -> None:
        self.given = problem
        self.problem = problem = with_centres(problem)
        self.assembly = Assembly(problem, threads=threads)
        self.threads = self.assembly.threads
        self.loads = Loads(problem, self.assembly.groups)
        n = len(problem.x)
        self.shape = Shape(np.zeros((n, 6)), self.assembly.still)
        self.linear = output.is_linear(problem)
        self.time, self.step, self.iterations = 0.0, 0, 0
        self.reaction, self.internal_forces = np.zeros((n, 6)), np.zeros((n, 6))
        self.external_forces = self.loads.at(0.0, self.shape.u)
        self.external_work, self.damped = 0.0, 0.0
        self.support_impulse = np.zeros(3)
        self._damping = np.zeros((n, 6))
        self._ends = np.arange(problem.modes + 1.0) if problem.modes else problem.ends()
        self.dt = float(self._ends[1])
        self._seen: Shape | None = None  # the shape of the elements' stresses, where that is not the last one
        self._start()
        self.procedure = self._procedure()
        if self.procedure.velocity(self) is None:
            self.external_forces = np.zeros((n, 6))  # statics begin without loads
        self.start_energy = self.procedure.kinetic(self) + sum(g.energies()[0] for g in self.assembly.groups)

    def _start(self) -> None:
        """Displacements at the start, and the stresses that go with them."""
        p = self.problem
        if p.dynamics is None or p.displacement is None:
            return
        first = self.shape
        self.shape = first.moved(np.where(self.assembly.active, p.displacement, 0.0))
        self.internal_forces, _ = self.assembly.evaluate(self.shape, first, 0.0, stiff=False)
        self.assembly.commit()

    def _procedure(self) -> Procedure:
        p = self.problem
        if p.rigid:
            return Guided(self)
        if any(has_life(e) for e in p.elements) and (p.modes or p.path is not None or p.dynamics is not None):
            raise ValueError("elements are born and die in statics alone, with loads that are given")
        central = p.dynamics is not None and p.dynamics.method == "central"
        if self.assembly.heat is not None and (p.modes or p.path is not None or central):
            raise ValueError("temperatures are computed in steps to equilibrium alone, with loads that are given")
        if p.modes:
            return Vibrations()
        if p.path is not None:
            return PathFollowing(self, p.path)
        if central:
            return Explicit(self)
        simple = self.linear and p.dynamics is None and self.assembly.heat is None
        return Superposition() if simple else Increments(self)

    def kernels(self) -> str:
        """What a run is built of, for the log."""
        kinds = ", ".join(f"{len(e.ids)} {e.kind} {e.family}" for e in self.problem.elements)
        return f"{kinds}; {self.assembly.equations} equations by {self.assembly.system.name}; {self.procedure.name}"

    @property
    def n(self) -> int:
        """Nodes."""
        return len(self.problem.x)

    def advance(self, until: float, max_steps: int, pause: float = math.inf) -> None:
        """Take one of the problem's steps and come back, for each is to be seen; what passes `until` is taken whole.

        Raises Diverged with the step, where, and the likely cause; the state is the last one in equilibrium.
        """
        if max_steps <= 0 or self.time >= until or self.done:
            return
        end = float(self._ends[self.step + 1])
        dt = end - self.time
        try:
            self.procedure.take(self, end)
        except Mechanism as error:
            raise self._diverged(str(error), (error.node, error.dof) if error.node >= 0 else None) from error
        except NotConverged as error:
            raise self._diverged(error.cause, error.worst) from error
        self.step += 1
        self.time, self.dt = end, dt

    def _diverged(self, cause: str, where: tuple[int, int] | None) -> Diverged:
        if where is None:
            return Diverged(self.step, 0, cause)
        number = int(self.problem.node_ids[where[0]])
        return Diverged(self.step, 0, f"{cause} at node {number} along {AXES[where[1]]}")

    # what procedures ask and tell

    def prescribed(self, now: float, until: float, end: float) -> Floats:
        """Prescribed change (n, 6) of displacement in a part of the step that ends at `end`."""
        change = np.zeros((self.n, 6))
        for m in self.problem.motions:
            if m.incremental:  # the curve's value is this step's change, spread over its parts
                factor = self.loads.factor(m.curve, end) * (until - now) / (end - float(self._ends[self.step]))
            else:
                factor = self.loads.factor(m.curve, until) - (self.loads.factor(m.curve, now) if now > 0.0 else 0.0)
            change[m.nodes, m.dofs] += factor * m.values
        return change

    def released(self, shape: Shape, dt: float) -> None:
        """Before a shape is accepted: what the forces of elements that went had done on the way is lost."""
        moved = shape.u - self.shape.u
        there, _ = self.assembly.evaluate(self.shape, self.shape, 0.0, stiff=False)
        self.damped += 0.5 * float(((self.internal_forces - there) * moved).sum())
        self.assembly.evaluate(shape, self.shape, dt, stiff=False)

    def accept(
        self, shape: Shape, external: Floats, internal: Floats, inertia: Floats | None = None,
        damping: Floats | None = None, duration: float = 0.0, *, seen: bool = True,
    ) -> None:  # fmt: skip
        """Commit a shape with its forces (n, 6); work of loads, supports and damping by the trapezoidal rule.

        duration: of what led to it, of a structure with inertia: the impulse of its supports. seen: whether the
        elements were evaluated at the shape; of a linear structure they may be later, when stresses are asked for.
        """
        moved = shape.u - self.shape.u
        inner = internal if inertia is None else internal + inertia
        if damping is not None:
            self.damped += 0.5 * float(((damping + self._damping) * moved).sum())
            self._damping = damping
            inner = inner + damping
        reaction = np.where(self.assembly.free, 0.0, inner - external)
        forces, before = external + reaction, self.external_forces + self.reaction
        self.external_work += 0.5 * float(((forces + before) * moved).sum())
        self.support_impulse = self.support_impulse + 0.5 * duration * (reaction + self.reaction)[:, :3].sum(axis=0)
        if seen:
            self.assembly.commit()
        elif self._seen is None:
            self._seen = self.shape
        self.shape, self.reaction = shape, reaction
        self.internal_forces, self.external_forces = internal, external

    @property
    def moving(self) -> bool:
        """Whether it has inertia."""
        return self.procedure.velocity(self) is not None

    @property
    def guided(self) -> bool:
        """Whether its motion is given, whatever pushes it."""
        return isinstance(self.procedure, Guided)

    def hold(self, external: Floats) -> None:
        """Loads (n, 6) that are held where they act."""
        self.external_forces, self.reaction = external, -external

    @property
    def period(self) -> float:
        """Length of the next step."""
        return float(self._ends[self.step + 1]) - self.time

    @property
    def done(self) -> bool:
        """Whether the last of the problem's steps is taken."""
        return self.step + 1 >= len(self._ends)

    def press(self, forces: Floats, *, at_once: bool = True) -> None:
        """Forces (n, 6) of what touches the structure, from now on; they replace the last ones.

        at_once: they act in the whole of the next step; otherwise, and always in statics, they grow in it.
        """
        before = self.loads.contact
        self.loads.contact = forces
        if self.guided:
            self.hold(self.external_forces + (forces if before is None else forces - before))
        if self.moving and at_once:
            change = forces if before is None else forces - before
            self.external_forces = self.external_forces + change
            inertia = self.procedure.jump(change)
            self.reaction = self.reaction + np.where(self.assembly.free, 0.0, inertia - change)

    # what it shows

    def frame(self) -> Frame:
        """The state now, nodes and elements in the order of the deck."""
        self._see()
        return output.frame(self)

    def _see(self) -> None:
        """Bring the elements' stresses to the shape."""
        if self._seen is not None:
            self.assembly.evaluate(self.shape, self._seen, 0.0, stiff=False)
            self.assembly.commit()
            self._seen = None

    def energies(self) -> dict[str, float]:
        """Kinetic, internal (what flow and damping took included), dissipated, and the work of loads and supports."""
        if self._seen is not None:  # linear statics
            internal = 0.5 * float((self.internal_forces * self.shape.u).sum())
            return {"kinetic": 0.0, "internal": internal, "dissipated": 0.0, "external_work": self.external_work}
        pairs = [g.energies() for g in self.assembly.groups]
        stops = self.assembly.stops
        held = 0.0 if stops is None else stops.energy(self.shape.u)
        return {
            "kinetic": self.procedure.kinetic(self),
            "internal": sum(p[0] for p in pairs) + held + self.damped,
            "dissipated": sum(p[1] for p in pairs) + self.damped,
            "external_work": self.external_work,
        }

    def history(self) -> dict[str, float]:
        """One row of history.csv."""
        return output.history(self, self.energies())

    def energy_report(self) -> dict[str, float]:
        """Energies now; balance_error: internal energy (by stresses) against external work (by forces)."""
        return output.energy_report(self, self.energies(), self.start_energy)

    # to be continued

    def checkpoint(self) -> dict[str, Any]:
        """Everything that another process needs to go on; this one goes on as if it were the other."""
        self._see()
        self.procedure.forget()
        self.assembly.system.factored = False
        for group in self.assembly.groups:
            group.forget()
        return self.snapshot()

    def snapshot(self) -> dict[str, Any]:
        """The state, to be restored in this process: what speeds up the next step stays."""
        data: dict[str, Any] = {name: getattr(self, name) for name in _KEPT}
        data |= {"u": self.shape.u, "external_work": self.external_work, "damped": self.damped,
                 "damping": self._damping, "support_impulse": self.support_impulse,
                 "time": self.time, "step": self.step, "dt": self.dt,
                 "start_energy": self.start_energy, "iterations": self.iterations}  # fmt: skip
        if self.loads.contact is not None:
            data["contact"] = self.loads.contact
        if self._seen is not None:
            data["seen"] = self._seen.u
        if self.shape.turn is not None:
            data["turn"] = self.shape.turn
        data |= {f"procedure_{name}": values for name, values in self.procedure.state().items()}
        for k, group in enumerate(self.assembly.groups):
            data |= {f"group{k}_{name}": values for name, values in group.state().items()}
        return {name: values.copy() if isinstance(values, np.ndarray) else values for name, values in data.items()}

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint of the same problem. ValueError when it is of another one."""
        if "u" not in data or np.shape(data["u"]) != (self.n, 6):
            raise ValueError("the checkpoint does not fit this run: the displacements have another shape")
        self.shape = Shape(np.array(data["u"]), np.array(data["turn"]) if "turn" in data else None)
        for name in _KEPT:
            setattr(self, name, np.array(data[name]))
        self._seen = Shape(np.array(data["seen"])) if "seen" in data else None
        self._damping = np.array(data["damping"])
        self.support_impulse = np.array(data["support_impulse"])
        self.loads.contact = np.array(data["contact"]) if "contact" in data else None
        self.external_work, self.damped = float(data["external_work"]), float(data["damped"])
        self.time, self.step, self.dt = float(data["time"]), int(data["step"]), float(data["dt"])
        self.start_energy, self.iterations = float(data["start_energy"]), int(data["iterations"])
        self.procedure.restore(_named(data, "procedure_"))
        for k, group in enumerate(self.assembly.groups):
            group.restore(_named(data, f"group{k}_"))


def _named(data: dict[str, Any], prefix: str) -> dict[str, Any]:
    return {name.removeprefix(prefix): values for name, values in data.items() if name.startswith(prefix)}
