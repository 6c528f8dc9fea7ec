"""The sample's physics: the radius of the heap, its slope, and what the quarter's planes and the floor keep."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, radius
from zrno.pipelines.samples import copy


@pytest.mark.slow
@pytest.mark.parametrize("spacing", [0.0125, pytest.param(0.01, marks=pytest.mark.slow)])
def test_the_cylinder_spreads_as_far_as_in_experiments_and_lies_below_its_friction_angle(
    tmp_path: Path, spacing: float
) -> None:
    """r (1 + 1.24 h/r) = 0.224 m, Lube et al. (2004)."""
    folder = tmp_path / "sand_cone"
    copy("sand_cone", folder)
    options = {"render": [], "spacing": spacing, "numbers.depth": 3.0 * spacing}
    run([folder / "scene.yaml"], output=folder / "out", options=options)
    found = load(folder / "out")
    sand = Cloud(found.arrays("particles", len(found.times) - 1), 3).of(1)
    assert radius(sand, axis="z", heap=True, fraction=0.99) == pytest.approx(0.224, rel=0.15)
    assert sand.mass.sum() == pytest.approx(2600.0 * np.pi * 0.1**2 * 0.1 / 4.0, rel=6e-3)  # the mesh has facets
    assert sand.x[:, :2].min() > 0.0  # the planes of symmetry hold, and the floor
    assert sand.x[:, 2].min() > 0.0
    r, z = np.hypot(sand.x[:, 0], sand.x[:, 1]), sand.x[:, 2]
    ring = (r / spacing).astype(int)
    top = np.array([z[ring == k].max() if np.any(ring == k) else 0.0 for k in range(ring.max() + 1)])
    flank = np.flatnonzero((top > 0.015) & (top < 0.08))
    assert 10.0 < np.degrees(np.arctan(-np.polyfit(spacing * flank, top[flank], 1)[0])) < 30.0
    kinetic = found.history["kinetic"]
    assert kinetic[-1] < 5e-3 * kinetic.max()
    balance = kinetic + found.history["internal"] - found.history["external_work"]
    assert abs(balance[-1] - balance[0]) < 0.02 * np.abs(found.history["external_work"]).max()
