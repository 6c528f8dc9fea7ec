"""Elastic wave in a bar that meets a rigid wall, or its like (d'Alembert).

stress = rho c v from the moment of contact until the wave comes back from the free end, 2 L / c. The wave speed c is
sqrt(M / rho), M = E for a thin bar (uniaxial stress), E / (1 - nu^2) for a plate (plane strain, free sides) and
E (1 - nu) / ((1 + nu) (1 - 2 nu)) where the sides cannot move (uniaxial strain).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from .parameters import chosen, poisson_ratio, positive

_STATES = ("stress", "plate", "strain")


@dataclass(frozen=True, slots=True, kw_only=True)
class BarWave:
    """young [pressure], poisson [-], density, length of the bar.

    speed: of the bar against the wall, or half of the closing speed of two equal bars. state: stress (thin bar), plate
    or strain (sides held). distance: of a probe from the contact, for `arrival`; without it the bar's length.
    """

    young: float
    density: float
    length: float
    speed: float
    poisson: float = 0.0
    state: str = "stress"
    distance: float | None = None
    SCALARS: ClassVar = ("stress", "duration", "arrival", "wave_speed")
    CURVES: ClassVar = ("pulse",)

    def __post_init__(self) -> None:
        positive(self, "young", "density", "length", "speed")
        chosen(self, "state", _STATES)
        poisson_ratio(self)

    def wave_speed(self) -> float:
        """Of the front [speed]."""
        nu = self.poisson
        factor = {"stress": 1.0, "plate": 1 / (1 - nu**2), "strain": (1 - nu) / ((1 + nu) * (1 - 2 * nu))}[self.state]
        return math.sqrt(self.young * factor / self.density)

    def stress(self) -> float:
        """Pressure at the contact while it lasts, compression positive."""
        return self.density * self.wave_speed() * self.speed

    def duration(self) -> float:
        """Of the contact [time]."""
        return 2.0 * self.length / self.wave_speed()

    def arrival(self) -> float:
        """When the front reaches the probe [time]."""
        return (self.length if self.distance is None else self.distance) / self.wave_speed()

    def pulse(self, time: NDArray[np.float64]) -> NDArray[np.float64]:
        """Pressure at the contact against time, which begins with it; shape (n,)."""
        return np.where((time >= 0.0) & (time < self.duration()), self.stress(), 0.0)
