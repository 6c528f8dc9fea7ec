"""Factors of half the digits, in half the memory and half the time, made good by conjugate gradients.

The single precision factors precondition conjugate gradients on the matrix itself in double precision (Buttari,
Dongarra, Kurzak, Luszczek & Tomov 2008). With M such factors and r the residual, r M^-1 r is the square of the error's
energy to the factors' own few digits: what stops the iteration is an error, not a residual.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .libraries import Pardiso, Singular
from .structure import dot

if TYPE_CHECKING:
    from .linear import System

Floats = NDArray[np.float64]
TOLERANCE = 1e-10  # of the error's energy norm before the last change, which takes two more digits
MOST = 20  # changes; where they do not suffice, single precision has too few digits for the matrix
PATIENCE = 4  # right sides: from there on factors of all digits are cheaper


class TooFewDigits(ArithmeticError):
    """Single precision does not carry this matrix."""


class Mixed:
    """Single precision factors by PARDISO, and conjugate gradients."""

    name = "pardiso"

    def __init__(self, system: System) -> None:
        self._system = system
        self._factors = Pardiso(system, single=True)
        self.answered = 0  # right sides

    def factor(self, values: Floats) -> None:
        self.answered = 0
        try:
            self._factors.factor(values)
        except Singular as error:
            raise TooFewDigits("a pivot is zero or negative") from error

    def solve(self, right: Floats) -> Floats:
        """Raises TooFewDigits."""
        if right.ndim == 2:
            return np.column_stack([self.solve(column) for column in right.T])
        self.answered += 1
        x, left = np.zeros_like(right), right.copy()
        largest = float(np.abs(right).max(initial=0.0))
        if largest == 0.0:
            return x
        direction, before = x, 1.0
        for k in range(MOST):
            answer = self._factors.solve(left / largest) * largest  # what is left may be below single precision's range
            size = dot(left, answer)
            if not size >= 0.0:
                break
            if size == 0.0:
                return x
            direction = answer + (size / before if k else 0.0) * direction
            image = self._system.product(direction)
            curvature = dot(direction, image)
            if not curvature > 0.0:
                break
            step = size / curvature
            x += step * direction
            left -= step * image
            before = size
            if math.sqrt(size) <= TOLERANCE * math.sqrt(abs(dot(x, right))):
                return x
            largest = float(np.abs(left).max())
            if largest == 0.0:
                return x
        raise TooFewDigits(f"more than {MOST} iterations")
