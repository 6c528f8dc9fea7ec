"""The consistent tangent of a law's stress update, for implicit solvers.

The tangent is of the update itself, not of the rate equations, so that Newton's method converges quadratically (Simo &
Taylor 1985). A law without a body of its own is differentiated by central differences of its update.
"""

from __future__ import annotations

import math

from .elastic import Elastic
from .invariants import THIRD
from .law import PLASTIC_STRAIN, dispatched, law_body, stress_update
from .von_mises import VonMisesIsotropic, VonMisesMixed

STEP = 1e-4  # of the largest strain increment, for central differences
LEAST = 1e-9  # strain


@dispatched
def stress_and_tangent(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i,
    scratch, modulus, j,
):  # fmt: skip
    """As `stress_update`, and modulus[j] (6, 6): its derivative by strain, shears as angles (doubled).

    scratch: (k, 2), as many rows as the state.
    """
    rows = state.shape[0]
    for k in range(rows):
        scratch[k, 0] = state[k, i]
    most = max(abs(de_xx), abs(de_yy), abs(de_zz), abs(de_xy), abs(de_yz), abs(de_zx))
    step = max(STEP * most, LEAST)
    for c in range(6):
        size = step if c < 3 else 0.5 * step
        d0 = size if c == 0 else 0.0
        d1 = size if c == 1 else 0.0
        d2 = size if c == 2 else 0.0
        d3 = size if c == 3 else 0.0
        d4 = size if c == 4 else 0.0
        d5 = size if c == 5 else 0.0
        for k in range(rows):
            scratch[k, 1] = scratch[k, 0]
        p0, p1, p2, p3, p4, p5, _ = stress_update(
            law, de_xx + d0, de_yy + d1, de_zz + d2, de_xy + d3, de_yz + d4, de_zx + d5,
            s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, scratch, 1,
        )  # fmt: skip
        for k in range(rows):
            scratch[k, 1] = scratch[k, 0]
        m0, m1, m2, m3, m4, m5, _ = stress_update(
            law, de_xx - d0, de_yy - d1, de_zz - d2, de_xy - d3, de_yz - d4, de_zx - d5,
            s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, scratch, 1,
        )  # fmt: skip
        half = 0.5 / step
        modulus[j, 0, c] = (p0 - m0) * half
        modulus[j, 1, c] = (p1 - m1) * half
        modulus[j, 2, c] = (p2 - m2) * half
        modulus[j, 3, c] = (p3 - m3) * half
        modulus[j, 4, c] = (p4 - m4) * half
        modulus[j, 5, c] = (p5 - m5) * half
    return stress_update(
        law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
    )


@law_body(stress_and_tangent, Elastic)
def _elastic(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i,
    scratch, modulus, j,
):  # fmt: skip
    for r in range(6):
        for c in range(6):
            modulus[j, r, c] = 0.0
    for r in range(3):
        for c in range(3):
            modulus[j, r, c] = law.lame
        modulus[j, r, r] += 2.0 * law.shear
        modulus[j, r + 3, r + 3] = law.shear
    return stress_update(
        law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
    )


@law_body(stress_and_tangent, VonMisesIsotropic, VonMisesMixed)
def _von_mises(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i,
    scratch, modulus, j,
):  # fmt: skip
    """Simo & Taylor 1985: K 1x1 + 2 G a I' - 2 G b n x n."""
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
    scale, along = 1.0, 0.0
    n0 = n1 = n2 = n3 = n4 = n5 = 0.0
    if flow > 0.0:
        de_m = (de_xx + de_yy + de_zz) * THIRD
        mean = (s_xx + s_yy + s_zz) * THIRD
        n0 = s_xx - mean + g2 * (de_xx - de_m) - a0
        n1 = s_yy - mean + g2 * (de_yy - de_m) - a1
        n2 = s_zz - mean + g2 * (de_zz - de_m) - a2
        n3 = s_xy + g2 * de_xy - a3
        n4 = s_yz + g2 * de_yz - a4
        n5 = s_zx + g2 * de_zx - a5
        size = math.sqrt(n0 * n0 + n1 * n1 + n2 * n2 + 2.0 * (n3 * n3 + n4 * n4 + n5 * n5))
        scale = 1.0 - 1.5 * g2 * flow / (math.sqrt(1.5) * size)
        along = g2 * (1.5 * g2 / (1.5 * g2 + law.hardening) - (1.0 - scale)) / (size * size)
    bulk = law.lame + g2 * THIRD
    shear = g2 * scale
    for r in range(6):
        nr = n0 if r == 0 else n1 if r == 1 else n2 if r == 2 else n3 if r == 3 else n4 if r == 4 else n5
        for c in range(6):
            nc = n0 if c == 0 else n1 if c == 1 else n2 if c == 2 else n3 if c == 3 else n4 if c == 4 else n5
            value = -along * nr * nc
            if r < 3 and c < 3:
                value += bulk - shear * THIRD
            if r == c:
                value += shear if r < 3 else 0.5 * shear
            modulus[j, r, c] = value
    return out
