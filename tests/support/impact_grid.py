"""The impact of the samples of two cylinders by finite differences: it shares nothing with the solvers."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# cm, us, g, Mbar: the samples' numbers
LENGTH, RADIUS, DENSITY = 3.0, 0.5, 2.7
YOUNG, POISSON, YIELD = 1.656, 0.33, 0.0029
LAME = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
LONGITUDINAL = math.sqrt((LAME + 2.0 * SHEAR) / DENSITY)
ROD = math.sqrt(YOUNG / (DENSITY * (1.0 - POISSON**2)))  # the speed of a rod's waves in plane strain


class Impact(NamedTuple):
    """Against time, after each step: (n,). largest: von Mises stress near the axis and the wall; kinetic: energy of a
    whole cylinder; force: on the wall."""

    times: Floats
    largest: Floats
    kinetic: Floats
    force: Floats


def rod_against_wall(cells: int, speed: float, until: float) -> Impact:
    """Half a cylinder (symmetry) that runs into a smooth rigid wall (the other cylinder): elastic, plane strain,
    velocities and stresses on staggered grids (Virieux 1986). The wall does not let go."""
    d = RADIUS / cells
    nx, ny = round(LENGTH / d), cells
    dt = 0.6 * d / LONGITUDINAL
    vx, vy = np.full((nx + 1, ny), -speed), np.zeros((nx, ny + 1))
    vx[0] = 0.0
    across, along = np.ones((nx + 1, 1)), np.ones((1, ny + 1))  # half the mass at the borders
    across[[0, -1]] = along[:, [0, -1]] = 0.5
    xx, yy, zz, xy = np.zeros((nx, ny)), np.zeros((nx, ny)), np.zeros((nx, ny)), np.zeros((nx + 1, ny + 1))
    times = dt * np.arange(1, math.ceil(until / dt) + 1)
    largest, kinetic, force = np.zeros((3, len(times)))
    for k in range(len(times)):
        ex, ey = np.diff(vx, axis=0) / d, np.diff(vy, axis=1) / d
        xx += dt * ((LAME + 2.0 * SHEAR) * ex + LAME * ey)
        yy += dt * ((LAME + 2.0 * SHEAR) * ey + LAME * ex)
        zz += dt * LAME * (ex + ey)
        xy[1:-1, 1:-1] += dt * SHEAR * (np.diff(vx, axis=1)[1:-1] + np.diff(vy, axis=0)[:, 1:-1]) / d
        before = vx.copy(), vy.copy()
        vx[1:-1] += dt / DENSITY * (np.diff(xx, axis=0) + np.diff(xy, axis=1)[1:-1]) / d
        vx[-1] += dt / DENSITY * (-2.0 * xx[-1] + np.diff(xy, axis=1)[-1]) / d
        vy[:, 1:-1] += dt / DENSITY * (np.diff(yy, axis=1) + np.diff(xy, axis=0)[:, 1:-1]) / d
        vy[:, -1] += dt / DENSITY * (-2.0 * yy[:, -1]) / d
        shear = 0.25 * (xy[1:, 1:] + xy[:-1, 1:] + xy[1:, :-1] + xy[:-1, :-1])
        mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * shear**2)
        largest[k] = mises[: 2 * cells, : max(1, cells // 10)].max()
        squares = (across * before[0] * vx).sum() + (along * before[1] * vy).sum()
        kinetic[k] = DENSITY * d * d * squares  # of two halves
        force[k] = -2.0 * d * xx[0].sum()
    return Impact(times, largest, kinetic, force)
