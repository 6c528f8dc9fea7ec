"""Plastic flow in elements: Newton's rate, closed forms of plates, cylinders and footings, another program's beam."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fem_meshes import bricks, group, held, loaded, moved, plane, problem, quads, ramp, shell, solve

from zrno.solvers import fem
from zrno.solvers import materials as laws
from zrno.solvers.errors import Diverged
from zrno.solvers.fem.assembly import Assembly
from zrno.solvers.fem.elements import shapes
from zrno.solvers.fem.equilibrium import Target, equilibrium
from zrno.solvers.fem.shape import Shape
from zrno.solvers.materials.drucker_prager import cone


def _motion(nodes: Any, dof: int, value: float) -> fem.Motion:
    nodes = np.atleast_1d(nodes).ravel()
    return fem.Motion(nodes, np.full(len(nodes), dof), np.full(len(nodes), value), 0)


SAND = laws.cap(66.7, 40.0, 0.25, gamma=0.18, decay=0.67, ratio=2.5, hardening=laws.CapHardening(0.066, 0.67, 0.189))
FLOWING = {
    "von Mises": (laws.von_mises(210.0, 0.3, 0.25, 2.0, 0.5), (-0.02, 0.01)),
    "Drucker-Prager": (laws.drucker_prager_soil(100.0, 0.3, 0.5, 25.0, 5.0), (-0.03, 0.015)),
    "cap": (SAND, (-0.02, 0.01)),
}


@pytest.mark.parametrize("name", FLOWING)
def test_newtons_method_is_quadratic(name: str) -> None:
    """A block pressed and sheared at its top in one step, so that most of it flows: digits double in each iteration,
    the slope of log r(k + 1) over log r(k) is about 2."""
    law, (press, shear) = FLOWING[name]
    x, nodes, number = bricks(3, 2, 2)
    top = number[-1].ravel()
    motions = tuple(_motion(top, dof, 1.0) for dof in (0, 1, 2))
    p = problem(x, group("hex8", "solid", nodes, law), held(len(x), (number[0], "xyz")), motions=motions)
    change = np.zeros((len(x), 6))
    change[top, :2] = press, shear
    how = fem.Iteration("newton", force=1e-13, most=30)
    a = Assembly(p)
    start = Shape(np.zeros((len(x), 6)))
    _, _, trace = equilibrium(a, start, Target(change, lambda s: np.zeros((len(x), 6))), 1.0, how)
    assert (a.groups[0]._history[0] > 0.0).mean() > 0.5  # type: ignore[attr-defined]
    steps = np.diff(np.log(trace.residuals))
    orders = steps[1:] / steps[:-1]
    assert orders[-2:].max() > 1.7  # the last one may end in round-off
    assert a.structure.symmetric == (name == "von Mises")


# plates and shells


@pytest.mark.parametrize(("layers", "most"), [(5, 0.06), (10, 0.01), (20, 0.005)])
def test_plastic_moment_of_a_plate(layers: int, most: float) -> None:
    """A strip bent to 30 times its elastic curvature: M = M_p (1 - 1/3 (1/30)^2) of M_p = sy h^2/4 a unit of width.

    Gauss's points through the thickness miss the jump at its middle by as much as `most`.
    """
    h, length, young, sy = 2.0, 10.0, 2.1e5, 250.0
    x, nodes, number = quads(2, 1, lambda r, s: np.stack([length * r, s, 0 * r], -1))
    fixed = held(len(x), (number[0], "xzb"), (number[:, 0], "y"))
    angle = 30.0 * 2.0 * sy / (young * h) * length
    motion = _motion(number[-1], 4, angle)
    elements = shell(nodes, h, laws.von_mises(young, 0.0, sy), layers=layers)
    solver, _ = solve(problem(x, elements, fixed, motions=(motion,), curves=(ramp(),), steps=((30, 1.0 / 30.0),)))
    moment = float(solver.reaction[number[-1], 4].sum())
    wanted = sy * h**2 / 4.0 * (1.0 - 1.0 / (3.0 * 30.0**2))
    assert moment == pytest.approx(wanted, rel=most)
    assert solver.energy_report()["balance_error"] < 1e-6


@pytest.mark.parametrize("ratio", [-1.0, 0.0, 0.5, 1.0, 2.0])
def test_the_yield_locus_of_plane_stress(ratio: float) -> None:
    """s1^2 - s1 s2 + s2^2 = sy^2 where stresses grow together, and no stress across."""
    x, nodes, number = quads(1, 1, lambda r, s: np.stack([r, s, 0 * r], -1))
    law = laws.von_mises(2.1e5, 0.3, 250.0, 1.0)
    elements = group("quad4", "plane", nodes, law, plane="stress", thickness=np.ones(1))
    pull = tuple(
        loaded(number[-1] if dof == 0 else number[:, -1], dof, value, 0) for dof, value in enumerate((1.0, ratio))
    )
    yields = 250.0 / math.sqrt(1.0 - ratio + ratio**2)
    curve = fem.Curve(np.array([0.0, 1.0, 2.0]), yields * np.array([0.0, 1.0 - 1e-9, 1.0 + 1e-5]))
    p = problem(x, elements, held(len(x), (number[0], "x"), (number[:, 0], "y")), nodal_loads=pull, curves=(curve,),
                steps=((2, 1.0),))  # fmt: skip
    solver, seen = solve(p, lambda s: s.assembly.groups[0].history[0].max())
    assert seen[0] == 0.0
    assert seen[1] > 0.0
    stress = solver.assembly.groups[0].stress  # type: ignore[attr-defined]
    np.testing.assert_allclose(stress[:, 0], yields, rtol=2e-5)
    np.testing.assert_allclose(stress[:, 2], 0.0, atol=1e-9)


@pytest.mark.parametrize("step", [0.001, 0.3])
def test_a_cone_stretched_in_its_plane(step: float) -> None:
    """s (1/sqrt(3) + 2 alpha) = k; also by a step whose first guess lies on the apex, which resists nothing."""
    x, nodes, number = quads(1, 1, lambda r, s: np.stack([r, s, 0 * r], -1))
    law = laws.drucker_prager(100.0, 0.3, 1.0, 0.3)
    elements = group("quad4", "plane", nodes, law, plane="stress", thickness=np.ones(1))
    pull = tuple(_motion(number[-1] if dof == 0 else number[:, -1], dof, 10.0 * step) for dof in (0, 1))
    p = problem(x, elements, held(len(x), (number[0], "x"), (number[:, 0], "y")), motions=pull, curves=(ramp(),),
                steps=((10, 0.1),))  # fmt: skip
    solver, _ = solve(p)
    stress = solver.assembly.groups[0].stress  # type: ignore[attr-defined]
    limit = 1.0 / (1.0 / math.sqrt(3.0) + 0.6)
    np.testing.assert_allclose(stress, np.tile([limit, limit, 0.0, 0.0, 0.0, 0.0], (len(stress), 1)), atol=1e-9)


# thick cylinder

BORE, OUTSIDE, STRENGTH = 100.0, 200.0, 240.0


def _ring(radial: int, along: int, **more: Any) -> tuple[dict[str, Any], fem.FaceLoad, int]:
    """A quarter of Hill's cylinder in plane strain: problem's parts, unit pressure, a node outside."""

    def place(r: np.ndarray, s: np.ndarray) -> np.ndarray:
        radius, angle = BORE + (OUTSIDE - BORE) * r, 0.5 * np.pi * s
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * r], -1)

    x, nodes, number = quads(radial, along, place)
    edges = np.stack([number[0, 1:], number[0, :-1]], axis=-1)
    pressure = fem.FaceLoad("line2", edges, np.ones(edges.shape), curve=0, thickness=np.ones(along), plane="strain")
    elements = group("quad4", "plane", nodes, laws.von_mises(2.1e5, 0.3, STRENGTH), plane="strain", **more)
    parts = {"x": x, "elements": elements, "fixed": held(len(x), (number[:, 0], "y"), (number[:, -1], "x"))}
    return parts, pressure, int(number[-1, 0])


@pytest.mark.parametrize("how", [{"mean": True}, {"modes": 4}], ids=["mean dilatation", "enhanced"])
def test_a_thick_cylinder_yields_from_the_bore(how: dict[str, Any], shared: Path) -> None:
    """Hill's displacements to 0.6 % up to 94 % of the limit pressure. Beyond it they grow by the inverse of what is
    left of it, and his stress along the axis is not von Mises's."""
    rows = np.genfromtxt(shared / "reference/fem/thick_cylinder_plastic.csv", delimiter=",", skip_header=2)
    rows = rows[rows[:, 0] <= 180.0]
    parts, pressure, outside = _ring(20, 12, **how)
    curve = fem.Curve(np.arange(len(rows) + 1.0), np.concatenate([[0.0], rows[:, 0]]))
    p = problem(**parts, face_loads=(pressure,), curves=(curve,), steps=((len(rows), 1.0),))
    _, seen = solve(p, lambda s: moved(s, outside, 0))
    np.testing.assert_allclose(seen, rows[:, 2], rtol=6e-3)


def test_a_thick_cylinder_has_a_limit() -> None:
    """2 sy/sqrt(3) ln(b/a), by displacement control."""
    parts, pressure, outside = _ring(20, 12, mean=True)
    pressure = dataclasses.replace(pressure, curve=None, values=100.0 * pressure.values)
    p = problem(**parts, face_loads=(pressure,), steps=((25, 1.0),), path=fem.Path(outside, 0, 0.03, True))
    _, seen = solve(p, lambda s: s.procedure.factor * 100.0)  # type: ignore[attr-defined]
    limit = 2.0 * STRENGTH / math.sqrt(3.0) * math.log(OUTSIDE / BORE)
    assert seen[-1] == pytest.approx(limit, rel=0.01)
    assert seen[-1] == pytest.approx(seen[-5], rel=1e-4)


@pytest.mark.parametrize("rate", [0.1, 1.0])
def test_one_element_with_overstress(rate: float) -> None:
    """Pulled at a steady rate: s = sy + sy rate/gamma (1 - exp(-E gamma t/sy)), t from where it yields; first order."""
    young, sy, gamma, end = 2.1e5, 250.0, 2.0, 0.004
    x, nodes, number = bricks(1, 1, 1)
    m = 400
    p = problem(x, group("hex8", "solid", nodes, laws.perzyna_yield(young, 0.3, sy, gamma)),
                held(len(x), (number[0], "x"), (number[:, 0], "y"), (number[:, :, 0], "z")),
                motions=(_motion(number[-1], 0, rate),), curves=(ramp(),),
                steps=((m, end / rate / m),))  # fmt: skip
    _, seen = solve(p, lambda s: s.assembly.groups[0].stress[0, 0])
    past = end / rate * np.arange(1, m + 1) / m - sy / (young * rate)
    exact = sy + sy * rate / gamma * (1.0 - np.exp(-young * gamma / sy * np.maximum(past, 0.0)))
    wanted = np.where(past > 0.0, exact, sy + young * rate * past)
    np.testing.assert_allclose(seen, wanted, rtol=5e-3)


# a beam that another program computed, and footings


def _krieg_and_key(stress: np.ndarray, increment: np.ndarray, shear: float, bulk: float, limit: float) -> np.ndarray:
    """Exact stress (3, 3) of a perfectly plastic von Mises law after a straight increment of strain (Krieg & Key 1976):
    elastic to the yield surface, then the angle psi of stress and strain closes, tan(psi / 2) by exp(-2 G |e| / R).
    """
    one = np.eye(3)
    mean = np.trace(stress) / 3 + bulk * np.trace(increment)
    s, e = stress - np.trace(stress) / 3 * one, increment - np.trace(increment) / 3 * one
    radius, size = math.sqrt(2 / 3) * limit, float(np.linalg.norm(e))
    trial = s + 2 * shear * e
    if np.linalg.norm(trial) <= radius:
        return trial + mean * one
    along, square = 2 * shear * float((s * e).sum()), (2 * shear * size) ** 2
    rest = float((s * s).sum()) - radius**2
    share = (-along + math.sqrt(max(along**2 - square * rest, 0.0))) / square  # to the yield surface
    s = s + share * 2 * shear * e
    n = e / size
    psi = math.acos(min(max(float((s * n).sum()) / radius, -1.0), 1.0))
    across = s - float((s * n).sum()) * n
    later = 2 * math.atan(math.tan(psi / 2) * math.exp(-2 * shear * (1 - share) * size / radius))
    length = float(np.linalg.norm(across))
    side = across / length if length > 1e-12 * radius else np.zeros((3, 3))
    return radius * (math.cos(later) * n + math.sin(later) * side) + mean * one


@pytest.mark.parametrize(("parts", "error"), [(1, 0.4898), (10, 0.0762), (100, 0.00805)])
def test_nafems_path_in_plane_strain(parts: int, error: float) -> None:
    """NL1: E 250e3, nu 0.25, yield 5; eight steps of 2.5e-5 along x, x, y, y and back, by one element.

    The worst stress against the exact one: of the first order in the step, as a return along the normal is.
    """
    law = laws.von_mises(250e3, 0.25, 5.0)
    x, nodes, _ = quads(1, 1, lambda r, s: np.stack([r, s, 0 * r], -1))
    path = np.array([(1, 0), (1, 0), (0, 1), (0, 1), (-1, 0), (-1, 0), (0, -1), (0, -1)])
    along = 2.5e-5 * np.concatenate([[(0, 0)], np.cumsum(path, axis=0)])
    curves = tuple(fem.Curve(np.arange(9.0), along[:, k].copy()) for k in (0, 1))
    motions = tuple(fem.Motion(np.arange(4), np.full(4, k), x[:, k].copy(), k) for k in (0, 1))
    elements = group("quad4", "plane", nodes, law, plane="strain")
    p = problem(x, elements, held(4, (slice(None), "z")), curves=curves, motions=motions,
                steps=((8 * parts, 1.0 / parts),))  # fmt: skip
    solver, seen = solve(p, lambda s: s.assembly.groups[0].stress[0].copy())  # type: ignore[attr-defined]
    exact, shear, bulk = np.zeros((3, 3)), 100e3, 250e3 / 1.5
    worst = 0.0
    for k, step in enumerate(path):
        exact = _krieg_and_key(exact, np.diag([2.5e-5 * step[0], 2.5e-5 * step[1], 0.0]), shear, bulk, 5.0)
        worst = max(worst, float(np.abs(seen[(k + 1) * parts - 1][:3] - np.diag(exact)).max()))
    assert worst == pytest.approx(error, rel=0.02)
    assert solver.energy_report()["balance_error"] < 0.05


@pytest.mark.slow
def test_a_cantilever_flows_as_other_programs_say() -> None:
    """60 x 12 x 12 bricks: 794.4912 by CalculiX and felupe (reference/fem/material_point.csv, EP1)."""
    x, nodes, number = bricks(60, 12, 12, (100.0, 10.0, 10.0))
    law = laws.von_mises(2.1e5, 0.3, 250.0, 2.1e5 * 2000.0 / 2.12e5)
    p = problem(x, group("hex8", "solid", nodes, law), held(len(x), (number[0], "xyz")),
                motions=(_motion(number[-1], 2, -6.0),), curves=(ramp(),), steps=((10, 0.1),))  # fmt: skip
    solver, _ = solve(p)
    assert solver.reaction[number[0].ravel(), 2].sum() == pytest.approx(794.4912, rel=1e-6)
    assert solver.energy_report()["balance_error"] < 1e-6


def _footing(kind: str, law: Any, inside: int, outside: int, down: int, push: float, **more: Any) -> list[float]:
    """Loads over width of a smooth rigid strip (half-width 1, half of it) on 5 x 5, pushed in by 30 steps.

    Elements grow by a quarter from the strip's edge on to all sides: the edge is where it is decided.
    """

    def graded(n: int) -> np.ndarray:
        widths = 1.25 ** np.arange(n)
        return np.concatenate([[0.0], np.cumsum(widths)]) / widths.sum()

    across = np.concatenate([1.0 - graded(inside)[::-1], 1.0 + 4.0 * graded(outside)[1:]])
    depth = -5.0 * graded(down)[::-1]
    step = 1 if kind == "quad4" else 2
    if step == 2:
        across, depth = (np.interp(np.arange(2 * len(v) - 1) / 2.0, np.arange(len(v)), v) for v in (across, depth))
    x0, y0 = np.meshgrid(across, depth, indexing="ij")
    x, number = plane(np.stack([x0.ravel(), y0.ravel()], -1)), np.arange(x0.size).reshape(x0.shape)
    low, high, middle = slice(None, -1, step), slice(step, None, step), slice(step // 2, None, step)
    at = {-1: low, 1: high, 0: middle}
    nodes = np.stack([number[at[int(a)], at[int(b)]] for a, b in shapes.NODES[kind]], -1)
    nodes = nodes.reshape(-1, nodes.shape[-1])
    loose = np.setdiff1d(number, nodes)
    top = number[across <= 1.0 + 1e-9, -1]
    fixed = held(len(x), (number[0], "x"), (number[-1], "x"), (number[:, 0], "xy"), (loose, "xy"))
    p = problem(x, group(kind, "plane", nodes, law, plane="strain", **more), fixed, motions=(_motion(top, 1, -push),),
                curves=(ramp(),), steps=((30, 1.0 / 30.0),), iteration=fem.Iteration(most=25))  # fmt: skip
    _, seen = solve(p, lambda s: -float(s.reaction[top, 1].sum()))
    return seen


E_SOIL = 1e4
FOOTINGS: dict[str, tuple[float, Any]] = {
    "cone 0": (0.0, laws.drucker_prager(E_SOIL, 0.3, *cone(1.0, 0.0, "plane_strain"))),
    "hexagon 0": (0.0, laws.mohr_coulomb(E_SOIL, 0.3, 1.0, 0.0)),
    "cone 20": (20.0, laws.drucker_prager(E_SOIL, 0.3, *cone(1.0, 20.0, "plane_strain"))),
    "hexagon 20": (20.0, laws.mohr_coulomb(E_SOIL, 0.3, 1.0, 20.0, 20.0)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FOOTINGS)
def test_prandtls_collapse(name: str, shared: Path) -> None:
    """180 eight-node elements of 2 x 2 points: within 3 % of c Nc, from above."""
    phi, law = FOOTINGS[name]
    table = np.genfromtxt(shared / "reference/fem/bearing_capacity_prandtl.csv", delimiter=",", skip_header=2)
    wanted = float(table[table[:, 0] == phi, 1][0])
    load = _footing("quad8", law, 5, 10, 12, 0.02 if phi == 0.0 else 0.1, gauss=(2, 2))
    assert load[-1] == pytest.approx(load[-4], rel=1e-3)  # it flows
    assert wanted < load[-1] < 1.03 * wanted


@pytest.mark.slow
def test_enhanced_strains_without_stiffness_say_so() -> None:
    """Where whole elements flow without hardening enhanced strains carry nothing: the run stops and says what does."""
    with pytest.raises(Diverged, match=r"enhanced strains have no stiffness left.*fem\.dilatation mean"):
        _footing("quad4", laws.von_mises(E_SOIL, 0.48, math.sqrt(3.0)), 4, 9, 11, 0.02, modes=4)


@pytest.mark.slow
def test_which_elements_lock_under_a_footing() -> None:
    """Mean dilatation frees flow without a change of volume; plain elements and flow that dilates stay locked."""
    mean = _footing("quad4", FOOTINGS["cone 0"][1], 6, 14, 16, 0.02, mean=True)
    assert 5.1416 < mean[-1] < 1.03 * 5.1416
    plain = _footing("quad4", FOOTINGS["cone 0"][1], 6, 14, 16, 0.02)
    assert plain[-1] > 1.15 * 5.1416
