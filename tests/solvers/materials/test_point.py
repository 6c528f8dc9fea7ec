"""The point driver: what it holds, and the example of the library's README."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from zrno.solvers.materials import (
    CapHardening,
    Elastic,
    Tait,
    cap,
    drucker_prager,
    drucker_prager_soil,
    fluid,
    mohr_coulomb,
    von_mises,
)
from zrno.solvers.materials.point import Point

README = Path(__file__).parents[3] / "solvers" / "materials" / "README.md"


def test_the_readme_runs() -> None:
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    assert len(blocks) == 1
    exec(blocks[0], {})


def test_uniaxial_stress_of_an_elastic_point() -> None:
    point = Point(Elastic.from_engineering(200.0, 0.3))
    strain = np.zeros((4, 6))
    strain[:, 0] = 0.01
    path = point.hold(strain, (False, True, True, True, True, True), np.zeros((4, 6)))
    assert path.stress[:, 0] == pytest.approx(200.0 * 0.01 * np.arange(1, 5), rel=1e-9)
    assert path.strain[-1] == pytest.approx([0.04, -0.012, -0.012, 0.0, 0.0, 0.0], abs=1e-12)
    assert point.strain == pytest.approx(path.strain[-1])


SAND = CapHardening(0.066, 0.67, 0.189)
BALANCED = {
    "von Mises": von_mises(100.0, 0.25, 0.1, 1.0),
    "cap": cap(200.0 / 3.0, 40.0, 0.25, gamma=0.18, decay=0.67, ratio=2.5, hardening=SAND, tension=-0.05),
    "flat cap": cap(200.0 / 3.0, 40.0, 0.25, gamma=0.18, decay=0.67, hardening=SAND),
    "cohesionless cap": cap(200.0 / 3.0, 40.0, 0.18, gamma=0.18, decay=0.67, ratio=2.5, hardening=SAND),
    "Drucker-Prager": drucker_prager_soil(100.0, 0.25, 0.1, 30.0, 10.0),
    "Drucker-Prager, cut": drucker_prager(100.0, 0.25, 0.1, 0.2, tension=0.0),
    "Mohr-Coulomb": mohr_coulomb(100.0, 0.25, 0.1, 30.0, 10.0, tension=0.05),
}


@pytest.mark.parametrize("name", BALANCED)
def test_work_is_elastic_energy_and_dissipation(name: str) -> None:
    """By the mean of old and new stress, as the solvers count it, along a smooth path with every kind of return."""
    t = np.linspace(0.0, 1.0, 3001)[1:]
    waves = np.array([[3.0, 5.0, 4.0, 6.0, 3.0, 2.0], [0.0, 1.0, 2.0, 0.5, 1.5, 2.5]])
    total = 0.003 * (np.sin(2.0 * np.pi * waves[0] * t[:, None] + waves[1]) - np.sin(waves[1]))
    strain = np.diff(total, axis=0, prepend=0.0)
    path = Point(BALANCED[name]).move(strain)
    double = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    means = 0.5 * (path.stress + np.vstack([np.zeros(6), path.stress[:-1]]))
    work = np.cumsum((means * strain * double).sum(axis=1))
    trace = path.stress[:, :3].sum(axis=1)
    elastic = ((path.stress**2 * double).sum(axis=1) * 1.25 - 0.25 * trace**2) / 200.0
    spent = np.cumsum(path.dissipated)
    assert spent[-1] > 0.05 * elastic.max()
    # a return from within overshoots: what it takes back is not counted as negative
    assert spent == pytest.approx(work - elastic, abs=3e-3 * spent[-1])


def test_a_path_goes_on_where_the_last_one_ended() -> None:
    strain = np.random.default_rng(0).normal(size=(40, 6)) * 0.001
    law = mohr_coulomb(1000.0, 0.3, 1.0, 30.0)
    whole = Point(law).move(strain)
    point = Point(law)
    parts = [point.move(strain[:15]), point.move(strain[15:15]), point.move(strain[15:])]
    for got, expected in zip(zip(*parts, strict=True), whole, strict=True):
        assert np.concatenate(got) == pytest.approx(expected, rel=1e-12, abs=1e-15)


def test_a_stress_that_no_strain_gives_is_said() -> None:
    wanted = np.full((1, 6), 1.0)
    with pytest.raises(RuntimeError, match="no strain"):
        Point(fluid(Tait(1.0, 1.0, 7.0), cutoff=0.0)).hold(
            np.zeros((1, 6)), (True, True, True, False, False, False), wanted
        )
