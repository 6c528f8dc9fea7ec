"""A frame: what a solver shows of its state at one time, in the order of the deck."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True, slots=True)
class Cells:
    """Elements of one kind. nodes: (e, n) indices into the frame's nodes, VTK's order; data: (e, ...) by name."""

    kind: str
    nodes: NDArray[np.int64]
    data: Arrays


@dataclass(frozen=True, slots=True)
class Frame:
    """Arrays by the names of the result folder.

    particles: `position` (n, 3) are the points, all others point data of n rows; empty without particles. nodes: the
    same of finite element nodes, and cells: their elements, of which each kind has the same arrays.
    """

    time: float
    step: int
    particles: Arrays
    nodes: Arrays = field(default_factory=dict)
    cells: Sequence[Cells] = ()
