"""Bad input through the command line: exit code 2, every fault with its place, no traceback, nothing written."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import cli, console
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
    """What run says about an input (and check, which says the same); asserts what holds of every bad input."""

    def call(command: str, *words: str) -> str:
        console._answers.clear()
        monkeypatch.setattr(sys, "argv", ["zrno", command, *words])
        before = tree(folder)
        with pytest.raises(SystemExit) as stop:
            cli.main()
        _, said = capfd.readouterr()
        assert stop.value.code == 2, said
        assert said.endswith("\n")
        for line in said.splitlines():
            assert PLACE.fullmatch(line), line
        assert tree(folder) == before
        return said

    def both(name: str, *words: str) -> str:
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
        (["--set", "h_option=1"], "--set:1:10: error: a smoothing length that changes is not computed yet"),
        (["--set", "end_time=soon"], "--set:1:10: error: end_time is not what it should be (soon)"),
        (["--set", "materials.steel.E=5"], "--set:1:19: error: materials.steel.E is for decks that a scene makes"),
        (["--until", "-1"], "--until:1:1: error: the run cannot end before it starts (-1.0)"),
        (["--until", "nan"], "--until:1:1: error: the run cannot end before it starts (nan)"),
    ],
)
def test_options_that_cannot_be(refused: Callable[..., str], words: list[str], message: str) -> None:
    assert message in refused("sound.mcm", *words)


def test_a_scene_that_cannot_be_run_writes_no_deck(folder: Path, refused: Callable[..., str]) -> None:
    (folder / "scene.yaml").write_text(
        "meshes: [{source: sound.msh, target: made.mcm, set: {end_tme: 3}}]\ndecks: [made.mcm]\n"
    )
    (folder / "sound.msh").write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
    assert "scene.yaml:1:" in refused("scene.yaml")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("kupa1.mcm", ":869:5: error: velocity card past the last particle 802 (2700)"),
        ("kipkupa.mcm", ":31:10: error: material model 4, generalised cap, is not supported"),
    ],
)
def test_decks_of_the_original_program_that_are_not_for_a_run_alone(
    shared: Path, folder: Path, refused: Callable[..., str], name: str, message: str
) -> None:
    shutil.copyfile(shared / "samples" / "mcm" / name, folder / name)
    assert name + message in refused(name)
