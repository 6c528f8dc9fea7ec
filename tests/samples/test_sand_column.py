"""The sample's physics: run-out and slope of the heap, and the stress of a column at rest under its own weight."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, toe
from zrno.pipelines.samples import copy

DENSITY, GRAVITY = 2650.0, 9.81


def run_out(sand: Cloud) -> float:
    """Where the heap is still a tenth of the column deep."""
    return float(toe(sand, axis="x", heap=True, depth=0.01, window=0.02))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("samples") / "sand_column"
    copy("sand_column", target)
    return target


def result(folder: Path, scene: str, **options: Any) -> Any:
    options = {key.replace("__", "."): value for key, value in options.items()}
    run([folder / scene], output=folder / "out", options={"render": [], **options})
    return load(folder / "out")


def test_the_sand_runs_out_as_far_as_in_experiments_and_lies_below_its_friction_angle(folder: Path) -> None:
    """d = w (1 + 1.2 h/w), Lube et al. (2005)."""
    found = result(folder, "scene.yaml", spacing=0.005, numbers__depth=0.015)
    sand = Cloud(found.arrays("particles", len(found.times) - 1), 2).of(1)
    assert run_out(sand) == pytest.approx(0.32, rel=0.05)
    x, y = sand.x[:, 0], sand.x[:, 1]
    assert y.max() > 0.093  # a low column keeps its height
    assert y.min() > 0.0  # the floor holds
    column = (x / 0.01).astype(int)
    top = np.array([y[column == k].max() if np.any(column == k) else 0.0 for k in range(column.max() + 1)])
    flank = np.flatnonzero((top > 0.005) & (top < 0.08))
    slope = np.degrees(np.arctan(-np.polyfit(0.01 * flank, top[flank], 1)[0]))
    assert 12.0 < slope < 31.0
    kinetic = found.history["kinetic"]
    assert kinetic[-1] < 1e-3 * kinetic.max()


@pytest.mark.parametrize("spacings", [(0.01, 0.005), pytest.param((0.005, 0.0025), marks=pytest.mark.slow)])
def test_the_run_out_hardly_depends_on_the_spacing(folder: Path, spacings: tuple[float, float]) -> None:
    """And the centre of mass moves by less than the spacing changes it to first order."""
    ends, centres = [], []
    for spacing in spacings:
        found = result(folder, "scene.yaml", spacing=spacing, numbers__depth=3.0 * spacing)
        sand = Cloud(found.arrays("particles", len(found.times) - 1), 2).of(1)
        ends.append(run_out(sand))
        centres.append(float(np.average(sand.x[:, 0], weights=sand.mass)))
        report = found.history["kinetic"] + found.history["internal"] - found.history["external_work"]
        assert abs(report[-1] - report[0]) < 0.01 * np.abs(found.history["external_work"]).max()
    assert ends[1] == pytest.approx(ends[0], rel=0.03)
    assert centres[1] == pytest.approx(centres[0], rel=0.015)


@pytest.mark.slow
@pytest.mark.parametrize("gaps", [True, False])
def test_the_density_of_grain_does_not_drift(folder: Path, gaps: bool) -> None:
    """It follows the pressure, 0.4 % at the foot; but for grain that has opened. Without gaps it ratchets down."""
    options = {"spacing": 0.01, "numbers.depth": 0.03, "sph.laws.sand.gaps": gaps}
    found = result(folder, "scene.yaml", **options)
    sand = Cloud(found.arrays("particles", len(found.times) - 1), 2).of(1)
    drift = np.abs(np.asarray(sand.arrays["density"]) / DENSITY - 1.0)
    within = np.average(drift < 0.03)
    assert bool(within > 0.98) is gaps


def test_the_floor_bears_the_weight_above_it(folder: Path) -> None:
    """Where grain came to rest after a flow, too; by a law of its own the floor's pressure was several times that."""
    found = result(folder, "scene.yaml", spacing=0.01, numbers__depth=0.03)
    last = found.arrays("particles", len(found.times) - 1)
    x, y, material = last["position"][:, 0], last["position"][:, 1], last["material"]
    assert np.abs(last["velocity"][material == 2]).max() == 0.0
    for low, high in ((0.02, 0.1), (0.1, 0.18), (0.2, 0.28)):
        above = DENSITY * 0.01**2 * GRAVITY * np.sum((material == 1) & (x > low) & (x < high)) / (high - low)
        here = (material == 2) & (y > -0.01) & (x > low) & (x < high)
        assert -last["stress"][here, 1].mean() == pytest.approx(above, rel=0.5)


def test_a_column_at_rest_bears_its_own_weight(folder: Path) -> None:
    found = result(folder, "rest.yaml")
    last = found.arrays("particles", len(found.times) - 1)
    y, stress = last["position"][:, 1], last["stress"]
    depth = y.max() + 0.0025 - y
    weight = DENSITY * GRAVITY * depth
    assert np.abs(-stress[:, 1] - weight).max() < 0.05 * DENSITY * GRAVITY * 0.2
    deep = depth > 0.01
    assert -stress[deep, 1] == pytest.approx(weight[deep], rel=0.05)
    lateral = stress[:, 0] / stress[:, 1]
    assert 0.40 < lateral.min() <= lateral.max() < 0.55  # up to the surface: diffusion does not even it out
    assert found.history["kinetic"][-1] < 1e-3 * found.history["kinetic"].max()
