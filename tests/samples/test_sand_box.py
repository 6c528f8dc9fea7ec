"""The sample's physics: run-out, slope, mass, and the weight that the plate of shells feels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, radius
from zrno.pipelines.samples import copy

WEIGHT = 2.099e-3 * 0.00981 * 36.0 * 36.0 * 192.0  # of the quarter


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "slope"), [("scene.yaml", 30.0), ("cap_plate.yaml", 47.6)])
def test_the_column_spreads_on_the_plate_and_the_plate_bears_it(tmp_path: Path, scene: str, slope: float) -> None:
    """1 + 1.6 sqrt(a) radii of the circle of the column's area, Lube et al. (2004), of sand."""
    folder = tmp_path / "sand_box"
    copy("sand_box", folder)
    path = folder / scene
    result = run([path], output=folder / "out", options={"render": []})
    assert result["status"] == "done"
    assert result["energy"]["balance_error"] < 0.02
    found = load(folder / "out")
    grain = Cloud(found.arrays("particles", len(found.times) - 1), 3)
    assert grain.mass.sum() == pytest.approx(WEIGHT / 0.00981, rel=1e-6)
    assert grain.x[:, 2].min() > 1.0  # nothing is in the plate or below it
    pressed = -found.history["structure_force_z"]
    assert pressed[-len(pressed) // 10 :].mean() == pytest.approx(WEIGHT, rel=5e-3)
    kinetic = found.history["kinetic"]
    assert kinetic[-1] < 1e-4 * kinetic.max()
    reach = radius(grain, axis="z", heap=True, fraction=0.99)
    if scene == "scene.yaml":
        alike = 72.0 / np.sqrt(np.pi)
        assert reach == pytest.approx(alike * (1.0 + 1.6 * np.sqrt(192.0 / alike)), rel=0.15)
    r, z = np.hypot(grain.x[:, 0], grain.x[:, 1]), grain.x[:, 2] - 1.0
    ring = (r / 7.2).astype(int)
    top = np.array([z[ring == k].max() if np.any(ring == k) else 0.0 for k in range(ring.max() + 1)])
    flank = np.flatnonzero((top > 0.12 * top.max()) & (top < 0.8 * top.max()))
    flank = flank[flank > 1]
    assert 10.0 < np.degrees(np.arctan(-np.polyfit(7.2 * flank, top[flank], 1)[0])) < slope
