"""Layouts of .msh that gmsh writes no more, or on other machines: built here number by number."""

from __future__ import annotations

import random
import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from zrno.translators.gmsh import read
from zrno.translators.gmsh.numbers import Encoding, Numbers
from zrno.translators.model import Model
from zrno.translators.text import Faults

NAMES = b'$PhysicalNames\n2\n2 7 "plate"\n1 3 "rim"\n$EndPhysicalNames\n'


class Sheet:
    """Sections of numbers as text ("") or as bytes of an order; i: 4-byte integers, n: size_t, d: doubles."""

    def __init__(self, version: str, order: str, size: int = 8) -> None:
        self.order, self.size = order, size
        one = struct.pack(order + "i", 1) + b"\n" if order else b""
        self.data = f"$MeshFormat\n{version} {int(bool(order))} {size}\n".encode() + one + b"$EndMeshFormat\n" + NAMES

    def section(self, name: str, *parts: tuple[str, list[float]], count: int | None = None) -> None:
        self.data += f"${name}\n".encode() + (b"" if count is None else b"%d\n" % count)
        for kind, numbers in parts:
            if self.order:
                letter = {"n": "Q" if self.size == 8 else "I"}.get(kind, kind)
                self.data += struct.pack(f"{self.order}{len(numbers)}{letter}", *numbers)
            else:
                self.data += " ".join(map(repr, numbers)).encode() + b"\n"
        self.data += f"\n$End{name}\n".encode()

    def read(self, folder: Path) -> Model:
        (folder / "m.msh").write_bytes(self.data)
        return read(folder / "m.msh")


NODES = [(11, 0.0, 0.0), (25, 1.0, 0.0), (12, 1.0, 1.0), (13, 0.0, 1.0)]


def check(model: Model) -> None:
    """Two triangles of a plate with a rim of one line."""
    assert model.node_ids.tolist() == [11, 25, 12, 13]
    assert model.xyz.tolist() == [[x, y, 0.0] for _, x, y in NODES]
    assert model.element_counts() == {"tri3": 2, "line2": 1}
    assert model.blocks[0].nodes.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert model.blocks[0].ids.tolist() == [31, 32]
    assert model.blocks[0].part.tolist() == [7, 7]
    assert (model.dimension, model.parts[7].name) == (2, "plate")
    assert [(s.name, s.nodes.tolist()) for s in model.node_sets] == [("rim", [0, 1]), ("plate", [0, 1, 2, 3])]


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("partitioned", [False, True])
@pytest.mark.parametrize("version", ["4", "4.0"])
def test_version_4_0(tmp_path: Path, order: str, partitioned: bool, version: str) -> None:
    sheet = Sheet(version, order)
    box = ("d", [0.0, 0.0, 0.0, 1.0, 1.0, 0.0])
    groups: list[tuple[str, list[float]]] = [
        ("n", [1, 1, 1, 0]), ("i", [1]), box, ("n", [0]),  # a point has a box too
        ("i", [1]), box, ("n", [1]), ("i", [3]), ("n", [2]), ("i", [1, -1]),
        ("i", [1]), box, ("n", [1]), ("i", [7]), ("n", [0]),
    ]  # fmt: skip
    sheet.section("Entities", *groups)
    surface = 1
    if partitioned:
        surface = 2
        sheet.section(
            "PartitionedEntities", ("i", [2, 1]), ("i", [9, 1]), ("n", [0, 0, 2, 0]),
            ("i", [2, 2, 1, 1, 1]), box, ("n", [0]), ("n", [0]),
            ("i", [3, 2, 1, 1, 2]), box, ("n", [0]), ("n", [1]), ("i", [1]),
        )  # fmt: skip
    rows = [part for tag, x, y in NODES[1:] for part in (("i", [tag]), ("d", [x, y, 0.0, 0.25, 0.5]))]
    sheet.section("Nodes", ("n", [2, 4]), ("i", [1, 0, 0]), ("n", [1]), ("i", [11]), ("d", [0.0, 0.0, 0.0]),
                  ("i", [surface, 2, 1]), ("n", [3]), *rows)  # fmt: skip
    sheet.section("Elements", ("n", [3, 3]), ("i", [surface, 2, 2]), ("n", [1]), ("i", [31, 11, 25, 12]),
                  ("i", [surface + partitioned, 2, 2]), ("n", [1]), ("i", [32, 11, 12, 13]),
                  ("i", [1, 1, 1]), ("n", [1]), ("i", [33, 11, 25]))  # fmt: skip
    model = sheet.read(tmp_path)
    check(model)
    assert (model.version, model.warnings) == ("4.0", [])


@pytest.mark.parametrize("size", [8, 4])
@pytest.mark.parametrize("order", ["", "<", ">"])
def test_version_4_1(tmp_path: Path, order: str, size: int) -> None:
    sheet = Sheet("4.1", order, size)
    box = ("d", [0.0, 0.0, 0.0, 1.0, 1.0, 0.0])
    groups: list[tuple[str, list[float]]] = [
        ("n", [1, 1, 1, 0]), ("i", [1]), ("d", [0.0, 0.0, 0.0]), ("n", [0]),
        ("i", [1]), box, ("n", [1]), ("i", [3]), ("n", [2]), ("i", [1, -1]),
        ("i", [1]), box, ("n", [1]), ("i", [-7]), ("n", [0]),
    ]  # fmt: skip
    sheet.section("Entities", *groups)
    points = [number for _, x, y in NODES for number in (x, y, 0.0, 0.25, 0.5)]
    sheet.section("Nodes", ("n", [1, 4, 11, 25]), ("i", [2, 1, 1]), ("n", [4]), ("n", [n[0] for n in NODES]),
                  ("d", points))  # fmt: skip
    sheet.section("Elements", ("n", [2, 3, 31, 33]), ("i", [2, 1, 2]), ("n", [2]), ("n", [31, 11, 25, 12]),
                  ("n", [32, 11, 12, 13]), ("i", [1, 1, 1]), ("n", [1]), ("n", [33, 11, 25]))  # fmt: skip
    sheet.section("Periodic", ("n", [1]), ("i", [1, 1, 1]), ("n", [0, 1]), ("n", [11, 25]))
    sheet.section("GhostElements", ("n", [1]), ("n", [31]), ("i", [1]), ("n", [1]), ("i", [2]))
    sheet.section("NodeData", ("n", [1]))
    sheet.section("NodeData", ("n", [1]))
    model = sheet.read(tmp_path)
    check(model)
    said = [warning.partition(" $")[2] for warning in model.warnings]
    assert said == [
        "Periodic is skipped: links of periodic nodes are not carried",
        "GhostElements is skipped: ghost elements are not carried: each element is read once",
        "NodeData (2 sections) is skipped: not part of a mesh",
    ]


@pytest.mark.parametrize("version", ["2", "2.0", "2.1", "2.2"])
@pytest.mark.parametrize("order", ["", "<", ">"])
def test_version_2(tmp_path: Path, version: str, order: str) -> None:
    """Rows of different counts of tags: with partitions (a ghost's is negative), with a group alone."""
    sheet = Sheet(version, order)
    rows = [part for tag, x, y in NODES for part in (("i", [tag]), ("d", [x, y, 0.0]))]
    sheet.section("Nodes", *rows, count=4)
    if order:
        sheet.section("Elements", ("i", [2, 1, 5]), ("i", [31, 7, 1, 2, 1, -2, 11, 25, 12]), ("i", [2, 1, 1]),
                      ("i", [32, 7, 11, 12, 13]), ("i", [1, 1, 2]), ("i", [33, 3, 1, 11, 25]), count=3)  # fmt: skip
    else:
        sheet.section("Elements", ("i", [31, 2, 5, 7, 1, 2, 1, -2, 11, 25, 12]), ("i", [32, 2, 1, 7, 11, 12, 13]),
                      ("i", [33, 1, 2, 3, 1, 11, 25]), count=3)  # fmt: skip
    check(sheet.read(tmp_path))
    if not order:
        sheet.data = sheet.data.replace(b"\n", b"\r\n")
        check(sheet.read(tmp_path))


@pytest.mark.parametrize("order", ["", "<"])
def test_many_rows_that_differ(tmp_path: Path, order: str) -> None:
    """Runs of rows alike, and rows that change their type and tags at random, keep their order."""
    numbers = random.Random(3)
    sheet = Sheet("2.2", order)
    sheet.section("Nodes", *[p for tag, x, y in NODES for p in (("i", [tag]), ("d", [x, y, 0.0]))], count=4)
    rows: list[tuple[str, list[float]]] = []
    wanted: dict[int, list[tuple[int, list[int]]]] = {1: [], 2: []}
    for i in range(1, 4000):
        kind, tags = (numbers.choice((1, 2)), numbers.randrange(5)) if i % 1000 > 300 else (2, 2)
        nodes = numbers.sample([11, 25, 12, 13], kind + 1)
        while wanted[kind] and wanted[kind][-1][1] == nodes:  # would be one element of two groups
            nodes = numbers.sample([11, 25, 12, 13], kind + 1)
        wanted[kind].append((i, nodes))
        groups = [7 + i % 2, *[1] * (tags - 1)] if tags else []
        rows.append(("i", [kind, 1, tags, i, *groups, *nodes] if order else [i, kind, tags, *groups, *nodes]))
    sheet.section("Elements", *rows, count=len(rows))
    model = sheet.read(tmp_path)
    for block, kind in zip(sorted(model.blocks, key=lambda b: b.kind), (1, 2), strict=True):
        assert block.ids.tolist() == [i for i, _ in wanted[kind]]
        assert model.node_ids[block.nodes].tolist() == [nodes for _, nodes in wanted[kind]]


def partitioned(gmsh, folder: Path, version: float, binary: int) -> Model:
    gmsh.model.add("box")
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [1], 5, "body")
    gmsh.model.addPhysicalGroup(2, [1], 6, "wall")
    gmsh.model.mesh.setPeriodic(2, [2], [1], [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 1)
    gmsh.model.mesh.generate(3)
    counts = [len(gmsh.model.mesh.getElementsByType(4)[0]), len(gmsh.model.mesh.getNodes()[0])]
    gmsh.model.mesh.partition(3)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(str(folder / "parts.msh"))
    model = read(folder / "parts.msh")
    assert [model.element_counts()["tet4"], len(model.xyz)] == counts
    return model


@pytest.mark.parametrize(("version", "binary"), [(2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)])
def test_partitioned_meshes_of_gmsh(tmp_path: Path, version: float, binary: int) -> None:
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        model = partitioned(gmsh, tmp_path, version, binary)
    finally:
        gmsh.finalize()
    assert [(part.id, part.name) for part in model.parts.values()] == [(5, "body")]
    wall = next(s for s in model.node_sets if s.name == "wall")
    assert np.array_equal(wall.nodes, np.flatnonzero(model.xyz[:, 0] == 0))
    said = " ".join(model.warnings)
    assert ("$Periodic is skipped" in said) == (version != 2.2)
    assert ("$GhostElements is skipped" in said) == (version != 2.2)


HEAD = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
NODES_41 = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
ELEMENTS_41 = "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("$NOD\n1\n1 0 0 0\n$ENDNOD\n", ":1:1: error: version 1 of .msh is not read ($NOD); expected version 2.2"),
        (HEAD.replace("0 8", "2 8"), ":2:5: error: no such file type (2)"),
        (HEAD.replace("0 8", "0 3"), ":2:7: error: this data size is not read (3)"),
        (HEAD.replace("4.1 0", "4.1 1"), ":3:1: error: the byte order cannot be told"),
        (NODES_41.replace("1 3 1 3", "9 3 1 3"), ":13:1: error: $Nodes ends too early"),
        (NODES_41.replace("0 3\n1", f"0 {10**15}\n1"), f"error: $Nodes ends too early; expected {10**15} more numbers"),
        (NODES_41.replace("0 3\n1", "0 -3\n1"), "error: $Nodes ends too early; expected -3 more numbers"),
        (NODES_41.replace("2 1 0", "7 1 0"), ":6:1: error: an entity of this dimension is not known (7)"),
        (NODES_41.replace("\n2\n3", "\n2.5\n3"), ":8:1: error: not a whole number (2.5)"),
        (NODES_41.replace("\n2\n3", f"\n2\n{2**53 + 1}"), f":9:1: error: not a whole number ({2**53})"),
        (NODES_41.replace("1 0 0\n0", "1_0 0 0\n0"), ":11:1: error: not a number (1_0)"),
        (NODES_41 + ELEMENTS_41.replace("1 2 3\n", f"1 2 {10**19}\n"), f":17:7: error: not a number ({10**19})"),
        (NODES_41 + ELEMENTS_41.replace("1 2 3\n", "1 2 -3\n"), "element 1 has a node that is not there (-3)"),
        (NODES_41 + ELEMENTS_41.replace("2 1 2 1", "3 1 2 1"), ":16:1: error: tri3 elements on an entity of this dim"),
        (NODES_41 + ELEMENTS_41.replace("2 1 2 1", "3 1 14 1"), "expected 13-node pyramids (gmsh option Mesh.SecondO"),
        (NODES_41.replace("$EndNodes", "$EndNo"), "error: the file ends inside $Nodes; expected $EndNodes"),
    ],
)
def test_faults(faults, text: str, said: str) -> None:
    lines = faults(read, text if text.startswith(("$Mesh", "$NOD")) else HEAD + text, name="m.msh")
    assert said in lines[0], lines


def test_numbers_past_the_counts_are_noted(tmp_path: Path) -> None:
    text = HEAD + NODES_41.replace("1 3 1 3", "1 5 1 3").replace("0 1 0\n$", "0 1 0 7 7\n$") + ELEMENTS_41
    (tmp_path / "m.msh").write_text(text)
    assert [warning.partition(": ")[2] for warning in read(tmp_path / "m.msh").warnings] == [
        "$Nodes announces 5 nodes and holds 3: those are read",
        "line 5: the last 2 numbers of $Nodes are past its counts: left out",
    ]


def test_counts_that_lie_take_no_memory(tmp_path: Path) -> None:
    sheet = Sheet("4.1", "<")
    sheet.section("Nodes", ("n", [2**60, 2**60, 1, 2**60]), ("i", [2, 1, 0]), ("n", [2**60]), ("n", [1, 2]))
    tracemalloc.start()
    try:
        with pytest.raises(Exception, match="ends too early"):
            sheet.read(tmp_path)
        assert tracemalloc.get_traced_memory()[1] < 1e6
    finally:
        tracemalloc.stop()


DIGITS = st.text("0123456789", min_size=1, max_size=25)
REALS = st.builds(lambda a, b, e: f"{a}.{b}e{e}", DIGITS, DIGITS, st.integers(-340, 280)) | st.floats(
    allow_nan=False, allow_infinity=False
).map(repr)


@given(texts=st.lists(REALS, min_size=1, max_size=20))
@settings(max_examples=200, deadline=None)
def test_reals_are_the_nearest_doubles(texts: list[str]) -> None:
    data = " ".join(texts).encode()
    numbers = Numbers(Faults("m"), data, 0, len(data), "Nodes", Encoding("4.1", ""), integers=False)
    assert numbers.reals(len(texts)).tolist() == [float(text) for text in texts]


@given(values=st.lists(st.integers(-(2**62), 2**62 - 1).map(lambda n: n // 5), min_size=1, max_size=20))
@settings(max_examples=100, deadline=None)
def test_integers_are_exact(values: list[int]) -> None:
    data = " ".join(map(str, values)).encode()
    numbers = Numbers(Faults("m"), data, 0, len(data), "Elements", Encoding("4.1", ""), integers=True)
    assert numbers.sizes(len(values)).tolist() == values
