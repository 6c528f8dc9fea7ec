"""The sample's physics: where the shell comes to rest, against the closed form."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, inner_radius
from zrno.pipelines.samples import copy
from zrno.solvers.exact import VerneyShell

EXACT = VerneyShell(inner=80, outer=100, density=1.845e-3, yield_stress=330, speed=417.0786)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("samples") / "verney_shell"
    copy("verney_shell", target)
    return target


def test_the_shell_stops_where_its_energy_is_used_up(folder: Path) -> None:
    said = run([folder / "scene.yaml"], output=folder / "out", options={"render": [], "spacing": 2})
    found = load(folder / "out")
    history = found.history
    start = np.pi / 4.0 * EXACT.density * EXACT.speed**2 * EXACT.inner**2 * np.log(EXACT.outer / EXACT.inner)
    assert history["kinetic"][0] == pytest.approx(start, rel=1e-3)  # the field of velocities is the exact one
    clouds = [Cloud(found.arrays("particles", k), 2) for k in range(len(found.times))]
    least = min(inner_radius(cloud, axis="z") for cloud in clouds)
    assert least == pytest.approx(EXACT.inner_radius(), rel=0.02)
    # by the mean square of all radii, which falls by as much as those of the faces do
    squares = [np.average((cloud.x**2).sum(axis=1), weights=cloud.mass) for cloud in clouds]
    assert np.sqrt(80.0**2 - (squares[0] - min(squares))) == pytest.approx(EXACT.inner_radius(), rel=0.005)
    assert history["kinetic"][-1] < 1e-3 * start
    assert np.abs(clouds[-1].arrays["density"] / EXACT.density - 1.0).max() < 0.005
    assert said["energy"]["balance_error"] < 0.01
