"""Rotation of a stress by a spin increment (Jaumann rate, [T] 4.6.1.8)."""

from __future__ import annotations

from ..jit import kernel


@kernel
def spin_rotation(w_xy, w_yz, w_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx):
    """s + W s - s W to first order in the spin increment, w_ij = (du_i/dx_j - du_j/dx_i)/2, W_zx = -W_xz."""
    xx = s_xx + 2.0 * (w_xy * s_xy - w_zx * s_zx)
    yy = s_yy + 2.0 * (w_yz * s_yz - w_xy * s_xy)
    zz = s_zz + 2.0 * (w_zx * s_zx - w_yz * s_yz)
    xy = s_xy + w_xy * (s_yy - s_xx) - w_zx * s_yz + w_yz * s_zx
    yz = s_yz + w_yz * (s_zz - s_yy) - w_xy * s_zx + w_zx * s_xy
    zx = s_zx + w_zx * (s_xx - s_zz) - w_yz * s_xy + w_xy * s_yz
    return xx, yy, zz, xy, yz, zx


@kernel
def rotate_rows(w_xy, w_yz, w_zx, state, row, i):
    """The tensor in six rows of the state, from `row` on, at point i."""
    turned = spin_rotation(
        w_xy, w_yz, w_zx,
        state[row, i], state[row + 1, i], state[row + 2, i], state[row + 3, i], state[row + 4, i], state[row + 5, i],
    )  # fmt: skip
    for k in range(6):
        state[row + k, i] = turned[k]
