"""Loads that are found, not given: arc length (Crisfield 1981) and displacement control, through limit points.

All loads grow together by a factor. A step has a length: of its displacement (arc), or of one degree of freedom.
"""

from __future__ import annotations

import logging
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .assembly import Mechanism
from .equilibrium import NotConverged
from .groups.group import Bad
from .problem import Path
from .shape import Shape

if TYPE_CHECKING:
    from .solver import Solver

Floats = NDArray[np.float64]
WANTED = 6  # iterations: steps grow where it takes fewer
LONGEST = 4.0  # times the first step
log = logging.getLogger("zrno")


class PathFollowing:
    """Statics along a path of equilibrium; the solver's time counts steps, `factor` is of the loads."""

    def __init__(self, solver: Solver, path: Path) -> None:
        self.path = path
        self.factor = 0.0
        self.name = f"nonlinear static, {'displacement control' if path.controlled else 'arc length'}"
        self._length = 0.0
        self._first = 0.0
        self._last: Floats | None = None

    def take(self, solver: Solver, end: float) -> None:
        for _ in range(solver.problem.iteration.cuts + 1):
            try:
                self._step(solver)
                return
            except (NotConverged, Mechanism) as error:
                log.info("step %d: %s; a shorter step", solver.step + 1, error)
                self._length *= 0.5
                failure = error
        raise failure

    def _step(self, solver: Solver) -> None:
        a, how, p = solver.assembly, solver.problem.iteration, self.path
        start = solver.shape
        whole = solver.loads.at(solver.problem.end_time, start.u)
        unit = a.gather(whole)
        self._stiffness(solver, start, start)
        by_load = a.expand(a.solve(unit))
        mark = p.node, p.dof
        if not self._length:
            self._length = self._first = self._reach(by_load, p.first / by_load[mark])
        sign = math.copysign(1.0, p.first * by_load[mark]) if self._last is None else self._sign(by_load)
        if p.controlled:
            change = self._length / by_load[mark]
        else:
            change = sign * self._length / float(np.linalg.norm(by_load[:, :3]))
        shape, factor = start.moved(change * by_load), self.factor + change
        for iteration in range(how.most):
            internal = self._forces(solver, shape, start)
            residual = a.gather(factor * whole - internal)
            scale = max(float(np.abs(factor * whole).max()), float(np.abs(internal).max()), 1e-300)
            size = float(np.abs(residual).max(initial=0.0)) / scale
            if not math.isfinite(size):
                raise NotConverged("the forces are not finite")
            if iteration and size <= (how.force or 1e-6):
                self._accept(solver, shape, factor, factor * whole, internal, iteration)
                return
            self._stiffness(solver, shape, start)
            both = a.solve(np.asfortranarray(np.column_stack([residual, unit])))
            by_rest, by_load = a.expand(both[:, 0]), a.expand(both[:, 1])
            moved = shape.u - start.u
            if p.controlled:
                change = (self._length - moved[mark] - by_rest[mark]) / by_load[mark]
            else:
                change = self._root(moved[:, :3], by_rest[:, :3], by_load[:, :3])
            shape, factor = shape.moved(by_rest + change * by_load), factor + change
        raise NotConverged(f"no equilibrium after {how.most} iterations: the residual force is {size:.1e} of the loads")

    def _reach(self, by_load: Floats, change: float) -> float:
        """Length of the first step."""
        return self.path.first if self.path.controlled else abs(change) * float(np.linalg.norm(by_load[:, :3]))

    def _sign(self, by_load: Floats) -> float:
        assert self._last is not None
        return math.copysign(1.0, float((by_load[:, :3] * self._last).sum()))

    def _root(self, moved: Floats, by_rest: Floats, by_load: Floats) -> float:
        """The change of factor that keeps the length, of two the one that goes on along the path."""
        base = moved + by_rest
        a = float((by_load**2).sum())
        b = 2.0 * float((base * by_load).sum())
        c = float((base**2).sum()) - self._length**2
        inside = b * b - 4.0 * a * c
        if inside < 0.0:
            raise NotConverged("the arc does not meet the path")
        roots = [(-b + s * math.sqrt(inside)) / (2.0 * a) for s in (1.0, -1.0)]
        return max(roots, key=lambda x: float(((base + x * by_load) * moved).sum()))

    def _forces(self, solver: Solver, shape: Shape, start: Shape) -> Floats:
        try:
            return solver.assembly.evaluate(shape, start, 0.0, stiff=False)[0]
        except Bad as error:
            raise NotConverged(f"element {error.element}: {error.cause}") from error

    def _stiffness(self, solver: Solver, shape: Shape, start: Shape) -> None:
        try:
            solver.assembly.evaluate(shape, start, 0.0)
        except Bad as error:
            raise NotConverged(f"element {error.element}: {error.cause}") from error
        solver.assembly.factor(definite=False)

    def _accept(
        self, solver: Solver, shape: Shape, factor: float, external: Floats, internal: Floats, iterations: int
    ) -> None:
        self._last = (shape.u - solver.shape.u)[:, :3]
        self.factor = factor
        solver.iterations += iterations
        solver.accept(shape, external, internal)
        if not self.path.controlled:
            longer = self._length * math.sqrt(WANTED / iterations)
            self._length = min(longer, LONGEST * self._first)
        elif abs(self._length) < abs(self._first):
            self._length = math.copysign(min(2.0 * abs(self._length), abs(self._first)), self._first)

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
        last = np.zeros((0, 3)) if self._last is None else self._last
        return {"path": np.array([self.factor, self._length, self._first]), "last": last}

    def restore(self, data: dict[str, Floats]) -> None:
        self.factor, self._length, self._first = data["path"].tolist()
        self._last = np.array(data["last"]) if len(data["last"]) else None
