"""Pair loops that cure known defects of the method; each only runs in a scene that asks for it.

Shapes and arguments as in `pairs`. All but the artificial stress, which rides on the momentum loop, stand here.
"""

from __future__ import annotations

from ..jit import kernel
from .pairs import TINY
from .smoothing import inverse_root, shape_slope, shape_value


@kernel
def _volume_factor(mean, dimension):
    """1/h^d."""
    inverse = 1.0 / mean
    if dimension == 1:
        return inverse
    if dimension == 2:
        return inverse * inverse
    return inverse * inverse * inverse


@kernel
def _drop(i, j, offset, source, z, x, y, zs, body):
    """g.(x_i - x_j) and its parts along the axes; of an image as far as its source: what lies beyond a plane is as
    deep as what it mirrors."""
    if source is not None and offset <= j < offset + len(source):  # the dummy that pads the lists stands behind
        j = source[j - offset]
    gx = body[0] * (x[i] - x[j])
    gy = body[1] * (y[i] - y[j])
    gz = 0.0
    if z is not None:
        gz = body[2] * (zs[i] - zs[j])
    return gx + gy + gz, gx, gy, gz


@kernel
def density_diffusion(i0, i1, offset, source, z, shape, x, y, zs, arrays, numbers, rate):
    """rate_i = factor h c sum_j 2 V_j (rho_j - rho_i - rho_i g.(x_j - x_i)/c^2)(x_j - x_i).grad_i W_ij / r^2.

    Delta-SPH (Molteni & Colagrossi 2009) with the hydrostatic part taken out (Fourtakas et al. 2019), so that a column
    at rest keeps its surface; among particles of one material, which has a factor of its own. offset, source: of the
    images, None without.
    """
    body = numbers.body
    for i in range(i0, i1):
        m = arrays.material[i]
        factor = numbers.density_diffusion[m]
        total = 0.0
        if factor == 0.0:
            rate[i] = 0.0
            continue
        rho = arrays.density[i]
        c = numbers.wave[m]
        inverse_c2 = rho / (c * c)
        for k in range(arrays.first[i], arrays.first[i] + arrays.count[i]):
            j = arrays.rows[k]
            if arrays.material[j] != m:
                continue
            mean = 0.5 * (arrays.h[i] + arrays.h[j])
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            r2 = dx * dx + dy * dy
            head = _drop(i, j, offset, source, z, x, y, zs, body)[0]
            if z is not None:
                dz = zs[i] - zs[j]
                r2 += dz * dz
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            slope = shape_slope(shape, q2 * iq, iq) * _volume_factor(mean, numbers.dimension) / (mean * mean)
            total -= arrays.volume[j] * (arrays.density[j] - rho + inverse_c2 * head) * slope
        rate[i] = 2.0 * factor * arrays.h[i] * c * numbers.normal * total


@kernel
def stress_diffusion(i0, i1, offset, source, z, shape, x, y, zs, arrays, numbers, rate):
    """rate_i = factor h c sum_j 2 V_j (sigma_j - sigma_i - head)(x_j - x_i).grad_i W_ij / r^2, all components.

    Regularises the stress of grain (Nguyen et al. 2017; Feng et al. 2021), which else falls apart into stripes. head:
    what gravity makes of the normal stress along axis a, -rho (g_a x_a + K g_b x_b) with x = x_j - x_i, b the other
    axes and K the pair's ratio of that stress to the one along g, between 0 and 1: without it the lateral stress of
    grain at rest spreads out evenly over its depth. Among one material; images as in `density_diffusion`.
    """
    body = numbers.body
    gravity2 = body[0] ** 2 + body[1] ** 2 + body[2] ** 2
    inverse_g2 = 1.0 / gravity2 if gravity2 > 0.0 else 0.0
    stress = arrays.stress
    for i in range(i0, i1):
        m = arrays.material[i]
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
        for k in range(arrays.first[i], arrays.first[i] + arrays.count[i]):
            j = arrays.rows[k]
            if arrays.material[j] != m:
                continue
            mean = 0.5 * (arrays.h[i] + arrays.h[j])
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = zs[i] - zs[j]
                r2 += dz * dz
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            slope = shape_slope(shape, q2 * iq, iq) * _volume_factor(mean, numbers.dimension) / (mean * mean)
            slope *= -arrays.volume[j]
            drop, gx, gy, gz = _drop(i, j, offset, source, z, x, y, zs, body)
            p_xx = stress[0, i] + stress[0, j]
            p_yy = stress[1, i] + stress[1, j]
            p_zz = stress[2, i] + stress[2, j]
            down = (p_xx * body[0] ** 2 + p_yy * body[1] ** 2 + p_zz * body[2] ** 2) * inverse_g2
            inverse = 1.0 / down if down < 0.0 else 0.0
            gx += min(max(p_xx * inverse, 0.0), 1.0) * (drop - gx)
            gy += min(max(p_yy * inverse, 0.0), 1.0) * (drop - gy)
            gz += min(max(p_zz * inverse, 0.0), 1.0) * (drop - gz)
            t_xx += slope * (stress[0, j] - stress[0, i] - rho * gx)
            t_yy += slope * (stress[1, j] - stress[1, i] - rho * gy)
            t_zz += slope * (stress[2, j] - stress[2, i] - rho * gz)
            t_xy += slope * (stress[3, j] - stress[3, i])
            if z is not None:
                t_yz += slope * (stress[4, j] - stress[4, i])
                t_zx += slope * (stress[5, j] - stress[5, i])
        scale = 2.0 * factor * arrays.h[i] * numbers.wave[m] * numbers.normal
        rate[0, i] = scale * t_xx
        rate[1, i] = scale * t_yy
        rate[2, i] = scale * t_zz
        rate[3, i] = scale * t_xy
        if z is not None:
            rate[4, i] = scale * t_yz
            rate[5, i] = scale * t_zx


@kernel
def smoothed_velocity(i0, i1, z, shape, factor, arrays, numbers, mean_velocity):
    """v_i + factor sum_j 2 m_j/(rho_i + rho_j) (v_j - v_i) W_ij: XSPH (Monaghan 1989), with which particles move."""
    for i in range(i0, i1):
        a0 = 0.0
        a1 = 0.0
        a2 = 0.0
        for k in range(arrays.first[i], arrays.first[i] + arrays.count[i]):
            j = arrays.rows[k]
            mean = 0.5 * (arrays.h[i] + arrays.h[j])
            dx = arrays.x[i] - arrays.x[j]
            dy = arrays.y[i] - arrays.y[j]
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
            q2 = r2 / (mean * mean) + TINY
            value = shape_value(shape, q2 * inverse_root(q2)) * _volume_factor(mean, numbers.dimension)
            value *= 2.0 * arrays.mass[j] / (arrays.density[i] + arrays.density[j])
            a0 += value * (arrays.u[j] - arrays.u[i])
            a1 += value * (arrays.v[j] - arrays.v[i])
            if z is not None:
                a2 += value * (arrays.w[j] - arrays.w[i])
        scale = factor * numbers.normal
        mean_velocity[0, i] = arrays.u[i] + scale * a0
        mean_velocity[1, i] = arrays.v[i] + scale * a1
        if z is not None:
            mean_velocity[2, i] = arrays.w[i] + scale * a2


@kernel
def pair_viscosity(i0, i1, z, shape, arrays, numbers, heat):
    """Adds Monaghan's viscosity (1992) to the acceleration; heat: (n + 1,) the power per mass that it dissipates.

    a_i -= sum_j m_j P grad_i W, P = (-alpha c mu + beta mu^2)/rho, mu = h v.x/(r^2 + 0.01 h^2) for pairs that close in;
    c, rho, alpha, beta are means of both.
    """
    pair = numbers.pair_viscosity
    for i in range(i0, i1):
        m = arrays.material[i]
        a0 = 0.0
        a1 = 0.0
        a2 = 0.0
        power = 0.0
        for k in range(arrays.first[i], arrays.first[i] + arrays.count[i]):
            j = arrays.rows[k]
            o = arrays.material[j]
            mean = 0.5 * (arrays.h[i] + arrays.h[j])
            dx = arrays.x[i] - arrays.x[j]
            dy = arrays.y[i] - arrays.y[j]
            r2 = dx * dx + dy * dy
            closing = (arrays.u[i] - arrays.u[j]) * dx + (arrays.v[i] - arrays.v[j]) * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
                closing += (arrays.w[i] - arrays.w[j]) * dz
            mu = mean * min(0.0, closing) / (r2 + 0.01 * mean * mean)
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            slope = shape_slope(shape, q2 * iq, iq) * _volume_factor(mean, numbers.dimension) / (mean * mean)
            c = 0.5 * (numbers.wave[m] + numbers.wave[o])
            alpha = 0.5 * (pair[m, 0] + pair[o, 0])
            beta = 0.5 * (pair[m, 1] + pair[o, 1])
            push = arrays.mass[j] * slope * 2.0 * (beta * mu - alpha * c) * mu
            push /= arrays.density[i] + arrays.density[j]
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
