"""The sample's physics: the plate bears the weight of the water, bends as theory says, and is at rest."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy

WEIGHT = 1000.0 * 9.81 * 2.0  # of the water over each metre of the strip's breadth


def settled(folder: Path, scene: str, changes: list[tuple[str, str]] | None = None) -> dict[str, np.ndarray]:
    """The history of a scene with another mesh or spacing: pieces of its text and what stands in their place."""
    copy("water_column", folder)
    text = (folder / scene).read_text(encoding="utf-8")
    for old, new in changes or []:
        assert old in text
        text = text.replace(old, new)
    (folder / "own.yaml").write_text(text, encoding="utf-8")
    result = run([folder / "own.yaml"], output=folder / "out")
    assert result["status"] == "done"
    assert result["energy"]["balance_error"] < 2e-3  # what dynamic relaxation takes is in it
    return load(folder / "out").history


@pytest.mark.slow
def test_the_plate_converges_to_the_reference(tmp_path: Path) -> None:
    """Mesh and spacing halved together. At 160 x 16 elements the structure alone is 0.1 % off, at 320 x 32 0.03 %."""
    wrong = []
    for along, spacing in ((20, 0.1), (40, 0.05), (80, 0.025)):
        numbers = f"settings: plate.yaml, numbers: {{along: {along}, across: {along // 10}}}"
        changes = [("settings: plate.yaml", numbers), ("spacing: 0.05", f"spacing: {spacing}")]
        history = settled(tmp_path / str(along), "scene.yaml", changes)
        late = history["structure_force_y"][history["time"] > 1.75]
        assert late == pytest.approx(-WEIGHT, rel=2e-3)
        assert history["kinetic"][-1] < 1e-3 * history["external_work"][-1]
        wrong.append(1.0 - history["max_displacement"][-1] / 7.06e-5)
    assert np.all(np.diff(wrong) < 0.0)
    assert wrong[1] < 0.015
    assert 0.0 < wrong[2] < 0.0075


@pytest.mark.slow
def test_shells_that_do_not_shear(tmp_path: Path) -> None:
    history = settled(tmp_path / "water", "shells.yaml")
    late = history["structure_force_z"][history["time"] > 1.75]
    assert late == pytest.approx(-0.4 * WEIGHT, rel=2e-3)
    assert history["max_displacement"][-1] == pytest.approx(6.86e-5, rel=0.005)
