"""The elements of PAK: types (NETIP), and the orders of their nodes against VTK's."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

import numpy as np

from zrno.translators.elements import TABLE
from zrno.translators.model import Floats, Ints


@dataclass(frozen=True, slots=True)
class Type:
    """An element type. corners: nodes that every one has; most: nodes that it may have; families as in the model.

    kinds: number of nodes -> name in `elements.TABLE`; order: node i of PAK is node order[i] of VTK (empty: i).
    """

    family: str
    corners: int
    most: int
    kinds: dict[int, str]
    order: tuple[int, ...] = ()


# pak32: node 1 at r = s = t = +1, 2 at r = -1, 3 at r = s = -1, 4 at s = -1, 5-8 below them; 9-12 between 12 23 34 41,
# 13-16 between 56 67 78 85, 17-20 between 15 26 37 48, 21 in the middle
HEX_ORDER = (4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19, 26)
_QUADS = {4: "quad4", 8: "quad8", 9: "quad9"}
_TRIANGLES = {3: "tri3", 6: "tri6"}
TYPES = {
    1: Type("truss", 2, 2, {2: "line2"}),
    2: Type("plane", 4, 9, _QUADS),
    21: Type("plane", 3, 6, _TRIANGLES),
    3: Type("solid", 8, 21, {8: "hex8", 20: "hex20"}, HEX_ORDER),
    31: Type("solid", 6, 15, {6: "wedge6", 15: "wedge15"}, (3, 4, 5, 0, 1, 2)),
    32: Type("solid", 5, 13, {5: "pyramid5", 13: "pyramid13"}),
    33: Type("solid", 4, 10, {4: "tet4", 10: "tet10"}),
    6: Type("beam", 2, 2, {2: "line2"}),
    8: Type("shell", 4, 9, _QUADS),
    81: Type("shell", 3, 6, _TRIANGLES),
    82: Type("shell", 4, 9, _QUADS),
    83: Type("shell", 3, 6, _TRIANGLES),
    84: Type("shell", 4, 9, _QUADS),
    85: Type("shell", 4, 9, _QUADS),
}
SOLIDS, PLANES, SHELLS = (3, 31, 32, 33), (2, 21), (8, 81, 82, 83, 84, 85)
# A solid of fewer corners as a hexahedron with corners that coincide: VTK's node i of it is node [i] of the solid.
COLLAPSED = {
    "wedge6": (0, 1, 2, 2, 3, 4, 5, 5),
    "pyramid5": (0, 1, 2, 3, 4, 4, 4, 4),
    "tet4": (0, 1, 2, 2, 3, 3, 3, 3),
}
# The same with all nodes mirrored, so that the volume changes its sign.
MIRRORED = {
    "hex8": (4, 5, 6, 7, 0, 1, 2, 3),
    "hex20": (4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19),
    "wedge6": (3, 4, 5, 0, 1, 2),
    "wedge15": (3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14),
    "pyramid5": (0, 3, 2, 1, 4),
    "pyramid13": (0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10),
    "tet4": (0, 2, 1, 3),
    "tet10": (0, 2, 1, 3, 6, 5, 4, 7, 9, 8),
}
_CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])


def _turns() -> Ints:
    """The 24 rotations of a hexahedron's corners, (24, 8)."""
    found = []
    for axes in permutations(range(3)):
        for flips in range(8):
            signs = np.array([1 - 2 * (flips >> k & 1) for k in range(3)])
            matrix = np.eye(3, dtype=np.int64)[list(axes)] * signs[:, None]
            if round(np.linalg.det(matrix)) == 1:
                moved = (2 * _CORNERS - 1) @ matrix.T
                found.append([int(np.flatnonzero((row == 2 * _CORNERS - 1).all(axis=1))[0]) for row in moved])
    return np.array(found)


def uncollapsed(nodes: Ints) -> tuple[dict[str, tuple[Ints, Ints]], Ints]:
    """Hexahedra in VTK order with corners that coincide, (n, 8): what each of them is.

    Returns kind -> (rows, nodes), and the rows that are neither a wedge, a pyramid nor a tetrahedron.
    """
    left = np.arange(len(nodes))
    found: dict[str, tuple[list[Ints], list[Ints]]] = {kind: ([], []) for kind in COLLAPSED}
    turns = _turns()
    for kind, pattern in COLLAPSED.items():
        corners = TABLE[kind].nodes
        place = [pattern.index(k) for k in range(corners)]
        for turn in turns:
            if not len(left):
                break
            turned = nodes[left][:, turn]
            own = turned[:, place]
            ordered = np.sort(own, axis=1)
            good = (turned == own[:, list(pattern)]).all(axis=1) & (ordered[:, 1:] != ordered[:, :-1]).all(axis=1)
            found[kind][0].append(left[good])
            found[kind][1].append(own[good])
            left = left[~good]
    result = {}
    for kind, (rows, own_nodes) in found.items():
        if sum(map(len, rows)):
            all_rows, all_nodes = np.concatenate(rows), np.concatenate(own_nodes)
            order = np.argsort(all_rows)
            result[kind] = (all_rows[order], all_nodes[order])
    return result, left


def inside_out(kind: str, nodes: Ints, xyz: Floats) -> Ints:
    """Rows of the solids whose volume is negative: by the corners' Jacobian in the middle."""
    shape = TABLE[kind].shape
    pattern = COLLAPSED.get("tet4" if shape.corners == 4 else kind) if shape.corners < 8 else tuple(range(8))
    if shape.corners < 8 and pattern is None:
        pattern = COLLAPSED["wedge6" if shape.corners == 6 else "pyramid5"]
    assert pattern is not None
    signs = (2 * _CORNERS - 1).astype(np.float64)
    weights = np.zeros((shape.corners, 3))
    for k, corner in enumerate(pattern):
        weights[corner] += signs[k]
    rows = []
    for first in range(0, len(nodes), 100_000):
        points = xyz[nodes[first : first + 100_000, : shape.corners]]
        with np.errstate(over="ignore", invalid="ignore"):  # of coordinates near the largest double
            jacobian = np.einsum("nkx,kr->nrx", points, weights)
            volume = np.einsum("nx,nx->n", jacobian[:, 0], np.cross(jacobian[:, 1], jacobian[:, 2]))
        rows.append(first + np.flatnonzero(volume < 0))
    return np.concatenate([np.empty(0, np.int64), *rows])


def middle_order(kind: str, nodes: Ints, xyz: Floats) -> tuple[int, ...] | None:
    """Places of mid-edge nodes by geometry: VTK's i-th is the [i]-th of the nodes after the corners.

    PAK's order of them in prisms, pyramids and tetrahedra is not known for sure. None where the nodes do not tell.
    """
    shape = TABLE[kind].shape
    edges = np.array(shape.edges)
    points = xyz[nodes[:1000]]
    middles = points[:, edges[:, 0]] / 2 + points[:, edges[:, 1]] / 2
    with np.errstate(over="ignore", invalid="ignore"):
        distance = np.linalg.norm(middles[:, :, None] - points[:, None, shape.corners :], axis=3).mean(axis=0)
    place = distance.argmin(axis=1)
    return tuple(place.tolist()) if len(set(place.tolist())) == len(edges) else None
