"""A structure whose motion is given: nothing is solved.

Where all translations are prescribed or held the nodes go there; otherwise the structure is a rigid body that moves as
those of its nodes that are, by least squares (rotation by Gauss-Newton). What pushes it is held wherever it acts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .equilibrium import NotConverged
from .procedures import Still
from .shape import Shape

if TYPE_CHECKING:
    from .solver import Solver

Floats = NDArray[np.float64]
ITERATIONS = 30
EXACT = 1e-12  # of the structure's size: a change of the motion below which it is found
RIGID = 1e-3  # of the same: prescribed motions further apart are no rigid body's


class Guided(Still):
    """The motion of a structure that is rigid, or of which every node is guided."""

    name = "motion is given"

    def __init__(self, solver: Solver) -> None:
        a = solver.assembly
        self._given = (a.prescribed | solver.problem.fixed)[:, :3] & a.active_before_fixing[:, :3]
        self._everywhere = bool((self._given | ~a.active_before_fixing[:, :3]).all())
        self._target = np.zeros((solver.n, 3))
        self._turn = np.zeros(3)
        self._shift = np.zeros(3)

    def take(self, solver: Solver, end: float) -> None:
        self._target = self._target + solver.prescribed(solver.time, end, end)[:, :3]
        u = np.zeros((solver.n, 6))
        u[:, :3] = np.where(self._given, self._target, 0.0) if self._everywhere else self._rigid(solver.problem.x)
        u[:, 3:] = self._turn
        solver.shape = Shape(u, None)
        solver.hold(solver.loads.at(end, u))

    def _rigid(self, x: Floats) -> Floats:
        """(n, 3) displacements of the rigid body."""
        from scipy.spatial.transform import Rotation

        middle = x.mean(axis=0)
        arm = x - middle
        size = float(np.abs(arm).max())
        rows = np.flatnonzero(self._given.ravel())
        for _ in range(ITERATIONS if len(rows) else 0):
            turned = Rotation.from_rotvec(self._turn).apply(arm)
            left = (self._target - (self._shift + turned - arm)).ravel()[rows]
            slopes = np.zeros((len(x), 3, 6))
            slopes[:, range(3), range(3)] = 1.0
            for axis in range(3):
                slopes[:, :, 3 + axis] = np.cross(np.eye(3)[axis], turned)
            change = np.linalg.lstsq(slopes.reshape(-1, 6)[rows], left, rcond=1e-10)[0]
            self._shift = self._shift + change[:3]
            self._turn = (Rotation.from_rotvec(change[3:]) * Rotation.from_rotvec(self._turn)).as_rotvec()
            if max(np.abs(change[:3]).max(), size * np.abs(change[3:]).max()) < EXACT * size:
                break
        moved = self._shift + Rotation.from_rotvec(self._turn).apply(arm) - arm
        left = np.where(self._given, self._target - moved, 0.0)
        worst = int(np.argmax(np.abs(left)))
        if abs(left.ravel()[worst]) > RIGID * size:
            raise NotConverged("the prescribed motions are not those of a rigid body", divmod(worst, 3))
        out: Floats = moved
        return out

    def state(self) -> dict[str, Floats]:
        return {"target": self._target, "turned": self._turn, "shift": self._shift}

    def restore(self, data: dict[str, Floats]) -> None:
        self._target, self._turn, self._shift = (np.array(data[name]) for name in ("target", "turned", "shift"))
