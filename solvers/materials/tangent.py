"""The consistent tangent of a law's stress update, for implicit solvers.

The tangent is of the update itself, not of the rate equations, so that Newton's method converges quadratically (Simo &
Taylor 1985). A law without a body of its own is differentiated by central differences of its update. Bodies stand in
`metal_tangent` and `soil_tangent`.
"""

from __future__ import annotations

from .elastic import Elastic
from .law import dispatched, law_body, stress_update

STEP = 1e-4  # of the largest strain increment, for central differences
LEAST = 1e-9  # strain
REMNANT = 1e-7  # of the elastic stiffness, where the stress answers to no strain at all


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


@dispatched
def symmetric_tangent(law):
    """Whether the tangent is symmetric in all states: a solver may then keep half of the matrix."""
    return True


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
