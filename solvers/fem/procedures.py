"""How a structure gets from one step to the next: superposition, increments, vibrations, explicit steps.

Each procedure moves the solver's shape to the end of a step; the solver keeps the books.
"""

from __future__ import annotations

import logging
import math
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from .assembly import Mechanism
from .equilibrium import NotConverged, Scale, Target, equilibrium
from .groups.group import Bad
from .implicit import Integrator
from .shape import Shape

if TYPE_CHECKING:
    import scipy.sparse as sp

    from .solver import Solver

Floats = NDArray[np.float64]
log = logging.getLogger("zrno")


WARY = 20  # steps without a guess after one that went wrong


class Procedure(Protocol):
    """What the solver asks of a procedure. name: for the log."""

    name: str

    def take(self, solver: Solver, end: float) -> None:
        """To the end of the next step. Raises NotConverged, Mechanism."""

    def velocity(self, solver: Solver) -> Floats | None:
        """(n, 6) at the shape's time; None of a static procedure."""

    def kinetic(self, solver: Solver) -> float:
        """Kinetic energy."""

    def momentum(self, solver: Solver) -> Floats:
        """Linear momentum (3,)."""

    def jump(self, change: Floats) -> Floats:
        """Loads change at once by `change` (n, 6): accelerations do too, displacements and velocities do not.

        Returns the change of the forces of inertia (n, 6).
        """

    def forget(self) -> None:
        """What only speeds up the next step: a resumed run does not have it, so one that goes on drops it too."""

    def state(self) -> dict[str, Floats]:
        """What a checkpoint keeps beside the shape; `restore` takes it."""

    def restore(self, data: dict[str, Floats]) -> None:
        """Go on from a checkpoint."""


class Still:
    """What all static procedures share."""

    def velocity(self, solver: Solver) -> Floats | None:
        return None

    def kinetic(self, solver: Solver) -> float:
        return 0.0

    def momentum(self, solver: Solver) -> Floats:
        return np.zeros(3)

    def jump(self, change: Floats) -> Floats:
        return np.zeros_like(change)

    def forget(self) -> None:
        """Nothing."""

    def state(self) -> dict[str, Floats]:
        return {}

    def restore(self, data: dict[str, Floats]) -> None:
        """Nothing."""


class Superposition(Still):
    """Linear statics: the answers to each pattern of loads and motions are found once, and scaled by their curves."""

    name = "linear static"

    def __init__(self) -> None:
        self._patterns: list[tuple[int | None, float, Floats, Floats]] | None = None
        self._stiffness: sp.csr_matrix | None = None  # of all degrees of freedom, held ones too

    def take(self, solver: Solver, end: float) -> None:
        if self._patterns is None:
            self._patterns = self._answers(solver)
        u, external = np.zeros((solver.n, 6)), np.zeros((solver.n, 6))
        for curve, shift, forces, answer in self._patterns:
            factor = solver.loads.factor(curve, end + shift)
            u += factor * answer
            external += factor * forces
        contact = solver.loads.contact
        if contact is None:
            shape = Shape(u)
            internal, _ = solver.assembly.evaluate(shape, solver.shape, 0.0, stiff=False)
            solver.accept(shape, external, internal)
            return
        a = solver.assembly
        zero = Shape(np.zeros((solver.n, 6)))
        if not a.system.factored:
            a.evaluate(zero, zero, 0.0)
            a.factor()
        if self._stiffness is None:  # a step under new forces then costs a product, no look at each element
            self._stiffness = a.full_matrix("stiffness", zero)
        u += a.expand(a.solve(a.gather(contact)))
        internal = (self._stiffness @ u.ravel()).reshape(u.shape)
        solver.accept(Shape(u), external + contact, internal, seen=False)

    def forget(self) -> None:
        self._patterns, self._stiffness = None, None

    def _answers(self, solver: Solver) -> list[tuple[int | None, float, Floats, Floats]]:
        a, zero = solver.assembly, Shape(np.zeros((solver.n, 6)))
        motions: dict[int | None, Floats] = {}
        for m in solver.problem.motions:
            motions.setdefault(m.curve, np.zeros((solver.n, 6)))[m.nodes, m.dofs] = m.values
        cases = solver.loads.patterns()
        a.evaluate(zero, zero, 0.0)
        a.factor(answers=len(cases) + len(motions))
        answers = []
        if cases:
            right = np.column_stack([a.gather(forces) for _, _, forces in cases])
            found = a.solve(np.asfortranarray(right))
            answers = [(*case, a.expand(found[:, k])) for k, case in enumerate(cases)]
        for curve, motion in motions.items():
            _, of_motion = a.evaluate(zero, zero, 0.0, moved=motion)
            answers.append((curve, 0.0, np.zeros((solver.n, 6)), a.expand(a.solve(-a.gather(of_motion))) + motion))
        if solver.loads.contact is None:
            a.system.release()  # before the stresses take theirs
        return answers


class Vibrations(Still):
    """Free vibrations: each step shows a mode, its largest displacement 1; time counts them."""

    name = "vibrations"

    def __init__(self) -> None:
        self._found: tuple[Floats, Floats] | None = None
        self.frequency = 0.0

    def take(self, solver: Solver, end: float) -> None:
        p = solver.problem
        if self._found is None:
            from .eigen import vibrations

            lumped = bool(p.dynamics and p.dynamics.lumped)
            self._found = vibrations(solver.assembly, p.modes, lumped=lumped)
        squares, modes = self._found
        k = min(round(end), len(squares)) - 1
        mode = modes[k] / max(float(np.abs(modes[k][:, :3]).max()), 1e-300)
        self.frequency = math.sqrt(max(squares[k], 0.0)) / (2.0 * math.pi)
        solver.shape = Shape(mode, solver.assembly.still)


class Increments(Still):
    """Newton's method step by step, static or (with an integrator) in motion; steps are halved where it fails."""

    def __init__(self, solver: Solver) -> None:
        self.mover: Integrator | None = None
        self._kept = 0.0  # the step whose factors are there, of a linear structure
        self._before: tuple[Floats, Floats, float] | None = None  # the last change, what of it was prescribed, its step
        self._growth: Floats | None = None  # how much that change was larger than the one before it
        self._scale = Scale()  # of the last step
        self._wary = 0  # steps to come that are not guessed, since a guess went wrong
        p = solver.problem
        self.name = f"{'linear' if solver.linear else f'nonlinear ({p.iteration.method})'} static"
        if p.dynamics is not None:
            self.mover = Integrator(solver.assembly, p.dynamics, solver.shape, p.velocity)
            self.mover.begin(solver.external_forces - solver.internal_forces)
            self.name = f"{'linear' if solver.linear else f'nonlinear ({p.iteration.method})'} {p.dynamics.method}"

    def take(self, solver: Solver, end: float) -> None:
        how = solver.problem.iteration
        now, length = solver.time, end - solver.time
        smallest = length / 2**how.cuts
        while now < end - 0.5 * smallest:
            until = min(now + length, end)
            try:
                self._part(solver, now, until, end)
            except (NotConverged, Mechanism) as error:
                if length <= 1.5 * smallest:
                    raise
                length *= 0.5
                log.info("step %d: %s; cut to %g", solver.step + 1, error, length)
                continue
            now = until
            length = min(2.0 * length, end - now) if now < end else length

    def _part(self, solver: Solver, now: float, until: float, end: float) -> None:
        dt, mover = until - now, self.mover
        change = solver.prescribed(now, until, end)
        changed = solver.assembly.at(until, solver.shape)
        if changed:
            self._before = None
        if solver.assembly.idle.any():
            self._loose(solver, until)
        if mover is None:
            target = Target(change, lambda s: solver.loads.at(until, s.u))
        else:
            reach = now + mover.theta * dt
            target = mover.target(solver.shape, change * mover.theta, lambda s: solver.loads.at(reach, s.u),
                                  mover.theta * dt)  # fmt: skip
        keep = solver.linear and self._kept > 0.0
        if keep and mover is not None:  # inertia is in the factors; enhanced strains need a matrix to grow by warmth
            keep = solver.assembly.heat is None and math.isclose(self._kept, dt, rel_tol=1e-9)
        guess = None if keep else self._guess(change, dt)
        how = solver.problem.iteration
        try:
            shape, internal, trace = equilibrium(
                solver.assembly, solver.shape, target, dt, how, keep=keep, guess=guess, scale=self._scale
            )
        except (NotConverged, Mechanism):
            self._before = None
            if guess is None:
                raise
            self._wary = WARY
            shape, internal, trace = equilibrium(
                solver.assembly, solver.shape, target, dt, how, keep=keep, scale=self._scale
            )
        self._scale = trace.scale
        self._kept = dt if solver.linear else 0.0
        last = shape.u - solver.shape.u
        self._growth = None if guess is None or self._before is None else last - dt / self._before[2] * self._before[0]
        self._before = (last, change, dt)
        solver.iterations += len(trace.residuals)
        log.debug("t = %g: residuals %s", until, " ".join(f"{r:.1e}" for r in trace.residuals))
        if mover is None:
            if changed:
                solver.released(shape, dt)
            solver.accept(shape, solver.loads.at(until, shape.u), internal)
            return
        if mover.theta != 1.0:
            moved = mover.interpolated(shape.u - solver.shape.u, dt)
            shape = solver.shape.moved(np.where(solver.assembly.active, moved, 0.0))
            internal, _ = solver.assembly.evaluate(shape, solver.shape, dt, stiff=False)
        external = solver.loads.at(until, shape.u)
        if mover.theta == 1.0:
            mover.finish(shape.u - solver.shape.u, external - internal, dt)
        solver.accept(shape, external, internal, mover.inertia(mover.acceleration), mover.damping(mover.velocity),
                      duration=dt)  # fmt: skip

    def _loose(self, solver: Solver, until: float) -> None:
        """Raise Mechanism where a load acts on a node whose elements are not there."""
        loose = solver.assembly.idle & (solver.loads.at(until, solver.shape.u) != 0.0)
        if loose.any():
            node, dof = np.argwhere(loose)[0].tolist()
            raise Mechanism(node, dof, "a load acts where no element is there yet or any more")

    def _guess(self, change: Floats, dt: float) -> Floats | None:
        """The last step's change once more, and grown as it grew, where prescribed motion goes on as it went.

        Without the growth a plate that turns would be stretched by the square of the step's angle. None elsewhere.
        """
        if self._before is None or self.mover is not None:
            return None
        if self._wary:
            self._wary -= 1
            return None
        last, prescribed, before = self._before
        share = dt / before
        if not np.allclose(change, share * prescribed, rtol=1e-9, atol=1e-12 * float(np.abs(change).max(initial=0.0))):
            return None
        return share * last if self._growth is None else share * last + share * share * self._growth

    def velocity(self, solver: Solver) -> Floats | None:
        return None if self.mover is None else self.mover.velocity

    def kinetic(self, solver: Solver) -> float:
        return 0.0 if self.mover is None else self.mover.kinetic()

    def momentum(self, solver: Solver) -> Floats:
        return np.zeros(3) if self.mover is None else self.mover.momentum()

    def jump(self, change: Floats) -> Floats:
        return np.zeros_like(change) if self.mover is None else self.mover.jump(change)

    def forget(self) -> None:
        self._before, self._kept, self._wary = None, 0.0, 0

    def state(self) -> dict[str, Floats]:
        m = self.mover
        moving = {} if m is None else {"velocity": m.velocity, "acceleration": m.acceleration, "last": m.last}
        return {"scale": np.array([self._scale.force, self._scale.energy]), **moving}

    def restore(self, data: dict[str, Floats]) -> None:
        self._scale = Scale(*np.asarray(data["scale"]).tolist())
        if self.mover is not None:
            for name in ("velocity", "acceleration", "last"):
                setattr(self.mover, name, np.array(data[name]))


class Explicit:
    """Central differences, as many stable steps as a step of the problem takes."""

    name = "central differences"

    def __init__(self, solver: Solver) -> None:
        from .explicit import Stepper

        assert solver.problem.dynamics is not None
        self.stepper = Stepper(solver.assembly, solver.problem.dynamics, solver.shape, solver.problem.velocity)

    def take(self, solver: Solver, end: float) -> None:
        start = solver.time
        parts = self.stepper.parts(end - start)
        if solver.step == 0:
            log.info("the stable step is %g: %d to a step of the deck", self.stepper.stable, parts)
        for k in range(parts):
            now, until = (start + (end - start) * (k + i) / parts for i in (0, 1))
            change = self.stepper.change(solver.external_forces - solver.internal_forces, until - now)
            shape = solver.shape.moved(change + solver.prescribed(now, until, end))
            try:
                internal, _ = solver.assembly.evaluate(shape, solver.shape, until - now, stiff=False)
            except Bad as error:
                raise NotConverged(f"element {error.element}: {error.cause}") from error
            if not np.isfinite(internal).all():
                bad = divmod(int(np.argmin(np.isfinite(internal).ravel())), 6)
                raise NotConverged("the forces are not finite: the step is above the stable one", bad)
            solver.accept(shape, solver.loads.at(until, shape.u), internal)

    def velocity(self, solver: Solver) -> Floats | None:
        return self.stepper.at_shape(solver.external_forces - solver.internal_forces)

    def kinetic(self, solver: Solver) -> float:
        return self.stepper.kinetic(solver.external_forces - solver.internal_forces)

    def momentum(self, solver: Solver) -> Floats:
        velocity = self.velocity(solver)
        assert velocity is not None
        out: Floats = (self.stepper.diagonal * velocity)[:, :3].sum(axis=0)
        return out

    def jump(self, change: Floats) -> Floats:
        """Each step begins with the forces that there are."""
        return np.where(self.stepper.assembly.free, change, 0.0)

    def forget(self) -> None:
        """Nothing."""

    def state(self) -> dict[str, Floats]:
        return {"velocity": self.stepper.velocity, "half": np.array(self.stepper.half)}

    def restore(self, data: dict[str, Floats]) -> None:
        self.stepper.velocity, self.stepper.half = np.array(data["velocity"]), float(data["half"])
