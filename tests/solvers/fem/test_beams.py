"""Beams of large displacement: their matrix, a circle, the elastica, a bend in space."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from fem_meshes import group, held, loaded, moved, problem, ramp, solve
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from zrno.solvers import fem
from zrno.solvers.fem.assembly import Assembly
from zrno.solvers.fem.shape import Shape
from zrno.solvers.materials import Elastic

LAW = Elastic.from_engineering(1e7, 0.0)
SECTION = {"area": 1.0, "iyy": 1.0 / 12.0, "izz": 1.0 / 12.0, "j": 1.0 / 6.0}


def _line(n: int, length: float, **more: Any) -> tuple[np.ndarray, fem.Elements]:
    x = np.outer(np.linspace(0.0, length, n + 1), [1.0, 0.0, 0.0])
    nodes = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    section = more.pop("section", SECTION)
    return x, group("line2", "beam", nodes, LAW, geometry="total", section=section, **more)


def _one(seed: int) -> tuple[Assembly, Shape]:
    """A slanting beam, both ends moved and turned at random."""
    rng = np.random.default_rng(seed)
    x = np.array([[0.0, 0, 0], [1.0, 2.0, 0.5]])
    elements = group("line2", "beam", np.array([[0, 1]]), LAW, geometry="total",
                     section={**SECTION, "iyy": 0.2, "shear_area_y": 0.8})  # fmt: skip
    a = Assembly(problem(x, elements, held(2)))
    shape = Shape(np.zeros((2, 6)), a.still).moved(np.tile(rng.uniform(-1.5, 1.5, (1, 6)), (2, 1)))
    return a, shape.moved(rng.uniform(-0.3, 0.3, (2, 6)))


def test_forces_are_derivatives_of_the_energy_and_the_matrix_of_forces() -> None:
    a, shape = _one(3)

    def at(change: np.ndarray) -> tuple[float, np.ndarray]:
        forces, _ = a.evaluate(shape.moved(change.reshape(2, 6)), shape, 1.0, stiff=False)
        a.commit()
        return a.groups[0].energies()[0], forces.ravel()

    a.evaluate(shape, shape, 1.0)
    matrix, step = a.system.full().toarray(), 1e-5
    base = at(np.zeros(12))[1]
    slopes, rows = np.empty(12), np.empty((12, 12))
    for k in range(12):
        plus, minus = at(step * np.eye(12)[k]), at(-step * np.eye(12)[k])
        slopes[k] = (plus[0] - minus[0]) / (2.0 * step)
        rows[k] = (plus[1] - minus[1]) / (2.0 * step)
    np.testing.assert_allclose(base, slopes, atol=1e-7 * np.abs(base).max())
    np.testing.assert_allclose(matrix, 0.5 * (rows + rows.T), atol=1e-7 * np.abs(matrix).max())


def test_turning_leaves_no_force() -> None:
    """Far beyond half a turn, about an axis of no element."""
    x, elements = _line(2, 3.0)
    a = Assembly(problem(x, elements, held(3)))
    shape = Shape(np.zeros((3, 6)), a.still)
    for _ in range(4):
        spin = np.array([0.7, -0.9, 1.1])
        turned = shape.moved(np.concatenate([np.zeros((3, 3)), np.tile(spin, (3, 1))], axis=1))
        assert turned.turn is not None
        turned.u[:, :3] = x @ turned.turn[0].T - x + 5.0
        shape = turned
    forces, _ = a.evaluate(shape, shape, 1.0, stiff=False)
    assert np.abs(forces).max() < 1e-8 * 1e7


@pytest.mark.parametrize(("n", "within"), [(10, 0.02), (20, 0.005)])
def test_a_cantilever_rolls_up_to_a_circle(n: int, within: float) -> None:
    """End moment 2 pi E I/L: the tip comes back to the root; at half of it, at 2 L/pi above it (Sze 2004, 3.2)."""
    length = 12.0
    full = 2.0 * math.pi * 1e7 / 12.0 / length
    x, elements = _line(n, length)
    p = problem(x, elements, held(n + 1, ([0], "xyzabc")), nodal_loads=(loaded(n, 4, -full, 0),), curves=(ramp(),),
                steps=((20, 0.05),))  # fmt: skip
    solver, seen = solve(p, lambda s: (moved(s, n, 0), moved(s, n, 2)))
    assert abs(seen[9][1]) == pytest.approx(2.0 * length / math.pi, rel=within)
    assert seen[9][0] == pytest.approx(-length, rel=within)
    assert np.hypot(seen[19][0] + length, seen[19][1]) < within * length
    assert solver.energy_report()["balance_error"] < 1e-3


def _elastica(load: float) -> tuple[float, float]:
    """Tip of a cantilever of length and E I 1 under a force across its start: along and across (Bisshopp & Drucker
    1945)."""
    root = math.sqrt(load)

    def missing(k: float) -> float:
        return float(ellipk(k * k) - ellipkinc(math.asin(1.0 / (k * math.sqrt(2.0))), k * k)) - root

    k = brentq(missing, math.sqrt(0.5) + 1e-12, 1.0 - 1e-12)
    s = math.asin(1.0 / (k * math.sqrt(2.0)))
    across = 1.0 - 2.0 / root * float(ellipe(k * k) - ellipeinc(s, k * k))
    along = math.sqrt(2.0) / root * math.sqrt(2.0 * k * k - 1.0)
    return along, across


@pytest.mark.parametrize("load", [1.0, 5.0, 10.0])
def test_the_elastica(load: float) -> None:
    """A slender cantilever, a force of so many E I/L^2 across; stiff along, so that it hardly stretches."""
    n = 20
    x, elements = _line(n, 1.0, section={**SECTION, "area": 1e4})
    force = load * 1e7 / 12.0
    p = problem(x, elements, held(n + 1, ([0], "xyzabc")), nodal_loads=(loaded(n, 1, force, 0),), curves=(ramp(),),
                steps=((10, 0.1),))  # fmt: skip
    solver, _ = solve(p)
    along, across = _elastica(load)
    assert 1.0 + moved(solver, n, 0) == pytest.approx(along, abs=2e-3)
    assert moved(solver, n, 1) == pytest.approx(across, abs=2e-3)


def test_a_bend_in_space() -> None:
    """An eighth of a circle of radius 100, clamped, pushed out of its plane: the tip's place under 300 and 600 (Bathe &
    Bolourchi 1979; numbers of Simo & Vu-Quoc 1986)."""
    n = 8
    angle = np.linspace(0.0, math.pi / 4.0, n + 1)
    x = 100.0 * np.column_stack([1.0 - np.cos(angle), np.sin(angle), 0.0 * angle])
    nodes = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    elements = group("line2", "beam", nodes, LAW, geometry="total", section=SECTION)
    p = problem(x, elements, held(n + 1, ([0], "xyzabc")), nodal_loads=(loaded(n, 2, 600.0, 0),), curves=(ramp(),),
                steps=((10, 0.1),))  # fmt: skip
    _, seen = solve(p, lambda s: x[n] + s.shape.u[n, :3])
    np.testing.assert_allclose(seen[4], (22.33, 58.84, 40.08), rtol=0.01)
    np.testing.assert_allclose(seen[9], (15.79, 47.23, 53.37), rtol=0.01)
