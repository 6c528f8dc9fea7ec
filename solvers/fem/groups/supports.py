"""What stands at single nodes: elastic supports and concentrated masses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..problem import Elements
from ..shape import Shape
from ..structure import Structure
from .group import Sink

Floats = NDArray[np.float64]


class PointGroup:
    """Springs to the ground or masses of nodes (e, 1), by their values (e, 6) of each degree of freedom."""

    def __init__(self, elements: Elements, x: Floats) -> None:
        self.elements = elements
        self.x = x
        self.nodes = np.ascontiguousarray(elements.nodes, dtype=np.int64)
        values = np.zeros((len(self.nodes), 6)) if elements.value is None else np.asarray(elements.value, dtype=float)
        self.dofs = np.flatnonzero((values != 0.0).any(axis=0))
        self._values = np.ascontiguousarray(values[:, self.dofs])
        self._spring = elements.family == "spring"
        self.volume = np.zeros(len(self.nodes))
        self.energy, self._energy = np.zeros(len(self.nodes)), np.zeros(len(self.nodes))
        self._offsets = np.empty(0, np.int32)

    def bind(self, structure: Structure) -> None:
        self._offsets = structure.offsets(self.nodes)

    def _diagonal(self) -> Floats:
        c = len(self.dofs)
        matrix = np.zeros((len(self.nodes), c, c, 1, 1))
        matrix[:, np.arange(c), np.arange(c), 0, 0] = self._values
        return matrix

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        if not self._spring:
            return
        moved = shape.u[self.nodes[:, 0]][:, self.dofs]
        forces = self._values * moved
        self._energy[:] = 0.5 * (forces * moved).sum(axis=1)
        sink.add(self.nodes, self.dofs, self._offsets, np.ascontiguousarray(forces[:, :, None]), self._diagonal())

    def commit(self) -> None:
        self.energy[:] = self._energy

    def energies(self) -> tuple[float, float]:
        return float(self.energy.sum()), 0.0

    def mass(self, sink: Sink, *, lumped: Floats | None = None) -> None:
        if self._spring:
            return
        if lumped is None:
            none = np.zeros((len(self.nodes), len(self.dofs), 1))
            sink.add(self.nodes, self.dofs, self._offsets, none, self._diagonal())
            return
        for k, c in enumerate(self.dofs):
            np.add.at(lumped[:, c], self.nodes[:, 0], self._values[:, k])

    def weights(self) -> Floats:
        out = np.zeros((len(self.x), 3))
        if not self._spring:
            for k, c in enumerate(self.dofs):
                if c < 3:
                    np.add.at(out[:, c], self.nodes[:, 0], self._values[:, k])
        return out

    def output(self) -> dict[str, Floats]:
        return {"stress": np.zeros((len(self.nodes), 6))}

    def at_nodes(self) -> tuple[Floats, Floats]:
        return np.zeros((len(self.nodes), 1, 6)), self.volume

    def forget(self) -> None:
        """Nothing."""

    def state(self) -> dict[str, Floats]:
        return {"energy": self.energy}

    def restore(self, data: dict[str, Floats]) -> None:
        self.energy[:] = data["energy"]
