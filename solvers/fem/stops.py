"""Rigid planes that nodes cannot pass: smooth, without tension; a penalty that is a multiple of the structure's own
stiffness at each node, so that what is given way to gets finer with the mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .groups.group import Sink
from .problem import Stop
from .structure import Structure

Floats = NDArray[np.float64]
_AXES = np.arange(3)


class Stops:
    """The planes of a problem. x: (n, 3) of the nodes at the start; nodes: those that have elements."""

    def __init__(self, planes: Sequence[Stop], x: Floats, nodes: NDArray[np.int64]) -> None:
        self.x = x[nodes]
        self.nodes = nodes
        self.places = np.array([plane.position for plane in planes]).reshape(-1, 3)
        normals = np.array([plane.normal for plane in planes]).reshape(-1, 3)
        self.normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        self.factors = np.array([plane.stiffness for plane in planes])
        self.stiffness = np.zeros((len(planes), len(nodes)))
        self._offsets = np.empty(0, np.int32)

    def bind(self, structure: Structure, diagonal: Floats) -> None:
        """To a matrix. diagonal: (n, 6) the structure's own stiffness."""
        self._offsets = structure.offsets(self.nodes[:, None])
        self.stiffness = self.factors[:, None] * (self.normals**2 @ diagonal[self.nodes, :3].T)

    def evaluate(self, u: Floats, sink: Sink, *, closed: bool = False) -> None:
        """Add what the planes push back with (as forces of stresses) and its stiffness. closed: as if all touched."""
        for k, normal in enumerate(self.normals):
            gap = self._gap(k, u)
            touching = np.flatnonzero((gap <= 0.0) | closed)
            if not len(touching):
                continue
            own = self.stiffness[k, touching]
            forces = (own * np.minimum(gap[touching], 0.0))[:, None] * normal
            matrix = (own[:, None, None] * np.outer(normal, normal))[:, :, :, None, None]
            sink.add(self.nodes[touching, None], _AXES, self._offsets[touching],
                     np.ascontiguousarray(forces[:, :, None]), np.ascontiguousarray(matrix))  # fmt: skip

    def energy(self, u: Floats) -> float:
        """What the planes hold, as springs do."""
        planes = range(len(self.normals))
        return sum(0.5 * float(self.stiffness[k] @ np.minimum(self._gap(k, u), 0.0) ** 2) for k in planes)

    def force(self, u: Floats) -> Floats:
        """(3,) of all planes on the structure."""
        total = np.zeros(3)
        for k, normal in enumerate(self.normals):
            total -= float(self.stiffness[k] @ np.minimum(self._gap(k, u), 0.0)) * normal
        return total

    def _gap(self, k: int, u: Floats) -> Floats:
        out: Floats = (self.x + u[self.nodes, :3] - self.places[k]) @ self.normals[k]
        return out
