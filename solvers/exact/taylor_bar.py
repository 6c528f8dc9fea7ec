"""How short a rod is after it has met a rigid wall: rigid and perfectly plastic.

Wilkins and Guinan, J. Appl. Phys. 44 (1973) 1200, on Taylor's analysis of 1948: the plastic front stands at h L0 from
the wall, and the rest of the rod is stopped by the yield stress: L / L0 = (1 - h) exp(-rho v^2 / (2 Y)) + h.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from .parameters import positive


@dataclass(frozen=True, slots=True, kw_only=True)
class TaylorBar:
    """start: length before; density; yield_stress; speed of the impact; front: h above, 0.12 fits many metals."""

    start: float
    density: float
    yield_stress: float
    speed: float
    front: float = 0.12
    SCALARS: ClassVar = ("length", "ratio")
    CURVES: ClassVar = ()

    def __post_init__(self) -> None:
        positive(self, "start", "density", "yield_stress", "speed")
        if not 0.0 <= self.front < 1.0:
            raise ValueError(f"front is {self.front:g}; expected 0 or more and less than 1")

    def ratio(self) -> float:
        """Length after to length before."""
        return (1.0 - self.front) * math.exp(-self.density * self.speed**2 / (2.0 * self.yield_stress)) + self.front

    def length(self) -> float:
        """After the impact."""
        return self.start * self.ratio()
