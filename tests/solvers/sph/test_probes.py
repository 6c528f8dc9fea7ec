"""What needs the kernel itself: quotients make it right where the kernel is cut off, differences need no correction."""

from __future__ import annotations

import numpy as np
from sph_scenes import jittered, one_body, smoothed_velocities

from zrno.solvers.sph import Solver
from zrno.solvers.sph.problem import Cures


def test_a_transducer_at_a_corner_shows_the_pressure() -> None:
    """Equal pressure in disorder: inside, at a free face, beyond a corner, where a bare sum shows less than half."""
    x = jittered((8, 8), 0.2)
    stress = np.tile([-0.02, -0.02, -0.02, 0.0, 0.0, 0.0], (len(x), 1))
    places = ((0.4, 0.4, 0.0, 0), (0.4, 0.8, 0.0, 0), (-0.05, -0.05, 0.0, 0))
    row = Solver(one_body(x, stress=stress, transducers=places)).history()
    assert np.allclose([row[f"pressure_{k}"] for k in (1, 2, 3)], 0.02, rtol=1e-12)


def test_smoothing_leaves_an_equal_velocity_alone_at_free_faces() -> None:
    """XSPH is a sum of differences: a kernel divided by its own sum would gain nothing there and cost the momentum."""
    x = jittered((8, 8), 0.2)
    v = np.zeros_like(x)
    v[:, :2] = 0.3, -0.1
    solver = Solver(one_body(x, v, cures=Cures(xsph=1.0)))
    solver.advance(1.0, 3)
    arrays = solver._arrays()
    assert np.abs(arrays.smoothed[:, :64] - [[0.3], [-0.1]]).max() < 1e-14
    rng = np.random.default_rng(5)
    arrays.u[:64] = rng.uniform(-1.0, 1.0, 64)
    mass = solver._state.rows("mass")[0, :64]
    assert abs(mass @ (smoothed_velocities(solver, 1.0)[0] - arrays.u[:64])) < 1e-16
