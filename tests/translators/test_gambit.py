from __future__ import annotations

import itertools
import random
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.elements import TABLE
from zrno.translators.gambit import read
from zrno.translators.gambit_elements import KINDS
from zrno.translators.geometry import measures
from zrno.translators.model import Model
from zrno.translators.text import InputError

SAMPLES = {
    "Maxwell2": (4, {"tri3": 2}, 2, {1: ("fluid", 2)}, {}),
    "cubeK5": (8, {"tet4": 5}, 3, {1: ("fluid", 2)}, {}),
    "kovA1": (8, {"tri3": 8}, 2, {1: ("epsilon: 1.000", 1)}, {"Inflow": [1, 2, 3, 4, 5, 6], "Outflow": [2, 3]}),
}


@pytest.mark.parametrize("name", SAMPLES)
def test_samples(shared: Path, name: str) -> None:
    model = read(shared / "samples/gambit" / f"{name}.neu")
    parts = {n: (part.name, part.material) for n, part in model.parts.items()}
    sets = {s.name: model.node_ids[s.nodes].tolist() for s in model.node_sets}
    assert (len(model.xyz), model.element_counts(), model.dimension, parts, sets) == SAMPLES[name]
    total = sum(measures(block, model.xyz).sum() for block in model.blocks)
    assert total == pytest.approx({"Maxwell2": 4.0, "cubeK5": 8.0, "kovA1": 8.0}[name])


def mesh_text(xyz: list[tuple[float, ...]], elements: list[tuple[int, int, list[int]]], more: str = "",
              first: int = 1) -> str:  # fmt: skip
    """A file of nodes numbered from `first`, and of elements (number, type, nodes from 0)."""
    lines = [
        "        CONTROL INFO 2.4.6",
        "** GAMBIT NEUTRAL FILE",
        "a mesh",
        "PROGRAM: Gambit VERSION: 2.4.6",
        "today",
    ]
    lines += ["     NUMNP     NELEM     NGRPS    NBSETS     NDFCD     NDFVL"]
    lines += ["".join(f"{n:10d}" for n in (len(xyz), len(elements), 0, 0, len(xyz[0]), len(xyz[0]))), "ENDOFSECTION"]
    lines += ["   NODAL COORDINATES 2.4.6"]
    lines += [f"{i:10d}" + "".join(f"{x:20.11e}" for x in point) for i, point in enumerate(xyz, first)]
    lines += ["ENDOFSECTION", "      ELEMENTS/CELLS 2.4.6"]
    for number, kind, nodes in elements:
        text = [f"{node + first:8d}" for node in nodes]
        head = f"{number:8d} {kind:2d} {len(nodes):2d} "
        lines += ["".join([head if i == 0 else " " * 15, *text[i : i + 7]]) for i in range(0, len(text), 7)]
    return "\n".join([*lines, "ENDOFSECTION", more])


@pytest.fixture
def load(tmp_path: Path):
    def of(*arguments, **options) -> Model:
        (tmp_path / "m.neu").write_text(mesh_text(*arguments, **options))
        return read(tmp_path / "m.neu")

    return of


def lattice(kind: str) -> list[tuple[float, ...]]:
    """Nodes in the manual's order: in rows, areas around."""
    ring = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1), (1, 1)]
    rows = [(x, y, z) for z, y, x in itertools.product(range(3), repeat=3)]
    return {
        "line3": [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)],
        "tri6": [(0, 0), (1, 0), (2, 0), (1, 1), (0, 2), (0, 1)],
        "quad8": ring[:8],
        "quad9": ring,
        "hex8": [p for p in rows if 1 not in p],
        "hex20": [p for p in rows if p.count(1) < 2],
        "hex27": rows,
        "tet10": [p for p in rows if sum(p) < 3],
        "pyramid5": [(0, 0, 0), (2, 0, 0), (0, 2, 0), (2, 2, 0), (1, 1, 2)],
    }[kind]


@pytest.mark.parametrize("kind", ["line3", "tri6", "quad8", "quad9", "hex8", "hex20", "hex27", "tet10", "pyramid5"])
def test_orders_of_nodes(load, kind: str) -> None:
    points = lattice(kind)
    number = next(pair for pair, (name, _) in KINDS.items() if name == kind)
    model = load(points, [(1, number[0], list(range(number[1])))])
    (block,) = model.blocks
    element = TABLE[kind]
    x = model.xyz[block.nodes[0]]
    assert (block.kind, model.warnings) == (kind, [])
    if element.mid_edges:
        for i, (a, b) in enumerate(element.shape.edges):
            assert np.array_equal(x[element.shape.corners + i], (x[a] + x[b]) / 2)
    for face in range(len(element.shape.faces)):
        cycle, centre = element.face_cycle(face)
        if centre is not None:
            assert np.array_equal(x[centre], x[list(cycle)].mean(axis=0))
    volume = {"line3": 0, "tri6": 2, "quad8": 4, "quad9": 4, "tet10": 4 / 3, "pyramid5": 8 / 3}.get(kind, 8)
    assert measures(block, model.xyz) == pytest.approx(volume)


@pytest.mark.parametrize("kind", ["hex8", "pyramid5"])
def test_a_base_numbered_around(load, kind: str) -> None:
    number = next(pair for pair, (name, _) in KINDS.items() if name == kind)
    points = lattice(kind)
    points[2], points[3] = points[3], points[2]
    if kind == "hex8":
        points[6], points[7] = points[7], points[6]
    model = load(points, [(1, number[0], list(range(number[1])))])
    assert measures(model.blocks[0], model.xyz) == pytest.approx(8 if kind == "hex8" else 8 / 3)
    assert f"1 {kind} elements are numbered around their faces, not in rows" in model.warnings[0]


def test_what_gmsh_writes(tmp_path: Path) -> None:
    """Each kind of solid with a boundary condition of each of some faces, as gmsh numbers them for Gambit."""
    import gmsh

    hexa, wedge, pyramid, tet = range(1, 9), range(9, 15), range(15, 20), range(20, 24)
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1),
              (3, 0, 0), (4, 0, 0), (3, 1, 0), (3, 0, 1), (4, 0, 1), (3, 1, 1),
              (6, 0, 0), (7, 0, 0), (7, 1, 0), (6, 1, 0), (6.5, 0.5, 1),
              (9, 0, 0), (10, 0, 0), (9, 1, 0), (9, 0, 1)]  # fmt: skip
    faces = [(solid[a - 1], *(solid[n - 1] for n in rest)) for solid, table in (
        (hexa, [(1, 4, 3, 2), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (1, 5, 8, 4), (5, 6, 7, 8)]),
        (wedge, [(1, 2, 5, 4), (2, 3, 6, 5), (1, 4, 6, 3), (1, 3, 2), (4, 5, 6)]),
        (pyramid, [(1, 4, 3, 2), (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)]),
        (tet, [(1, 3, 2), (1, 2, 4), (2, 3, 4), (1, 4, 3)]),
    ) for a, *rest in table]  # fmt: skip
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.addDiscreteEntity(3, 1)
        gmsh.model.mesh.addNodes(3, 1, list(range(1, 24)), np.ravel(points).tolist())
        solids = [list(some) for some in (tet, hexa, wedge, pyramid)]
        gmsh.model.mesh.addElements(3, 1, [4, 5, 6, 7], [[4], [1], [2], [3]], solids)
        gmsh.model.addPhysicalGroup(3, [1], 5, "body one")
        for i, face in enumerate(faces, 1):
            gmsh.model.addDiscreteEntity(2, i)
            gmsh.model.mesh.addElements(2, i, [2 if len(face) == 3 else 3], [[100 + i]], [list(face)])
            gmsh.model.addPhysicalGroup(2, [i], i, f"face_{i}")
        gmsh.write(str(tmp_path / "all.neu"))
    finally:
        gmsh.finalize()
    model = read(tmp_path / "all.neu")
    assert {n: part.name for n, part in model.parts.items()} == {5: "body one"}
    volumes = {block.kind: measures(block, model.xyz)[0] for block in model.blocks}
    assert volumes == pytest.approx({"tet4": 1 / 6, "hex8": 1, "wedge6": 1 / 2, "pyramid5": 1 / 3})
    assert {s.name: (s.nodes + 1).tolist() for s in model.node_sets} == {
        f"face_{i}": sorted(face) for i, face in enumerate(faces, 1)
    }
    assert model.warnings == ["20 boundary condition(s) of faces became node sets: the nodes of their faces"]


SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
QUAD = [(1, 2, [0, 1, 2, 3])]
GROUP = "       ELEMENT GROUP 2.4.6\nGROUP:          3 ELEMENTS:          1 MATERIAL:          2 NFLAGS:          1\n"
GROUP += "                           plate\n       0\n       1\nENDOFSECTION\n"
FACES = "       BOUNDARY CONDITIONS 2.4.6\n                      left side       1       1       0       6\n"
FACES += "         1    2    4\nENDOFSECTION\n"
FIXED = "       BOUNDARY CONDITIONS 2.4.6\n                           fixed       0       2       1       6\n"
FIXED += "         1  0.5\n         3  0.5\nENDOFSECTION\n"


def test_groups_and_conditions(load, tmp_path: Path) -> None:
    model = load(SQUARE, QUAD, "/ a remark\n" + GROUP + FACES + FIXED + "  TIMESTEPDATA 2.4.6\n 1\nENDOFSECTION\n")
    assert (model.title, model.version, model.dimension) == ("a mesh", "2.4.6", 2)
    assert [(p.id, p.name, p.material, p.dimension) for p in model.parts.values()] == [(3, "plate", 2, 2)]
    assert model.blocks[0].part.tolist() == [3]
    assert [(s.name, s.nodes.tolist()) for s in model.node_sets] == [("left side", [0, 3]), ("fixed", [0, 2])]
    assert [w.replace(f"{tmp_path}/", "") for w in model.warnings] == [
        "m.neu:30: boundary condition fixed: 1 value(s) of each of its 2 entries are not carried",
        "m.neu: 1 section(s) TIMESTEPDATA are not read",
        "the codes of 2 boundary condition(s) are not carried",
        "1 boundary condition(s) of faces became node sets: the nodes of their faces",
    ]


def test_numbers_that_touch(load) -> None:
    """Numbers of eight digits fill their columns."""
    first = 12345678
    hexa = lattice("hex8")
    group = GROUP.replace("       0\n       1\n", "       012345678\n")
    model = load(hexa, [(first, 4, list(range(8)))], group, first=first)
    assert model.node_ids.tolist() == list(range(first, first + 8))
    assert measures(model.blocks[0], model.xyz) == pytest.approx(8)
    assert model.blocks[0].ids.tolist() == [first]


def test_shifted_columns_and_fortran_exponents(tmp_path: Path) -> None:
    text = mesh_text(SQUARE, QUAD, GROUP).replace("e+00", "D+00").replace("       1  2  4 ", "1 2 4 ")
    (tmp_path / "m.neu").write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    model = read(tmp_path / "m.neu")
    assert model.xyz[:, :2].tolist() == [list(point) for point in SQUARE]
    assert model.blocks[0].nodes.tolist() == [[0, 1, 2, 3]]


def test_elements_of_no_group_and_of_two(load) -> None:
    second = GROUP.replace("         3 E", "         4 E").replace("plate", "again")
    model = load(SQUARE, [*QUAD, (2, 3, [0, 1, 2])], GROUP + second)
    assert {n: part.name for n, part in model.parts.items()} == {3: "plate", 4: "again", 5: "ungrouped"}
    assert [block.part.tolist() for block in model.blocks] == [[3], [5]]
    assert model.warnings == ["1 times an element belongs to a further group: it is in the part of its first"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "         4         1",
            "         5         1",
            ":14:1: error: 4 nodes where 5 are announced; expected 5 nodes",
        ),
        ("         4         1", f" {10**17}         1", "nodes where 100000000000000000 are announced"),
        ("         4         1", "         x         1", ":7:1: error: not the counts of a mesh"),
        ("1.00000000000e+00", "one", ":11:1: error: not a line of nodes"),
        ("1.00000000000e+00", "nan", ":11:1: error: a coordinate is not finite"),
        ("         2   1", "         1   1", "error: a node number stands twice (1)"),
        ("         2   1", "       2.5   1", ":11:1: error: not a whole number (2.5)"),
        ("         2   1", "        -2   1", ":11:1: error: not a node number (-2)"),
        ("       1  2  4 ", "       1  5 15 ", "elements end too early"),
        ("       1  2  4 ", "       1  8  4 ", ":16:1: error: elements of type 8 with 4 nodes are not read"),
        ("       3       4\n", "       3       9\n", "element 1 has a node that is not there (9)"),
        ("       3       4\n", "       3       x\n", ":16:1: error: not a whole number (x)"),
        ("GROUP:", "GRUPPE:", "error: not the heading of a group"),
        ("       0\n       1\n", "       0\n       8\n", "error: an element is not there (8)"),
        ("ELEMENTS:          1", "ELEMENTS:          7", "error: a group of another length than announced"),
        ("         1    2    4", "         1    2    5", ":26:1: error: a quad4 element has no such face (5)"),
        ("         1    2    4", "         9    2    4", "error: an element is not there (9)"),
        ("       1       1       0       6", "       7       1       0       6", "condition of this type is not read"),
        ("    2    4\nENDOFSECTION\n", "    2    4\n", ":27:1: error: the file ends inside BOUNDARY CONDITIONS"),
    ],
)
def test_faults(faults, old: str, new: str, said: str) -> None:
    text = mesh_text(SQUARE, QUAD, GROUP + FACES)
    assert old in text
    lines = faults(read, text.replace(old, new, 1), name="m.neu")
    assert said in lines[0], lines


def test_broken_files(tmp_path: Path) -> None:
    whole = mesh_text(lattice("hex8"), [(1, 4, list(range(8))), (2, 3, [0, 1, 2])], GROUP + FACES + FIXED).encode()
    numbers = random.Random(1)
    broken = [whole[:end] for end in range(0, len(whole), 3)]
    words = [
        b"-1",
        b"0",
        b"9" * 18,
        b"9" * 30,
        b"nan",
        b"1e400",
        b"1.5",
        b"\0",
        b"\xff",
        b"\n",
        b"/",
        b"ENDOFSECTION\n",
    ]
    for _ in range(600):
        data = bytearray(whole)
        at = numbers.randrange(len(data))
        data[at : at + numbers.choice((1, 8))] = numbers.choice(words)
        broken.append(bytes(data))
    for data in broken:
        (tmp_path / "m.neu").write_bytes(data)
        with suppress(InputError):
            read(tmp_path / "m.neu")
