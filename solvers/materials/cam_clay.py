"""Modified Cam-clay (Roscoe & Burland 1968): an ellipse through the origin that grows by compaction, in Hooke's medium.

Compression positive, p the mean pressure, q = sqrt(3) J: q^2/M^2 + p (p - pc) <= 0, associated flow;
pc grows by d pc = (1 + e0)/(lambda - kappa) pc d epv. The elastic moduli are constant: kappa enters by lambda - kappa
alone, and a swelling line is straight in p, not in ln p.

An implicit step (backward Euler) has one unknown, the compaction w of the step: p = p* - K w, pc = pc' exp(theta w),
the multiplier w/(2 p - pc), q = q*/(1 + 6 G multiplier/M^2). w has the sign of 2 p* - pc' and lies before the w where
2 p = pc, so that a bracket holds it: any increment has an answer.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..jit import kernel
from .invariants import elastic_trial, flow_work, second_invariant
from .law import PLASTIC_STRAIN, lame_constants, law_body, state_rows, stress_update

ITERATIONS = 200


class CamClay(NamedTuple):
    """lame, shear [pressure]; ratio: M; stiff: (1 + e0)/(lambda - kappa); first: pc at the start [pressure].

    State: plastic strain, compaction (so pc = first exp(stiff compaction)).
    """

    lame: float
    shear: float
    ratio: float
    stiff: float
    first: float


def cam_clay(
    young: float, poisson: float, ratio: float, compression: float, swelling: float, first: float, voids: float
) -> CamClay:
    """The law of M, lambda, kappa, the preconsolidation pressure and the void ratio e0 at the start."""
    if not (ratio > 0.0 and first > 0.0 and voids >= 0.0):
        raise ValueError(f"M {ratio!r} and pc {first!r} must be positive, e0 {voids!r} not negative")
    if not compression > swelling >= 0.0:
        raise ValueError(f"lambda {compression!r} must be greater than kappa {swelling!r}, which is not negative")
    return CamClay(*lame_constants(young, poisson), ratio, (1.0 + voids) / (compression - swelling), first)


@kernel
def _turning(bulk, stiff, pressure, before):
    """w where 2 p = pc: c(w) = 2 (p* - K w) - pc' exp(theta w) is concave and falls."""
    w = 0.0
    if 2.0 * pressure > before:  # both are beyond it, and Newton from beyond is monotone
        w = min((pressure - 0.5 * before) / bulk, math.log(2.0 * pressure / before) / stiff)
    for _ in range(ITERATIONS):
        part = before * math.exp(stiff * w)
        change = (2.0 * (pressure - bulk * w) - part) / (2.0 * bulk + stiff * part)
        w += change
        if not abs(change) > 1e-16 * abs(w):
            break
    return w


@kernel
def clay_return(law, pressure, deviator, before):
    """w, p, q and pc. pressure, deviator: the trial, outside; before: pc."""
    bulk = law.lame + 2.0 / 3.0 * law.shear
    square = law.ratio * law.ratio
    factor = 6.0 * law.shear / square
    end = _turning(bulk, law.stiff, pressure, before)
    low, high = min(0.0, end), max(0.0, end)
    wet = end > 0.0
    w = 0.0
    p, q, pc = pressure, deviator, before
    value, size = 0.0, 1.0
    for _ in range(ITERATIONS):
        p = pressure - bulk * w
        pc = before * math.exp(law.stiff * w)
        c = 2.0 * p - pc
        if c == 0.0:
            multiplier, growth = 0.0, 0.0
        else:
            multiplier = w / c
            growth = (c + w * (2.0 * bulk + law.stiff * pc)) / (c * c)
        shrink = 1.0 + factor * max(0.0, multiplier)
        q = deviator / shrink
        value = q * q / square + p * (p - pc)
        slope = -2.0 * q * q / square * factor * growth / shrink - bulk * (2.0 * p - pc) - p * law.stiff * pc
        size = q * q / square + p * p
        if abs(value) <= 1e-14 * size:
            break
        if (value > 0.0) == wet:
            low = w
        else:
            high = w
        new = w - value / slope
        if not low < new < high:
            new = 0.5 * (low + high)
        if new == w or new <= low or new >= high:
            break
        w = new
    if not abs(value) <= 1e-12 * size:  # at the critical state: 2 p - pc is less than round-off
        q = min(deviator, law.ratio * math.sqrt(max(0.0, p * (pc - p))))
    return w, p, q, pc


@law_body(stress_update, CamClay)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    bulk = law.lame + 2.0 / 3.0 * law.shear
    trial = mean + bulk * volumetric
    root = math.sqrt(second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    pc = law.first * math.exp(law.stiff * state[1, i])
    scale, new, work = 1.0, trial, 0.0
    if 3.0 * root * root / law.ratio**2 > -trial * (pc + trial):
        w, pressure, deviator, _ = clay_return(law, -trial, math.sqrt(3.0) * root, pc)
        new = -pressure
        scale = deviator / (math.sqrt(3.0) * root) if root > 0.0 else 0.0
        state[PLASTIC_STRAIN, i] += (1.0 - scale) * root / (math.sqrt(3.0) * law.shear)
        state[1, i] += w
        along = s_xx * x_xx + s_yy * x_yy + s_zz * x_zz + 2.0 * (s_xy * x_xy + s_yz * x_yz + s_zx * x_zx)
        work = flow_work(bulk, law.shear, mean, trial, new, along, root, scale)
    return scale * x_xx + new, scale * x_yy + new, scale * x_zz + new, scale * x_xy, scale * x_yz, scale * x_zx, work


@law_body(state_rows, CamClay)
def _rows(law):
    return 2
