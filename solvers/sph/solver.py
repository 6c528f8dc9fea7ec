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
from ..materials import PLASTIC_STRAIN, constant_wave, sound_speed, state_rows
from ..neighbours import FAR, Cells, NeighbourList
from ..threads import available, run
from . import across, ghosts, measures, probes, reference, step
from .contact import contact_of, culprit
from .problem import STEP_OPTIONS, Cures, Problem
from .smoothing import normaliser, shape_of, value_at
from .state import Arrays, Numbers, Rows, State

SKIN = 0.25  # of the largest h: the list's spare radius
IMAGE = 0.25  # of h: a particle nearer to its image than this shortens the step no further
CHECKED = 50  # steps between looks at the energy balance
STORED = ("contact_energy", "contact_dissipated", "artificial_energy")  # columns that stand at the end
CREATED = 3.0  # so many times the energy put in cannot come out of a stable run
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
        self._mixed = self._is_mixed()
        self._contact = contact_of(problem, self._shape)
        self._uniform_h = bool(np.all(problem.h == problem.h[0])) and problem.h_option == 0
        self._uniform_mass = bool(np.all(problem.mass == problem.mass[0]))
        self._skin = skin * float(problem.h.max()) * 0.5 * self._shape.support
        self._plain = not all(b.lagrangian for b in problem.bodies)
        cures = self._cures = problem.cures if self._plain else Cures()
        self._heats = any(b.alpha or b.beta for b in problem.bodies)
        self._walled = any(b.bearing for b in problem.bodies)
        has = Rows(
            state=max(state_rows(b.law) for b in problem.bodies),
            contact=problem.apart or bool(problem.walls),
            correction=cures.correction,
            artificial=cures.artificial_stress > 0.0,
            heat=self._heats,
            density_rate=any(b.density_diffusion for b in problem.bodies),
            stress_rate=any(b.stress_diffusion for b in problem.bodies),
            xsph=cures.xsph > 0.0,
            changing_h=problem.h_option != 0,
            body_work=problem.body_curve is not None,
            wave=not (problem.original or all(constant_wave(b.law) for b in problem.bodies)),
            contact_heat=self._contact.heats,
            slip=self._contact.friction is not None,
            normals=self._contact.normals is not None,
            wall_slip=self._contact.wall_slip,
            lagrangian=any(b.lagrangian for b in problem.bodies),
        )
        self._has = has
        self._state = State(n, problem.dimension, has)
        self._images = ghosts.Images(np.zeros(0, np.int64), np.zeros((3, 0)), np.zeros((3, 0)))
        self._mirrors = None if problem.original else ghosts.mirrors(problem.planes)
        self._mirrored = any(p.kind in (ghosts.SYMMETRY, ghosts.PERIODIC) for p in problem.planes)
        self._progress = np.zeros(step.PROGRESS)
        self._list = NeighbourList(n)
        self._others = NeighbourList(n)
        self._reduced = np.zeros((self.threads, 8))  # a cache line each
        self._laws = tuple(b.law for b in problem.bodies)
        self._numbers = self._make_numbers()
        self._fill_state()
        self._spare = 0.5 * self._skin  # how far particles go before the next list
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
        self._start_energy = self._energies()

    # what the run is

    def _is_mixed(self) -> bool:
        """Whether bodies of different density are each other's neighbours.

        The sums are then to suit that (see `pairs`).
        """
        p = self.problem
        return len({b.density for b in p.bodies}) > 1 and not p.apart and not p.original

    def _make_numbers(self) -> Numbers:
        p = self.problem
        h = float(p.h[0])
        normal = normaliser(self._shape, p.dimension)
        times, values = p.body_curve or (np.zeros(2), np.zeros((2, 3)))
        spacing = float(np.median((p.mass / p.density) ** (1.0 / p.dimension) / p.h))
        wave = np.array([sound_speed(b.law, b.density, self._first_energy(k)) for k, b in enumerate(p.bodies)])
        wave = np.where(self._contact.rigid, 0.0, wave)
        viscous = np.array([(b.linear, b.quadratic, b.least, b.most) for b in p.bodies])
        scale = normal / h ** (p.dimension + 2) if self._uniform_h else normal
        return Numbers(
            dimension=p.dimension,
            inverse_h2=1.0 / (h * h),
            scale=scale,
            force_scale=scale * (float(p.mass[0]) if self._uniform_mass else 1.0),
            normal=normal,
            viscous=viscous,
            wave=wave,
            body=np.array(p.body_force if p.body_curve is None else values[0], dtype=float),
            body_times=np.asarray(times, dtype=float),
            body_values=np.asarray(values, dtype=float),
            h_option=p.h_option,
            relaxation=p.relaxation,
            pair_viscosity=np.array([(b.alpha, b.beta) for b in p.bodies]),
            density_diffusion=np.array([b.density_diffusion for b in p.bodies]),
            stress_diffusion=np.array([b.stress_diffusion for b in p.bodies]),
            least_distance=0.0 if self._mirrors is None else IMAGE,
            wall=np.array([b.density if b.bearing else 0.0 for b in p.bodies]),
            inverse_w=1.0 / value_at(self._shape, spacing),
            step_option=p.step_option,
            step_factor=p.step_factor,
            original=p.original,
            mixed=self._mixed,
        )

    def _first_energy(self, body: int) -> float:
        """Mean energy per unit mass of a body's particles at the start."""
        p = self.problem
        mine = p.body == body
        return float(p.energy[mine].mean()) if p.energy is not None and np.any(mine) else 0.0

    def _fill_state(self) -> None:
        p, s, n = self.problem, self._state, self.n
        d = s.d
        for name, values in (("x", p.x), ("x_half", p.x), ("x_start", p.x), ("u", p.v)):
            s.rows(name)[:, :n] = values.T[:d]
        for name, scalar in (("mass", p.mass), ("h", p.h), ("density", p.density), ("volume", p.mass / p.density)):
            s.rows(name)[0, :n] = scalar
        if p.energy is not None:
            s.rows("energy")[0, :n] = p.energy
        if p.stress is not None:
            rows = s.rows("stress")
            rows[:, :n] = p.stress.T[: len(rows)]
        s.id[:n] = np.arange(1, n + 1) if p.id is None else p.id
        s.material[:n] = p.body
        if p.fixed is not None:
            s.fixed[:n] = p.fixed @ np.array([1, 2, 4])
        if self._has.changing_h:
            s.rows("h_start")[0, :n] = p.h * p.density ** (1.0 / p.dimension)
        if self._has.wave:
            s.rows("wave")[0, :n] = self._numbers.wave[p.body]
        if self._has.correction:  # none yet: the stress-free start needs none
            s.rows("correction")[: 3 if p.dimension == 3 else 2] = 1.0
        radius = self._shape.support * float(p.h.max())
        span = max(float(np.ptp(p.x, axis=0).max()), radius)
        s.place_dummy(float(np.abs(p.x).max()) + FAR * radius + span)

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
        s.sort(Cells(self.n, x, y, z, self._shape.support * float(self.problem.h.max())).order, self.threads)
        return reference.build(self.problem, s, self._shape, self.threads)

    def kernels(self) -> str:
        """What the loops were built for, for the log."""
        p = self.problem
        laws = ", ".join(dict.fromkeys(type(law).__name__ for law in self._laws))
        return (
            f"{p.dimension}D, {p.kernel} kernel, {'one' if self._uniform_h else 'variable'} h, "
            f"{'one' if self._uniform_mass else 'variable'} mass, laws: {laws}, "
            f"contact: {self._contact.name(len(p.bodies))}, "
            f"step: {STEP_OPTIONS[p.step_option]}, {self.threads} thread(s)"
            + "".join(f", {term}" for term in self._terms())
        )

    def _terms(self) -> list[str]:
        """What a run has beyond the plain method."""
        p, cures = self.problem, self._cures
        said = {
            "total-Lagrangian: " + ", ".join(b.name for b in p.bodies if b.lagrangian): self._has.lagrangian,
            "gradient correction": cures.correction,
            f"artificial stress {cures.artificial_stress:g}": cures.artificial_stress > 0.0,
            "density diffusion": self._has.density_rate,
            "stress diffusion": self._has.stress_rate,
            f"XSPH {cures.xsph:g}": cures.xsph > 0.0,
            "pair viscosity": self._heats,
            "walls that bear their neighbours' stress": self._walled,
            f"h option {p.h_option}": p.h_option != 0,
            f"dynamic relaxation {p.relaxation:g}": p.relaxation != 1.0,
            f"{len(p.planes)} boundary plane(s)": bool(p.planes),
            "base acceleration by curve": p.body_curve is not None,
            "as the original program": p.original,
        }
        return [term for term, there in said.items() if there]

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
                self._run_kernel(until, 0)
                if self.time >= pause:
                    break
            elif reason == step.BROKEN:
                raise self._broken()
            elif reason == step.FAILED:
                raise self._failed()
            elif reason == step.COLLAPSED:
                raise self._collapsed()
            else:
                break
        if self.step // CHECKED > started // CHECKED:
            self._check_energy()

    def _run_kernel(self, until: float, steps: int, pause: float = math.inf) -> int:
        a = self._arrays()
        p, cures, has = self.problem, self._cures, self._has
        solid = p.dimension == 3
        images = self._images if self._mirrored else None
        return int(
            run(
                step.advance,
                self.threads,
                self.live,
                self.n,
                self._shape,
                True if solid else None,
                a.z if solid else None,
                None if self._uniform_h or not self._plain else a.h,
                None if self._uniform_mass or not self._plain else a.mass,
                a.nearest if p.step_option == 2 and self._plain else None,
                True if p.dimension == 1 else None,
                a.cx,
                self._contact.law,
                True if self._mixed else None,
                a.correction if has.correction else None,
                a.bx,
                cures.artificial_stress if has.artificial else None,
                a.h_list,
                a.h_start,
                a.density_rate,
                a.stress_rate if has.stress_rate else None,
                a.heat,
                a.smoothed if has.xsph else None,
                cures.xsph,
                a.body_work,
                a.wave,
                True if self._walled else None,
                None if images is None else images.source,
                None if images is None else images.sign,
                None if images is None else images.shift,
                self._mirrors,
                self._contact.friction,
                self._contact.damping,
                self._contact.normals,
                self._contact.by_normals,
                self._contact.walls,
                a.wall_slip if has.wall_slip else None,
                a.contact_heat,
                True if self._plain else None,
                self._reference,
                a,
                self._numbers,
                self._laws,
                self._progress,
                float(until),
                float(pause),
                steps,
                self._spare**2,
            )[0]
        )

    def _arrays(self) -> Arrays:
        s = self._state
        positions = {
            f"{axis}{suffix}": s.row(f"x{suffix}", k)
            for suffix in ("", "_half", "_list", "_start")
            for k, axis in enumerate("xyz")
        }
        return Arrays(
            **positions,
            u=s.row("u", 0),
            v=s.row("u", 1),
            w=s.row("u", 2),
            ax=s.row("a", 0),
            ay=s.row("a", 1),
            az=s.row("a", 2),
            cx=s.row("c", 0),
            cy=s.row("c", 1),
            cz=s.row("c", 2),
            contact_work=s.row("contact_work"),
            bx=s.row("b", 0),
            by=s.row("b", 1),
            bz=s.row("b", 2),
            artificial_work=s.row("artificial_work"),
            heat=s.row("heat"),
            h_start=s.row("h_start"),
            h_list=s.row("h_list"),
            correction=s.rows("correction"),
            density_rate=s.row("density_rate"),
            stress_rate=s.rows("stress_rate"),
            smoothed=s.rows("smoothed"),
            body_work=s.row("body_work"),
            wave=s.row("wave"),
            stress=s.rows("stress"),
            gradient=s.rows("gradient"),
            s=s.rows("s"),
            density=s.row("density"),
            volume=s.row("volume"),
            mass=s.row("mass"),
            h=s.row("h"),
            energy=s.row("energy"),
            dissipated=s.row("dissipated"),
            viscosity=s.row("viscosity"),
            nearest=s.row("nearest"),
            state=s.rows("state"),
            id=s.id,
            material=s.material,
            fixed=s.fixed,
            first=self._list.first,
            count=self._list.count,
            rows=self._list.rows,
            c_first=self._others.first,
            c_count=self._others.count,
            c_rows=self._others.rows,
            reduced=self._reduced,
            contact_heat=s.row("contact_heat"),
            slip=s.rows("slip"),
            wall_slip=s.rows("wall_slip"),
            colour=s.rows("colour"),
            mobilised=s.rows("mobilised"),
            deformation=s.rows("deformation"),
            hourglass=s.rows("hourglass"),
            nominal=s.rows("nominal"),
        )

    def _rebuild(self, *, sort: bool = True) -> None:
        """Sort the particles by cell and list their neighbours.

        sort False: from where the last list was built, as it was.
        """
        s = self._state
        if sort:
            self._leave()
            s.rows("x_list")[:] = s.rows("x")
            if self._has.changing_h:
                s.rows("h_list")[:] = s.rows("h")
        self.builds += 1
        n = self.live
        h_max = float(s.rows("h_list" if self._has.changing_h else "h")[0, :n].max())
        radius = h_max * self._shape.support
        if self._reference is not None:
            self._relist(radius)
            return
        rows = s.rows("x_list")
        cells = Cells(n, rows[0], rows[1], rows[2] if s.d == 3 else None, radius + self._skin)
        if sort:
            s.sort(cells.order, self.threads)
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
            if self._mirrored:
                neighbours.build_mapped(
                    n, len(self._images), self.n, x, y, z, dummy=s.dummy, radius=radius, skin=self._skin, h=h,
                    group=group, other=other, threads=self.threads,
                )  # fmt: skip
            else:
                neighbours.build(
                    cells, x, y, z, radius=radius, skin=self._skin, h=h, group=group, other=other, threads=self.threads,
                    dummy=s.dummy,
                )  # fmt: skip

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

    def _leave(self) -> None:
        """Bring particles that left a periodic box back, and put those beyond a limit behind the others."""
        s, planes = self._state, self.problem.planes
        if not planes:
            return
        moving = [np.stack([s.rows(name)[axis] for name in ("x", "x_half", "x_start")]) for axis in range(s.d)]
        ghosts.wrap(planes, moving, self.live)
        for axis, moved in enumerate(moving):
            for name, values in zip(("x", "x_half", "x_start"), moved, strict=True):
                s.rows(name)[axis, : self.live] = values[: self.live]
        out = ghosts.beyond_limit(planes, s.rows("x")[:, : self.live])
        if np.any(out):
            if np.all(out):
                raise Diverged(self.step, int(s.id[0]), "all particles have left the problem through its limit planes")
            s.sort(np.concatenate((np.flatnonzero(~out), np.flatnonzero(out))), self.threads)
            self.live -= int(np.count_nonzero(out))

    def _make_images(self, reach: float) -> None:
        """Images of the particles near planes, with everything that the loops read of them."""
        s = self._state
        found = ghosts.images(self.problem.planes, s.rows("x_list")[:, : self.live], reach)
        s.make_room(len(found))
        self._images = found
        at = slice(self.n, self.n + len(found))
        for name in ("mass", "h", *(["h_list"] if self._has.changing_h else [])):
            s.rows(name)[0, at] = s.rows(name)[0, found.source]
        s.material[at] = s.material[found.source]
        s.rows("x_list")[:, at] = found.sign[: s.d] * s.rows("x_list")[:, found.source] + found.shift[: s.d]
        a = self._arrays()
        z = a.z if s.d == 3 else None
        ghosts.follow_motion(0, len(found), self.n, z, found.source, found.sign, found.shift, a)
        ghosts.follow_stress(
            0, len(found), self.n, z, a.correction if self._has.correction else None, found.source, found.sign, a
        )

    def _check_energy(self) -> None:
        """An unstable step makes energy out of nothing, long before a number overflows."""
        start, now = self._start_energy, self._energies()
        given = start["kinetic"] + abs(start["internal"]) + abs(now["external_work"])
        made = measures.total(now) - measures.total(start)
        if not made <= CREATED * given:
            s, n = self._state, self.n
            kinetic = s.rows("mass")[0, :n] * np.sum(s.rows("u")[:, :n] ** 2, axis=0)
            raise Diverged(
                self.step,
                int(s.id[np.argmax(kinetic)]),
                f"the run has made {made / given:.3g} times the energy that was put in, most of it here: "
                "the step factor may be too large or the material is stretched apart",
            )

    def _broken(self) -> Diverged:
        i = int(self._progress[step.BAD])
        return Diverged(
            self.step + 1,
            int(self._state.id[i]),
            "it moved further than its smoothing length in one step, or its velocity is not a number: the step factor "
            "may be too large, two particles coincide, or the material is stretched apart",
        )

    def _failed(self) -> Diverged:
        i = int(self._progress[step.BAD])
        s = self._state
        f = np.eye(s.d) + s.rows("deformation")[:, i].reshape(s.d, s.d)
        return Diverged(
            self.step,
            int(s.id[i]),
            f"its volume is {np.linalg.det(f):.3g} and its greatest stretch {np.linalg.norm(f, 2):.3g} times that of "
            "the start: a total-Lagrangian body must stay whole, or the step factor is too large",
        )

    def _collapsed(self) -> Diverged:
        p, s, n = self.problem, self._state, self.n
        cause = "the time step collapsed"
        item = 0
        if p.apart and (found := culprit(self._arrays(), p.dimension, self.live)):
            item, why = found
            cause += f": {why}"
        elif p.step_option == 2:
            i = int(np.argmin(s.rows("nearest")[0, :n]))
            item = int(s.id[i])
            distance = math.sqrt(s.rows("nearest")[0, i])
            cause += (
                f" to {self.dt:.3g}: its nearest neighbour is only {distance:.3g} away "
                "(two particles coincide or clump)"
            )
        return Diverged(self.step, item, cause)

    # what it shows

    def _velocity(self) -> Floats:
        """(d, n) velocities at the time of the positions; with `original` those of the half step before."""
        s, n = self._state, self.n
        back = 0.0 if self.problem.original else 0.5 * float(self._progress[step.LAST])
        velocity = s.rows("u")[:, :n] + back * s.rows("a")[:, :n]
        for k in range(s.d):
            velocity[k, (s.fixed[:n] >> k) & 1 == 1] = 0.0
        return velocity

    def frame(self) -> Frame:
        """The state now, in the order of the deck."""
        arrays = measures.particles(self.problem, self._state, self._velocity()[:, : self.live], self.live)
        return Frame(time=self.time, step=self.step, particles=arrays)

    def _energies(self) -> dict[str, float]:
        return measures.energies(self.problem, self._state, self._velocity())

    def _contact_force(self) -> Floats:
        """Force [3] of all other bodies on the first one."""
        s, n = self._state, self.n
        force = np.zeros(3)
        a = self._arrays()
        if self._has.contact:
            first = s.material[:n] == 0
            force[: s.d] = (s.rows("c")[:, :n] * s.rows("mass")[0, :n] * first).sum(axis=1)
        if len(self.problem.bodies) > 1 and not self.problem.apart:
            across.interface_force(
                0, self.live, a.first, a.count, a.rows, self._shape, a.x, a.y, a.z, a.s,
                a.volume if self._mixed else a.mass, a.h,
                -(self.problem.dimension + 2.0), self._numbers.normal, a.material, 0, force,
            )  # fmt: skip
        return force

    def history(self) -> dict[str, float]:
        """One row of history.csv: energies, momentum, the contact force on the first material.

        `internal` is elastic and dissipated energy together, `dissipated` the part that plastic flow and viscosity
        took; kinetic + internal + contact_energy + contact_dissipated + artificial_energy - external_work stays
        constant.
        """
        s, n = self._state, self.n
        energies = self._energies()
        stored = {name: energies.pop(name) for name in STORED}
        momentum = np.zeros(3)
        momentum[: s.d] = (self._velocity() * s.rows("mass")[0, :n]).sum(axis=1)
        force = self._contact_force()
        plastic = s.rows("state")[PLASTIC_STRAIN, :n] if len(s.rows("state")) else np.zeros(1)
        return {
            "time": self.time,
            "dt": self.dt,
            **energies,
            **dict(zip(("momentum_x", "momentum_y", "momentum_z"), momentum.tolist(), strict=True)),
            **dict(zip(("contact_force_x", "contact_force_y", "contact_force_z"), force.tolist(), strict=True)),
            "active": float(self.live),
            **stored,
            "max_plastic_strain": float(plastic.max()),
            "step": float(self.step),
            **self._probes(),
        }

    def _probes(self) -> dict[str, float]:
        """The columns of transducers and traced particles."""
        p = self.problem
        columns = {}
        if p.transducers:
            table = np.array(p.transducers)
            found = probes.pressures(self._state, self.live, self._shape, table[:, :3], table[:, 3].astype(np.int64))
            columns = {f"pressure_{k}": value for k, value in enumerate(found.tolist(), start=1)}
        if p.traced:
            columns |= probes.traces(self._state, self.live, np.array(p.traced), self._velocity())
        return columns

    def energy_report(self) -> dict[str, float]:
        """Energies at the start and now.

        balance_error is relative to the largest of kinetic, internal and external work.
        """

        start, now = self._start_energy, self._energies()
        scale = max(start["kinetic"], now["kinetic"], abs(now["internal"]), abs(now["external_work"]), 1e-300)
        return {
            "initial": start["kinetic"] + start["internal"],
            "final": measures.total(now) + now["external_work"],
            "kinetic": now["kinetic"],
            "internal": now["internal"],
            "external_work": now["external_work"],
            "dissipated": now["dissipated"],
            "balance_error": abs(measures.total(now) - measures.total(start)) / scale,
        }

    # to be continued

    def checkpoint(self) -> dict[str, Any]:
        """Everything that another process needs to go on bit for bit, including where the neighbour list was built."""
        s, n = self._state, self.n
        data: dict[str, Any] = {name: np.array(s.rows(name)[:, :n]) for name in s.slices}
        data["live"] = self.live
        data |= {"id": s.id[:n].copy(), "material": s.material[:n].copy(), "fixed": s.fixed[:n].copy()}
        return data | {
            "progress": self._progress.copy(),
            "start_energy": np.array(list(self._start_energy.values())),
            "time": self.time,
            "step": self.step,
        }

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint of the same problem. ValueError when it is of another one."""
        s, n = self._state, self.n
        for name in s.slices:
            if name not in data or np.shape(data[name]) != s.rows(name)[:, :n].shape:
                raise ValueError(f"the checkpoint does not fit this run: {name} is missing or has another shape")
        for name in s.slices:
            s.rows(name)[:, :n] = data[name]
        for name in ("id", "material", "fixed"):
            getattr(s, name)[:n] = data[name]
        self.live = int(data["live"])
        self._progress[:] = data["progress"]
        if self.problem.body_curve is not None:
            step.body_force_at(self._progress[step.TIME], self._numbers)
        self._start_energy = dict(zip(self._start_energy, np.asarray(data["start_energy"]).tolist(), strict=True))
        self._rebuild(sort=False)
