"""Loops over pairs of different bodies: the contact potential, and the force that the momentum sum carries across.

Shapes as in `pairs`.
"""

from __future__ import annotations

from ..contact.potential import original_reference
from ..jit import kernel
from .pairs import TINY
from .smoothing import inverse_root, shape_slope, shape_value


@kernel
def contact_acceleration(
    i0,
    i1,
    first,
    count,
    rows,
    shape,
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
    reach2 = shape.support * shape.support
    reference = shape_value(shape, 0.5 * shape.support)
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
            if r2 >= reach2 * mean * mean:
                continue
            mj = material[j]
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            value = shape_value(shape, q2 * iq)
            if original:
                f = 1.5 * value / original_reference(h[j] / mean)
                power = exponent[mi]
            else:
                f = value / reference
                power = 0.5 * (exponent[mi] + exponent[mj])
            factor = (
                -mass[j] * (strength[mi] + strength[mj]) * f**power
                * normal * mean**volume_exponent * shape_slope(shape, q2 * iq, iq)
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
def interface_force(
    i0, i1, first, count, rows, shape, x, y, z, s, weight, h, volume_exponent, normal, material, body, force
):
    """Adds to force[3] what particles of other materials do to those of material `body` through the momentum sum."""
    reach2 = shape.support * shape.support
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
            if r2 >= reach2 * mean * mean or material[j] == body:
                continue
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            factor = weight[i] * weight[j] * normal * mean**volume_exponent * shape_slope(shape, q2 * iq, iq)
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
