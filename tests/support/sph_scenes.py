"""Small problems that several tests run."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from zrno.solvers.materials import Elastic
from zrno.solvers.sph import Body, Problem, Solver, cures, packed
from zrno.solvers.sph.ghosts import PERIODIC, Plane
from zrno.solvers.threads import meeting

ELASTIC = Elastic.from_engineering(1.0, 0.3)


def lattice(shape: tuple[int, ...], at: tuple[float, ...], spacing: float = 0.1) -> np.ndarray:
    """Points in the middles of cells, (n, 3)."""
    axes = [a + spacing * (np.arange(n) + 0.5) for n, a in zip(shape, at, strict=True)]
    x = np.zeros((math.prod(shape), 3))
    x[:, : len(shape)] = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(shape))
    return x


def one_body(
    x: np.ndarray,
    v: np.ndarray | None = None,
    *,
    dimension: int = 2,
    spacing: float = 0.1,
    law: Any = ELASTIC,
    body: dict[str, float] | None = None,
    **options: Any,
) -> Problem:
    """A body of unit density on a lattice."""
    n = len(x)
    v = np.zeros_like(x) if v is None else v
    given = {
        "dimension": dimension, "x": x, "v": v, "mass": np.full(n, spacing**dimension),
        "h": np.full(n, 1.2 * spacing), "density": np.ones(n), "body": np.zeros(n, np.int64),
        "bodies": (Body(1, "a", law, 1.0, **(body or {})),), "end_time": 1.0,
    }  # fmt: skip
    return Problem(**given | options)


def periodic(*lengths: float) -> tuple[Plane, ...]:
    """A box from the origin."""
    return tuple(
        Plane(a, side, PERIODIC, at) for a, length in enumerate(lengths) for side, at in ((-1, 0.0), (1, length))
    )


def impact(dimension: int, n: int = 6, law: Any = ELASTIC, speed: float = 0.01, **changes: Any) -> Problem:
    """Two blocks that touch and run into each other along x."""
    shape = (n, n, n)[:dimension]
    zeros = (0.0,) * (dimension - 1)
    x = np.concatenate([lattice(shape, (-0.1 * n, *zeros)), lattice(shape, (0.0, *zeros))])
    half = len(x) // 2
    v = np.zeros_like(x)
    v[:half, 0], v[half:, 0] = speed, -speed
    problem = one_body(x, v, dimension=dimension, law=law)
    bodies = {"body": np.repeat([0, 1], half), "bodies": (Body(1, "a", law, 1.0), Body(2, "b", law, 1.0))}
    return dataclasses.replace(problem, **bodies | changes)


def finished(problem: Problem, until: float = 1.0, **options: Any) -> Solver:
    """A solver that stands at the time `until`."""
    solver = Solver(problem, **options)
    solver.advance(until, 10**6)
    assert solver.time == until
    return solver


def jittered(shape: tuple[int, ...], amount: float = 0.25, seed: int = 3, spacing: float = 0.1) -> np.ndarray:
    """A lattice whose points are moved at random by up to `amount` of the spacing."""
    x = lattice(shape, (0.0,) * len(shape), spacing)
    x[:, : len(shape)] += amount * spacing * np.random.default_rng(seed).uniform(-1.0, 1.0, (len(x), len(shape)))
    return x


def smoothed_velocities(solver: Solver, factor: float) -> np.ndarray:
    """(d, n) what XSPH makes of the velocities that the solver's arrays now have."""
    a, numbers, n = solver._arrays(), solver._numbers, solver.n
    solid = True if numbers.dimension == 3 else None
    h = None if solver._uniform_h else a.h
    mass = None if solver._uniform_mass else a.mass
    found = np.zeros((numbers.dimension, a.x.shape[0]))
    packed.pack_smoothing(0, 1, meeting(1), solid, h, a)
    cures.smoothed_velocity(
        0, n, a.first, a.count, a.rows, solver._shape, a.packed, a.near[0, 0], solid, h, mass, numbers.inverse_h2,
        2.0 * factor * numbers.force_scale, None, found,
    )  # fmt: skip
    return found[:, :n]
