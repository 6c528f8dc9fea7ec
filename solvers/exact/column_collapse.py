"""How far a column of dry grains runs out: the scaling laws of experiments, friction plays no part; within 10 %.

Axisymmetric: Lube, Huppert, Sparks and Hallworth, J. Fluid Mech. 508 (2004) 175. Plane channel: the same authors, Phys.
Rev. E 72 (2005) 041301. With a = height / width:
    axisymmetric  (r - w) / w = 1.24 a, a < 1.7;  1.6 sqrt(a) above      h = 0.88 w a^(1/6), a >= 1
    plane         (d - w) / w = 1.2 a,  a < 1.8;  1.9 a^(2/3) above      h = 0.65 w a^(2/5), a >= 1.15
The plane law has a transition between 1.8 and 2.8; here its upper branch starts at 1.8.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from .parameters import chosen, positive


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnCollapse:
    """height, width (radius, or length behind the gate) of the column; geometry: plane or axisymmetric; gravity."""

    height: float
    width: float
    geometry: str = "plane"
    gravity: float = 9.80665
    SCALARS: ClassVar = ("run_out", "final_height", "time")
    CURVES: ClassVar = ()

    def __post_init__(self) -> None:
        positive(self, "height", "width", "gravity")
        chosen(self, "geometry", ("plane", "axisymmetric"))

    def _aspect(self) -> float:
        return self.height / self.width

    def run_out(self) -> float:
        """Radius or length of the heap at rest."""
        a = self._aspect()
        if self.geometry == "plane":
            growth = 1.2 * a if a < 1.8 else 1.9 * a ** (2 / 3)
        else:
            growth = 1.24 * a if a < 1.7 else 1.6 * math.sqrt(a)
        return self.width * (1.0 + growth)

    def final_height(self) -> float:
        """Of the heap at rest; a low column keeps its height."""
        a = self._aspect()
        least, factor, power = (1.15, 0.65, 2 / 5) if self.geometry == "plane" else (1.0, 0.88, 1 / 6)
        return self.height if a < least else factor * self.width * a**power

    def time(self) -> float:
        """Until the front stands."""
        return (3.3 if self.geometry == "plane" else 3.0) * math.sqrt(self.height / self.gravity)
