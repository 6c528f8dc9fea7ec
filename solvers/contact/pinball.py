"""Pinball penalty (Belytschko & Neal 1991; [T] 5.3.1-4): a ball of radius R = h/2 around each particle.

p = (h_i + h_j)/2 - |x_i - x_j| is the overlap of the two, and
    F2 = G_i G_j/(G_i + G_j) sqrt(R_i R_j/(R_i + R_j)) p^(3/2)
    F1 = rho_i rho_j R_i^3 R_j^3/(rho_i R_i^3 + rho_j R_j^3) dp/dt / dt where p grows, else 0.
`Pinball` is F = Kp F2: a spring, which gives back what it stores and holds a body at rest. `PinballImpact` is the rule
as printed, F = Kp min(F1, F2): it ends when the bodies begin to part, so that contact takes energy away and what rests
on it sinks slowly (by about 4 g dt in unit time); for impacts only. In the plane and on a line the forces, which are
those of balls, are shared out over a depth of R_i + R_j (each way).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from numba.extending import overload

from ..jit import kernel
from .law import JIT_OPTIONS, TINY, is_law, repulsion

STIFF = 20.0  # Kp that makes the contact of lattices with h = 1.2 spacings about as stiff as the bodies


class Pinball(NamedTuple):
    """factor: Kp [-]; modulus: (bodies,) shear moduli G (for fluids, which have none, rho c^2); flat: 3 - dimension."""

    reach: float
    factor: float
    modulus: Any
    flat: int


class PinballImpact(NamedTuple):
    """As `Pinball`, by the rule as printed."""

    reach: float
    factor: float
    modulus: Any
    flat: int


@kernel
def _spring_of(law, h_i, h_j, body_i, body_j, r):
    """(overlap, Kp F2/overlap) of two balls that touch."""
    reach = 0.5 * (h_i + h_j)
    overlap = reach - r
    g_i = law.modulus[body_i]
    g_j = law.modulus[body_j]
    stiff = law.factor * g_i * g_j / (g_i + g_j) * math.sqrt(0.5 * h_i * h_j / (h_i + h_j) * overlap)
    for _ in range(law.flat):
        stiff /= reach
    return overlap, stiff


def _spring(law, shape, r2, h_i, h_j, mass_i, mass_j, density_i, density_j, body_i, body_j, approach, dt):
    if 4.0 * r2 >= (h_i + h_j) ** 2:
        return 0.0, 0.0
    r = math.sqrt(r2)
    overlap, stiff = _spring_of(law, h_i, h_j, body_i, body_j, r)
    return stiff * overlap / (r + TINY), 1.5 * stiff


def _impact(law, shape, r2, h_i, h_j, mass_i, mass_j, density_i, density_j, body_i, body_j, approach, dt):
    if 4.0 * r2 >= (h_i + h_j) ** 2 or (approach <= 0.0 and dt > 0.0):
        return 0.0, 0.0
    r = math.sqrt(r2)
    overlap, stiff = _spring_of(law, h_i, h_j, body_i, body_j, r)
    a = 0.125 * density_i * h_i * h_i * h_i
    b = 0.125 * density_j * h_j * h_j * h_j
    stop = law.factor * a * b / (a + b) * approach / (r + TINY)
    for _ in range(law.flat):
        stop /= 0.5 * (h_i + h_j)
    force = stiff * overlap
    if stop < force * dt:
        force = stop / dt
    return force / (r + TINY), 1.5 * stiff


@overload(repulsion, jit_options=JIT_OPTIONS)
def _of_pinball(law, shape, r2, h_i, h_j, mass_i, mass_j, density_i, density_j, body_i, body_j, approach, dt):
    if is_law(law, PinballImpact):
        return _impact
    return _spring if is_law(law, Pinball) else None
