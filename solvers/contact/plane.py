"""A rigid plane that bodies cannot pass, one-sided: it pushes and never pulls.

A particle of radius R (half its spacing, so that a lattice whose edge lies on the wall just touches it) at the distance
d in front of the plane overlaps it by p = R - d and is pushed back by F = k p (1 + (p/R)^2), k = rho c^2 R^(d-2) of its
material: as stiff as the body itself, and stiffer where a particle's centre has come behind the plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..jit import kernel
from .friction import Coulomb

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Wall:
    """A plane through `position`; `normal`: out of the wall, to where the particles are (any length)."""

    position: Vector
    normal: Vector
    friction: Coulomb | None = None

    def __post_init__(self) -> None:
        if not math.hypot(*self.normal) > 0.0 or not all(math.isfinite(a) for a in (*self.position, *self.normal)):
            raise ValueError(f"a wall needs a finite position and normal, not {self.position} and {self.normal}")


@kernel
def wall_push(overlap, radius, k):
    """(force, stiffness) of an overlap; zero where there is none."""
    if overlap <= 0.0:
        return 0.0, 0.0
    s = overlap / radius
    s *= s
    return k * overlap * (1.0 + s), k * (1.0 + 3.0 * s)
