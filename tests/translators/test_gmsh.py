from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.translators.elements import TABLE
from zrno.translators.geometry import measures
from zrno.translators.gmsh import mesh_geo, read
from zrno.translators.gmsh.geo import read as read_geo
from zrno.translators.text import InputError

GEO = """\
SetFactory("OpenCASCADE");
DefineConstant[ L = 2 ];
Box(1) = {0, 0, 0, L, 1, 1};
Box(2) = {L, 0, 0, 1, 1, 1};
Coherence;
Physical Volume("left", 7) = {1};
Physical Volume("right", 9) = {2};
Physical Surface("floor", 7) = {Surface In BoundingBox {-1, -1, -0.1, 9, 9, 0.1}};
Mesh.MeshSizeMax = 0.5;
"""


@pytest.fixture
def gmsh() -> Iterator[Any]:
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield gmsh
    gmsh.finalize()


# counts of ../shared/samples/MANIFEST.tsv, found by meshio and gmsh
SAMPLES = {
    "mfem_compass": (13, {"line2": 8, "tri3": 8, "quad4": 4}),
    "mfem_periodic_cube": (125, {"quad4": 96, "hex8": 64}),
    "mfem_indheat_41": (5289, {"tri3": 6446, "tet4": 30431}),
    "mfem_p2_prism": (65, {"tri6": 8, "quad9": 8, "wedge18": 8}),
    "mfem_t1_v4": (417, {"point1": 2, "line2": 80, "tri3": 752}),
    "mfem_indheat_40": (6701, {"tri3": 6264, "tet4": 30032}),
    "gridap_square": (9, {"point1": 4, "line2": 8, "quad4": 4}),
    "gridap_two_tets": (5, {"tet4": 2}),
    "gridap_demo": (10257, {"point1": 2, "line2": 60, "tri3": 800, "tet4": 40144}),
    "gen_box_22a": (428, {"tri3": 66, "tet4": 1455}),
    "gen_box_22b": (428, {"tri3": 66, "tet4": 1455}),
    "gen_slab_41a": (60, {"point1": 1, "line2": 4, "quad4": 8, "hex8": 24}),
    "gen_slab_22a_o2": (315, {"point1": 1, "line3": 4, "quad9": 8, "hex27": 24}),
}


@pytest.mark.parametrize("name", SAMPLES)
def test_sample_counts(shared: Path, name: str) -> None:
    model = read(shared / "samples/msh" / f"{name}.msh")
    assert (len(model.xyz), model.element_counts()) == SAMPLES[name]
    links = ["line 296: $Periodic is skipped: links of periodic nodes are not carried"]
    assert [w.partition(": ")[2] for w in model.warnings] == (links if name == "mfem_periodic_cube" else [])


def test_a_version_4_0_sample_and_its_twin(shared: Path) -> None:
    """The same geometry, meshed by two versions of gmsh: entities, groups and faces agree, inner nodes do not."""
    old, new = (read(shared / "samples/msh" / f"mfem_indheat_{version}.msh") for version in ("40", "41"))
    assert (old.version, new.version) == ("4.0", "4.1")
    assert list(old.parts) == list(new.parts) == [1000, 1001, 1002]
    assert [s.id for s in old.node_sets] == [s.id for s in new.node_sets]
    assert np.allclose(old.bounding_box(), new.bounding_box())
    volumes = []
    for model in (old, new):
        tets = next(block for block in model.blocks if block.kind == "tet4")
        volumes.append([measures(tets, model.xyz)[tets.part == part].sum() for part in model.parts])
    assert volumes[0] == pytest.approx(volumes[1], rel=0.02)


def test_groups_of_a_sample(shared: Path, same) -> None:
    text, binary = (read(shared / "samples/msh" / f"gen_box_22{kind}.msh") for kind in "ab")
    assert {number: part.name for number, part in text.parts.items()} == {10: "left part", 20: 'right "quoted" часть'}
    assert next((s.name, len(s.nodes)) for s in text.node_sets) == ("fix", 44)
    assert same(text.blocks, binary.blocks)
    assert np.array_equal(text.node_ids, binary.node_ids)
    assert np.allclose(text.xyz, binary.xyz, rtol=1e-15, atol=1e-15)


@pytest.mark.parametrize("name", sorted(SAMPLES.keys() - {"mfem_p2_prism", "mfem_t1_v4", "mfem_indheat_40"}))
def test_the_same_mesh_as_meshio(shared: Path, name: str) -> None:
    import meshio

    ours, theirs = read(shared / "samples/msh" / f"{name}.msh"), meshio.read(shared / "samples/msh" / f"{name}.msh")
    assert np.array_equal(ours.xyz[:, : theirs.points.shape[1]], theirs.points)
    for block in ours.blocks:
        kind = TABLE[block.kind].meshio
        assert np.array_equal(block.nodes, np.concatenate([c.data for c in theirs.cells if c.type == kind]))


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("incomplete", [0, 1])
@pytest.mark.parametrize(("version", "binary"), [(2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)])
def test_what_gmsh_writes(tmp_path: Path, gmsh, version: float, binary: int, order: int, incomplete: int) -> None:
    (tmp_path / "box.geo").write_text(GEO)
    gmsh.open(str(tmp_path / "box.geo"))
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(str(tmp_path / "box.msh"))
    model = read(tmp_path / "box.msh")
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    theirs = dict(zip(tags.tolist(), np.reshape(xyz, (-1, 3)).tolist(), strict=True))
    ours = dict(zip(model.node_ids.tolist(), model.xyz.tolist(), strict=True))
    assert {tag: theirs[tag] for tag in ours} == ours or np.allclose([theirs[tag] for tag in ours], list(ours.values()))
    assert {number: part.name for number, part in model.parts.items()} == {7: "left", 9: "right"}
    assert {s.name for s in model.node_sets} == {"left", "right", "floor"}
    floor = next(s for s in model.node_sets if s.name == "floor")
    assert np.array_equal(np.sort(floor.nodes), np.flatnonzero(model.xyz[:, 2] == 0))
    volume = {
        number: sum(
            measures(block, model.xyz)[block.part == number].sum() for block in model.blocks if "tet" in block.kind
        )
        for number in model.parts
    }
    assert volume == pytest.approx({7: 2.0, 9: 1.0}, rel=1e-12)


def test_an_entity_of_two_groups(tmp_path: Path, gmsh) -> None:
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [1], 1, "body")
    gmsh.model.addPhysicalGroup(3, [1], 2, "all")
    gmsh.model.mesh.generate(3)
    gmsh.write(str(tmp_path / "two.msh"))
    model = read(tmp_path / "two.msh")
    assert list(model.parts) == [1]
    assert [(s.name, len(s.nodes)) for s in model.node_sets] == [("body", len(model.xyz)), ("all", len(model.xyz))]
    assert "times an element belongs to a further group (all)" in model.warnings[0]
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)  # writes such an element twice
    gmsh.write(str(tmp_path / "twice.msh"))
    again = read(tmp_path / "twice.msh")
    assert again.element_counts() == model.element_counts()
    assert [(s.name, len(s.nodes)) for s in again.node_sets] == [("body", len(model.xyz)), ("all", len(model.xyz))]
    assert again.warnings == [w.replace("two.msh", "twice.msh") for w in model.warnings]


def test_without_groups_entities_are_parts(tmp_path: Path, gmsh) -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.addRectangle(2, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)
    gmsh.write(str(tmp_path / "two.msh"))
    model = read(tmp_path / "two.msh")
    assert (list(model.parts), model.dimension) == ([1, 2], 2)


HEAD = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
NODES = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
ELEMENTS = "$Elements\n1\n1 2 2 5 5 1 2 3\n$EndElements\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", ":1:1: error: the file is empty"),
        ("hello\n", ":1:1: error: not a gmsh mesh"),
        (HEAD.replace("2.2", "1.0") + NODES, ":2:1: error: this version of .msh is not read (1.0)"),
        (HEAD, ":4:1: error: a mesh without nodes"),
        (HEAD + NODES.replace("2 1 0 0", "2 x 0 0"), ":7:3: error: not a number (x)"),
        (HEAD + NODES.replace("2 1 0 0", "2 1 nan 0"), ":6:1: error: a number in $Nodes is not finite"),
        (HEAD + NODES.replace("\n3\n", "\n4\n"), "error: $Nodes ends too early; expected 16 more numbers"),
        (HEAD + NODES.replace("\n3\n", "\nabc\n", 1), ":5:1: error: no count of $Nodes (abc)"),
        (HEAD + NODES.replace("3 0 1 0", "2 0 1 0"), ":8:1: error: a node number stands twice (2)"),
        (HEAD + NODES[:20], "error: the file ends inside $Nodes"),
        (
            HEAD + NODES + ELEMENTS.replace("1 2 3\n", "1 2 8\n"),
            ":12:1: error: element 1 has a node that is not there (8)",
        ),
        (HEAD + NODES + ELEMENTS.replace("1 2 2", "1 99 2"), ":12:3: error: elements of gmsh type 99 are not known"),
        (HEAD + NODES + ELEMENTS.replace("$Elements\n1", "$Elements\n2"), "error: $Elements ends too early"),
        (HEAD + "$PhysicalNames\n1\nbad\n$EndPhysicalNames\n" + NODES, ":6:1: error: not a physical name (bad)"),
    ],
)
def test_faults(faults, text: str, said: str) -> None:
    lines = faults(read, text, name="m.msh")
    assert said in lines[0], lines


def test_alternating_element_types(tmp_path: Path) -> None:
    rows = [f"{i} {1 if i % 2 else 2} 2 5 5 1 2{'' if i % 2 else ' 3'}" for i in range(1, 8)]
    (tmp_path / "m.msh").write_text(HEAD + NODES + "$Elements\n7\n" + "\n".join(rows) + "\n$EndElements\n")
    model = read(tmp_path / "m.msh")
    assert model.element_counts() == {"line2": 4, "tri3": 3}
    assert model.blocks[1].ids.tolist() == [2, 4, 6]


def test_binary_files_that_end_early(tmp_path: Path, shared: Path) -> None:
    data = (shared / "samples/msh/gen_box_22b.msh").read_bytes()
    (tmp_path / "m.msh").write_bytes(data[:3000])
    with pytest.raises(InputError, match="the file ends inside"):
        read(tmp_path / "m.msh")


def test_a_geometry_is_meshed_with_its_parameters(tmp_path: Path) -> None:
    (tmp_path / "box.geo").write_text(GEO)
    model = read_geo(tmp_path / "box.geo", numbers={"L": 5})
    assert model.bounding_box() == [[0, 0, 0], [6, 1, 1]]
    assert (model.title, model.format) == ("box", "geo")
    mesh = mesh_geo(tmp_path / "box.geo")
    assert read(mesh).bounding_box() == [[0, 0, 0], [3, 1, 1]]
    mesh.unlink()
    mesh.parent.rmdir()


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="this system has no SIGPIPE")
def test_a_broken_pipe_stays_an_exception_after_meshing(tmp_path: Path) -> None:
    (tmp_path / "box.geo").write_text(GEO)
    script = """
import os, sys
from zrno.translators.gmsh.geo import read
read(sys.argv[1])
reader, writer = os.pipe()
os.close(reader)
try:
    os.write(writer, b"frame")
except BrokenPipeError:
    sys.exit(5)
"""
    assert subprocess.run([sys.executable, "-c", script, tmp_path / "box.geo"]).returncode == 5


def test_a_geometry_is_meshed_outside_the_main_thread(tmp_path: Path) -> None:
    (tmp_path / "box.geo").write_text(GEO)
    models = []
    before = signal.getsignal(signal.SIGPIPE)
    thread = threading.Thread(target=lambda: models.append(read_geo(tmp_path / "box.geo")))
    thread.start()
    thread.join()
    signal.signal(signal.SIGPIPE, before)
    assert models[0].bounding_box() == [[0, 0, 0], [3, 1, 1]]


def test_a_geometrys_errors_have_their_line(faults) -> None:
    assert ":2:1: error: gmsh: " in faults(read_geo, "Point(1) = {0, 0, 0};\nfoo bar;\n", name="x.geo")[0]
    assert ":2:1: error: gmsh skips a last line" in faults(read_geo, "x = 1;\ny = 2;", name="x.geo")[0]
    assert "makes no mesh" in faults(read_geo, "x = 1;\n", name="x.geo")[0]
