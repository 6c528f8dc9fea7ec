"""The command line: options, exit codes, one JSON object, no traceback."""

from __future__ import annotations

import json
import subprocess
import sys
import time
import types
from pathlib import Path
from typing import Any

import pytest

from zrno.pipelines import cli, console
from zrno.pipelines.errors import Missing, RunFailed
from zrno.solvers.errors import Diverged
from zrno.translators import read

ZRNO = [sys.executable, "-c", "from zrno.pipelines.cli import main; main()"]


class Called:
    """What a stand-in of a pipeline was called with."""

    def __init__(self, result: Any) -> None:
        self.result = result
        self.args: tuple[Any, ...] = ()
        self.kwargs: dict[str, Any] = {}

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        self.args, self.kwargs = args, kwargs
        if isinstance(self.result, BaseException):
            raise self.result
        return self.result


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Put a stand-in for `zrno.pipelines.NAME.NAME`, which returns or raises what it is given."""

    def put(name: str, result: Any) -> Called:
        called = Called(result)
        module = types.ModuleType(f"zrno.pipelines.{name}")
        setattr(module, name, called)
        monkeypatch.setitem(sys.modules, module.__name__, module)
        return called

    return put


def _call(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    console._answers.clear()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["zrno", *words])
        with pytest.raises(SystemExit) as stop:
            cli.main()
    out, err = capsys.readouterr()
    return int(stop.value.code or 0), out, err


RESULT = {
    "status": "done",
    "steps": 3,
    "time": 0.5,
    "output": "results",
    "pictures": ["p.png"],
    "energy": {"final": float("nan")},
}


def test_help_answers_in_under_a_third_of_a_second() -> None:
    walls = []
    for _ in range(5):
        start = time.perf_counter()
        done = subprocess.run([*ZRNO, "--help"], capture_output=True, text=True, check=True)
        walls.append(time.perf_counter() - start)
    assert "convert" in done.stdout
    assert min(walls) < 0.3


def test_all_commands_take_json_verbose_and_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    commands = ("convert", "info", "check", "run", "render", "plot", "study", "doctor")
    for words in [*([c] for c in commands), ["samples", "list"], ["samples", "copy"]]:
        code, out, _ = _call(capsys, *words, "--help")
        assert code == 0
        for option in ("--json", "-v,", "-q,"):
            assert option in out, (words, option)


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    from importlib.metadata import version

    code, out, _ = _call(capsys, "--version")
    assert code == 0
    assert out.startswith(f"zrno {version('zrno')}")


def test_completion_is_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert "--install-completion" in _call(capsys, "--help")[1]


def test_run_hands_its_options_on(capsys: pytest.CaptureFixture[str], stand_in: Any) -> None:
    called = stand_in("run", RESULT)
    words = ["run", "a.mcm", "b.dat", "-o", "out", "--threads", "2", "--until", "1.5", "--resume"]
    code, out, _ = _call(capsys, *words, "--set", "compat=original", "--set", "end_time=1e-3", "-q")
    assert code == 0
    assert called.args == ([Path("a.mcm"), Path("b.dat")],)
    assert called.kwargs == {
        "output": Path("out"),
        "threads": 2,
        "until": 1.5,
        "resume": True,
        "allow_outside": False,
        "options": {"compat": "original", "end_time": 1e-3},
        "quiet": True,
        "progress": False,
        "known": {},
    }
    assert out == "done: 3 steps to t = 0.5, results\np.png\n"


def test_json_is_one_object_and_has_no_nan(capsys: pytest.CaptureFixture[str], stand_in: Any) -> None:
    stand_in("run", RESULT)
    code, out, _ = _call(capsys, "run", "a.mcm", "--json")
    assert code == 0
    assert json.loads(out, parse_constant=pytest.fail) == RESULT | {"energy": {"final": None}}


@pytest.mark.parametrize(
    ("error", "code", "message"),
    [
        (Diverged(7, 42, "negative density"), 1, "error: step 7 at particle 42: negative density"),
        (RunFailed("the disk is full"), 1, "error: the disk is full"),
        (ValueError("no field x"), 2, "error: no field x"),
        (FileNotFoundError(2, "No such file or directory", "a.mcm"), 2, "a.mcm: error: no such file or directory"),
        (Missing("install EGL"), 3, "error: install EGL"),
        (ImportError("no gmsh"), 3, "error: no gmsh"),
        (KeyboardInterrupt(), 130, "interrupted"),
        (ZeroDivisionError("oops"), 1, "internal error: ZeroDivisionError: oops (-v shows where)"),
    ],
)
def test_what_goes_wrong_has_its_exit_code(
    capsys: pytest.CaptureFixture[str], stand_in: Any, error: BaseException, code: int, message: str
) -> None:
    stand_in("run", error)
    assert _call(capsys, "run", "a.mcm") == (code, "", message + "\n")
    found, out, err = _call(capsys, "run", "a.mcm", "--json")
    assert (found, err) == (code, message + "\n")
    assert json.loads(out)["errors"] == [message]


def test_a_traceback_only_when_asked_for(capsys: pytest.CaptureFixture[str], stand_in: Any) -> None:
    stand_in("run", ZeroDivisionError("oops"))
    assert "Traceback" not in _call(capsys, "run", "a.mcm")[2]
    assert "Traceback" in _call(capsys, "run", "a.mcm", "-v")[2]


@pytest.mark.parametrize(
    "words",
    [
        ["run"],
        ["nonsense"],
        ["info", "--frobnicate", "x"],
        ["convert", "a.msh", "b.mcm", "--dialect", "1"],
        ["render", "d", "--size", "big"],
        ["run", "a.mcm", "--set", "novalue"],
        ["info", "missing.mcm"],
        ["convert", "only_one.msh"],
    ],
)
def test_wrong_usage_is_exit_code_2(capsys: pytest.CaptureFixture[str], stand_in: Any, words: list[str]) -> None:
    stand_in("run", RESULT)
    code, out, err = _call(capsys, *words)
    assert (code, out) == (2, "")
    assert err
    code, out, _ = _call(capsys, *words, "--json")
    assert code == 2
    assert json.loads(out)["status"] == "bad input"


def test_render_and_plot_hand_their_options_on(capsys: pytest.CaptureFixture[str], stand_in: Any) -> None:
    drawn = stand_in("render", [Path("p.png")])
    words = ["--field", "pressure", "--time", "all", "--view", "x", "--size", "640x480", "-o", "p.png"]
    words += ["--of", "particles", "--most", "3"]
    assert _call(capsys, "render", "out", *words) == (0, "p.png\n", "")
    assert drawn.args == (Path("out"),)
    assert drawn.kwargs == {
        "output": Path("p.png"),
        "field": "pressure",
        "time": "all",
        "view": "x",
        "most": 3.0,
        "size": (640, 480),
        "of": "particles",
    }
    plotted = stand_in("plot", Path("h.png"))
    assert _call(capsys, "plot", "out", "--quantity", "kinetic", "--quantity", "dt")[:2] == (0, "h.png\n")
    assert plotted.kwargs == {"output": None, "quantities": ["kinetic", "dt"]}


@pytest.fixture
def sample(tmp_path: Path) -> Path:
    """A copy of the sample of two cylinders."""
    from zrno.pipelines.samples import copy

    return copy("two_cylinders", tmp_path / "cylinders")


def test_convert_info_and_check_of_the_sample(capsys: pytest.CaptureFixture[str], sample: Path) -> None:
    deck = str(sample / "c.mcm")
    words = ["--settings", str(sample / "cylinders.yaml"), "--spacing", "0.0333333333", "--json"]
    code, out, err = _call(capsys, "convert", str(sample / "cylinders.geo"), deck, *words)
    assert code == 0
    assert "5400 particles in 2 part(s)" in err
    answer = json.loads(out)
    assert answer["source"]["parts"] == {"1": "left", "2": "right"}
    assert answer["target"]["particles"] == 5400
    assert answer["approximated"] == answer["dropped"] == []
    code, out, _ = _call(capsys, "info", deck, "--json")
    assert code == 0
    keys = "format version dimension nodes elements particles parts materials sets bounding_box includes warnings"
    assert list(json.loads(out)) == keys.split()
    assert "5400" in _call(capsys, "info", deck)[1]
    assert _call(capsys, "check", deck, str(sample / "scene.yaml"))[0] == 0


def test_check_says_every_fault_of_every_file(capsys: pytest.CaptureFixture[str], sample: Path) -> None:
    scene = sample / "scene.yaml"
    scene.write_text(scene.read_text().replace("every: 0.5", "every: soon").replace("every: 5", "every: -5"))
    empty = sample / "empty.mcm"
    empty.touch()
    code, out, err = _call(capsys, "check", str(scene), str(empty), "--json")
    assert code == 2
    answer = json.loads(out)
    assert answer["faults"] == 3
    assert [len(row["faults"]) for row in answer["files"]] == [2, 1]
    assert len(err.splitlines()) == 3
    assert err.startswith(f"{scene}:")


def test_help_settings_is_yaml(capsys: pytest.CaptureFixture[str]) -> None:
    import yaml

    code, out, _ = _call(capsys, "convert", "--help-settings")
    assert code == 0
    assert "end_time" in yaml.safe_load(out)


@pytest.mark.parametrize(
    ("words", "head"),
    [
        ([], b"4.1 0 8\n"),
        (["--msh", "2.2"], b"2.2 0 8\n"),
        (["--binary"], b"4.1 1 8\n\x01\0\0\0"),
        (["--binary", "--msh", "2.2"], b"2.2 1 8\n\x01\0\0\0"),
    ],
)
def test_convert_writes_the_mesh_asked_for(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, words: list[str], head: bytes
) -> None:
    source, target = tmp_path / "a.k", tmp_path / "b.msh"
    source.write_text("*KEYWORD\n*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n*ELEMENT_SHELL\n1,1,1,2,3,3\n*END\n")
    assert _call(capsys, "convert", str(source), str(target), *words)[0] == 0
    assert target.read_bytes().startswith(b"$MeshFormat\n" + head)
    code, out, _ = _call(capsys, "info", str(target), "--json")
    assert (code, json.loads(out)["elements"]) == (0, {"tri3": 1})
    if words:
        code, _, err = _call(capsys, "convert", str(source), str(tmp_path / "b.vtu"), *words)
        assert code == 2
        assert "are for .msh meshes" in err


def test_water_in_a_box_of_a_script_and_settings_alone(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """The settings that the page on .mcm decks shows."""
    page = (Path(__file__).parents[2] / "translators" / "pages" / "mcm.md").read_text()
    (tmp_path / "tank.yaml").write_text(page.split("```yaml\n")[1].split("```")[0])
    (tmp_path / "tank.geo").write_text(
        'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 0.5, 0.6}; Physical Volume("water", 1) = {1};\n'
    )
    deck = tmp_path / "tank.mcm"
    words = [str(tmp_path / "tank.geo"), str(deck), "--settings", str(tmp_path / "tank.yaml"), "--spacing", "0.1"]
    code, _, err = _call(capsys, "convert", *words)
    assert code == 0, err
    model = read(deck)
    assert (model.materials[1].law, len(model.particles)) == ("fluid", 300)
    assert model.equations_of_state[model.materials[1].eos].parameters["B"] == 5e4
    assert model.particle_control.planes == [(1, 0.0), (1, 1.0), (0, 0.0), (0, 0.0), (1, 0.0), (0, 0.0)]


def test_a_reader_that_has_enough(tmp_path: Path) -> None:
    (tmp_path / "a.k").write_text("*KEYWORD\n*NODE\n1,0,0,0\n*END\n")
    code = "import sys; sys.argv = ['zrno', 'info', 'a.k']\nfrom zrno.pipelines.cli import main\nmain()"
    with subprocess.Popen(
        [sys.executable, "-c", code], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as run:
        assert run.stdout is not None
        assert run.stderr is not None
        run.stdout.close()
        said = run.stderr.read().decode()
    assert (run.returncode, said) == (1, "")


def test_convert_says_what_only_particle_decks_take(capsys: pytest.CaptureFixture[str], sample: Path) -> None:
    code, _, err = _call(
        capsys, "convert", str(sample / "cylinders.geo"), str(sample / "c.vtu"), "--particles", "nodes"
    )
    assert code == 2
    assert "make a particle deck" in err
    assert not (sample / "c.vtu").exists()
