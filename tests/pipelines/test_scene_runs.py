"""Whole scenes through `zrno run`: mesh, settings, the scene's numerics, result folder."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines.load import load
from zrno.pipelines.run import run

MESH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "sand"
2 2 "plate"
$EndPhysicalNames
$Nodes
8
1 0.06 0.0025 0
2 0.18 0.0025 0
3 0.18 0.0625 0
4 0.06 0.0625 0
5 0.0 -0.04 0
6 0.24 -0.04 0
7 0.24 0 0
8 0.0 0 0
$EndNodes
$Elements
2
1 3 2 1 1 1 2 3 4
2 3 2 2 2 5 6 7 8
$EndElements
"""
SETTINGS = """\
end_time: 0.004
output_interval: 0.002
step_option: 2
materials:
  sand: {law: elastic, density: 1600, E: 1.2e7, nu: 0.3, velocity: [0, -0.5, 0]}
  plate: {law: elastic, density: 7800, E: 1.45e11, nu: 0.3}
"""
SCENE = """\
title: A soft block on a plate
meshes:
  - {source: m.msh, target: m.mcm, settings: m.yaml, spacing: 0.01}
decks: [m.mcm]
sph:
  total_lagrangian: [plate]
  contact: {law: pinball, pinball: 1, damping: 0.1, friction: {static: 0.5, kinetic: 0.4}}
"""


def _scene(folder: Path, mesh: str, settings: str, scene: str) -> Path:
    for name, text in (("m.msh", mesh), ("m.yaml", settings), ("scene.yaml", scene)):
        (folder / name).write_text(text)
    return folder / "scene.yaml"


def test_a_plate_of_steel_does_not_slow_the_sand(tmp_path: Path) -> None:
    """Local steps unasked, through a whole scene."""
    scene = _scene(tmp_path, MESH, SETTINGS, SCENE)
    result = run([scene], output=tmp_path / "out")
    log = (tmp_path / "out" / "run.log").read_text()
    assert "local steps: about" in log
    assert "of plate in one of the others" in log
    row = load(tmp_path / "out").history
    assert row["time"][-1] == 0.004
    assert result["steps"] < 120  # in steps of the steel some 2500
    assert result["energy"]["balance_error"] < 1e-3
    start = 1600 * 0.12 * 0.06 * -0.5
    assert row["momentum_y"] == pytest.approx(start, rel=1e-10)
    assert row["contact_force_y"].max() > 0.0  # they met
    assert json.loads((tmp_path / "out" / "run.json").read_text())["status"] == "done"


def test_a_body_of_revolution_through_a_whole_scene(tmp_path: Path) -> None:
    """A copper rod that meets a plane; the result knows that its x is a radius."""
    nodes = ["0 0 0", "3.2 0 0", "3.2 32.4 0", "0 32.4 0"]
    listed = "\n".join(f"{i} {node}" for i, node in enumerate(nodes, 1))
    mesh = (
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"rod\"\n$EndPhysicalNames\n"
        f"$Nodes\n4\n{listed}\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n"
    )  # fmt: skip
    settings = """\
axisymmetric: true
end_time: 0.01
step_option: 2
h_factor: 1.5
discretisation: 1
materials:
  rod: {law: von_mises, density: 8.93e-3, E: 117.0e3, nu: 0.35, yield_stress: 400, tangent_modulus: 99.9, beta: 1,
        velocity: [0, -227, 0]}
planes: {ymin: [symmetry, 0]}
"""
    text = (
        "units: mm-ms-g\nmeshes:\n  - {source: m.msh, target: m.mcm, settings: m.yaml, spacing: 0.64}\ndecks: [m.mcm]\n"
    )
    run([_scene(tmp_path, mesh, settings, text)], output=tmp_path / "out")
    result = load(tmp_path / "out")
    assert result.axisymmetric
    assert result.dimension == 2
    assert "axisymmetric, cubic kernel" in (tmp_path / "out" / "run.log").read_text()
    mass = result.arrays(index=-1)["mass"].sum()
    assert mass == pytest.approx(8.93e-3 * np.pi * 3.2**2 * 32.4, rel=1e-6)
    assert result.history["kinetic"][0] == pytest.approx(0.5 * mass * 227.0**2, rel=1e-3)
    assert result.history["kinetic"][-1] < 0.9 * result.history["kinetic"][0]
    assert np.all(result.history["momentum_x"] == 0.0)
