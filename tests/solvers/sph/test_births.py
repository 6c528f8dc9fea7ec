"""Particles that are born later: on their way they are not there, then they are as if the run began with them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from sph_scenes import impact, lattice, one_body

from zrno.solvers.sph import Plane, Problem, Solver
from zrno.solvers.sph.ghosts import LIMIT

SPEED = 0.4
WAY = 0.8
GRAVITY = (0.0, -0.05, 0.0)


def two_blocks(**changes: object) -> Problem:
    """A block at rest, and one that comes from afar, row by row through a plane."""
    x = np.concatenate([lattice((4, 4), (0.0, 0.0)), lattice((4, 4), (2.0 - WAY, 0.0))])
    v = np.zeros_like(x)
    v[16:, 0] = SPEED
    birth = np.zeros(32)
    birth[16:] = (2.0 - x[16:, 0]) / SPEED
    return dataclasses.replace(one_body(x, v, birth=birth, body_force=GRAVITY), **changes)  # type: ignore[arg-type]


def test_a_block_in_flight_is_born_row_by_row() -> None:
    """Each row goes straight on, then falls: its place and velocity by the formula of a throw from its birth on."""
    p = two_blocks()
    assert p.birth is not None
    solver = Solver(p)
    seen = []
    for until in (0.5, 1.0, 1.5, 1.8, 2.5, 4.0):
        solver.advance(until, 10**6)
        there = solver.frame().particles
        assert np.array_equal(there["id"], np.flatnonzero(p.birth <= until) + 1)
        seen.append(len(there["id"]))
        assert solver.history()["active"] == seen[-1]
        mass = 0.01 * seen[-1]
        assert there["mass"].sum() == pytest.approx(mass)
        assert solver.history()["momentum_x"] == pytest.approx(0.01 * SPEED * (seen[-1] - 16), abs=1e-12)
        assert solver.energy_report()["balance_error"] < 1e-3
    assert seen[0] == 16
    assert seen[-1] == 32
    assert len(set(seen)) > 2
    last = there["id"] > 16
    fallen = np.mean(-0.025 * (4.0 - p.birth[16:]) ** 2)
    assert there["position"][last, 0].mean() == pytest.approx(p.x[16:, 0].mean() + SPEED * 4.0, abs=1e-9)
    assert there["position"][last, 1].mean() - 0.2 == pytest.approx(fallen, rel=0.02)


def test_what_is_born_in_one_instant_is_as_if_it_had_been_there() -> None:
    """A block of its own, born whole far from everything: at rest in itself, without stress, to the last digits."""
    p = two_blocks(body_force=(0.0, 0.0, 0.0))
    assert p.birth is not None
    solver = Solver(dataclasses.replace(p, birth=np.where(p.birth > 0.0, 1.3, 0.0)))
    solver.advance(3.0, 10**6)
    there = solver.frame().particles
    assert np.abs(there["position"] - p.x - 3.0 * p.v).max() < 1e-12
    assert np.abs(there["stress"]).max() < 1e-12
    assert solver.history()["absent_energy"] == 0.0


def test_before_it_is_born_nothing_feels_it() -> None:
    """It flies through another block, which stays as it is to the bit."""
    x = np.concatenate([lattice((4, 4), (0.0, 0.0)), lattice((4, 4), (-1.0, 0.0))])
    v = np.zeros_like(x)
    v[16:, 0] = 1.0
    solver = Solver(one_body(x, v, birth=np.repeat([0.0, 3.0], 16)))
    solver.advance(2.9, 10**6)
    assert solver.live == 16
    assert np.array_equal(solver.frame().particles["position"], x[:16])
    assert solver.history()["kinetic"] == 0.0
    assert solver.history()["absent_energy"] == pytest.approx(0.5 * 16 * 0.01)


def test_birth_impact_death_and_restart() -> None:
    """A block is born, hits another, and what passes the limit dies: the balance holds, and a restart is exact."""
    blocks = impact(2, 6, speed=0.05)
    born = np.where(blocks.body == 0, 0.5, 0.0)
    p = dataclasses.replace(
        blocks, x=blocks.x - np.where(blocks.body == 0, 0.3, 0.0)[:, None] * [1, 0, 0], birth=born,
        planes=(Plane(0, 1, LIMIT, 0.7),),
    )  # fmt: skip
    solver = Solver(p, threads=1)
    solver.advance(0.4, 10**6)
    assert solver.live == 36
    again = Solver(p, threads=1)
    again.restore(solver.checkpoint())
    off = []
    for until, live in ((11.0, 72), (12.0, 66)):
        for one in (solver, again):
            one.advance(until, 10**6)
        assert solver.live == live
        off.append(solver.energy_report()["balance_error"])
    assert off[0] < 0.03  # of the impact itself, see test_hard_cases
    assert abs(off[1] - off[0]) < 0.01
    a, b = (one.frame().particles for one in (solver, again))
    assert all(np.array_equal(a[name], b[name]) for name in a)


@pytest.mark.parametrize(
    ("birth", "message"),
    [
        (np.ones(32), "all particles are born later"),
        (np.zeros(3), "every particle needs a time of birth"),
        (np.full(32, -1.0), "every particle needs a time of birth"),
    ],
)
def test_births_that_cannot_be(birth: np.ndarray, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        two_blocks(birth=birth)
