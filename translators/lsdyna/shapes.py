"""What solids with repeated nodes are: tetrahedra, pyramids, wedges; and where mid-nodes of large elements stand.

A hexahedron whose nodes coincide is found by the faces that are left: three or four of different corners. So every way
to write a degenerate solid is understood, and all of one pattern are turned at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import TABLE
from zrno.translators.model import Floats, Ints

_HEX_FACES = TABLE["hex8"].shape.faces
# A degenerate hexahedron repeats a node along an edge.
_HEX_EDGES = TABLE["hex8"].shape.edges

# LS-DYNA's order of mid-nodes in VTK's places: bottom edges, vertical edges, top edges.
_MANY = 50_000  # solids: with so many the jitted loop pays for its loading
_HEX20 = (*range(8), 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15)


@lru_cache(maxsize=1000)
def _collapsed(pattern: tuple[int, ...]) -> tuple[str, tuple[int, ...]] | None:
    """Kind, and which of the eight nodes are its nodes in VTK's order; None where it is no solid that we know.

    pattern: for each node the first place of the same node.
    """
    if pattern == (0, 1, 2, 3, 3, 3, 3, 3):  # its apex is a corner of what would be the base
        return "tet4", (0, 1, 2, 3)
    faces = []
    for face in _HEX_FACES:
        around = [pattern[i] for i in face]
        cycle = [node for i, node in enumerate(around) if node != around[i - 1]]
        if len(set(cycle)) >= 3:
            if len(set(cycle)) != len(cycle):
                return None
            faces.append(tuple(cycle))
    corners, sides = len(set(pattern)), sorted(len(face) for face in faces)
    triangles = [face for face in faces if len(face) == 3]
    quads = [face for face in faces if len(face) == 4]
    # faces look outward, the base of a VTK cell inward: it is turned round
    if corners == 4 and sides == [3, 3, 3, 3]:
        base = _from_smallest(triangles[0][::-1])
        apex = (set(pattern) - set(base)).pop()
        return "tet4", (*base, apex)
    if corners == 5 and sides == [3, 3, 3, 3, 4]:
        base = _from_smallest(quads[0][::-1])
        apex = (set(pattern) - set(base)).pop()
        return "pyramid5", (*base, apex)
    if corners == 6 and sides == [3, 3, 4, 4, 4] and not set(triangles[0]) & set(triangles[1]):
        base = _from_smallest(min(triangles)[::-1])
        top = []
        for node in base:
            neighbours = {
                quad[(quad.index(node) + step) % 4] for quad in quads if node in quad for step in (1, -1)
            } - set(base)
            if len(neighbours) != 1:
                return None
            top.append(neighbours.pop())
        return "wedge6", (*base, *top)
    return None


def _from_smallest(cycle: tuple[int, ...]) -> tuple[int, ...]:
    start = cycle.index(min(cycle))
    return cycle[start:] + cycle[:start]


# How a solid is written with eight nodes: the first place of each place's node.
_WRITTEN = {
    "hex8": tuple(range(8)), "tet4": (0, 1, 2, 3, 3, 3, 3, 3), "pyramid5": (0, 1, 2, 3, 4, 4, 4, 4),
    "wedge6": (0, 1, 2, 3, 4, 4, 6, 6),
}  # fmt: skip
_THICK_WEDGE = (0, 1, 2, 2, 4, 5, 6, 6)


def eight_nodes(kind: str, *, thick: bool = False) -> tuple[int, ...]:
    """How a shell or a solid stands in eight places: place i holds its node eight[i] (in VTK's order)."""
    pattern = _THICK_WEDGE if thick and kind == "wedge6" else _WRITTEN[kind]
    shape = ("hex8", pattern) if kind == "hex8" else _collapsed(pattern)
    assert shape is not None
    return tuple(shape[1].index(first) for first in pattern)


def split_solids(nodes: Ints) -> Iterator[tuple[str, Ints | None, Ints]]:
    """The shapes among solids of eight nodes: kind, which of them (None: all), and their nodes in VTK's order.

    nodes: (n, 8) numbers; a last four of zeros means a tetrahedron. What no shape fits stays "hex8".
    """
    if len(nodes) and nodes.min() <= 0:
        zero = (nodes[:, 4:] == 0).all(axis=1)
        nodes = nodes.copy()
        nodes[zero, 4:] = nodes[zero, 3:4]
    odd = _repeated(nodes)
    places = np.flatnonzero(odd)
    if not len(places):
        yield "hex8", None, nodes
        return
    some = nodes[places]
    first = np.argmax(some[:, :, None] == some[:, None, :], axis=2)
    code = first @ 8 ** np.arange(8)
    plain = [np.flatnonzero(~odd)]
    found: dict[str, list[tuple[Ints, Ints]]] = {}
    for value in np.unique(code).tolist():
        which = np.flatnonzero(code == value)
        shape = _collapsed(tuple(first[which[0]].tolist()))
        if shape is None:
            plain.append(places[which])
        else:
            found.setdefault(shape[0], []).append((places[which], some[which][:, list(shape[1])]))
    rest = np.sort(np.concatenate(plain))
    if len(rest):
        yield "hex8", rest, nodes[rest]
    for kind, parts in found.items():
        which = np.concatenate([p for p, _ in parts])
        turned = np.concatenate([n for _, n in parts])
        order = np.argsort(which, kind="stable")
        yield kind, which[order], turned[order]


def _repeated(nodes: Ints) -> NDArray[np.bool_]:
    if len(nodes) > _MANY:
        from zrno.translators.lsdyna.kernels import repeated

        return repeated(nodes, np.array(_HEX_EDGES))
    odd = np.zeros(len(nodes), bool)
    for a, b in _HEX_EDGES:
        odd |= nodes[:, a] == nodes[:, b]
    return odd


def default_order(kind: str) -> tuple[int, ...]:
    """Where VTK's nodes stand in LS-DYNA's order: node i of VTK is node order[i] of LS-DYNA."""
    if kind in ("hex20", "hex27"):
        return (*_HEX20, *range(20, TABLE[kind].nodes))
    return tuple(range(TABLE[kind].nodes))


def order_by_place(kind: str, points: Floats) -> tuple[int, ...] | None:
    """The order of mid-nodes as their places tell it; None where the places fit no order, or the default fits too.

    points: (n, k, 3) nodes in LS-DYNA's order. Each mid-node is sought nearest to the middle of its edge or face.
    """
    element = TABLE[kind]
    corners = element.shape.corners
    wanted = [points[:, list(edge)].mean(axis=1) for edge in element.shape.edges]
    if element.mid_faces:
        faces = [face for face in element.shape.faces if kind == "hex27" or len(face) == 4]
        wanted += [points[:, list(face)].mean(axis=1) for face in faces]
    if kind == "hex27":
        wanted.append(points[:, :corners].mean(axis=1))
    target = np.stack(wanted, axis=1)
    middle = points[:, corners:]
    distance = ((target[:, :, None] - middle[:, None, :]) ** 2).sum(axis=3).sum(axis=0)
    nearest = distance.argmin(axis=1)
    default = np.array(default_order(kind)[corners:]) - corners
    rows = np.arange(len(default))
    if (
        len(set(nearest.tolist())) != len(nearest)
        or distance[rows, nearest].sum() >= 0.99 * distance[rows, default].sum()
    ):
        return None
    return (*range(corners), *(nearest + corners).tolist())
