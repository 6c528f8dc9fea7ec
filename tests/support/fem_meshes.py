"""Meshes and problems of structures that several tests run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.solvers import fem
from zrno.solvers.fem.elements import shapes
from zrno.solvers.materials import Elastic

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def quads(nx: int, ny: int, place: Callable[[Floats, Floats], Floats]) -> tuple[Floats, Ints, Ints]:
    """Nodes (n, 3), four-node elements (nx ny, 4) and the nodes' numbers (nx + 1, ny + 1) of a mapped unit square."""
    r, s = np.meshgrid(np.linspace(0, 1, nx + 1), np.linspace(0, 1, ny + 1), indexing="ij")
    number = np.arange(r.size).reshape(r.shape)
    nodes = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return place(r.ravel(), s.ravel()), nodes, number


def nine(nx: int, ny: int, place: Callable[[Floats, Floats], Floats]) -> tuple[Floats, Ints, Ints]:
    """As `quads` of nine-node elements; the nodes' numbers are (2 nx + 1, 2 ny + 1)."""
    x, _, number = quads(2 * nx, 2 * ny, place)
    at = {-1: slice(None, -1, 2), 0: slice(1, None, 2), 1: slice(2, None, 2)}
    nodes = np.stack([number[at[int(r)], at[int(s)]] for r, s in shapes.NODES["quad9"]], axis=-1).reshape(-1, 9)
    return x, nodes, number


def eight(nx: int, ny: int, place: Callable[[Floats, Floats], Floats]) -> tuple[Floats, Ints, Ints]:
    """As `nine` without the centres; their number is -1."""
    x, nodes, number = nine(nx, ny, place)
    number[1::2, 1::2] = -1
    kept = number.ravel() >= 0
    new = np.cumsum(kept) - 1
    return x[kept], new[nodes[:, :8]], np.where(number < 0, -1, new[number])


def straight(x: Floats, nodes: Ints, shift: Floats) -> Floats:
    """Nine-node elements whose corners are shifted by (n, 3), edges straight and middles in the middle."""
    out = x.copy()
    corners = np.unique(nodes[:, :4])
    out[corners] += shift[corners]
    for k in range(4):
        out[nodes[:, 4 + k]] = 0.5 * (out[nodes[:, k]] + out[nodes[:, (k + 1) % 4]])
    out[nodes[:, 8]] = out[nodes[:, :4]].mean(axis=1)
    return out


def reversed_edges(n: int) -> tuple[Floats, Floats]:
    """Places r, s (n + 1, n + 1) in a unit square of Ko, Lee & Bathe's distorted meshes: edges are cut 1 : 2 : .. : n,
    those opposite the other way round, and straight lines join them."""
    cut = np.concatenate([[0.0], np.cumsum(np.arange(1.0, n + 1))]) / (n * (n + 1) / 2)
    below, left = np.meshgrid(cut, 1.0 - cut[::-1], indexing="ij")
    above, right = np.meshgrid(1.0 - cut[::-1], cut, indexing="ij")
    r = (below + (above - below) * left) / (1.0 - (above - below) * (right - left))
    return r, left + (right - left) * r


def bricks(nx: int, ny: int, nz: int, size: tuple[float, float, float] = (1, 1, 1)) -> tuple[Floats, Ints, Ints]:
    """Nodes, eight-node hexahedra and the nodes' numbers (nx + 1, ny + 1, nz + 1) of a box."""
    axes = [np.linspace(0, length, n + 1) for length, n in zip(size, (nx, ny, nz), strict=True)]
    x = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(x)).reshape(nx + 1, ny + 1, nz + 1)
    low = (slice(None, -1), slice(1, None))
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    nodes = np.stack([number[low[i], low[j], low[k]] for i, j, k in corners], axis=-1).reshape(-1, 8)
    return x, nodes, number


def plane(x: Floats, z: float = 0.0) -> Floats:
    """Points (n, 2) in space."""
    return np.column_stack([x, np.full(len(x), z)])


def problem(x: Floats, elements: Any, fixed: NDArray[np.bool_], **more: Any) -> fem.Problem:
    """A problem with nodes numbered from 1. elements: one group, or several."""
    groups = elements if isinstance(elements, tuple) else (elements,)
    return fem.Problem("test", 3, x, np.arange(1, len(x) + 1), groups, fixed, **more)


def group(kind: str, family: str, nodes: Ints, law: Any = None, **more: Any) -> fem.Elements:
    """Elements numbered from 1, of steel without units where no law is given."""
    law = Elastic.from_engineering(2.1e5, 0.3) if law is None else law
    return fem.Elements(kind, family, nodes, np.arange(1, len(nodes) + 1), 1, law, **more)


def shell(nodes: Ints, thickness: float, law: Any = None, **more: Any) -> fem.Elements:
    """Shells of one thickness, of four nodes or of as many as given."""
    kind = {4: "quad4", 8: "quad8", 9: "quad9"}[nodes.shape[1]]
    return group(kind, "shell", nodes, law, thickness=np.full(len(nodes), thickness), **more)


def held(count: int, *rows: tuple[Any, str]) -> NDArray[np.bool_]:
    """(count, 6) of pairs: nodes, and what of "xyzabc" is held (a b c: rotations about x y z)."""
    fixed = np.zeros((count, 6), bool)
    for nodes, letters in rows:
        for letter in letters:
            fixed[nodes, "xyzabc".index(letter)] = True
    return fixed


def loaded(nodes: Any, dof: int, total: float, curve: int | None = None) -> fem.NodalLoad:
    """A force shared by nodes alike. dof: 0..5."""
    nodes = np.atleast_1d(nodes).ravel()
    return fem.NodalLoad(nodes, np.full(len(nodes), dof), np.full(len(nodes), total / len(nodes)), curve)


def line_load(nodes: Ints, dof: int, total: float, curve: int | None = None) -> fem.NodalLoad:
    """A force that is spread evenly over an edge of quadratic elements of one length."""
    share = np.zeros(len(nodes))
    for k in range(0, len(nodes) - 1, 2):
        share[k : k + 3] += np.array([1.0, 4.0, 1.0]) / (3.0 * (len(nodes) - 1))
    return fem.NodalLoad(nodes, np.full(len(nodes), dof), total * share, curve)


def ramp() -> fem.Curve:
    """From 0 to 1 in a unit of time."""
    return fem.Curve(np.array([0.0, 1.0]), np.array([0.0, 1.0]))


def solve(p: fem.Problem, see: Callable[[fem.Solver], Any] | None = None) -> tuple[fem.Solver, list[Any]]:
    """Run a problem to its end; what is seen after each step."""
    solver = fem.Solver(p)
    seen = []
    for _ in range(p.modes or len(p.ends()) - 1):
        solver.advance(np.inf, 1)
        seen.append(see(solver) if see else None)
    return solver, seen


def moved(solver: fem.Solver, node: Any, dof: int) -> float:
    """A displacement."""
    return float(solver.shape.u[int(node), dof])
