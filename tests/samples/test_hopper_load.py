"""Grain in an elastic silo: what the floor and the walls get, against the weight of a column."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy

RHO_G = 2.099e-3 * 0.00981


@pytest.mark.slow
def test_walls_and_floor_bear_the_weight_of_the_grain(tmp_path: Path) -> None:
    folder = tmp_path / "silo"
    copy("hopper_load", folder)
    run([folder / "scene.yaml"], output=folder / "out", options={"render": []})
    found = load(folder / "out")
    nodes = found.arrays("elements", len(found.times) - 1)
    force = nodes["contact_force"]
    weight = RHO_G * 48.0**2 * 240.0
    assert -force[:, 2].sum() == pytest.approx(weight, rel=5e-3)
    assert force.sum(axis=0)[2] == pytest.approx(found.history["structure_force_z"][-1], rel=1e-6)
    start = nodes["position"] - nodes["displacement"]
    walls = start[:, 2] > 1.0
    assert 0.02 * weight < -force[walls, 2].sum() < 0.4 * np.abs(force[walls, :2]).sum()
