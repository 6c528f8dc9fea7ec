"""The impact by finite elements, against finite differences and beside the particles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from impact_grid import DENSITY, LENGTH, RADIUS, ROD, YIELD, rod_against_wall

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy

MASS = DENSITY * LENGTH * 2.0 * RADIUS


def _run(folder: Path, scene: str, **options: Any) -> Any:
    copy("two_cylinders_fem", folder / "sample")
    result = run([folder / "sample" / scene], output=folder / "out", options={"render": [], **options})
    assert result["status"] == "done"
    assert result["energy"]["balance_error"] < 0.01
    return load(folder / "out")


def test_the_elastic_impact_is_that_of_finite_differences(tmp_path: Path) -> None:
    found = _run(tmp_path, "elastic.yaml", **{"numbers.n": 10, "end_time": 9.0, "fem.steps": 180}).history
    grid = rod_against_wall(30, 1e-3, 7.0)
    kinetic = np.interp(grid.times, found["time"], found["kinetic"])
    assert np.linalg.norm(kinetic - grid.kinetic) < 0.03 * np.linalg.norm(grid.kinetic)
    pressing = found["time"][-found["contact_force_x"] > 0.0]
    assert 1.0 < pressing[-1] * ROD / (2.0 * LENGTH) < 1.12  # and they part
    speed = found["momentum_x"] / MASS
    assert speed[0] == pytest.approx(1e-3)
    assert -1e-3 < speed[-1] < -0.85e-3


def test_the_plastic_impact_beside_the_particles(tmp_path: Path) -> None:
    found = _run(tmp_path, "scene.yaml", **{"numbers.n": 20, "end_time": 5.0, "fem.steps": 100})
    history = found.history
    rows = np.genfromtxt(tmp_path / "sample/reference/centre.csv", delimiter=",", comments="#", skip_header=3)
    speed = np.interp(rows[:, 0], history["time"], history["momentum_x"] / MASS)[:11]
    np.testing.assert_allclose(speed, rows[:11, 2], atol=0.03 * 1e-2)
    cells = found.mesh("elements").cell_data
    assert cells["plastic_strain"].max() > 0.1
    assert cells["von_mises"].max() <= 1.01 * YIELD
