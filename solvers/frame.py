"""A frame: what a solver shows of its state at one time, in the order of the deck."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Frame:
    """Arrays by the names of the result folder; `position` (n, 3) are the points, all others point data of n rows."""

    time: float
    step: int
    particles: dict[str, NDArray[np.float64] | NDArray[np.int64]]
