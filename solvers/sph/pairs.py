"""Pair loops over the Verlet list: velocity gradient, momentum, contact, interface force.

Each is a serial function over a block of particles with one contiguous, branch-free inner loop that vectorises; what a
scene does not have is None and is left out when the loop is compiled: z and w in the plane, h where all smoothing
lengths are equal, mass where all masses are equal, nearest where the time step does not ask for it. Arrays have one
more entry than there are particles: the dummy that pads the rows, far away.

Shapes: x, y, z, u, v, w, h, mass, volume (n + 1,); gradient (d*d, n + 1) rows du/dx du/dy (du/dz) dv/dx ...; s
(k, n + 1) with k = 6 (xx yy zz xy yz zx) or 3 (xx yy xy) in the plane: (sigma - q I)/rho^2. scale is a_d / h^(d+2), or
a_d alone where h is given; a line (one dimension) runs as a plane with y = 0 and says so by `line`.
"""

from __future__ import annotations

import numpy as np

from ..bits import bits_of, of_bits
from ..contact.potential import original_reference
from ..jit import kernel
from .smoothing import inverse_root, spline, spline_slope

TINY = 1e-30  # keeps the inverse root of coincident particles finite
ALONE = np.int64(0x7E37E43C8800759C)  # the bits of 1e300: the squared distance of a particle without neighbours


@kernel
def velocity_gradient(
    i0, i1, first, count, rows, x, y, solid, z, u, v, w, volume, h, inverse_h2, scale, line, gradient
):
    """grad v_i = sum_j V_j (v_j - v_i) (x) grad_i W_ij ([T] 4.6.1.13), with the positions that are handed in.

    solid: None in the plane, where z and w are not looked at.
    """
    for i in range(i0, i1):
        xi = x[i]
        yi = y[i]
        ui = u[i]
        vi = v[i]
        ux = 0.0
        uy = 0.0
        vx = 0.0
        vy = 0.0
        if solid is not None:
            zi = z[i]
            wi = w[i]
            uz = 0.0
            vz = 0.0
            wx = 0.0
            wy = 0.0
            wz = 0.0
        if h is not None:
            hi = 0.5 * h[i]
        begin = np.uint64(first[i])
        for k in range(np.uint64(count[i])):
            j = rows[begin + k]
            dx = xi - x[j]
            dy = yi - y[j]
            r2 = dx * dx + dy * dy
            if solid is not None:
                dz = zi - z[j]
                r2 += dz * dz
            if h is not None:
                mean = hi + 0.5 * h[j]
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
            factor = factor * volume[j] * spline_slope(q2 * iq, iq)
            dx *= factor
            dy *= factor
            du = u[j] - ui
            dv = v[j] - vi
            ux += du * dx
            uy += du * dy
            vx += dv * dx
            vy += dv * dy
            if solid is not None:
                dz *= factor
                dw = w[j] - wi
                uz += du * dz
                vz += dv * dz
                wx += dw * dx
                wy += dw * dy
                wz += dw * dz
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
    i0,
    i1,
    first,
    count,
    rows,
    x,
    y,
    z,
    s,
    weight,
    h,
    inverse_h2,
    scale,
    line,
    body_x,
    body_y,
    body_z,
    ax,
    ay,
    az,
    nearest,
    density,
):
    """a_i = sum_j m_j (s_i + s_j) . grad_i W_ij + g: the sum form that conserves momentum pair by pair.

    weight: masses, or None where all are equal and in the scale. Where bodies differ in density the sum is
    a_i = sum_j V_j (sigma_i + sigma_j) / rho_i . grad_i W_ij instead: the one whose work is that of the velocity
    gradient above; then s is the stress, the weights are the volumes and density is given. nearest: None, or (n + 1,)
    the squared distance to the nearest listed particle.
    """
    if z is not None:
        sxx = s[0]
        syy = s[1]
        szz = s[2]
        sxy = s[3]
        syz = s[4]
        szx = s[5]
    else:
        sxx = s[0]
        syy = s[1]
        sxy = s[2]
    for i in range(i0, i1):
        xi = x[i]
        yi = y[i]
        xxi = sxx[i]
        yyi = syy[i]
        xyi = sxy[i]
        a0 = 0.0
        a1 = 0.0
        if z is not None:
            zi = z[i]
            zzi = szz[i]
            yzi = syz[i]
            zxi = szx[i]
            a2 = 0.0
        if h is not None:
            hi = 0.5 * h[i]
        if nearest is not None:
            least = ALONE
        begin = np.uint64(first[i])
        for k in range(np.uint64(count[i])):
            j = rows[begin + k]
            dx = xi - x[j]
            dy = yi - y[j]
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = zi - z[j]
                r2 += dz * dz
            if nearest is not None:
                least = min(least, bits_of(r2))
            if h is not None:
                mean = hi + 0.5 * h[j]
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
                factor *= weight[j]
            q2 = r2 * ih2 + TINY
            iq = inverse_root(q2)
            factor *= spline_slope(q2 * iq, iq)
            dx *= factor
            dy *= factor
            xy = xyi + sxy[j]
            if z is not None:
                dz *= factor
                yz = yzi + syz[j]
                zx = zxi + szx[j]
                a0 += (xxi + sxx[j]) * dx + xy * dy + zx * dz
                a1 += xy * dx + (yyi + syy[j]) * dy + yz * dz
                a2 += zx * dx + yz * dy + (zzi + szz[j]) * dz
            else:
                a0 += (xxi + sxx[j]) * dx + xy * dy
                a1 += xy * dx + (yyi + syy[j]) * dy
        if density is not None:
            inverse = 1.0 / density[i]
            a0 *= inverse
            a1 *= inverse
            if z is not None:
                a2 *= inverse
        ax[i] = a0 + body_x
        ay[i] = a1 + body_y
        if z is not None:
            az[i] = a2 + body_z
        if nearest is not None:
            nearest[i] = of_bits(least)


@kernel
def contact_acceleration(
    i0,
    i1,
    first,
    count,
    rows,
    x,
    y,
    z,
    mass,
    h,
    volume_exponent,
    normal,
    material,
    strength,
    exponent,
    original,
    ax,
    ay,
    az,
    cx,
    cy,
    cz,
):
    """Adds the repulsive contact (`contact.potential`) to the acceleration, and keeps it in cx, cy, cz.

    h, mass: (n + 1,). volume_exponent: -(d + 2); normal: a_d of the spline. strength, exponent: K and n of each
    material. original: as the original program codes it (n of particle i's material, its divisor of f).
    """
    for i in range(i0, i1):
        a0 = 0.0
        a1 = 0.0
        a2 = 0.0
        mi = material[i]
        for k in range(first[i], first[i] + count[i]):
            j = rows[k]
            mean = 0.5 * (h[i] + h[j])
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
            if r2 >= 4.0 * mean * mean:
                continue
            mj = material[j]
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            shape = spline(q2 * iq)
            if original:
                f = 1.5 * shape / original_reference(h[j] / mean)
                power = exponent[mi]
            else:
                f = shape / spline(1.0)
                power = 0.5 * (exponent[mi] + exponent[mj])
            factor = (
                -mass[j] * (strength[mi] + strength[mj]) * f**power
                * normal * mean**volume_exponent * spline_slope(q2 * iq, iq)
            )  # fmt: skip
            a0 += factor * dx
            a1 += factor * dy
            if z is not None:
                a2 += factor * dz
        cx[i] = a0
        cy[i] = a1
        ax[i] += a0
        ay[i] += a1
        if z is not None:
            cz[i] = a2
            az[i] += a2


@kernel
def interface_force(i0, i1, first, count, rows, x, y, z, s, weight, h, volume_exponent, normal, material, body, force):
    """Adds to force[3] what particles of other materials do to those of material `body` through the momentum sum."""
    for i in range(i0, i1):
        if material[i] != body:
            continue
        for k in range(first[i], first[i] + count[i]):
            j = rows[k]
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
            mean = 0.5 * (h[i] + h[j])
            if r2 >= 4.0 * mean * mean or material[j] == body:
                continue
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            factor = weight[i] * weight[j] * normal * mean**volume_exponent * spline_slope(q2 * iq, iq)
            if z is not None:
                xy = s[3, i] + s[3, j]
                yz = s[4, i] + s[4, j]
                zx = s[5, i] + s[5, j]
                force[0] += factor * ((s[0, i] + s[0, j]) * dx + xy * dy + zx * dz)
                force[1] += factor * (xy * dx + (s[1, i] + s[1, j]) * dy + yz * dz)
                force[2] += factor * (zx * dx + yz * dy + (s[2, i] + s[2, j]) * dz)
            else:
                xy = s[2, i] + s[2, j]
                force[0] += factor * ((s[0, i] + s[0, j]) * dx + xy * dy)
                force[1] += factor * (xy * dx + (s[1, i] + s[1, j]) * dy)
