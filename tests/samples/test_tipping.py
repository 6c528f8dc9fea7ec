"""The sample's physics: the plate's edge goes where it is moved, the grain lies, and slides as friction says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy

WEIGHT = 0.00981  # N by g


def tipped(folder: Path, until: float, **options: object):
    copy("tipping", folder)
    run([folder / "scene.yaml"], output=folder / "out", until=until, options={"render": [], **options})
    return load(folder / "out")


def test_the_plate_bears_the_cone(tmp_path: Path) -> None:
    """In the first 60 ms the cone lands, and lies: the mean force on the plate is its weight."""
    found = tipped(tmp_path / "tipping", 60.0)
    h = found.history
    lying = h["time"] > 40.0
    mass = found.arrays("particles", 0)["mass"].sum()
    assert -h["structure_force_z"][lying].mean() == pytest.approx(WEIGHT * mass, rel=0.01)
    assert np.abs(h["interface_energy"][-1]) < 0.5 * h["external_work"][-1]
    plate = found.arrays("elements", len(found.times) - 1)
    assert plate["displacement"][:, 2].max() == pytest.approx(6.0, rel=1e-3)  # the edge: 50 mm in 500 ms


@pytest.mark.slow
def test_the_cone_sheds_and_slides(tmp_path: Path) -> None:
    """[T] 8.3: grain runs down the flank from about 200 ms, the cone slides from about 450 ms."""
    found = tipped(tmp_path / "tipping", 1000.0)
    plate = {t: k for k, t in enumerate(found.times)}
    start = found.arrays("particles", 0)["position"]

    def along(time: float) -> np.ndarray:
        """How far each particle has gone down the plate: across the hinge's edge the plate turns by asin(z/150)."""
        x = found.arrays("particles", plate[time])["position"] + np.array([75.0, 0.0, 0.0])
        angle = np.arcsin(min(time, 500.0) / 500.0 * 50.0 / 150.0)
        now = x[:, 0] * np.cos(angle) + x[:, 2] * np.sin(angle)
        return start[:, 0] + 75.0 - now

    low = start[:, 2] < 8.0  # what lies on the plate
    assert np.median(along(200.0)[low]) < 1.0
    assert along(250.0).max() > 5.0
    assert np.median(along(400.0)[low]) < 3.0
    assert np.median(along(600.0)[low]) > 5.0
    assert found.history["kinetic"][-1] > 100.0
