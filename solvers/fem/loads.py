"""External forces (n, 6) at a time: patterns that are found once and scaled by curves, and pressure that follows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .elements import shapes
from .groups.group import Group
from .groups.timed import TimedGroup
from .problem import FaceLoad, Problem

Floats = NDArray[np.float64]


class Loads:
    """What acts on a structure."""

    def __init__(self, problem: Problem, groups: Sequence[Group]) -> None:
        self.problem = problem
        self.contact: Floats | None = None  # (n, 6) forces of what touches the structure, in this step
        self._timed: list[tuple[TimedGroup, int | None, Floats]] = []  # weight of elements that come and go
        self._patterns: dict[tuple[int | None, float], Floats] = {}
        self.followers = tuple(load for load in problem.face_loads if load.follows and load.direction == 0)
        radius = _radii(problem)
        for load in problem.nodal_loads:
            pattern = self._pattern(load.curve, load.shift)
            values = load.values if radius is None else load.values * radius[load.nodes]
            np.add.at(pattern, (load.nodes, load.dofs), values)
        for face in problem.face_loads:
            if face not in self.followers:
                self._pattern(face.curve)[:, :3] += face_forces(face, problem.x, len(problem.x))
        for body in problem.body_loads:
            for group in groups:
                if body.materials is None or group.elements.material in body.materials:
                    own = group.weights() * body.acceleration
                    if isinstance(group, TimedGroup):
                        self._timed.append((group, body.curve, own))
                    else:
                        self._pattern(body.curve)[:, :3] += own

    def _pattern(self, curve: int | None, shift: float = 0.0) -> Floats:
        n = len(self.problem.x)
        return self._patterns.setdefault((curve, shift), np.zeros((n, 6)))

    def patterns(self) -> list[tuple[int | None, float, Floats]]:
        """Curve, shift of its time, and forces of each pattern."""
        return [(curve, shift, values) for (curve, shift), values in self._patterns.items()]

    def factor(self, curve: int | None, time: float) -> float:
        """Of a curve at a time; 1 without a curve."""
        return 1.0 if curve is None else self.problem.curves[curve](time)

    def at(self, time: float, u: Floats) -> Floats:
        """Forces at a time; u: (n, 6) displacement, for the pressure that follows."""
        total = np.zeros((len(self.problem.x), 6)) if self.contact is None else self.contact.copy()
        for (curve, shift), values in self._patterns.items():
            total += self.factor(curve, time + shift) * values
        for group, curve, weight in self._timed:
            if group.lives(time):
                total[:, :3] += self.factor(curve, time) * weight
        for face in self.followers:
            factor = self.factor(face.curve, time)
            if factor:
                total[:, :3] += factor * face_forces(face, self.problem.x + u[:, :3], len(total))
        return total


def _radii(problem: Problem) -> Floats | None:
    """Of nodes of an axisymmetric problem: there a nodal load is a force per unit of the circumference."""
    return problem.x[:, 0] if any(e.plane == "axisymmetric" for e in problem.elements) else None


def face_forces(load: FaceLoad, x: Floats, count: int) -> Floats:
    """Nodal forces (count, 3) of a pressure or traction on faces, at the places x (count, 3) of the nodes.

    On edges of plane elements pressure acts to the left of the way from the first to the second node.
    """
    table = shapes.table(load.kind, full=True)
    corners = x[load.nodes]
    tangents = np.einsum("gkd,fki->fgdi", table.slopes, corners)
    if tangents.shape[2] == 2:
        normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    else:
        thickness = np.ones(len(corners)) if load.thickness is None else load.thickness
        normal = np.cross(tangents[:, :, 0], [0.0, 0.0, 1.0]) * thickness[:, None, None]
        if load.plane == "axisymmetric":
            normal *= np.einsum("gk,fk->fg", table.values, corners[:, :, 0])[:, :, None]
    value = np.einsum("gk,fk->fg", table.values, load.values) * table.weights
    if load.direction == 0:
        flux = -value[:, :, None] * normal
    else:
        flux = np.zeros_like(normal)
        flux[:, :, load.direction - 1] = value * np.linalg.norm(normal, axis=2)
    own = np.einsum("gk,fgi->fki", table.values, flux)
    total = np.zeros((count, 3))
    for i in range(3):
        total[:, i] = np.bincount(load.nodes.ravel(), own[:, :, i].ravel(), minlength=count)
    return total
