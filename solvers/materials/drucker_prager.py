"""Drucker-Prager: perfectly plastic cone, flow by an angle of its own, apex, tension cut-off.

Compression is positive in I = -(s_xx + s_yy + s_zz), J = sqrt(J2). J <= k + alpha I, flow along J - alpha_flow I:
1. beyond the cut-off, I(trial) < T: the pressure T/3 without shear ([T] 4.6.3, LS-DYNA MAT_025). With `keeps_shear`
   I = T is a surface of its own instead, with its normal as flow: what is cut off keeps the shear that the cone allows.
   Only so is the stress continuous in the strain, which Newton's method on a structure needs
2. dl = (J - k - alpha I)/(G + 9 K alpha alpha_flow), I += 9 K alpha_flow dl, J = k + alpha I        (4.6.3.24-30)
3. where that J is negative: the apex I = -k/alpha
The cones of cohesion and friction angle are those of Mohr-Coulomb's triaxial compression or extension (through the
outer or inner corners of its hexagon) or of its collapse load in plane strain (Drucker & Prager 1952).

Gap: grain without cohesion that is pulled apart opens, 1 and 3 above; pressed again it must first close by as much as
it has opened before it bears anything, a strain of at most OPEN. A law of rates alone bears at once, and so ratchets:
loosened and pressed in turn, it becomes ever less dense under a pressure that belongs to full density.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from ..jit import kernel
from .invariants import elastic_trial, flow_work, second_invariant
from .law import GAP, OPEN, PLASTIC_STRAIN, bulk_modulus, lame_constants, law_body, state_rows, stress_update

Match = Literal["compression", "extension", "plane_strain"]


class DruckerPrager(NamedTuple):
    """lame, shear, k [pressure]; slope, flow: alpha of strength and of flow; tension, apex: least I.

    gaps: whether an opening is remembered; keeps_shear: see 1 above. State: ep; the gap, a volume strain, if there is
    one.
    """

    lame: float
    shear: float
    k: float
    slope: float
    flow: float
    tension: float
    apex: float
    gaps: bool = False
    keeps_shear: bool = False


def drucker_prager(
    young: float,
    poisson: float,
    k: float,
    slope: float,
    *,
    flow: float | None = None,
    tension: float = -math.inf,
    gaps: bool = False,
) -> DruckerPrager:
    """The law of k [pressure] and alpha. flow: alpha of the flow, else the same; tension: least I, not positive.

    gaps: what is pulled apart closes again before it bears; only without cohesion.
    """
    flow = slope if flow is None else flow
    if not (k >= 0.0 and slope >= 0.0 and k + slope > 0.0 and math.isfinite(k + slope)):
        raise ValueError(f"k {k!r} and alpha {slope!r} must not be negative, and not both 0")
    if not 0.0 <= flow <= slope:
        raise ValueError(f"the flow's alpha {flow!r} must lie between 0 and the strength's {slope!r}")
    if not tension <= 0.0:
        raise ValueError(f"tension cut-off {tension!r} must not be positive (compression is); without cohesion it is 0")
    if gaps and k > 0.0:
        raise ValueError("a gap can only be remembered of a material without cohesion")
    apex = -k / slope if slope > 0.0 else -math.inf
    if tension > -math.inf:
        tension = max(tension, apex)
    return DruckerPrager(*lame_constants(young, poisson), k, slope, flow, tension, apex, gaps)


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
    gaps: bool | None = None,
) -> DruckerPrager:
    """The law of cohesion [pressure], friction and dilation angle [degrees]. gaps: else where there is no cohesion."""
    if not 0.0 <= dilation <= friction:
        raise ValueError(f"dilation angle {dilation!r} must lie between 0 and the friction angle {friction!r}")
    k, slope = cone(cohesion, friction, match)
    flow = cone(cohesion, dilation, match)[1]
    gaps = cohesion == 0.0 if gaps is None else gaps
    return drucker_prager(young, poisson, k, slope, flow=flow, tension=tension, gaps=gaps)


@kernel
def on_cone(law, bulk, first, root):
    """Whether a trial beyond the cut-off returns to the cone before it gets there."""
    over = root - law.k - law.slope * law.tension
    return law.tension - first <= 9.0 * bulk * law.flow / law.shear * over


@law_body(stress_update, DruckerPrager)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    bulk = law.lame + 2.0 / 3.0 * law.shear
    trial = mean + bulk * volumetric
    pull = trial
    if law.gaps:
        pull += bulk * state[GAP, i]
    root = math.sqrt(second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    first = -3.0 * pull
    left = root
    if first < law.tension and not (law.keeps_shear and on_cone(law, bulk, first, root)):
        first = law.tension
        left = min(root, law.k + law.slope * first) if law.keeps_shear else 0.0
    else:
        over = root - law.k - law.slope * first
        if over > 0.0:
            first += 9.0 * bulk * law.flow * over / (law.shear + 9.0 * bulk * law.slope * law.flow)
            left = min(root, law.k + law.slope * first)
            if left < 0.0:
                first = law.apex
                left = 0.0
    if law.gaps:
        state[GAP, i] = min(max(0.0, pull) / bulk, OPEN) if left == 0.0 else 0.0
    new = -first / 3.0
    scale = left / root if root > 0.0 else 0.0
    work = 0.0
    if left < root or first != -3.0 * trial:
        state[PLASTIC_STRAIN, i] += (root - left) / (math.sqrt(3.0) * law.shear)
        along = s_xx * x_xx + s_yy * x_yy + s_zz * x_zz + 2.0 * (s_xy * x_xy + s_yz * x_yz + s_zx * x_zx)
        work = flow_work(bulk, law.shear, mean, trial, new, along, root, scale)
    mean = new
    return scale * x_xx + mean, scale * x_yy + mean, scale * x_zz + mean, scale * x_xy, scale * x_yz, scale * x_zx, work


@law_body(state_rows, DruckerPrager)
def _rows(law):
    return 2 if law.gaps else 1


@law_body(bulk_modulus, DruckerPrager)
def _bulk(law):
    return law.lame + 2.0 / 3.0 * law.shear
