"""`zrno check`: what a run would refuse is a warning of a sound deck; a scene is checked with the decks it makes."""

from __future__ import annotations

from pathlib import Path

import pytest

from zrno.pipelines import samples
from zrno.pipelines.check import check, check_text, fault_lines
from zrno.pipelines.run import run
from zrno.translators import InputError, load_settings

SCENE = "meshes: [{source: plate.msh, target: plate.mcm, settings: plate.yaml, spacing: 0.25}]\ndecks: [plate.mcm]\n"
SETTINGS = "end_time: 0.1\nmaterials:\n  plate: {density: 2, E: 10, nu: 0.3}\n"

OF_HALF_THE_VOLUME = "law: fluid, eos: {type: perfect_gas, gamma: 1.4, E0: 1, V0: 0.5}"


@pytest.fixture
def scene(tmp_path: Path, plate_msh: str) -> Path:
    (tmp_path / "plate.msh").write_text(plate_msh)
    (tmp_path / "plate.yaml").write_text(SETTINGS)
    (tmp_path / "scene.yaml").write_text(SCENE)
    return tmp_path / "scene.yaml"


def _short(folder: Path, text: str) -> list[str]:
    return text.replace(f"{folder}/", "").splitlines()


def test_the_decks_that_a_scene_makes_are_checked_and_nothing_is_written(scene: Path) -> None:
    rows = check([scene])
    assert fault_lines(rows) == []
    assert _short(scene.parent, check_text(rows)) == [
        "scene.yaml: ok",
        "plate.mcm: ok",
        "  warning: dropped: 1 line2 elements - of lower dimension than the parts: no particles are made of them",
        "  warning: dropped: 1 node sets - an .mcm deck has none: edge",
    ]
    assert sorted(path.name for path in scene.parent.iterdir()) == ["plate.msh", "plate.yaml", "scene.yaml"]


def test_what_cannot_be_run_yet_is_a_warning_where_it_was_asked(scene: Path) -> None:
    (scene.parent / "plate.yaml").write_text(SETTINGS.replace("E: 10, nu: 0.3", OF_HALF_THE_VOLUME))
    rows = check([scene])
    assert fault_lines(rows) == []
    warning = "plate.yaml:3:28: cannot be run yet: material 1: an initial relative volume V0 of 0.5 is not computed yet"
    assert f"  warning: {warning}" in _short(scene.parent, check_text(rows))


def test_a_deck_that_cannot_be_run_yet_is_sound(scene: Path) -> None:
    from zrno.pipelines.convert import convert

    deck = scene.parent / "deck.mcm"
    (scene.parent / "plate.yaml").write_text(SETTINGS.replace("E: 10, nu: 0.3", OF_HALF_THE_VOLUME))
    settings = load_settings(scene.parent / "plate.yaml")
    convert([scene.parent / "plate.msh"], deck, spacing=0.5, settings=settings)
    rows = check([deck])
    assert fault_lines(rows) == []
    assert _short(scene.parent, check_text(rows)) == [
        "deck.mcm: ok",
        "  warning: deck.mcm:17:1: cannot be run yet: material 1: an initial relative volume V0 of 0.5 is not computed "
        "yet",
    ]


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("plate.msh", "4 0 1 0", "4 0 x 0", "plate.msh:14:5: error: "),
        ("plate.yaml", "E: 10", "E: ten", "plate.yaml:3:26: error: materials.plate.E is not what it should be (ten)"),
        ("plate.yaml", "  plate", "  wing", "plate.yaml:2:1: error: a part has no material (plate)"),
        ("scene.yaml", "spacing", "spacng", "scene.yaml:1:71: error: unknown key meshes.0.spacng"),
        ("scene.yaml", "0.25", "0.25, part: [8]", "scene.yaml:1:10: error: the mesh has no part 8; it has: 7 plate"),
        ("scene.yaml", "0.25", "0.25, particles: shells, set: {dimension: 3}", "scene.yaml:1:111: error: the mesh"),
    ],
)
def test_faults_of_meshes_settings_and_scene_have_their_places(
    scene: Path, file: str, old: str, new: str, said: str
) -> None:
    path = scene.parent / file
    text = path.read_text()
    assert text.count(old) >= 1
    path.write_text(text.replace(old, new, 1))
    lines = _short(scene.parent, "\n".join(fault_lines(check([scene]))))
    assert lines[0].startswith(said), lines


def test_both_decks_of_a_pair_are_looked_at(scene: Path) -> None:
    (scene.parent / "plate.dat").write_text("C a deck\n")
    scene.write_text(SCENE.replace("[plate.mcm]", "[plate.dat, plate.mcm]"))
    rows = {Path(row["file"]).name: row for row in check([scene])}
    assert sorted(rows) == ["plate.dat", "plate.mcm", "scene.yaml"]
    assert rows["plate.dat"]["faults"]
    assert not rows["plate.mcm"]["faults"]


def test_two_decks_of_a_kind_make_no_run(tmp_path: Path) -> None:
    for name in ("a.mcm", "b.mcm"):
        (tmp_path / name).write_text("")
    with pytest.raises(InputError, match=r"these do not make a run .a.mcm, b.mcm.; expected one .mcm, one .dat"):
        run([tmp_path / "a.mcm", tmp_path / "b.mcm"], output=tmp_path / "out")


def test_samples_are_sound_without_a_warning(tmp_path: Path) -> None:
    folder = samples.copy("two_cylinders", tmp_path / "cylinders")
    rows = check([folder / "scene.yaml"])
    assert _short(folder, check_text(rows)) == ["scene.yaml: ok", "cylinders.mcm: ok"]


@pytest.mark.parametrize(
    ("settings", "sph", "said"),
    [
        ("axisymmetric: true\n", "xsph: 0.1", "an axisymmetric run does not go with XSPH"),
        ("axisymmetric: true\ngravity: [1, 0, 0]\n", "", "does not go with a body force across the axis"),
        ("", "sleep: 0.01", "particles cannot sleep without a constant base acceleration"),
        ("", "local_steps: true", "local time steps do not go together with kernel contact"),
        (
            "planes: {xmax: [limit, 5]}\n",
            "total_lagrangian: true",
            "does not go together with periodic and limit planes",
        ),
    ],
)
def test_what_does_not_go_together_is_a_warning(scene: Path, settings: str, sph: str, said: str) -> None:
    """The solver's refusals, with the scene's own section; without it the same scene is sound."""
    (scene.parent / "plate.yaml").write_text(SETTINGS + settings)
    scene.write_text(SCENE + f"sph: {{{sph}}}\n")
    rows = check([scene])
    assert fault_lines(rows) == []
    assert any("cannot be run" in line and said in line for line in _short(scene.parent, check_text(rows)))
