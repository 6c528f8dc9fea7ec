"""Where a thick shell that implodes comes to rest (Verney's test): incompressible, rigid and perfectly plastic.

The kinetic energy at the start is the plastic work at the end. With m = 2 for a cylinder (plane strain) and 3 for a
sphere, incompressible flow has v = v_a (a / r)^(m - 1), and r^m falls by the same D everywhere; the work is
C Y (F(b^m) - F(a^m)), F(s) = s ln s - (s - D) ln(s - D), with C = pi / sqrt(3) for the cylinder, per length, and
8 pi / 9 for the sphere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from .parameters import chosen, positive


@dataclass(frozen=True, slots=True, kw_only=True)
class VerneyShell:
    """inner, outer: radii at the start; density; yield_stress; speed: of the inner face, inward; shape: see above."""

    inner: float
    outer: float
    density: float
    yield_stress: float
    speed: float
    shape: str = "cylinder"
    SCALARS: ClassVar = ("inner_radius", "outer_radius")
    CURVES: ClassVar = ()

    def __post_init__(self) -> None:
        positive(self, "inner", "outer", "density", "yield_stress", "speed")
        chosen(self, "shape", ("cylinder", "sphere"))
        if not self.outer > self.inner:
            raise ValueError(f"outer is {self.outer:g}; expected more than inner, {self.inner:g}")

    def _energy(self) -> float:
        a, b = self.inner, self.outer
        if self.shape == "cylinder":
            return math.pi * self.density * self.speed**2 * a**2 * math.log(b / a)
        return 2.0 * math.pi * self.density * self.speed**2 * a**4 * (1.0 / a - 1.0 / b)

    def _work(self, d: float) -> float:
        """Plastic work until r^m has fallen by d."""
        m, factor = (2, math.pi / math.sqrt(3.0)) if self.shape == "cylinder" else (3, 8.0 * math.pi / 9.0)

        def f(s: float) -> float:
            return s * math.log(s) - ((s - d) * math.log(s - d) if s > d else 0.0)

        return factor * self.yield_stress * (f(self.outer**m) - f(self.inner**m))

    def _fall(self) -> float:
        """By how much r^m has fallen at rest; of a shell that closes, all of the inner one."""
        low, high = 0.0, self.inner ** (2 if self.shape == "cylinder" else 3)
        energy = self._energy()
        if energy >= self._work(high):
            return high
        for _ in range(100):  # the work grows with the fall: halve the interval down to round-off
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._work(middle) < energy else (low, middle)
        return low

    def _radius(self, start: float) -> float:
        m = 2 if self.shape == "cylinder" else 3
        return float(max(0.0, start**m - self._fall()) ** (1.0 / m))

    def inner_radius(self) -> float:
        """At rest; 0 of a shell that closes."""
        return self._radius(self.inner)

    def outer_radius(self) -> float:
        """At rest."""
        return self._radius(self.outer)
