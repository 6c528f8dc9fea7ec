"""Rotation of a stress by a spin increment (Jaumann rate, [T] 4.6.1.8)."""

from __future__ import annotations

from ..jit import kernel


@kernel
def spin_rotation(w_xy, w_yz, w_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx):
    """Q s Q' with Q = (I - W/2)^-1 (I + W/2) (Hughes & Winget 1980): a rotation, whatever the increment.

    W_ij = (du_i/dx_j - du_j/dx_i)/2 at the middle of the increment. Adding W s - s W alone, as a first-order rule does,
    makes stress grow by the square of the increment: 20 % in ten turns of ten thousand steps.
    """
    f = 1.0 / (1.0 + 0.25 * (w_xy * w_xy + w_yz * w_yz + w_zx * w_zx))
    xx = 1.0 - 0.5 * f * (w_xy * w_xy + w_zx * w_zx)
    yy = 1.0 - 0.5 * f * (w_xy * w_xy + w_yz * w_yz)
    zz = 1.0 - 0.5 * f * (w_yz * w_yz + w_zx * w_zx)
    half_xy = 0.5 * f * w_yz * w_zx
    half_yz = 0.5 * f * w_zx * w_xy
    half_zx = 0.5 * f * w_xy * w_yz
    xy = half_xy + f * w_xy
    yx = half_xy - f * w_xy
    yz = half_yz + f * w_yz
    zy = half_yz - f * w_yz
    zx = half_zx + f * w_zx
    xz = half_zx - f * w_zx
    a_xx = xx * s_xx + xy * s_xy + xz * s_zx
    a_xy = xx * s_xy + xy * s_yy + xz * s_yz
    a_xz = xx * s_zx + xy * s_yz + xz * s_zz
    a_yx = yx * s_xx + yy * s_xy + yz * s_zx
    a_yy = yx * s_xy + yy * s_yy + yz * s_yz
    a_yz = yx * s_zx + yy * s_yz + yz * s_zz
    a_zx = zx * s_xx + zy * s_xy + zz * s_zx
    a_zy = zx * s_xy + zy * s_yy + zz * s_yz
    a_zz = zx * s_zx + zy * s_yz + zz * s_zz
    return (
        a_xx * xx + a_xy * xy + a_xz * xz,
        a_yx * yx + a_yy * yy + a_yz * yz,
        a_zx * zx + a_zy * zy + a_zz * zz,
        a_xx * yx + a_xy * yy + a_xz * yz,
        a_yx * zx + a_yy * zy + a_yz * zz,
        a_zx * xx + a_zy * xy + a_zz * xz,
    )


@kernel
def first_order_spin(w_xy, w_yz, w_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx):
    """s + W s - s W: what the original program does."""
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
