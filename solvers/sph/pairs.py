"""Pair loops over the Verlet list: velocity gradient and momentum.

Each is a serial function over a block of particles with one contiguous, branch-free inner loop that vectorises; what a
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

from ..bits import bits_of, of_bits
from ..gather import LANES, ROOM, gather
from ..jit import kernel
from .smoothing import inverse_root, shape_slope, shape_value

TINY = 1e-30  # keeps the inverse root of coincident particles finite
ALONE = np.int64(0x7E37E43C8800759C)  # the bits of 1e300: the squared distance of a particle without neighbours
WELL = 2e-3  # a shape matrix whose determinant is this small beside its mean eigenvalue's power is not inverted
# 1/tr(inverse) of the shape matrix, below which less and less of the inverse is taken: whole at the corner of a solid
# block (0.02 at least), and never more than a factor of 50. A grain that flies past two others far off has a small
# matrix, well conditioned; its whole inverse multiplied velocities by thousands, and threw grain through the floor.
SEEN = 0.02


@kernel
def velocity_gradient(
    i0, i1, first, count, rows, shape, packed, solid, h, inverse_h2, scale, line, gradient, correction
):
    """grad v_i = sum_j V_j (v_j - v_i) (x) grad_i W_ij ([T] 4.6.1.13), of the packed motion.

    solid: None in the plane; h: None where all are equal. correction: None, or (6 | 3, n + 1) for the inverse B of
    the shape matrix sum_j V_j (x_j - x_i) (x) grad_i W_ij, which then makes the gradient exact for linear fields
    (Randles & Libersky 1996): grad v B.
    """
    near = np.empty((LANES, ROOM))
    x = near[0]
    y = near[1]
    if solid is not None:
        z = near[2]
        u = near[3]
        v = near[4]
        w = near[5]
        volume = near[6]
        size = near[7]
    else:
        u = near[2]
        v = near[3]
        volume = near[4]
        size = near[5]
    for i in range(i0, i1):
        xi = packed[i, 0]
        yi = packed[i, 1]
        if solid is not None:
            zi = packed[i, 2]
            ui = packed[i, 3]
            vi = packed[i, 4]
            wi = packed[i, 5]
        else:
            ui = packed[i, 2]
            vi = packed[i, 3]
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
            mxx = 0.0
            myy = 0.0
            mxy = 0.0
            if solid is not None:
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
                    part = min(1.0, determinant / (SEEN * (cxx + cyy + czz)))
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
                    part = min(1.0, determinant / (SEEN * 2.0 * mean))
                    inverse = part / determinant
                    bxx = myy * inverse + (1.0 - part)
                    byy = mxx * inverse + (1.0 - part)
                    bxy = -mxy * inverse
                correction[0, i] = bxx
                correction[1, i] = byy
                correction[2, i] = bxy
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


@kernel
def momentum(
    i0, i1, first, count, rows, shape, packed, beside, z, s, weight, h, inverse_h2, scale, line, body, ax, ay, az,
    nearest, density, corrected, artificial, inverse_w, bx, by, bz,
):  # fmt: skip
    """a_i = sum_j m_j (s_i + s_j) . grad_i W_ij + g: the sum form that conserves momentum pair by pair.

    weight: masses, or None where all are equal and in the scale. Where bodies differ in density the sum is
    a_i = sum_j V_j (sigma_i + sigma_j) / rho_i . grad_i W_ij instead: the one whose work is that of the velocity
    gradient above; then s is the stress, the weights are the volumes and density is given. body: (3,) g. nearest: None,
    or (n + 1,) the squared distance to the nearest listed particle. corrected: None, or anything where s is s B.

    artificial: None, or the factor e of the artificial stress: the part of a pair's force that pulls the two together
    is lessened by e f^4, f = W(r)/W(spacing), inverse_w being the inverse of the latter's value; bx.. then keep that
    part of the acceleration. It is the term of Monaghan (2000) and Gray, Monaghan & Swift (2001), taken along the pair,
    where the instability W'' sigma > 0 lives, in place of the principal axes: central, so that it turns nothing.
    """
    near = np.empty((LANES, ROOM))
    x = near[0]
    y = near[1]
    if z is not None:
        more = np.empty((LANES, ROOM))
        weights = more[0]
        size = more[1]
        sxx = near[2]
        if corrected is not None:
            sxy = near[3]
            sxz = near[4]
            syx = near[5]
            syy = near[6]
            syz = near[7]
            szx = more[2]
            szy = more[3]
            szz = more[4]
        else:
            syy = near[3]
            szz = near[4]
            sxy = near[5]
            syz = near[6]
            szx = near[7]
    else:
        weights = near[2]
        size = near[3]
        sxx = near[4]
        if corrected is not None:
            sxy = near[5]
            syx = near[6]
            syy = near[7]
        else:
            syy = near[5]
            sxy = near[6]
    for i in range(i0, i1):
        xi = packed[i, 0]
        yi = packed[i, 1]
        xxi = s[0, i]
        if corrected is not None:
            xyi = s[1, i]
            if z is not None:
                xzi = s[2, i]
                yxi = s[3, i]
                yyi = s[4, i]
                yzi = s[5, i]
                zxi = s[6, i]
                zyi = s[7, i]
                zzi = s[8, i]
            else:
                yxi = s[2, i]
                yyi = s[3, i]
        else:
            yyi = s[1, i]
            if z is not None:
                zzi = s[2, i]
                xyi = s[3, i]
                yzi = s[4, i]
                zxi = s[5, i]
            else:
                xyi = s[2, i]
        a0 = 0.0
        a1 = 0.0
        if z is not None:
            zi = z[i]
            a2 = 0.0
        if artificial is not None:
            b0 = 0.0
            b1 = 0.0
            if z is not None:
                b2 = 0.0
        if h is not None:
            hi = 0.5 * h[i]
        if nearest is not None:
            least = ALONE
        begin = first[i]
        end = begin + count[i]
        while begin < end:
            some = min(ROOM, end - begin)
            for at in range(0, some, LANES):
                if z is not None:
                    gather(packed, rows, begin + at, near, at, 8)
                    if corrected is not None:
                        gather(beside, rows, begin + at, more, at, 5)
                    elif h is not None or weight is not None:
                        gather(beside, rows, begin + at, more, at, 2)
                elif corrected is not None:
                    gather(packed, rows, begin + at, near, at, 8)
                else:
                    gather(packed, rows, begin + at, near, at, 7)
            start = np.uint64(begin)
            begin += some
            for k in range(np.uint64(some)):
                dx = xi - x[k]
                dy = yi - y[k]
                r2 = dx * dx + dy * dy
                if z is not None:
                    dz = zi - z[rows[start + k]]
                    r2 += dz * dz
                if nearest is not None:
                    least = min(least, bits_of(r2))
                if h is not None:
                    mean = hi + 0.5 * size[k]
                    ih2 = 1.0 / (mean * mean)
                    factor = scale * ih2 * ih2
                    if z is not None:
                        factor *= mean * ih2
                    if line is not None:
                        factor *= mean
                else:
                    ih2 = inverse_h2
                    factor = scale
                if weight is not None:
                    factor *= weights[k]
                q2 = r2 * ih2 + TINY
                iq = inverse_root(q2)
                factor *= shape_slope(shape, q2 * iq, iq)
                gx = dx * factor
                gy = dy * factor
                xy = xyi + sxy[k]
                yx = xy
                if corrected is not None:
                    yx = yxi + syx[k]
                fx = (xxi + sxx[k]) * gx + xy * gy
                fy = yx * gx + (yyi + syy[k]) * gy
                if z is not None:
                    gz = dz * factor
                    yz = yzi + syz[k]
                    zx = zxi + szx[k]
                    if corrected is not None:
                        xz = xzi + sxz[k]
                        zy = zyi + szy[k]
                    else:
                        xz = zx
                        zy = yz
                    fx += xz * gz
                    fy += yz * gz
                    fz = zx * gx + zy * gy + (zzi + szz[k]) * gz
                    a2 += fz
                a0 += fx
                a1 += fy
                if artificial is not None:
                    pull = fx * dx + fy * dy
                    if z is not None:
                        pull += fz * dz
                    f = shape_value(shape, q2 * iq) * inverse_w
                    f *= f
                    push = artificial * f * f * max(0.0, -pull) * iq * iq * ih2
                    b0 += push * dx
                    b1 += push * dy
                    if z is not None:
                        b2 += push * dz
        if artificial is not None:
            a0 += b0
            a1 += b1
            if z is not None:
                a2 += b2
        if density is not None:
            inverse = 1.0 / density[i]
            a0 *= inverse
            a1 *= inverse
            if z is not None:
                a2 *= inverse
            if artificial is not None:
                b0 *= inverse
                b1 *= inverse
                if z is not None:
                    b2 *= inverse
        ax[i] = a0 + body[0]
        ay[i] = a1 + body[1]
        if z is not None:
            az[i] = a2 + body[2]
        if artificial is not None:
            bx[i] = b0
            by[i] = b1
            if z is not None:
                bz[i] = b2
        if nearest is not None:
            nearest[i] = of_bits(least)
