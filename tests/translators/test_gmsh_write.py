from __future__ import annotations

import random
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from zrno.translators import formats
from zrno.translators.elements import TABLE
from zrno.translators.gmsh import read, write
from zrno.translators.lost import report_lost
from zrno.translators.model import ElementBlock, Material, Model, NodeSet, Part
from zrno.translators.report import Report
from zrno.translators.text import InputError

FORMS = [("4.1", False), ("4.1", True), ("2.2", False), ("2.2", True)]
NAMES = st.text(st.sampled_from("abc \"'$#:1_žдσ"), min_size=1, max_size=8)
QUICK = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@st.composite
def models(draw: st.DrawFn) -> Model:
    """Models of any elements, with parts of several dimensions and sets of any nodes."""
    count = 40
    numbers = random.Random(draw(st.integers(0, 2**32)))
    reals = st.floats(allow_nan=False, allow_infinity=False)
    xyz = np.array(draw(st.lists(reals, min_size=3 * count, max_size=3 * count))).reshape(count, 3)
    kinds = draw(st.lists(st.sampled_from(sorted(TABLE)), min_size=1, max_size=4, unique=True))
    top = max(TABLE[kind].dimension for kind in kinds)
    sizes = [draw(st.integers(1, 5)) for _ in kinds]
    ids = iter(numbers.sample(range(1, 2**31 - 1000), sum(sizes)))
    model = Model(title=draw(NAMES), xyz=xyz, node_ids=np.array(numbers.sample(range(1, 2**31 - 1), count)))
    for kind, size in zip(kinds, sizes, strict=True):
        firsts = numbers.sample(range(count), size)  # rows that differ
        rest = [numbers.sample(sorted({*range(count)} - {first}), TABLE[kind].nodes - 1) for first in firsts]
        nodes = np.array([[first, *some] for first, some in zip(firsts, rest, strict=True)])
        least = 1 if TABLE[kind].dimension == top else 0
        part = np.array([numbers.randint(least, 3) for _ in firsts])
        model.blocks.append(ElementBlock(kind, np.array([next(ids) for _ in firsts]), nodes, part))
    for number in sorted({int(n) for block in model.blocks for n in block.part} - {0}):
        model.parts[number] = Part(number, draw(st.one_of(st.just(""), NAMES)))
    for number in draw(st.lists(st.integers(1, 9), max_size=3, unique=True)):
        nodes = np.array(sorted(numbers.sample(range(count), draw(st.integers(1, 6)))))
        model.node_sets.append(NodeSet(number, draw(st.one_of(st.just(""), NAMES)), nodes))
    lower = [block for block in model.blocks if TABLE[block.kind].dimension < top]
    if lower and draw(st.booleans()):  # a set that elements say
        model.node_sets.append(NodeSet(17, "boundary", np.unique(lower[0].nodes)))
    return model


def elements_of(model: Model) -> dict[str, dict[int, tuple[list[int], int]]]:
    """Nodes and part of each element."""
    found: dict[str, dict[int, tuple[list[int], int]]] = {}
    for block in model.blocks:
        rows = zip(block.ids.tolist(), block.nodes.tolist(), block.part.tolist(), strict=True)
        found.setdefault(block.kind, {}).update({i: (nodes, part) for i, nodes, part in rows})
    return found


def sets_of(model: Model, *, numbers: bool = True) -> list[tuple[int, str, list[int]]]:
    return sorted((s.id if numbers else 0, s.name, s.nodes.tolist()) for s in model.node_sets)


def with_sets_of_parts(model: Model) -> Model:
    """What reading a mesh adds: a named part is a set also, one for each dimension it has elements of."""
    full = Model(node_sets=list(model.node_sets))
    for number, part in model.parts.items():
        for dimension in range(4):
            nodes = [b.nodes[b.part == number].ravel() for b in model.blocks if TABLE[b.kind].dimension == dimension]
            some = np.unique(np.concatenate(nodes)) if nodes else np.zeros(0)
            if part.name and len(some):
                full.node_sets.append(NodeSet(number, part.name, some))
    return full


@pytest.mark.parametrize(("version", "binary"), FORMS)
@given(model=models())
@QUICK
def test_there_and_back(tmp_path: Path, version: str, binary: bool, model: Model) -> None:
    path = tmp_path / "m.msh"
    report = write(model, path, version=version, binary=binary)
    again = read(path)
    assert again.warnings == []
    assert not report.dropped
    assert np.array_equal(again.xyz.view(np.int64), model.xyz.view(np.int64))  # to the last bit, -0.0 too
    assert np.array_equal(again.node_ids, model.node_ids)
    assert elements_of(again) == elements_of(model)
    assert {n: part.name for n, part in again.parts.items()} == {n: part.name for n, part in model.parts.items()}
    assert again.title == model.title
    renumbered = bool(report.approximated)
    assert sets_of(again, numbers=not renumbered) == sets_of(with_sets_of_parts(model), numbers=not renumbered)
    write(again, path, version=version, binary=binary)
    assert sets_of(read(path), numbers=not renumbered) == sets_of(again, numbers=not renumbered)


@pytest.fixture
def slab() -> Model:
    """Two hexes of two parts; faces of the floor; sets of faces, of an edge's nodes and of nodes at large."""
    x = np.array([[i, j, k] for k in (0, 1) for j in (0, 1) for i in (0, 1, 2)], float)
    hexes = np.array([[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]])
    quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])
    return Model(
        title="slab",
        node_ids=np.arange(1, 13),
        xyz=x / 3,
        blocks=[
            ElementBlock("hex8", np.array([7, 9]), hexes, np.array([2, 5])),
            ElementBlock("quad4", np.array([10, 11]), quads, np.zeros(2, int)),
        ],
        parts={2: Part(2, "left ч"), 5: Part(5, "right")},
        node_sets=[
            NodeSet(4, "floor", np.arange(6)),
            NodeSet(6, "left floor", np.array([0, 1, 3, 4])),
            NodeSet(5, "corners", np.array([0, 11])),
        ],
    )


@pytest.mark.parametrize(("version", "binary"), FORMS)
def test_gmsh_reads_what_is_written(tmp_path: Path, slab: Model, version: str, binary: bool) -> None:
    import gmsh

    assert not write(slab, tmp_path / "slab.msh", version=version, binary=binary)
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        before = len(gmsh.logger.get())
        gmsh.open(str(tmp_path / "slab.msh"))
        said = gmsh.logger.get()[before:]
        gmsh.logger.stop()
        assert [line for line in said if line.startswith(("Error", "Warning"))] == []
        tags, xyz, _ = gmsh.model.mesh.getNodes()
        assert np.array_equal(np.reshape(xyz, (-1, 3))[np.argsort(tags)], slab.xyz)
        hexes = np.reshape(gmsh.model.mesh.getElementsByType(5)[1], (-1, 8))
        assert np.array_equal(hexes, slab.blocks[0].nodes + 1)
        groups = {
            (dimension, gmsh.model.getPhysicalName(dimension, tag)): sorted(
                gmsh.model.mesh.getNodesForPhysicalGroup(dimension, tag)[0].tolist()
            )
            for dimension, tag in gmsh.model.getPhysicalGroups()
        }
    finally:
        gmsh.finalize()
    several = version == "4.1"  # the quads of the left floor are of the floor too: in 2.2 points say it
    assert groups == {
        (3, "left ч"): sorted((slab.blocks[0].nodes[0] + 1).tolist()),
        (3, "right"): sorted((slab.blocks[0].nodes[1] + 1).tolist()),
        (2, "floor"): [1, 2, 3, 4, 5, 6],
        (2 if several else 0, "left floor"): [1, 2, 4, 5],
        (0, "corners"): [1, 12],
    }


@pytest.mark.parametrize(("version", "binary"), FORMS)
def test_meshio_reads_what_is_written(tmp_path: Path, slab: Model, version: str, binary: bool) -> None:
    import meshio

    write(slab, tmp_path / "slab.msh", version=version, binary=binary)
    mesh = meshio.gmsh.read(tmp_path / "slab.msh")
    assert np.array_equal(mesh.points, slab.xyz)
    cells = np.concatenate([c.data for c in mesh.cells if c.type == "hexahedron"])
    assert np.array_equal(cells, slab.blocks[0].nodes)


@pytest.mark.parametrize("element", [e for e in TABLE.values() if e.dimension], ids=lambda e: e.name)
def test_node_orders_are_gmshs(tmp_path: Path, element) -> None:
    """gmsh's reference element, written by gmsh, is read with its mid-edge nodes where the table has them."""
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        _, dimension, _, count, coordinates, _ = gmsh.model.mesh.getElementProperties(element.gmsh)
        points = np.zeros((count, 3))
        points[:, :dimension] = np.reshape(coordinates, (count, dimension))
        gmsh.model.addDiscreteEntity(dimension, 1)
        gmsh.model.mesh.addNodes(dimension, 1, list(range(1, count + 1)), points.ravel().tolist())
        gmsh.model.mesh.addElements(dimension, 1, [element.gmsh], [[1]], [list(range(1, count + 1))])
        gmsh.write(str(tmp_path / "one.msh"))
    finally:
        gmsh.finalize()
    model = read(tmp_path / "one.msh")
    (block,) = model.blocks
    assert block.kind == element.name
    x = model.xyz[block.nodes[0]]
    for i, (a, b) in enumerate(element.shape.edges if element.mid_edges else ()):
        assert x[element.shape.corners + i] == pytest.approx((x[a] + x[b]) / 2)


def test_what_a_mesh_cannot_say_is_reported(tmp_path: Path, slab: Model) -> None:
    slab.materials[1] = Material(1)
    slab.parts[2].material = 1
    slab.parts[8] = Part(8, "empty")
    slab.node_sets.append(NodeSet(9, "none", np.zeros(0, np.int64)))
    dropped = {item.what: item.count for item in write(slab, tmp_path / "a.msh").dropped}
    assert dropped == {"materials": 1, "part material": 1, "parts": 1, "node sets": 1}


def test_a_field_that_a_model_gets_later_is_reported() -> None:
    @dataclass
    class Thing:
        name: str = ""
        springs: list[int] = field(default_factory=list)
        gravity: float = 9.81
        thickness: Any = None

    report = Report()
    report_lost([Thing("a"), Thing("b", [1, 2], 1.6, np.ones(3))], {"name"}, "thing", "nowhere", report)
    lost = {item.what: item.count for item in report.dropped}
    assert lost == {"thing springs": 2, "thing gravity": 1, "thing thickness": 3}


def test_numbers_that_a_group_cannot_have(tmp_path: Path, slab: Model) -> None:
    slab.parts = {2: Part(2, "a"), 2**31: Part(2**31, "b")}
    slab.blocks[0].part = np.array([2, 2**31])
    slab.node_sets = [NodeSet(0, "zero", np.array([0])), NodeSet(1, "one", np.array([1]))]
    report = write(slab, tmp_path / "a.msh")
    assert {item.what: item.count for item in report.approximated} == {"part numbers": 1, "node set numbers": 1}
    model = read(tmp_path / "a.msh")
    assert {n: part.name for n, part in model.parts.items()} == {1: "b", 2: "a"}
    assert {(s.id, s.name) for s in model.node_sets if len(s.nodes) == 1} == {(1, "one"), (2, "zero")}


def test_models_that_no_mesh_file_holds(tmp_path: Path, slab: Model) -> None:
    with pytest.raises(ValueError, match=r"version 4\.0 of \.msh is not written; expected 4\.1 or 2\.2"):
        write(slab, tmp_path / "a.msh", version="4.0")
    with pytest.raises(ValueError, match="no nodes"):
        write(Model(), tmp_path / "a.msh")
    slab.node_ids[0] = 2**31
    assert not write(slab, tmp_path / "a.msh")
    with pytest.raises(ValueError, match=r"the number 2147483648 .* does not fit version 2.2"):
        write(slab, tmp_path / "b.msh", version="2.2")
    slab.xyz[0, 0] = np.nan
    with pytest.raises(ValueError, match="not finite"):
        write(slab, tmp_path / "b.msh")
    assert [path.name for path in tmp_path.iterdir()] == ["a.msh"]


def test_nodes_alone(tmp_path: Path) -> None:
    model = Model(xyz=np.eye(3), node_ids=np.array([3, 3, 4]), node_sets=[NodeSet(2, "two", np.array([0, 2]))])
    for version, binary in FORMS:
        report = write(model, tmp_path / "a.msh", version=version, binary=binary)
        assert [item.what for item in report.approximated] == ["node numbers"]
        again = read(tmp_path / "a.msh")
        assert (again.node_ids.tolist(), again.blocks, sets_of(again)) == ([1, 2, 3], [], [(2, "two", [0, 2])])


def test_msh_is_a_target(tmp_path: Path, slab: Model) -> None:
    formats.write(slab, tmp_path / "slab.msh", version="2.2", binary=True)
    assert (tmp_path / "slab.msh").read_bytes().startswith(b"$MeshFormat\n2.2 1 8\n")


@pytest.fixture(params=FORMS, ids=lambda form: f"{form[0]}{'b' if form[1] else 'a'}")
def bytes_of(request, tmp_path: Path, slab: Model) -> bytes:
    version, binary = request.param
    write(slab, tmp_path / "slab.msh", version=version, binary=binary)
    return (tmp_path / "slab.msh").read_bytes()


@pytest.fixture
def survives(tmp_path: Path) -> Callable[[bytes], None]:
    """Reads bytes: into a model or into faults, nothing else."""

    def check(data: bytes) -> None:
        (tmp_path / "broken.msh").write_bytes(data)
        with suppress(InputError):
            read(tmp_path / "broken.msh")

    return check


def test_files_cut_anywhere(bytes_of: bytes, survives) -> None:
    for end in range(len(bytes_of)):
        survives(bytes_of[:end])


def test_broken_bytes_and_words(bytes_of: bytes, survives) -> None:
    numbers = random.Random(1)
    words = [b"-1", b"0", b"9" * 18, b"9" * 30, b"nan", b"1e400", b"2147483648", b"1.5", b"\0", b"\xff" * 8, b"$", b""]
    for _ in range(400):
        data = bytearray(bytes_of)
        at = numbers.randrange(len(data))
        width = numbers.choice((1, 4, 8))
        data[at : at + width] = numbers.choice([*words, bytes([numbers.randrange(256)])])
        survives(bytes(data))
