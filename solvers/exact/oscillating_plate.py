"""Free vibration of a thin plate that is clamped at one end (Landau and Lifshitz, Theory of Elasticity, section 25).

Plane strain: omega^2 = E H^2 k^4 / (12 rho (1 - nu^2)), with cos(kL) cosh(kL) = -1, kL = 1.875104 in the first mode. A
test of particle methods since Gray, Monaghan and Swift (2001). It neglects shear and rotary inertia: at H / L = 0.1 a
real plate is 0.8 to 1 % slower. `thick_period` has both, by Timoshenko's beam: Huang, J. Appl. Mech. 28 (1961) 579, eq.
of the clamped and free one, shear coefficient 5/6, plane strain.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from .parameters import poisson_ratio, positive

_FIRST_MODE = 1.8751040687119611
_SHEAR = 5.0 / 6.0  # of a rectangle


@dataclass(frozen=True, slots=True, kw_only=True)
class OscillatingPlate:
    """length L from the clamp, thickness H, young [pressure], poisson [-], density."""

    length: float
    thickness: float
    young: float
    poisson: float
    density: float
    SCALARS: ClassVar = ("period", "omega", "thick_period")
    CURVES: ClassVar = ()

    def __post_init__(self) -> None:
        positive(self, "length", "thickness", "young", "density")
        poisson_ratio(self)

    def omega(self) -> float:
        """Angular frequency of the first mode [1/time]."""
        k = _FIRST_MODE / self.length
        return self.thickness * k**2 * math.sqrt(self.young / (12.0 * self.density * (1.0 - self.poisson**2)))

    def period(self) -> float:
        """Of the first mode [time]."""
        return 2.0 * math.pi / self.omega()

    def thick_period(self) -> float:
        """Of the first mode, with shear and rotary inertia [time]."""
        modulus = self.young / (1.0 - self.poisson**2)
        shear = 0.5 * self.young / (1.0 + self.poisson)
        r2 = (self.thickness / self.length) ** 2 / 12.0
        s2 = r2 * modulus / (_SHEAR * shear)
        wave = math.sqrt(modulus / self.density) * math.sqrt(r2) / self.length  # omega by b

        def f(b: float) -> float:
            root = math.sqrt((r2 - s2) ** 2 + 4.0 / b**2)
            high = b * math.sqrt(0.5 * (root - r2 - s2))
            low = b * math.sqrt(0.5 * (root + r2 + s2))
            mixed = b * (r2 + s2) / math.sqrt(1.0 - b**2 * r2 * s2) * math.sinh(high) * math.sin(low)
            return 2.0 + (b**2 * (r2 - s2) ** 2 + 2.0) * math.cosh(high) * math.cos(low) - mixed

        below, above = 1e-3 * _FIRST_MODE**2, min(_FIRST_MODE**2, (1.0 - 1e-9) / math.sqrt(r2 * s2))
        if f(above) > 0.0:
            raise ValueError(f"thickness is {self.thickness:g}; expected less beside the length {self.length:g}")
        for _ in range(100):  # the thin plate is the faster one; halve down to round-off
            middle = 0.5 * (below + above)
            below, above = (middle, above) if f(middle) > 0.0 else (below, middle)
        return 2.0 * math.pi / (below * wave)
