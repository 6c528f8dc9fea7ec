"""The commands on keyword decks: info, check, convert."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from zrno.pipelines import cli, console


@pytest.fixture
def zrno(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """zrno(words...) -> exit code, stdout, stderr; in a folder of its own."""
    monkeypatch.chdir(tmp_path)

    def call(*words: str) -> tuple[int, str, str]:
        console._answers.clear()
        with pytest.raises(SystemExit) as stop:
            cli.app([*words])
        code = stop.value.code
        return (int(code or 0), *capfd.readouterr())

    return call


def test_info(zrno: Any, everything: str, tmp_path: Path) -> None:
    (tmp_path / "part.k").write_text(everything)
    (tmp_path / "main.key").write_text("*INCLUDE\npart.k\n")
    code, out, _ = zrno("info", "main.key", "--json")
    found = json.loads(out)
    assert code == 0
    assert (found["format"], found["nodes"], found["particles"]) == ("lsdyna", 15, 3)
    assert found["elements"] == {"hex8": 1, "pyramid5": 1, "quad4": 1, "tri3": 1, "line2": 2, "point1": 2}
    assert found["includes"] == ["part.k"]
    assert found["parts"]["1"] == "a block, of steel"
    assert found["materials"]["4"] == {"name": "", "law": "cap", "density": 1.85e-9}
    assert found["sets"]["the bottom"] == 4
    assert found["bounding_box"] == [[0.0, 0.0, 0.0], [3.0, 1.0, 1.0]]


def test_info_of_a_piece(zrno: Any, tmp_path: Path) -> None:
    (tmp_path / "piece.dyn").write_text("*ELEMENT_SOLID\n1,1,1,2,3,4,5,6,7,8\n*INCLUDE\nlost.k\n")
    code, out, _ = zrno("info", "piece.dyn", "--json")
    assert code == 0
    assert json.loads(out)["elements"] == {"hex8": 1}
    assert len(json.loads(out)["warnings"]) == 2
    code, _, error = zrno("check", "piece.dyn")
    assert (code, error) == (
        2,
        "piece.dyn:4:1: error: there is no such file to include (lost.k); expected a file in .\n",
    )


def test_check(zrno: Any, everything: str, tmp_path: Path) -> None:
    (tmp_path / "good.k").write_text(everything)
    (tmp_path / "bad.k").write_text(
        everything.replace("       3             1.0             1.0", "       3             1.0             l.0", 1)
    )
    code, out, error = zrno("check", "good.k", "bad.k")
    assert code == 2
    assert out.startswith("good.k: ok\n")
    line = 1 + everything[: everything.index("       3             1.0             1.0")].count("\n")
    assert error.startswith(f"bad.k:{line}:38: error: xyz is not a number (l.0)")


def test_convert_from_a_deck_to_a_deck(zrno: Any, everything: str, tmp_path: Path) -> None:
    (tmp_path / "a.k").write_text(everything)
    code, out, _ = zrno("convert", "a.k", "b.k", "--strict")
    assert (code, out) == (0, "b.k\n")
    first, second = (json.loads(zrno("info", name, "--json")[1]) for name in ("a.k", "b.k"))
    assert first | {"warnings": []} == second | {"warnings": []}


def test_convert_refuses_a_piece(zrno: Any, tmp_path: Path) -> None:
    (tmp_path / "piece.k").write_text("*ELEMENT_SOLID\n1,1,1,2,3,4,5,6,7,8\n")
    for target in ("a.k", "a.vtu", "a.mcm", "a.msh"):
        code, _, error = zrno("convert", "piece.k", target)
        assert code == 2
        assert "1 element points at nodes that are not in the file" in error
        assert not (tmp_path / target).exists()


def test_includes_outside(zrno: Any, cube: str, tmp_path: Path) -> None:
    (tmp_path / "deck").mkdir()
    (tmp_path / "nodes.k").write_text(cube)
    (tmp_path / "deck/main.k").write_text("*INCLUDE\n../nodes.k\n*ELEMENT_SHELL\n1,1,1,2,3,4\n")
    for words in (("info",), ("check",), ("convert",)):
        names = [words[0], "deck/main.k", *(["out.vtu"] if words[0] == "convert" else [])]
        code, _, error = zrno(*names)
        assert code == 2
        assert "deck/main.k:2:1: error: an included file is outside the folder of the deck (../nodes.k)" in error
        assert "--allow-outside" in error
        assert zrno(*names, "--allow-outside")[0] == 0
    assert (tmp_path / "out.vtu").exists()
