"""The particle solver.

Owns the state, the neighbour lists and the loop's memory; shows frames, history and checkpoints.

With `original` the states are the same kind, but labelled as the original program labels them: at an output "at t" its
positions are those of t - dt and its velocities those of the half step before.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Diverged
from ..frame import Frame
from ..neighbours import Cells, NeighbourList
from ..threads import available, run
from . import across, births, blame, ghosts, local, measures, probes, reference, rest, setup, step
from .contact import contact_of
from .driving import Driven
from .ledger import Ledger
from .particle import DRIVEN
from .problem import Cures, Problem
from .smoothing import shape_of
from .state import Arrays, State

SKIN = 0.25  # of the largest h: the list's spare radius
CHECKED = 50  # steps between looks at the energies; the original's coupling does not keep their balance
SMALL = 2000  # fewer particles run on one thread: a parallel region costs more than it saves

Floats = NDArray[np.float64]


class Solver:
    """A run of smoothed particles. `advance` moves it on; between calls the state is synchronised at `time`."""

    def __init__(self, problem: Problem, *, threads: int | None = None, skin: float = SKIN) -> None:
        self.problem = problem
        self.end_time = problem.end_time
        self.builds = 0
        n = self.n = len(problem.x)
        self.live = n  # particles that have not left the problem; the others stand behind them
        self.threads = 1 if n < SMALL else max(1, min(threads or available(), available()))
        self._shape = shape_of(problem.kernel, problem.dimension)
        self._mixed = setup.is_mixed(problem)
        self._contact = contact_of(problem, self._shape)
        self._uniform_h = setup.uniform_h(problem)
        self._uniform_mass = setup.uniform_mass(problem)
        self._skin = skin * float(problem.h.max()) * 0.5 * self._shape.support
        self._plain = not all(b.lagrangian for b in problem.bodies)
        cures = self._cures = problem.cures if self._plain else Cures()
        self._walled = any(b.bearing for b in problem.bodies)
        self._images = ghosts.Images(np.zeros(0, np.int64), np.zeros((3, 0)), np.zeros((3, 0)))
        self._mirrors = None if problem.original else ghosts.mirrors(problem.planes)
        self._numbers = setup.numbers_of(problem, self._contact, self._shape, mirrors=self._mirrors is not None)
        self._stiff = local.classes(problem, self._numbers.wave, xsph=cures.xsph > 0.0)
        self._resting = rest.resting(problem, self._numbers.wave)
        self._inner = np.zeros(local.INNER)
        self._slow = n if self._stiff is None else int(np.count_nonzero(~self._stiff[problem.body]))
        has = self._has = setup.rows_of(problem, self._contact, cures, local=self._stiff is not None)
        self._rows_apart = True if has.correction or has.hoop else None
        own = not (self._uniform_h and self._uniform_mass) or self._mixed or has.correction
        self._state = State(n, problem.dimension, has, packs=(self._plain, own and problem.dimension == 3))
        surface = self._contact.surface
        self.driven = Driven(self._state, n, surface) if has.driven or surface is not None else None
        self._mirrored = any(p.kind in (ghosts.SYMMETRY, ghosts.PERIODIC) for p in problem.planes)
        self._progress = np.zeros(step.PROGRESS)
        self._list = NeighbourList(n)
        self._others = NeighbourList(n)
        self._reduced = np.zeros((self.threads, 8))  # a cache line each
        self._laws = tuple(b.law for b in problem.bodies)
        setup.fill(self._state, problem, self._numbers, has, self._shape)
        self._spare = 0.5 * self._skin  # how far particles go before the next list
        if has.birth:
            self.live = births.set_apart(self._state, self.threads)
        self._due = births.due(self._state, self.live)
        self._reference = self._make_reference() if has.lagrangian else None
        self._rebuild()
        self._progress[step.PENDING] = 1.0
        self._run_kernel(0.0, 0)
        first = problem.first_step or float(self._progress[step.NEXT])
        self._progress[step.NEXT] = self._progress[step.FIRST] = first
        if not first > 0.0:
            raise self._collapsed()
        if problem.original:
            self._start_as_original(first)
        self._ledger = Ledger(self.energies())

    def _start_as_original(self, first: float) -> None:
        """The original program begins with a whole step of strain, at positions half a step before the start."""
        s, n = self._state, self.n
        s.rows("x_half")[:, :n] = s.rows("x")[:, :n] - 0.5 * first * s.rows("u")[:, :n]
        self._progress[step.LAST] = first
        self._progress[step.PENDING] = 1.0

    def _make_reference(self) -> reference.Reference:
        """Particles are sorted once: the reference list is to hold."""
        reference.check(self.problem)
        s = self._state
        x, y, z = (s.row("x_start", k) for k in range(3))
        assert x is not None
        assert y is not None
        cells = Cells(self.n, x, y, z, self._shape.support * float(self.problem.h.max()))
        s.sort(self._ordered(cells), self.threads)
        if self._mirrored:
            self._images = reference.place_images(self.problem, s, self._shape)
        by_cell = self._stiff is None
        return reference.build(self.problem, s, self._shape, self.threads, len(self._images), by_cell=by_cell)

    def _ordered(self, cells: Cells) -> NDArray[np.int64]:
        """The order of the cells; with local steps the slow bodies before the stiff ones."""
        if self._stiff is None:
            return cells.order
        return local.in_front(cells.order, self._stiff[self._state.material[: cells.n]])

    def kernels(self) -> str:
        """What the loops were built for, for the log."""
        text = setup.described(self.problem, self._contact, self._cures, self._has, self.threads)
        if self._stiff is None:
            return text + local.advice(self.problem, self._numbers.wave, xsph=self._cures.xsph > 0.0)
        names = ", ".join(b.name for b, stiff in zip(self.problem.bodies, self._stiff, strict=True) if stiff)
        inner = self._progress[step.NEXT] / self._inner[local.FAST_NEXT]
        return f"{text}, local steps: about {max(1, round(inner))} of {names} in one of the others"

    # the loop

    @property
    def time(self) -> float:
        """Time reached; with `original` the label of the state, one step later than its positions."""
        time = float(self._progress[step.TIME])
        return time + float(self._progress[step.NEXT]) if self.problem.original and self.step else time

    @property
    def step(self) -> int:
        """Steps done."""
        return int(self._progress[step.STEPS])

    @property
    def dt(self) -> float:
        """The step to come."""
        return float(self._progress[step.NEXT])

    def advance(self, until: float, max_steps: int, pause: float = math.inf) -> None:
        """Take up to max_steps steps towards the time `until`, which is met exactly (with `original`: passed).

        pause: come back at the first step that has passed this time; the steps are not trimmed to meet it.

        Raises `Diverged` with the step, the particle and the likely cause; the state is that of the last good step, but
        for the particles that broke.
        """
        started = self.step
        wanted = started + max_steps
        while self.step < wanted:
            reason = self._run_kernel(until, wanted - self.step, pause)
            if reason == step.REBUILD:
                self._rebuild()
                if self.step == wanted or self.time >= pause:
                    self._run_kernel(until, 0)
                    break
            elif reason == step.BROKEN:
                raise blame.broken(self._state, self.step + 1, int(self._progress[step.BAD]))
            elif reason == step.FAILED:
                raise blame.torn(self._state, self.step, int(self._progress[step.BAD]))
            elif reason == step.COLLAPSED:
                raise self._collapsed()
            else:
                break
        if self.step // CHECKED > started // CHECKED:
            now = self.energies()
            self._ledger.note(now)
            made = blame.energy_made(self._state, self.step, self._ledger, now)
            if made is not None and not (self.problem.original and self._has.driven):
                raise made

    def _run_kernel(self, until: float, steps: int, pause: float = math.inf) -> int:
        if self._stiff is not None:
            return self._run_local(until, steps, pause)
        a = self._arrays()
        p, cures, has = self.problem, self._cures, self._has
        solid = p.dimension == 3
        images = self._images if self._mirrored else None
        found = run(
            step.advance, self.threads, self.live, self.n, self._shape, True if solid else None,
            a.z if solid else None, None if self._uniform_h or not self._plain else a.h,
            None if self._uniform_mass or not self._plain else a.mass,
            a.nearest if p.step_option == 2 and self._plain else None, True if p.dimension == 1 else None, a.cx,
            self._contact.law, True if self._mixed else None, a.correction if has.correction else None, a.bx,
            cures.artificial_stress if has.artificial else None, a.h_list, a.h_start, a.density_rate,
            a.stress_rate if has.stress_rate else None, a.heat, a.smoothed if has.xsph else None, cures.xsph,
            a.body_work, a.wave, True if self._walled else None, None if images is None else images.source,
            None if images is None else images.sign, None if images is None else images.shift, self._mirrors,
            self._contact.friction, self._contact.damping, self._contact.normals, self._contact.by_normals,
            self._contact.walls, a.wall_slip if has.wall_slip else None, a.contact_heat,
            True if self._plain else None, a.hoop, self._rows_apart, self._reference, True if has.driven else None,
            None if self._contact.surface is None else self._contact.surface.faces(),
            a.face_slip if has.face_slip else None, self._resting, a, self._numbers, self._laws,
            self._progress, float(until), float(pause), self._due, steps, self._spare**2,
        )  # fmt: skip
        return int(found[0])

    def _run_local(self, until: float, steps: int, pause: float) -> int:
        """`_run_kernel` with local steps."""
        a = self._arrays()
        p, has, contact = self.problem, self._has, self._contact
        solid = p.dimension == 3
        found = run(
            local.advance, self.threads, self.n, self._slow, self._shape, True if solid else None,
            a.z if solid else None, None if self._uniform_h or not self._plain else a.h,
            None if self._uniform_mass or not self._plain else a.mass,
            a.nearest if p.step_option == 2 and self._plain else None, True if p.dimension == 1 else None, a.cx,
            contact.law, a.correction if has.correction else None, a.bx,
            self._cures.artificial_stress if has.artificial else None, a.density_rate,
            a.stress_rate if has.stress_rate else None, a.heat, a.wave, contact.friction, contact.damping,
            contact.normals, contact.by_normals, contact.walls, a.wall_slip if has.wall_slip else None,
            a.contact_heat, True if self._plain else None, self._reference, a, self._numbers, self._laws,
            self._progress, self._inner, float(until), float(pause), steps, self._spare**2,
        )  # fmt: skip
        return int(found[0])

    def _arrays(self) -> Arrays:
        return self._state.arrays(self._list, self._others, self._reduced)

    def _rebuild(self, *, sort: bool = True) -> None:
        """Sort the particles by cell and list their neighbours.

        sort False: from where the last list was built, as it was.
        """
        s = self._state
        s.forget()
        if sort:
            last = float(self._progress[step.LAST])
            if self.problem.planes:
                self.live = ghosts.leave(s, self.problem.planes, self.live, last, self.threads)
            if self._has.birth:
                self.live = births.enter(s, self.live, self.time, last, self.threads)
                self._due = births.due(s, self.live)
            if self.live == 0:
                raise Diverged(self.step, int(s.id[0]), "all particles have left the problem through its limit planes")
            s.rows("x_list")[:] = s.rows("x")
            if self._has.changing_h:
                s.rows("h_list")[:] = s.rows("h")
        self.builds += 1
        n = self.live
        h_max = float(s.rows("h_list" if self._has.changing_h else "h")[0, :n].max())
        radius = h_max * self._shape.support
        if self._reference is not None:
            self._relist(radius)
            if self._contact.surface is not None:  # bodies alone need no new list of themselves, but facets are near
                self._spare = min(self._spare, 0.5 * self._skin)
            self._face(n)
            return
        rows = s.rows("x_list")
        cells = Cells(n, rows[0], rows[1], rows[2] if s.d == 3 else None, radius + self._skin)
        if sort:
            s.sort(self._ordered(cells), self.threads)
        self._face(n)
        if self._mirrored:
            self._make_images(radius + self._skin)
        x, y, z = s.row("x_list", 0), s.row("x_list", 1), s.row("x_list", 2)
        assert x is not None
        assert y is not None
        h = None
        if not self._uniform_h:  # the pair's radius is half the support of both
            h = s.rows("h_list" if self._has.changing_h else "h")[0] * (0.5 * self._shape.support)
            radius *= 0.5
        group = s.material if self.problem.apart else None
        wanted = [(self._list, False)] + ([(self._others, True)] if self.problem.apart else [])
        of_kernel = radius, h
        for neighbours, other in wanted:
            radius, h = self._contact.pairs(*of_kernel, self._shape.support) if other else of_kernel
            if self._mirrored or self._stiff is not None:
                neighbours.build_mapped(
                    n, len(self._images), self.n, x, y, z, dummy=s.dummy, radius=radius, skin=self._skin, h=h,
                    group=group, other=other, threads=self.threads,
                )  # fmt: skip
            else:
                neighbours.build(
                    cells, x, y, z, radius=radius, skin=self._skin, h=h, group=group, other=other, threads=self.threads,
                    dummy=s.dummy,
                )  # fmt: skip
        if self._has.interface:
            arrays = self._arrays()
            across.interface_speed(self.live, s.dummy, arrays.wave, self._numbers, arrays)

    def _face(self, n: int) -> None:
        """List the facets near each particle."""
        surface = self._contact.surface
        if surface is not None:
            s = self._state
            x, y, z = (s.row("x_list", k) for k in range(3))
            assert x is not None
            assert y is not None
            surface.build(x, y, z, n, surface.largest(s.rows("h")[0, :n], s.material[:n]), self._spare)

    def _relist(self, radius: float) -> None:
        """The lists beside the reference list, of particles that keep their order."""
        s = self._state
        h = None
        if not self._uniform_h:
            h = s.rows("h_list" if self._has.changing_h else "h")[0] * (0.5 * self._shape.support)
            radius *= 0.5
        of_contact = self._contact.pairs(radius, h, self._shape.support)
        self._spare = reference.relist(
            self.problem, s, self._list, self._others, (radius, h), of_contact, self._skin, self.threads
        )

    def _make_images(self, reach: float) -> None:
        """Images of the particles near planes, with everything that the loops read of them."""
        s = self._state
        found = self._images = ghosts.place_images(s, self.problem.planes, self.live, reach)
        a = self._arrays()
        z = a.z if s.d == 3 else None
        ghosts.follow_motion(0, len(found), self.n, z, found.source, found.sign, found.shift, a)
        ghosts.follow_stress(0, len(found), self.n, z, self._rows_apart, found.source, found.sign, a)

    def _collapsed(self) -> Diverged:
        return blame.collapsed(self.problem, self._state, self._arrays(), self.live, self.step, self.dt)

    # what it shows

    def _velocity(self) -> Floats:
        """(d, n) velocities at the time of the positions; with `original` those of the half step before."""
        s, n = self._state, self.n
        back = 0.0 if self.problem.original else 0.5 * float(self._progress[step.LAST])
        velocity = s.rows("u")[:, :n] + back * s.rows("a")[:, :n]
        if self._stiff is not None:
            u, a, c, held = (s.rows(name)[:, self._slow : n] for name in ("u", "a", "c", "held"))
            velocity[:, self._slow :] = local.velocity(u, a, c, held, float(self._progress[step.LAST]), self._inner)
        driven = s.fixed[:n] & DRIVEN > 0
        if self._resting is not None:
            velocity[:, s.rows("still")[0, :n] != rest.AWAKE] = 0.0
        for k in range(s.d):
            velocity[k, (s.fixed[:n] >> k) & 1 == 1] = 0.0
            velocity[k, driven] = s.rows("u")[k, :n][driven]
        return velocity

    def frame(self) -> Frame:
        """The state now, in the order of the deck."""
        arrays = measures.particles(self.problem, self._state, self._velocity()[:, : self.live], self.live)
        return Frame(time=self.time, step=self.step, particles=arrays)

    def energies(self) -> dict[str, float]:
        """Energies now, see `measures.energies`."""
        given = 0.0 if self.driven is None else self.driven.work
        found = measures.energies(self.problem, self._state, self._velocity(), self.live, given)
        if self._contact.surface is not None:  # what facets give is no particle's work
            found["contact_energy"] += given
        return found

    def history(self) -> dict[str, float]:
        """One row of history.csv: energies, momentum, the contact force on the first material.

        `internal` is elastic and dissipated energy together, `dissipated` the part that plastic flow and viscosity
        took; kinetic + internal + contact_energy + contact_dissipated + artificial_energy + relaxation_dissipated -
        external_work stays constant.
        """
        s, n = self._state, self.live
        velocity = self._velocity()
        force = measures.contact_force(self.problem, s, self._arrays(), self._shape, self._numbers, self._rows_apart, n)
        clock = {"time": self.time, "dt": self.dt, "step": float(self.step)}
        row = measures.row(self.problem, s, velocity, self.energies(), force, n, clock)
        if not self._has.absent:
            del row["absent_energy"]
        return row | rest.columns(s.rows("still")[:, :n]) | probes.columns(self.problem, s, n, self._shape, velocity)

    def energy_report(self) -> dict[str, float]:
        """Energies at the start and now, and how far their balance is out, see `Ledger.report`."""
        return self._ledger.report(self.energies())

    # to be continued

    def checkpoint(self) -> dict[str, Any]:
        """Everything that another process needs to go on bit for bit, including where the neighbour list was built."""
        return self._state.kept() | {
            "live": self.live,
            "progress": self._progress.copy(),
            "inner": self._inner.copy(),
            **({} if self.driven is None else self.driven.kept()),
            **self._ledger.kept(),
            "time": self.time,
            "step": self.step,
        }

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint of the same problem. ValueError when it is of another one."""
        self._state.restore(data)
        self.live = int(data["live"])
        self._due = births.due(self._state, self.live)
        self._progress[:] = data["progress"]
        self._inner[:] = data["inner"]
        if self.problem.body_curve is not None:
            step.body_force_at(self._progress[step.TIME], self._numbers)
        self._ledger.restore(data)
        self._rebuild(sort=False)
        if self.driven is not None:
            self.driven.restore(data)
