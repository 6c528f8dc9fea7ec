"""Repulsive contact by a potential of the kernel (Vignjevic et al. 2006; [T] 5.3.7-13; the deck's contact type 1).

a_i = - sum_j m_j (K_i + K_j) f^n grad_i W(r_ij, h_ij), f = W(r)/W(h) of the mean smoothing length h_ij, over particles
j of other bodies. The pair's exponent is the mean of both, so that action equals reaction.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba.extending import overload

from ..jit import kernel
from ..sph.smoothing import inverse_root, normaliser, shape_slope, shape_value
from .law import JIT_OPTIONS, TINY, is_law, repulsion


class Potential(NamedTuple):
    """reach: support of the kernel; strength, exponent: (bodies,) K [pressure/density^2] and n [-].

    normal: a_d of the kernel; dimension; original: as the original program codes it (n of particle i's material, its
    divisor of f).
    """

    reach: float
    strength: Any
    exponent: Any
    normal: float
    dimension: int
    original: bool


def potential(shape: Any, dimension: int, strength: Any, exponent: Any, *, original: bool = False) -> Potential:
    """The law for a smoothing kernel."""
    return Potential(
        shape.support, np.asarray(strength, float), np.asarray(exponent, float), normaliser(shape, dimension),
        dimension, original,
    )  # fmt: skip


def matching_strength(wave_speed: float, density: float) -> float:
    """K that makes the contact about as stiff as a body of this wave speed: its pressure is rho c^2 at r = h."""
    return wave_speed * wave_speed / density


@kernel
def original_reference(s):
    """The divisor of f as the original program codes it, at s = h_j/h_ij: without its factor 1/4 from s = 1 on."""
    if s < 1.0:
        return 0.75 * s * s * s - 1.5 * s * s + 1.0
    return (2.0 - s) ** 3


def _repulsion(law, shape, r2, h_i, h_j, mass_i, mass_j, density_i, density_j, body_i, body_j, approach, dt):
    mean = 0.5 * (h_i + h_j)
    inverse = 1.0 / mean
    q2 = r2 * inverse * inverse + TINY
    iq = inverse_root(q2)
    value = shape_value(shape, q2 * iq)
    slope = shape_slope(shape, q2 * iq, iq)
    if law.original:
        f = 1.5 * value / original_reference(h_j * inverse)
        power = law.exponent[body_i]
    else:
        f = value / shape_value(shape, 0.5 * shape.support)
        power = 0.5 * (law.exponent[body_i] + law.exponent[body_j])
    factor = law.normal * inverse * inverse * inverse
    if law.dimension > 1:
        factor *= inverse
    if law.dimension > 2:
        factor *= inverse
    push = -mass_i * mass_j * (law.strength[body_i] + law.strength[body_j]) * f**power * factor * slope
    return push, push * (2.0 * q2 * iq - (power + 1.0) * slope * q2 / (value + TINY))


@overload(repulsion, jit_options=JIT_OPTIONS)
def _of_potential(law, shape, r2, h_i, h_j, mass_i, mass_j, density_i, density_j, body_i, body_j, approach, dt):
    return _repulsion if is_law(law, Potential) else None
