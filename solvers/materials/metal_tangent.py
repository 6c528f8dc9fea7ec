"""Consistent tangents of von Mises's laws (Simo & Taylor 1985): K 1x1 + 2 G a I' - b n x n.

n is the trial deviator relative to the back stress before the step, which is why one body serves isotropic and
kinematic hardening alike. With a strain rate (Cowper & Symonds) a term n x e' joins them, of the rate's own growth with
the strain e' of the step: it has no symmetry.
"""

from __future__ import annotations

import math

from .hardening import yield_at
from .invariants import THIRD, second_invariant
from .law import PLASTIC_STRAIN, dispatched, law_body, stress_update
from .tangent import stress_and_tangent, symmetric_tangent
from .von_mises import VonMisesCurve, VonMisesIsotropic, VonMisesMixed, VonMisesMixedCurve


@dispatched
def _slope(law, plastic):
    """dY/dep, hardening of both kinds together."""
    return law.hardening


@law_body(_slope, VonMisesCurve, VonMisesMixedCurve)
def _curve_slope(law, plastic):
    return yield_at(law.hardening, plastic)[1]


@dispatched
def _rate_factor(law, square, dt):
    """1 + (rate/C)^(1/p) and 1/p of a step; square: J2 of its strain."""
    return 1.0, 0.0


@law_body(_rate_factor, VonMisesCurve)
def _cowper_symonds(law, square, dt):
    if not (law.rate < math.inf and dt > 0.0 and square > 0.0):
        return 1.0, 0.0
    return 1.0 + math.pow(math.sqrt(4.0 / 3.0 * square) / (dt * law.rate), law.power), law.power


@law_body(symmetric_tangent, VonMisesCurve)
def _symmetric(law):
    return law.rate == math.inf


@law_body(stress_and_tangent, VonMisesIsotropic, VonMisesMixed, VonMisesCurve, VonMisesMixedCurve)
def _von_mises(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i,
    scratch, modulus, j,
):  # fmt: skip
    before = state[PLASTIC_STRAIN, i]
    shifted = state.shape[0] > 6  # a back stress
    a0 = state[1, i] if shifted else 0.0
    a1 = state[2, i] if shifted else 0.0
    a2 = state[3, i] if shifted else 0.0
    a3 = state[4, i] if shifted else 0.0
    a4 = state[5, i] if shifted else 0.0
    a5 = state[6, i] if shifted else 0.0
    out = stress_update(
        law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
    )
    g2 = 2.0 * law.shear
    flow = state[PLASTIC_STRAIN, i] - before
    scale, along, across = 1.0, 0.0, 0.0
    n0 = n1 = n2 = n3 = n4 = n5 = 0.0
    de_m = (de_xx + de_yy + de_zz) * THIRD
    if flow > 0.0:
        mean = (s_xx + s_yy + s_zz) * THIRD
        n0 = s_xx - mean + g2 * (de_xx - de_m) - a0
        n1 = s_yy - mean + g2 * (de_yy - de_m) - a1
        n2 = s_zz - mean + g2 * (de_zz - de_m) - a2
        n3 = s_xy + g2 * de_xy - a3
        n4 = s_yz + g2 * de_yz - a4
        n5 = s_zx + g2 * de_zx - a5
        size = math.sqrt(n0 * n0 + n1 * n1 + n2 * n2 + 2.0 * (n3 * n3 + n4 * n4 + n5 * n5))
        trial = math.sqrt(1.5) * size
        square = second_invariant(de_xx - de_m, de_yy - de_m, de_zz - de_m, de_xy, de_yz, de_zx)
        factor, power = _rate_factor(law, square, dt)
        stiff = 1.5 * g2 + factor * _slope(law, state[PLASTIC_STRAIN, i])
        scale = 1.0 - 1.5 * g2 * flow / trial
        along = g2 * (1.5 * g2 / stiff - (1.0 - scale)) / (size * size)
        if power > 0.0:
            # d factor = (factor - 1)/p e':de/(e':e')
            across = 1.5 * g2 / (trial * stiff) * (trial - 1.5 * g2 * flow) / factor
            across *= (factor - 1.0) * power / (2.0 * square)
    bulk = law.lame + g2 * THIRD
    shear = g2 * scale
    for r in range(6):
        nr = n0 if r == 0 else n1 if r == 1 else n2 if r == 2 else n3 if r == 3 else n4 if r == 4 else n5
        for c in range(6):
            nc = n0 if c == 0 else n1 if c == 1 else n2 if c == 2 else n3 if c == 3 else n4 if c == 4 else n5
            value = -along * nr * nc
            if across != 0.0:
                ec = de_xx - de_m if c == 0 else de_yy - de_m if c == 1 else de_zz - de_m if c == 2 else (
                    de_xy if c == 3 else de_yz if c == 4 else de_zx
                )  # fmt: skip
                value += across * nr * ec
            if r < 3 and c < 3:
                value += bulk - shear * THIRD
            if r == c:
                value += shear if r < 3 else 0.5 * shear
            modulus[j, r, c] = value
    return out
