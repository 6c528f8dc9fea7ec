"""Visco-plasticity by overstress (Perzyna 1966), on a cone; von Mises where the cone's slope is 0.

f = J + 3 alpha s_m - k - H kappa, J = sqrt(s':s'/2), s_m the mean stress (tension positive);
d kappa/dt = gamma <f/k>^m, d ep/dt = gamma <f/k>^m (s'/(2 J) + alpha_flow 1).
This is [T] 8.1.15-19 as far as its damaged text can be read - a rate by a power of the overstress, the normal of
J + A I1, and a scalar that hardens at the same rate - in plain time and with Hooke's elasticity: the thermodynamic time
and the hyper-elastic terms b2..b6 are left out, their formulas are not legible. The exponent l is not known.

An implicit step (backward Euler) has one unknown f: f + (G + 9 K alpha alpha_flow + H) gamma dt <f/k>^m = f(trial).
Where J would fall below 0 it is 0 and the flow is one of volume. For gamma dt -> inf it is the return to the cone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..jit import kernel
from .invariants import elastic_trial, flow_work, second_invariant
from .law import PLASTIC_STRAIN, lame_constants, law_body, state_rows, stress_update

ITERATIONS = 200


class Perzyna(NamedTuple):
    """lame, shear, k, hardening [pressure]; slope, flow: alpha; rate: gamma [1/time]; power: m. State: ep, kappa."""

    lame: float
    shear: float
    k: float
    slope: float
    flow: float
    hardening: float
    rate: float
    power: float


def perzyna(
    young: float,
    poisson: float,
    k: float,
    slope: float = 0.0,
    *,
    rate: float,
    power: float = 1.0,
    hardening: float = 0.0,
    flow: float | None = None,
) -> Perzyna:
    """The law of k [pressure] and alpha; flow: alpha of the flow, else the same; hardening: H [pressure]."""
    flow = slope if flow is None else flow
    if not (k > 0.0 and rate > 0.0 and power > 0.0 and math.isfinite(k + rate + power)):
        raise ValueError(f"k {k!r}, rate {rate!r} and exponent {power!r} must be positive")
    if not (hardening >= 0.0 and math.isfinite(hardening)):
        raise ValueError(f"hardening {hardening!r} must not be negative")
    if not 0.0 <= flow <= slope < math.inf or (slope > 0.0 and flow == 0.0):
        raise ValueError(f"the flow's alpha {flow!r} must lie above 0 and at most be the strength's {slope!r}")
    return Perzyna(*lame_constants(young, poisson), k, slope, flow, hardening, rate, power)


def perzyna_yield(
    young: float, poisson: float, yield_stress: float, rate: float, power: float = 1.0, hardening: float = 0.0
) -> Perzyna:
    """Von Mises by a uniaxial yield stress: plastic strain grows by rate <s/yield_stress - 1>^power in tension, and
    the yield stress by `hardening` of it."""
    root = math.sqrt(3.0)
    return perzyna(
        young, poisson, yield_stress / root, rate=root * rate, power=power, hardening=hardening / 3.0
    )  # fmt: skip


@kernel
def overstress(law, trial, falls, dt):
    """f after a step, from its trial > 0 and how much of it a unit of kappa takes."""
    low, high = 0.0, trial
    x = trial
    size = falls * law.rate * dt
    for _ in range(ITERATIONS):
        part = size * math.pow(x / law.k, law.power)
        value = x + part - trial
        if value > 0.0:
            high = x
        else:
            low = x
        new = x - value / (1.0 + law.power * part / x) if x > 0.0 else 0.0
        if not low < new < high:
            new = 0.5 * (low + high)
        change = abs(new - x)
        x = new
        if not change > 1e-16 * trial:
            break
    return x


@law_body(stress_update, Perzyna)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    bulk = law.lame + 2.0 / 3.0 * law.shear
    trial = mean + bulk * volumetric
    root = math.sqrt(second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    rest = 3.0 * law.slope * trial - law.k - law.hardening * state[1, i]
    over = root + rest
    scale, work, new = 1.0, 0.0, trial
    if over > 0.0:
        volume = 9.0 * bulk * law.slope * law.flow + law.hardening
        falls = law.shear + volume
        left = overstress(law, over, falls, dt)
        grown = (over - left) / falls
        if law.shear * grown > root:
            grown = 0.0
            if rest > 0.0:
                grown = (rest - overstress(law, rest, volume, dt)) / volume
            grown = max(grown, root / law.shear)
        scale = 1.0 - law.shear * min(grown, root / law.shear) / root if root > 0.0 else 0.0
        new = trial - 3.0 * bulk * law.flow * grown
        state[PLASTIC_STRAIN, i] += (1.0 - scale) * root / (math.sqrt(3.0) * law.shear)
        state[1, i] += grown
        along = s_xx * x_xx + s_yy * x_yy + s_zz * x_zz + 2.0 * (s_xy * x_xy + s_yz * x_yz + s_zx * x_zx)
        work = flow_work(bulk, law.shear, mean, trial, new, along, root, scale)
    return scale * x_xx + new, scale * x_yy + new, scale * x_zz + new, scale * x_xy, scale * x_yz, scale * x_zx, work


@law_body(state_rows, Perzyna)
def _rows(law):
    return 2
