"""Scene files: every fault with its place; options; decks made from meshes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines import options, scene
from zrno.pipelines.sections import Friction
from zrno.translators import InputError, load_settings, read, yaml_marks
from zrno.translators.model import Material, Model, ParticleControl

MESH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 7 "plate"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 2 0 0
3 2 1 0
4 0 1 0
$EndNodes
$Elements
1
1 3 2 7 1 1 2 3 4
$EndElements
"""
SETTINGS = "end_time: 3\nmaterials:\n  plate: {law: elastic, density: 2, E: 10, nu: 0.3}\n"


def _scene(folder: Path, text: str) -> Path:
    (folder / "plate.msh").write_text(MESH)
    (folder / "plate.yaml").write_text(SETTINGS)
    path = folder / "scene.yaml"
    path.write_text(text)
    return path


GOOD = """\
title: A plate
units: mm-ms-g
meshes:
  - {source: plate.msh, target: plate.mcm, settings: plate.yaml, spacing: 0.25}
decks: [plate.mcm]
coupling: {surface: all, contact: potential, friction: {static: 0.65, kinetic: 0.55}}
output: {every: 1e-1, format: vtp}
render: [{field: von_mises, time: last, view: iso}, {time: 0.5}]
checkpoint: {every: 100}
study:
  reference: plate.yaml
  quantity: tip
  vary: {spacing: [8, 4, 2], step_factor: [0.8, 0.4]}
  tolerance: 0.05
"""


def _faults(path: Path, **options: object) -> list[str]:
    with pytest.raises(InputError) as error:
        scene.load(path, options)
    return [str(fault).removeprefix(f"{path.parent}/") for fault in error.value.faults]


def test_the_whole_scene_is_read(tmp_path: Path) -> None:
    read_scene = scene.load(_scene(tmp_path, GOOD))
    assert read_scene.coupling is not None
    assert read_scene.coupling.friction == Friction(static=0.65, kinetic=0.55)
    assert read_scene.output.every == 0.1
    assert [picture.time for picture in read_scene.render] == ["last", 0.5]
    assert read_scene.system is not None
    assert (read_scene.system.stress, read_scene.system.gravity) == ("MPa", pytest.approx(9.80665e-3))


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (
            "static: 0.65",
            "static: 0.5",
            "scene.yaml:6:65: error: coupling.friction.static: must be >= kinetic (0.5); expected at least 0.55",
        ),
        ("units", "unit", "scene.yaml:2:1: error: unknown key unit (unit); expected units (did you mean that?)"),
        (
            "spacing: 0.25",
            "sapcing: 1",
            "scene.yaml:4:66: error: unknown key meshes.0.sapcing (sapcing); expected spacing (did you mean that?)",
        ),
        (
            "spacing: 0.25",
            "spacing: -1e-3",
            "scene.yaml:4:75: error: meshes.0.spacing has a wrong value (-1e-3); expected a value greater than 0",
        ),
        (
            "contact: potential",
            "contact: magic",
            "scene.yaml:6:35: error: coupling.contact has a wrong value (magic);"
            " expected 'kernel', 'potential', 'pinball' or 'face'",
        ),
        ("decks: [plate.mcm]", "", "scene.yaml:1:1: error: decks is missing; expected the key decks"),
        (
            "decks: [plate.mcm]",
            "decks: [plate.mcm, other.mcm]",
            "scene.yaml:5:8: error: decks: plate.mcm, other.mcm do not make a run;"
            " expected one .mcm, one .dat, or one of each",
        ),
        (
            "decks: [plate.mcm]",
            "decks: [other.mcm]",
            "scene.yaml:5:9: error: decks.0: no such file (other.mcm); expected a file beside the scene,"
            " or a target of meshes",
        ),
        (
            "source: plate.msh",
            "source: none.msh",
            "scene.yaml:4:14: error: meshes.0.source: no such file (none.msh); expected a file beside the scene",
        ),
        (
            "time: last",
            "time: lost",
            "scene.yaml:8:35: error: render.0.time: is no time (lost); expected a time, last or all",
        ),
        (
            "view: iso",
            "view: up",
            "scene.yaml:8:47: error: render.0.view: is no view (up); expected one of iso, x, y, z, -x, -y, -z, "
            "or a direction as 1,-2,0.5",
        ),
        (
            "reference: plate.yaml",
            "reference: plate.yaml\n  analytic: beam",
            "scene.yaml:12:13: error: study.analytic: stands beside study.reference (beam); expected one of the two",
        ),
        (
            "title: A plate",
            "title: A\ntitle: B",
            "scene.yaml:2:1: error: the key stands twice (title); expected each key once",
        ),
        (
            "spacing: 0.25",
            "set: {end_tim: 3}",
            "scene.yaml:4:72: error: unknown key end_tim (end_tim); expected end_time (did you mean that?)",
        ),
    ],
)
def test_a_fault_has_its_place(tmp_path: Path, old: str, new: str, fault: str) -> None:
    assert old in GOOD
    said = _faults(_scene(tmp_path, GOOD.replace(old, new)))
    assert said == [fault]


def test_all_faults_are_said_and_at_most_twenty(tmp_path: Path) -> None:
    two = GOOD.replace("every: 100", "every: -1").replace("format: vtp", "format: bmp")
    assert [line.split(":")[1] for line in _faults(_scene(tmp_path, two))] == ["7", "9"]
    many = GOOD + "".join(f"key{i}: 1\n" for i in range(50))
    assert len(_faults(_scene(tmp_path, many))) == 20


def test_text_that_is_no_yaml(tmp_path: Path) -> None:
    assert _faults(_scene(tmp_path, "title: [a, b\nunits: c\n"))[0].startswith("scene.yaml:2:6: error: not YAML")
    path = tmp_path / "binary.yaml"
    path.write_bytes(b"a: 1\nb: \x00\xff\n")
    assert _faults(path)[0].startswith("binary.yaml:")
    assert "mapping" in _faults(_scene(tmp_path, "- a\n- b\n"))[0]
    loop = _faults(_scene(tmp_path, "a: &a\n  b: *a\n"))
    assert any("contains itself" in line for line in loop)


def test_faults_of_settings_keep_their_own_place(tmp_path: Path) -> None:
    path = _scene(tmp_path, GOOD)
    (tmp_path / "plate.yaml").write_text(SETTINGS.replace("nu: 0.3", "nu: 0.6"))
    assert _faults(path)[0].startswith("plate.yaml:3:")


@pytest.mark.parametrize(
    ("settings", "place"),
    [
        ("set: {materials: {plate: {E: -1}}}", "4:95: error: materials.plate.E is not what it should be (-1)"),
        ("set: {materials.plate.nu: 0.7}", "4:72: error: materials.plate.nu is too large (0.7)"),
        ("set: {materials.plate: {EE: 1}}", "4:90: error: unknown key materials.plate.EE (EE)"),
        ("set: {end_time: {a: 1}}", "4:83: error: there is no end_time.a (1)"),
        ("set: {end_time.a: 1}", "4:72: error: there is no end_time.a (1)"),
    ],
)
def test_faults_of_settings_in_the_scene_have_their_place_there(tmp_path: Path, settings: str, place: str) -> None:
    said = _faults(_scene(tmp_path, GOOD.replace("spacing: 0.25", settings)))
    assert [line.startswith(f"scene.yaml:{place}") for line in said] == [True], said


def test_faults_of_settings_that_are_nowhere_stand_at_the_mesh(tmp_path: Path) -> None:
    text = GOOD.replace("settings: plate.yaml, spacing: 0.25", "set: {friction.static: 0.1}")
    assert _faults(_scene(tmp_path, text)) == [
        "scene.yaml:4:50: error: friction.kinetic is missing (null); expected static and kinetic"
    ]


def test_settings_in_place_are_stronger_than_the_file(tmp_path: Path, make_decks: Any) -> None:
    text = GOOD.replace("spacing: 0.25", "spacing: 0.25, set: {materials: {plate: {E: 20}}, end_time: 5}")
    loaded = scene.load(_scene(tmp_path, text))
    assert loaded.meshes[0].set == {"materials.plate.E": 20, "end_time": 5}
    make_decks(loaded, tmp_path)
    deck = read(tmp_path / "plate.mcm")
    assert deck.materials[1].parameters["E"] == 20
    assert deck.particle_control is not None
    assert deck.particle_control.end_time == 5


def test_options_go_where_they_belong(tmp_path: Path, make_decks: Any) -> None:
    given = options.parse(
        [
            "compat=original",
            "output.every=1e-3",
            "render.1.field=pressure",
            "spacing=0.5",
            "end_time=7",
            "materials.plate.E=5",
        ]
    )
    sorted_options = options.split(given)
    assert sorted_options.run == {"compat": "original"}
    assert sorted_options.settings == {"end_time": 7, "materials.plate.E": 5}
    loaded = scene.load(_scene(tmp_path, GOOD), sorted_options.scene)
    assert loaded.output.every == 1e-3
    assert loaded.render[1].field == "pressure"
    assert loaded.meshes[0].spacing == 0.5
    make_decks(loaded, tmp_path)
    deck = read(tmp_path / "plate.mcm")
    assert deck.particles is not None
    assert len(deck.particles) == 8  # 2 x 1 at a spacing of 0.5
    assert deck.materials[1].parameters["E"] == 5


def test_bad_options_say_what_is_known(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"--set:1:1: error: unknown key endtime .* end_time \(did you mean"):
        options.split({"endtime": 1})
    with pytest.raises(InputError, match="compat has a wrong value"):
        options.split({"compat": "modern"})
    with pytest.raises(InputError, match="not a key and its value"):
        options.parse(["novalue"])
    assert _faults(_scene(tmp_path, GOOD), **{"output.every": -1})[0].startswith("--set:1:14: error: output.every")
    assert _faults(_scene(tmp_path, GOOD), **{"output.evry": 1})[0].startswith("--set:1:1: error: unknown key")
    path = _scene(tmp_path, "decks: [plate.mcm]\n")
    (tmp_path / "plate.mcm").touch()
    assert _faults(path, end_time=3)[0].startswith("--set:1:1: error: end_time: this scene makes no deck from a mesh")
    assert "there is no render.5.field" in _faults(_scene(tmp_path, GOOD), **{"render.5.field": "x"})[0]


def test_settings_of_a_deck_that_is_there() -> None:
    model = Model(materials={1: Material(1)}, particle_control=ParticleControl(end_time=1.0))
    options.apply({"end_time": 4, "gravity": [0, 0, -9.8], "xsph": True, "viscosity.linear": 0.1}, model)
    control = model.particle_control
    assert control is not None
    assert (control.end_time, control.base_acceleration, control.velocity_option) == (4.0, (0.0, 0.0, -9.8), 1)
    assert model.materials[1].viscosity_linear == 0.1
    with pytest.raises(InputError, match="a scene makes from a mesh"):
        options.apply({"h_factor": 1.3}, model)


def test_numbers_as_engineers_write_them() -> None:
    assert [yaml_marks.parse_value(text) for text in ("1e-3", "-2E5", ".5", "3", "text", "[1e1, 2]")] == [
        1e-3,
        -2e5,
        0.5,
        3,
        "text",
        [10.0, 2],
    ]


def test_strict_writes_nothing_when_something_is_lost(tmp_path: Path) -> None:
    from zrno.pipelines.convert import convert

    lines = MESH.replace('1\n2 7 "plate"', '2\n1 3 "edge"\n2 7 "plate"')
    lines = lines.replace("$Elements\n1\n", "$Elements\n2\n2 1 2 3 1 1 2\n")
    (tmp_path / "plate.msh").write_text(lines)
    (tmp_path / "plate.yaml").write_text(SETTINGS)
    target = tmp_path / "plate.mcm"
    how = {"settings": load_settings(tmp_path / "plate.yaml"), "spacing": 0.5}
    with pytest.raises(ValueError, match="node sets"):
        convert([tmp_path / "plate.msh"], target, strict=True, **how)  # type: ignore[arg-type]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["plate.msh", "plate.yaml"]
    result = convert([tmp_path / "plate.msh"], target, **how)  # type: ignore[arg-type]
    assert [item["what"] for item in result["dropped"]] == ["line2 elements", "node sets"]
    assert target.exists()


def test_several_meshes_become_one(tmp_path: Path) -> None:
    from zrno.translators.merge import merge

    (tmp_path / "a.msh").write_text(MESH)
    one, two = read(tmp_path / "a.msh"), read(tmp_path / "a.msh")
    whole = merge([one, two])
    assert len(whole.xyz) == 8
    assert len(set(whole.node_ids.tolist())) == 8
    assert len(whole.parts) == 2
    parts = np.concatenate([block.part for block in whole.blocks])
    assert sorted(parts.tolist()) == sorted(whole.parts)
    assert whole.blocks[1].nodes.min() == 4
    with pytest.raises(ValueError, match="particle deck"):
        merge([one, _deck()])


def test_a_scenes_pictures_are_drawn_as_it_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from zrno.pipelines.run import _pictures

    asked: list[dict[str, Any]] = []
    monkeypatch.setattr("zrno.pipelines.render.render", lambda folder, **options: asked.append(options) or [])
    text = GOOD.replace("{time: 0.5}", "{field: pressure, time: 0.5, view: x, size: [640, 480], most: 3}")
    _pictures(scene.load(_scene(tmp_path, text)), tmp_path, [])
    assert asked[1] == {"field": "pressure", "of": None, "most": 3.0, "time": 0.5, "view": "x", "size": (640, 480)}


def _deck() -> Model:
    from zrno.translators.model import Particles

    return Model(particles=Particles(np.zeros((1, 3)), np.ones(1, np.int64), np.zeros(1, np.int64)))
