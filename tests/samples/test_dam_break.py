"""The sample's physics: the front against Martin and Moyce's, and a floor whose pressure is the water's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, front
from zrno.pipelines.samples import copy


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("samples") / "dam_break"
    copy("dam_break", target)
    return target


def test_the_front_runs_as_in_the_experiments(folder: Path) -> None:
    options = {"render": [], "spacing": 0.05, "numbers.depth": 0.15}
    run([folder / "scene.yaml"], output=folder / "out", options=options)
    found = load(folder / "out")
    frames = range(len(found.times))
    reach = [front(Cloud(found.arrays("particles", k), 2).of(1), axis="x", heap=True) for k in frames]
    time, measured = np.genfromtxt(folder / "reference/front.csv", delimiter=",", skip_header=4, usecols=(0, 1)).T
    assert len(time) == 6
    here = np.interp(time, found.times, reach)
    assert np.linalg.norm(here - measured) < 0.10 * np.linalg.norm(measured)
    speed = (here[-1] - here[2]) / (time[-1] - time[2])
    assert speed == pytest.approx((measured[-1] - measured[2]) / (time[-1] - time[2]), rel=0.10)
    last = found.arrays("particles", len(found.times) - 1)
    water = last["material"] == 1
    pressure = -last["stress"][:, :3].mean(axis=1)
    assert last["position"][water, 1].min() > 0.0
    assert np.abs(last["density"][water] / 1000.0 - 1.0).max() < 0.015
    assert pressure[~water].max() < 1.3 * pressure[water].max()  # by the law of water it is several times that
