"""The consistent tangent of Mohr-Coulomb's law: planes and edges by their own projections, corners by none.

In the trial's principal axes the normal stresses answer by a constant matrix of the case, n = n0 + T p*, and a shear
between two axes by (n_a - n_b)/(p_a - p_b), which turns the stress with its axes (de Souza Neto, Peric & Owen 2008, A).
"""

from __future__ import annotations

import numpy as np

from ..jit import kernel
from .invariants import elastic_trial, second_invariant
from .law import law_body, stress_update
from .mohr_coulomb import MohrCoulomb, kept, mohr_coulomb_return, planes, sorted_principal, taken, well_inside
from .tangent import REMNANT, stress_and_tangent, symmetric_tangent

CLOSE = 1e-9  # principal values are one below this share of their size


@kernel
def _answers(law, case, t):
    """t (3, 3): slopes of the returned principal stresses by the trial's, in a case of the return."""
    for k in range(3):
        for l in range(3):
            t[k, l] = 0.0 if k != l else 1.0 if case >= 0 else REMNANT
    if case < 0:
        return
    a, r, b, q = planes(law, case)
    g2 = 2.0 * law.shear
    r_all, q_all = law.lame * (r[0] + r[1] + r[2]), law.lame * (q[0] + q[1] + q[2])
    aa = taken(law, a[0], a[1], a[2], r[0], r[1], r[2])
    bb, ab, ba = 1.0, 0.0, 0.0
    if case > 1:
        ab = taken(law, a[0], a[1], a[2], q[0], q[1], q[2])
        ba = taken(law, b[0], b[1], b[2], r[0], r[1], r[2])
        bb = taken(law, b[0], b[1], b[2], q[0], q[1], q[2])
    below = aa * bb - ab * ba
    for l in range(3):
        m = (a[l] * bb - b[l] * ab) / below
        n = (b[l] * aa - a[l] * ba) / below
        for k in range(3):
            t[k, l] -= (r_all + g2 * r[k]) * m + (q_all + g2 * q[k]) * n


@law_body(stress_and_tangent, MohrCoulomb)
def _tangent(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i,
    scratch, modulus, j,
):  # fmt: skip
    g2 = 2.0 * law.shear
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    mean += (law.lame + 2.0 / 3.0 * law.shear) * volumetric
    p1, p2, p3 = mean, mean, mean
    ax, bx, cx, ay, by, cy, az, bz, cz = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    elastic = well_inside(law, mean, second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    if not elastic:
        p1, p2, p3, ax, bx, cx, ay, by, cy, az, bz, cz = sorted_principal(
            x_xx + mean, x_yy + mean, x_zz + mean, x_xy, x_yz, x_zx
        )
        elastic = kept(law, p1, p2, p3, 0.0)
    n1, n2, n3, case = p1, p2, p3, 9
    if not elastic:
        n1, n2, n3, case = mohr_coulomb_return(law, p1, p2, p3)
    for r in range(6):
        for c in range(6):
            modulus[j, r, c] = 0.0
    if elastic:
        for r in range(3):
            for c in range(3):
                modulus[j, r, c] = law.lame
            modulus[j, r, r] += g2
            modulus[j, r + 3, r + 3] = law.shear
    else:
        t, m = np.empty((3, 3)), np.empty((3, 6))
        _answers(law, case, t)
        x, y, z = (ax, bx, cx), (ay, by, cy), (az, bz, cz)
        for k in range(3):
            _pair(x[k], y[k], z[k], x[k], y[k], z[k], m, k)
        p, n = (p1, p2, p3), (n1, n2, n3)
        size = abs(p1) + abs(p3)
        for k in range(3):
            for l in range(3):
                row = t[k, 0] + t[k, 1] + t[k, 2]
                value = law.lame * row + g2 * t[k, l]
                for r in range(6):
                    for c in range(6):
                        modulus[j, r, c] += value * m[k, r] * m[l, c]
        for k in range(3):
            l = (k + 1) % 3
            apart = p[k] - p[l]
            if abs(apart) > CLOSE * size:
                ratio = (n[k] - n[l]) / apart
            else:
                ratio = 0.5 * (t[k, k] - t[k, l] + t[l, l] - t[l, k])
            _pair(x[k], y[k], z[k], x[l], y[l], z[l], m, 0)
            for r in range(6):
                for c in range(6):
                    modulus[j, r, c] += 2.0 * g2 * max(ratio, REMNANT) * m[0, r] * m[0, c]
    return stress_update(
        law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
    )


@kernel
def _pair(ax, ay, az, bx, by, bz, m, k):
    """m[k] (6,): the symmetric part of a x b."""
    m[k, 0] = ax * bx
    m[k, 1] = ay * by
    m[k, 2] = az * bz
    m[k, 3] = 0.5 * (ax * by + ay * bx)
    m[k, 4] = 0.5 * (ay * bz + az * by)
    m[k, 5] = 0.5 * (az * bx + ax * bz)


@law_body(symmetric_tangent, MohrCoulomb)
def _associated(law):
    return law.sine == law.flow
