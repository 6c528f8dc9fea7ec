"""The shape of a structure: displacements, and the rotations of nodes where they are finite."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel

Floats = NDArray[np.float64]


@dataclass(slots=True)
class Shape:
    """u: (n, 6) displacements and rotations; turn: (n, 3, 3) rotation of each node, or None where they are small.

    Rotations in u are sums of the increments' vectors: with finite ones they are for output alone.
    """

    u: Floats
    turn: Floats | None = None

    def moved(self, change: Floats) -> Shape:
        """This shape after a change (n, 6): rotation vectors in space, as in Newton's method."""
        turn = None if self.turn is None else np.empty_like(self.turn)
        if turn is not None:
            _turned(self.turn, np.ascontiguousarray(change[:, 3:]), turn)
        return Shape(self.u + change, turn)

    def copy(self) -> Shape:
        """Of its own arrays."""
        return Shape(self.u.copy(), None if self.turn is None else self.turn.copy())


@kernel
def rotation(x, y, z, out):
    """exp of a rotation vector (Rodrigues), into (3, 3)."""
    square = x * x + y * y + z * z
    angle = np.sqrt(square)
    if angle > 1e-4:
        a = np.sin(angle) / angle
        b = (1.0 - np.cos(angle)) / square
    else:
        a = 1.0 - square / 6.0
        b = 0.5 - square / 24.0
    out[0, 0] = 1.0 - b * (y * y + z * z)
    out[0, 1] = b * x * y - a * z
    out[0, 2] = b * x * z + a * y
    out[1, 0] = b * x * y + a * z
    out[1, 1] = 1.0 - b * (x * x + z * z)
    out[1, 2] = b * y * z - a * x
    out[2, 0] = b * x * z - a * y
    out[2, 1] = b * y * z + a * x
    out[2, 2] = 1.0 - b * (x * x + y * y)


@kernel
def _turned(turn, vectors, out):
    step = np.empty((3, 3))
    for k in range(turn.shape[0]):
        rotation(vectors[k, 0], vectors[k, 1], vectors[k, 2], step)
        for i in range(3):
            for j in range(3):
                total = 0.0
                for m in range(3):
                    total += step[i, m] * turn[k, m, j]
                out[k, i, j] = total
