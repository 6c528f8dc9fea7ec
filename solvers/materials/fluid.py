"""Viscous fluid: pressure by an equation of state with a cut-off, Newtonian shear 2 viscosity dev(rate).

Nothing is remembered, so a rotation costs nothing. In MCM model 9, LS-DYNA MAT_009.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from .eos import implicit_pressure, squared_sound
from .law import constant_wave, law_body, stress_update, wave_speed


class Fluid(NamedTuple):
    """viscosity [pressure time]; cutoff: the least pressure, -inf without one; eos: a NamedTuple of `eos`."""

    viscosity: float
    cutoff: float
    eos: Any


def fluid(eos: Any, *, viscosity: float = 0.0, cutoff: float = -math.inf) -> Fluid:
    """The law of an equation of state; ValueError where the constants make no sense."""
    if not viscosity >= 0.0:
        raise ValueError(f"viscosity {viscosity!r} must not be negative")
    if not cutoff <= 0.0:
        raise ValueError(f"pressure cut-off {cutoff!r} must not be positive: it is the least pressure, a tension")
    return Fluid(viscosity, cutoff, eos)


@law_body(stress_update, Fluid)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric = de_xx + de_yy + de_zz
    before = -(s_xx + s_yy + s_zz) / 3.0
    mean = volumetric / 3.0
    rate = 2.0 * law.viscosity / dt if law.viscosity > 0.0 else 0.0
    v_xx = rate * (de_xx - mean)
    v_yy = rate * (de_yy - mean)
    v_zz = rate * (de_zz - mean)
    v_xy = rate * de_xy
    v_yz = rate * de_yz
    v_zx = rate * de_zx
    # the caller's work is by the mean of old and new stress; what of it is the shear's
    work = (s_xx + before + v_xx) * de_xx + (s_yy + before + v_yy) * de_yy + (s_zz + before + v_zz) * de_zz
    work = 0.5 * work + (s_xy + v_xy) * de_xy + (s_yz + v_yz) * de_yz + (s_zx + v_zx) * de_zx
    p = max(law.cutoff, implicit_pressure(law.eos, rho, e, volumetric, before, work))
    heat = v_xx * de_xx + v_yy * de_yy + v_zz * de_zz + 2.0 * (v_xy * de_xy + v_yz * de_yz + v_zx * de_zx)
    return v_xx - p, v_yy - p, v_zz - p, v_xy, v_yz, v_zx, heat


@law_body(wave_speed, Fluid)
def _wave(law, rho, e, state, i):
    return math.sqrt(squared_sound(law.eos, rho, e))


@law_body(constant_wave, Fluid)
def _constant(law):
    return False
