"""The sample's physics: a cut stands or fails as limit analysis says; the cure keeps cohesive soil from clumping."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy

SPACING, HEIGHT = 0.08, 2.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("samples") / "slope_failure"
    copy("slope_failure", target)
    return target


def result(folder: Path, scene: str, **options: Any) -> Any:
    options = {key.replace("__", "."): value for key, value in options.items()}
    run([folder / scene], output=folder / "out", options={"render": [], **options})
    return load(folder / "out")


def clumped(folder: Path, scene: str) -> int:
    """How many particles of the soil have their nearest neighbour within 0.6 spacings at the end."""
    found = result(folder, scene)
    last = found.arrays("particles", len(found.times) - 1)
    x = last["position"][:, :2]
    near, _ = cKDTree(x).query(x[last["material"] == 1], k=2)
    return int(np.sum(near[:, 1] < 0.6 * SPACING))


@pytest.mark.slow
def test_cohesive_soil_clumps_without_the_cure_and_does_not_with_it(folder: Path) -> None:
    assert clumped(folder, "scene.yaml") < 5
    assert clumped(folder, "plain.yaml") > 20


def settled(folder: Path, cohesion: float) -> float:
    """By how much of its height the edge of the cut has come down."""
    found = result(folder, "cut.yaml", **{"sph.laws.soil.c": cohesion})
    first, last = (found.arrays("particles", k)["position"] for k in (0, len(found.times) - 1))
    edge = (first[:, 0] > 3.5) & (first[:, 0] < 4.0) & (first[:, 1] > 1.9)
    return float((first[edge, 1] - last[edge, 1]).mean() / HEIGHT)


@pytest.mark.parametrize(("number", "stands"), [(3.5, True), (4.1, False)])
def test_a_vertical_cut_in_clay_stands_or_fails_as_limit_analysis_says(
    folder: Path, number: float, stands: bool
) -> None:
    """rho g H / c = 3.78 (Pastor, Thai and Francescato 2000; Taylor 1937: 3.83)."""
    down = settled(folder, 1850.0 * 9.81 * HEIGHT / number)
    assert down < 0.04 if stands else down > 0.08
