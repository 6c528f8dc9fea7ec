"""The pressure of a particle on a surface of finer and of coarser nodes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zrno.solvers.coupling.pressure import pressure


def test_a_force_is_spread_over_the_disc_of_a_particle_and_stays_whole() -> None:
    grid = np.arange(41.0)
    x = np.array([(a, b, 0.0) for a in grid for b in grid])
    force = np.zeros_like(x)
    force[41 * 20 + 20] = [0.0, 0.0, -3.0]
    force[41 * 8 + 8] = [4.0, 0.0, 0.0]
    found = pressure(x, force, np.ones(len(x)), 6.0)
    assert found.sum() == pytest.approx(7.0, rel=1e-12)
    assert found[41 * 20 + 24] == found[41 * 20 + 20] == pytest.approx(3.0 / (math.pi * 36.0), rel=0.01)
    assert found[41 * 20 + 27] == 0.0


def test_on_a_coarser_surface_it_is_a_nodes_force_by_its_area() -> None:
    x = 10.0 * np.eye(3)
    force = np.array([[0.0, 3.0, 4.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    assert pressure(x, force, np.array([2.0, 1.0, 4.0]), 6.0).tolist() == [2.5, 0.0, 0.25]
    assert pressure(x, 0.0 * force, np.ones(3), 6.0).tolist() == [0.0, 0.0, 0.0]
