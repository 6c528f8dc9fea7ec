"""A result folder is read back: what was written, with nothing heavy imported before it is needed."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.history import History
from zrno.pipelines.load import load
from zrno.pipelines.manifest import Manifest, digests
from zrno.pipelines.quantities import field, field_names, quantity
from zrno.pipelines.series import ResultSeries
from zrno.translators.text import InputError


@pytest.fixture
def folder(tmp_path: Path, solver: Any, drive: Any) -> Path:
    where = tmp_path / "results"
    drive(solver, [ResultSeries(where, {1: "a", 2: "b"}, interval=0.1), History(where, units={"time": "ms"})], 2)
    Manifest(where, inputs={}, options={}, threads=2, title="Two bodies", units="mm-ms-g")
    return where


def test_times_history_series_arrays_and_meshes(folder: Path, solver: Any) -> None:
    result = load(folder)
    assert (result.title, result.units) == ("Two bodies", "mm-ms-g")
    assert result.series == ["mat01_a", "mat02_b", "particles"]
    np.testing.assert_array_equal(result.times, [0.0, 0.1, 0.2])
    assert result.history["active"].tolist() == [40.0] * 3
    assert result.history_units == {"time": "ms"}
    expected = solver.frame().particles
    solver.step = 2
    arrays = result.arrays("particles", 2)
    assert arrays.keys() == expected.keys()
    for name, values in solver.frame().particles.items():
        np.testing.assert_allclose(arrays[name], values, rtol=1e-6)
    assert result.mesh("mat02_b", 0).n_points == 20
    np.testing.assert_array_equal(result.arrays()["position"], arrays["position"])


def test_what_is_not_there_is_named(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no series mat03; there are: mat01_a, mat02_b, particles"):
        load(folder).mesh("mat03")
    with pytest.raises(IndexError, match="no frame 3; there are 3"):
        load(folder).mesh("particles", 3)
    with pytest.raises(InputError, match="no such folder"):
        load(tmp_path / "nowhere")
    with pytest.raises(InputError, match=r"not a result folder; expected a folder with run\.json"):
        load(tmp_path)


def test_a_run_that_was_killed_between_two_series_has_the_times_of_both(folder: Path) -> None:
    listed = folder / "particles.pvd"
    lines = listed.read_text().splitlines(keepends=True)
    listed.write_text("".join(line for line in lines if 'timestep="0.2"' not in line))
    np.testing.assert_array_equal(load(folder).times, [0.0, 0.1])
    assert load(folder).mesh("mat01_a")["velocity"][0, 0] == 0.5


def test_the_public_names_stay_functions_and_import_nothing_heavy() -> None:
    code = """
import sys
from zrno.pipelines import load
assert callable(load)
import zrno.pipelines.load
from zrno.pipelines.load import load as same
from zrno.pipelines import load as again
assert again is load is same
heavy = {"vtk", "vtkmodules", "pyvista", "h5py", "matplotlib", "numba", "meshio", "gmsh"} & set(sys.modules)
assert not heavy, heavy
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_fields_have_components_and_magnitudes() -> None:
    stress = np.array([[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]])
    arrays = {"mass": np.array([2.0]), "velocity": np.array([[3.0, 4.0, 12.0]]), "stress": stress}
    assert field(arrays, "mass") == [2.0]
    assert field(arrays, "velocity") == [13.0]
    assert field(arrays, "velocity_y") == [4.0]
    assert field(arrays, "stress_zx") == [6.0]
    tensor = np.array([[1, 4, 6], [4, 2, 5], [6, 5, 3]])
    np.testing.assert_allclose(field(arrays, "stress"), np.linalg.norm(tensor))
    for name in ("stress_x", "velocity_xx", "mass_x", "speed"):
        with pytest.raises(ValueError, match=f"no field {name}; there are: mass, velocity, velocity_x, .*stress_zx"):
            field(arrays, name)
    assert all(len(field(arrays, name)) == 1 for name in field_names(arrays))


def test_labels_and_units() -> None:
    assert str(quantity("von_mises", "mm-ms-g")) == "von Mises stress [MPa]"
    assert str(quantity("velocity_x", "cm-us-g")) == "velocity x [cm/µs]"
    assert str(quantity("density", "mm-s-t")) == "density [t/mm³]"
    assert str(quantity("contact_force_z", "m-s-kg")) == "contact force z [N]"
    assert str(quantity("kinetic", "mm-ms-g", 2)) == "kinetic energy [mJ/mm]"
    assert str(quantity("contact_force_z", "cm-us-g", 2)) == "contact force z [Mbar cm²/cm]"
    assert str(quantity("structure_force_z", "m-s-kg", 2)) == "structure force z [N/m]"
    assert str(quantity("pending_impulse_x", "mm-ms-g")) == "pending impulse x [g mm/ms]"
    assert str(quantity("interface_energy", "mm-ms-g")) == "interface energy [mJ]"
    assert str(quantity("stress_top_xx", "m-s-kg")) == "stress top xx [Pa]"
    assert str(quantity("momentum_x", "m-s-kg", 2)) == "momentum x [kg/m m/s]"
    assert str(quantity("mass", "m-s-kg", 1)) == "mass [kg/m²]"
    assert str(quantity("density", "m-s-kg", 2)) == "density [kg/m³]"
    assert str(quantity("velocity_x")) == "velocity x"
    assert str(quantity("id", "m-s-kg")) == "particle number"
    assert str(quantity("neighbours", "m-s-kg")) == "neighbours"


def test_the_manifest_says_how_a_run_was_made_and_ended(tmp_path: Path) -> None:
    deck = tmp_path / "deck.mcm"
    deck.write_bytes(b"abc")
    manifest = Manifest(
        tmp_path / "out", inputs=digests([deck]), options={"step_factor": np.float64(0.8), "path": deck}, threads=2
    )
    path = tmp_path / "out" / "run.json"
    started = json.loads(path.read_text())
    assert started["status"] == "running"
    assert started["inputs"] == {str(deck): "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"}
    assert started["options"] == {"step_factor": 0.8, "path": str(deck)}
    assert started["threads"] == 2
    assert {"version", "git_hash", "host", "started"} <= started.keys()
    assert "finished" not in started
    manifest.update(status="done", wall_seconds={"total": 1.5}, energy={"balance_error": math.nan, "kinetic": 1.0})
    ended = json.loads(path.read_text())
    assert ended["status"] == "done"
    assert ended["energy"] == {"balance_error": None, "kinetic": 1.0}
    assert ended["finished"] >= ended["started"]
    assert [p.name for p in path.parent.iterdir()] == ["run.json"]
