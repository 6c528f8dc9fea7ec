"""Pair loops that cure known defects of the method; each only runs in a scene that asks for it.

Shapes and arguments as in `pairs`. All but the artificial stress, which rides on the momentum loop, stand here.
The inner loops have no branch and count without signs, so that they vectorise: that is a factor of eight to ten.
"""

from __future__ import annotations

import numpy as np

from ..gather import LANES, ROOM, gather
from ..jit import inlined_kernel, kernel
from .packed import motion_of
from .pairs import TINY
from .smoothing import inverse_root, shape_slope, shape_value


@inlined_kernel
def _slope(shape, r2, mean, dimension):
    """(dW/dr)/r / a_d of a pair; one division, which with eight lanes costs as much as ten products."""
    inverse = 1.0 / mean
    inverse2 = inverse * inverse
    q2 = r2 * inverse2 + TINY
    iq = inverse_root(q2)
    factor = inverse2 * inverse
    if dimension > 1:
        factor *= inverse
    if dimension > 2:
        factor *= inverse
    return factor * shape_slope(shape, q2 * iq, iq)


@inlined_kernel
def _slope_to(j, xi, yi, zi, hi, shape, x, y, zs, h, dimension):
    """`_slope` of a place with smoothing length hi and particle j; zs: None in the plane."""
    dx = xi - x[j]
    dy = yi - y[j]
    r2 = dx * dx + dy * dy
    if zs is not None:
        dz = zi - zs[j]
        r2 += dz * dz
    return _slope(shape, r2, 0.5 * (hi + h[j]), dimension)


@inlined_kernel
def _level(j, offset, source):
    """The particle that lies as deep as j: of an image its source, since what lies beyond a plane is as deep as what it
    mirrors. No branch; the first source is read in any case, see `ghosts.Images`."""
    image = np.int64(j) - offset
    mirrored = 0 <= image < len(source)  # the dummy that pads the lists stands behind
    found = source[image if mirrored else 0]
    return np.uint64(found if mirrored else np.int64(j))


@inlined_kernel
def density_diffusion(i0, i1, offset, source, z, shape, x, y, zs, arrays, numbers, rate):
    """rate_i = factor h c sum_j 2 V_j (rho_j - rho_i - rho_i g.(x_j - x_i)/c^2)(x_j - x_i).grad_i W_ij / r^2.

    Delta-SPH (Molteni & Colagrossi 2009) with the hydrostatic part taken out (Fourtakas et al. 2019), so that a column
    at rest keeps its surface; among particles of one material, which has a factor of its own. offset, source: of the
    images, None without.
    """
    g0, g1, g2 = numbers.body[0], numbers.body[1], numbers.body[2]
    dimension = numbers.dimension
    density, material, volume, h, rows = arrays.density, arrays.material, arrays.volume, arrays.h, arrays.rows
    for i in range(i0, i1):
        m = material[i]
        factor = numbers.density_diffusion[m]
        if factor == 0.0:
            rate[i] = 0.0
            continue
        total = 0.0
        rho = density[i]
        c = numbers.wave[m]
        inverse_c2 = rho / (c * c)
        xi, yi, zi, hi = x[i], y[i], 0.0, h[i]
        if z is not None:
            zi = zs[i]
        first = np.uint64(arrays.first[i])
        for k in range(np.uint64(arrays.count[i])):
            j = rows[first + k]
            slope = _slope_to(j, xi, yi, zi, hi, shape, x, y, zs, h, dimension)
            slope *= volume[j] if material[j] == m else 0.0
            level = _level(j, offset, source) if source is not None else np.uint64(j)
            head = g0 * (xi - x[level]) + g1 * (yi - y[level])
            if z is not None:
                head += g2 * (zi - zs[level])
            total -= (density[j] - rho + inverse_c2 * head) * slope
        rate[i] = 2.0 * factor * hi * c * numbers.normal * total


@inlined_kernel
def stress_diffusion(i0, i1, offset, source, z, shape, x, y, zs, arrays, numbers, rate):
    """rate_i = factor h c sum_j 2 V_j (sigma_j - sigma_i - head)(x_j - x_i).grad_i W_ij / r^2, all components.

    Regularises the stress of grain (Nguyen et al. 2017; Feng et al. 2021), which else falls apart into stripes. head:
    what gravity makes of the normal stress along axis a, -rho (g_a x_a + K g_b x_b) with x = x_j - x_i, b the other
    axes and K the pair's ratio of that stress to the one along g, between 0 and 1: without it the lateral stress of
    grain at rest spreads out evenly over its depth. Among one material; images as in `density_diffusion`.
    """
    g0, g1, g2 = numbers.body[0], numbers.body[1], numbers.body[2]
    gravity2 = g0 * g0 + g1 * g1 + g2 * g2
    inverse_g2 = 1.0 / gravity2 if gravity2 > 0.0 else 0.0
    along0, along1, along2 = g0 * g0 * inverse_g2, g1 * g1 * inverse_g2, g2 * g2 * inverse_g2
    dimension = numbers.dimension
    material, volume, h, rows = arrays.material, arrays.volume, arrays.h, arrays.rows
    xx, yy, zz, xy = arrays.stress[0], arrays.stress[1], arrays.stress[2], arrays.stress[3]
    if z is not None:
        yz, zx = arrays.stress[4], arrays.stress[5]
    for i in range(i0, i1):
        m = material[i]
        factor = numbers.stress_diffusion[m]
        if factor == 0.0:
            rate[:, i] = 0.0
            continue
        t_xx = 0.0
        t_yy = 0.0
        t_zz = 0.0
        t_xy = 0.0
        t_yz = 0.0
        t_zx = 0.0
        rho = arrays.density[i]
        xi, yi, zi, hi = x[i], y[i], 0.0, h[i]
        xxi, yyi, zzi, xyi = xx[i], yy[i], zz[i], xy[i]
        if z is not None:
            zi, yzi, zxi = zs[i], yz[i], zx[i]
        first = np.uint64(arrays.first[i])
        for k in range(np.uint64(arrays.count[i])):
            j = rows[first + k]
            slope = _slope_to(j, xi, yi, zi, hi, shape, x, y, zs, h, dimension)
            slope *= -volume[j] if material[j] == m else 0.0
            level = _level(j, offset, source) if source is not None else np.uint64(j)
            gx = g0 * (xi - x[level])
            gy = g1 * (yi - y[level])
            gz = 0.0
            if z is not None:
                gz = g2 * (zi - zs[level])
            drop = gx + gy + gz
            p_xx = xxi + xx[j]
            p_yy = yyi + yy[j]
            p_zz = zzi + zz[j]
            down = p_xx * along0 + p_yy * along1 + p_zz * along2
            inverse = 1.0 / down if down < 0.0 else 0.0
            gx += min(max(p_xx * inverse, 0.0), 1.0) * (drop - gx)
            gy += min(max(p_yy * inverse, 0.0), 1.0) * (drop - gy)
            gz += min(max(p_zz * inverse, 0.0), 1.0) * (drop - gz)
            t_xx += slope * (xx[j] - xxi - rho * gx)
            t_yy += slope * (yy[j] - yyi - rho * gy)
            t_zz += slope * (zz[j] - zzi - rho * gz)
            t_xy += slope * (xy[j] - xyi)
            if z is not None:
                t_yz += slope * (yz[j] - yzi)
                t_zx += slope * (zx[j] - zxi)
        scale = 2.0 * factor * hi * numbers.wave[m] * numbers.normal
        rate[0, i] = scale * t_xx
        rate[1, i] = scale * t_yy
        rate[2, i] = scale * t_zz
        rate[3, i] = scale * t_xy
        if z is not None:
            rate[4, i] = scale * t_yz
            rate[5, i] = scale * t_zx


@inlined_kernel
def smoothed_velocity(
    i0, i1, first, count, rows, shape, packed, near, solid, h, mass, inverse_h2, scale, line, mean_velocity
):  # fmt: skip
    """v_i + factor sum_j 2 m_j/(rho_i + rho_j) (v_j - v_i) W_ij: XSPH (Monaghan 1989), with which particles move.

    packed: see `packed.pack_smoothing`; near: a buffer. mass: None where all are equal and in the scale, which also has
    the factor. The other arguments as in `pairs.velocity_gradient`.
    """
    x, y, z, u, v, w, density, size = motion_of(near, solid)
    if h is None:
        scale = scale / inverse_h2
    for i in range(i0, i1):
        xi, yi, zi, ui, vi, wi, rho, _ = motion_of(packed[i], solid)
        a0 = 0.0
        a1 = 0.0
        if solid is not None:
            a2 = 0.0
        if h is not None:
            hi = 0.5 * h[i]
        begin = first[i]
        end = begin + count[i]
        while begin < end:
            some = min(ROOM, end - begin)
            for at in range(0, some, LANES):
                gather(packed, rows, begin + at, near, at, 8)
            start = np.uint64(begin)
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
                    inverse = 1.0 / (mean * (rho + density[k]))  # one division for the two
                    ih = inverse * (rho + density[k])
                    ih2 = ih * ih
                    factor = scale * ih * (inverse * mean)
                    if line is None:
                        factor *= ih
                    if solid is not None:
                        factor *= ih
                else:
                    ih2 = inverse_h2
                    factor = scale / (rho + density[k])
                if mass is not None:
                    factor *= mass[rows[start + k]]
                q2 = r2 * ih2 + TINY
                factor *= shape_value(shape, q2 * inverse_root(q2))
                a0 += factor * (u[k] - ui)
                a1 += factor * (v[k] - vi)
                if solid is not None:
                    a2 += factor * (w[k] - wi)
        mean_velocity[0, i] = ui + a0
        mean_velocity[1, i] = vi + a1
        if solid is not None:
            mean_velocity[2, i] = wi + a2


@kernel
def pair_viscosity(i0, i1, z, shape, arrays, numbers, heat):
    """Adds Monaghan's viscosity (1992) to the acceleration; heat: (n + 1,) the power per mass that it dissipates.

    a_i -= sum_j m_j P grad_i W, P = (-alpha c mu + beta mu^2)/rho, mu = h v.x/(r^2 + 0.01 h^2) for pairs that close in;
    c, rho, alpha, beta are means of both.
    """
    pair, wave, dimension = numbers.pair_viscosity, numbers.wave, numbers.dimension
    x, y, u, v, h, rows = arrays.x, arrays.y, arrays.u, arrays.v, arrays.h, arrays.rows
    mass, density, material = arrays.mass, arrays.density, arrays.material
    if z is not None:
        w = arrays.w
    for i in range(i0, i1):
        m = material[i]
        a0 = 0.0
        a1 = 0.0
        a2 = 0.0
        power = 0.0
        rho, c, alpha, beta = density[i], wave[m], pair[m, 0], pair[m, 1]
        xi, yi, ui, vi, hi = x[i], y[i], u[i], v[i], h[i]
        if z is not None:
            zi, wi = z[i], w[i]
        first = np.uint64(arrays.first[i])
        for k in range(np.uint64(arrays.count[i])):
            j = rows[first + k]
            o = np.uint64(material[j])
            mean = 0.5 * (hi + h[j])
            dx = xi - x[j]
            dy = yi - y[j]
            r2 = dx * dx + dy * dy
            closing = (ui - u[j]) * dx + (vi - v[j]) * dy
            if z is not None:
                dz = zi - z[j]
                r2 += dz * dz
                closing += (wi - w[j]) * dz
            distance2 = r2 + 0.01 * mean * mean
            both = rho + density[j]
            inverse = 1.0 / (distance2 * both)  # one division for the two
            mu = mean * min(0.0, closing) * both * inverse
            speed = 0.5 * (c + wave[o])
            push = mass[j] * _slope(shape, r2, mean, dimension) * distance2 * inverse
            push *= ((beta + pair[o, 1]) * mu - (alpha + pair[o, 0]) * speed) * mu
            a0 -= push * dx
            a1 -= push * dy
            if z is not None:
                a2 -= push * dz
            power += push * closing
        arrays.ax[i] += numbers.normal * a0
        arrays.ay[i] += numbers.normal * a1
        if z is not None:
            arrays.az[i] += numbers.normal * a2
        heat[i] = 0.5 * numbers.normal * power
