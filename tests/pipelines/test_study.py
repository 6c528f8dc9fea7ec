"""`zrno study`: the section's faults, and a study end to end on a scene of a few hundred particles."""

from __future__ import annotations

import csv
import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines import cli, console, samples, scene, study_runs
from zrno.pipelines.load import load
from zrno.pipelines.study import study
from zrno.pipelines.study_plan import prepare, run_name
from zrno.pipelines.study_table import study_text
from zrno.translators import InputError

STUDY = """\
study:
  quantity: kinetic.last
  reference: 5.9e-6
  vary: {spacing: [0.25, 0.125]}
  tolerance: 0.5
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the sample of two cylinders."""
    return samples.copy("two_cylinders", tmp_path / "cylinders")


def put(folder: Path, text: str) -> Path:
    """The sample's study scene with another section `study`, and a short end time."""
    whole = (folder / "study.yaml").read_text()
    path = folder / "short.yaml"
    path.write_text(whole[: whole.index("study:\n")].replace("end_time: 7", "end_time: 3") + text)
    return path


def faults(path: Path, **options: Any) -> list[str]:
    with pytest.raises(InputError) as caught:
        prepare(path, options)
    first = (path.read_text().split("study:\n")[0]).count("\n") + 1  # lines are counted from `study:`
    said = [str(fault).removeprefix(f"{path}:") for fault in caught.value.faults]
    return [
        f"{int(line.split(':')[0]) - first}:{line.split(':', 1)[1]}" if line[0].isdigit() else line for line in said
    ]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("kinetic.last", "kinetic.lst", "1:13: error: no such number of a curve: lst (kinetic.lst); expected last"),
        ("kinetic.last", "kinetic", "2:14: error: a number stands against a curve (5.9e-6); expected a file, or a"),
        ("kinetic.last", "{measure: lenght, axis: x}", "1:23: error: no measure lenght (lenght); expected length"),
        ("kinetic.last", "{measure: length}", "1:13: error: study.quantity.axis is missing; expected axis, which"),
        ("kinetic.last", "{measure: length, axis: x, field: a}", "1:47: error: field is no parameter of length (a)"),
        ("kinetic.last", "{measure: length, axis: w}", "1:37: error: study.quantity.axis has a wrong value (w)"),
        (
            "kinetic.last",
            "{mesure: length}",
            "1:14: error: unknown key study.quantity.mesure (mesure); expected measure",
        ),
        (
            "kinetic.last",
            "{column: a, measure: b}",
            "1:13: error: a quantity is a column or a measure; expected one of",
        ),
        ("reference: 5.9e-6", "reference: no.csv", "2:14: error: study.reference: no such file (no.csv)"),
        ("  reference: 5.9e-6\n", "", "1:3: error: nothing to measure against; expected reference or analytic"),
        (
            "reference: 5.9e-6",
            "analytic: bar",
            "2:13: error: no closed-form solution bar (bar); expected one of bar_wave",
        ),
        (
            "reference: 5.9e-6",
            "analytic: {name: taylor_bar, start: 1, density: 1, yield_stress: -1, speed: 1}",
            "2:68: error: yield_stress is -1 (-1); expected more than 0",
        ),
        (
            "reference: 5.9e-6",
            "analytic: {name: taylor_bar, start: 1, density: 1, yeld_stress: 1, speed: 1}",
            "2:13: error: study.analytic.yield_stress is missing; expected yield_stress, which taylor_bar needs",
        ),
        (
            "reference: 5.9e-6",
            "analytic: {name: taylor_bar, of: mass, start: 1, density: 1, yield_stress: 1, speed: 1}",
            "2:36: error: taylor_bar has no result mass (mass); expected one of length, ratio",
        ),
        (
            "reference: 5.9e-6",
            "analytic: {name: taylor_bar, start: 1e300, density: 1e300, yield_stress: 1, speed: 1e300}",
            "2:13: error: the solution is no finite number",
        ),
        ("spacing:", "meshes.0:", "3:20: error: meshes.0 cannot vary; expected a key that changes the run"),
        ("spacing:", "spacng:", "3:10: error: unknown key spacng (spacng); expected spacing (did you mean that?)"),
        ("0.125]", "-1]", "3:26: error: meshes.0.spacing has a wrong value (-1); expected a value greater than 0"),
        ("0.125]", "0.25]", "3:26: error: the value stands twice (0.25); expected each value once"),
        ("[0.25, 0.125]", "0.25", "3:19: error: study.vary.spacing has a wrong value (0.25); expected a valid list"),
        ("[0.25, 0.125]", f"{list(range(1, 1002))}", "3:9: error: 1001 runs are too many; expected at most 1000"),
        ("0.5\n", "0.5\n  paired: true\n", "3:9: error: the lists of vary have 2, 3 values"),
        ("tolerance: 0.5", "tolerance: 0", "4:14: error: study.tolerance has a wrong value (0); expected a value"),
    ],
)
def test_a_fault_has_its_place(folder: Path, old: str, new: str, fault: str) -> None:
    assert old in STUDY
    text = STUDY.replace(old, new)
    if "paired" in new:
        text = text.replace("0.125]}", "0.125], step_factor: [0.8, 0.4, 0.2]}")
        fault = "5:11" + fault[3:]
    said = faults(put(folder, text))
    assert any(line.startswith(fault) for line in said), said


def test_check_reads_the_reference(folder: Path) -> None:
    from zrno.pipelines.check import check

    (folder / "r.csv").write_text("time,kinetik\n0,1\n")
    text = STUDY.replace("kinetic.last", "kinetic").replace("5.9e-6", "r.csv")
    fault = check([put(folder, text)])[0]["faults"][0]
    assert (fault["path"], fault["line"], fault["message"]) == (str(folder / "r.csv"), 1, "no column kinetic")


def test_what_is_varied_is_not_set_too(folder: Path) -> None:
    assert "spacing is set by --set, too" in faults(put(folder, STUDY), spacing=0.5)[0]


def test_a_scene_without_a_study_and_a_deck(folder: Path) -> None:
    assert faults(folder / "scene.yaml")[0].endswith("no study in this scene; expected a section study")
    assert "not a scene" in faults(folder / "cylinders.geo")[0]


def test_all_combinations_or_pairs(folder: Path) -> None:
    text = STUDY.replace("0.125]}", "0.125], step_factor: [0.8, 0.4]}")
    assert [*prepare(put(folder, text), {}).runs] == [
        "spacing=0.25_step_factor=0.8",
        "spacing=0.25_step_factor=0.4",
        "spacing=0.125_step_factor=0.8",
        "spacing=0.125_step_factor=0.4",
    ]
    paired = prepare(put(folder, text + "  paired: true\n"), {})
    assert [*paired.runs] == ["spacing=0.25_step_factor=0.8", "spacing=0.125_step_factor=0.4"]


def test_names_of_runs_are_names_of_files_and_differ() -> None:
    values: list[Any] = ["../x", "x", "-x", [1, 2], [1, -2], 1, 1.0, "a" * 300, "a" * 301, True, "å/b", "å?b"]
    names = [run_name({"materials.left.E": value}) for value in values]
    assert len(set(names)) == len(values)
    assert all("/" not in name and name.isascii() and len(name) <= 100 for name in names)


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, dict[str, Any]]:
    """Scene, folder and result of a study: two spacings, a stable step and one that loses energy or diverges."""
    folder = samples.copy("two_cylinders", tmp_path_factory.mktemp("study") / "cylinders")
    (folder / "r.csv").write_text("time,kinetic\nus,\n0.1,7.9e-6\n0.3,7.4e-6\n0.5,6.9e-6\n")
    path = put(
        folder,
        "study:\n  quantity: kinetic\n  reference: r.csv\n"
        "  vary: {spacing: [0.25, 0.125], step_factor: [0.5, 10]}\n  tolerance: 0.5\n",
    )
    return path, folder / "out", study(path, output=folder / "out")


def test_every_run_is_a_row_and_a_result_folder(done: tuple[Path, Path, dict[str, Any]]) -> None:
    path, out, result = done
    rows = result["rows"]
    assert [row["status"] for row in rows] == ["done", "done", "done", "failed"]
    assert [row["particles"] for row in rows][::2] == [96, 384]
    for row in rows[::2]:
        history = load(row["output"]).history
        time = np.array([0.1, 0.3, 0.5])
        wanted = np.array([7.9e-6, 7.4e-6, 6.9e-6])
        off = np.interp(time, history["time"], history["kinetic"]) - wanted
        expected = math.sqrt(np.trapezoid(off**2, time) / np.trapezoid(wanted**2, time))
        assert row["error"] == pytest.approx(expected, rel=1e-12)
        assert row["particle_steps_per_second"] == pytest.approx(row["particles"] * row["steps"] / row["wall_seconds"])
        assert row["message"] == ""
    assert rows[1]["message"].startswith("the energy balance is out by")
    assert rows[3]["error"] is None
    assert "step" in rows[3]["message"]
    assert not any(row["front"] or row["recommended"] for row in rows[1::2])
    assert not (path.parent / "study.mcm").exists()  # decks are made in the runs' folders
    assert (out / "runs" / rows[0]["run"] / "study.mcm").exists()


def test_compiling_is_apart(done: tuple[Path, Path, dict[str, Any]]) -> None:
    for row in done[2]["rows"][::2]:
        manifest = load(row["output"]).manifest
        assert row["wall_seconds"] <= manifest["wall_seconds"]
        assert row["wall_seconds"] < 2.0


def test_the_files_say_the_same(done: tuple[Path, Path, dict[str, Any]]) -> None:
    _, out, result = done
    stored = json.loads((out / "study.json").read_text(), parse_constant=pytest.fail)
    assert stored.keys() >= {"rows", "front", "order_of_convergence", "recommended"}
    assert stored["front"] == result["front"]
    assert stored["recommended"]["run"] == result["recommended"]["run"]
    with (out / "study.csv").open() as file:
        table = list(csv.DictReader(file))
    assert [row["run"] for row in table] == [row["run"] for row in result["rows"]]
    assert float(table[0]["error"]) == result["rows"][0]["error"]
    assert table[3]["error"] == ""
    assert [row["spacing"] for row in table] == ["0.25", "0.25", "0.125", "0.125"]
    text = study_text(result).splitlines()
    assert len(text) == 1 + 4 + 4
    assert text[0].split()[:3] == ["spacing", "step_factor", "error"]
    assert text[-2] == "recommended: spacing {spacing}, step_factor {step_factor}".format(
        **result["recommended"]["options"]
    )


def test_the_picture_is_drawn(done: tuple[Path, Path, dict[str, Any]], tmp_path: Path) -> None:
    from matplotlib.image import imread

    from zrno.pipelines.study_plot import draw

    _, out, result = done
    assert np.ptp(imread(out / "study.png")) > 0.5
    text = draw(tmp_path / "s.svg", result).read_text()
    for words in ("relative error of kinetic energy", "0.125, 0.5", "efficient front", "1 run without an error"):
        assert words in text, words
    bare = {**result, "rows": result["rows"][3:], "recommended": None}
    assert draw(tmp_path / "bare.svg", bare).stat().st_size > 0


def test_only_what_is_missing_is_run_again(
    done: tuple[Path, Path, dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    path, out, result = done
    ran: list[dict[str, Any]] = []
    real = study_runs.run
    monkeypatch.setattr(study_runs, "run", lambda *a, **k: ran.append(k) or real(*a, **k))
    assert study(path, output=out)["rows"] == result["rows"]
    assert ran == []
    (out / "runs" / result["rows"][2]["run"] / study_runs.STAMP).unlink()  # as a study leaves it that is interrupted
    study(path, output=out)
    assert [k["options"]["spacing"] for k in ran] == [0.125, 0.125]  # to warm up, and to time
    ran.clear()
    again = study(path, output=out, repeat=2)
    assert [k["options"]["spacing"] for k in ran[1:]] == [0.25, 0.25, 0.125]  # what diverged is not timed again
    assert [row["repeats"] for row in again["rows"]][:3] == [2, 2, 2]
    ran.clear()
    settings = path.parent / "cylinders.yaml"
    settings.write_text(settings.read_text().replace("density: 2.7", "density: 2.8"))
    study(path, output=out)
    assert len(ran) == 1 + 4


@pytest.mark.parametrize(
    ("quantity", "fault"),
    [
        ("heat.last", "no column heat; there are: time, dt"),
        ("{measure: mean, field: heat}", "no field heat; there are: position"),
        ("{measure: length, axis: x, material: 5}", "no material 5; there are: 1, 2"),
    ],
)
def test_what_no_run_has_ends_the_study(folder: Path, quantity: str, fault: str) -> None:
    path = put(folder, STUDY.replace("kinetic.last", quantity).replace(", 0.125]", "]"))
    with pytest.raises(InputError, match=f"short.yaml:[0-9]+:13: error: {fault}"):
        study(path, output=folder / "out")


def test_the_command(folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    path = put(folder, STUDY.replace("kinetic.last", "{measure: length, axis: x, material: 1}").replace("5.9e-6", "3"))

    def call(*words: str) -> tuple[int, str, str]:
        console._answers.clear()
        monkeypatch.setattr(sys, "argv", ["zrno", "study", *words])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        return (int(stop.value.code or 0), *capsys.readouterr())

    code, out, _ = call(str(path), "-o", str(folder / "out"), "--set", "step_factor=0.5", "--json")
    assert code == 0
    answer = json.loads(out, parse_constant=pytest.fail)
    assert answer["recommended"]["run"] == "spacing=0.25"
    assert 0.0 < answer["rows"][1]["error"] < 0.01
    put(folder, STUDY.replace("0.25, 0.125", "0.125"))
    code, out, err = call(str(path), "-o", str(folder / "out"), "--set", "step_factor=10")
    assert (code, err) == (1, "")
    assert "recommended: none is within the tolerance" in out
    assert call(str(folder / "scene.yaml"))[0] == 2


def test_a_study_is_part_of_the_scene(folder: Path) -> None:
    loaded = scene.load(folder / "study.yaml").study
    assert loaded is not None
    assert len(loaded.combinations()) == 32
