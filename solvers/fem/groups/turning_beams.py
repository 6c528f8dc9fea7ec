"""Beams of any displacement and rotation, elastic and little strained: those of small displacements in turning frames.

They go by `elements.corotational`. What bends between two nodes is small, so that a beam that curls needs some elements
a radian: a circle by ten is within 1 %.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..elements.corotational import deformation, geometric
from ..shape import Shape
from .beams import BeamGroup
from .group import Sink

Floats = NDArray[np.float64]


class TurningBeamGroup(BeamGroup):
    """A group of beams with finite rotation; see `group.Group`. Their masses are alike in all directions."""

    def _at(self, shape: Shape) -> tuple[Floats, Floats, Floats, Floats]:
        assert shape.turn is not None
        places = (self.x + shape.u[:, :3])[self.nodes]
        return places, shape.turn[self.nodes], self._turn, self.length

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        at = self._at(shape)
        local, rows, _ = deformation(*at)
        stretched = local if self._growth is None else local - self._growth[:, None] * (np.arange(12) == 6)
        self._trial[:] = np.einsum("epq,eq->ep", self._local, stretched)
        if self._growth is None:
            self._energy[:] = 0.5 * (local * self._trial).sum(axis=1)
        else:
            step = local - deformation(*self._at(before))[0]
            self._energy[:] = self.energy + 0.5 * (step * (self.forces + self._trial)).sum(axis=1)
        own = np.einsum("eqi,eq->ei", rows, self._trial).reshape(-1, 2, 6)
        matrix = None
        if sink.stiff:
            stiff = np.einsum("epi,epq,eqj->eij", rows, self._local, rows) + geometric(*at, self._trial)
            matrix = np.ascontiguousarray(stiff.reshape(-1, 2, 6, 2, 6).transpose(0, 2, 4, 1, 3))
        sink.add(self.nodes, self.dofs, self._offsets, np.ascontiguousarray(own.transpose(0, 2, 1)), matrix)

    def _consistent(self, mass: Floats, polar: Floats) -> Floats:
        """(e, 6, 6, 2, 2), by straight lines between the ends."""
        own = np.column_stack([mass, mass, mass, polar, polar, polar])
        both = (np.ones((2, 2)) + np.eye(2)) / 6.0
        return np.ascontiguousarray(own[:, :, None, None, None] * np.eye(6)[:, :, None, None] * both)
