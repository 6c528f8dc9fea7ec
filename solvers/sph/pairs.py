"""Pair loops over the Verlet list: the velocity gradient, here, and `momentum`.

Each is a serial function over a block of particles. What it reads of the neighbours is packed into cache lines (see
`packed`) and brought into a buffer of whole vectors; a contiguous, branch-free inner loop over it vectorises. What a
scene does not have is None and is left out when the loop is compiled: z and w in the plane, h where all smoothing
lengths are equal, mass where all masses are equal, nearest where the time step does not ask for it, and the cures.
Arrays have one more entry than there are particles: the dummy that pads the rows, far away.

Shapes: x, y, z, u, v, w, h, mass, volume (n + 1,); gradient (d*d, n + 1) rows du/dx du/dy (du/dz) dv/dx ...; s
(k, n + 1): (sigma - q I)/rho^2, k = 6 (xx yy zz xy yz zx) or 3 (xx yy xy) in the plane; with the gradient correction
s B, not symmetric, k = 9 or 4 row by row. scale is a_d / h^(d+2), or a_d alone where h is given; a line (one
dimension) runs as a plane with y = 0 and says so by `line`. shape: the kernel, see `smoothing`.
"""

from __future__ import annotations

import numpy as np

from ..gather import LANES, ROOM, gather
from ..jit import inlined_kernel
from .packed import motion_of
from .smoothing import inverse_root, shape_slope

TINY = 1e-30  # keeps the inverse root of coincident particles finite
WELL = 2e-3  # a shape matrix whose determinant is this small beside its mean eigenvalue's power is not inverted
# 1/tr(inverse) of the shape matrix, below which less and less of the inverse is taken: whole at the corner of a solid
# block (0.05 at least by the cubic spline, shaken by a quarter), and never more than a factor of 25. A grain that flies
# past two others far off has a small matrix, well conditioned; its whole inverse multiplied velocities by thousands,
# and threw grain through the floor.
SEEN = 0.04


@inlined_kernel
def velocity_gradient(
    i0, i1, first, count, rows, shape, packed, near, solid, h, inverse_h2, scale, line, gradient, correction, corrected,
    material,
):  # fmt: skip
    """grad v_i = sum_j V_j (v_j - v_i) (x) grad_i W_ij ([T] 4.6.1.13), of the packed motion. near: a buffer.

    solid: None in the plane; h: None where all are equal. correction: None, or (7 | 4, n + 1) for the inverse B of
    the shape matrix sum_j V_j (x_j - x_i) (x) grad_i W_ij, which then makes the gradient exact for linear fields
    (Randles & Libersky 1996): grad v B; and in its last row |B sum_j V_j grad_i W_ij|^2, what a particle strains itself
    by moving, which the critical step needs. corrected: (bodies,) 1, or 0 for those whose B is the unit matrix;
    material: (n + 1,) the body of a particle.
    """
    x, y, z, u, v, w, volume, size = motion_of(near, solid)
    for i in range(i0, i1):
        xi, yi, zi, ui, vi, wi, _, _ = motion_of(packed[i], solid)
        ux = 0.0
        uy = 0.0
        vx = 0.0
        vy = 0.0
        if solid is not None:
            uz = 0.0
            vz = 0.0
            wx = 0.0
            wy = 0.0
            wz = 0.0
        if correction is not None:
            gx_sum = 0.0
            gy_sum = 0.0
            mxx = 0.0
            myy = 0.0
            mxy = 0.0
            if solid is not None:
                gz_sum = 0.0
                mzz = 0.0
                myz = 0.0
                mzx = 0.0
        if h is not None:
            hi = 0.5 * h[i]
        begin = first[i]
        end = begin + count[i]
        while begin < end:
            some = min(ROOM, end - begin)
            for at in range(0, some, LANES):
                if solid is not None:
                    if h is not None:
                        gather(packed, rows, begin + at, near, at, 8)
                    else:
                        gather(packed, rows, begin + at, near, at, 7)
                elif h is not None:
                    gather(packed, rows, begin + at, near, at, 6)
                else:
                    gather(packed, rows, begin + at, near, at, 5)
            begin += some
            for k in range(np.uint64(some)):
                dx = xi - x[k]
                dy = yi - y[k]
                r2 = dx * dx + dy * dy
                if solid is not None:
                    dz = zi - z[k]
                    r2 += dz * dz
                if h is not None:
                    mean = hi + 0.5 * size[k]
                    ih2 = 1.0 / (mean * mean)
                    factor = scale * ih2 * ih2
                    if solid is not None:
                        factor *= mean * ih2
                    if line is not None:
                        factor *= mean
                else:
                    ih2 = inverse_h2
                    factor = scale
                q2 = r2 * ih2 + TINY
                iq = inverse_root(q2)
                factor = factor * volume[k] * shape_slope(shape, q2 * iq, iq)
                gx = dx * factor
                gy = dy * factor
                du = u[k] - ui
                dv = v[k] - vi
                ux += du * gx
                uy += du * gy
                vx += dv * gx
                vy += dv * gy
                if correction is not None:
                    gx_sum += gx
                    gy_sum += gy
                    mxx -= dx * gx
                    myy -= dy * gy
                    mxy -= dx * gy
                    if solid is not None:
                        mzx -= dz * gx
                        myz -= dz * gy
                if solid is not None:
                    gz = dz * factor
                    dw = w[k] - wi
                    uz += du * gz
                    vz += dv * gz
                    wx += dw * gx
                    wy += dw * gy
                    wz += dw * gz
                    if correction is not None:
                        gz_sum += gz
                        mzz -= dz * gz
        if correction is not None:
            if solid is not None:
                cxx = myy * mzz - myz * myz
                cxy = myz * mzx - mxy * mzz
                czx = mxy * myz - myy * mzx
                determinant = mxx * cxx + mxy * cxy + mzx * czx
                mean = (mxx + myy + mzz) / 3.0
                bxx = 1.0
                byy = 1.0
                bzz = 1.0
                bxy = 0.0
                byz = 0.0
                bzx = 0.0
                if determinant > WELL * mean * mean * mean and mean > 0.0:
                    cyy = mxx * mzz - mzx * mzx
                    czz = mxx * myy - mxy * mxy
                    part = corrected[material[i]] * min(1.0, determinant / (SEEN * (cxx + cyy + czz)))
                    inverse = part / determinant
                    bxx = cxx * inverse + (1.0 - part)
                    bxy = cxy * inverse
                    bzx = czx * inverse
                    byy = cyy * inverse + (1.0 - part)
                    byz = (mxy * mzx - mxx * myz) * inverse
                    bzz = czz * inverse + (1.0 - part)
                correction[0, i] = bxx
                correction[1, i] = byy
                correction[2, i] = bzz
                correction[3, i] = bxy
                correction[4, i] = byz
                correction[5, i] = bzx
                ox = gx_sum * bxx + gy_sum * bxy + gz_sum * bzx
                oy = gx_sum * bxy + gy_sum * byy + gz_sum * byz
                oz = gx_sum * bzx + gy_sum * byz + gz_sum * bzz
                correction[6, i] = corrected[material[i]] * (ox * ox + oy * oy + oz * oz)
                ux, uy, uz = (
                    ux * bxx + uy * bxy + uz * bzx, ux * bxy + uy * byy + uz * byz, ux * bzx + uy * byz + uz * bzz
                )  # fmt: skip
                vx, vy, vz = (
                    vx * bxx + vy * bxy + vz * bzx, vx * bxy + vy * byy + vz * byz, vx * bzx + vy * byz + vz * bzz
                )  # fmt: skip
                wx, wy, wz = (
                    wx * bxx + wy * bxy + wz * bzx, wx * bxy + wy * byy + wz * byz, wx * bzx + wy * byz + wz * bzz
                )  # fmt: skip
            else:
                if line is not None:
                    myy = mxx
                determinant = mxx * myy - mxy * mxy
                mean = 0.5 * (mxx + myy)
                bxx = 1.0
                byy = 1.0
                bxy = 0.0
                if determinant > WELL * mean * mean and mean > 0.0:
                    part = corrected[material[i]] * min(1.0, determinant / (SEEN * 2.0 * mean))
                    inverse = part / determinant
                    bxx = myy * inverse + (1.0 - part)
                    byy = mxx * inverse + (1.0 - part)
                    bxy = -mxy * inverse
                correction[0, i] = bxx
                correction[1, i] = byy
                correction[2, i] = bxy
                ox = gx_sum * bxx + gy_sum * bxy
                oy = gx_sum * bxy + gy_sum * byy
                correction[3, i] = corrected[material[i]] * (ox * ox + oy * oy)
                ux, uy = ux * bxx + uy * bxy, ux * bxy + uy * byy
                vx, vy = vx * bxx + vy * bxy, vx * bxy + vy * byy
        if solid is not None:
            gradient[0, i] = ux
            gradient[1, i] = uy
            gradient[2, i] = uz
            gradient[3, i] = vx
            gradient[4, i] = vy
            gradient[5, i] = vz
            gradient[6, i] = wx
            gradient[7, i] = wy
            gradient[8, i] = wz
        else:
            gradient[0, i] = ux
            gradient[1, i] = uy
            gradient[2, i] = vx
            gradient[3, i] = vy
