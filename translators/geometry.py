"""Geometry of element blocks: exact measures, simplices that make up an element, edge lengths."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from zrno.translators.elements import TABLE, Element
from zrno.translators.model import ElementBlock, Floats

_GAUSS = np.polynomial.legendre.leggauss(4)  # exact to degree 7: a quad9 face's flux has degree 5 in each direction


def measures(block: ElementBlock, xyz: Floats) -> Floats:
    """Areas of 2D or volumes of 3D elements, shape (n,): of the isoparametric element, exact for curved ones.

    A volume is the flux of x/3 through the element's faces (divergence theorem).
    """
    element = TABLE[block.kind]
    points = xyz[block.nodes]
    points = points - points.mean(axis=1, keepdims=True)
    if element.dimension == 2:
        return _area(element, points)
    total = np.zeros(len(points))
    for face in range(len(element.shape.faces)):
        x, du, dv, weights = _face_points(element, face, points)
        total += np.einsum("nqi,nqi,q->n", x, np.cross(du, dv), weights) / 3.0
    return np.abs(total)


def _area(element: Element, points: Floats) -> Floats:
    _, du, dv, weights = _face_points(element, 0, points)
    normal = np.cross(du, dv)
    if not points[..., 2].any():  # flat: signed, so that the sum is the polygon's (or the curved outline's) area
        return np.abs(normal[..., 2] @ weights)
    return np.asarray(np.linalg.norm(normal, axis=2) @ weights)


def _face_points(element: Element, face: int, points: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Quadrature points of a face: positions and both tangents, shape (n, q, 3), and weights (q,)."""
    cycle, centre = element.face_cycle(face)
    nodes = points[:, [*cycle, *(() if centre is None else (centre,))]]
    corners = len(cycle) // 2 if element.mid_edges else len(cycle)
    u, v, weights = _rule(corners)
    values, by_u, by_v = _shape_functions(corners, nodes.shape[1], u, v)
    return values @ nodes, by_u @ nodes, by_v @ nodes, weights


def _rule(corners: int) -> tuple[Floats, Floats, Floats]:
    """Gauss points and weights of the square (-1, 1)^2, or of the triangle (0, 0), (1, 0), (0, 1) by collapsing it."""
    points, weights = _GAUSS
    u, v = (grid.ravel() for grid in np.meshgrid(points, points))
    w = np.outer(weights, weights).ravel()
    if corners == 4:
        return u, v, w
    s, t = (1 + u) / 2, (1 + v) / 2
    return s, t * (1 - s), w * (1 - s) / 4


def _shape_functions(corners: int, count: int, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """Values and derivatives of a face's shape functions, shape (q, count).

    The nodes stand corner, mid-edge, corner, ..., centre. The functions are found from the monomials that they span:
    by the inverse of the monomials' values at the nodes.
    """
    powers = {
        (3, 3): [(0, 0), (1, 0), (0, 1)],
        (3, 6): [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
        (4, 4): [(0, 0), (1, 0), (0, 1), (1, 1)],
        (4, 8): [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2)],
        (4, 9): [(i, j) for i in range(3) for j in range(3)],
    }[corners, count]
    at = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)] if corners == 4 else [(0, 0), (1, 0), (0, 1)], float)
    if count > corners:
        at = np.stack([at, (at + np.roll(at, -1, axis=0)) / 2], axis=1).reshape(-1, 2)
    if count == 9:
        at = np.vstack([at, [0.0, 0.0]])
    i, j = np.array(powers).T
    inverse = np.linalg.inv(at[:, :1] ** i * at[:, 1:] ** j)
    u, v = u[:, None], v[:, None]
    values = u**i * v**j
    by_u = i * u ** np.maximum(i - 1, 0) * v**j
    by_v = j * u**i * v ** np.maximum(j - 1, 0)
    return values @ inverse, by_u @ inverse, by_v @ inverse


def simplices(block: ElementBlock, xyz: Floats) -> Iterator[Floats]:
    """Triangles of 2D or tetrahedra of 3D elements: corner positions, shape (n, 3 or 4, 3), a group of them at a time.

    Together they fill the element: exactly a straight one, through all its nodes a curved one. Faces with four corners
    are split about their centre, so that neighbours meet without a gap.
    """
    element = TABLE[block.kind]
    points = xyz[block.nodes]
    if block.kind in ("tri3", "tet4"):
        yield points
        return
    inside = points.mean(axis=1)
    if element.dimension == 2:
        for triangle in _triangles(element, 0, points):
            yield triangle
        return
    for face in range(len(element.shape.faces)):
        for triangle in _triangles(element, face, points):
            yield np.concatenate([inside[:, None], triangle], axis=1)


def _triangles(element: Element, face: int, points: Floats) -> Iterator[Floats]:
    cycle, centre = element.face_cycle(face)
    if len(cycle) == 3:
        yield points[:, list(cycle)]
        return
    corners, middles = cycle[::2], cycle[1::2]
    if len(cycle) == 6:
        yield points[:, list(middles)]
        for i, corner in enumerate(corners):
            yield points[:, [corner, middles[i], middles[i - 1]]]
        return
    if centre is not None:
        middle = points[:, centre]
    elif element.mid_edges:  # the serendipity face's centre
        middle = points[:, list(middles)].sum(axis=1) / 2 - points[:, list(corners)].sum(axis=1) / 4
    else:
        middle = points[:, list(cycle)].mean(axis=1)
    for a, b in zip(cycle, cycle[1:] + cycle[:1], strict=True):
        yield np.stack([middle, points[:, a], points[:, b]], axis=1)


def edge_lengths(block: ElementBlock, xyz: Floats) -> Floats:
    """Lengths between the corners of all edges, shape (n * edges,)."""
    edges = np.array(TABLE[block.kind].shape.edges, int).reshape(-1, 2)
    vectors = xyz[block.nodes[:, edges[:, 0]]] - xyz[block.nodes[:, edges[:, 1]]]
    return np.asarray(np.linalg.norm(vectors, axis=2).ravel())
