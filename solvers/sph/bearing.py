"""Walls of held particles that bear what leans on them: their stress is their neighbours', not a law's.

A held particle's own law sees its neighbours come and go, and never gives back what they pressed in: under a flow its
pressure ratchets up to many times the weight above it, and lifts the flow off the wall. The stress is the mean of the
neighbours' that are no wall, weighted by W V, with what gravity makes of the way to the wall (Adami, Hu & Adams 2012
for fluids; Bui et al. 2008 for soils); shear comes with it, so that the wall is as rough as the material is within. The
density is that of the material at rest.
"""

from __future__ import annotations

from ..jit import kernel
from .pairs import TINY
from .smoothing import inverse_root, shape_slope, shape_value

_SOLID = ((0, 3, 5), (3, 1, 4), (5, 4, 2))  # where the components of a symmetric tensor stand
_STRESS = ((0, 3), (3, 1))
_SHAPE = ((0, 2), (2, 1))


@kernel
def bear(i0, i1, z, shape, correction, dt, arrays, numbers):
    """Stress, viscous pressure and density of the walls' particles among i0..i1; zero where nothing is near.

    dt: of the strain before; the work that the law's stress has done in it becomes that of the new one.
    """
    body = numbers.body
    stress = arrays.stress
    components = 4 if z is None else 6
    for i in range(i0, i1):
        m = arrays.material[i]
        if not numbers.wall[m] > 0.0:
            continue
        weight = 0.0
        head = 0.0
        q = 0.0
        work = -_power(i, z, arrays)
        for c in range(components):
            stress[c, i] = 0.0
        for k in range(arrays.first[i], arrays.first[i] + arrays.count[i]):
            j = arrays.rows[k]
            if numbers.wall[arrays.material[j]] > 0.0:
                continue
            mean = 0.5 * (arrays.h[i] + arrays.h[j])
            dx = arrays.x[i] - arrays.x[j]
            dy = arrays.y[i] - arrays.y[j]
            r2 = dx * dx + dy * dy
            along = body[0] * dx + body[1] * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
                along += body[2] * dz
            q2 = r2 / (mean * mean) + TINY
            value = arrays.volume[j] * shape_value(shape, q2 * inverse_root(q2))
            weight += value
            head += value * arrays.density[j] * along
            q += value * arrays.viscosity[j]
            for c in range(components):
                stress[c, i] += value * stress[c, j]
        inverse = 1.0 / weight if weight > TINY else 0.0
        arrays.viscosity[i] = q * inverse
        for c in range(components):
            stress[c, i] *= inverse
        for c in range(3):
            stress[c, i] -= head * inverse
        work = 0.5 * dt * (work + _power(i, z, arrays)) / numbers.wall[m]
        arrays.energy[i] += work
        arrays.dissipated[i] = arrays.energy[i]
        arrays.density[i] = numbers.wall[m]
        arrays.volume[i] = arrays.mass[i] / arrays.density[i]
        _to_force(i, z, correction, arrays, numbers)


@kernel
def without_walls(i0, i1, solid, shape, correction, arrays, numbers):
    """Takes out of the walls' velocity gradients what other walls' particles add, which nobody feels.

    solid: None in the plane. Walls that move with a structure exert nothing on each
    other, and what is counted as their stress's work is to be what the others lose: on an uneven wall that turns the
    rest is not zero (a tenth of all work in the coupled run of a cone on a plate).
    """
    x, y, z = arrays.x_half, arrays.y_half, arrays.z_half
    d = 2 if solid is None else 3
    reach2 = shape.support * shape.support
    for i in range(i0, i1):
        if not numbers.wall[arrays.material[i]] > 0.0:
            continue
        for k in range(arrays.first[i], arrays.first[i] + arrays.count[i]):
            j = arrays.rows[k]
            dx = (x[i] - x[j], y[i] - y[j], 0.0 if solid is None else z[i] - z[j])
            r2 = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]
            mean = 0.5 * (arrays.h[i] + arrays.h[j])
            if r2 >= reach2 * mean * mean or not numbers.wall[arrays.material[j]] > 0.0:
                continue
            q2 = r2 / (mean * mean) + TINY
            iq = inverse_root(q2)
            factor = arrays.volume[j] * numbers.normal * mean ** -(d + 2.0) * shape_slope(shape, q2 * iq, iq)
            du = (
                arrays.u[j] - arrays.u[i],
                arrays.v[j] - arrays.v[i],
                0.0 if solid is None else arrays.w[j] - arrays.w[i],
            )
            for b in range(d):
                slope = dx[b]
                if correction is not None:
                    slope = 0.0
                    for c in range(d):
                        slope += dx[c] * correction[_SHAPE[c][b] if solid is None else _SOLID[c][b], i]
                for a in range(d):
                    arrays.gradient[d * a + b, i] -= factor * slope * du[a]


@kernel
def _power(i, z, arrays):
    """(stress - q) : grad v."""
    stress, gradient = arrays.stress, arrays.gradient
    q = arrays.viscosity[i]
    if z is None:
        shear = stress[3, i] * (gradient[1, i] + gradient[2, i])
        return (stress[0, i] - q) * gradient[0, i] + (stress[1, i] - q) * gradient[3, i] + shear
    power = 0.0
    for a in range(3):
        for b in range(3):
            power += (stress[_SOLID[a][b], i] - (q if a == b else 0.0)) * gradient[3 * a + b, i]
    return power


@kernel
def _to_force(i, z, correction, arrays, numbers):
    """s of a particle from its stress, as `particle.constitutive` makes it."""
    stress, s = arrays.stress, arrays.s
    inverse = 1.0 if numbers.mixed else 1.0 / (arrays.density[i] * arrays.density[i])
    q = arrays.viscosity[i] * inverse
    if correction is None:
        for c in range(3 if z is None else 6):
            s[c, i] = stress[3 if z is None and c == 2 else c, i] * inverse - (
                q if c < (2 if z is None else 3) else 0.0
            )
        return
    d = 2 if z is None else 3
    for a in range(d):
        for b in range(d):
            total = 0.0
            for c in range(d):
                if z is None:
                    t = stress[_STRESS[a][c], i] * inverse
                    shape = correction[_SHAPE[c][b], i]
                else:
                    t = stress[_SOLID[a][c], i] * inverse
                    shape = correction[_SOLID[c][b], i]
                total += (t - (q if a == c else 0.0)) * shape
            s[a * d + b, i] = total
