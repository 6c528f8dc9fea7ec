"""The sample's wagon: it holds what is poured into it until its door opens, and not a particle passes a wall."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy


@pytest.mark.slow
def test_grain_leaves_by_the_door_alone(tmp_path: Path) -> None:
    folder = tmp_path / "wagon"
    copy("wagon", folder)
    run([folder / "scene.yaml"], output=folder / "out", options={"render": []}, until=2500.0)
    found = load(folder / "out")
    shut = found.arrays("particles", int(np.searchsorted(found.times, 1500.0)))
    count = len(shut["id"])
    assert count == len(found.arrays("particles", 0)["id"])
    assert shut["position"][:, 2].min() > 0.0  # above the door
    for k in range(len(found.times)):
        x, y, z = found.arrays("particles", k)["position"].T
        within = z > 0.0
        assert x[within].max() < 2400.0
        assert y[within].max() < 1200.0
        assert np.all(z[within] > 0.58 * (x[within] - 600.0))  # the end slope
    assert len(found.arrays("particles", len(found.times) - 1)["id"]) < 0.95 * count
