"""A column at rest under its own weight: pressure = rho g (top - z), no shear at its sides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from .parameters import positive


@dataclass(frozen=True, slots=True, kw_only=True)
class Hydrostatic:
    """density, gravity (its amount), height of the column, top: coordinate of its free face (without it the height)."""

    density: float
    gravity: float
    height: float
    top: float | None = None
    SCALARS: ClassVar = ("bottom", "mean")
    CURVES: ClassVar = ("pressure", "stress")

    def __post_init__(self) -> None:
        positive(self, "density", "gravity", "height")

    def bottom(self) -> float:
        """Pressure at the foot."""
        return self.density * self.gravity * self.height

    def mean(self) -> float:
        """Pressure, averaged over the column."""
        return 0.5 * self.bottom()

    def pressure(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """At coordinates along the column, compression positive, shape (n,); zero above the top."""
        top = self.height if self.top is None else self.top
        return np.maximum(0.0, self.density * self.gravity * (top - z))

    def stress(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """Along the column, tension positive, as in frames; shape (n,)."""
        return -self.pressure(z)
