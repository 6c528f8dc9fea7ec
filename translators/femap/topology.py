"""FEMAP's elements: topologies, types and face numbers.

Sources: FEMAP neutral file format 4.41, data block 404; node places and face numbers as FemCon (M. Topalovic) and
neu2fstr (FrontISTR) have them. A pressure acts into the element: a plate's face 1 is the one that its normal leaves
behind, so that the pressure pushes along the normal; faces 3 and on of a plate or a plane element are its edges.
"""

from __future__ import annotations

from dataclasses import dataclass

from zrno.translators.elements import TABLE

RIGID, RIGID_2, MULTIPLE, CONTACT, WELD = 13, 14, 15, 16, 17
LISTS = (RIGID, RIGID_2, MULTIPLE, CONTACT, WELD)

# topology -> kind, and which of the record's 20 nodes is node i in VTK's order
TOPOLOGIES: dict[int, tuple[str, tuple[int, ...]]] = {
    0: ("line2", (0, 1)),
    1: ("line3", (0, 1, 2)),
    2: ("tri3", (0, 1, 2)),
    3: ("tri6", (0, 1, 2, 4, 5, 6)),
    4: ("quad4", (0, 1, 2, 3)),
    5: ("quad8", (0, 1, 2, 3, 4, 5, 6, 7)),
    6: ("tet4", (0, 1, 2, 4)),
    7: ("wedge6", (0, 1, 2, 4, 5, 6)),
    8: ("hex8", (0, 1, 2, 3, 4, 5, 6, 7)),
    9: ("point1", (0,)),
    10: ("tet10", (0, 1, 2, 4, 8, 9, 10, 12, 13, 14)),
    11: ("wedge15", (0, 1, 2, 4, 5, 6, 8, 9, 10, 16, 17, 18, 12, 13, 14)),
    12: ("hex20", (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15)),
    18: ("pyramid5", (0, 1, 2, 3, 4)),
    19: ("pyramid13", (0, 1, 2, 3, 4, 8, 9, 10, 11, 12, 13, 14, 15)),
}
# EMSolution and others leave no gaps: told by a node where the gap would be
PACKED: dict[int, tuple[int, ...]] = {
    3: (0, 1, 2, 3, 4, 5),
    6: (0, 1, 2, 3),
    7: (0, 1, 2, 3, 4, 5),
    10: (0, 1, 2, 3, 4, 5, 6, 7, 8, 9),
    11: (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11),
}
GAP = 3
PYRAMIDS = {8: 18, 12: 19}  # bricks whose upper face is one node
NUMBERS = {kind: topology for topology, (kind, _) in TOPOLOGIES.items()}


@dataclass(frozen=True, slots=True)
class Type:
    """name: for messages; family: as `ElementBlock.family`; plane: as `Section.plane`; sure: whether it says all."""

    name: str
    family: str
    plane: str = ""
    sure: bool = True


TYPES: dict[int, Type] = {
    1: Type("rod", "truss"),
    2: Type("bar", "beam"),
    3: Type("tube", "truss"),
    4: Type("link", "truss", sure=False),
    5: Type("beam", "beam"),
    6: Type("spring", "spring"),
    7: Type("spring of one degree of freedom", "spring"),
    8: Type("curved beam", "beam", sure=False),
    9: Type("gap", "", sure=False),
    10: Type("plot only", "", sure=False),
    11: Type("shear panel", "shell", sure=False),
    12: Type("shear panel", "shell", sure=False),
    13: Type("membrane", "plane", "stress"),
    14: Type("membrane", "plane", "stress"),
    15: Type("bending plate", "shell", sure=False),
    16: Type("bending plate", "shell", sure=False),
    17: Type("plate", "shell"),
    18: Type("plate", "shell"),
    19: Type("plane strain", "plane", "strain"),
    20: Type("plane strain", "plane", "strain"),
    21: Type("laminate", "shell", sure=False),
    22: Type("laminate", "shell", sure=False),
    23: Type("axisymmetric", "plane", "axisymmetric"),
    24: Type("axisymmetric", "plane", "axisymmetric"),
    25: Type("solid", "solid"),
    26: Type("solid", "solid"),
    27: Type("mass", "mass"),
    28: Type("mass matrix", "mass", sure=False),
    29: Type("rigid", "rigid"),
    34: Type("contact", "", sure=False),
    37: Type("beam", "beam"),
}
UNKNOWN = Type("unknown", "", sure=False)
PARABOLIC = range(11, 27)  # types of areas and volumes: odd where linear, the next where parabolic
_BY_FAMILY = {"truss": 1, "beam": 2, "spring": 6, "mass": 27, "solid": 25, "tshell": 25, "shell": 17}
_BY_PLANE = {"stress": 13, "strain": 19, "axisymmetric": 23}


def type_of(kind: str, family: str, plane: str, own: int = 0) -> int:
    """The type of elements to write; own: the type that their property had in a FEMAP file, 0 where it had none."""
    element = TABLE[kind]
    if own and TYPES.get(own, UNKNOWN).family == family and fits(own, kind):
        number = own
    elif family == "plane":
        number = _BY_PLANE.get(plane, 13)
    else:
        number = _BY_FAMILY.get(family) or (27, 2, 17, 25)[element.dimension]
    if number in PARABOLIC:
        number = number - 1 + number % 2 + int(element.mid_edges)
    return number


def fits(number: int, kind: str) -> bool:
    """Whether elements of a shape can be of a type."""
    dimension = {25: 3, 26: 3, 27: 0, 28: 0}.get(number, 2 if number in PARABOLIC else 1)
    return TABLE[kind].dimension == dimension


# corners, in VTK's order, of face 1, 2, ... by the count of an element's corners and its dimension; normals point
# outwards. A pyramid's sides are not certain and left out.
_FACES: dict[tuple[int, int], tuple[tuple[int, ...], ...]] = {
    (8, 3): ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    (6, 3): ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    (4, 3): ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    (5, 3): ((0, 3, 2, 1),),
    (3, 2): ((0, 2, 1), (0, 1, 2), (0, 1), (1, 2), (2, 0)),
    (4, 2): ((0, 3, 2, 1), (0, 1, 2, 3), (0, 1), (1, 2), (2, 3), (3, 0)),
}


def faces_of(kind: str) -> tuple[tuple[int, ...], ...]:
    """The faces of a kind of element, number i + 1 at i."""
    element = TABLE[kind]
    return _FACES.get((element.shape.corners, element.dimension), ())
