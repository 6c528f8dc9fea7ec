"""The pair loop of forces: see `pairs` for its form and shapes."""

from __future__ import annotations

import numpy as np

from ..bits import bits_of, of_bits
from ..gather import LANES, ROOM, gather
from ..jit import inlined_kernel
from .packed import stress_of, weight_of
from .pairs import TINY
from .smoothing import inverse_root, shape_slope, shape_value

ALONE = np.int64(0x7E37E43C8800759C)  # the bits of 1e300: the squared distance of a particle without neighbours


@inlined_kernel
def momentum(
    i0, i1, first, count, rows, shape, packed, beside, near, more, z, weight, h, inverse_h2, scale, line, body, ax, ay,
    az, nearest, density, corrected, artificial, inverse_w, bx, by, bz,
):  # fmt: skip
    """a_i = sum_j m_j (s_i + s_j) . grad_i W_ij + g: the sum form that conserves momentum pair by pair.

    weight: masses, or None where all are equal and in the scale. Where bodies differ in density the sum is
    a_i = sum_j V_j (sigma_i + sigma_j) / rho_i . grad_i W_ij instead: the one whose work is that of the velocity
    gradient; then s is the stress, the weights are the volumes and density is given. body: (3,) g. nearest: None,
    or (n + 1,) the squared distance to the nearest listed particle. corrected: None, or anything where s is s B.
    near, more: buffers for the lines of the two tables.

    artificial: None, or the factor e of the artificial stress: the part of a pair's force that pulls the two together
    is lessened by e f^4, f = W(r)/W(spacing), inverse_w being the inverse of the latter's value; bx.. then keep that
    part of the acceleration. It is the term of Monaghan (2000) and Gray, Monaghan & Swift (2001), taken along the pair,
    where the instability W'' sigma > 0 lives, in place of the principal axes: central, so that it turns nothing.
    """
    x = near[0]
    y = near[1]
    weights, size = weight_of(near, more, z)
    sxx, sxy, sxz, syx, syy, syz, szx, szy, szz = stress_of(near, more, z, corrected)
    for i in range(i0, i1):
        xi = packed[i, 0]
        yi = packed[i, 1]
        xxi, xyi, xzi, yxi, yyi, yzi, zxi, zyi, zzi = stress_of(packed[i], beside[i], z, corrected)
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
                fx = (xxi + sxx[k]) * gx + (xyi + sxy[k]) * gy
                fy = (yxi + syx[k]) * gx + (yyi + syy[k]) * gy
                if z is not None:
                    gz = dz * factor
                    fx += (xzi + sxz[k]) * gz
                    fy += (yzi + syz[k]) * gz
                    fz = (zxi + szx[k]) * gx + (zyi + szy[k]) * gy + (zzi + szz[k]) * gz
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
