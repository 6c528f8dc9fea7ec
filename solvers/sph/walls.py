"""Particles against rigid planes (`contact.plane`): one-sided push and Coulomb friction, wall by wall."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..contact.friction import FORGET, follow, rub
from ..contact.plane import wall_push
from ..jit import kernel
from .across import stable_step


class Walls(NamedTuple):
    """position, normal (unit): (walls, 3); static, kinetic: (walls,) coefficients.

    stiff: (bodies,) squared wave speed; radius: (bodies,) of a particle in units of its h.
    """

    position: Any
    normal: Any
    static: Any
    kinetic: Any
    stiff: Any
    radius: Any


@kernel
def wall_force(i0, i1, z, walls, law, damping, slip, heat, dt, cx, arrays):
    """Adds the walls' forces to a range of particles; returns the longest stable step.

    law: None where cx does not yet hold what other bodies do. slip: None without friction, or (walls (d + 2), n + 1)
    elastic slip, how far it slid, and the load of friction, wall by wall.
    """
    u, v = arrays.u, arrays.v
    least = np.inf
    d = 3 if z is not None else 2
    for i in range(i0, i1):
        b = arrays.material[i]
        radius = walls.radius[b] * arrays.h[i]
        mass = arrays.mass[i]
        wave = math.sqrt(walls.stiff[b])
        k = walls.stiff[b] * mass / (4.0 * radius * radius)
        a0 = 0.0
        a1 = 0.0
        a2 = 0.0
        total = 0.0
        for m in range(len(walls.position)):
            nx = walls.normal[m, 0]
            ny = walls.normal[m, 1]
            nz = walls.normal[m, 2]
            distance = (arrays.x[i] - walls.position[m, 0]) * nx + (arrays.y[i] - walls.position[m, 1]) * ny
            if z is not None:
                distance += (z[i] - walls.position[m, 2]) * nz
            force, stiffness = wall_push(radius - distance, radius, k)
            if stiffness == 0.0:
                if slip is not None:
                    row = m * (d + 2)
                    slip[row : row + d, i] = 0.0
                    slip[row + d + 1, i] = follow(slip[row + d + 1, i], 0.0, dt, FORGET * wave, arrays.h[i])
                continue
            sx = u[i]
            sy = v[i]
            sz = arrays.w[i] if z is not None else 0.0
            along = sx * nx + sy * ny + sz * nz
            if damping is not None:
                more = max(-force, -2.0 * damping * math.sqrt(stiffness * mass) * along)
                force += more
                heat[i] -= more * along * dt
            total += stiffness
            tx = 0.0
            ty = 0.0
            tz = 0.0
            if slip is not None:
                row = m * (d + 2)
                load = follow(slip[row + d + 1, i], force, dt, wave, arrays.h[i])
                slip[row + d + 1, i] = load
                tx, ty, tz, ex, ey, ez, slid, lost = rub(
                    slip[row, i], slip[row + 1, i], slip[row + 2, i] if z is not None else 0.0,
                    sx - along * nx, sy - along * ny, sz - along * nz, dt, load, force, k, mass, arrays.h[i],
                    walls.static[m], walls.kinetic[m], slip[row + d, i],
                )  # fmt: skip
                slip[row, i] = ex
                slip[row + 1, i] = ey
                if z is not None:
                    slip[row + 2, i] = ez
                slip[row + d, i] = slid
                heat[i] += lost
            a0 += force * nx - tx
            a1 += force * ny - ty
            a2 += force * nz - tz
        if total > 0.0:
            least = min(least, stable_step(mass, total, damping))
        a0 /= mass
        a1 /= mass
        a2 /= mass
        if law is None:
            cx[i] = a0
            arrays.cy[i] = a1
        else:
            cx[i] += a0
            arrays.cy[i] += a1
        arrays.ax[i] += a0
        arrays.ay[i] += a1
        if z is not None:
            if law is None:
                arrays.cz[i] = a2
            else:
                arrays.cz[i] += a2
            arrays.az[i] += a2
    return least
