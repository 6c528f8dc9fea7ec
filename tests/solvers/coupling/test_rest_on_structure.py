"""Grain asleep on a structure: it weighs on it as before, wakes when it moves, and the books are kept."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from coupled_scenes import DENSITY, SIDE, block, drop, facing, plate

from zrno.solvers import fem
from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.coupling import Coupled
from zrno.solvers.sph import Cures, rest
from zrno.solvers.threads import available

GRAVITY = 0.00981
WEIGHT = 64 * DENSITY * 8.0 * GRAVITY
SLEEP, NEVER = 0.005, 1e-12  # the latter: the same loops, and nobody sleeps but who stands still to round-off
PERIOD = 0.25
SETTLED = 200  # periods


def at_rest(structure: fem.Problem, *, sleep: float = SLEEP, kernel: bool = False, side: int = 4, **changes: Any):
    """A block set down on a plate, damped. kernel: the plate's nodes are particles, neighbours of the block's."""
    given: dict[str, Any] = {"body_force": (0.0, 0.0, -GRAVITY), "sleep": sleep, "relaxation": 0.98, "side": side}
    if kernel:
        grain = block(structure, gap=2.0, potential=False, **given | changes)
    else:
        friction = Coulomb(0.5, 0.4)
        grain = facing(structure, gap=0.5, friction=friction, contact_damping=0.3, **given | changes)
    grain.v[:] = 0.0
    return grain


def rigid(curve: fem.Curve | None = None, way: float = 0.0, *, edge: bool = False, steps: int = 2000) -> fem.Problem:
    """A rigid plate, moved up by `way` times the curve; edge: one edge alone, about the other."""
    structure = dataclasses.replace(plate(steps=steps, period=PERIOD), rigid=True, dynamics=None)
    if curve is None:
        return structure
    fixed = np.zeros_like(structure.fixed)
    moved = np.arange(len(structure.x))
    if edge:
        fixed[structure.x[:, 0] == 0.0, :3] = True
        moved = np.flatnonzero(structure.x[:, 0] == SIDE)
    motion = fem.Motion(moved, np.full(len(moved), 2), np.full(len(moved), way), 0)
    return dataclasses.replace(structure, fixed=fixed, curves=(curve,), motions=(motion,))


def run(coupled: Coupled, periods: int) -> Coupled:
    for _ in range(periods):
        coupled.advance(math.inf, 1)
    return coupled


def middle(structure: fem.Problem) -> int:
    return int(np.argmin(np.abs(structure.x[:, :2] - 0.5 * SIDE).sum(axis=1)))


@pytest.mark.parametrize("kernel", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_sleepers_weigh_on_a_rigid_structure(kernel: bool) -> None:
    coupled = run(drop(rigid(), at_rest(rigid(), kernel=kernel)), 60 if kernel else SETTLED)
    row = coupled.history()
    assert row["asleep"] == 64.0
    assert row["deep"] == (32.0 if kernel else 64.0)  # beside nodes that are particles nobody is
    assert row["kinetic"] == 0.0
    assert row["structure_force_z"] == pytest.approx(-WEIGHT, rel=0.005)
    assert coupled.pending.max() == 0.0
    assert row["interface_energy"] == 0.0
    assert coupled.energy_report()["balance_error"] < 0.005


def test_an_elastic_plate_sags_as_under_grain_that_is_awake() -> None:
    sags, made, seen = [], [], []
    structure = plate(steps=1000, period=PERIOD, dynamics=None)
    for sleep in (NEVER, SLEEP):
        coupled = run(drop(structure, at_rest(structure, sleep=sleep), relaxation=0.2), SETTLED)
        row = coupled.history()
        assert row["structure_force_z"] == pytest.approx(-WEIGHT, rel=0.005)
        sags.append(coupled.structure.shape.u[middle(structure), 2])
        made.append(row["interface_energy"])
        seen.append(row["asleep"])
        for _ in range(5):  # what the particles lose the structure gets, in each period
            before = coupled.pending + coupled.force * PERIOD
            run(coupled, 1)
            assert np.abs(coupled.pending + coupled.force * PERIOD - before).max() < 1e-3 * WEIGHT * PERIOD
    assert seen == [0.0, 64.0]
    assert sags[0] < -1e-6
    assert sags[1] == pytest.approx(sags[0], rel=0.01)
    assert made[1] == pytest.approx(made[0], rel=0.05)


def test_a_swinging_plate_feels_weight_and_no_bed() -> None:
    """With inertia and undamped it goes on swinging under sleepers; their force is the weight within BEARS."""
    structure = plate(steps=1000, period=PERIOD)
    coupled = run(drop(structure, at_rest(structure), tolerance=1e-3), SETTLED)
    force, asleep = [], []
    for _ in range(40):
        run(coupled, 1)
        force.append(-coupled.force[:, 2].sum())
        asleep.append(coupled.history()["asleep"])
    assert np.mean(asleep) > 40.0
    assert np.mean(force) == pytest.approx(WEIGHT, rel=rest.BEARS)
    assert np.ptp(force) < rest.BEARS * WEIGHT


TILTED, SINE = 120, 0.55  # periods, and of the angle
TIMES = np.linspace(0.0, 500.0, 2001)
TILT = fem.Curve(TIMES, np.sin(0.5 * math.pi * np.clip((TIMES - 50.0) / 25.0, 0.0, 1.0)) ** 2)


def test_a_plate_that_tilts_wakes_its_block() -> None:
    """By 33 degrees in 25 ms, under 30 g, so that it turns with it: it slides as the one that never slept."""
    structure = rigid(TILT, SINE * SIDE, edge=True)
    turns: dict[str, Any] = {
        "relaxation": 0.999,
        "cures": Cures(correction=True),
        "body_force": (0.0, 0.0, -30.0 * GRAVITY),
    }
    places, asleep = [], []
    for sleep in (NEVER, SLEEP):
        coupled = run(drop(structure, at_rest(structure, sleep=sleep, **turns)), SETTLED)
        asleep.append(coupled.history()["asleep"])
        places.append([coupled.frame().particles["position"].mean(axis=0)])
        for _ in range(TILTED // 10):
            run(coupled, 10)
            places[-1].append(coupled.frame().particles["position"].mean(axis=0))
        assert coupled.history()["asleep"] == 0.0
        assert coupled.energy_report()["balance_error"] < 0.02
    assert asleep == [0.0, 64.0]
    awake, slept = (np.array(p) for p in places)
    slid = awake[0, 0] - (math.sqrt(1.0 - SINE**2) * awake[-1, 0] + SINE * awake[-1, 2])
    assert slid > 2.0
    assert np.linalg.norm(slept - awake, axis=1).max() < 0.005 * slid


@pytest.mark.parametrize("kernel", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_a_plate_that_goes_from_under_them_lets_them_fall(kernel: bool) -> None:
    """As the door of a wagon: at once 1 mm/ms down. Deep ones follow ring after ring, none is late by 0.1 ms."""
    begins = 15.0 if kernel else 50.0
    gone = fem.Curve(np.array([0.0, begins, begins + 20.0]), np.array([0.0, 0.0, 1.0]))
    structure = rigid(gone, -20.0)
    heights, speeds = [], []
    for sleep in (NEVER, SLEEP):
        coupled = run(
            drop(structure, at_rest(structure, sleep=sleep, kernel=kernel, relaxation=0.99)), int(begins / PERIOD)
        )
        if sleep == SLEEP:
            assert coupled.history()["asleep"] == 64.0
        run(coupled, 20)
        assert coupled.history()["asleep"] == 0.0
        heights.append(coupled.frame().particles["displacement"][:, 2])
        speeds.append(coupled.frame().particles["velocity"][:, 2])
    assert np.abs(heights[1] - heights[0]).max() < 0.1 * np.abs(speeds[0]).max()


def test_restart() -> None:
    """Bit for bit, out of a time when some sleep and some do not, and out of sleep into the tilt."""
    structure = rigid(TILT, SINE * SIDE, edge=True)
    for periods in (70, SETTLED - 3):
        one = run(drop(structure, at_rest(structure)), periods)
        kept = {k: v.copy() if isinstance(v, np.ndarray) else v for k, v in one.checkpoint().items()}
        again = drop(structure, at_rest(structure))
        again.restore(kept)
        for coupled in (one, again):
            run(coupled, 30)
        assert one.history() == again.history()
        for name, values in one.frame().particles.items():
            assert np.array_equal(values, again.frame().particles[name]), name


@pytest.mark.slow
def test_threads() -> None:
    """2197 particles, so that they are shared out, asleep and woken: the same bits by one and two threads."""
    structure = rigid(fem.Curve(np.array([0.0, 30.0, 40.0]), np.array([0.0, 0.0, 1.0])), 2.0, edge=True)
    x = structure.x.copy()
    x[:, :2] = 8.0 + 2.0 * (x[:, :2] - 8.0)
    structure = dataclasses.replace(structure, x=x)
    found = []
    for count in (1, 2):
        coupled = run(drop(structure, at_rest(structure, side=13), threads=count), 110)
        asleep = coupled.history()["asleep"]
        run(coupled, 20)
        found.append((asleep, coupled))
    one, two = (coupled for _, coupled in found)
    assert two.particles.threads == min(2, available())
    assert found[0][0] == found[1][0] > 0.0
    assert one.history() == two.history()
    for name, values in one.frame().particles.items():
        assert np.array_equal(values, two.frame().particles[name]), name
