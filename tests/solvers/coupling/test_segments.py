"""Face contact in the plane: a block of particles on the segments of a rigid slab that is thinner than a particle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fem_meshes import group, held, plane, quads
from sph_scenes import lattice

from zrno.solvers import fem, sph
from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.coupling import Coupled, Exchange
from zrno.solvers.materials import Elastic
from zrno.solvers.sph.problem import Body
from zrno.solvers.sph.surface import Facets

SPACING, DENSITY, GRAVITY = 2.0, 2.0e-3, 0.00981  # mm, g/mm^3, mm/ms^2
COLUMNS, ROWS, THICKNESS = 6, 4, 0.5
SOFT = Elastic.from_engineering(50.0, 0.3)
RUBBED = Coulomb(0.5, 0.4)
WEIGHT = COLUMNS * ROWS * DENSITY * SPACING**2 * GRAVITY


def slid(degrees: float) -> tuple[float, np.ndarray]:
    """Acceleration along a slope that tilts from 5 to 25 ms, from 40 to 60 ms, and the force on the slab then."""
    x, nodes, number = quads(20, 1, lambda r, s: plane(np.column_stack([80.0 * r - 20.0, THICKNESS * (s - 1.0)])))
    slab = group("quad4", "plane", nodes, SOFT, plane="strain", density=DENSITY)
    structure = fem.Problem("slab", 2, x, np.arange(1, len(x) + 1), (slab,), held(len(x), (slice(None), "xyzabc")),
                            steps=((120, 0.5),), rigid=True)  # fmt: skip
    below, above = number[:, 0], number[::-1, 1]
    rim = np.concatenate([below, above, below[:1]])
    corners = np.column_stack([rim[:-1], rim[1:]])
    facets = Facets(x, corners, np.zeros(len(corners)), np.ones(len(corners), bool), RUBBED)
    places = lattice((COLUMNS, ROWS), (0.0, 0.0), SPACING)
    places = places if places.shape[1] == 3 else np.column_stack([places, np.zeros(len(places))])
    n = len(places)
    angle, times = math.radians(degrees), np.linspace(0.0, 60.0, 61)
    tilt = angle * np.clip((times - 5.0) / 20.0, 0.0, 1.0)
    across = -GRAVITY * np.cos(tilt) * np.clip(times / 5.0, 0.0, 1.0)
    curve = times, np.column_stack([GRAVITY * np.sin(tilt), across, np.zeros_like(times)])
    grain = sph.Problem(
        dimension=2, x=places, v=np.zeros((n, 3)), mass=np.full(n, DENSITY * SPACING**2), h=np.full(n, 1.3 * SPACING),
        density=np.full(n, DENSITY), body=np.zeros(n, np.int64), bodies=(Body(1, "block", SOFT, DENSITY),),
        end_time=60.0, facets=facets, contact_damping=0.3, body_curve=curve,
    )  # fmt: skip
    coupled = Coupled(fem.Solver(structure), sph.Solver(grain, threads=1), Exchange(nodes=np.arange(len(x))))
    speed, force = [], []
    for step in range(120):
        coupled.advance(math.inf, 1)
        if step in (79, 119):
            speed.append(float(coupled.frame().particles["velocity"][:, 0].mean()))
        if step >= 80:
            force.append(coupled.force.sum(axis=0))
    return (speed[1] - speed[0]) / 20.0, np.mean(force, axis=0) / WEIGHT


@pytest.mark.parametrize("degrees", [20.0, 30.0])
def test_a_block_on_an_incline_of_segments(degrees: float) -> None:
    """Sticks below mu_s = tan 26.6 degrees, slides above with g (sin - mu_k cos); the slab bears the weight."""
    acceleration, force = slid(degrees)
    angle = math.radians(degrees)
    assert force[1] == pytest.approx(-math.cos(angle), rel=0.005)
    if math.tan(angle) < RUBBED.static:
        assert abs(acceleration) < 1e-4 * GRAVITY
        assert force[0] == pytest.approx(math.sin(angle), rel=0.005)
    else:
        wanted = GRAVITY * (math.sin(angle) - RUBBED.kinetic * math.cos(angle))
        assert acceleration == pytest.approx(wanted, rel=0.01)
