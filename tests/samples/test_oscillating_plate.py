"""The sample's physics: period and amplitude of a clamped plate, against the thin plate's and the thick one's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, centre
from zrno.pipelines.samples import copy
from zrno.pipelines.signals import loss, period
from zrno.solvers.exact import OscillatingPlate

EXACT = OscillatingPlate(length=0.2, thickness=0.02, young=2e6, poisson=0.3975, density=1000.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("samples") / "oscillating_plate"
    copy("oscillating_plate", target)
    return target


def swings(folder: Path, spacing: float, end: float) -> tuple[float, float, float]:
    """Period, share of the amplitude that a cycle loses, balance of the energy."""
    options = {"render": [], "spacing": spacing, "end_time": end, "checkpoint.every": end}
    said = run([folder / "scene.yaml"], output=folder / "out", options=options)
    found = load(folder / "out")
    clouds = [Cloud(found.arrays("particles", k), 2) for k in range(len(found.times))]
    held = clouds[0].x[:, 0] < 0.0
    assert held.sum() == round(0.02 * 0.02 / spacing**2)  # the clamp, by `bc_where`
    assert np.all(clouds[-1].arrays["displacement"][held] == 0.0)
    tip = clouds[0].arrays["velocity"][:, 1].max()
    assert tip == pytest.approx(0.01 * 57.03, rel=0.03)
    places = np.array([centre(cloud, axis="y") for cloud in clouds])
    return period(found.times, places), loss(found.times, places), said["energy"]["balance_error"]


@pytest.mark.slow
def test_the_period_converges_to_that_of_a_thick_plate(folder: Path) -> None:
    coarse, fine = (swings(folder, 0.02 / layers, 0.6)[0] / EXACT.thick_period() - 1.0 for layers in (4, 6))
    assert 0.0 < fine < 0.055
    assert np.log(coarse / fine) / np.log(6 / 4) > 1.3  # the order; 1.8 on finer ones, see the page


@pytest.mark.slow
def test_ten_periods(folder: Path) -> None:
    found, lost, balance = swings(folder, 0.02 / 12, 2.8)
    assert found == pytest.approx(EXACT.period(), rel=0.03)
    assert abs(1.0 - (1.0 - lost) ** 10) < 0.05
    assert balance < 1e-3
