"""Meshes and materials that break solvers: either the answer is right, or the run says why there is none.

Others of the kind stand where they belong: nu 0.4999 with continua, collapse loads with plasticity, thickness 1e-4 and
snap-through with shells, mechanisms with structures.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from fem_meshes import bricks, eight, group, held, line_load, loaded, moved, nine, problem, quads, shell, solve

from zrno.solvers import fem
from zrno.solvers.errors import Diverged
from zrno.solvers.fem import linear
from zrno.solvers.materials import Elastic, von_mises

LENGTH = 10.0
LAW = Elastic.from_engineering(1000.0, 0.3)
BEAM = LENGTH**3 / (3 * 1000 / 12) + LENGTH / (5 / 6 * 1000 / 2.6)  # Timoshenko's, under a unit force at its tip


def _skewed(p: np.ndarray) -> np.ndarray:
    """A beam whose inner elements lean by up to 70 degrees; its ends stay straight."""
    out = p.copy()
    out[:, 0] += math.tan(math.radians(70)) * (p[:, 1] - 0.5) * np.sin(np.pi * p[:, 0] / LENGTH)
    return out


@pytest.mark.parametrize(
    ("kind", "family", "modes", "cuts", "share"),
    [("quad4", "plane", 4, (20, 2), 1.002), ("quad8", "plane", 0, (20, 2), 0.990),
     ("quad9", "plane", 0, (20, 2), 0.990), ("quad4", "shell", 4, (20, 2), 1.002),
     ("quad9", "shell", 0, (20, 2), 0.955), ("quad9", "shell", 0, (40, 4), 0.993),
     ("quad4", "plane", 0, (20, 2), 0.321)],
)  # fmt: skip
def test_elements_that_lean_by_70_degrees(
    kind: str, family: str, modes: int, cuts: tuple[int, int], share: float
) -> None:
    """Bent in their plane. The last one is known: plain four-node elements lock, enhanced ones do not."""
    mesh: Any = {"quad4": quads, "quad8": eight, "quad9": nine}[kind]
    x, nodes, number = mesh(*cuts, lambda r, s: _skewed(np.stack([LENGTH * r, s, 0 * r], -1)))
    if family == "plane":
        elements = group(kind, "plane", nodes, LAW, plane="stress", modes=modes)
    else:
        elements = shell(nodes, 1.0, LAW, modes=modes)
    fixed = held(len(x), (number[0][number[0] >= 0], "xyzabc"))
    pull = loaded(number[-1], 1, 1.0) if kind == "quad4" else line_load(number[-1], 1, 1.0)
    solver, _ = solve(problem(x, elements, fixed, nodal_loads=(pull,)))
    tip = moved(solver, number[-1, number.shape[1] // 2], 1)
    assert tip / BEAM == pytest.approx(share, abs=0.004)


def test_bricks_that_lean_by_70_degrees() -> None:
    """Enhanced; a clamped end that cannot contract is a little stiffer than a beam's."""
    x, nodes, number = bricks(20, 2, 1, (LENGTH, 1.0, 1.0))
    elements = group("hex8", "solid", nodes, LAW, modes=12)
    p = problem(_skewed(x), elements, held(len(x), (number[0], "xyz")), nodal_loads=(loaded(number[-1], 1, 1.0),))
    solver, _ = solve(p)
    assert np.mean([moved(solver, n, 1) for n in number[-1].ravel()]) / BEAM == pytest.approx(0.995, abs=0.003)


@pytest.mark.parametrize("kind", ["quad4", "quad9"])
def test_shells_a_thousand_times_as_long_as_wide(kind: str) -> None:
    """One element along a unit square and 1000 (500) across it, bent by a moment."""
    mesh: Any = {"quad4": quads, "quad9": nine}[kind]
    x, nodes, number = mesh(1, 1000 if kind == "quad4" else 500, lambda r, s: np.stack([r, s, 0 * r], -1))
    share = np.full(1001, 1e-3)
    share[[0, -1]] /= 2
    moment = line_load(number[-1], 4, -1.0) if kind == "quad9" else fem.NodalLoad(number[-1], np.full(1001, 4), -share)
    elements = shell(nodes, 0.01, Elastic.from_engineering(1e7, 0.0))
    solver, _ = solve(problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(moment,)))
    assert moved(solver, number[-1, 500], 2) == pytest.approx(1.0 / (2 * 1e7 * 1e-6 / 12), rel=1e-5)


def _thin_bricks(aspect: float) -> float:
    """A strip of ten flat enhanced bricks under a force at its tip, over the beam's deflection."""
    x, nodes, number = bricks(10, 1, 1, (10.0, 1.0, 1.0 / aspect))
    elements = group("hex8", "solid", nodes, Elastic.from_engineering(1e7, 0.0), modes=12)
    p = problem(x, elements, held(len(x), (number[0], "xyz")), nodal_loads=(loaded(number[-1], 2, 1e-6),))
    solver, _ = solve(p)
    return moved(solver, number[-1, 0, 0], 2) / (1e-6 * 10.0**3 / (3 * 1e7 / (12 * aspect**3)))


def test_flat_bricks_bend_or_the_run_says_that_digits_run_out() -> None:
    """Ten times 1 x 1 x 1/100: right. Of 1/1000 the stiffnesses across and in bending lie 1e16 apart: an error."""
    assert _thin_bricks(100.0) == pytest.approx(0.9975, abs=1e-3)
    with pytest.raises(Diverged, match=r"run out of digits .* at node \d+ along u"):
        _thin_bricks(1000.0)


@pytest.mark.parametrize("method", ["pardiso", "scipy", "multigrid"])
@pytest.mark.parametrize("below", [1e6, 1.0])
def test_soft_on_stiff(below: float, method: str) -> None:
    """A column of two halves whose moduli are 1e6 apart, either way round, under pressure: each half's own strain."""
    if method not in linear.installed():
        pytest.skip(f"the linear solver {method} is not installed")
    above = 1e6 / below
    x, nodes, number = bricks(3, 3, 8)
    halves = nodes.reshape(9, 8, 8)[:, :4].reshape(-1, 8), nodes.reshape(9, 8, 8)[:, 4:].reshape(-1, 8)
    parts = tuple(
        group("hex8", "solid", half, Elastic.from_engineering(young, 0.0))
        for half, young in zip(halves, (below, above), strict=True)
    )
    top = number[:, :, -1]
    faces = np.stack([top[:-1, :-1], top[1:, :-1], top[1:, 1:], top[:-1, 1:]], -1).reshape(-1, 4)
    press = fem.FaceLoad("quad4", faces, np.ones(faces.shape))
    solver, _ = solve(problem(x, parts, held(len(x), (number[:, :, 0], "xyz")), face_loads=(press,), solver=method))
    assert moved(solver, top[1, 1], 2) == pytest.approx(-0.5 / below - 0.5 / above, rel=1e-7)
    assert moved(solver, number[1, 1, 4], 2) == pytest.approx(-0.5 / below, rel=1e-7)


def test_more_than_a_collapse_load_is_an_error_with_its_place() -> None:
    """A perfectly plastic bar, yield 5 and area 2, pulled to 12: at 10 it flows, and nothing balances more."""
    x = np.array([[0.0, 0, 0], [10.0, 0, 0]])
    bar = group("line2", "truss", np.array([[0, 1]]), von_mises(1000.0, 0.3, 5.0), section={"area": 2.0})
    ramp = fem.Curve(np.array([0.0, 12.0]), np.array([0.0, 12.0]))
    p = problem(x, bar, held(2, ([0], "xyz"), ([1], "yz")), nodal_loads=(loaded(1, 0, 1.0, 0),), curves=(ramp,),
                steps=((4, 3.0),))  # fmt: skip
    solver = fem.Solver(p)
    for _ in range(3):
        solver.advance(np.inf, 1)
    assert moved(solver, 1, 0) == pytest.approx(9.0 * 10.0 / (1000.0 * 2.0))
    with pytest.raises(Diverged, match="at node 2 along ux"):
        solver.advance(np.inf, 1)
    assert solver.time == 9.0
