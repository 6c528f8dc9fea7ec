"""Shape functions and quadrature of every isoparametric element, tabulated once at its integration points.

A kind is its nodes' natural coordinates and the polynomials that its shape functions span; the functions follow by
inversion. Nodes are in VTK's order. Natural coordinates: -1 .. 1 of quadrilaterals and hexahedra, 0 .. 1 of triangles
and tetrahedra, both of wedges; a pyramid has its base at t = 0 and its tip at t = 1 (Bedrosian 1992: rational terms).
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

Points = list[tuple[float, ...]]

_QUAD: Points = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
_QUAD_EDGES: Points = [(0, -1), (1, 0), (0, 1), (-1, 0)]
_TRI: Points = [(0, 0), (1, 0), (0, 1)]
_TRI_EDGES: Points = [(0.5, 0), (0.5, 0.5), (0, 0.5)]
_HEX: Points = [(*p, t) for t in (-1, 1) for p in _QUAD]
_HEX_EDGES: Points = [(*p, t) for t in (-1, 1) for p in _QUAD_EDGES] + [(*p, 0) for p in _QUAD]
_HEX_FACES: Points = [(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)]
_WEDGE: Points = [(*p, t) for t in (-1, 1) for p in _TRI]
_WEDGE_EDGES: Points = [(*p, t) for t in (-1, 1) for p in _TRI_EDGES] + [(*p, 0) for p in _TRI]
_TET: Points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
_TET_EDGES: Points = [(0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0), (0, 0, 0.5), (0.5, 0, 0.5), (0, 0.5, 0.5)]
_PYRAMID: Points = [*((*p, 0) for p in _QUAD), (0, 0, 1)]
_PYRAMID_EDGES: Points = [*((*p, 0) for p in _QUAD_EDGES), *((0.5 * r, 0.5 * s, 0.5) for r, s in _QUAD)]

NODES: dict[str, Points] = {
    "line2": [(-1,), (1,)],
    "line3": [(-1,), (1,), (0,)],
    "tri3": _TRI,
    "tri6": _TRI + _TRI_EDGES,
    "quad4": _QUAD,
    "quad8": _QUAD + _QUAD_EDGES,
    "quad9": [*_QUAD, *_QUAD_EDGES, (0, 0)],
    "tet4": _TET,
    "tet10": _TET + _TET_EDGES,
    "pyramid5": _PYRAMID,
    "pyramid13": _PYRAMID + _PYRAMID_EDGES,
    "wedge6": _WEDGE,
    "wedge15": _WEDGE + _WEDGE_EDGES,
    "hex8": _HEX,
    "hex20": _HEX + _HEX_EDGES,
    "hex27": [*_HEX, *_HEX_EDGES, *_HEX_FACES, (0, 0, 0)],
}


def _tensor(orders: tuple[int, ...], serendipity: int = 0) -> list[tuple[int, ...]]:
    """Exponents up to each order; serendipity: the greatest sum of exponents, where those of 1 do not count."""
    found = [tuple(int(i) for i in index) for index in np.ndindex(*(o + 1 for o in orders))]
    return [e for e in found if not serendipity or sum(i for i in e if i > 1) <= serendipity]


def _complete(dimension: int, order: int) -> list[tuple[int, ...]]:
    return [e for e in _tensor((order,) * dimension) if sum(e) <= order]


_WEDGE15_TERMS = [(*e, k) for k in (0, 1) for e in _complete(2, 2)] + [(0, 0, 2), (1, 0, 2), (0, 1, 2)]

# exponents of r, s, t; a fourth one is of 1 / (1 - t)
TERMS: dict[str, list[tuple[int, ...]]] = {
    "line2": _tensor((1,)),
    "line3": _tensor((2,)),
    "tri3": _complete(2, 1),
    "tri6": _complete(2, 2),
    "quad4": _tensor((1, 1)),
    "quad8": _tensor((2, 2), serendipity=2),
    "quad9": _tensor((2, 2)),
    "tet4": _complete(3, 1),
    "tet10": _complete(3, 2),
    "pyramid5": [*_complete(3, 1), (1, 1, 0, 1)],
    "pyramid13": [*_complete(3, 2), (1, 1, 0, 1), (2, 1, 0, 1), (1, 2, 0, 1)],
    "wedge6": [(*e, k) for k in (0, 1) for e in _complete(2, 1)],
    "wedge15": _WEDGE15_TERMS,
    "hex8": _tensor((1, 1, 1)),
    "hex20": _tensor((2, 2, 2), serendipity=2),
    "hex27": _tensor((2, 2, 2)),
}
TENSOR = ("line2", "line3", "quad4", "quad8", "quad9", "hex8", "hex20", "hex27")  # points by direction
_POINTS = {"line2": 2, "line3": 3, "quad4": 2, "quad8": 3, "quad9": 3, "hex8": 2, "hex20": 3, "hex27": 3}
_TIP = 1e-12  # where the tip's rational terms are taken


@dataclass(frozen=True, slots=True)
class Table:
    """An element at its integration points.

    points: (g, d) natural coordinates; weights: (g,); values: (g, n) shape functions; slopes: (g, n, d) their
    derivatives by natural coordinates; nodes: (n, d) natural coordinates of the nodes.
    """

    kind: str
    points: Floats
    weights: Floats
    values: Floats
    slopes: Floats
    nodes: Floats

    @property
    def count(self) -> int:
        """Integration points."""
        return len(self.weights)


def dimension(kind: str) -> int:
    """Of the natural space."""
    return len(NODES[kind][0])


def functions(kind: str, points: Floats) -> tuple[Floats, Floats]:
    """Shape functions (g, n) and their derivatives (g, n, d) at natural points (g, d)."""
    points = np.atleast_2d(np.asarray(points, dtype=float))
    inverse = _inverse(kind)
    values, slopes = _terms(kind, points)
    return values @ inverse, np.asarray(np.einsum("gmd,mn->gnd", slopes, inverse))


@functools.cache
def table(kind: str, gauss: tuple[int, ...] = (), *, full: bool = False) -> Table:
    """An element's table. gauss: points by direction of quadrilaterals and hexahedra, 0 the usual; the usual without.

    full: a rule that integrates the consistent mass.
    """
    points, weights = rule(kind, gauss, full=full)
    values, slopes = functions(kind, points)
    return Table(kind, points, weights, values, slopes, np.array(NODES[kind], dtype=float))


def rule(kind: str, gauss: tuple[int, ...] = (), *, full: bool = False) -> tuple[Floats, Floats]:
    """Points (g, d) and weights (g,) of a quadrature."""
    if kind in TENSOR:
        usual = _POINTS[kind]
        counts = [(gauss[k] if k < len(gauss) else 0) or usual for k in range(dimension(kind))]
        return _product([_gauss(n) for n in counts])
    quadratic = kind in ("tri6", "tet10", "wedge15", "pyramid13")
    if kind.startswith("tri"):
        return _triangle(6 if quadratic and full else 3 if quadratic or full else 1)
    if kind.startswith("tet"):
        if full:
            return _collapsed_tetrahedron(3 if quadratic else 2)
        return _tetrahedron(4 if quadratic else 1)
    if kind.startswith("wedge"):
        flat, flat_weights = _triangle(6 if quadratic else 3)
        line, line_weights = _gauss(3 if quadratic else 2)
        points = np.column_stack([np.tile(flat, (len(line), 1)), np.repeat(line, len(flat))])
        return points, np.tile(flat_weights, len(line)) * np.repeat(line_weights, len(flat))
    return _collapsed_pyramid(3 if quadratic else 2)


@functools.cache
def extrapolation(kind: str, gauss: tuple[int, ...] = ()) -> Floats:
    """(n, g): from integration points to nodes, by the polynomials that the points determine (least squares)."""
    t = table(kind, gauss)
    if t.count == 1:
        return np.ones((len(t.nodes), 1))
    low = {"line": "line2", "tri": "tri3", "quad": "quad4", "tet": "tet4", "wedg": "wedge6", "hex": "hex8"}
    plain = next((low[k] for k in low if kind.startswith(k)), "tet4")
    at_points, _ = _terms(plain, t.points)
    at_nodes, _ = _terms(plain, t.nodes)
    rank = np.linalg.matrix_rank(at_points)
    if rank < at_points.shape[1]:  # fewer points than that: what is linear, or the mean
        keep = [i for i, e in enumerate(TERMS[plain]) if sum(e) <= (1 if t.count > dimension(kind) else 0)]
        at_points, at_nodes = at_points[:, keep], at_nodes[:, keep]
    return np.ascontiguousarray(at_nodes @ np.linalg.pinv(at_points), dtype=float)


def surface_products(kind: str, corners: Floats) -> Floats:
    """(e, n, n) integrals of products of shape functions over surfaces with nodes at corners (e, n, 3)."""
    t = table(kind, full=True)
    tangents = np.einsum("gkd,eki->egdi", t.slopes, corners)
    area = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=2) * t.weights
    out: Floats = np.einsum("eg,gk,gl->ekl", area, t.values, t.values)
    return out


@functools.cache
def _inverse(kind: str) -> Floats:
    values, _ = _terms(kind, np.array(NODES[kind], dtype=float))
    return np.asarray(np.linalg.inv(values), dtype=float)


def _terms(kind: str, points: Floats) -> tuple[Floats, Floats]:
    """The polynomials (g, m) of a kind and their derivatives (g, m, d)."""
    d = dimension(kind)
    exponents = np.array([(*e[:d], *([e[d]] if len(e) > d else [0])) for e in TERMS[kind]])
    columns = [points[:, k] for k in range(d)]
    if d == 3:
        columns.append(1.0 / np.maximum(1.0 - points[:, 2], _TIP))
    else:
        exponents = exponents[:, :d]
    powers = [c[:, None] ** exponents[None, :, k] for k, c in enumerate(columns)]
    values = functools.reduce(np.multiply, powers)
    slopes = np.empty((len(points), len(exponents), d))
    for k in range(d):
        e = exponents[:, k]
        own = e * columns[k][:, None] ** np.maximum(e - 1, 0)
        slopes[:, :, k] = functools.reduce(np.multiply, [own if i == k else p for i, p in enumerate(powers)])
    if d == 3:  # (1 - t)^-m grows along t
        slopes[:, :, 2] += values * exponents[:, 3] * columns[3][:, None]
    return values, slopes


def _gauss(n: int) -> tuple[Floats, Floats]:
    points, weights = np.polynomial.legendre.leggauss(n)
    return np.asarray(points), np.asarray(weights)


def _product(lines: list[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """A tensor rule; the first direction runs fastest."""
    grids: Any = np.meshgrid(*[p for p, _ in lines], indexing="ij")
    weights: Any = np.meshgrid(*[w for _, w in lines], indexing="ij")
    points = np.column_stack([g.ravel(order="F") for g in grids])
    return points, functools.reduce(np.multiply, [w.ravel(order="F") for w in weights])


def _triangle(count: int) -> tuple[Floats, Floats]:
    """Dunavant 1985: degree 1, 2 or 4 by 1, 3 or 6 points."""
    if count == 1:
        return np.array([[1 / 3, 1 / 3]]), np.array([0.5])
    groups = [(1 / 6, 1 / 3)] if count == 3 else [(0.445948490915965, 0.223381589678011),
                                                  (0.091576213509771, 0.109951743655322)]  # fmt: skip
    points = [p for a, _ in groups for p in ((a, a), (1 - 2 * a, a), (a, 1 - 2 * a))]
    return np.array(points), 0.5 * np.repeat([w for _, w in groups], 3)


def _tetrahedron(count: int) -> tuple[Floats, Floats]:
    """Degree 1 or 2 by 1 or 4 points."""
    if count == 1:
        return np.array([[0.25, 0.25, 0.25]]), np.array([1 / 6])
    a = (5 - np.sqrt(5)) / 20
    b = 1 - 3 * a
    return np.array([(a, a, a), (b, a, a), (a, b, a), (a, a, b)]), np.full(4, 1 / 24)


def _collapsed_tetrahedron(n: int) -> tuple[Floats, Floats]:
    """Conical product rule (Stroud 1971) with n^3 points, degree 2 n - 1."""
    from scipy.special import roots_jacobi

    lines = []
    for k in range(3):
        x, w = roots_jacobi(n, k, 0)
        lines.append((0.5 * (x + 1), w / 2 ** (k + 1)))
    (r, wr), (s, ws), (t, wt) = lines
    points, weights = _product([(r, wr), (s, ws), (t, wt)])
    z = points[:, 2]
    y = points[:, 1] * (1 - z)
    x = points[:, 0] * (1 - y - z)
    return np.column_stack([x, y, z]), weights


def _collapsed_pyramid(n: int) -> tuple[Floats, Floats]:
    """Gauss in the base, Jacobi to the tip."""
    from scipy.special import roots_jacobi

    x, w = roots_jacobi(n, 2, 0)
    points, weights = _product([_gauss(n), _gauss(n), (0.5 * (x + 1), w / 8)])
    scale = 1 - points[:, 2]
    return np.column_stack([points[:, 0] * scale, points[:, 1] * scale, points[:, 2]]), weights
