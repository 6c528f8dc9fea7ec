"""Behind a plane shock of a solid with Us = c0 + s up: the Rankine-Hugoniot relations, from a state of rest.

P = rho0 Us up, rho = rho0 Us / (Us - up), e = up^2 / 2. Mie and Grueneisen's equation of state with this Hugoniot as
its reference meets them, whatever its gamma.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .parameters import positive


@dataclass(frozen=True, slots=True, kw_only=True)
class Hugoniot:
    """density at rest; c0 [speed] and slope [-] of the shock's speed; speed: of the particles behind it."""

    density: float
    c0: float
    slope: float
    speed: float
    SCALARS: ClassVar = ("pressure", "shock_speed", "shocked_density", "energy")
    CURVES: ClassVar = ()

    def __post_init__(self) -> None:
        positive(self, "density", "c0", "slope", "speed")

    def shock_speed(self) -> float:
        """Us."""
        return self.c0 + self.slope * self.speed

    def pressure(self) -> float:
        """Compression positive."""
        return self.density * self.shock_speed() * self.speed

    def shocked_density(self) -> float:
        """Behind the shock."""
        return self.density * self.shock_speed() / (self.shock_speed() - self.speed)

    def energy(self) -> float:
        """Internal, per mass."""
        return 0.5 * self.speed**2
