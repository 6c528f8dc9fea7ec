"""Principal values and directions of a symmetric tensor by Jacobi's rotations: no LAPACK, exact for equal values."""

from __future__ import annotations

import math

from ..jit import kernel
from .invariants import second_invariant


@kernel
def greatest_deviator(s_xx, s_yy, s_zz, s_xy, s_yz, s_zx):
    """The greatest principal value of a deviator, by its third invariant."""
    root = math.sqrt(second_invariant(s_xx, s_yy, s_zz, s_xy, s_yz, s_zx) / 3.0)
    if not root > 0.0:
        return root
    third = s_xx * s_yy * s_zz + 2.0 * s_xy * s_yz * s_zx - s_xx * s_yz**2 - s_yy * s_zx**2 - s_zz * s_xy**2
    return 2.0 * root * math.cos(math.acos(min(1.0, max(-1.0, 0.5 * third / root**3))) / 3.0)


@kernel
def _turn(a_pp, a_qq, a_pq):
    """Cosine and sine of the rotation that makes a_pq zero, and the tangent."""
    if a_pq == 0.0:
        return 1.0, 0.0, 0.0
    half = 0.5 * (a_qq - a_pp) / a_pq
    tangent = math.copysign(1.0, half) / (abs(half) + math.hypot(half, 1.0))
    cosine = 1.0 / math.sqrt(1.0 + tangent * tangent)
    return cosine, tangent * cosine, tangent


@kernel
def _mix(c, s, p, q):
    return c * p - s * q, s * p + c * q


@kernel
def principal(xx, yy, zz, xy, yz, zx):
    """Principal values (3, in no order) and their directions as columns (9: rows x, y, z)."""
    ax, bx, cx = 1.0, 0.0, 0.0
    ay, by, cy = 0.0, 1.0, 0.0
    az, bz, cz = 0.0, 0.0, 1.0
    least = 1e-17 * (abs(xx) + abs(yy) + abs(zz) + abs(xy) + abs(yz) + abs(zx))
    for _ in range(12):
        if not abs(xy) + abs(yz) + abs(zx) > least:
            break
        c, s, t = _turn(xx, yy, xy)
        xx, yy, xy = xx - t * xy, yy + t * xy, 0.0
        zx, yz = _mix(c, s, zx, yz)
        ax, bx = _mix(c, s, ax, bx)
        ay, by = _mix(c, s, ay, by)
        az, bz = _mix(c, s, az, bz)
        c, s, t = _turn(yy, zz, yz)
        yy, zz, yz = yy - t * yz, zz + t * yz, 0.0
        xy, zx = _mix(c, s, xy, zx)
        bx, cx = _mix(c, s, bx, cx)
        by, cy = _mix(c, s, by, cy)
        bz, cz = _mix(c, s, bz, cz)
        c, s, t = _turn(xx, zz, zx)
        xx, zz, zx = xx - t * zx, zz + t * zx, 0.0
        xy, yz = _mix(c, s, xy, yz)
        ax, cx = _mix(c, s, ax, cx)
        ay, cy = _mix(c, s, ay, cy)
        az, cz = _mix(c, s, az, cz)
    return xx, yy, zz, ax, bx, cx, ay, by, cy, az, bz, cz
