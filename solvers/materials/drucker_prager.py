"""Drucker-Prager: perfectly plastic cone, flow by an angle of its own, apex, tension cut-off.

Compression is positive in I = -(s_xx + s_yy + s_zz), J = sqrt(J2). J <= k + alpha I, flow along J - alpha_flow I:
1. beyond the cut-off, I(trial) < T: the pressure T/3 without shear ([T] 4.6.3, LS-DYNA MAT_025)
2. dl = (J - k - alpha I)/(G + 9 K alpha alpha_flow), I += 9 K alpha_flow dl, J = k + alpha I        (4.6.3.24-30)
3. where that J is negative: the apex I = -k/alpha
The cones of cohesion and friction angle are those of Mohr-Coulomb's triaxial compression or extension (through the
outer or inner corners of its hexagon) or of its collapse load in plane strain (Drucker & Prager 1952).
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from .invariants import elastic_trial, flow_work, second_invariant
from .law import PLASTIC_STRAIN, lame_constants, law_body, state_rows, stress_update

Match = Literal["compression", "extension", "plane_strain"]


class DruckerPrager(NamedTuple):
    """lame, shear, k [pressure]; slope, flow: alpha of strength and of flow; tension, apex: least I. State: ep."""

    lame: float
    shear: float
    k: float
    slope: float
    flow: float
    tension: float
    apex: float


def drucker_prager(
    young: float, poisson: float, k: float, slope: float, *, flow: float | None = None, tension: float = -math.inf
) -> DruckerPrager:
    """The law of k [pressure] and alpha. flow: alpha of the flow, else the same; tension: least I, not positive."""
    flow = slope if flow is None else flow
    if not (k >= 0.0 and slope >= 0.0 and k + slope > 0.0 and math.isfinite(k + slope)):
        raise ValueError(f"k {k!r} and alpha {slope!r} must not be negative, and not both 0")
    if not 0.0 <= flow <= slope:
        raise ValueError(f"the flow's alpha {flow!r} must lie between 0 and the strength's {slope!r}")
    if not tension <= 0.0:
        raise ValueError(f"tension cut-off {tension!r} must not be positive (compression is); without cohesion it is 0")
    apex = -k / slope if slope > 0.0 else -math.inf
    if tension > -math.inf:
        tension = max(tension, apex)
    return DruckerPrager(*lame_constants(young, poisson), k, slope, flow, tension, apex)


def cone(cohesion: float, friction: float, match: Match = "compression") -> tuple[float, float]:
    """(k, alpha) of a cohesion [pressure] and a friction angle [degrees]."""
    if not (cohesion >= 0.0 and math.isfinite(cohesion)):
        raise ValueError(f"cohesion {cohesion!r} must not be negative")
    if not 0.0 <= friction < 90.0:
        raise ValueError(f"friction angle {friction!r} must lie between 0 and 90 degrees")
    sine, cosine = math.sin(math.radians(friction)), math.cos(math.radians(friction))
    if match == "plane_strain":
        below = math.sqrt(9.0 * cosine * cosine + 12.0 * sine * sine)
        return 3.0 * cohesion * cosine / below, sine / below
    below = math.sqrt(3.0) * (3.0 - sine if match == "compression" else 3.0 + sine)
    return 6.0 * cohesion * cosine / below, 2.0 * sine / below


def drucker_prager_soil(
    young: float,
    poisson: float,
    cohesion: float,
    friction: float,
    dilation: float = 0.0,
    *,
    match: Match = "compression",
    tension: float = -math.inf,
) -> DruckerPrager:
    """The law of cohesion [pressure], friction and dilation angle [degrees]."""
    if not 0.0 <= dilation <= friction:
        raise ValueError(f"dilation angle {dilation!r} must lie between 0 and the friction angle {friction!r}")
    k, slope = cone(cohesion, friction, match)
    return drucker_prager(young, poisson, k, slope, flow=cone(cohesion, dilation, match)[1], tension=tension)


@law_body(stress_update, DruckerPrager)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    bulk = law.lame + 2.0 / 3.0 * law.shear
    trial = mean + bulk * volumetric
    root = math.sqrt(second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    first = -3.0 * trial
    left = root
    if first < law.tension:
        first = law.tension
        left = 0.0
    else:
        over = root - law.k - law.slope * first
        if over > 0.0:
            first += 9.0 * bulk * law.flow * over / (law.shear + 9.0 * bulk * law.slope * law.flow)
            left = min(root, law.k + law.slope * first)
            if left < 0.0:
                first = law.apex
                left = 0.0
    new = -first / 3.0
    scale = left / root if root > 0.0 else 0.0
    work = 0.0
    if left < root or first > -3.0 * trial:
        state[PLASTIC_STRAIN, i] += (root - left) / (math.sqrt(3.0) * law.shear)
        along = s_xx * x_xx + s_yy * x_yy + s_zz * x_zz + 2.0 * (s_xy * x_xy + s_yz * x_yz + s_zx * x_zx)
        work = flow_work(bulk, law.shear, mean, trial, new, along, root, scale)
    mean = new
    return scale * x_xx + mean, scale * x_yy + mean, scale * x_zz + mean, scale * x_xy, scale * x_yz, scale * x_zx, work


@law_body(state_rows, DruckerPrager)
def _rows(law):
    return 1
