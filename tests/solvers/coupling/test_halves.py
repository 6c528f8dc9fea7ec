"""Half a model behind a symmetry plane and the whole: facets end at the plane and need no images beyond it."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from coupled_scenes import ELEMENTS, SIDE, STEEL, THICKNESS, drop, facing, plate
from fem_meshes import held, plane, quads, shell
from sph_scenes import lattice

from zrno.solvers import fem
from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.materials import drucker_prager_soil
from zrno.solvers.sph import Body, Problem, Solver
from zrno.solvers.sph.ghosts import SYMMETRY, Plane
from zrno.solvers.sph.surface import Facets

GRAVITY = 0.00981
MIDDLE = 0.5 * SIDE


def half_plate() -> fem.Problem:
    """The half of `plate` beyond x = MIDDLE, held there as by its other half."""
    width = ELEMENTS // 2
    x, nodes, number = quads(width, ELEMENTS, lambda r, s: plane(np.column_stack([MIDDLE * (1.0 + r), SIDE * s])))
    rim = np.unique(np.concatenate([number[-1], number[:, 0], number[:, -1]]))
    fixed = held(len(x), (rim, "xyzabc"), (number[0], "xbc"))
    whole = plate(dynamics=None, steps=1000, period=0.25)
    return dataclasses.replace(
        whole, x=x, node_ids=np.arange(1, len(x) + 1), fixed=fixed,
        elements=(shell(nodes, THICKNESS, STEEL, density=whole.elements[0].density),),
    )  # fmt: skip


@pytest.mark.slow
def test_a_block_on_half_an_elastic_plate() -> None:
    found = []
    for structure, planes in ((plate(dynamics=None, steps=1000, period=0.25), ()),
                              (half_plate(), (Plane(0, -1, SYMMETRY, MIDDLE),))):  # fmt: skip
        grain = facing(
            structure, gap=0.5, side=6, friction=Coulomb(0.5, 0.4), contact_damping=0.3, relaxation=0.98,
            body_force=(0.0, 0.0, -GRAVITY),
        )  # fmt: skip
        grain.v[:] = 0.0
        if planes:
            beyond = grain.x[:, 0] > MIDDLE
            rows = {name: getattr(grain, name)[beyond] for name in ("x", "v", "mass", "h", "density", "body")}
            grain = dataclasses.replace(grain, planes=planes, **rows)
        coupled = drop(structure, grain, relaxation=0.2)
        for _ in range(200):
            coupled.advance(math.inf, 1)
        centre = int(np.argmin(np.abs(structure.x[:, :2] - MIDDLE).sum(axis=1)))
        arrays = coupled.frame().particles
        places, squeezed = arrays["position"], np.abs(arrays["displacement"]).max()
        places = places[places[:, 0] > MIDDLE]
        places = places[np.lexsort(places.round(3).T)]
        weight = float(grain.mass.sum()) * GRAVITY
        found.append((coupled.history()["structure_force_z"] / weight, coupled.structure.shape.u[centre, 2], places))
    (force, sag, places), (half_force, half_sag, half_places) = found
    assert force == pytest.approx(-1.0, rel=1e-3)
    assert half_force == pytest.approx(force, rel=1e-6)
    assert sag < -1e-6
    assert half_sag == pytest.approx(sag, rel=1e-3)  # the whole's triangles are not mirrored
    assert np.abs(half_places - places).max() < 0.01 * squeezed


SPACING, DENSITY = 0.01, 2650.0


def grain_on(slope: float, *, half: bool, width: int = 8, height: int = 5, rows: int = 8) -> Problem:
    """Grain between smooth planes on a floor that rises by `slope` from x = 0: all of it, or what is beyond x = 0."""
    length, thin = width * SPACING, 0.1 * SPACING
    xs = np.linspace(0.0, length, rows + 1)
    xs = xs if half else np.concatenate([-xs[:0:-1], xs])
    nodes = np.zeros((len(xs), 3))
    nodes[:, 0], nodes[:, 1] = xs, slope * np.abs(xs)
    corners = np.column_stack([np.arange(len(xs) - 1), np.arange(1, len(xs))])
    count = len(corners)
    x = lattice((width, height), (0.0, 0.0), SPACING)
    x[:, 1] += slope * x[:, 0] + thin
    if not half:
        x = np.concatenate([x, x * (-1.0, 1.0, 1.0)])
    n = len(x)
    law = drucker_prager_soil(8.4e5, 0.3, 0.0, 31.0, match="plane_strain")
    return Problem(
        dimension=2, x=x, v=np.zeros_like(x), mass=np.full(n, DENSITY * SPACING**2), h=np.full(n, 1.2 * SPACING),
        density=np.full(n, DENSITY), body=np.zeros(n, np.int64), end_time=1.0, step_factor=0.5, kernel="wendland_c2",
        bodies=(Body(1, "sand", law, DENSITY, linear=1.0, alpha=1.0, least=0.7 * DENSITY),),
        body_force=(0.0, -9.81, 0.0), contact_damping=0.3,
        planes=(Plane(0, 1, SYMMETRY, length), Plane(0, -1, SYMMETRY, 0.0 if half else -length)),
        facets=Facets(nodes, corners, np.full(count, thin), np.zeros(count, bool), Coulomb(0.5, 0.4)),
    )  # fmt: skip


@pytest.mark.parametrize("slope", [-0.5, 0.0, 0.5, 1.0])
def test_a_ridge_a_floor_and_valleys(slope: float) -> None:
    """Though a grain in the valley is nearer to the plane than half its spacing: places and forces as of the whole."""
    found = []
    for half in (False, True):
        solver = Solver(grain_on(slope, half=half), threads=1)
        assert solver.driven is not None
        assert solver.problem.facets is not None
        nodes = solver.problem.facets.nodes
        solver.driven.go(np.zeros_like(nodes))
        solver.advance(0.3, 10**6)
        received = solver.driven.take_impulse()
        beyond = nodes[:, 0] >= 0.0
        forces = received[beyond, 1]
        if not half:
            forces[0] *= 0.5  # the node in the plane bears both sides
        places = solver.frame().particles["position"][: 8 * 5]
        found.append((forces, places))
    assert found[0][0].sum() == pytest.approx(-0.3 * 40 * DENSITY * SPACING**2 * 9.81, rel=0.05)
    assert np.abs(found[1][0] - found[0][0]).max() < 1e-9 * np.abs(found[0][0]).max()
    assert np.abs(found[1][1] - found[0][1]).max() < 1e-9 * SPACING
