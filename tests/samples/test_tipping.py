"""The sample's physics: the plate's edge goes where it is moved, the grain lies, and slides as friction says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.load import Result
from zrno.pipelines.samples import copy

WEIGHT = 0.00981  # N by g


def tipped(folder: Path, scene: str, until: float, **options: object) -> Result:
    copy("tipping", folder)
    run([folder / scene], output=folder / "out", until=until, options={"render": [], **options})
    return load(folder / "out")


def test_the_plate_bears_the_cone(tmp_path: Path) -> None:
    """The cone lands, and lies after 60 ms: the mean force on the plate is its weight."""
    found = tipped(tmp_path / "tipping", "scene.yaml", 100.0)
    h = found.history
    lying = h["time"] > 60.0
    mass = found.arrays("particles", 0)["mass"].sum()
    assert -h["structure_force_z"][lying].mean() == pytest.approx(WEIGHT * mass, rel=0.01)
    plate = found.arrays("elements", len(found.times) - 1)
    assert plate["displacement"][:, 2].max() == pytest.approx(10.0, rel=1e-3)  # the edge: 50 mm in 500 ms


def along(found: Result, time: float) -> np.ndarray:
    """How far each particle has gone down the plate, which turns about the hinge's edge by asin(z/150)."""
    start = found.arrays("particles", 0)["position"]
    moved = found.arrays("particles", int(np.searchsorted(found.times, time - 1e-6)))["position"]
    x = moved + np.array([75.0, 0.0, 0.0])
    angle = np.arcsin(min(time, 500.0) / 500.0 * 50.0 / 150.0)
    way: np.ndarray = start[:, 0] + 75.0 - (x[:, 0] * np.cos(angle) + x[:, 2] * np.sin(angle))
    return way


def lowest(found: Result) -> np.ndarray:
    height = found.arrays("particles", 0)["position"][:, 2]
    low: np.ndarray = height < height.min() + 2.0
    return low


@pytest.mark.slow
def test_the_cone_slides_as_a_whole_when_friction_says(tmp_path: Path) -> None:
    """[T] 8.3: from about 450 ms, where the plate stands at the angle of friction."""
    found = tipped(tmp_path / "tipping", "scene.yaml", 700.0)
    low = lowest(found)
    assert abs(np.median(along(found, 400.0)[low])) < 0.05
    assert 0.3 < np.median(along(found, 500.0)[low]) < 2.0
    assert np.median(along(found, 600.0)[low]) > 5.0


@pytest.mark.slow
def test_a_cone_of_sand_sheds_before_it_slides(tmp_path: Path) -> None:
    """[T] 8.3: grain runs down the flank from about 200 ms, where flank and plate together stand at 30 degrees."""
    found = tipped(tmp_path / "tipping", "sand.yaml", 450.0)
    early, late = (np.quantile(along(found, t + 100.0) - along(found, t), 0.95) for t in (50.0, 300.0))
    assert early < 0.8
    assert late > 5.0 * early
    assert np.median(along(found, 400.0)[lowest(found)]) < 0.5
