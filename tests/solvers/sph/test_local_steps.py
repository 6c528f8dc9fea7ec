"""Local time steps: the same answer in fewer steps, momentum, energy, threads, checkpoints; what is held."""

from __future__ import annotations

import dataclasses
import time
from typing import Any

import numpy as np
import pytest
from sph_scenes import lattice

from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.materials import Elastic
from zrno.solvers.neighbours import NeighbourList
from zrno.solvers.sph import Body, Problem, Solver, local, setup
from zrno.solvers.sph.contact import contact_of
from zrno.solvers.sph.critical import critical_step
from zrno.solvers.sph.smoothing import shape_of
from zrno.solvers.sph.state import State

SPACING = 0.01


def elastic(speed: float, density: float, nu: float = 0.3) -> Elastic:
    """Of this speed of compression waves."""
    return Elastic.from_engineering(density * speed**2 * (1 + nu) * (1 - 2 * nu) / (1 - nu), nu)


SAND = Body(1, "sand", elastic(100.0, 1600.0), 1600.0)
STEEL = Body(2, "steel", elastic(5000.0, 7800.0), 7800.0, lagrangian=True)


def on_plate(width: int = 24, height: int = 12, layers: int = 4, **changes: Any) -> Problem:
    """A soft block that falls on a wider elastic plate, both free."""
    sand = lattice((width, height), (0.0, 0.25 * SPACING), SPACING)
    steel = lattice((width + 8, layers), (-4 * SPACING, -layers * SPACING), SPACING)
    x = np.concatenate([sand, steel])
    body = np.repeat([0, 1], [len(sand), len(steel)])
    v = np.zeros_like(x)
    v[body == 0, :2] = 0.3, -0.5
    density = np.where(body == 0, SAND.density, STEEL.density)
    given: dict[str, Any] = {
        "dimension": 2, "x": x, "v": v, "mass": density * SPACING**2, "h": np.full(len(x), 1.2 * SPACING),
        "density": density, "body": body, "bodies": (SAND, STEEL), "end_time": 0.008, "pinball": 1.0,
        "friction": Coulomb(0.5, 0.4), "contact_damping": 0.1, "local_steps": True,
    }  # fmt: skip
    return Problem(**given | changes)


def through(problem: Problem, **options: Any) -> Solver:
    solver = Solver(problem, **options)
    solver.advance(problem.end_time, 10**6)
    assert solver.time == problem.end_time
    return solver


@pytest.fixture(scope="module")
def run() -> Solver:
    return through(on_plate())


def _off(s: Solver, other: Solver, name: str) -> float:
    """RMS difference of a vector of the sand."""
    moved = [one.frame().particles for one in (s, other)]
    off = (moved[0][name] - moved[1][name])[moved[0]["material"] == 1]
    return float(np.sqrt((off**2).sum(axis=1).mean()))


@pytest.mark.slow
def test_the_same_answer_in_the_steps_of_the_sand() -> None:
    """What differs is what the sand's longer step does: of second order without friction, of first order with it.

    So it is on a rigid plate with steps of one length, where friction makes 3.1e-5 of the first number here.
    """
    for rubs, order in ((True, 1), (False, 2)):
        options: dict[str, Any] = {} if rubs else {"friction": None, "contact_damping": 0.0}
        one = through(on_plate(local_steps=False, **options))
        coarse, fine = (through(on_plate(step_factor=f, **options)) for f in (0.8, 0.4))
        assert one.step > 40 * coarse.step
        assert coarse._inner[local.FAST_STEPS] >= one.step
        for name, bound in (("displacement", (0.01 if rubs else 0.001) * 0.58 * 0.008), ("velocity", 0.01 * 0.58)):
            off = _off(coarse, one, name)
            assert off < bound, name
            assert _off(fine, one, name) < 1.4 * 0.5**order * off, name
        first, other = coarse.history(), one.history()
        given = float(0.5 * (on_plate().mass * (on_plate().v ** 2).sum(axis=1)).sum())
        for name in ("kinetic", "internal", "dissipated", "contact_energy", "contact_dissipated"):
            assert abs(first[name] - other[name]) < 0.004 * given, name


def test_momentum_to_the_last_digits_and_energy(run: Solver) -> None:
    p = on_plate()
    mass = float((p.mass * (p.body == 0)).sum())
    given = 0.5 * mass * (0.3**2 + 0.5**2)
    h = run.history()
    assert h["contact_dissipated"] > 0.05 * given  # they rubbed
    assert abs(h["momentum_x"] - 0.3 * mass) < 1e-13 * mass
    assert abs(h["momentum_y"] + 0.5 * mass) < 1e-13 * mass
    assert h["contact_force_y"] == 0.0  # they have parted: the contact stores nothing; what it made is friction's
    assert abs(h["contact_energy"]) < 0.03 * h["contact_dissipated"]
    assert run.energy_report()["balance_error"] < 1e-3


def test_momentum_while_they_press(run: Solver) -> None:
    """What the stiff body has still to be given is in its velocity."""
    solver = Solver(on_plate())
    solver.advance(0.006, 10**6, pause=0.0035)  # not trimmed to a time
    h = solver.history()
    assert h["contact_force_y"] > 1.0
    assert abs(h["momentum_y"] - run.history()["momentum_y"]) < 1e-13 * abs(h["momentum_y"])


def test_threads_and_checkpoints_bit_for_bit() -> None:
    problem = on_plate(60, 34, end_time=0.004)
    assert len(problem.x) > 2000
    one, two = Solver(problem, threads=1), Solver(problem, threads=2)
    for s in (one, two):
        s.advance(0.0025, 10**6)
    other = Solver(problem, threads=1)
    other.restore(two.checkpoint())
    for s in (one, two, other):
        s.advance(0.004, 10**6)
    for s in (two, other):
        assert s.history() == one.history()
        for name, values in s.frame().particles.items():
            assert np.array_equal(values, one.frame().particles[name]), name


def _numbers(problem: Problem) -> Any:
    shape = shape_of(problem.kernel, problem.dimension)
    return setup.numbers_of(problem, contact_of(problem, shape), shape, mirrors=False)


def test_by_itself_only_where_it_is_worth_while() -> None:
    def stiff(problem: Problem) -> Any:
        found = local.classes(problem, _numbers(problem).wave, xsph=False)
        return None if found is None else found.tolist()

    p = on_plate(local_steps=None)
    like = dataclasses.replace(SAND, number=2, law=elastic(300.0, 7800.0), density=7800.0)
    assert stiff(p) == [False, True]
    assert stiff(dataclasses.replace(p, bodies=(SAND, like))) is None
    assert stiff(dataclasses.replace(p, bodies=(SAND, like), local_steps=True)) == [False, True]
    assert stiff(_held(p)) is None  # a rigid wall has no steps of its own
    assert stiff(dataclasses.replace(p, relaxation=0.99)) is None
    with pytest.raises(ValueError, match="do not go together with dynamic relaxation"):
        stiff(dataclasses.replace(p, relaxation=0.99, local_steps=True))
    with pytest.raises(ValueError, match="do not go together with kernel contact"):
        stiff(dataclasses.replace(p, pinball=None, friction=None, local_steps=True))


def test_the_log_says_who_makes_the_step_where_local_steps_cannot_be() -> None:
    def said(**changes: Any) -> str:
        problem = on_plate(local_steps=None, **changes)
        return local.advice(problem, _numbers(problem).wave, xsph=False)

    assert said() == ""  # they can be
    assert said(relaxation=0.99) == (
        ", all in the steps of steel, 50 times what others need: no local steps with dynamic relaxation"
    )
    assert said(relaxation=0.99, bodies=(SAND, dataclasses.replace(SAND, number=2))) == ""


def _held(p: Problem, **steel: Any) -> Problem:
    """With the plate held, its material changed."""
    fixed = np.repeat((p.body == 1)[:, None], 3, axis=1)
    return dataclasses.replace(p, fixed=fixed, bodies=(SAND, dataclasses.replace(STEEL, **steel)))


KINDS = {
    "pinball": ({"lagrangian": False}, {}, 100.0),
    "bearing": ({"lagrangian": False, "bearing": True}, {"pinball": None, "friction": None}, 100.0),
    "kernel contact": ({"lagrangian": False}, {"pinball": None, "friction": None}, 5000.0),
}


@pytest.mark.parametrize("kind", KINDS)
def test_held_steel_limits_the_step_only_by_its_stress(kind: str) -> None:
    """In kernel contact the sand feels the steel's own stress: with the sand's step such a run breaks in its third."""
    steel, options, speed = KINDS[kind]
    p = dataclasses.replace(_held(on_plate(), **steel), v=np.zeros((len(on_plate().x), 3)), **options)
    numbers = _numbers(p)
    contact = contact_of(p, shape_of(p.kernel, 2))
    rows = setup.rows_of(p, contact, p.cures, local=False)
    n = len(p.x)
    state = State(n, 2, rows, packs=(False, False))
    setup.fill(state, p, numbers, rows, shape_of(p.kernel, 2))
    state.rows("nearest")[:] = SPACING**2
    arrays = state.arrays(NeighbourList(n), NeighbourList(n), np.zeros((1, 8)))
    assert critical_step(0, n, None, None, None, numbers, arrays) == pytest.approx(SPACING / speed, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["pinball", "bearing"])
def test_a_held_wall_of_steel_does_not_slow_the_sand(kind: str) -> None:
    steel, options, _ = KINDS[kind]
    p = dataclasses.replace(_held(on_plate(local_steps=False, contact_damping=0.0), **steel), friction=None)
    p = dataclasses.replace(p, **options)
    sand = p.body == 0
    assert p.fixed is not None
    alone = dataclasses.replace(
        p, x=p.x[sand], v=p.v[sand], mass=p.mass[sand], h=p.h[sand], density=p.density[sand], fixed=p.fixed[sand],
        body=p.body[sand], bodies=(SAND,), pinball=None,
    )  # fmt: skip
    assert Solver(p).dt == pytest.approx(Solver(alone).dt, rel=1e-12)


@pytest.mark.slow
def test_a_held_end_does_not_limit_its_body() -> None:
    """Held particles that lie nearer to each other than the others do."""
    x = np.concatenate([lattice((20, 4), (0.0, 0.0), SPACING), lattice((8, 8), (-4 * SPACING, 0.0), 0.5 * SPACING)])
    held = np.arange(len(x)) >= 80
    p = Problem(
        dimension=2, x=x, v=np.zeros_like(x), mass=np.where(held, 0.25, 1.0) * 1600 * SPACING**2,
        h=np.full(len(x), 1.2 * SPACING), density=np.full(len(x), 1600.0), body=np.zeros(len(x), np.int64),
        bodies=(SAND,), end_time=1.0, fixed=np.repeat(held[:, None], 3, axis=1),
    )  # fmt: skip
    nearest = 0.75 * SPACING  # from the last free column to the first held one
    assert Solver(p).dt == pytest.approx(0.8 * np.hypot(nearest, 0.25 * SPACING) / 100.0, rel=1e-9)


@pytest.mark.slow
def test_what_it_saves() -> None:
    """A plate under a block of 1800: the time of the run without local steps, and with, on one thread."""
    seconds = {}
    for steps in (False, True):
        solver = Solver(on_plate(60, 30, friction=None, contact_damping=0.0, local_steps=steps), threads=1)
        start = time.process_time()
        solver.advance(0.008, 10**6)
        seconds[steps] = time.process_time() - start
    assert seconds[False] > 4.0 * seconds[True]
