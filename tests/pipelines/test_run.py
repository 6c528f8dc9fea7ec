"""`zrno run` end to end on small decks: the result folder, options, and runs that are killed, interrupted, diverge."""

from __future__ import annotations

import csv
import errno
import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista

from zrno.pipelines.checkpoint import load_latest
from zrno.pipelines.errors import RunFailed
from zrno.pipelines.history import COLUMNS
from zrno.pipelines.load import load
from zrno.pipelines.run import run
from zrno.pipelines.series import Series
from zrno.solvers.threads import available
from zrno.translators import write
from zrno.translators.model import Material, Model, ParticleControl, Particles
from zrno.translators.text import InputError

ZRNO = [sys.executable, "-c", "from zrno.pipelines.cli import main; main()"]
RESULT_KEYS = {
    "status", "steps", "time", "wall_seconds", "compile_seconds", "particles", "nodes", "elements",
    "particle_steps_per_second", "energy", "output", "warnings",
}  # fmt: skip
ENERGY_KEYS = {"initial", "final", "kinetic", "internal", "external_work", "dissipated", "balance_error"}
ARRAYS = {
    "id", "material", "velocity", "density", "mass", "radius", "pressure", "stress", "von_mises", "plastic_strain",
    "displacement",
}  # fmt: skip
SPACING = 0.1


def deck(
    path: Path, dimension: int = 2, *, side: int = 10, end_time: float = 3.0, every: float = 0.25, rows: float = 0.05
) -> Path:
    """Two squares or cubes of side^dimension elastic-plastic particles that meet at 100 m/s each (units cm-us-g)."""
    grid = np.stack(np.meshgrid(*[np.arange(side)] * dimension, indexing="ij"), -1).reshape(-1, dimension)
    n = len(grid)
    x, velocity = np.zeros((2 * n, 3)), np.zeros((2 * n, 3))
    x[:n, :dimension] = x[n:, :dimension] = SPACING * grid
    x[n:, 0] += SPACING * side
    velocity[:n, 0], velocity[n:, 0] = 1e-2, -1e-2
    law = {"E": 0.7, "nu": 0.33, "yield_stress": 0.003, "tangent_modulus": 0.01, "beta": 0.5}
    model = Model(
        title="An impact",
        format="mcm",
        dimension=dimension,
        materials={
            i: Material(i, name, "von_mises", 2.7, law, mass=2.7 * n * SPACING**dimension, h=1.2 * SPACING)
            for i, name in ((1, "Left body"), (2, "right"))
        },
        particles=Particles(x, np.repeat([1, 2], n), np.zeros(2 * n, np.int64), velocity),
        particle_control=ParticleControl(
            dimension=dimension, end_time=end_time, step_factor=0.8, step_option=2, output_interval=every,
            history_interval=rows,
        ),
    )  # fmt: skip
    write(model, path)
    return path


def zrno(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """The program, as a user starts it."""
    return subprocess.run([*ZRNO, *words], cwd=folder, capture_output=True, text=True, check=False)


def contents(directory: Path) -> dict[str, bytes]:
    """What a run computed: every file but the log, the manifest and the checkpoints (their layout may differ)."""
    files = [p for p in sorted(directory.rglob("*")) if p.is_file() and p.suffix != ".h5" and p.stem != "run"]
    return {str(p.relative_to(directory)): p.read_bytes() for p in files}


def assert_same_end(one: Path, other: Path) -> None:
    """Two runs that computed the same, bit for bit: last state, frames, histories."""
    first, second = load_latest(one), load_latest(other)
    assert first is not None
    assert second is not None
    assert first.keys() == second.keys()
    for name, value in first.items():
        np.testing.assert_array_equal(value, second[name], err_msg=name)
    assert [p.name for p in sorted(one.glob("*.h5"))] == [p.name for p in sorted(other.glob("*.h5"))]
    assert (one / "history.csv").read_text() == (other / "history.csv").read_text()
    assert contents(one) == contents(other)


# the result folder


@pytest.fixture(scope="module", params=[2, 3], ids=["2D", "3D"])
def finished(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The folder of a finished run, beside its deck, and what the program printed."""
    folder = tmp_path_factory.mktemp("finished")
    deck(folder / "impact.mcm", request.param, side=10 if request.param == 2 else 6, end_time=1.1)
    done = zrno(folder, "run", "impact.mcm", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "impact_results", done.stdout


def test_json_is_one_object_with_all_its_keys(finished: tuple[Path, str]) -> None:
    where, printed = finished
    result = json.loads(printed, parse_constant=pytest.fail)
    assert result.keys() >= RESULT_KEYS
    assert result["energy"].keys() >= ENERGY_KEYS
    assert (result["status"], result["time"], result["output"]) == ("done", 1.1, "impact_results")
    assert result["particles"] == load(where).mesh().n_points
    assert result["particle_steps_per_second"] > 0
    assert result["wall_seconds"] > 0
    energy = result["energy"]
    assert energy["initial"] == pytest.approx(energy["kinetic"] + energy["internal"], rel=0.02)
    assert energy["balance_error"] < 0.02


def test_series_open_and_have_the_same_times(finished: tuple[Path, str]) -> None:
    where, _ = finished
    frames = {path.stem: pyvista.get_reader(path) for path in where.glob("*.pvd")}
    assert sorted(frames) == ["mat01_left-body", "mat02_right", "particles"]
    points = {}
    for name, reader in frames.items():
        assert reader.time_values == [0.0, 0.25, 0.5, 0.75, 1.0, 1.1]
        reader.set_active_time_value(1.1)
        (mesh,) = reader.read()
        assert set(mesh.point_data) == ARRAYS
        assert all(np.isfinite(values).all() for values in mesh.point_data.values())
        points[name] = mesh
    bodies = [points["mat01_left-body"], points["mat02_right"]]
    for name in ("id", "stress", "velocity"):
        together = np.concatenate([body.point_data[name] for body in bodies])
        np.testing.assert_array_equal(together, points["particles"].point_data[name])
    assert points["particles"].point_data["id"].tolist() == list(range(1, points["particles"].n_points + 1))
    assert set(bodies[1].point_data["material"]) == {2}
    assert points["particles"].point_data["plastic_strain"].max() > 0


def test_history_has_its_columns_and_a_row_of_units(finished: tuple[Path, str]) -> None:
    where, _ = finished
    header, units, *rows = csv.reader((where / "history.csv").read_text().splitlines())
    assert tuple(header[: len(COLUMNS)]) == COLUMNS
    assert {len(row) for row in (header, units, *rows)} == {len(header)}
    assert set(units) == {""}  # a deck does not say them
    history = load(where).history
    assert history["time"][[0, -1]].tolist() == [0.0, 1.1]
    assert (np.diff(history["time"]) > 0).all()
    assert np.diff(history["kinetic"])[-1] < 0
    sound = history["kinetic"][0] ** 0.5 * history["active"][0] ** 0.5  # larger than any momentum of the run
    for axis in "xyz":
        assert np.abs(history[f"momentum_{axis}"]).max() < 1e-13 * sound


def test_the_manifest_says_what_was_run(finished: tuple[Path, str]) -> None:
    where, printed = finished
    manifest = json.loads((where / "run.json").read_text())
    text = (where.parent / "impact.mcm").read_bytes()
    assert manifest["inputs"] == {"impact.mcm": hashlib.sha256(text).hexdigest()}
    for key in ("version", "git_hash", "started", "finished", "host", "title"):
        assert manifest[key], key
    assert manifest["threads"] == 1  # small runs are faster on one
    assert manifest["options"]["control"]["end_time"] == 1.1
    result = json.loads(printed)
    for key in ("status", "steps", "energy", "wall_seconds", "compile_seconds", "particles"):
        assert manifest[key] == result[key]
    log = (where / "run.log").read_text()
    assert "cubic kernel" in log
    assert f"done: {result['steps']} steps" in log
    assert len(list(where.glob("checkpoint_*.h5"))) == 2


# options


def test_history_does_not_shorten_steps(tmp_path: Path) -> None:
    steps = [
        run([deck(tmp_path / f"{i}.mcm", rows=rows)], output=tmp_path / str(i))["steps"]
        for i, rows in enumerate((0.001, 3.0))
    ]
    assert steps[0] == steps[1]


def test_until_cuts_and_never_prolongs(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm", end_time=0.5)
    assert run([source], output=tmp_path / "cut", until=0.4)["time"] == 0.4
    result = load(tmp_path / "cut")
    assert result.times.tolist() == [0.0, 0.25, 0.4]
    assert result.history["time"][-1] == 0.4
    assert result.manifest["options"]["until"] == 0.4
    assert run([source], output=tmp_path / "whole", until=9.0)["time"] == 0.5


def test_set_replaces_a_field_of_a_deck(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm")
    fields = ("--set", "end_time=0.4", "--set", "output_interval=0.2")
    done = zrno(tmp_path, "run", source.name, "-o", "out", *fields, "-q")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("done: ")
    result = load(tmp_path / "out")
    assert result.times.tolist() == [0.0, 0.2, 0.4]
    assert result.manifest["options"]["control"]["output_interval"] == 0.2


def test_set_replaces_a_key_of_a_scene(tmp_path: Path) -> None:
    deck(tmp_path / "impact.mcm", end_time=0.4)
    scene = tmp_path / "scene.yaml"
    scene.write_text("title: A scene\nunits: cm-us-g\ndecks: [impact.mcm]\noutput: {every: 0.1}\n")
    run([scene], output=tmp_path / "out", options={"output.every": 0.2, "output.format": "vtk"})
    result = load(tmp_path / "out")
    assert result.times.tolist() == [0.0, 0.2, 0.4]
    assert all(path.suffix == ".vtk" for path in (tmp_path / "out" / "vtk").iterdir())
    assert result.mesh().n_points == 200
    assert (result.title, result.units) == ("A scene", "cm-us-g")
    assert (result.history_units["time"], result.history_units["kinetic"]) == ("us", "Mbar cm^3/cm")  # per depth
    assert (result.history_units["contact_force_x"], result.dimension) == ("Mbar cm^2/cm", 2)
    assert result.history_units["contact_energy"] == result.history_units["kinetic"]
    assert result.history_units["relaxation_dissipated"] == result.history_units["kinetic"]
    assert set(result.manifest["inputs"]) == {str(scene), str(tmp_path / "impact.mcm")}


def test_a_picture_that_cannot_be_drawn_is_a_warning_of_a_run_that_is_done(tmp_path: Path) -> None:
    deck(tmp_path / "impact.mcm", end_time=0.1)
    (tmp_path / "scene.yaml").write_text("decks: [impact.mcm]\nrender: [{time: 99}]\n")
    result = run([tmp_path / "scene.yaml"], output=tmp_path / "out")
    assert (result["status"], result["pictures"]) == ("done", [])
    assert result["warnings"] == ["render.0 is not drawn: no frame at time 99; there are 2 from 0 to 0.1"]
    assert result["warnings"][0] in (tmp_path / "out" / "run.log").read_text()


def test_what_making_a_deck_lost_is_in_the_log_and_among_the_warnings(tmp_path: Path) -> None:
    (tmp_path / "squares.geo").write_text(
        'SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 1, 1}; Rectangle(2) = {1, 0, 0, 1, 1};\n'
        'Physical Surface("left") = {1}; Physical Surface("right") = {2}; Physical Curve("bottom") = {1};\n'
    )
    scene = tmp_path / "scene.yaml"
    scene.write_text(
        "meshes:\n"
        "  - source: squares.geo\n"
        "    target: squares.mcm\n"
        "    spacing: 0.1\n"
        "    set:\n"
        "      end_time: 0.1\n"
        "      step_option: 2\n"
        "      materials.left: &law {law: von_mises, density: 2.7, E: 0.7, nu: 0.3, yield_stress: 0.003, beta: 0.5,\n"
        "        tangent_modulus: 0.01}\n"
        "      materials.right: *law\n"
        "decks: [squares.mcm]\n"
    )
    result = run([scene], output=tmp_path / "out")
    lost = "line2 elements - of lower dimension than the parts: no particles are made of them"
    assert [warning for warning in result["warnings"] if lost in warning]
    log = (tmp_path / "out" / "run.log").read_text()
    assert "making squares.mcm: 200 particles in 2 part(s)" in log
    assert log.count(lost) == 1
    resumed = run([scene], output=tmp_path / "out", resume=True)  # the deck is made again, the same
    assert (resumed["status"], resumed["steps"]) == ("done", result["steps"])
    assert f"resumed at t = 0.1, step {result['steps']}" in (tmp_path / "out" / "run.log").read_text()


def test_set_of_a_scenes_key_is_wrong_for_a_deck(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"--set:1:1: error: output\.every is for scenes"):
        run([deck(tmp_path / "impact.mcm")], output=tmp_path / "out", options={"output.every": 0.2})
    assert not (tmp_path / "out").exists()


def test_compat_original_labels_times_as_the_original_program(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm", end_time=0.5)
    run([source], output=tmp_path / "ours")
    run([source], output=tmp_path / "original", options={"compat": "original"})
    ours, original = load(tmp_path / "ours"), load(tmp_path / "original")
    assert original.manifest["options"]["compat"] == "original"
    assert original.times[0] == 0.0
    assert original.times[1] > ours.times[1] == 0.25  # at the first step past the time, whose state is a step behind
    moved = [np.abs(result.arrays(index=1)["displacement"]).max() for result in (ours, original)]
    assert moved[1] < moved[0]


def test_results_do_not_depend_on_threads(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm", side=33, end_time=0.5)
    for threads in (1, 2):
        run([source], output=tmp_path / str(threads), threads=threads)
        assert load(tmp_path / str(threads)).manifest["threads"] == min(threads, available())
    assert_same_end(tmp_path / "1", tmp_path / "2")


# the energy balance


def test_an_unstable_run_that_does_not_explode_is_a_warning(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm", end_time=6.0, every=6.0)
    how = ("run", source.name, "-o", "out", "--set", "step_factor=2.8", "--set", "sph.correction=false")
    done = zrno(tmp_path, *how, "--json")
    assert done.returncode == 0
    result = json.loads(done.stdout)
    (warning,) = result["warnings"]
    assert result["status"] == "done"
    assert f"out by {result['energy']['balance_error']:.0%} of the largest" in warning
    assert "step_factor below 2.8" in warning
    assert done.stderr == f"warning: {warning}\n"
    assert load(tmp_path / "out").manifest["warnings"] == [warning]
    assert f"WARNING {warning}" in (tmp_path / "out" / "run.log").read_text()

    history = load(tmp_path / "out").history
    kinetic, internal = history["kinetic"], history["internal"]
    error = np.abs(kinetic + internal - kinetic[0]) / np.maximum(np.maximum(kinetic, internal), kinetic[0])
    assert error[-1] == pytest.approx(result["energy"]["balance_error"])
    assert f"passed 5% at t = {history['time'][np.flatnonzero(error <= 0.05)[-1] + 1]:.4g}:" in warning

    quiet = zrno(tmp_path, *how, "-q")
    assert (quiet.returncode, quiet.stderr) == (0, "")
    stable = run([source], output=tmp_path / "out")
    assert stable["warnings"] == []


# runs that end before their time


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a run of some hundred frames, beside its deck `impact.mcm`."""
    folder = tmp_path_factory.mktemp("unbroken")
    run([deck(folder / "impact.mcm", side=20, end_time=60.0, every=0.5, rows=0.3)], output=folder / "results")
    return folder / "results"


def _stopped(unbroken: Path, output: Path, number: signal.Signals) -> tuple[int, str, str]:
    """Start the same run in a process of its own and send it a signal when some frames are there."""
    words = [*ZRNO, "run", "impact.mcm", "-o", str(output), "--json"]
    child = subprocess.Popen(words, cwd=unbroken.parent, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    give_up = time.monotonic() + 60
    while child.poll() is None and time.monotonic() < give_up and len(list(output.glob("vtk/particles_*"))) < 5:
        time.sleep(0.002)
    child.send_signal(number)
    out, err = child.communicate(timeout=60)
    assert len(list(output.glob("vtk/particles_*"))) < 100, "the run was over before the signal"
    return child.returncode, out, err


def test_a_killed_run_is_readable_and_resumes_to_the_same_end(unbroken: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    code, _, _ = _stopped(unbroken, broken, signal.SIGKILL)
    assert code == -signal.SIGKILL
    assert json.loads((broken / "run.json").read_text())["status"] == "running"
    for path in broken.glob("*.pvd"):
        reader = pyvista.get_reader(path)
        assert len(reader.time_values) >= 4
        reader.set_active_time_value(reader.time_values[-1])
        assert reader.read()[0].n_points in (400, 800)
    assert len(load(broken).times) >= 4
    assert len(load(broken).history["time"]) >= 4

    resumed = zrno(unbroken.parent, "run", "impact.mcm", "-o", str(broken), "--resume", "--json")
    assert (resumed.returncode, resumed.stderr) == (0, "")
    result = json.loads(resumed.stdout)
    assert (result["status"], result["time"]) == ("done", 60.0)
    assert_same_end(unbroken, broken)
    # The energies are those of the whole run, not of its second part.
    energy = load(unbroken).manifest["energy"]
    assert result["energy"] == energy


def test_an_interrupted_run_has_its_checkpoint_and_resumes_to_the_same_end(unbroken: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    code, out, err = _stopped(unbroken, broken, signal.SIGINT)
    assert code == 130
    assert err.splitlines()[-1] == "interrupted"
    assert "Traceback" not in err
    printed = json.loads(out)
    assert (printed["status"], printed["errors"]) == ("interrupted", ["interrupted"])
    assert printed.keys() >= RESULT_KEYS
    manifest = load(broken).manifest
    assert manifest["status"] == "interrupted"
    state = load_latest(broken)
    assert state is not None
    assert state["step"] == manifest["steps"] == printed["steps"]
    assert "interrupted at t = " in (broken / "run.log").read_text()

    assert run([unbroken.parent / "impact.mcm"], output=broken, resume=True)["status"] == "done"
    assert_same_end(unbroken, broken)


def test_an_interrupt_in_the_middle_of_a_frame_waits_for_its_end(
    unbroken: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_frame = Series.write
    calls = []

    def interrupted(self: Series, *args: Any, **more: Any) -> None:
        calls.append(self.name)
        if len(calls) == 10:  # the first of three series of the fourth frame
            os.kill(os.getpid(), signal.SIGINT)
        write_frame(self, *args, **more)

    monkeypatch.setattr(Series, "write", interrupted)
    source = unbroken.parent / "impact.mcm"
    with pytest.raises(KeyboardInterrupt):
        run([source], output=tmp_path / "broken")
    assert len(calls) == 12
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    run([source], output=tmp_path / "broken", resume=True)
    assert_same_end(unbroken, tmp_path / "broken")


def test_a_second_interrupt_does_not_wait(unbroken: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def impatient(self: Series, *args: Any, **more: Any) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)
        pytest.fail("not reached")

    monkeypatch.setattr(Series, "write", impatient)
    with pytest.raises(KeyboardInterrupt):
        run([unbroken.parent / "impact.mcm"], output=tmp_path / "broken")
    assert not list(tmp_path.rglob("*.h5"))  # of a state that nobody knows
    assert load(tmp_path / "broken").manifest["status"] == "interrupted"


def test_resume_without_a_checkpoint_begins_at_the_start(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm", end_time=0.5)
    run([source], output=tmp_path / "plain")
    run([source], output=tmp_path / "resumed", resume=True)
    assert_same_end(tmp_path / "plain", tmp_path / "resumed")
    before = contents(tmp_path / "resumed")
    run([source], output=tmp_path / "resumed", resume=True)  # at its end already
    assert contents(tmp_path / "resumed") == before


def test_resume_with_another_deck_is_refused(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm", end_time=0.5)
    run([source], output=tmp_path / "out")
    before = contents(tmp_path / "out")
    deck(source, end_time=0.75)
    done = zrno(tmp_path, "run", source.name, "-o", "out", "--resume")
    assert done.returncode == 2
    assert re.match(r"impact\.mcm:1:1: error: not the input that checkpoint_\d+\.h5 was made from", done.stderr)
    assert contents(tmp_path / "out") == before


def test_a_diverging_run_says_where_and_keeps_what_it_computed(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm", side=30, end_time=30.0, every=3.0)
    done = zrno(tmp_path, "run", source.name, "-o", "out", "--set", "step_factor=5", "--json")
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    said = re.fullmatch(r"error: step (\d+) at particle (\d+): .*step factor may be too large.*\n", done.stderr)
    assert said
    assert 1 <= int(said[2]) <= 1800
    printed = json.loads(done.stdout)
    assert printed["status"] == "failed"
    assert printed["errors"] == [done.stderr.strip()]
    assert printed.keys() >= RESULT_KEYS
    assert printed["energy"].keys() >= ENERGY_KEYS
    assert printed["output"] == "out"
    assert (printed["steps"], printed["particles"]) == (load(tmp_path / "out").manifest["steps"], 1800)
    result = load(tmp_path / "out")
    assert result.manifest["status"] == "failed"
    assert int(said[1]) - result.manifest["steps"] in (0, 1)
    assert len(result.times) >= 1
    assert result.mesh().n_points == 1800
    assert len(result.history["time"]) > 2
    assert said[0].strip().removeprefix("error: ") in (tmp_path / "out" / "run.log").read_text()


def test_a_run_that_cannot_write_its_results_has_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: Series, *args: Any, **more: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(self.path))

    monkeypatch.setattr(Series, "write", full)
    known: dict[str, Any] = {}
    with pytest.raises(RunFailed, match="No space left on device"):
        run([deck(tmp_path / "impact.mcm")], output=tmp_path / "out", known=known)
    assert (known["status"], known["steps"]) == ("failed", 0)
    assert load(tmp_path / "out").manifest["status"] == "failed"


def test_particles_that_coincide_fail_the_run_before_it_begins(tmp_path: Path) -> None:
    source = deck(tmp_path / "impact.mcm")
    first = next(line for line in source.read_text().splitlines() if line.startswith("       1    0"))
    second = next(line for line in source.read_text().splitlines() if line.startswith("       2    0"))
    source.write_text(source.read_text().replace(second, "       2" + first[8:]))
    done = zrno(tmp_path, "run", source.name, "--json")
    assert done.returncode == 1
    printed = json.loads(done.stdout)
    assert (printed["status"], printed["steps"], printed["time"]) == ("failed", 0, 0.0)
    assert "coincide" in printed["errors"][0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["impact.mcm"]


def test_bad_input_has_status_and_errors_alone(tmp_path: Path) -> None:
    deck(tmp_path / "impact.mcm")
    done = zrno(tmp_path, "run", "impact.mcm", "--set", "h_option=3", "--json")
    assert done.returncode == 2
    assert json.loads(done.stdout) == {"status": "bad input", "errors": [done.stderr.strip()]}
