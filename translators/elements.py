"""The elements: one table of names, node counts, numbers and node orders.

Nodes are in VTK's order everywhere in the project: corners, then mid-edge nodes in the order of `Shape.edges`, then
mid-face nodes in the order of `Shape.faces`, then the centre. (VTK file formats 4.2, figures 2 and 3; gmsh manual,
"Node ordering".)
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Shape:
    """What elements of one shape share. edges: corner pairs; faces: corner cycles."""

    dimension: int
    corners: int
    edges: tuple[tuple[int, int], ...] = ()
    faces: tuple[tuple[int, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Element:
    """A row of the table.

    gmsh, vtk: type numbers; from_gmsh: node i in VTK's order is node from_gmsh[i] in gmsh's (empty: the same order);
    mid_edges, mid_faces: whether it has those nodes; meshio: its name there.
    """

    name: str
    shape: Shape
    nodes: int
    gmsh: int
    vtk: int
    meshio: str
    from_gmsh: tuple[int, ...] = ()
    mid_edges: bool = False
    mid_faces: bool = False

    @property
    def dimension(self) -> int:
        """0 point, 1 line, 2 area, 3 volume."""
        return self.shape.dimension

    def face_cycle(self, face: int) -> tuple[tuple[int, ...], int | None]:
        """A face's border nodes in turn (corner, mid-edge, corner, ...) and its centre node or None.

        An area has one face, itself.
        """
        shape = self.shape
        corners = shape.faces[face] if shape.faces else tuple(range(shape.corners))
        cycle: list[int] = []
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            cycle.append(a)
            if self.mid_edges:
                edge = next(i for i, pair in enumerate(shape.edges) if set(pair) == {a, b})
                cycle.append(shape.corners + edge)
        centre = None
        if self.mid_faces and len(corners) == 4:
            quads = [i for i, f in enumerate(shape.faces) if len(f) == 4] or [0]
            centre = shape.corners + len(shape.edges) + quads.index(face)
        return tuple(cycle), centre


_POINT = Shape(0, 1)
_LINE = Shape(1, 2, ((0, 1),))
_TRI = Shape(2, 3, ((0, 1), (1, 2), (2, 0)))
_QUAD = Shape(2, 4, ((0, 1), (1, 2), (2, 3), (3, 0)))
_TET = Shape(3, 4, ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)))
_PYRAMID = Shape(
    3,
    5,
    ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
    ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
)
_WEDGE = Shape(
    3,
    6,
    ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
    ((0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5), (0, 2, 1), (3, 4, 5)),
)
_HEX = Shape(
    3,
    8,
    ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)),
    ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)),
)

_HEX20_FROM_GMSH = (0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)
_WEDGE15_FROM_GMSH = (0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11)

TABLE: dict[str, Element] = {
    e.name: e
    for e in (
        Element("point1", _POINT, 1, 15, 1, "vertex"),
        Element("line2", _LINE, 2, 1, 3, "line"),
        Element("line3", _LINE, 3, 8, 21, "line3", mid_edges=True),
        Element("tri3", _TRI, 3, 2, 5, "triangle"),
        Element("tri6", _TRI, 6, 9, 22, "triangle6", mid_edges=True),
        Element("quad4", _QUAD, 4, 3, 9, "quad"),
        Element("quad8", _QUAD, 8, 16, 23, "quad8", mid_edges=True),
        Element("quad9", _QUAD, 9, 10, 28, "quad9", mid_edges=True, mid_faces=True),
        Element("tet4", _TET, 4, 4, 10, "tetra"),
        Element("tet10", _TET, 10, 11, 24, "tetra10", (0, 1, 2, 3, 4, 5, 6, 7, 9, 8), mid_edges=True),
        Element("pyramid5", _PYRAMID, 5, 7, 14, "pyramid"),
        Element(
            "pyramid13", _PYRAMID, 13, 19, 27, "pyramid13", (0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12), mid_edges=True
        ),
        Element("wedge6", _WEDGE, 6, 6, 13, "wedge"),
        Element("wedge15", _WEDGE, 15, 18, 26, "wedge15", _WEDGE15_FROM_GMSH, mid_edges=True),
        Element(
            "wedge18", _WEDGE, 18, 13, 32, "wedge18", (*_WEDGE15_FROM_GMSH, 15, 17, 16), mid_edges=True, mid_faces=True
        ),
        Element("hex8", _HEX, 8, 5, 12, "hexahedron"),
        Element("hex20", _HEX, 20, 17, 25, "hexahedron20", _HEX20_FROM_GMSH, mid_edges=True),
        Element(
            "hex27",
            _HEX,
            27,
            12,
            29,
            "hexahedron27",
            (*_HEX20_FROM_GMSH, 22, 23, 21, 24, 20, 25, 26),
            mid_edges=True,
            mid_faces=True,
        ),
    )
}
BY_GMSH = {e.gmsh: e for e in TABLE.values()}
BY_MESHIO = {e.meshio: e for e in TABLE.values()}
