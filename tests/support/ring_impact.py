"""The rings of the sample rubber_rings by finite elements: it shares nothing with the solvers.

Two equal rings that meet are one ring that meets a smooth rigid wall, and of that the upper half. Four-node elements in
plane strain with the mean dilatation of each (Nagtegaal, Parks & Rice 1974), Hooke's law by rates with Jaumann's spin
(as the particles have it), central differences, no damping; the wall pushes back what has passed it like a spring.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

INNER, OUTER, DENSITY, YOUNG, POISSON = 0.03, 0.04, 1000.0, 1.0e6, 0.3975  # m, kg, s: the sample's
LAME = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
SOUND = math.sqrt((LAME + 2.0 / 3.0 * SHEAR) / DENSITY)  # c0 of the literature
_GAUSS = [(a / math.sqrt(3.0), b / math.sqrt(3.0)) for a in (-1, 1) for b in (-1, 1)]
_SLOPES = np.array([
    [[-(1 - b), (1 - b), (1 + b), -(1 + b)], [-(1 - a), -(1 + a), (1 + a), (1 - a)]] for a, b in _GAUSS
]) / 4.0  # fmt: skip


class Rebound(NamedTuple):
    """restitution: mean velocity after over before; energy: all of it at the end over what there was at the start."""

    restitution: float
    energy: float
    steps: int


def _mesh(cells: int) -> tuple[Floats, NDArray[np.int64]]:
    """Half a ring that touches the wall x = 0, `cells` through its thickness: (n, 2) places, (e, 4) corners."""
    around = round(cells * math.pi * 0.5 * (INNER + OUTER) / (OUTER - INNER))
    radius, angle = np.meshgrid(
        np.linspace(INNER, OUTER, cells + 1), np.linspace(0.0, math.pi, around + 1), indexing="ij"
    )
    x = np.stack([OUTER + radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    number = np.arange(x[..., 0].size).reshape(radius.shape)
    corners = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    return x.reshape(-1, 2), corners.reshape(-1, 4)


def _slopes(x: Floats) -> tuple[Floats, Floats]:
    """Of the shape functions at the four points of each element, (e, 4, 2, 4), and the points' areas (e, 4)."""
    jacobian = np.einsum("gan,enb->egab", _SLOPES, x)
    area = jacobian[..., 0, 0] * jacobian[..., 1, 1] - jacobian[..., 0, 1] * jacobian[..., 1, 0]
    return np.linalg.solve(jacobian, np.broadcast_to(_SLOPES, (len(x), *_SLOPES.shape))), area


def ring_against_wall(cells: int, speed: float, until: float) -> Rebound:
    """cells: through the thickness; speed: of the ring towards the wall, parts of c0; until: time [s]."""
    x, corners = _mesh(cells)
    n, size = len(x), (OUTER - INNER) / cells
    dt = 0.4 * size / math.sqrt((LAME + 2.0 * SHEAR) / DENSITY)
    stiff = YOUNG  # of the wall by length, and depth 1: about that of an element
    _, area = _slopes(x[corners])
    mass = np.bincount(corners.ravel(), np.repeat(DENSITY * area.sum(axis=1) / 4.0, 4), n)
    v = np.zeros_like(x)
    v[:, 0] = -speed * SOUND
    lower = np.abs(x[:, 1]) < 1e-9 * OUTER
    stress = np.zeros((len(corners), 4, 4))  # xx yy zz xy
    internal = 0.0
    start = 0.5 * float(mass @ (v * v).sum(axis=1))
    steps = math.ceil(until / dt)
    force = np.zeros_like(x)
    for _ in range(steps):
        v += dt * force / mass[:, None]
        v[lower, 1] = 0.0
        middle = x + 0.5 * dt * v
        slopes, area = _slopes(middle[corners])
        gradient = np.einsum("egbn,ena->egab", slopes, v[corners]) * dt
        volume = np.einsum("eg,egaa->e", area, gradient) / area.sum(axis=1)  # the mean, at all points
        shift = 0.5 * (volume[:, None] - np.einsum("egaa->eg", gradient))
        xx, yy = gradient[..., 0, 0] + shift, gradient[..., 1, 1] + shift
        xy = 0.5 * (gradient[..., 0, 1] + gradient[..., 1, 0])
        half = 0.25 * (gradient[..., 1, 0] - gradient[..., 0, 1])  # tan of half the turn (Hughes & Winget 1980)
        c, s = (1.0 - half**2) / (1.0 + half**2), 2.0 * half / (1.0 + half**2)
        old = stress.copy()
        a, b, t = stress[..., 0].copy(), stress[..., 1].copy(), stress[..., 3].copy()
        stress[..., 0] = c * c * a + s * s * b - 2.0 * s * c * t
        stress[..., 1] = s * s * a + c * c * b + 2.0 * s * c * t
        stress[..., 3] = s * c * (a - b) + (c * c - s * s) * t
        stress[..., :3] += LAME * volume[:, None, None]
        stress[..., 0] += 2.0 * SHEAR * xx
        stress[..., 1] += 2.0 * SHEAR * yy
        stress[..., 3] += 2.0 * SHEAR * xy
        mean = 0.5 * (old + stress)
        work = mean[..., 0] * xx + mean[..., 1] * yy + 2.0 * mean[..., 3] * xy
        internal += float((work * area).sum())
        x = x + dt * v
        slopes, area = _slopes(x[corners])
        weighed = stress * area[..., None]
        plane = 0.5 * (weighed[..., 0] + weighed[..., 1])  # works on the mean dilatation, the rest on the strain itself
        share = np.einsum("eg,egbn->ebn", area, slopes) / area.sum(axis=1)[:, None, None]
        fx = np.einsum("eg,egn->en", weighed[..., 0] - plane, slopes[:, :, 0])
        fx += np.einsum("eg,egn->en", weighed[..., 3], slopes[:, :, 1]) + plane.sum(axis=1)[:, None] * share[:, 0]
        fy = np.einsum("eg,egn->en", weighed[..., 1] - plane, slopes[:, :, 1])
        fy += np.einsum("eg,egn->en", weighed[..., 3], slopes[:, :, 0]) + plane.sum(axis=1)[:, None] * share[:, 1]
        force[:, 0] = -np.bincount(corners.ravel(), fx.ravel(), n) + stiff * np.maximum(0.0, -x[:, 0])
        force[:, 1] = -np.bincount(corners.ravel(), fy.ravel(), n)
    kinetic = 0.5 * float(mass @ (v * v).sum(axis=1))
    return Rebound(float(mass @ v[:, 0] / mass.sum()) / (speed * SOUND), (kinetic + internal) / start, steps)
