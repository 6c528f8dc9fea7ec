"""What a run records of single places and particles in each row of its history."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .problem import Problem
from .smoothing import Shape, value_many
from .state import State

Floats = NDArray[np.float64]


def pressures(s: State, live: int, shape: Shape, points: Floats, bodies: NDArray[np.int64]) -> Floats:
    """(k,) pressures at the points (k, 3), each among the particles of one body: sum V p W / sum V W, 0 where none are.

    The quotient (Shepard 1968) makes the mean right at free surfaces and walls, where the kernel is cut off.
    """
    volume = s.rows("volume")[0, :live]
    pressure = -s.rows("stress")[:3, :live].mean(axis=0)
    h = s.rows("h")[0, :live]
    found = np.zeros(len(points))
    for k, (point, body) in enumerate(zip(points, bodies, strict=True)):
        distance = np.sqrt(np.sum((s.rows("x")[:, :live] - point[: s.d, None]) ** 2, axis=0))
        near = np.flatnonzero((distance < shape.support * h) & (s.material[:live] == body))
        if len(near):
            weight = volume[near] * value_many(shape, distance[near] / h[near])
            found[k] = weight @ pressure[near] / weight.sum() if weight.sum() > 0.0 else 0.0
    return found


def traces(s: State, live: int, ids: NDArray[np.int64], velocity: Floats) -> dict[str, float]:
    """Columns of single particles: place, velocity, pressure, density; NaN for those that have left."""
    place = dict(zip(s.id[:live].tolist(), range(live), strict=True))
    columns: dict[str, float] = {}
    for number in ids.tolist():
        i = place.get(number)
        names = [f"{axis}" for axis in "xyz"[: s.d]] + [f"velocity_{axis}" for axis in "xyz"[: s.d]]
        values = np.full(2 * s.d + 2, np.nan)
        if i is not None:
            values[: s.d] = s.rows("x")[:, i]
            values[s.d : 2 * s.d] = velocity[:, i]
            values[-2] = -s.rows("stress")[:3, i].mean()
            values[-1] = s.rows("density")[0, i]
        for name, value in zip([*names, "pressure", "density"], values.tolist(), strict=True):
            columns[f"particle_{number}_{name}"] = value
    return columns


def columns(p: Problem, s: State, live: int, shape: Shape, velocity: Floats) -> dict[str, float]:
    """The columns of a problem's transducers and traced particles."""
    found: dict[str, float] = {}
    if p.transducers:
        table = np.array(p.transducers)
        values = pressures(s, live, shape, table[:, :3], table[:, 3].astype(np.int64))
        found = {f"pressure_{k}": value for k, value in enumerate(values.tolist(), start=1)}
    if p.traced:
        found |= traces(s, live, np.array(p.traced), velocity)
    return found
