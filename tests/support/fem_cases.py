"""Published linear benchmarks (MacNeal & Harder 1985, NAFEMS, Timoshenko, Ko et al. 2017) as functions of the mesh.

Each returns what the benchmark asks for and the solver. n: elements along the side that the docstring names.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from fem_meshes import (
    Floats,
    Ints,
    bricks,
    eight,
    group,
    held,
    line_load,
    loaded,
    moved,
    nine,
    problem,
    quads,
    shell,
    solve,
)

from zrno.solvers import fem
from zrno.solvers.fem import output
from zrno.solvers.materials import Elastic

Found = tuple[float, fem.Solver]


def edge_load(nodes: Ints, dof: int, total: float) -> fem.NodalLoad:
    """A force spread evenly over an edge of four-node elements of one length."""
    share = np.full(len(nodes), total / (len(nodes) - 1))
    share[[0, -1]] /= 2
    return fem.NodalLoad(nodes, np.full(len(nodes), dof), share)


# shells


def roof(n: int, modes: int = 4, mesh: Any = quads) -> Found:
    """Scordelis-Lo, a quarter of n x n: how far the middle of the free edge sinks, 0.3024."""
    bend = math.radians(40)
    x, nodes, number = mesh(n, n, lambda r, s: np.stack([25 * np.sin(bend * r), 25 * s, 25 * np.cos(bend * r)], -1))
    side, middle, crown = (row[row >= 0] for row in (number[:, 0], number[:, -1], number[0]))
    fixed = held(len(x), (side, "xz"), (middle, "yac"), (crown, "xbc"))
    elements = shell(nodes, 0.25, Elastic.from_engineering(4.32e8, 0.0), density=360.0, modes=modes)
    weight = fem.BodyLoad(np.array([0.0, 0.0, -1.0]))
    solver, _ = solve(problem(x, elements, fixed, body_loads=(weight,)))
    return -moved(solver, number[-1, -1], 2), solver


def cylinder_mesh(n: int) -> tuple[Floats, Ints, Ints, Any]:
    """An octant of the pinched cylinder, n x n, and what is held."""
    x, nodes, number = quads(
        n, n, lambda r, s: np.stack([300 * np.sin(0.5 * np.pi * r), 300 * s, 300 * np.cos(0.5 * np.pi * r)], -1)
    )
    fixed = held(len(x), (number[:, 0], "xz"), (number[:, -1], "yac"), (number[0], "xbc"), (number[-1], "zab"))
    return x, nodes, number, fixed


def cylinder(n: int, modes: int = 4) -> Found:
    """Pinched, on diaphragms: how far the load goes, 1.8248e-5."""
    x, nodes, number, fixed = cylinder_mesh(n)
    elements = shell(nodes, 3.0, Elastic.from_engineering(3e6, 0.3), modes=modes)
    solver, _ = solve(problem(x, elements, fixed, nodal_loads=(loaded(number[0, -1], 2, -0.25),)))
    return -moved(solver, number[0, -1], 2), solver


def hemisphere(n: int, modes: int = 4, mesh: Any = quads, thickness: float = 0.04) -> Found:
    """Pinched, with a hole of 18 degrees, a quarter of n x n: how far a load goes, 0.0940.

    mesh: of the unit square, a part of the sphere is made of it.
    """
    top = 0.5 * np.pi - math.radians(18)
    x, nodes, number = mesh(n, n, lambda r, s: np.stack([r, s, 0 * r], -1))
    turn, up = 0.5 * np.pi * x[:, 0], top * x[:, 1]
    x = 10 * np.stack([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)], -1)
    fixed = held(len(x), (number[0], "yac"), (number[-1], "xbc"), (number[0, 0], "z"))
    elements = shell(nodes, thickness, Elastic.from_engineering(6.825e7, 0.3), modes=modes)
    loads = (loaded(number[0, 0], 0, 1.0), loaded(number[-1, 0], 1, -1.0))
    solver, _ = solve(problem(x, elements, fixed, nodal_loads=loads))
    return moved(solver, number[0, 0], 0), solver


def octant(n: int, radius: float, mesh: Any) -> tuple[Floats, Ints]:
    """A sphere's octant by three patches of n x n elements that meet where x = y = z."""
    patches, nodes, count = [], [], 0
    for k in range(3):
        a, b, c = (np.eye(3)[(k + i) % 3] for i in range(3))
        quad = np.array([a, (a + b) / 2, (a + b + c) / 3, (a + c) / 2])

        def place(r: Floats, s: Floats, quad: Floats = quad) -> Floats:
            p = np.stack([(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s], -1) @ quad
            out: Floats = radius * p / np.linalg.norm(p, axis=1, keepdims=True)
            return out

        x, own, _ = mesh(n, n, place)
        patches.append(x)
        nodes.append(own + count)
        count += len(x)
    x = np.concatenate(patches)
    _, first, inverse = np.unique(np.round(x / radius, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    return x[first], inverse.ravel()[np.concatenate(nodes)]


def full_hemisphere(n: int, mesh: Any = quads, young: float = 68.25e9, load: float = 2e3) -> Found:
    """NAFEMS LE3 (0.185), without a hole: pulled outward at A and inward at C, the top held along z; ux at A."""
    x, nodes = octant(n, 10.0, mesh)
    elements = shell(nodes, 0.04, Elastic.from_engineering(young, 0.3))
    on = np.abs(x) < 1e-9

    def at(*place: float) -> int:
        return int(np.argmin(np.linalg.norm(x - place, axis=1)))

    fixed = held(len(x), (on[:, 1], "yac"), (on[:, 0], "xbc"), ([at(0, 0, 10)], "z"))
    a, c = at(10, 0, 0), at(0, 10, 0)
    solver, _ = solve(problem(x, elements, fixed, nodal_loads=(loaded(a, 0, load), loaded(c, 1, -load))))
    return moved(solver, a, 0), solver


def twisted(n: int, thickness: float, dof: int, modes: int = 4) -> Found:
    """MacNeal & Harder's beam that turns by 90 degrees, n x n/6: its tip, by a load of 1.

    dof: 1 or 2, along the width of the tip or across it.
    """

    def place(r: Floats, s: Floats) -> Floats:
        turn, across = 0.5 * np.pi * r, 1.1 * (s - 0.5)
        return np.stack([12 * r, across * np.sin(turn), across * np.cos(turn)], -1)

    x, nodes, number = quads(n, n // 6, place)
    elements = shell(nodes, thickness, Elastic.from_engineering(29e6, 0.22), modes=modes)
    load = 1.0 if thickness > 0.1 else 1e-6
    p = problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(edge_load(number[-1], dof, load),))
    solver, _ = solve(p)
    return moved(solver, number[-1, n // 12], dof), solver


def plate(n: int, clamped: bool, point: bool, h: float = 1e-3) -> Found:
    """A quarter of a square plate, n x n: Timoshenko's coefficient of q a^4 / D or P a^2 / D."""
    x, nodes, number = quads(n, n, lambda r, s: np.stack([0.5 * r, 0.5 * s, 0 * r], -1))
    young = 2.1e5
    sides = ((number[-1], "zb" if not clamped else "zab"), (number[:, -1], "za" if not clamped else "zab"))
    fixed = held(len(x), (slice(None), "xyc"), (number[0], "b"), (number[:, 0], "a"),
                 *((where, letters if clamped else "z") for where, letters in sides))  # fmt: skip
    if not clamped:  # the edges do not turn about their normals
        fixed |= held(len(x), (number[-1], "a"), (number[:, -1], "b"))
    elements = shell(nodes, h, Elastic.from_engineering(young, 0.3))
    load: dict[str, Any] = (
        {"nodal_loads": (loaded(number[0, 0], 2, -0.25),)} if point
        else {"face_loads": (fem.FaceLoad("quad4", nodes, np.full(nodes.shape, 1.0)),)}
    )  # fmt: skip
    solver, _ = solve(problem(x, elements, fixed, **load))
    return -moved(solver, number[0, 0], 2) * young * h**3 / (12 * (1 - 0.09)), solver


def hook(n: int) -> Found:
    """Raasch's, two arcs, 12 n x n: where its tip goes; the thick shell twists: 5.02 (Ko et al.), not 4.93."""
    lengths = 14 * math.radians(60), 46 * math.radians(150)

    def place(r: Floats, s: Floats) -> Floats:
        way = r * sum(lengths)
        first = np.minimum(way / 14, math.radians(60))
        rest = np.maximum(way / 46 - lengths[0] / 46, 0.0)
        start = np.stack([14 * np.sin(first), 14 - 14 * np.cos(first)], -1)
        ahead = np.array([math.cos(math.radians(60)), math.sin(math.radians(60))])
        right = np.array([ahead[1], -ahead[0]])
        second = 46 * (np.sin(rest)[:, None] * ahead + (1 - np.cos(rest))[:, None] * right)
        return np.column_stack([start + second, 20 * s])

    share = lengths[0] / sum(lengths)
    along = 12 * n
    split = round(along * share)
    grid = np.concatenate([np.linspace(0, share, split + 1), np.linspace(share, 1, along - split + 1)[1:]])
    x, nodes, number = quads(along, n, lambda r, s: place(grid[np.rint(r * along).astype(int)], s))
    elements = shell(nodes, 2.0, Elastic.from_engineering(3300.0, 0.35), modes=4)
    p = problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(edge_load(number[-1], 2, 1.0),))
    solver, _ = solve(p)
    return moved(solver, number[-1, n // 2], 2), solver


# solids and plane elements


def curved(n: int, axis: int) -> Found:
    """MacNeal & Harder's quarter ring 4.12 .. 4.32, 0.1 thick, by n x n/12 shells: its tip, in (0) or out of plane (2).

    The section is twice as wide as thick: its torsion is at the end of what shells say.
    """
    x, nodes, number = quads(n, n // 12, _ring)
    elements = shell(nodes, 0.1, Elastic.from_engineering(1e7, 0.25), modes=4)
    p = problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(loaded(number[-1], axis, 1.0),))
    solver, _ = solve(p)
    return float(np.mean([moved(solver, node, axis) for node in number[-1]])), solver


def _ring(r: Floats, s: Floats) -> Floats:
    radius, angle = 4.12 + 0.2 * s, 0.5 * np.pi * r
    return np.stack([radius * np.sin(angle), radius * np.cos(angle), 0 * r], -1)


def curved_solid(n: int, axis: int) -> Found:
    """The same by enhanced bricks, n x n/6 x n/12."""
    x, nodes, number = bricks(n, n // 6, n // 12)
    elements = group("hex8", "solid", nodes, Elastic.from_engineering(1e7, 0.25), modes=12)
    x = _ring(x[:, 0], x[:, 1]) + np.outer(0.1 * x[:, 2], [0.0, 0.0, 1.0])
    number_tip = number[-1]
    share = np.ones(number_tip.shape)
    for side in (0, -1):
        share[side] /= 2
        share[:, side] /= 2
    pull = fem.NodalLoad(number_tip.ravel(), np.full(share.size, axis), (share / share.sum()).ravel())
    solver, _ = solve(problem(x, elements, held(len(x), (number[0], "xyz")), nodal_loads=(pull,)))
    return float(np.mean([moved(solver, node, axis) for node in number_tip.ravel()])), solver


def straight_beam(cuts: tuple[int, int, int], axis: int) -> Found:
    """MacNeal & Harder's cantilever 6 x 0.2 x 0.1 by enhanced bricks, free to contract at its root: its tip."""
    x, nodes, number = bricks(*cuts, (6.0, 0.2, 0.1))
    elements = group("hex8", "solid", nodes, Elastic.from_engineering(1e7, 0.3), modes=12)
    held_at = held(len(x), (number[0], "x"), (number[0, :, 0], "z"), (number[0, 0], "y"))
    solver, _ = solve(problem(x, elements, held_at, nodal_loads=(loaded(number[-1], axis, 1.0),)))
    return float(np.mean([moved(solver, node, axis) for node in number[-1].ravel()])), solver


def twist_of_bricks(cuts: tuple[int, int, int]) -> Found:
    """SC4: the same beam, clamped, turned at its tip by enhanced bricks: Saint-Venant's 0.03411.

    The clamped end, which cannot warp, is 1.5 % stiffer than Saint-Venant's bar.
    """
    x, nodes, number = bricks(*cuts, (6.0, 0.2, 0.1))
    x = x - [0.0, 0.1, 0.05]
    elements = group("hex8", "solid", nodes, Elastic.from_engineering(1e7, 0.3), modes=12)
    tip = number[-1].ravel()
    arm = np.stack([-x[tip, 2], x[tip, 1]], 1) / (x[tip, 1:] ** 2).sum()
    couple = fem.NodalLoad(np.repeat(tip, 2), np.tile([1, 2], len(tip)), arm.ravel())
    solver, _ = solve(problem(x, elements, held(len(x), (number[0], "xyz")), nodal_loads=(couple,)))
    return float((arm * solver.shape.u[tip, 1:3]).sum()), solver


def twist_of_shells(n: int) -> Found:
    """SC4 by nine-node shells, n x n/6."""
    x, nodes, number = nine(n, n // 6, lambda r, s: np.stack([6 * r, 0.2 * (s - 0.5), 0 * r], -1))
    elements = shell(nodes, 0.1, Elastic.from_engineering(1e7, 0.3))
    p = problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(line_load(number[-1], 3, 1.0),))
    solver, _ = solve(p)
    return moved(solver, number[-1, number.shape[1] // 2], 3), solver


def cook(n: int, modes: int = 4) -> Found:
    """Cook's membrane, n x n four-node elements in plane stress: the middle of the loaded edge, 23.9642."""
    x, nodes, number = quads(n, n, lambda r, s: np.stack([48 * r, 44 * r + s * (44 - 28 * r), 0 * r], -1))
    elements = group("quad4", "plane", nodes, Elastic.from_engineering(1.0, 1 / 3), plane="stress", modes=modes)
    p = problem(x, elements, held(len(x), (number[0], "xy")), nodal_loads=(edge_load(number[-1], 1, 1.0),))
    solver, _ = solve(p)
    return moved(solver, number[-1, n // 2], 1), solver


def ellipses(r: Floats, s: Floats) -> Floats:
    """Between NAFEMS' ellipses 2 x 1 and 3.25 x 2.75: r outwards, s from the x axis to the y axis."""
    angle = 0.5 * np.pi * s
    inner = np.stack([2.0 * np.cos(angle), 1.0 * np.sin(angle)], -1)
    outer = np.stack([3.25 * np.cos(angle), 2.75 * np.sin(angle)], -1)
    flat = inner + r[:, None] * (outer - inner)
    return np.column_stack([flat, np.zeros(len(r))])


def le1(n: int) -> Found:
    """Elliptic membrane by n x 3 n/2 eight-node elements: sigma_yy at D (2, 0), 92.7 MPa."""
    x, nodes, number = eight(n, 3 * n // 2, ellipses)
    edge = number[-1]
    edges = np.stack([edge[:-1:2], edge[2::2], edge[1::2]], axis=-1)  # outwards from left to right of their way
    pull = fem.FaceLoad("line3", edges, np.full(edges.shape, -10e6), thickness=np.ones(len(edges)))
    elements = group("quad8", "plane", nodes, Elastic.from_engineering(210e9, 0.3), plane="stress")
    fixed = held(len(x), (number[:, 0][number[:, 0] >= 0], "y"), (number[:, -1][number[:, -1] >= 0], "x"))
    solver, _ = solve(problem(x, elements, fixed, face_loads=(pull,)))
    return float(output.frame(solver).nodes["stress"][number[0, 0], 1]) / 1e6, solver


def le10(n: int, m: int = 4) -> Found:
    """Thick plate by n x 4 n/3 x m twenty-node hexahedra: sigma_yy at D on the top (2, 0, 0.6), -5.38 MPa."""
    flat, quad, number = eight(n, 4 * n // 3, ellipses)
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
    places = np.concatenate(x)
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
    fixed = held(len(places), (every, "xy"), (at_y0, "y"), (at_x0, "x"), (middle, "z"))
    solver, _ = solve(problem(places, elements, fixed, face_loads=(press,)))
    return float(output.frame(solver).nodes["stress"][layer[2 * m][number[0, 0]], 1]) / 1e6, solver
