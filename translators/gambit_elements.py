"""Gambit's elements: types, node orders and face numbers.

Nodes of areas are numbered around (corner, mid-edge, corner, ...), those of bricks, tetrahedra of second order and of a
pyramid's base in rows. Orders that the manual's figures leave open (wedges and pyramids of second order) are not read.
"""

from __future__ import annotations

from zrno.translators.elements import TABLE

_EDGE, _QUAD, _TRI, _BRICK, _WEDGE, _TET, _PYRAMID = range(1, 8)

# (type, count of nodes) -> name, and which of the file's nodes is node i in VTK's order
KINDS: dict[tuple[int, int], tuple[str, tuple[int, ...]]] = {
    (_EDGE, 2): ("line2", (0, 1)),
    (_EDGE, 3): ("line3", (0, 2, 1)),
    (_QUAD, 4): ("quad4", (0, 1, 2, 3)),
    (_QUAD, 8): ("quad8", (0, 2, 4, 6, 1, 3, 5, 7)),
    (_QUAD, 9): ("quad9", (0, 2, 4, 6, 1, 3, 5, 7, 8)),
    (_TRI, 3): ("tri3", (0, 1, 2)),
    (_TRI, 6): ("tri6", (0, 2, 4, 1, 3, 5)),
    (_BRICK, 8): ("hex8", (0, 1, 3, 2, 4, 5, 7, 6)),
    (_BRICK, 20): ("hex20", (0, 2, 7, 5, 12, 14, 19, 17, 1, 4, 6, 3, 13, 16, 18, 15, 8, 9, 11, 10)),
    (_BRICK, 27): ("hex27", (0, 2, 8, 6, 18, 20, 26, 24, 1, 5, 7, 3, 19, 23, 25, 21, 9, 11, 17, 15, 12, 14, 10, 16, 4,
                             22, 13)),
    (_WEDGE, 6): ("wedge6", (0, 1, 2, 3, 4, 5)),
    (_TET, 4): ("tet4", (0, 1, 2, 3)),
    (_TET, 10): ("tet10", (0, 2, 5, 9, 1, 4, 3, 6, 7, 8)),
    (_PYRAMID, 5): ("pyramid5", (0, 1, 3, 2, 4)),
}  # fmt: skip

# undoes the exchange of rows, for files that number a base around
RING_TO_ROWS = {"hex8": (0, 1, 3, 2, 4, 5, 7, 6), "pyramid5": (0, 1, 3, 2, 4)}

# corners of face 1, 2, ... by count of an element's corners and its dimension
_FACES: dict[tuple[int, int], tuple[tuple[int, ...], ...]] = {
    (3, 2): ((0, 1), (1, 2), (2, 0)),
    (4, 2): ((0, 1), (1, 2), (2, 3), (3, 0)),
    (8, 3): ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (0, 1, 2, 3), (4, 5, 6, 7)),
    (6, 3): ((0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5), (0, 1, 2), (3, 4, 5)),
    (4, 3): ((0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    (5, 3): ((0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
}


def face_nodes(kind: str, face: int) -> list[int] | None:
    """Places of the nodes of a face (from 1; of an area an edge) in VTK's order; None where there is no such face."""
    element = TABLE[kind]
    faces = _FACES.get((element.shape.corners, element.dimension), ())
    if not 0 < face <= len(faces):
        return None
    corners = faces[face - 1]
    if element.dimension == 2:
        middle = element.shape.corners + face - 1
        return [*corners, middle] if element.mid_edges else list(corners)
    place = next(i for i, other in enumerate(element.shape.faces) if set(other) == set(corners))
    cycle, centre = element.face_cycle(place)
    return [*cycle] if centre is None else [*cycle, centre]
