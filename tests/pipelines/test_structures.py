"""Runs of finite element decks: from the command's inputs to a result folder."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from zrno.pipelines import load, run
from zrno.pipelines.build_fem import structure_problem
from zrno.pipelines.check import check
from zrno.pipelines.cli import app
from zrno.solvers.materials import cam_clay
from zrno.solvers.materials.point import drive
from zrno.translators import read
from zrno.translators.model import FaceLoad
from zrno.translators.text import InputError

MESH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "clamped"
1 2 "tip"
2 3 "strip"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
4
1 1 2 1 1 1 4
2 1 2 2 2 3 6
3 3 2 3 3 1 2 5 4
4 3 2 3 3 2 3 6 5
$EndElements
"""
SETTINGS = """
dimension: 3
materials:
  strip: {law: elastic, E: 1000, nu: 0, density: 1, thickness: 0.1}
sets:
  clamped: {fixed: all}
  tip: {force: [0, 0, -1.0e-4]}
fem: {steps: 4}
"""
SCENE = """title: Strip
units: mm-ms-g
meshes:
  - {source: strip.msh, target: strip.dat, settings: strip.yaml}
decks: [strip.dat]
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    (tmp_path / "strip.msh").write_text(MESH)
    (tmp_path / "strip.yaml").write_text(SETTINGS)
    (tmp_path / "scene.yaml").write_text(SCENE)
    return tmp_path / "scene.yaml"


def test_a_strip_from_mesh_to_frames(scene: Path, tmp_path: Path) -> None:
    result = run([scene], output=tmp_path / "out", options={"fem.enhanced": "all"})
    assert result["status"] == "done"
    assert (result["nodes"], result["elements"], result["particles"], result["steps"]) == (6, 2, 0, 4)
    found = load(tmp_path / "out")
    assert found.series == ["elements", "mat01"]
    np.testing.assert_allclose(found.times, [0, 0.25, 0.5, 0.75, 1.0])
    bent = 2e-4 * 2**3 / (3 * 1000 * 0.1**3 / 12)  # of Euler and Bernoulli, shear beside it
    tip = found.arrays(None, -1)["displacement"][:, 2].min()
    assert tip == pytest.approx(-bent, rel=0.08)
    half = found.arrays(None, 2)["displacement"][:, 2].min()
    assert half == pytest.approx(0.5 * tip, rel=1e-5)
    history = found.history
    np.testing.assert_allclose(history["reaction_z"], 2e-4 * history["time"], rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(history["internal"], history["external_work"], rtol=1e-9)
    mesh = found.mesh("elements")
    assert mesh.n_cells == 2
    names = {"id", "material", "thickness", "stress", "von_mises", "plastic_strain", "stress_top", "stress_bottom"}
    assert names <= set(mesh.cell_data)
    assert {"displacement", "rotation", "reaction"} <= set(mesh.point_data)
    manifest = json.loads((tmp_path / "out/run.json").read_text())
    assert manifest["status"] == "done"


@pytest.mark.parametrize("format", ["vtp", "vtk", "vtkhdf"])
def test_the_formats_hold_the_same(scene: Path, tmp_path: Path, format: str) -> None:
    run([scene], output=tmp_path / "out", options={"output.format": format})
    mesh = load(tmp_path / "out").mesh("elements")
    assert mesh.n_points == 6
    assert mesh.n_cells == 2
    assert mesh.point_data["displacement"][:, 2].min() < 0.0


def test_what_goes_on_ends_in_the_same_bits(scene: Path, tmp_path: Path) -> None:
    options = {"fem.geometry": "total", "sets.tip.force": [0, 0, -0.02]}
    run([scene], output=tmp_path / "whole", options=options)
    run([scene], output=tmp_path / "parts", options=options, until=0.5)
    result = run([scene], output=tmp_path / "parts", options=options, resume=True)
    assert result["steps"] == 4
    whole, parts = load(tmp_path / "whole"), load(tmp_path / "parts")
    assert (tmp_path / "whole/history.csv").read_text() == (tmp_path / "parts/history.csv").read_text()
    np.testing.assert_array_equal(whole.arrays()["displacement"], parts.arrays()["displacement"])


def test_a_listing_on_request_reads_back(scene: Path, tmp_path: Path) -> None:
    """Every step's displacements, reactions and stresses in columns; a resumed run's file is that of a whole one."""
    run([scene], output=tmp_path / "out", options={"fem.listing": True})
    text = (tmp_path / "out/listing.lst").read_text()
    assert text.count("STEP NUMBER =") == 4
    last = text[text.rindex("STEP NUMBER =") :].splitlines()
    found = load(tmp_path / "out").arrays(None, -1)
    at = next(k for k, line in enumerate(last) if "D I S P L" in line) + 3
    rows = np.array([[float(v) for v in line.split()] for line in last[at : at + 6]])
    assert rows[:, 0].tolist() == [1, 2, 3, 4, 5, 6]
    np.testing.assert_allclose(rows[:, 3], found["displacement"][:, 2], rtol=1e-5, atol=1e-12)
    np.testing.assert_allclose(rows[:, 5], found["rotation"][:, 1], rtol=1e-5, atol=1e-12)
    at = next(k for k, line in enumerate(last) if "R E A C" in line) + 3
    assert sum(float(line.split()[3]) for line in last[at : at + 2]) == pytest.approx(2e-4, rel=1e-5)
    at = next(k for k, line in enumerate(last) if "LAYER" in line) + 1
    layers = np.array([[float(v) for v in line.split()] for line in last[at : at + 6]])
    assert layers[:, :2].astype(int).tolist() == [[e, k] for e in (3, 4) for k in (1, 2, 3)]
    np.testing.assert_allclose(layers[0, 2], -layers[2, 2], rtol=1e-5)
    run([scene], output=tmp_path / "parts", options={"fem.listing": True}, until=0.5)
    run([scene], output=tmp_path / "parts", options={"fem.listing": True}, resume=True)
    assert (tmp_path / "parts/listing.lst").read_text() == text
    run([scene], output=tmp_path / "without")
    assert not (tmp_path / "without/listing.lst").exists()


def test_a_structure_that_is_not_held_is_told(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "strip.yaml").write_text(SETTINGS.replace("clamped: {fixed: all}", "clamped: {fixed: x}"))
    ran = CliRunner().invoke(app, ["run", str(scene), "-o", str(tmp_path / "out")])
    assert ran.exit_code == 1
    assert "can move without resistance" in ran.output


def test_a_strip_that_grows_with_its_temperature(scene: Path, tmp_path: Path) -> None:
    """From the settings' formula through the deck: u = alpha x^2/2 of T = x above the reference 0."""
    settings = """
dimension: 2
materials: {strip: {law: thermo_elastic, E: 1000, nu: 0.0, expansion: 0.01, density: 1}}
sets:
  clamped: {fixed: x y}
  strip: {temperature: x}
"""
    folder = scene.parent
    (folder / "strip.yaml").write_text(settings)
    result = run([scene], output=tmp_path / "out", options={"render": []})
    assert result["status"] == "done"
    shells = settings.replace("dimension: 2", "dimension: 3").replace("1}}", "1, thickness: 0.1}}")
    (folder / "strip.yaml").write_text(shells.replace("x y", "all"))
    run([scene], output=tmp_path / "shells", options={"render": []})
    for name in ("out", "shells"):
        frame = load(tmp_path / name).arrays()
        place = frame["position"] - frame["displacement"]
        np.testing.assert_allclose(frame["displacement"][:, 0], 0.005 * place[:, 0] ** 2, atol=2e-4)
    cold = settings.replace("thermo_elastic", "elastic").replace("expansion: 0.01, ", "")
    (folder / "strip.yaml").write_text(cold)
    result = run([scene], output=tmp_path / "cold", options={"render": []})
    assert any("temperatures do nothing" in warning for warning in result["warnings"])


def test_a_traction_on_an_edge_in_the_plane(scene: Path, tmp_path: Path) -> None:
    """Force by area 10 along x and 0.1 along y: u = sigma x/E in the middle, and the support's forces."""
    (scene.parent / "strip.yaml").write_text("""
dimension: 2
materials: {strip: {law: elastic, E: 1000, nu: 0.0, density: 1}}
sets:
  clamped: {fixed: all}
  tip: {traction: [10, 0.1, 0]}
""")
    run([scene], output=tmp_path / "out", options={"render": []})
    frame = load(tmp_path / "out").arrays()
    np.testing.assert_allclose(frame["reaction"].sum(axis=0), (-10.0, -0.1, 0.0), atol=1e-6)
    tip = np.abs(frame["position"][:, 0] - 2.0) < 0.1
    assert frame["displacement"][tip, 0].mean() == pytest.approx(0.02, rel=1e-4)
    model = read(scene.parent / "strip.dat")
    model.face_loads = [FaceLoad(np.array([[2, 5]]), np.array([[1.0]]), native={"IPRAV": -1})]
    with pytest.raises(InputError, match="shear along edges"):
        structure_problem(model, "strip.dat")


def test_explicit_steps_refuse_damping_by_the_stiffness(scene: Path, tmp_path: Path) -> None:
    """It would be left out in silence."""
    run([scene], output=tmp_path / "out", options={"render": []})
    model = read(scene.parent / "strip.dat")
    control = model.fem_control
    assert control is not None
    control.dynamic, control.integration, control.damping, control.rayleigh = 1, 3, 3, (0.1, 0.0)
    assert structure_problem(model, "strip.dat").dynamics is not None
    control.rayleigh = (0.1, 0.2)
    with pytest.raises(InputError, match="damping by the stiffness in explicit steps"):
        structure_problem(model, "strip.dat")


def test_refusals_have_their_place(scene: Path, tmp_path: Path) -> None:
    run([scene], output=tmp_path / "made")
    with pytest.raises(InputError, match=r"--set:1:1: error: unknown key fem.sovler"):
        run([tmp_path / "strip.dat"], options={"fem.sovler": 1})
    with pytest.raises(InputError, match="tolerance"):
        run([scene], output=tmp_path / "out", options={"fem.tolerance": -1})
    assert not (tmp_path / "out").exists()


def test_an_element_that_is_none_is_a_fault_of_the_deck(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "strip.msh").write_text(MESH.replace("3 2 0 0", "3 1 0 0").replace("6 2 1 0", "6 1 1 0"))
    with pytest.raises(InputError, match=r"strip\.dat:1:1: error: element \d+: its area is not positive"):
        run([scene], output=tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert not (tmp_path / "strip.dat").exists()


def test_plane_elements_that_run_clockwise_are_turned(scene: Path, tmp_path: Path) -> None:
    """Meshers make them; the answer is that of the others."""
    plane = SETTINGS.replace("dimension: 3", "dimension: 2").replace("[0, 0, -1.0e-4]", "[1.0, 0, 0]")
    (tmp_path / "strip.yaml").write_text(plane)
    run([scene], output=tmp_path / "right")
    turned = MESH.replace("1 2 5 4", "1 4 5 2").replace("2 3 6 5", "2 5 6 3")
    (tmp_path / "strip.msh").write_text(turned)
    result = run([scene], output=tmp_path / "turned")
    assert any("2 quad4 elements run clockwise" in warning for warning in result["warnings"])
    right, same = (load(tmp_path / name).arrays()["displacement"] for name in ("right", "turned"))
    np.testing.assert_allclose(same, right, rtol=1e-6, atol=1e-9)


def test_a_picture_of_elements(scene: Path, tmp_path: Path) -> None:
    run([scene], output=tmp_path / "out")
    from zrno.pipelines.errors import Missing
    from zrno.pipelines.render import render

    try:
        files = render(tmp_path / "out", field="displacement_z", size=(320, 240))
        cells = render(tmp_path / "out", field="thickness", size=(320, 240), output=tmp_path / "t.png")
    except Missing as missing:
        pytest.skip(str(missing))
    from matplotlib.image import imread

    picture = imread(files[0])[..., :3]
    assert picture.std() > 0.05  # neither white nor one colour
    assert cells[0].exists()
    with pytest.raises(ValueError, match="no field velocity"):
        render(tmp_path / "out", field="velocity", size=(320, 240))


def test_check_looks_at_structures(scene: Path) -> None:
    rows = check([scene])
    assert [row["faults"] for row in rows] == [[], []]


def test_forces_that_do_nothing_are_told(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "strip.yaml").write_text(SETTINGS.replace("dimension: 3", "dimension: 2"))
    result = run([scene], output=tmp_path / "out")
    assert any("2 forces or moments on degrees of freedom that are held" in w for w in result["warnings"])


def test_integration_is_of_motion(scene: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the deck is static"):
        run([scene], output=tmp_path / "out", options={"fem.integration": "central"})
    with pytest.raises(InputError, match="no such material"):
        run([scene], output=tmp_path / "out", options={"fem.laws": {7: {"law": "perzyna", "k": 1.0, "rate": 1.0}}})
    (tmp_path / "strip.yaml").write_text(SETTINGS.replace("fem: {steps: 4}", "fem: {steps: 4, analysis: dynamic}"))
    said = {}
    for name in ("newmark", "hht", "central"):
        run([scene], output=tmp_path / name, options={"fem.integration": name})
        said[name] = load(tmp_path / name).arrays(None, -1)["displacement"][:, 2].min()
    assert len(set(said.values())) == 3
    assert max(said.values()) < 0.0


@pytest.mark.slow
def test_cam_clay_from_a_deck_is_the_law_at_a_point(scene: Path, tmp_path: Path) -> None:
    """Confined compression of two elements, through the deck's model 9: elastic, then on the ellipse as it grows."""
    numbers = {"E": 1000.0, "nu": 0.3, "M": 1.1, "lambda": 0.15, "kappa": 0.03, "pc": 20.0, "e0": 0.9}
    said = ", ".join(f"{name}: {value}" for name, value in numbers.items())
    (scene.parent / "strip.yaml").write_text(f"""
dimension: 2
materials: {{strip: {{law: cam_clay, {said}, density: 1}}}}
sets:
  clamped: {{fixed: x}}
  strip: {{fixed: y}}
  tip: {{displacement: [-0.1, null, null]}}
fem: {{steps: 10}}
""")
    run([scene], output=tmp_path / "out", options={"render": []})
    assert "    9    1" in (scene.parent / "strip.dat").read_text()
    strain = np.zeros((10, 6))
    strain[:, 0] = -0.005
    path = drive(cam_clay(*numbers.values()), strain)
    results = load(tmp_path / "out")
    found = np.array([results.mesh("elements", k).cell_data["stress"][0] for k in range(1, 11)])
    np.testing.assert_allclose(found[:, :3], path.stress[:, :3], rtol=1e-4)
    assert path.state[-1, 1] > 0.01  # flows
