"""Von Mises plasticity with linear mixed hardening, radial return ([T] 4.6.2; Krieg & Key 1976).

Yield: sqrt(3/2) |s - a| <= Y0 + beta H ep, back stress a growing by (1 - beta) H of the plastic strain,
H = E ET / (E - ET). beta = 1 isotropic, 0 kinematic. Steps of the return:
1. trial deviator s* = s + 2 G de', relative to the back stress: xi = s* - a, xi_eq = sqrt(3/2) |xi|
2. dep = (xi_eq - Y) / (3 G + H) if positive
3. s = s* - (3 G dep / xi_eq) xi,  a += ((1 - beta) H dep / xi_eq) xi,  Y += beta H dep
With a table or a power (`VonMisesCurve`, `VonMisesMixedCurve`) H is the curve's own slope and the return as exact.
Cowper & Symonds 1957 raise the whole curve of isotropic hardening by 1 + (rate/C)^(1/p), rate = sqrt(2/3 e':e') of the
whole deviatoric strain.
The pressure stays elastic. One increment is exact for radial paths. Without kinematic hardening there is no back stress
in the state at all (`VonMisesIsotropic`): a scene pays for what it uses.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .hardening import Linear, Power, Table, radial_return, yield_at
from .invariants import THIRD, elastic_trial, second_invariant
from .law import PLASTIC_STRAIN, lame_constants, law_body, rotate_state, state_rows, stress_update
from .rotation import rotate_rows


class VonMisesIsotropic(NamedTuple):
    """lame, shear, yield_stress, hardening: lambda, G, Y0, H [pressure]. State: plastic strain."""

    lame: float
    shear: float
    yield_stress: float
    hardening: float


class VonMisesMixed(NamedTuple):
    """As `VonMisesIsotropic`, with beta [-] < 1. State: plastic strain, back stress deviator (6)."""

    lame: float
    shear: float
    yield_stress: float
    hardening: float
    beta: float


class VonMisesCurve(NamedTuple):
    """lame, shear: lambda, G [pressure]; rate: C [1/time], inf without one; power: 1/p. State: plastic strain."""

    lame: float
    shear: float
    hardening: Linear | Power | Table
    rate: float
    power: float


class VonMisesMixedCurve(NamedTuple):
    """As `VonMisesCurve` without a rate, with beta [-] < 1. State: plastic strain, back stress deviator (6)."""

    lame: float
    shear: float
    hardening: Linear | Power | Table
    beta: float


def von_mises_curve(
    young: float,
    poisson: float,
    hardening: Linear | Power | Table,
    beta: float = 1.0,
    *,
    rate: float = math.inf,
    exponent: float = 1.0,
) -> VonMisesCurve | VonMisesMixedCurve:
    """The law of a hardening curve; beta in 0..1 (isotropic); rate, exponent: Cowper and Symonds' C [1/time] and p."""
    if not (rate > 0.0 and exponent > 0.0):
        raise ValueError(f"Cowper and Symonds' C {rate!r} and p {exponent!r} must be positive")
    if not 0.0 <= beta <= 1.0:
        raise ValueError(f"hardening parameter beta {beta!r} must lie between 0 (kinematic) and 1 (isotropic)")
    if beta < 1.0:
        if beta == 0.0 and not yield_at(hardening, 0.0)[0] > 0.0:
            raise ValueError("kinematic hardening needs a yield stress: the surface keeps its size")
        if rate < math.inf:
            raise ValueError("a strain rate raises the curve of isotropic hardening only: beta must be 1")
        return VonMisesMixedCurve(*lame_constants(young, poisson), hardening, beta)
    return VonMisesCurve(*lame_constants(young, poisson), hardening, rate, 1.0 / exponent)


def von_mises(
    young: float, poisson: float, yield_stress: float, tangent_modulus: float = 0.0, beta: float = 1.0
) -> VonMisesIsotropic | VonMisesMixed:
    """The law of Young's modulus, yield stress and elastic-plastic tangent modulus ET [pressure]; beta in 0..1."""
    lame, shear = lame_constants(young, poisson)
    if not yield_stress > 0.0:
        raise ValueError(f"yield stress {yield_stress!r} must be positive")
    if not 0.0 <= tangent_modulus < young:
        raise ValueError(f"tangent modulus {tangent_modulus!r} must lie between 0 and Young's modulus {young!r}")
    if not 0.0 <= beta <= 1.0:
        raise ValueError(f"hardening parameter beta {beta!r} must lie between 0 (kinematic) and 1 (isotropic)")
    hardening = young * tangent_modulus / (young - tangent_modulus)
    if beta == 1.0 or hardening == 0.0:
        return VonMisesIsotropic(lame, shear, yield_stress, hardening)
    return VonMisesMixed(lame, shear, yield_stress, hardening, beta)


@law_body(stress_update, VonMisesIsotropic)
def _isotropic(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    g2 = 2.0 * law.shear
    de_m = (de_xx + de_yy + de_zz) * THIRD
    mean = (s_xx + s_yy + s_zz) * THIRD
    x_xx = s_xx - mean + g2 * (de_xx - de_m)
    x_yy = s_yy - mean + g2 * (de_yy - de_m)
    x_zz = s_zz - mean + g2 * (de_zz - de_m)
    x_xy = s_xy + g2 * de_xy
    x_yz = s_yz + g2 * de_yz
    x_zx = s_zx + g2 * de_zx
    mean += (3.0 * law.lame + g2) * de_m
    square = 1.5 * (x_xx * x_xx + x_yy * x_yy + x_zz * x_zz + 2.0 * (x_xy * x_xy + x_yz * x_yz + x_zx * x_zx))
    strength = law.yield_stress + law.hardening * state[PLASTIC_STRAIN, i]
    work = 0.0
    scale = 1.0
    softness = 1.0 / (1.5 * g2 + law.hardening)  # out of the caller's loop: a division less
    if square > strength * strength:
        trial = math.sqrt(square)
        increment = (trial - strength) * softness
        state[PLASTIC_STRAIN, i] += increment
        scale = 1.0 - 1.5 * g2 * increment / trial
        work = (strength + 0.5 * law.hardening * increment) * increment
    return scale * x_xx + mean, scale * x_yy + mean, scale * x_zz + mean, scale * x_xy, scale * x_yz, scale * x_zx, work


@law_body(stress_update, VonMisesMixed)
def _mixed(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    g2 = 2.0 * law.shear
    de_m = (de_xx + de_yy + de_zz) * THIRD
    mean = (s_xx + s_yy + s_zz) * THIRD
    x_xx = s_xx - mean + g2 * (de_xx - de_m) - state[1, i]
    x_yy = s_yy - mean + g2 * (de_yy - de_m) - state[2, i]
    x_zz = s_zz - mean + g2 * (de_zz - de_m) - state[3, i]
    x_xy = s_xy + g2 * de_xy - state[4, i]
    x_yz = s_yz + g2 * de_yz - state[5, i]
    x_zx = s_zx + g2 * de_zx - state[6, i]
    mean += (3.0 * law.lame + g2) * de_m
    square = 1.5 * (x_xx * x_xx + x_yy * x_yy + x_zz * x_zz + 2.0 * (x_xy * x_xy + x_yz * x_yz + x_zx * x_zx))
    strength = law.yield_stress + law.beta * law.hardening * state[PLASTIC_STRAIN, i]
    work = 0.0
    scale = 1.0
    softness = 1.0 / (1.5 * g2 + law.hardening)  # out of the caller's loop: a division less
    if square > strength * strength:
        trial = math.sqrt(square)
        increment = (trial - strength) * softness
        state[PLASTIC_STRAIN, i] += increment
        scale = 1.0 - 1.5 * g2 * increment / trial
        back = (1.0 - law.beta) * law.hardening * increment / trial
        state[1, i] += back * x_xx
        state[2, i] += back * x_yy
        state[3, i] += back * x_zz
        state[4, i] += back * x_xy
        state[5, i] += back * x_yz
        state[6, i] += back * x_zx
        # the relative stress is scaled about the old back stress, which moved by `back` of it
        scale -= back
        work = (strength + 0.5 * law.beta * law.hardening * increment) * increment
    return (
        scale * x_xx + state[1, i] + mean,
        scale * x_yy + state[2, i] + mean,
        scale * x_zz + state[3, i] + mean,
        scale * x_xy + state[4, i],
        scale * x_yz + state[5, i],
        scale * x_zx + state[6, i],
        work,
    )


@law_body(stress_update, VonMisesMixedCurve)
def _mixed_curve(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
):  # fmt: skip
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    mean += (law.lame + 2.0 / 3.0 * law.shear) * volumetric
    x_xx -= state[1, i]
    x_yy -= state[2, i]
    x_zz -= state[3, i]
    x_xy -= state[4, i]
    x_yz -= state[5, i]
    x_zx -= state[6, i]
    trial = math.sqrt(3.0 * second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    first, _ = yield_at(law.hardening, 0.0)
    before, _ = yield_at(law.hardening, state[PLASTIC_STRAIN, i])
    less = (1.0 - law.beta) * (before - first)  # of the curve, what the back stress has of it
    increment, strength, work = radial_return(
        law.hardening, trial, state[PLASTIC_STRAIN, i], 3.0 * law.shear, 1.0, -less
    )  # fmt: skip
    scale = 1.0
    if increment > 0.0:
        state[PLASTIC_STRAIN, i] += increment
        scale = 1.0 - 3.0 * law.shear * increment / trial
        back = (1.0 - law.beta) * (strength + less - before) / trial
        state[1, i] += back * x_xx
        state[2, i] += back * x_yy
        state[3, i] += back * x_zz
        state[4, i] += back * x_xy
        state[5, i] += back * x_yz
        state[6, i] += back * x_zx
        scale -= back
        work = (1.0 - law.beta) * first * increment + law.beta * (work + less * increment)
    return (
        scale * x_xx + state[1, i] + mean,
        scale * x_yy + state[2, i] + mean,
        scale * x_zz + state[3, i] + mean,
        scale * x_xy + state[4, i],
        scale * x_yz + state[5, i],
        scale * x_zx + state[6, i],
        work,
    )


@law_body(rotate_state, VonMisesMixed, VonMisesMixedCurve)
def _mixed_rotate(law, w_xy, w_yz, w_zx, state, i):
    rotate_rows(w_xy, w_yz, w_zx, state, 1, i)


@law_body(stress_update, VonMisesCurve)
def _curve(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    mean += (law.lame + 2.0 / 3.0 * law.shear) * volumetric
    trial = math.sqrt(3.0 * second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    factor = 1.0
    if law.rate < math.inf and dt > 0.0:
        third = volumetric / 3.0
        square = second_invariant(de_xx - third, de_yy - third, de_zz - third, de_xy, de_yz, de_zx)
        factor += math.pow(math.sqrt(4.0 / 3.0 * square) / (dt * law.rate), law.power)
    increment, _, work = radial_return(
        law.hardening, trial, state[PLASTIC_STRAIN, i], 3.0 * law.shear, factor, 0.0
    )  # fmt: skip
    scale = 1.0
    if increment > 0.0:
        state[PLASTIC_STRAIN, i] += increment
        scale = 1.0 - 3.0 * law.shear * increment / trial
    return scale * x_xx + mean, scale * x_yy + mean, scale * x_zz + mean, scale * x_xy, scale * x_yz, scale * x_zx, work


@law_body(state_rows, VonMisesIsotropic, VonMisesCurve)
def _rows(law):
    return 1


@law_body(state_rows, VonMisesMixed, VonMisesMixedCurve)
def _more_rows(law):
    return 7
