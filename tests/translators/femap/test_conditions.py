"""Constraints and loads of both generations, read by eye from texts."""

from __future__ import annotations

import numpy as np
import pytest

from zrno.translators.femap import read, write
from zrno.translators.model import Model

END_NODES, END_RELATIONS = "-1,-1,-1,0,0,0,0,0,0,", "-1,-1,-1,"


def held(model: Model) -> list[tuple[int, str, int, list[int], list[list[int]]]]:
    return [
        (c.id, c.name, c.system, model.node_ids[c.nodes].tolist(), c.dofs.astype(int).tolist())
        for c in model.constraints
    ]


SETS = [
    "1,", "clamped", "2,120,1,1,1,1,0,0,0,", "1,120,1,1,1,1,0,0,0,", "3,120,1,0,0,1,0,0,0,", "99,120,1,1,0,0,0,0,0,",
]  # fmt: skip
RELATION = ["7,120,1,", "2,", "1,1,1.,", "2,3,-0.5,"]


def test_406(neu, load) -> None:
    second = ["2,", "<NULL>", END_NODES, END_RELATIONS, "5,", "last", "4,120,1,0,0,0,0,0,1,", END_NODES, END_RELATIONS]
    text = neu.block(406, *SETS, END_NODES, *RELATION, END_RELATIONS, *second)
    model = load(neu.MESH + text)
    assert held(model) == [
        (1, "clamped", 0, [2, 1], [[1, 1, 1, 0, 0, 0]] * 2),
        (1, "clamped", 0, [3], [[0, 0, 1, 0, 0, 0]]),
        (5, "last", 0, [4], [[0, 0, 0, 0, 0, 1]]),
    ]
    (relation,) = model.equations
    assert (relation.id, relation.nodes.tolist(), relation.dofs.tolist()) == (7, [0, 1], [1, 3])
    assert relation.coefficients.tolist() == [1.0, -0.5]
    assert model.warnings[1:] == [
        "m.neu: 1 constraints of nodes that are not there are not read",
        "m.neu: 3 constraint sets: all are read, where a run of FEMAP has one of them",
    ]


@pytest.mark.parametrize(
    ("version", "more"),
    [
        ("8.3", []),
        ("9.3", ["-1,0,0,", "1,2,3,", "-1,-1,0,", "-1,0,0,"]),
        ("10.3", ["-1,-1,-1,0,", "-1,0,0,"]),
    ],
)
def test_506(neu, load, version: str, more: list[str]) -> None:
    geometry = ["3,120,1,1,1,1,0,0,0,0,", "-1,-1,-1,0,0,0,0,0,0,0,"]
    ends = ["-1,-1,-1,0,0,0,0,0,0,0,"]
    text = neu.block(506, *(line + "0," for line in SETS[:1]), *SETS[1:5], *ends, *geometry, *ends, *ends, *RELATION,
                     "-1,-1,-1,0,", *more, "2,", "second", "4,120,1,0,1,0,0,0,0,0,", *ends * 4, "-1,-1,-1,0,",
                     *more)  # fmt: skip
    text = text.replace("1,0,\nclamped", "1,\nclamped")
    model = load(neu.MESH + text, version)
    assert [row[:2] + row[3:4] for row in held(model)] == [
        (1, "clamped", [2, 1]),
        (1, "clamped", [3]),
        (2, "second", [4]),
    ]
    assert len(model.equations) == 1
    assert "m.neu: 1 constraints on geometry are not read" in model.warnings
    assert ("m.neu: 2 lines behind the constraints are not read" in model.warnings) == (len(more) == 4)


def test_systems_of_nodes(neu, load, tmp_path, same) -> None:
    """A node's constraints act in its output system."""
    systems = neu.block(405, "3,0,0,60,1,", "s", "0.,0.,0.,", "0.,0.,45.,")
    held_nodes = neu.block(406, *SETS[:5], END_NODES, END_RELATIONS)
    model = load(neu.nodes(neu.CUBE, {1: 3}) + neu.block(404, *neu.BRICK) + systems + held_nodes)
    assert [row[2:4] for row in held(model)] == [(0, [2]), (3, [1]), (0, [3])]
    assert not write(model, tmp_path / "o.neu")
    assert same(read(tmp_path / "o.neu").constraints, model.constraints)


def load_407(node: int, kind: int, pairs: list[tuple[int, float]], system: int = 0, function: int = 0) -> list[str]:
    filled = pairs + [(0, 0.0)] * (6 - len(pairs))
    return [f"{node},{kind},10,1,{system},{function},", "0.,0.,", *(f"{flag},{value!r}," for flag, value in filled),
            "0.,0,0,0,", "0,0,0,0,0,0,0,", "0,0,0,", "0.,0.,0.,"]  # fmt: skip


def load_507(node: int, kind: int, flags: list[int], values: list[float], function: int = 0) -> list[str]:
    return [f"{node},{kind},10,1,0,0,0,", "".join(f"{f}," for f in (*flags, 0, 0, 0)[:3]),
            "".join(f"{v!r}," for v in (*values, 0.0, 0.0, 0.0, 0.0)[:5]), f"{function},0,0,0,0,", "0,0,0,0,0,",
            "0,0,0,", "0.,0.,0.,"]  # fmt: skip


HEAT = ["0.,0.,0.,", "0.,0.,0.,0.,", "0.,0.,0.,0.,", "0,0,0,", "0,0,0,"]
OPTIONS = ["0.,0.,0.,0.,", "0.,0.,0.,", "0.,0.,0.,0.,0.,0.,", "0.,0.,0.,0.,0.,0.,", "0,0,0,0,0,0,0,0,0,",
           "0,0,0,0,0,0,0,0,", "0,0,0,0,0,0,0,", "0,0,0,0,0,0,0,", "0,0,0,0,0,"]  # fmt: skip


def heading(gravity: bool = True, number: int = 1, options: int = 9) -> list[str]:
    return [f"{number},", f"set {number}", f"0,20.,0,{int(gravity)},0,", "0.,0.,-9.81,0,0,2,", "0.,0.,0.,0,0,0,",
            "0.,0.,0.,", "0.,0.,0.,", *HEAT, *OPTIONS[9 - options :]]  # fmt: skip


def seen(model: Model) -> list[tuple[str, list[tuple[int, int, float]], int | None]]:
    return [
        (n.kind, list(zip(model.node_ids[n.nodes].tolist(), n.dofs.tolist(), n.values.tolist(), strict=True)), n.curve)
        for n in model.nodal_loads
    ]


EXPECTED = [
    ("force", [(2, 1, 10.0), (2, 3, -5.5), (3, 2, 1.25), (3, 5, 7.0)], None),
    ("force", [(4, 1, 3.0)], 2),
    ("displacement", [(1, 1, 0.001)], None),
    ("velocity", [(1, 3, 4.0)], None),
    ("acceleration", [(1, 2, 6.0)], None),
    ("temperature", [(5, 0, 300.0), (6, 0, 310.0)], None),
]
TEMPERATURES = ["5,10,1,300.,0.,0,", "6,10,1,310.,0.,0,", "-1,-1,-1,0.,0.,0,", "1,10,1,5.,0.,0,", "-1,-1,-1,0.,0.,0,"]


@pytest.mark.parametrize("options", [9, 8, 6])
def test_407(neu, load, options: int) -> None:
    loads = [*load_407(2, 1, [(1, 10.0), (0, 0.0), (1, -5.5)]), *load_407(1, 2, [(1, 0.001)]),
             *load_407(3, 1, [(0, 0.0), (1, 1.25), (0, 0.0), (0, 0.0), (1, 7.0)]),
             *load_407(4, 1, [(1, 3.0)], function=2), *load_407(1, 7, [(0, 0.0), (0, 0.0), (1, 4.0)]),
             *load_407(1, 3, [(0, 0.0), (1, 6.0)]), *load_407(1, 11, [(3, 2.5)], function=2),
             *load_407(1, 15, [(1, 1.0)]), *load_407(77, 1, [(1, 1.0)]), "-1,-1,-1,-1,-1,", *TEMPERATURES]  # fmt: skip
    text = neu.block(407, *heading(options=options), *loads)
    model = load(neu.MESH + text + neu.block(420, "2,1,", "f", "1,0.,1.,", "-1,0.,0.,"))
    check(model)
    assert model.face_loads[0].curve == 2
    assert model.body_loads[0].curve == 2
    assert model.warnings[1:] == [
        "m.neu: 1 temperatures of elements: not read",
        "m.neu: 1 loads on nodes that are not there: not read",
        "m.neu: 1 convection: not read",
    ]


@pytest.mark.parametrize("more", [[], ["-1,-1,", "1,2,", "-1,0,0,"]])
def test_507(neu, load, more: list[str]) -> None:
    loads = [*load_507(2, 1, [1, 0, 1], [10.0, 0.0, -5.5]), *load_507(1, 3, [1], [0.001]),
             *load_507(3, 1, [0, 1, 0], [0.0, 1.25]), *load_507(3, 2, [0, 1], [0.0, 7.0]),
             *load_507(4, 1, [1], [3.0], function=2), *load_507(1, 5, [0, 0, 1], [0.0, 0.0, 4.0]),
             *load_507(1, 7, [0, 1], [0.0, 6.0]), *load_507(1, 42, [3], [2.5], function=2),
             "-1,-1,-1,-1,-1,-1,0,"]  # fmt: skip
    geometric = ["1,42,10,1,0,0,0,", "text of any kind", "-1.,0.,0.,", "-1,-1,-1,-1,-1,-1,0,"]
    text = neu.block(507, *heading(), *loads, *geometric, *TEMPERATURES, *more,
                     *heading(False, 2), *["-1,-1,-1,-1,-1,-1,0,"] * 2, *["-1,-1,-1,0.,0.,0,"] * 2)  # fmt: skip
    model = load(neu.MESH + text, "10.0")
    check(model)
    assert "m.neu: 3 lines of loads on geometry: not read" in model.warnings
    assert "m.neu: 1 gravity that is switched off: not read" in model.warnings
    assert "m.neu: 2 load sets: all are read, where a run of FEMAP has one of them" in model.warnings


def check(model: Model) -> None:
    merged = {(kind, curve): [] for kind, _, curve in EXPECTED}
    for kind, rows, curve in seen(model):
        merged[kind, curve] += rows
    assert {key: sorted(rows) for key, rows in merged.items()} == {(k, c): sorted(rows) for k, rows, c in EXPECTED}
    assert [load.acceleration for load in model.body_loads] == [(0.0, 0.0, -9.81)]
    (face,) = model.face_loads
    assert (face.values.tolist(), face.direction, face.name) == ([[2.5]], 0, "set 1")
    assert model.node_ids[face.faces].tolist() == [[1, 2, 6, 5]]  # y = 0: its normal points out of the brick


@pytest.mark.parametrize("kind", ["hex8", "wedge6", "tet4"])
def test_faces_point_outwards(kind: str) -> None:
    from zrno.translators.elements import TABLE
    from zrno.translators.femap.topology import faces_of

    x = {"hex8": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
         "wedge6": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
         "tet4": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]}[kind]  # fmt: skip
    points = np.array(x, float)
    faces = faces_of(kind)
    assert {frozenset(f) for f in faces} == {frozenset(f) for f in TABLE[kind].shape.faces}
    for face in faces:
        a, b, c = points[list(face[:3])]
        assert np.cross(b - a, c - b) @ (points[list(face)].mean(axis=0) - points.mean(axis=0)) > 0


def test_pressures_on_plates_and_edges(neu, load) -> None:
    """Face 1 pushes along the normal, face 2 against it, from 3 on edges."""
    loads = [line for face in (1, 2, 3, 6) for line in load_407(2, 11, [(face, float(face))])]
    mesh = neu.nodes(neu.CUBE) + neu.block(404, *neu.element(2, 17, 4, [1, 2, 3, 4]))
    model = load(mesh + neu.block(407, *heading(False), *loads, "-1,-1,-1,-1,-1,", *["-1,-1,-1,0.,0.,"] * 2))
    faces = np.append(model.node_ids, -1)[model.face_loads[0].faces].tolist()
    assert faces == [[1, 4, 3, 2], [1, 2, 3, 4], [1, 2, -1, -1], [4, 1, -1, -1]]
    assert model.face_loads[0].values.tolist() == [[1.0], [2.0], [3.0], [6.0]]
