"""The sample's physics: the plate bears the weight of the water and bends as theory says."""

from __future__ import annotations

from pathlib import Path

import pytest

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy


@pytest.mark.slow
def test_the_plate_bears_the_water(tmp_path: Path) -> None:
    copy("water_column", tmp_path / "water")
    result = run([tmp_path / "water" / "scene.yaml"], output=tmp_path / "out")
    assert result["status"] == "done"
    history = load(tmp_path / "out").history
    assert history["structure_force_y"][-1] == pytest.approx(-1000.0 * 9.81 * 2.0, rel=0.005)
    assert history["max_displacement"][-1] == pytest.approx(7.06e-5, rel=0.03)
