"""Elastic-plastic solid whose pressure comes of an equation of state: metal under strong shocks.

MCM model 10, LS-DYNA MAT_010. Deviator: Hooke and radial return, sqrt(3 J2) <= Y(ep) + (a1 + a2 p) max(p, 0). Pressure:
the equation of state, p >= cutoff (a tension, so negative). Spall 1: no more than that limit. 2: where the greatest
principal stress reaches -cutoff, 3: where p falls below the cut-off, the material is rubble from then on: no shear, no
tension. So it is where the plastic strain reaches the failure strain.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from .eos import implicit_pressure, squared_sound
from .hardening import Linear, Table, radial_return
from .invariants import elastic_trial, second_invariant
from .law import PLASTIC_STRAIN, constant_wave, law_body, state_rows, stress_update, wave_speed
from .principal import greatest_deviator

BROKEN = 1  # row: 1 where the material is rubble


class Hydro(NamedTuple):
    """shear: G; hardening; a1 [-], a2 [1/pressure]; cutoff [pressure]; spall 1, 2, 3; failure: strain, inf without one.

    State: plastic strain, broken.
    """

    shear: float
    hardening: Linear | Table
    a1: float
    a2: float
    cutoff: float
    spall: int
    failure: float
    eos: Any


def hydro(
    shear: float,
    hardening: Linear | Table,
    eos: Any,
    *,
    a1: float = 0.0,
    a2: float = 0.0,
    cutoff: float = -math.inf,
    spall: int = 1,
    failure: float = math.inf,
) -> Hydro:
    """The law of a shear modulus, a hardening and an equation of state; ValueError where they make no sense."""
    if not shear > 0.0:
        raise ValueError(f"shear modulus {shear!r} must be positive")
    if isinstance(hardening, Linear) and not (hardening.yield_stress >= 0.0 and hardening.modulus >= 0.0):
        raise ValueError(f"yield stress and hardening {tuple(hardening)!r} must not be negative")
    if not (a1 >= 0.0 and a2 >= 0.0):
        raise ValueError(f"a1 {a1!r} and a2 {a2!r} must not be negative")
    if not cutoff <= 0.0:
        raise ValueError(f"pressure cut-off {cutoff!r} must not be positive: it is the least pressure, a tension")
    if spall not in (1, 2, 3):
        raise ValueError(f"spall type {spall!r} must be 1, 2 or 3")
    if not failure > 0.0:
        raise ValueError(f"failure strain {failure!r} must be positive")
    return Hydro(shear, hardening, a1, a2, cutoff, spall, failure, eos)


@law_body(stress_update, Hydro)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    before = -mean
    s_xx -= mean
    s_yy -= mean
    s_zz -= mean
    if state[BROKEN, i] > 0.0:
        work = 0.5 * (s_xx * de_xx + s_yy * de_yy + s_zz * de_zz) + s_xy * de_xy + s_yz * de_yz + s_zx * de_zx
        p = max(0.0, implicit_pressure(law.eos, rho, e, volumetric, before, work))
        return -p, -p, -p, 0.0, 0.0, 0.0, 0.0
    trial = math.sqrt(3.0 * second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    plastic = state[PLASTIC_STRAIN, i]
    g3 = 3.0 * law.shear
    # the pressure needs the deviator's work, the strength needs the pressure: the work by the old pressure's strength
    push = max(before, 0.0)
    increment, _, _ = radial_return(law.hardening, trial, plastic, g3, 1.0, (law.a1 + law.a2 * push) * push)
    scale = 1.0 - g3 * increment / trial if increment > 0.0 else 1.0
    work = 0.5 * ((s_xx + scale * x_xx) * de_xx + (s_yy + scale * x_yy) * de_yy + (s_zz + scale * x_zz) * de_zz)
    work += (s_xy + scale * x_xy) * de_xy + (s_yz + scale * x_yz) * de_yz + (s_zx + scale * x_zx) * de_zx
    p = implicit_pressure(law.eos, rho, e, volumetric, before, work)
    push = max(p, 0.0)
    increment, _, heat = radial_return(law.hardening, trial, plastic, g3, 1.0, (law.a1 + law.a2 * push) * push)
    scale = 1.0 - g3 * increment / trial if increment > 0.0 else 1.0
    state[PLASTIC_STRAIN, i] = plastic + increment
    torn = plastic + increment >= law.failure
    if law.spall == 2:
        torn = torn or greatest_deviator(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx) * scale - p >= -law.cutoff
    elif law.spall == 3:
        torn = torn or p < law.cutoff
    if torn:
        state[BROKEN, i] = 1.0
        p = max(0.0, p)
        heat += (scale * trial) ** 2 / (2.0 * g3)
        scale = 0.0
    p = max(p, law.cutoff)
    return scale * x_xx - p, scale * x_yy - p, scale * x_zz - p, scale * x_xy, scale * x_yz, scale * x_zx, heat


@law_body(wave_speed, Hydro)
def _wave(law, rho, e, state, i):
    return math.sqrt(squared_sound(law.eos, rho, e) + 4.0 / 3.0 * law.shear / rho)


@law_body(state_rows, Hydro)
def _rows(law):
    return 2


@law_body(constant_wave, Hydro)
def _constant(law):
    return False
