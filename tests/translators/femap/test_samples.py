"""The sample files: their counts, and what their blocks say, read by eye."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.femap import read, write
from zrno.translators.geometry import measures
from zrno.translators.model import Model

NAMES = ("emsi_simple", "pak_3de", "pak_kockav1", "pak_tac11", "pakf_bakiheart")


@pytest.fixture
def sample(shared: Path):
    return lambda name: read(shared / f"samples/femap/{name}.neu")


@pytest.mark.parametrize("name", NAMES)
def test_counts(shared: Path, sample, name: str) -> None:
    with (shared / "samples/MANIFEST.tsv").open() as file:
        row = next(row for row in csv.reader(file, delimiter="\t") if row[0] == f"femap/{name}.neu")
    version, counts = re.search(r"version (\S+); (.*?) \|", row[5]).groups()
    said = {key: int(value) for key, value in re.findall(r"(\w+)=(\d+)", counts)}
    model = sample(name)
    assert model.version == version
    assert {"nodes": len(model.xyz), **model.element_counts()} == said


@pytest.mark.parametrize("name", NAMES)
def test_there_and_back(sample, same, tmp_path: Path, name: str) -> None:
    model = sample(name)
    report = write(model, tmp_path / "o.neu")
    again = read(tmp_path / "o.neu")
    assert not report
    assert again.version == "4.41"
    again.version = model.version
    assert same(model, again)


def test_volumes(sample) -> None:
    model = sample("pak_3de")
    assert model.blocks[0].part.tolist() == [1, 2, 2]
    for name, sizes in (("pak_3de", [1.0] * 3), ("pak_kockav1", [1e6]), ("pak_tac11", [100.0] * 6)):
        assert measures(sample(name).blocks[0], sample(name).xyz) == pytest.approx(sizes)
    heart = sample("pakf_bakiheart")
    assert measures(heart.blocks[0], heart.xyz).min() > 0


def held(model: Model) -> dict[int, str]:
    """Degrees of freedom of each node that constraints hold: node number -> "xyz"."""
    found = {}
    for constraint in model.constraints:
        for node, dofs in zip(constraint.nodes, constraint.dofs, strict=True):
            found[int(model.node_ids[node])] = "".join(np.array([*"xyzabc"])[dofs])
    return found


def test_3de(sample) -> None:
    model = sample("pak_3de")
    assert [(m.name, m.law, m.density, m.parameters) for m in model.materials.values()] == [
        ("MAT   1", "elastic", 3.0, {"E": 4.0, "nu": 0.0}),
        ("MAT   2", "elastic", 1.0, {"E": 2.0, "nu": 0.0}),
    ]
    assert [(p.id, p.name, p.material, p.section) for p in model.parts.values()] == [
        (1, "PRO   1", 1, 1),
        (2, "PRO   2", 2, 2),
    ]
    assert held(model) == {1: "xy", 2: "xyz", 3: "xz", 4: "x", 5: "y", 6: "yz", 7: "z", 9: "y", 10: "yz", 11: "z",
                           13: "xy", 14: "xyz", 15: "xz", 16: "x"}  # fmt: skip
    assert model.fixed is not None
    assert model.fixed.astype(int).tolist() == [[0, 0, 0, 1, 1, 1]] * 16
    assert [(c.id, c.name) for c in model.constraints] == [(1, "constraint")] * 7
    assert [w.split("/")[-1] for w in model.warnings] == [
        "pak_3de.neu:233: the file ends inside block 451",
        "pak_3de.neu:157: 1 block(s) 450 are not read (results)",
        "pak_3de.neu:232: 1 block(s) 451 are not read (results)",
    ]


def test_tac11(sample) -> None:
    model = sample("pak_tac11")
    material, section = model.materials[1], model.sections[1]
    assert (material.law, material.parameters) == ("elastic", {"E": 1.0, "nu": 0.33333})
    assert material.native["values"][9] == 1.49998  # the first of the 3-D matrix
    assert (section.kind, section.plane, section.parameters) == ("plane", "stress", {"thickness": 1.0})
    assert (model.dimension, model.blocks[0].family) == (2, "plane")
    assert held(model) == {1: "xy", 2: "y", 3: "y", 4: "y", 5: "x", 9: "x"}
    assert model.node_ids[model.blocks[0].nodes[0]].tolist() == [1, 2, 6, 5]


def test_emsolution(sample) -> None:
    """Short records of a material and of a property."""
    model = sample("emsi_simple")
    assert (model.materials[1].law, model.parts[1].name, model.parts[1].material) == ("", "Material1", 1)
    assert [w.split("/")[-1] for w in model.warnings] == [
        "emsi_simple.neu: 2 line(s) of block 402 belong to no property",
        "emsi_simple.neu:19: material 1 has no modulus of elasticity: it has no law",
    ]


def test_exponents_without_a_letter(sample) -> None:
    """2.81617-322, which Fortran writes for 2.81617E-322."""
    assert sample("pakf_bakiheart").materials[1].density == 2.81617e-322
