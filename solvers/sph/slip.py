"""Friction between bodies: normals, slip, and the traction that each particle's contact can bear.

A pair's normal is the difference of both points' gradients of a colour that is 1 in other bodies and 0 in their own
([T] 5.4.2-3), a particle's the mean of its pairs' by their normal forces N_ij. The mean velocity against the other
bodies, by N_ij too, is its slip; a face of its volume is its surface. Its traction T_i (`contact.friction`) is shared
out to the pairs by N_ij: t_ij = - N_ij (T_i/N_i - T_j/N_j)/2, N_i = sum_j N_ij. The halves are those of the two sides
of the same surface, and t_ij = - t_ji to the last bit.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba.extending import overload

from ..contact.friction import ELASTIC, FORGET, WEAKENING, follow, stick_or_slide, turned_into
from ..contact.law import JIT_OPTIONS, is_law
from ..jit import kernel
from ..threads import barrier, share
from .across import pair_normal, pair_push
from .pairs import TINY
from .smoothing import inverse_root, shape_slope


class CoulombPairs(NamedTuple):
    """(bodies, bodies) each: static and kinetic coefficient; modulus, impedance, wave speed of the softer."""

    static: Any
    kinetic: Any
    modulus: Any
    impedance: Any
    wave: Any


class DragPairs(NamedTuple):
    """coefficient: (bodies, bodies) shear stress by slip velocity."""

    coefficient: Any


@kernel
def colour_gradient(i0, i1, z, shape, arrays, numbers):
    """sum_j V_j grad_i W_ij over particles of other bodies: points to them."""
    x, y = arrays.x, arrays.y
    reach2 = shape.support * shape.support
    for i in range(i0, i1):
        cx = 0.0
        cy = 0.0
        cz = 0.0
        for k in range(arrays.c_first[i], arrays.c_first[i] + arrays.c_count[i]):
            j = arrays.c_rows[k]
            inverse = 2.0 / (arrays.h[i] + arrays.h[j])
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
            q2 = r2 * inverse * inverse + TINY
            if q2 >= reach2:
                continue
            iq = inverse_root(q2)
            factor = numbers.normal * inverse * inverse * inverse
            if numbers.dimension > 1:
                factor *= inverse
            if z is not None:
                factor *= inverse
            factor *= arrays.volume[j] * shape_slope(shape, q2 * iq, iq)
            cx += factor * dx
            cy += factor * dy
            if z is not None:
                cz += factor * dz
        arrays.colour[0, i] = cx
        arrays.colour[1, i] = cy
        if z is not None:
            arrays.colour[2, i] = cz


def traction(friction, own, other, weight, sums):
    """Adds what a pair says of the friction's numbers, weighted by its normal force, to sums (5,)."""
    raise NotImplementedError("called from jitted code only")


def resist(friction, i, z, nx, ny, nz, sx, sy, sz, force, area, sums, dt, arrays):
    """The traction (3 components) of particle i that slips by s at a normal force; moves its history on."""
    raise NotImplementedError("called from jitted code only")


@overload(traction, jit_options=JIT_OPTIONS)
def _of_pair(friction, own, other, weight, sums):
    if is_law(friction, DragPairs):

        def drag(friction, own, other, weight, sums):
            sums[0] += weight * friction.coefficient[own, other]

        return drag

    def coulomb(friction, own, other, weight, sums):
        sums[0] += weight * friction.static[own, other]
        sums[1] += weight * friction.kinetic[own, other]
        sums[2] += weight * friction.modulus[own, other]
        sums[3] += weight * friction.impedance[own, other]
        sums[4] += weight * friction.wave[own, other]

    return coulomb


@overload(resist, jit_options=JIT_OPTIONS)
def _of_particle(friction, i, z, nx, ny, nz, sx, sy, sz, force, area, sums, dt, arrays):
    if is_law(friction, DragPairs):

        def drag(friction, i, z, nx, ny, nz, sx, sy, sz, force, area, sums, dt, arrays):
            c = area * sums[0] / force
            arrays.contact_heat[i] += 0.5 * dt * c * (sx * sx + sy * sy + sz * sz)
            return c * sx, c * sy, c * sz

        return drag

    def coulomb(friction, i, z, nx, ny, nz, sx, sy, sz, force, area, sums, dt, arrays):
        slip = arrays.slip
        last = 3 if z is not None else 2
        ez = slip[2, i] if z is not None else 0.0
        ex, ey, ez = turned_into(slip[0, i], slip[1, i], ez, nx, ny, nz)
        load = follow(slip[last + 1, i], force, dt, sums[4] / force, arrays.h[i])
        slip[last + 1, i] = load
        part = load / force
        k = min(max(load, 1e-6 * force) / ELASTIC, area * sums[2] / force) / arrays.h[i]
        c = area * sums[3] / force
        tx, ty, tz, ex, ey, ez, slid, heat = stick_or_slide(
            ex, ey, ez, sx, sy, sz, dt, k, c, part * sums[0], part * sums[1], WEAKENING * arrays.h[i], slip[last, i]
        )
        slip[0, i] = ex
        slip[1, i] = ey
        if z is not None:
            slip[2, i] = ez
        slip[last, i] = slid
        arrays.contact_heat[i] += 0.5 * heat
        return tx, ty, tz

    return coulomb


def forget(friction, i, z, dt, arrays):
    """The history of a particle out of contact: how far it slid stays, for a body that chatters as it slides."""
    raise NotImplementedError("called from jitted code only")


@overload(forget, jit_options=JIT_OPTIONS)
def _out_of_contact(friction, i, z, dt, arrays):
    if is_law(friction, DragPairs):

        def drag(friction, i, z, dt, arrays):
            pass

        return drag

    def coulomb(friction, i, z, dt, arrays):
        slip = arrays.slip
        last = 3 if z is not None else 2
        own = arrays.material[i]
        slip[:last, i] = 0.0
        slip[last + 1, i] = follow(slip[last + 1, i], 0.0, dt, FORGET * friction.wave[own, own], arrays.h[i])

    return coulomb


@kernel
def resistance(i0, i1, z, shape, law, friction, damping, dt, arrays):
    """T_i/N_i of a range of particles into `mobilised`, with the normals of all."""
    x, y, u, v = arrays.x, arrays.y, arrays.u, arrays.v
    reach2 = law.reach * law.reach
    mobilised = arrays.mobilised
    sums = np.zeros(5)
    for i in range(i0, i1):
        force = 0.0
        sx = 0.0
        sy = 0.0
        sz = 0.0
        sums[:] = 0.0
        nx = 0.0
        ny = 0.0
        nz = 0.0
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
            du = u[i] - u[j]
            dv = v[i] - v[j]
            approach = -du * dx - dv * dy
            if z is not None:
                dw = arrays.w[i] - arrays.w[j]
                approach -= dw * dz
            push, _, _ = pair_push(law, shape, damping, i, j, r2, approach, dt, arrays)
            px, py, pz, along = pair_normal(i, j, z, dx, dy, dz, arrays)
            weight = push * along
            force += weight
            nx += weight * px
            ny += weight * py
            nz += weight * pz
            sx += weight * du
            sy += weight * dv
            if z is not None:
                sz += weight * dw
            traction(friction, arrays.material[i], arrays.material[j], weight, sums)
        tx = 0.0
        ty = 0.0
        tz = 0.0
        size = math.sqrt(nx * nx + ny * ny + nz * nz)
        if force > 0.0 and size > 0.0:
            nx /= size
            ny /= size
            nz /= size
            sx /= force
            sy /= force
            sz /= force
            surface = math.sqrt(arrays.volume[i])
            if z is not None:
                surface = arrays.volume[i] ** (2.0 / 3.0)
            along = sx * nx + sy * ny + sz * nz
            tx, ty, tz = resist(
                friction, i, z, nx, ny, nz, sx - along * nx, sy - along * ny, sz - along * nz, force,
                surface, sums, dt, arrays,
            )  # fmt: skip
            tx /= force
            ty /= force
            tz /= force
        else:
            forget(friction, i, z, dt, arrays)
        mobilised[0, i] = tx
        mobilised[1, i] = ty
        if z is not None:
            mobilised[2, i] = tz


@kernel
def _follow(g0, g1, n, z, source, sign, rows):
    """Vectors of the images."""
    for g in range(g0, g1):
        rows[0, n + g] = sign[0, g] * rows[0, source[g]]
        rows[1, n + g] = sign[1, g] * rows[1, source[g]]
        if z is not None:
            rows[2, n + g] = sign[2, g] * rows[2, source[g]]


@kernel
def phase(thread, threads, sync, n, offset, z, shape, law, friction, damping, dt, source, sign, arrays, numbers):
    """Normals, and tractions where there is friction, each thread its range. source, sign: of images, or None."""
    i0, i1 = share(n, thread, threads)
    colour_gradient(i0, i1, z, shape, arrays, numbers)
    barrier(sync, threads)
    if source is not None:
        g0, g1 = share(len(source), thread, threads)
        _follow(g0, g1, offset, z, source, sign, arrays.colour)
        barrier(sync, threads)
    if friction is not None:
        resistance(i0, i1, z, shape, law, friction, damping, dt, arrays)
        barrier(sync, threads)
        if source is not None:
            _follow(g0, g1, offset, z, source, sign, arrays.mobilised)
            barrier(sync, threads)
