"""Consistent tangents of the laws that act on the mean stress and on the size of the deviator alone.

Drucker-Prager's cone, the cap, Cam-clay and Perzyna's overstress scale the trial deviator and shift the mean stress:
(m, J) = F(m*, J*), m tension positive. Given the four slopes of F - by implicit differentiation of the law's own
residuals - the tangent follows for all alike (`isotropic_modulus`). On an apex or a cut-off F is constant: a remnant of
the elastic stiffness is left there, so that a node between such points has a place to be.
"""

from __future__ import annotations

import math

from ..jit import kernel
from .cam_clay import CamClay, clay_return
from .cap import GROWTH, Cap, KinematicCap
from .cap_return import cap_slopes, inside
from .drucker_prager import DruckerPrager, on_cone
from .invariants import elastic_trial, second_invariant
from .law import GAP, dispatched, law_body, stress_update
from .perzyna import Perzyna, overstress
from .tangent import REMNANT, stress_and_tangent, symmetric_tangent


@kernel
def isotropic_modulus(shear, bulk, root, left, slopes, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx, modulus, j):
    """modulus[j] of a trial deviator x of size J* = root that becomes `left`; slopes: as `_return` has them."""
    m_m, m_r, r_m, r_r = slopes
    scale = left / root if root > 0.0 else r_r
    xx = shear / (root * root) * (r_r - scale) if root > 0.0 else 0.0
    x1 = bulk * r_m / root if root > 0.0 else 0.0
    ix = shear * m_r / root if root > 0.0 else 0.0
    soft = shear * max(scale, REMNANT)
    for r in range(6):
        nr = x_xx if r == 0 else x_yy if r == 1 else x_zz if r == 2 else x_xy if r == 3 else x_yz if r == 4 else x_zx
        for c in range(6):
            nc = (
                x_xx if c == 0 else x_yy if c == 1 else x_zz if c == 2 else x_xy if c == 3 else x_yz if c == 4 else x_zx
            )  # fmt: skip
            value = xx * nr * nc
            if c < 3:
                value += x1 * nr
            if r < 3:
                value += ix * nc
            if r < 3 and c < 3:
                value += bulk * m_m - soft * 2.0 / 3.0
            if r == c:
                value += 2.0 * soft if r < 3 else soft
            modulus[j, r, c] = value


@dispatched
def _return(law, trial, root, dt, state, i):
    """J, and dm/dm*, dm/dJ*, dJ/dm*, dJ/dJ*, of a trial mean stress and J, from the state before the step."""
    raise NotImplementedError("no law of that class")


ELASTIC = (1.0, 0.0, 0.0, 1.0)
CONSTANT = (REMNANT, 0.0, 0.0, REMNANT)


@law_body(_return, DruckerPrager)
def _cone(law, trial, root, dt, state, i):
    bulk = law.lame + 2.0 / 3.0 * law.shear
    first = -3.0 * (trial + bulk * state[GAP, i] if law.gaps else trial)
    if first < law.tension and not (law.keeps_shear and on_cone(law, bulk, first, root)):
        strength = law.k + law.slope * law.tension
        if not law.keeps_shear or root > strength:
            return (strength if law.keeps_shear else 0.0), CONSTANT
        return root, (REMNANT, 0.0, 0.0, 1.0)
    over = root - law.k - law.slope * first
    if not over > 0.0:
        return root, ELASTIC
    soft = 1.0 / (law.shear + 9.0 * bulk * law.slope * law.flow)
    left = root - law.shear * soft * over
    if left < 0.0:
        return 0.0, CONSTANT
    spread = 3.0 * bulk * law.flow * soft
    cut = law.shear * soft
    return left, (1.0 - 3.0 * law.slope * spread, -spread, -3.0 * law.slope * cut, 1.0 - cut)


@law_body(_return, Cap)
def _cap(law, trial, root, dt, state, i):
    centre = max(0.0, law.start + state[GROWTH, i])
    if inside(law, -3.0 * trial, root, centre):
        return root, ELASTIC
    left, i_i, i_j, j_i, j_j = cap_slopes(law, law.shear, -3.0 * trial, root, centre)
    return left, (max(i_i, REMNANT), -i_j / 3.0, -3.0 * j_i, max(j_j, REMNANT))


@law_body(_return, CamClay)
def _clay(law, trial, root, dt, state, i):
    pc = law.first * math.exp(law.stiff * state[1, i])
    if not 3.0 * root * root / law.ratio**2 > -trial * (pc + trial):
        return root, ELASTIC
    three = math.sqrt(3.0)
    bulk = law.lame + 2.0 / 3.0 * law.shear
    deviator = three * root
    w, p, q, pc = clay_return(law, -trial, deviator, pc)
    square = law.ratio * law.ratio
    factor = 6.0 * law.shear / square
    c = 2.0 * p - pc
    # w - m c = 0 and the ellipse, for w and the multiplier m: at the critical state c is 0 and m is not w/c
    m = (deviator / q - 1.0) / factor if q > 0.0 else w / c
    shrink = 1.0 + factor * m
    a_w, a_m, a_p = 1.0 + m * (2.0 * bulk + law.stiff * pc), -c, -2.0 * m
    b_w, b_m, b_p = -bulk * c - p * law.stiff * pc, -2.0 * q * q / square * factor / shrink, c
    b_q = 2.0 * q / (square * shrink)
    below = a_w * b_m - a_m * b_w
    w_p, m_p = (a_m * b_p - a_p * b_m) / below, (b_w * a_p - a_w * b_p) / below
    w_q, m_q = a_m * b_q / below, -a_w * b_q / below
    turn = q * factor / shrink
    return q / three, (1.0 - bulk * w_p, bulk * w_q * three, turn * m_p / three, 1.0 / shrink - turn * m_q)


@law_body(_return, Perzyna)
def _viscous(law, trial, root, dt, state, i):
    rest = 3.0 * law.slope * trial - law.k - law.hardening * state[1, i]
    over = root + rest
    if not over > 0.0:
        return root, ELASTIC
    bulk = law.lame + 2.0 / 3.0 * law.shear
    volume = 9.0 * bulk * law.slope * law.flow + law.hardening
    falls = law.shear + volume
    f = overstress(law, over, falls, dt)
    grown = (over - f) / falls
    part = law.rate * dt * law.power / law.k * math.pow(f / law.k, law.power - 1.0)
    if law.shear * grown <= root:
        part /= 1.0 + falls * part
        spread = 3.0 * bulk * law.flow * part
        return root - law.shear * grown, (
            1.0 - 3.0 * law.slope * spread, -spread, -3.0 * law.slope * law.shear * part, 1.0 - law.shear * part,
        )  # fmt: skip
    f = overstress(law, rest, volume, dt) if rest > 0.0 else 0.0
    if not (rest > 0.0 and (rest - f) / volume > root / law.shear):
        return 0.0, (1.0, -3.0 * bulk * law.flow / law.shear, 0.0, 0.0)
    part = law.rate * dt * law.power / law.k * math.pow(f / law.k, law.power - 1.0)
    part /= 1.0 + volume * part
    return 0.0, (1.0 - 9.0 * bulk * law.slope * law.flow * part, 0.0, 0.0, 0.0)


@law_body(stress_and_tangent, DruckerPrager, Cap, CamClay, Perzyna)
def _tangent(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i,
    scratch, modulus, j,
):  # fmt: skip
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    bulk = law.lame + 2.0 / 3.0 * law.shear
    root = math.sqrt(second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    left, slopes = _return(law, mean + bulk * volumetric, root, dt, state, i)
    isotropic_modulus(law.shear, bulk, root, left, slopes, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx, modulus, j)
    return stress_update(
        law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
    )


@law_body(symmetric_tangent, DruckerPrager, Perzyna)
def _associated(law):
    return law.slope == law.flow


@law_body(symmetric_tangent, CamClay, Cap, KinematicCap)
def _hardening_by_volume(law):
    """The flow is associated, but the implicit step's surface moves with the compaction that the step itself makes."""
    return False
