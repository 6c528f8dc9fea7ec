"""Loops over pairs of different bodies: the contact law, and the force that the momentum sum carries across.

Shapes as in `pairs`. A particle's row in the list of other bodies is empty unless it is near one: away from contact a
particle costs a look at its count.
"""

from __future__ import annotations

import math

import numpy as np

from ..contact.law import repulsion
from ..jit import kernel
from .pairs import TINY
from .smoothing import inverse_root, shape_slope

COINCIDENT = 1e-12  # squared distance, in units of h^2, at which two points are one
CLOSING = 0.25  # of its distance, that a pair may come nearer in a step


@kernel
def pair_push(law, shape, damping, i, j, r2, approach, dt, arrays):
    """(push, stiffness, power lost) of a pair by a law of `contact.law`, with a dashpot where there is damping.

    damping: None, or the fraction of the pair's critical damping; it pulls no more than the law pushes.
    """
    push, stiffness = repulsion(
        law, shape, r2, arrays.h[i], arrays.h[j], arrays.mass[i], arrays.mass[j], arrays.density[i], arrays.density[j],
        arrays.material[i], arrays.material[j], approach, dt,
    )  # fmt: skip
    lost = 0.0
    if damping is not None:
        reduced = arrays.mass[i] * arrays.mass[j] / (arrays.mass[i] + arrays.mass[j])
        more = max(-push, 2.0 * damping * math.sqrt(stiffness * reduced) * approach / (r2 + TINY))
        push += more
        lost = more * approach
    return push, stiffness, lost


@kernel
def stable_step(mass, stiffness, damping):
    """The longest step of a point that springs of this total stiffness hold, whatever they hold it to."""
    longest = math.sqrt(2.0 * mass / stiffness)
    if damping is not None:
        longest *= math.sqrt(1.0 + damping * damping) - damping
    return longest


@kernel
def contact_force(i0, i1, z, shape, law, friction, damping, normals, by_normals, dt, cx, heat, arrays, numbers):
    """Adds what other bodies do to each particle to its acceleration, and keeps it in cx, cy, cz.

    Returns the longest stable step: by the contact's stiffness, and so that no pair passes through each other.
    friction: None, or `slip.resistance` has found what each particle's friction amounts to. heat: None, or the row that
    what dashpots take goes to.
    """
    x, y, u, v = arrays.x, arrays.y, arrays.u, arrays.v
    reach2 = law.reach * law.reach
    all_fixed = (1 << numbers.dimension) - 1
    least = np.inf
    for i in range(i0, i1):
        a0 = 0.0
        a1 = 0.0
        a2 = 0.0
        total = 0.0
        free = (arrays.fixed[i] & all_fixed) != all_fixed
        for k in range(arrays.c_first[i], arrays.c_first[i] + arrays.c_count[i]):
            j = arrays.c_rows[k]
            mean = 0.5 * (arrays.h[i] + arrays.h[j])
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            dz = 0.0
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
            if r2 >= reach2 * mean * mean:
                continue
            approach = (u[j] - u[i]) * dx + (v[j] - v[i]) * dy
            if z is not None:
                approach += (arrays.w[j] - arrays.w[i]) * dz
            push, stiffness, lost = pair_push(law, shape, damping, i, j, r2, approach, dt, arrays)
            total += stiffness
            if approach > 0.0:
                least = min(least, CLOSING * r2 / approach)
            if r2 < COINCIDENT * mean * mean:
                least = 0.0
            if heat is not None:
                heat[i] += 0.5 * dt * lost
            if normals is not None:
                nx, ny, nz, along = pair_normal(i, j, z, dx, dy, dz, arrays)
                along *= push
                if by_normals is not None and along > 0.0:
                    a0 += along * nx
                    a1 += along * ny
                    a2 += along * nz
                else:
                    a0 += push * dx
                    a1 += push * dy
                    a2 += push * dz
            else:
                a0 += push * dx
                a1 += push * dy
                a2 += push * dz
            if friction is not None:
                along *= 0.5
                a0 -= along * (arrays.mobilised[0, i] - arrays.mobilised[0, j])
                a1 -= along * (arrays.mobilised[1, i] - arrays.mobilised[1, j])
                if z is not None:
                    a2 -= along * (arrays.mobilised[2, i] - arrays.mobilised[2, j])
        if total > 0.0 and free:
            least = min(least, stable_step(arrays.mass[i], total, damping))
        inverse = 1.0 / arrays.mass[i]
        cx[i] = a0 * inverse
        arrays.cy[i] = a1 * inverse
        arrays.ax[i] += cx[i]
        arrays.ay[i] += arrays.cy[i]
        if z is not None:
            arrays.cz[i] = a2 * inverse
            arrays.az[i] += arrays.cz[i]
    return least


@kernel
def pair_normal(i, j, z, dx, dy, dz, arrays):
    """The pair's normal (3), of colour_j - colour_i (but for the sign the same for both); x_i - x_j along it, >= 0."""
    colour = arrays.colour
    nx = colour[0, j] - colour[0, i]
    ny = colour[1, j] - colour[1, i]
    nz = 0.0
    if z is not None:
        nz = colour[2, j] - colour[2, i]
    inverse = 1.0 / math.sqrt(nx * nx + ny * ny + nz * nz + TINY)
    nx *= inverse
    ny *= inverse
    nz *= inverse
    return nx, ny, nz, max(0.0, nx * dx + ny * dy + nz * dz)


@kernel
def interface_speed(live, dummy, wave, numbers, arrays):
    """Keeps in `interface` the speed by which stress of other bodies moves each of the first `live` particles.

    A light particle beside a heavy stiff one is moved by the mean of both moduli over its own density, faster than its
    own waves go: it is that which limits the step there. wave: None, or the row of speeds now.
    """
    for i in range(live):
        own = wave[i] if wave is not None else numbers.wave[arrays.material[i]]
        own *= own * arrays.density[i]
        most = 0.0
        for k in range(arrays.first[i], arrays.first[i] + arrays.count[i]):
            j = arrays.rows[k]
            if j == dummy or arrays.material[j] == arrays.material[i] or numbers.wall[arrays.material[j]] > 0.0:
                continue
            other = numbers.wave[arrays.material[j]]
            if wave is not None and j < live:
                other = wave[j]
            most = max(most, 0.5 * (own + arrays.density[j] * other * other))
        arrays.interface[0, i] = math.sqrt(most / arrays.density[i])


@kernel
def interface_force(
    i0,
    i1,
    first,
    count,
    rows,
    shape,
    x,
    y,
    z,
    s,
    weight,
    h,
    volume_exponent,
    normal,
    material,
    body,
    rows_apart,
    force,
):
    """Adds to force[3] what particles of other materials do to those of material `body` through the momentum sum.

    rows_apart: None, or anything where s has all d*d components (with the gradient correction).
    """
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
            if rows_apart is not None and z is not None:
                for axis in range(3):
                    row = 3 * axis
                    pair = (s[row, i] + s[row, j]) * dx + (s[row + 1, i] + s[row + 1, j]) * dy
                    force[axis] += factor * (pair + (s[row + 2, i] + s[row + 2, j]) * dz)
            elif rows_apart is not None:
                for axis in range(2):
                    row = 2 * axis
                    force[axis] += factor * ((s[row, i] + s[row, j]) * dx + (s[row + 1, i] + s[row + 1, j]) * dy)
            elif z is not None:
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
