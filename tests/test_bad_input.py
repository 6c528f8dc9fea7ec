"""Bad input through the command line: exit code 2, every fault with its place, no traceback, nothing written."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import cli, console, run
from zrno.translators import write
from zrno.translators.model import Material, Model, ParticleControl, Particles

PLACE = re.compile(r"[^:]+:[1-9]\d*:[1-9]\d*: error: \S.*")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with a sound deck `sound.mcm` of four particles."""
    monkeypatch.chdir(tmp_path)
    x = np.zeros((4, 3))
    x[:, 0] = np.arange(4.0)
    write(
        Model(
            dimension=2,
            materials={i: Material(i, "steel", "elastic", 7.8, {"E": 2.1, "nu": 0.3}, mass=2.0, h=1.2) for i in (1, 2)},
            particles=Particles(x, np.array([1, 1, 2, 2]), np.zeros(4, np.int64), np.tile([[1e-3, 0, 0]], (4, 1))),
            particle_control=ParticleControl(dimension=2, end_time=1.0, step_option=2),
        ),
        tmp_path / "sound.mcm",
    )
    return tmp_path


def tree(where: Path) -> dict[str, bytes | None]:
    """Everything in a folder."""
    return {str(p.relative_to(where)): p.read_bytes() if p.is_file() else None for p in sorted(where.rglob("*"))}


@pytest.fixture
def refused(folder: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Callable[..., str]:
    """What run says about an input (and check, which says the same); asserts what holds of every bad input.

    command: another one that is to refuse its words.
    """

    def call(command: str, *words: str) -> str:
        console._answers.clear()
        monkeypatch.setattr(sys, "argv", ["zrno", command, *words])
        before = tree(folder)
        with pytest.raises(SystemExit) as stop:
            cli.main()
        _, said = capfd.readouterr()
        assert stop.value.code == 2, said
        assert said.endswith("\n")
        for line in said.splitlines() if command != "convert" else ():  # its targets have no lines
            assert PLACE.fullmatch(line), line
        assert tree(folder) == before
        return said

    def both(name: str, *words: str, command: str = "") -> str:
        if command:
            return call(command, name, *words)
        said = call("run", name, *words)
        if not words:
            assert call("check", name) == said
        return said

    return both


def _changed(folder: Path, old: str, new: str) -> str:
    text = (folder / "sound.mcm").read_text()
    assert text.count(old) == 1, old
    (folder / "bad.mcm").write_text(text.replace(old, new))
    return "bad.mcm"


FIRST = "       1    0                 0.0                 0.0      1"
SECOND = "       2    0                 1.0                 0.0      1"


def test_the_sound_deck_is_sound(
    folder: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", ["zrno", "check", "sound.mcm"])
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert (stop.value.code or 0, *capfd.readouterr()) == (0, "sound.mcm: ok\n", "")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (SECOND, SECOND.replace("1.0", "l.0"), "x is not a number (l.0)"),
        (SECOND, SECOND.replace("    2 ", "    x ", 1), "number is not an integer (x)"),
        (SECOND, SECOND[:-1] + "7", "material number out of range (7)"),
        (SECOND, SECOND[:-1] + "0", "material number out of range (0)"),
        (f"{FIRST}\n{SECOND}", f"{SECOND}\n{FIRST}", "particle number out of order (2)"),
        (f"{SECOND}\n", "", "particle number out of order (3)"),
        ("       1.0       0.0       0.0       0.0", "       1,0       0.0       0.0       0.0", "not a number (1,0)"),
    ],
)  # fmt: skip
def test_a_wrong_field_has_its_place(
    folder: Path, refused: Callable[..., str], old: str, new: str, message: str
) -> None:
    name = _changed(folder, old, new)
    text = (folder / name).read_text()
    said = refused(name)
    assert message in said
    line, column = map(int, said.split(":")[1:3])
    offending = message.partition("(")[2].rstrip(")")
    assert text.splitlines()[line - 1][column - 1 :].startswith(offending)


def test_every_fault_is_said_not_the_first_alone(folder: Path, refused: Callable[..., str]) -> None:
    text = (folder / "sound.mcm").read_text().replace("1.0                 0.0 ", "1.0                 O.0 ")
    (folder / "bad.mcm").write_text(text.replace(" 7.8", "-7.8"))
    said = refused("bad.mcm").splitlines()
    assert [line.partition(" (")[0].split(": error: ")[1] for line in said] == [
        *["density is not positive"] * 2,
        "y is not a number",
    ]


@pytest.mark.parametrize("lines", [1, 8, 14, 22, -9, -4])
def test_a_truncated_deck_ends_with_what_was_expected(folder: Path, refused: Callable[..., str], lines: int) -> None:
    whole = (folder / "sound.mcm").read_text().splitlines()
    (folder / "bad.mcm").write_text("\n".join(whole[:lines]) + "\n")
    assert "the file ends here; expected" in refused("bad.mcm")


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("empty.mcm", b"", "empty.mcm:1:1: error: the file is empty"),
        ("binary.mcm", b"\x7fELF\x02\x01\x01" + bytes(range(256)) * 20, "binary.mcm:1:1: error: a binary file"),
        ("words.mcm", b"Dear reader,\nthis is not a deck.\n", "words.mcm:"),
        ("empty.yaml", b"", "empty.yaml:1:1: error: the file is empty"),
        ("binary.yaml", b"\x7fELF\x02\x01\xff" + bytes(range(256)), "binary.yaml:1:1: error: not YAML"),
        ("torn.yaml", b"decks: [sound.mcm\n", "error: not YAML"),
        ("scene.yaml", b"title: A scene\ndecks: [sound.mcm]\nouptut: {every: 1}\n",
         "scene.yaml:3:1: error: unknown key ouptut (ouptut); expected output"),
        ("nested.yaml", b"decks: [sound.mcm]\noutput:\n  evry: 1\n",
         "nested.yaml:3:3: error: unknown key output.evry (evry); expected every"),
        ("lost.yaml", b"decks: [lost.mcm]\n", "lost.yaml:1:9: error: decks.0: no such file (lost.mcm)"),
    ],
)  # fmt: skip
def test_files_that_are_no_input(
    folder: Path, refused: Callable[..., str], name: str, content: bytes, message: str
) -> None:
    (folder / name).write_bytes(content)
    assert message in refused(name)


def test_a_missing_file_and_a_folder(folder: Path, refused: Callable[..., str]) -> None:
    assert "missing.mcm:1:1: error: no such file" in refused("missing.mcm")
    assert "missing.yaml:1:1: error: no such file" in refused("missing.yaml")
    (folder / "folder.mcm").mkdir()
    assert "folder.mcm:1:1: error: is a directory" in refused("folder.mcm")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--set", "nonsense=1"], "--set:1:1: error: unknown key nonsense"),
        (["--set", "end_time"], "--set:1:1: error: not a key and its value"),
        (["--set", "compat=new"], "--set:1:8: error: compat has a wrong value (new)"),
        (["--set", "output.every=1"], "--set:1:1: error: output.every is for scenes"),
        (["--set", "h_option=3"], "--set:1:10: error: h_option is not what it should be (3)"),
        (["--set", "end_time=soon"], "--set:1:10: error: end_time is not what it should be (soon)"),
        (["--set", "materials.steel.E=5"], "--set:1:19: error: materials.steel.E is for decks that a scene makes"),
        (["--until", "-1"], "--until:1:1: error: the run cannot end before it starts (-1.0)"),
        (["--until", "nan"], "--until:1:1: error: the run cannot end before it starts (nan)"),
    ],
)
def test_options_that_cannot_be(refused: Callable[..., str], words: list[str], message: str) -> None:
    assert message in refused("sound.mcm", *words)


SCENE = """\
meshes: [{source: plate.msh, target: plate.mcm, settings: plate.yaml, spacing: 0.25}]
decks: [plate.mcm]
"""
SETTINGS = """\
end_time: 0.1
materials:
  plate: {law: von_mises, density: 2, E: 10, nu: 0.3, yield_stress: 1}
"""


@pytest.fixture
def scene(folder: Path, plate_msh: str) -> Callable[..., str]:
    """scene((old, new), ...): a scene that makes its deck, with texts replaced in whichever file has them."""

    def make(*changes: tuple[str, str]) -> str:
        for name, text in (("plate.msh", plate_msh), ("scene.yaml", SCENE), ("plate.yaml", SETTINGS)):
            for old, new in changes:
                text = text.replace(old, new)
            (folder / name).write_text(text)
        (folder / "plate.mcm").write_text("what stood here before\n")
        (folder / "full.mcm").mkdir()
        (folder / "scene_results").mkdir()
        (folder / "scene_results" / "history.csv").write_text("time\ns\n0\n")
        return "scene.yaml"

    return make


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("end_time: 0.1", "end_tme: 3"), "plate.yaml:1:1: error: unknown key end_tme"),
        (("spacing: 0.25", "spacing: 0.25, set: {end_tme: 3}"), "scene.yaml:1:92: error: unknown key end_tme"),
        (("settings: plate.yaml, ", ""), "scene.yaml:1:10: error: a part has no material (plate)"),
        (("spacing: 0.25", "part: wing"), "scene.yaml:1:10: error: the mesh has no part wing"),
        (("  plate: {law", "  wing: {law"), "plate.yaml:3:3: error: materials of a part that the mesh does not have"),
        (("4 0 1 0", "4 0 x 0"), "plate.msh:14:5: error: "),
        (("plate.mcm", "lost/plate.mcm"), "scene.yaml:1:38: error: meshes.0.target: in a folder that there is not"),
        (("plate.mcm", "full.mcm"), "scene.yaml:1:38: error: meshes.0.target: a folder"),
    ],
)
def test_a_scene_of_bad_input_writes_no_deck(
    scene: Callable[..., str], refused: Callable[..., str], change: tuple[str, str], message: str
) -> None:
    assert message in refused(scene(change))


@pytest.mark.parametrize(
    ("change", "words", "message"),
    [
        (("spacing: 0.25",
          "spacing: 0.25, set: {birth_death: {option: 2, particles: [0, 0], death_plane: [0, 0, 0, 3]}}"),
         [], "scene.yaml:1:114: error: no such orientation of the plane of death"),
        (("decks: [", "coupling: {contact: pinball}\ndecks: ["), [],
         "scene.yaml:2:1: error: coupling is of grain and structure, and this scene has one deck"),
        (("", ""), ["--set", "sph.kernel=cubc"], "--set:1:12: error: sph.kernel has a wrong value (cubc)"),
        (("von_mises, density: 2, E: 10, nu: 0.3, yield_stress: 1", "cap, density: 2, K: 10, G: 5, alpha: 1"), [],
         "plate.yaml:3:16: error: material 1: W 0.0 and D 0.0 must be positive: the cap hardens by them"),
        (("decks: [", "render: [{field: presure}]\ndecks: ["), [],
         "scene.yaml:2:18: error: render.0.field: no such field (presure); expected pressure (did you mean that?)"),
        (("", ""), ["-o", "plate.yaml"], "plate.yaml:1:1: error: not a folder"),
    ],
)  # fmt: skip
def test_a_scene_that_the_solver_refuses_writes_nothing(
    scene: Callable[..., str], refused: Callable[..., str], change: tuple[str, str], words: list[str], message: str
) -> None:
    name = scene(change)
    assert message in refused(name, *words, command="run")


def test_a_scene_whose_deck_changed_is_not_resumed_and_its_deck_not_replaced(
    folder: Path, scene: Callable[..., str], refused: Callable[..., str], capfd: pytest.CaptureFixture[str]
) -> None:
    name = scene()
    run([name])
    assert (folder / "plate.mcm").read_text().startswith("plate")
    said = refused(name, "--resume", "--set", "spacing=0.5")
    assert "plate.mcm:1:1: error: not the input that checkpoint_" in said


@pytest.mark.parametrize(
    ("words", "change", "message"),
    [
        (["plate.msh", "new.mcm"], ("", ""), "--settings:1:1: error: a part has no material (plate)"),
        (["plate.msh", "new.mcm", "--settings", "plate.yaml"], (", E: 10", ""), "plate.yaml:3:3: error: materials."),
        (["plate.msh", "new.mcm", "--settings", "lost.yaml"], ("", ""), "lost.yaml:1:1: error: no such file"),
        (["plate.msh", "plate.mcm", "--settings", "plate.yaml", "--strict"], ("", ""), "the target cannot say all"),
        (["plate.msh", "new.vtu", "--dialect", "2.07"], ("", ""), "new.vtu: a dialect is for .mcm decks"),
        (["plate.msh", "new.vtu", "--spacing", "2"], ("", ""), "make a particle deck (.mcm) of a mesh"),
        (["plate.msh", "new.xyz"], ("", ""), "new.xyz: files of this kind are not written"),
        (["sound.mcm", "new.mcm", "--particles", "nodes"], ("", ""), "make a particle deck (.mcm) of a mesh"),
        (["plate.msh", "lost/new.mcm", "--settings", "plate.yaml"], ("", ""), "no such file or directory"),
    ],
)  # fmt: skip
def test_a_refused_conversion_writes_nothing(
    scene: Callable[..., str],
    refused: Callable[..., str],
    words: list[str],
    change: tuple[str, str],
    message: str,
) -> None:
    scene(change)
    assert message in refused(*words, command="convert")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("kupa1.mcm", ":869:5: error: velocity card past the last particle 802 (2700)"),
        ("kipkupa.mcm", ":41:1: error: material 2 owns no particle"),
    ],
)
def test_decks_of_the_original_program_that_are_not_for_a_run_alone(
    shared: Path, folder: Path, refused: Callable[..., str], name: str, message: str
) -> None:
    shutil.copyfile(shared / "samples" / "mcm" / name, folder / name)
    assert name + message in refused(name)
