"""The front against Martin and Moyce's and the inviscid one, and a floor whose pressure is the water's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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


def front_of(result: Path) -> tuple[np.ndarray, np.ndarray, Any]:
    """Times, the front there, and the result."""
    found = load(result)
    frames = range(len(found.times))
    reach = [front(Cloud(found.arrays("particles", k), 2).of(1), axis="x", heap=True) for k in frames]
    return np.array(found.times), np.array(reach), found


def curve(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Times and fronts of a reference."""
    lines = [line for line in path.read_text().splitlines() if line[0].isdigit()]
    time, place = np.loadtxt(lines, delimiter=",", usecols=(0, 1)).T
    return time, place


def error(here: np.ndarray, there: np.ndarray) -> float:
    return float(np.linalg.norm(here - there) / np.linalg.norm(there))


def test_the_front_runs_as_in_the_experiments(folder: Path) -> None:
    options = {"render": [], "spacing": 0.05, "numbers.depth": 0.15}
    run([folder / "scene.yaml"], output=folder / "out", options=options)
    times, reach, found = front_of(folder / "out")
    time, measured = curve(folder / "reference/front.csv")
    assert len(time) == 6
    here = np.interp(time, times, reach)
    assert error(here, measured) < 0.10
    speed = (here[-1] - here[2]) / (time[-1] - time[2])
    assert speed == pytest.approx((measured[-1] - measured[2]) / (time[-1] - time[2]), rel=0.10)
    for name in ("front", "front_2"):  # the clock set where the experiment first saw the front: see the README
        time, measured = curve(folder / f"reference/{name}.csv")
        late = time[0] - np.interp(measured[0], reach, times)
        assert error(np.interp(time - late, times, reach), measured) < 0.04
    last = found.arrays("particles", len(found.times) - 1)
    water = last["material"] == 1
    pressure = -last["stress"][:, :3].mean(axis=1)
    assert last["position"][water, 1].min() > 0.0
    assert np.abs(last["density"][water] / 1000.0 - 1.0).max() < 0.015
    assert pressure[~water].max() < 1.3 * pressure[water].max()  # by the law of water it is several times that


def test_the_front_on_a_smooth_floor_converges_to_the_inviscid_one(folder: Path) -> None:
    time, place = curve(folder / "reference/inviscid.csv")
    errors = []
    for spacing in (0.1, 0.05):
        output = folder / f"smooth_{spacing}"
        run([folder / "smooth.yaml"], output=output, options={"render": [], "spacing": spacing})
        times, reach, _ = front_of(output)
        done = time <= times[-1]
        errors.append(error(np.interp(time[done], times, reach), place[done]))
    assert errors[1] < 0.03
    assert errors[1] < 0.75 * errors[0]
