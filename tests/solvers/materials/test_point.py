"""The point driver: what it holds, and the example of the library's README."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from zrno.solvers.materials import Elastic, Tait, fluid, mohr_coulomb
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
