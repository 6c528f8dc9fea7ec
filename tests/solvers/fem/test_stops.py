"""Rigid planes that nodes cannot pass: in motion and at rest, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from fem_meshes import group, held, loaded, moved, problem, quads, solve

from zrno.solvers import fem
from zrno.solvers.materials import Elastic


def test_a_bar_bounces_off_a_plane() -> None:
    """Trusses that start a gap away at speed v: they press from then on, for 2 L / c, with rho c v."""
    n, speed, gap = 100, 0.01, 0.002
    x = np.column_stack([np.linspace(-1.0, 0.0, n + 1), np.zeros((n + 1, 2))])
    nodes = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    law = Elastic.from_engineering(1.0, 0.0)
    elements = fem.Elements("line2", "truss", nodes, np.arange(1, n + 1), 1, law, density=1.0, section={"area": 1.0})
    velocity = np.zeros((n + 1, 6))
    velocity[:, 0] = speed
    p = problem(x, elements, held(n + 1, (slice(None), "yz")), velocity=velocity, steps=((300, 0.01),),
                stops=(fem.Stop((gap, 0, 0), (-1, 0, 0)),), dynamics=fem.Dynamics("central", lumped=True))  # fmt: skip
    solver, seen = solve(p, lambda s: s.assembly.stops.force(s.shape.u)[0])  # type: ignore[union-attr]
    force = -np.array(seen)
    times = 0.01 * np.arange(1, 301)
    pressing = times[force > 0.0]
    assert pressing[0] == pytest.approx(gap / speed, abs=0.02)
    assert pressing[-1] - pressing[0] == pytest.approx(2.0, rel=0.03)
    assert force[(times > 0.4) & (times < 2.0)].mean() == pytest.approx(speed, rel=0.01)  # rho c v A
    assert 0.01 * force.sum() == pytest.approx(2.0 * speed, rel=0.02)
    assert solver.energy_report()["balance_error"] < 0.01


def test_a_plane_holds_a_block_and_does_not_pull() -> None:
    """A block on a plane, pressed: the plane gives way by little of its shortening; pulled, it goes."""
    x, nodes, number = quads(4, 4, lambda r, s: np.stack([r, s, 0 * r], -1))
    law = Elastic.from_engineering(1e3, 0.0)
    fixed = held(len(x), (slice(None), "z"), (number[0], "x"))
    elements = group("quad4", "plane", nodes, law, plane="strain")
    top = number[:, -1]
    value = np.array([[0, 1e-3, 0, 0, 0, 0.0]])
    spring = fem.Elements("point1", "spring", top[:1, None], np.array([99]), 2, None, value=value)
    stop = (fem.Stop((0, 0, 0), (0, 1, 0), 100.0),)
    push = fem.NodalLoad(top, np.ones(5, int), -np.array([0.5, 1, 1, 1, 0.5]) / 4)
    solver, _ = solve(problem(x, (elements, spring), fixed, nodal_loads=(push,), stops=stop))
    assert moved(solver, top[2], 1) == pytest.approx(-1e-3, rel=0.02)
    assert -1e-3 * 0.02 < moved(solver, number[2, 0], 1) < 0.0
    assert solver.assembly.stops.force(solver.shape.u)[1] == pytest.approx(1.0, rel=1e-4)  # type: ignore[union-attr]
    pulled, _ = solve(problem(x, (elements, spring), fixed, nodal_loads=(loaded(top, 1, 1e-6),), stops=stop))
    assert moved(pulled, number[2, 0], 1) == pytest.approx(1e-3, rel=1e-2)  # only the spring holds it


def test_planes_do_not_damp() -> None:
    """A block that flies to a plane, with Rayleigh's damping by stiffness: nothing slows it on the way, and Newton's
    matrix is the derivative: few iterations once it presses."""
    x, nodes, number = quads(2, 2, lambda r, s: np.stack([r, 0.1 + s, 0 * r], -1))
    fixed = held(len(x), (slice(None), "z"), (number[0], "x"))
    elements = group("quad4", "plane", nodes, Elastic.from_engineering(1e3, 0.0), plane="strain", density=1.0)
    velocity = np.zeros((len(x), 6))
    velocity[:, 1] = -1.0
    p = problem(x, elements, fixed, velocity=velocity, stops=(fem.Stop((0, 0, 0), (0, 1, 0)),), steps=((120, 1e-3),),
                dynamics=fem.Dynamics(stiffness_damping=1e-3))  # fmt: skip
    solver, seen = solve(p, lambda s: (s.iterations, moved(s, number[1, 1], 1)))
    np.testing.assert_allclose([u for _, u in seen[:95]], -1e-3 * np.arange(1, 96), rtol=1e-9)
    assert solver.assembly.stops.force(solver.shape.u)[1] > 0.0  # type: ignore[union-attr]
    assert np.diff([i for i, _ in seen[99:]]).max() <= 3
