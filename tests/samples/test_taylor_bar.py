"""The sample's physics: how short and how wide the copper rod is, against the range of the literature."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, front
from zrno.pipelines.samples import copy


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("samples") / "taylor_bar"
    copy("taylor_bar", target)
    return target


def published(folder: Path) -> dict[str, tuple[float, float]]:
    """Least and greatest value of the literature by quantity."""
    lines = (folder / "reference/published.csv").read_text().splitlines()
    rows = csv.DictReader(line for line in lines if line[:1] != "#")
    return {row["quantity"]: (float(row["least"]), float(row["greatest"])) for row in rows}


def impact(folder: Path, cells: int, scene: str = "scene.yaml") -> tuple[float, float, float, dict[str, Any]]:
    """Length, radius of the outermost particle, plastic strain, what the run said."""
    options = {"render": [], "spacing": 3.2 / cells, "output.every": 0.04}
    said = run([folder / scene], output=folder / "out", options=options)
    found = load(folder / "out")
    rod = Cloud(found.arrays("particles", len(found.times) - 1), 3)
    assert rod.mass.sum() == pytest.approx(8.93e-3 * np.pi * 3.2**2 / 4.0 * 32.4, rel=1e-3)
    wide = float(np.hypot(rod.x[:, 0], rod.x[:, 1]).max())
    return front(rod, axis="z"), wide, float(found.history["max_plastic_strain"][-1]), said


def check(folder: Path, length: float, wide: float, strain: float, said: dict[str, Any]) -> None:
    low, high = published(folder)["length"]
    assert 0.98 * low < length < 1.02 * high
    low, high = published(folder)["radius"]
    assert 0.95 * low < wide < 1.05 * high
    low, high = published(folder)["plastic_strain"]
    assert 0.95 * low < strain < 1.05 * high
    assert said["energy"]["balance_error"] < 0.01


@pytest.mark.slow
def test_the_rod_is_as_short_and_as_wide_as_in_the_literature(folder: Path) -> None:
    check(folder, *impact(folder, 5))


@pytest.mark.slow
@pytest.mark.parametrize(("cells", "scene"), [(8, "scene.yaml"), (12, "scene.yaml"), (8, "wall.yaml")])
def test_finer_rods_and_a_wall_that_only_pushes(folder: Path, cells: int, scene: str) -> None:
    check(folder, *impact(folder, cells, scene))
