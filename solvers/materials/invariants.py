"""What the laws share of tensor algebra: the elastic trial stress and its second invariant."""

from __future__ import annotations

from ..jit import kernel

THIRD = 1.0 / 3.0  # dividing costs the laws more than the rest of their elastic step


@kernel
def elastic_trial(
    shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
):  # fmt: skip
    """Volume increment, mean stress before it, and the deviator (6) of an elastic strain increment."""
    volumetric = de_xx + de_yy + de_zz
    mean = (s_xx + s_yy + s_zz) * THIRD
    g2 = 2.0 * shear
    shift = mean + g2 * THIRD * volumetric
    return (
        volumetric,
        mean,
        s_xx + g2 * de_xx - shift,
        s_yy + g2 * de_yy - shift,
        s_zz + g2 * de_zz - shift,
        s_xy + g2 * de_xy,
        s_yz + g2 * de_yz,
        s_zx + g2 * de_zx,
    )


@kernel
def flow_work(bulk, shear, mean, trial, new, along, root, scale):
    """Work of the plastic strain of an increment per volume, by the mean of old and new stress; at least 0.

    So it is what the increment's work, by that mean, leaves over the elastic energy's growth. mean, trial, new: mean
    stresses; the deviator ends as `scale` of its trial, whose invariant J is `root`; along: old deviator : trial.
    """
    volume = 0.5 * (mean + new) * (trial - new) / bulk
    return max(0.0, volume + 0.25 * (1.0 - scale) * (along + 2.0 * scale * root * root) / shear)


@kernel
def second_invariant(s_xx, s_yy, s_zz, s_xy, s_yz, s_zx):
    """J2 = s:s/2 of a deviator."""
    return 0.5 * (s_xx * s_xx + s_yy * s_yy + s_zz * s_zz) + s_xy * s_xy + s_yz * s_yz + s_zx * s_zx
