"""A mesh as CalculiX includes it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from zrno.translators.calculix import of_type, write_mesh
from zrno.translators.gmsh import read
from zrno.translators.model import ElementBlock, Model, Part

MESH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "held side"
2 3 "strip"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2.25 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
3
1 1 2 1 1 1 4
2 3 2 3 3 1 2 5 4
3 3 2 3 3 2 3 6 5
$EndElements
"""


def test_nodes_elements_and_sets(tmp_path: Path) -> None:
    (tmp_path / "strip.msh").write_text(MESH)
    model = read(tmp_path / "strip.msh")
    assert of_type(model, "S4")
    assert not of_type(model, "S3")
    write_mesh(tmp_path / "mesh.inp", model, "S4", {"AT": np.array([2])})
    lines = (tmp_path / "mesh.inp").read_text().splitlines()
    assert lines[0] == "*NODE, NSET=NALL"
    assert "3,2.25,0,0" in lines
    k = lines.index("*ELEMENT, TYPE=S4, ELSET=STRIP")
    assert lines[k + 1 : k + 3] == ["1,1,2,5,4", "2,2,3,6,5"]
    assert lines[lines.index("*ELSET, ELSET=EALL, GENERATE") + 1] == "1,2"
    assert lines[lines.index("*NSET, NSET=HELD_SIDE") + 1] == "1,4"
    assert lines[lines.index("*NSET, NSET=AT") + 1] == "3"
    assert max(map(len, lines)) <= 132


def test_long_elements_and_sets_go_on_in_the_next_line(tmp_path: Path) -> None:
    model = Model(title="one", dimension=3)
    model.xyz, model.node_ids = np.arange(60.0).reshape(20, 3), np.arange(1, 21)
    model.parts[1] = Part(1, "one")
    model.blocks.append(ElementBlock("hex20", np.array([7]), np.arange(20)[None], np.array([1]), "solid", {}))
    write_mesh(tmp_path / "mesh.inp", model, "C3D20", {"AT": np.arange(11), "NONE": np.arange(0)})
    text = (tmp_path / "mesh.inp").read_text()
    nodes = range(1, 21)
    card = text.split("*ELEMENT")[1].split("*")[0].split("\n", 1)[1]
    assert card.startswith(",".join(map(str, [1, *nodes[:7]])) + ",\n")
    assert [int(v) for v in card.replace("\n", "").split(",")[:21]] == [1, *nodes]
    assert "*NSET, NSET=AT\n1,2,3,4,5,6,7,8\n9,10,11\n" in text
    assert "NONE" not in text
