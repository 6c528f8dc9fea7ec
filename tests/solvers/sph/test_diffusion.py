"""Diffusion of density and stress against its law, pair by pair."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
import pytest
from sph_scenes import jittered, one_body, periodic

from zrno.solvers.sph import Plane, Solver, cures, smoothing
from zrno.solvers.sph.ghosts import SYMMETRY


def diffused(solver: Solver) -> tuple[np.ndarray, np.ndarray]:
    """(n,) and (n, 6) rates of density and stress diffusion as their docstrings say, pair by pair, with no list."""
    a, numbers, n, d = solver._arrays(), solver._numbers, solver.n, solver.problem.dimension
    images = solver._images.source
    x = np.stack([row[: n + len(images)] for row in (a.x, a.y, a.z)[:d]], axis=1)
    level = np.concatenate([np.arange(n), images])
    g = numbers.body[:d]
    down = g**2 / (g @ g)
    of_density, of_stress = np.zeros(n), np.zeros((n, 6))
    for i, j in itertools.product(range(n), range(len(x))):
        m = a.material[i]
        h = 0.5 * (a.h[i] + a.h[j])
        q = float(np.linalg.norm(x[i] - x[j])) / h
        if a.material[j] != m or not 0.0 < q < solver._shape.support:
            continue
        slope = -2.0 * a.h[i] * numbers.wave[m] * numbers.normal * smoothing.slope_at(solver._shape, q) / h ** (d + 2)
        fall = g * (x[i] - x[level[j]])
        head = a.density[i] / numbers.wave[m] ** 2 * fall.sum()
        share = numbers.density_diffusion[m] * a.volume[j] * slope
        of_density[i] += share * (a.density[j] - a.density[i] + head)
        mean = a.stress[:3, i] + a.stress[:3, j]
        along = float(down @ mean[:d])
        ratio = np.clip(mean / along, 0.0, 1.0) if along < 0.0 else np.zeros(3)
        own = np.append(fall, np.zeros(3 - d))
        step = a.stress[:, j] - a.stress[:, i]
        step[:3] -= a.density[i] * (own + ratio * (fall.sum() - own))
        of_stress[i, : len(step)] += numbers.stress_diffusion[m] * a.volume[j] * slope * step
    return of_density, of_stress


@pytest.mark.parametrize(
    ("shape", "planes"),
    [
        pytest.param((8, 7), (), marks=pytest.mark.slow),
        ((8, 7), (Plane(1, -1, SYMMETRY, -0.02), Plane(0, -1, SYMMETRY, -0.03))),
        pytest.param((8, 7), periodic(0.8), marks=pytest.mark.slow),
        ((8, 7), (Plane(1, -1, SYMMETRY, -9.0),)),  # a plane without images
        ((5, 4, 4), (Plane(1, -1, SYMMETRY, -0.02),)),
    ],
)
def test_diffusion_is_the_law_pair_by_pair(shape: tuple[int, ...], planes: tuple[Plane, ...]) -> None:
    """Three bodies, of which the last does not diffuse; own smoothing lengths, stress and density at random."""
    d = len(shape)
    x = jittered(shape, 0.1)
    n, noise = len(x), np.random.default_rng(11)
    body = noise.integers(0, 3, n)
    base = one_body(x, dimension=d, planes=planes, body={"density_diffusion": 0.1, "stress_diffusion": 0.2})
    kept = base.bodies[0]
    bodies = (
        kept, dataclasses.replace(kept, number=2, density_diffusion=0.3, stress_diffusion=0.1),
        dataclasses.replace(kept, number=3, density_diffusion=0.0, stress_diffusion=0.0),
    )  # fmt: skip
    stress = noise.normal(size=(n, 6)) - 1.0 * (np.arange(6) < 3)
    stress[:, 4:] *= d == 3
    problem = dataclasses.replace(
        base, body=body, bodies=bodies, body_force=(0.3, -0.7, 0.2 * (d == 3)), stress=stress,
        density=noise.uniform(0.9, 1.1, n), h=noise.uniform(0.11, 0.13, n),
    )  # fmt: skip
    solver = Solver(problem, threads=1)
    a, numbers, solid = solver._arrays(), solver._numbers, True if d == 3 else None
    images = solver._images.source if planes else None
    assert (images is not None and len(images) > 0) == (bool(planes) and planes[0].position > -1.0)
    for half, at in ((a.x_half, a.x), (a.y_half, a.y), (a.z_half, a.z))[:d]:
        half[:] = at
    of_density, of_stress = np.zeros(n), np.zeros((6, n))
    args = (0, n, n, images, solid, solver._shape, a.x_half, a.y_half, a.z_half, a, numbers)
    cures.density_diffusion(*args, of_density)
    cures.stress_diffusion(*args, of_stress)
    want_density, want_stress = diffused(solver)
    assert np.abs(of_density - want_density).max() < 1e-13 * np.abs(want_density).max()
    assert np.abs(of_stress.T - want_stress).max() < 1e-13 * np.abs(want_stress).max()
    still = a.material[:n] == 2
    assert np.all(of_density[still] == 0.0)
    assert np.all(of_density[~still] != 0.0)
