"""Growth by temperature: closed forms of one element, a cylinder, and NAFEMS LE11."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fem_meshes import bricks, eight, group, held, plane, problem, quads, ramp, solve

from zrno.solvers import fem
from zrno.solvers import materials as laws
from zrno.solvers.fem.elements import shapes
from zrno.solvers.materials import Elastic

E, NU, ALPHA = 2.1e5, 0.3, 1.2e-5
LAW = Elastic.from_engineering(E, NU)


def _warm(x: Any, nodes: Any, fixed: Any, value: Any, *, kind: str = "hex8", family: str = "solid", steps: int = 1,
          reference: float = 0.0, **more: Any) -> fem.Solver:  # fmt: skip
    elements = group(kind, family, nodes, more.pop("law", LAW), expansion=ALPHA, reference=reference, **more)
    n = np.arange(len(x))
    given = fem.Temperature(n, np.broadcast_to(value, len(n)).astype(float), 0)
    p = problem(x, elements, fixed, temperatures=(given,), curves=(ramp(),), steps=((steps, 1.0 / steps),))
    return solve(p)[0]


@pytest.mark.parametrize("more", [{}, {"modes": 12}, {"mean": True}, {"geometry": fem.UPDATED}], ids=str)
def test_free_growth_leaves_no_stress(more: dict[str, Any]) -> None:
    x, nodes, number = bricks(2, 1, 2, (2.0, 1.0, 3.0))
    fixed = held(len(x), (number[0], "x"), (number[:, 0], "y"), (number[:, :, 0], "z"))
    solver = _warm(x, nodes, fixed, 120.0, steps=3, reference=20.0, **more)
    exact = ALPHA * 100.0 if more.get("geometry") is None else np.exp(ALPHA * 100.0) - 1.0
    np.testing.assert_allclose(solver.shape.u[:, :3], exact * x, atol=1e-6 * exact)
    stress = solver.assembly.groups[0].stress  # type: ignore[attr-defined]
    assert np.abs(stress).max() < 1e-6 * E * ALPHA * 100.0
    assert solver.energy_report()["balance_error"] < 1e-6


@pytest.mark.parametrize("more", [{}, {"modes": 12}, {"law": laws.von_mises(E, NU, 1e9)}], ids=str)
def test_what_is_held_is_pressed(more: dict[str, Any]) -> None:
    """All sides held: -E alpha dT/(1 - 2 nu) in each direction; the inner node stays where it is."""
    x, nodes, number = bricks(2, 2, 2)
    inner = number[1, 1, 1]
    fixed = np.ones((len(x), 6), bool)
    fixed[inner] = False
    solver = _warm(x, nodes, fixed, 50.0, **more)
    stress = solver.assembly.groups[0].stress  # type: ignore[attr-defined]
    wanted = -E * ALPHA * 50.0 / (1.0 - 2.0 * NU)
    np.testing.assert_allclose(stress[:, :3], wanted, rtol=1e-10)
    np.testing.assert_allclose(stress[:, 3:], 0.0, atol=1e-9 * abs(wanted))


@pytest.mark.parametrize(
    ("where", "wanted"),
    [("stress", (0.0, 0.0)), ("strain", (0.0, -E * ALPHA * 50.0)), ("axisymmetric", (0.0, 0.0))],
)
def test_plane_elements_that_may_grow(where: str, wanted: tuple[float, float]) -> None:
    """In plane strain the third direction is held: -E alpha dT. Axisymmetric: the radius grows too."""
    x, nodes, number = quads(2, 2, lambda r, s: plane(np.stack([1.0 + r, s], -1)))
    fixed = held(len(x), (slice(None), "zabc"), (number[:, 0], "y"))
    fixed[number[0], 0] = where != "axisymmetric"
    more = {"thickness": np.ones(len(nodes))} if where == "stress" else {}
    solver = _warm(x, nodes, fixed, 50.0, kind="quad4", family="plane", plane=where, **more)
    stress = solver.assembly.groups[0].stress  # type: ignore[attr-defined]
    np.testing.assert_allclose(stress[:, 0], wanted[0], atol=1e-9 * E)
    np.testing.assert_allclose(stress[:, 2], wanted[1], rtol=1e-9, atol=1e-9 * E)
    grows = ALPHA * 50.0 * (1.0 + NU if where == "strain" else 1.0)
    radius = x[:, 0] if where == "axisymmetric" else x[:, 0] - 1.0
    np.testing.assert_allclose(solver.shape.u[:, 0], grows * radius, rtol=1e-9, atol=1e-12)


def test_the_hot_part_yields() -> None:
    """A bar between walls yields where E alpha dT passes its strength; cooled back it is pulled."""
    x, nodes, number = bricks(3, 1, 1, (3.0, 1.0, 1.0))
    law = laws.von_mises(E, NU, 100.0)
    fixed = held(len(x), (number[[0, -1]], "x"), (number[:, 0], "y"), (number[:, :, 0], "z"))
    n = np.arange(len(x))
    curve = fem.Curve(np.array([0.0, 1.0, 2.0]), np.array([0.0, 60.0, 0.0]))
    elements = group("hex8", "solid", nodes, law, expansion=ALPHA)
    p = problem(x, elements, fixed, temperatures=(fem.Temperature(n, np.ones(len(n)), 0),), curves=(curve,),
                steps=((20, 0.1),))  # fmt: skip
    _, seen = solve(p, lambda s: s.assembly.groups[0].stress[:, 0].copy())  # type: ignore[attr-defined]
    np.testing.assert_allclose(seen[9], -100.0, rtol=1e-6)
    np.testing.assert_allclose(seen[19], E * ALPHA * 60.0 - 100.0, rtol=1e-6)


def test_a_run_goes_on_from_a_checkpoint() -> None:
    x, nodes, number = bricks(2, 1, 1)
    fixed = held(len(x), (number[0], "xyz"))
    elements = group("hex8", "solid", nodes, LAW, expansion=ALPHA, modes=12)
    n = np.arange(len(x))
    p = problem(x, elements, fixed, temperatures=(fem.Temperature(n, x[:, 0] * 100.0, 0),), curves=(ramp(),),
                steps=((4, 0.25),))  # fmt: skip
    whole, _ = solve(p)
    half, again = fem.Solver(p), fem.Solver(p)
    half.advance(np.inf, 1)
    half.advance(np.inf, 1)
    again.restore(half.checkpoint())
    again.advance(np.inf, 1)
    again.advance(np.inf, 1)
    np.testing.assert_allclose(again.shape.u, whole.shape.u, rtol=1e-9, atol=1e-15)


def test_what_is_not_computed_says_so() -> None:
    x, nodes, number = bricks(1, 1, 1)
    given = (fem.Temperature(np.arange(8), np.ones(8)),)
    elements = group("hex8", "solid", nodes, LAW, expansion=ALPHA, density=1.0)
    with pytest.raises(ValueError, match="temperatures"):
        fem.Solver(problem(x, elements, held(8, (number[0], "xyz")), temperatures=given, modes=2))
    timed = group("hex8", "solid", nodes, LAW, expansion=ALPHA, birth=np.full(1, 0.5))
    with pytest.raises(ValueError, match="born"):
        fem.Solver(problem(x, timed, held(8, (number[0], "xyz")), temperatures=given))


def _shells(kind: str) -> tuple[Any, Any]:
    """A distorted plate of 2 x 2 quadrilaterals, or twice as many triangles."""
    if kind == "quad8":
        x, nodes, _ = eight(2, 2, lambda r, s: plane(np.stack([2.0 * r, s], -1)))
        return x, nodes
    x, nodes, number = quads(2, 2, lambda r, s: plane(np.stack([2.0 * r, s], -1)))
    x[number[1, 1], :2] += (0.2, -0.1)
    return x, nodes if kind == "quad4" else np.concatenate([nodes[:, [0, 1, 2]], nodes[:, [0, 2, 3]]])


@pytest.mark.parametrize("kind", ["tri3", "quad4", "quad8"])
def test_a_plate_grows_or_is_pressed(kind: str) -> None:
    """Free: no stress. Its edges held: -E alpha dT/(1 - nu) along both directions, on both faces."""
    x, nodes = _shells(kind)
    thick = np.full(len(nodes), 0.1)
    left, below = np.flatnonzero(x[:, 0] == 0.0), np.flatnonzero(x[:, 1] == 0.0)
    free = _warm(x, nodes, held(len(x), (left, "xb"), (below, "ya"), (slice(None), "z")), 50.0, kind=kind,
                 family="shell", thickness=thick)  # fmt: skip
    np.testing.assert_allclose(free.shape.u[: len(x), :2], ALPHA * 50.0 * x[:, :2], atol=1e-9 * ALPHA * 50.0)
    assert np.abs(free.assembly.groups[0].output()["stress_top"]).max() < 1e-9 * E
    edge = (x[:, 0] % 2.0 == 0.0) | (x[:, 1] % 1.0 == 0.0)
    walled = _warm(x, nodes, held(len(x), (edge, "xyzabc")), 50.0, kind=kind, family="shell", thickness=thick, steps=2)
    wanted = -E * ALPHA * 50.0 / (1.0 - NU)
    for face in ("stress_bottom", "stress_top"):
        np.testing.assert_allclose(walled.assembly.groups[0].output()[face][:, :2], wanted, rtol=1e-9)


@pytest.mark.parametrize("family", ["truss", "beam"])
def test_a_bar_between_walls(family: str) -> None:
    """Cold to one side of its middle, so that it grows by the mean: -E alpha dT. Free at an end: no stress."""
    x = np.array([[0.0, 0, 0], [1.0, 2.0, 2.0], [2.0, 4.0, 4.0]])
    nodes = np.array([[0, 1], [1, 2]])
    section = {"area": 2.0, "iyy": 1.0, "izz": 1.0, "j": 1.0}
    more = {"kind": "line2", "family": family, "section": section, "reference": 10.0}
    ends = [0, 2] if family == "beam" else [0, 1, 2]
    walled = _warm(x, nodes, held(3, (ends, "xyzabc")), [10.0, 60.0, 10.0], steps=2, **more)
    np.testing.assert_allclose(walled.assembly.groups[0].output()["stress"][:, 0], -E * ALPHA * 25.0, rtol=1e-9)
    free = _warm(x[:2] * [1, 0, 0], nodes[:1], held(2, ([0], "xyzabc"), ([1], "yz")), 60.0, steps=2, **more)
    np.testing.assert_allclose(free.shape.u[1, 0], ALPHA * 50.0, rtol=1e-9)
    assert abs(free.assembly.groups[0].output()["stress"]).max() < 1e-9 * E
    assert max(s.energy_report()["balance_error"] for s in (walled, free)) < 1e-6


@pytest.mark.parametrize("more", [{}, {"modes": 12}], ids=str)
def test_a_linear_structure_is_factored_once(more: dict[str, Any]) -> None:
    """Two metals on each other, warmed in ten steps: what one step gives, and the bow of Timoshenko's bimetal."""
    x, nodes, number = bricks(24, 1, 4, (12.0, 0.5, 1.0))
    low = np.flatnonzero(x[nodes].mean(axis=1)[:, 2] < 0.5)
    high = np.setdiff1d(np.arange(len(nodes)), low)
    law = Elastic.from_engineering(E, 0.0)
    parts = tuple(group("hex8", "solid", nodes[rows], law, expansion=growth, **more)
                  for rows, growth in ((low, ALPHA), (high, 3.0 * ALPHA)))  # fmt: skip
    fixed = held(len(x), (number[0], "x"), (number[:, 0], "y"), (number[0, :, 0], "z"))
    warm = fem.Temperature(np.arange(len(x)), np.full(len(x), 50.0), 0)
    found = []
    for steps in (1, 10):
        solver, _ = solve(problem(x, parts, fixed, temperatures=(warm,), curves=(ramp(),), steps=((steps, 1 / steps),)))
        assert solver.assembly.system.factorisations == 1
        found.append(solver.shape.u)
    np.testing.assert_allclose(found[1], found[0], atol=1e-9 * np.abs(found[0]).max())
    if more:  # plain bricks lock in bending
        bow = 1.5 * 2.0 * ALPHA * 50.0 / 1.0  # 24 (a2 - a1) dT/(16 h), equal moduli and thicknesses
        assert found[0][number[-1, 0, 2], 2] == pytest.approx(-0.5 * bow * 12.0**2, rel=5e-3)


# NAFEMS LE11: a sphere's zone, a cone and a cylinder, a quarter; T = sqrt(x^2 + y^2) + z, held along z at both ends


def _profile(s: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Radius and height of the wall; s: 0 .. 4 along it, t: 0 inside, 1 outside."""
    half = np.pi / 180.0

    def arc(radius: float, degrees: float) -> tuple[np.ndarray, np.ndarray]:
        return radius * np.cos(half * degrees * s), radius * np.sin(half * degrees * s)

    steps = np.array([1.0, 2.0, 3.0, 4.0])
    height = np.interp(s, steps[1:], [np.sin(45 * half), 0.5 * (np.sin(45 * half) + 1.79), 1.79])
    inside = np.where(s <= 2.0, arc(1.0, 22.5), (np.full_like(s, np.cos(45 * half)), height))
    radius = np.interp(s, steps, [1.4 * np.cos(30 * half), 1.1062, 1.0, 1.0])
    line = radius, np.interp(s, steps, [0.7, 1.045, 1.39, 1.79])
    outside = np.where(s <= 1.0, arc(1.4, 30.0), line)
    r, z = inside + t * (outside - inside)
    return r, z


def _le11(kind: str, n: int, **more: Any) -> float:
    """sigma_zz [MPa] on the circle through A, inside at z = 0: the mean along it, of stresses averaged at nodes.

    n: elements through the wall, twice as many along the sphere's first zone, 3 n around.
    """
    step = 2 if kind == "hex20" else 1
    s = np.concatenate([np.linspace(0, 1, 2 * n * step, endpoint=False), np.linspace(1, 4, 3 * n * step + 1)])
    t, angle = np.linspace(0, 1, n * step + 1), np.linspace(0, np.pi / 2, 3 * n * step + 1)
    number = np.arange(len(t) * len(angle) * len(s)).reshape(len(t), len(angle), len(s))
    t0, angle0, s0 = np.meshgrid(t, angle, s, indexing="ij")
    r, z = _profile(s0.ravel(), t0.ravel())
    x = np.column_stack([r * np.cos(angle0.ravel()), r * np.sin(angle0.ravel()), z])
    low, high, middle = slice(None, -1, step), slice(step, None, step), slice(step // 2, None, step)
    at = {-1: low, 1: high, 0: middle}
    nodes = np.stack([number[at[int(a)], at[int(b)], at[int(c)]] for a, b, c in shapes.NODES[kind]], -1)
    nodes = nodes.reshape(-1, nodes.shape[-1])
    loose = np.setdiff1d(number, nodes)
    fixed = held(len(x), (number[:, 0], "y"), (number[:, -1], "x"), (number[:, :, [0, -1]], "z"), (loose, "xyz"))
    warm = fem.Temperature(np.arange(len(x)), np.hypot(x[:, 0], x[:, 1]) + x[:, 2], 0)
    elements = group(kind, "solid", nodes, Elastic.from_engineering(210e3, 0.3), expansion=2.3e-4, **more)
    solver, _ = solve(problem(x, elements, fixed, temperatures=(warm,), curves=(ramp(),)))
    assert solver.energy_report()["balance_error"] < 1e-6
    stress = solver.frame().nodes["stress"]
    return float(stress[number[0, ::step, 0], 2].mean())


LE11 = {
    ("hex20", 1): -93.718, ("hex20", 2): -100.044, ("hex20", 4): -102.741,
    ("hex8", 2): -98.794, ("hex8", 4): -102.299, ("hex8", 8): -104.031,
}  # fmt: skip


@pytest.mark.parametrize(("kind", "n"), LE11)
def test_le11(kind: str, n: int) -> None:
    """-105 MPa, which finer meshes come to from above."""
    more = {"modes": 12} if kind == "hex8" else {}
    assert _le11(kind, n, **more) == pytest.approx(LE11[kind, n], rel=1e-3)
