"""The sample's physics: run-out, slope, mass, and the weight that the structure feels, on a plate and in a box."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, radius
from zrno.pipelines.samples import copy

GRAVITY = 0.00981
WEIGHT = 2.099e-3 * GRAVITY * 36.0 * 36.0 * 192.0  # of the quarter
CELL = 7.2


def come_to_rest(folder: Path, scene: str, spacing: float = CELL) -> Cloud:
    """The grain at 1 s: none is lost, none is in the plate, and what stands below bears all of it."""
    copy("sand_box", folder)
    text = (folder / scene).read_text(encoding="utf-8")
    assert f"spacing: {CELL}" in text
    (folder / scene).write_text(text.replace(f"spacing: {CELL}", f"spacing: {spacing:g}"), encoding="utf-8")
    result = run([folder / scene], output=folder / "out", options={"render": []})
    assert result["status"] == "done"
    assert result["energy"]["balance_error"] < 0.02
    found = load(folder / "out")
    grain = Cloud(found.arrays("particles", len(found.times) - 1), 3)
    assert grain.mass.sum() == pytest.approx(WEIGHT / GRAVITY, rel=1e-6)
    assert grain.x[:, 2].min() > 1.0
    pressed = -found.history["structure_force_z"]
    assert pressed[-len(pressed) // 10 :].mean() == pytest.approx(WEIGHT, rel=5e-3)
    kinetic = found.history["kinetic"]
    assert kinetic[-1] < 1e-4 * kinetic.max()
    return grain


def top_of(grain: Cloud, cell: float) -> np.ndarray:
    """The uppermost centre above the plate in rings of a cell."""
    ring = (np.hypot(grain.x[:, 0], grain.x[:, 1]) / cell).astype(int)
    z = grain.x[:, 2] - 1.0
    return np.array([z[ring == k].max() if np.any(ring == k) else 0.0 for k in range(ring.max() + 1)])


def slope_of(grain: Cloud, cell: float) -> float:
    """Of the flank [degrees], from 80 % of the height down to where the tongue of one layer begins."""
    top = top_of(grain, cell)
    tongue = int(np.argmax(top < 0.75 * cell))  # beyond it single grains may lie on others
    flank = np.flatnonzero(top[:tongue] < 0.8 * top.max())
    flank = flank[flank > 1]
    return float(np.degrees(np.arctan(-np.polyfit(cell * flank, top[flank], 1)[0])))


@pytest.mark.slow
def test_sand_runs_out_as_far_as_in_experiments(tmp_path: Path) -> None:
    """1 + 1.6 sqrt(a) radii of the circle of the column's area, Lube et al. (2004): where the deposit ends."""
    alike = 72.0 / np.sqrt(np.pi)
    wanted = alike * (1.0 + 1.6 * np.sqrt(192.0 / alike))
    wrong = []
    for spacing in (9.0, CELL, 6.0):
        grain = come_to_rest(tmp_path / f"{spacing:g}", "scene.yaml", spacing)
        wrong.append(radius(grain, axis="z", heap=True, fraction=0.999) / wanted - 1.0)
        assert radius(grain, axis="z", heap=True, fraction=0.99) == pytest.approx(wanted, rel=0.1)
        assert 10.0 < slope_of(grain, spacing) < 30.0
    assert np.abs(wrong).max() < 0.06
    assert abs(wrong[2]) < abs(wrong[0])


@pytest.mark.slow
def test_the_cap_model_comes_to_rest(tmp_path: Path) -> None:
    """Through retraction and tension; its slope at the origin, 0.377, is that of 47.6 degrees in compression."""
    grain = come_to_rest(tmp_path / "cap", "cap_plate.yaml")
    assert 10.0 < slope_of(grain, CELL) < 47.6


@pytest.mark.slow
def test_the_heap_in_the_box_is_that_on_the_plate(tmp_path: Path) -> None:
    box, plate = (come_to_rest(tmp_path / name, f"{name}.yaml") for name in ("container", "scene"))
    assert top_of(box, 20.0)[:8] == pytest.approx(top_of(plate, 20.0)[:8], abs=0.5 * CELL)
