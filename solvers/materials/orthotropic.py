"""Orthotropic linear elasticity: nine constants along three axes, which need not be those of the coordinates.

Compliance by pairs of axes: e_xx = s_xx/Ex - nu_xy s_yy/Ex - .., so nu_xy/Ex = nu_yx/Ey; shear angles s_xy/Gxy. Stress
and strain are the law's own axes' only at the first shape: with a turning body the total Lagrangian formulation keeps
them so, the updated one does not turn the stiffness.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .law import law_body, stress_update, wave_speed
from .tangent import stress_and_tangent

Floats = NDArray[np.float64]
_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))


class Orthotropic(NamedTuple):
    """stiffness: (6, 6) of stresses by strains, shears as angles [pressure]; greatest: stiffness of a plane wave."""

    stiffness: Floats
    greatest: float


def orthotropic(
    young: Sequence[float], poisson: Sequence[float], shear: Sequence[float], axes: Any = None
) -> Orthotropic:
    """The law of Ex Ey Ez, nu_xy nu_yz nu_zx, Gxy Gyz Gzx. axes: (3, 3), rows are its axes' directions, or None."""
    if not (min(young) > 0.0 and min(shear) > 0.0 and math.isfinite(sum(young) + sum(shear) + sum(poisson))):
        raise ValueError(f"moduli {(*young, *shear)!r} must be positive")
    compliance = np.diag([1.0 / value for value in (*young, *shear)])
    for k, value in enumerate(poisson):
        other = (k + 1) % 3
        compliance[k, other] = compliance[other, k] = -value / young[k]
    if not np.linalg.eigvalsh(compliance).min() > 0.0:
        raise ValueError(f"Poisson's ratios {tuple(poisson)!r} do not go with the moduli {tuple(young)!r}: strain "
                         "would release energy")  # fmt: skip
    stiffness = np.linalg.inv(compliance)
    if axes is not None:
        turn = _strain_turn(np.asarray(axes, dtype=float))
        stiffness = turn.T @ stiffness @ turn
    stiffness = np.ascontiguousarray(0.5 * (stiffness + stiffness.T))
    return Orthotropic(stiffness, float(np.linalg.eigvalsh(stiffness[:3, :3]).max()))


def axes_of(first: Sequence[float], second: Sequence[float]) -> Floats:
    """Three right-handed axes: along `first`, in the plane of both, and across it; ValueError where they are one."""
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    across = np.cross(a, b)
    if not np.linalg.norm(across) > 1e-9 * np.linalg.norm(a) * np.linalg.norm(b):
        raise ValueError(f"{tuple(first)!r} and {tuple(second)!r} give no axes: they are parallel, or 0")
    a, across = a / np.linalg.norm(a), across / np.linalg.norm(across)
    return np.stack([a, np.cross(across, a), across])


def _strain_turn(axes: Floats) -> Floats:
    """(6, 6) from strains in the coordinates to those in the axes, shears as angles."""
    if not np.allclose(axes @ axes.T, np.eye(3), atol=1e-9):
        raise ValueError("the material's axes must be unit vectors at right angles")
    turn = np.empty((6, 6))
    for r, (i, j) in enumerate(_PAIRS):
        for c, (k, l) in enumerate(_PAIRS):
            both = axes[i, k] * axes[j, l] + axes[i, l] * axes[j, k]
            turn[r, c] = 0.5 * both * (1.0 if r < 3 else 2.0)
    return turn


@law_body(stress_update, Orthotropic)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    c = law.stiffness
    g_xy, g_yz, g_zx = 2.0 * de_xy, 2.0 * de_yz, 2.0 * de_zx
    return (
        s_xx + c[0, 0] * de_xx + c[0, 1] * de_yy + c[0, 2] * de_zz + c[0, 3] * g_xy + c[0, 4] * g_yz + c[0, 5] * g_zx,
        s_yy + c[1, 0] * de_xx + c[1, 1] * de_yy + c[1, 2] * de_zz + c[1, 3] * g_xy + c[1, 4] * g_yz + c[1, 5] * g_zx,
        s_zz + c[2, 0] * de_xx + c[2, 1] * de_yy + c[2, 2] * de_zz + c[2, 3] * g_xy + c[2, 4] * g_yz + c[2, 5] * g_zx,
        s_xy + c[3, 0] * de_xx + c[3, 1] * de_yy + c[3, 2] * de_zz + c[3, 3] * g_xy + c[3, 4] * g_yz + c[3, 5] * g_zx,
        s_yz + c[4, 0] * de_xx + c[4, 1] * de_yy + c[4, 2] * de_zz + c[4, 3] * g_xy + c[4, 4] * g_yz + c[4, 5] * g_zx,
        s_zx + c[5, 0] * de_xx + c[5, 1] * de_yy + c[5, 2] * de_zz + c[5, 3] * g_xy + c[5, 4] * g_yz + c[5, 5] * g_zx,
        0.0,
    )


@law_body(stress_and_tangent, Orthotropic)
def _tangent(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i,
    scratch, modulus, j,
):  # fmt: skip
    for r in range(6):
        for c in range(6):
            modulus[j, r, c] = law.stiffness[r, c]
    return stress_update(
        law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
    )


@law_body(wave_speed, Orthotropic)
def _wave(law, rho, e, state, i):
    return math.sqrt(law.greatest / rho)
