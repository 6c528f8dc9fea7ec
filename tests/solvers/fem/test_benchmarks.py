"""Published linear benchmarks of solids, plane problems and plates (MacNeal & Harder 1985, NAFEMS, Timoshenko)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fem_meshes import bricks, eight, group, held, loaded, moved, problem, quads, shell, solve

from zrno.solvers import fem
from zrno.solvers.fem import output
from zrno.solvers.materials import Elastic


def _ellipses(r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Between NAFEMS' ellipses 2 x 1 and 3.25 x 2.75: r outwards, s from the x axis to the y axis."""
    angle = 0.5 * np.pi * s
    inner = np.stack([2.0 * np.cos(angle), 1.0 * np.sin(angle)], -1)
    outer = np.stack([3.25 * np.cos(angle), 2.75 * np.sin(angle)], -1)
    flat = inner + r[:, None] * (outer - inner)
    return np.column_stack([flat, np.zeros(len(r))])


@pytest.mark.parametrize(("n", "modes", "within"), [(16, 4, 0.005), (32, 4, 0.002)])
def test_cooks_membrane(n: int, modes: int, within: float) -> None:
    x, nodes, number = quads(n, n, lambda r, s: np.stack([48 * r, 44 * r + s * (44 - 28 * r), 0 * r], -1))
    elements = group("quad4", "plane", nodes, Elastic.from_engineering(1.0, 1 / 3), plane="stress", modes=modes)
    shear = np.full(n + 1, 1.0 / n)
    shear[[0, -1]] /= 2
    load = fem.NodalLoad(number[-1], np.full(n + 1, 1), shear)
    solver, _ = solve(problem(x, elements, held(len(x), (number[0], "xy")), nodal_loads=(load,)))
    assert moved(solver, number[-1, n // 2], 1) == pytest.approx(23.9642, rel=within)


def test_le1_an_elliptic_membrane() -> None:
    """sigma_yy at D (2, 0): 92.7 MPa."""
    x, nodes, number = eight(8, 12, _ellipses)
    edge = number[-1]
    edges = np.stack([edge[:-1:2], edge[2::2], edge[1::2]], axis=-1)  # outwards from left to right of their way
    pull = fem.FaceLoad("line3", edges, np.full(edges.shape, -10e6), thickness=np.ones(len(edges)))
    elements = group("quad8", "plane", nodes, Elastic.from_engineering(210e9, 0.3), plane="stress")
    fixed = held(len(x), (number[:, 0][number[:, 0] >= 0], "y"), (number[:, -1][number[:, -1] >= 0], "x"))
    solver, _ = solve(problem(x, elements, fixed, face_loads=(pull,)))
    stress = output.frame(solver).nodes["stress"]
    assert stress[number[0, 0], 1] / 1e6 == pytest.approx(92.7, rel=0.02)


def test_le10_a_thick_plate() -> None:
    """sigma_yy at D on the top (2, 0, 0.6): -5.38 MPa, by twenty-node hexahedra."""
    flat, quad, number = eight(6, 8, _ellipses)
    m = 4
    levels = np.linspace(0.0, 0.6, 2 * m + 1)
    count = len(flat)
    corner = np.zeros(count, bool)
    corner[quad[:, :4].ravel()] = True
    x, layer = [], []
    total = 0
    for k, z in enumerate(levels):
        own = np.full(count, -1)
        keep = np.ones(count, bool) if k % 2 == 0 else corner
        own[keep] = total + np.arange(keep.sum())
        total += int(keep.sum())
        layer.append(own)
        x.append(np.column_stack([flat[keep, :2], np.full(keep.sum(), z)]))
    x = np.concatenate(x)
    nodes = np.concatenate([
        np.column_stack([layer[k][quad[:, :4]], layer[k + 2][quad[:, :4]], layer[k][quad[:, 4:]],
                         layer[k + 2][quad[:, 4:]], layer[k + 1][quad[:, :4]]])
        for k in range(0, 2 * m, 2)
    ])  # fmt: skip
    top = layer[2 * m][quad]
    press = fem.FaceLoad("quad8", top, np.full(top.shape, 1e6))
    elements = group("hex20", "solid", nodes, Elastic.from_engineering(210e9, 0.3), gauss=(2, 2, 2))
    outer = number[-1][number[-1] >= 0]
    every = [level for own in layer for level in own[outer] if level >= 0]
    at_y0 = [level for own in layer for level in own[number[:, 0][number[:, 0] >= 0]] if level >= 0]
    at_x0 = [level for own in layer for level in own[number[:, -1][number[:, -1] >= 0]] if level >= 0]
    middle = layer[m][outer]
    fixed = held(len(x), (every, "xy"), (at_y0, "y"), (at_x0, "x"), (middle, "z"))
    solver, _ = solve(problem(x, elements, fixed, face_loads=(press,)))
    stress = output.frame(solver).nodes["stress"]
    assert stress[layer[2 * m][number[0, 0]], 1] / 1e6 == pytest.approx(-5.38, rel=0.03)


@pytest.mark.parametrize(("axis", "reference"), [(0, 3.0e-5), (1, 0.1081), (2, 0.4321)])
def test_a_straight_cantilever_of_six_bricks(axis: int, reference: float) -> None:
    """MacNeal & Harder's regular mesh: extension, in-plane and out-of-plane shear."""
    x, nodes, number = bricks(6, 1, 1, (6.0, 0.2, 0.1))
    elements = group("hex8", "solid", nodes, Elastic.from_engineering(1e7, 0.3), modes=12)
    held_at = held(len(x), (number[0], "x"), (number[0, :, 0], "z"), (number[0, 0], "y"))
    solver, _ = solve(problem(x, elements, held_at, nodal_loads=(loaded(number[-1], axis, 1.0),)))
    tip = np.mean([moved(solver, node, axis) for node in number[-1].ravel()])
    assert tip == pytest.approx(reference, rel=0.02)


@pytest.mark.parametrize(
    ("clamped", "point", "alpha"),
    [(True, False, 0.00126532), (False, False, 0.004062), (True, True, 0.005612), (False, True, 0.011601)],
)
def test_a_square_plate(clamped: bool, point: bool, alpha: float) -> None:
    """Timoshenko's coefficients of q a^4 / D or P a^2 / D; a quarter of the plate."""
    x, nodes, number = quads(24, 24, lambda r, s: np.stack([0.5 * r, 0.5 * s, 0 * r], -1))
    h, young = 1e-3, 2.1e5
    sides = ((number[-1], "zb" if not clamped else "zab"), (number[:, -1], "za" if not clamped else "zab"))
    fixed = held(len(x), (slice(None), "xyc"), (number[0], "b"), (number[:, 0], "a"),
                 *((where, letters if clamped else "z") for where, letters in sides))  # fmt: skip
    if not clamped:  # the edges do not turn about their normals
        fixed |= held(len(x), (number[-1], "a"), (number[:, -1], "b"))
    elements = shell(nodes, h, Elastic.from_engineering(young, 0.3))
    load: dict[str, object] = (
        {"nodal_loads": (loaded(number[0, 0], 2, -0.25),)} if point
        else {"face_loads": (fem.FaceLoad("quad4", nodes, np.full(nodes.shape, 1.0)),)}
    )  # fmt: skip
    solver, _ = solve(problem(x, elements, fixed, **load))
    stiffness = young * h**3 / (12 * (1 - 0.09))
    assert -moved(solver, number[0, 0], 2) * stiffness == pytest.approx(alpha, rel=0.01)


@pytest.mark.parametrize(("axis", "reference", "within"), [(0, 0.088519, 0.02), (2, 0.498302, 0.04)])
def test_a_curved_beam(axis: int, reference: float, within: float) -> None:
    """MacNeal & Harder's quarter ring 4.12 .. 4.32, thickness 0.1, by shells; sheared at its tip in and out of plane.

    The section is twice as wide as thick: its torsion is at the end of what shells say.
    """
    x, nodes, number = quads(
        24, 2, lambda r, s: np.stack([(4.12 + 0.2 * s) * np.sin(0.5 * np.pi * r), (4.12 + 0.2 * s)
                                      * np.cos(0.5 * np.pi * r), 0 * r], -1)
    )  # fmt: skip
    elements = shell(nodes, 0.1, Elastic.from_engineering(1e7, 0.25), modes=4)
    solver, _ = solve(problem(x, elements, held(len(x), (number[0], "xyzabc")),
                              nodal_loads=(loaded(number[-1], axis, 1.0),)))  # fmt: skip
    assert np.mean([moved(solver, node, axis) for node in number[-1]]) == pytest.approx(reference, rel=within)


def test_the_raasch_hook() -> None:
    """Two arcs, the thick shell twists: 5.02 (Ko et al., as quoted), not Raasch's 4.93."""
    turns = 18, 30

    def place(r: np.ndarray, s: np.ndarray) -> np.ndarray:
        way = r * (14 * math.radians(60) + 46 * math.radians(150))
        first = np.minimum(way / 14, math.radians(60))
        rest = np.maximum(way / 46 - 14 * math.radians(60) / 46, 0.0)
        start = np.stack([14 * np.sin(first), 14 - 14 * np.cos(first)], -1)
        ahead = np.array([math.cos(math.radians(60)), math.sin(math.radians(60))])
        right = np.array([ahead[1], -ahead[0]])
        second = 46 * (np.sin(rest)[:, None] * ahead + (1 - np.cos(rest))[:, None] * right)
        flat = start + second
        return np.column_stack([flat, 20 * s])

    lengths = 14 * math.radians(60), 46 * math.radians(150)
    share = lengths[0] / sum(lengths)
    n = sum(turns) * 2
    split = round(n * share)
    grid = np.concatenate([np.linspace(0, share, split + 1), np.linspace(share, 1, n - split + 1)[1:]])
    x, nodes, number = quads(n, 8, lambda r, s: place(grid[np.rint(r * n).astype(int)], s))
    elements = shell(nodes, 2.0, Elastic.from_engineering(3300.0, 0.35), modes=4)
    shear = np.full(9, 1.0 / 8)
    shear[[0, -1]] /= 2
    load = fem.NodalLoad(number[-1], np.full(9, 2), shear)
    solver, _ = solve(problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(load,)))
    assert moved(solver, number[-1, 4], 2) == pytest.approx(5.02, rel=0.03)
