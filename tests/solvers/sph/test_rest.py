"""Sleeping: grain at rest is held and costs nothing, wakes when it is pushed, and nothing is lost on the way."""

from __future__ import annotations

import dataclasses
import time
from typing import Any

import numpy as np
import pytest

from tests.support.sph_scenes import lattice
from zrno.solvers.materials import drucker_prager_soil
from zrno.solvers.sph import Body, Cures, Problem, Solver, rest, total
from zrno.solvers.sph.ghosts import SYMMETRY, Plane

SPACING = 0.01
DENSITY = 2650.0
NEVER = 1e-12  # a limit that nothing stays under: the same loops, and nobody sleeps
OPENED = 0.35


def column(width: int = 20, height: int = 10, *, gate: bool = True, sleep: float = 0.01, **changes: Any) -> Problem:
    """Grain between smooth walls, damped by its pair viscosity; without the gate it runs off to the right."""
    x = lattice((width, height), (0.0, 0.0), SPACING)
    n = len(x)
    law = drucker_prager_soil(8.4e5, 0.3, 0.0, 31.0, match="plane_strain")
    walls = [Plane(0, -1, SYMMETRY, 0.0), Plane(1, -1, SYMMETRY, 0.0)]
    given: dict[str, Any] = {
        "dimension": 2, "x": x, "v": np.zeros_like(x), "mass": np.full(n, DENSITY * SPACING**2),
        "h": np.full(n, 1.2 * SPACING), "density": np.full(n, DENSITY), "body": np.zeros(n, np.int64),
        "bodies": (Body(1, "sand", law, DENSITY, linear=1.0, alpha=1.0, least=0.7 * DENSITY),), "end_time": 1.0,
        "step_factor": 0.5, "body_force": (0.0, -9.81, 0.0), "kernel": "wendland_c2", "sleep": sleep,
        "planes": (*walls, Plane(0, 1, SYMMETRY, width * SPACING)) if gate else tuple(walls),
    }  # fmt: skip
    return Problem(**given | changes)


def at(solver: Solver, when: float) -> Solver:
    solver.advance(when, 10**6)
    assert solver.time == when
    return solver


def opened(settled: Solver, when: float, threads: int = 1, **changes: Any) -> Solver:
    """The same grain, its gate gone."""
    width, height = (round(float(v)) for v in np.ptp(settled.problem.x[:, :2], axis=0) / SPACING + 1.0)
    solver = Solver(column(width, height, gate=False, **changes), threads=threads)
    solver.restore(settled.checkpoint())
    return at(solver, when)


@pytest.fixture(scope="module")
def settled() -> Solver:
    solver = at(Solver(column(), threads=1), OPENED)
    solver.advance(1.0, (rest.LOOK - 1 - solver.step) % rest.LOOK)  # the next step looks at all sleepers
    return solver


def test_a_column_falls_asleep_under_its_weight(settled: Solver) -> None:
    row = settled.history()
    assert row["asleep"] == row["deep"] == settled.n
    assert row["kinetic"] == 0.0
    awake = at(Solver(column(sleep=NEVER), threads=1), settled.time).frame().particles
    asleep = settled.frame().particles
    assert np.abs(asleep["stress"] - awake["stress"]).max() < 0.02 * DENSITY * 9.81 * 0.1
    assert np.abs(asleep["position"] - awake["position"]).max() < 1e-3 * SPACING
    assert settled.energy_report()["balance_error"] < 2e-3


@pytest.mark.slow
def test_nobody_sleeps_before_gravity_is_what_it_will_be() -> None:
    """Set on in full and again altered at the end of a table, with time to fall asleep before that and after it."""
    gravity = np.array([(0.0, -9.81, 0.0), (0.0, -9.81, 0.0), (0.0, -9.80, 0.0)])
    curve = np.array([0.0, OPENED, OPENED + 0.01]), gravity
    solver = at(Solver(column(body_curve=curve), threads=1), OPENED + 0.01)
    assert solver.history()["asleep"] == 0.0
    at(solver, OPENED + 0.1)
    assert solver.history()["asleep"] == solver.n
    assert solver.energy_report()["balance_error"] < 2e-3


def test_sleepers_do_not_move(settled: Solver) -> None:
    before = {name: np.array(values) for name, values in settled.frame().particles.items()}
    later = Solver(column(), threads=1)
    later.restore(settled.checkpoint())
    at(later, 2 * OPENED)
    assert all(np.array_equal(values, later.frame().particles[name]) for name, values in before.items())


def test_a_gate_that_opens_wakes_them(settled: Solver) -> None:
    """The centre of mass as without sleeping but for 2 milliseconds: what wakes has been pushed."""
    when = settled.time + 0.1
    slept = opened(settled, when)
    woken = settled.checkpoint()
    woken["still"] = np.zeros_like(woken["still"])
    free = Solver(column(gate=False, sleep=NEVER), threads=1)
    free.restore(woken)
    at(free, when)
    assert slept.history()["asleep"] == free.history()["asleep"] == 0.0
    places = [s.frame().particles["position"].mean(axis=0) for s in (settled, slept, free)]
    way = np.linalg.norm(places[2] - places[0])
    speed = np.linalg.norm(free.frame().particles["velocity"].mean(axis=0))
    assert way > 0.5 * SPACING
    assert np.linalg.norm(places[1] - places[2]) < 0.002 * speed
    assert slept.energy_report()["balance_error"] < 5e-3


def test_motion_that_ends_is_dissipated() -> None:
    """With a high limit much falls asleep in motion: the balance over each step is that of any other step."""
    solver = Solver(column(sleep=0.5), threads=1)
    lost, off = 0.0, []
    for _ in range(800):
        before, asleep = solver.energies(), solver.history()["asleep"]
        solver.advance(1.0, 1)
        after = solver.energies()
        if solver.history()["asleep"] > asleep:
            lost += before["kinetic"] - after["kinetic"]
            off.append(total(after) - total(before))
    assert lost > 1e-6
    assert abs(sum(off)) < 1e-3 * lost


def test_threads_and_restart() -> None:
    """Bit for bit, with some asleep, some not: 2160 particles, the fewest that take two threads."""
    runs = [at(Solver(column(216, 10), threads=threads), 0.18) for threads in (1, 2)]
    first, second = (run.frame().particles for run in runs)
    assert 0.0 < runs[0].history()["deep"] < runs[0].history()["asleep"] < runs[0].n
    assert all(np.array_equal(first[name], second[name]) for name in first)
    again = Solver(column(216, 10), threads=1)
    again.restore(runs[1].checkpoint())
    ends = [at(run, 0.19).frame().particles for run in (runs[0], again)]
    assert all(np.array_equal(ends[0][name], ends[1][name]) for name in first)


@pytest.mark.parametrize(
    "changes",
    [
        {"body_force": (0.0, 0.0, 0.0)},
        {"h_option": 1},
        {"cures": Cures(xsph=0.1)},
        {"local_steps": True},
        {"original": True},
    ],
)
def test_what_it_does_not_go_with(changes: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="cannot sleep"):
        rest.resting(column(**changes), np.array([20.0]))


def test_a_lasting_push_wakes_and_a_swinging_one_does_not() -> None:
    """By the rule itself: push' = a - push/tau, with tau g BEARS the limit."""
    limits = rest.resting(column(), np.array([20.0]))
    assert limits is not None
    assert limits.speed == pytest.approx(limits.memory * rest.BEARS * 9.81)

    class Arrays:
        pass

    solver = Solver(column(2, 2), threads=1)
    arrays = solver._arrays()
    dt = limits.memory / 50.0
    for strength, swings, wakes in ((0.9, False, False), (1.1, False, True), (5.0, True, False)):
        arrays.still[:] = rest.HELD
        arrays.push[:] = 0.0
        woken = 0.0
        for k in range(500):
            arrays.ax[:] = strength * rest.BEARS * 9.81 * (-1.0 if swings and k % 4 > 1 else 1.0)
            arrays.ay[:] = 0.0
            woken = max(woken, rest.wake(0, 4, 4, None, None, limits, None, 4, None, None, False, dt, arrays))
        assert (woken > 0.0) == wakes


@pytest.mark.slow
def test_what_it_saves() -> None:
    """A column asleep costs a fifth of one that is awake, at most; off is the same to rounding."""

    def spent(solver: Solver) -> float:
        at(solver, OPENED)
        began, steps = time.process_time(), solver.step
        at(solver, OPENED + 0.2)
        return (time.process_time() - began) / (solver.step - steps)

    awake, asleep = (Solver(column(100, 10, sleep=sleep), threads=1) for sleep in (NEVER, 0.02))
    assert spent(asleep) < 0.2 * spent(awake)
    off = Solver(dataclasses.replace(column(100, 10), sleep=0.0), threads=1)
    at(off, OPENED + 0.2)
    ends = [s.frame().particles for s in (off, awake)]
    assert all(np.allclose(ends[0][name], ends[1][name], rtol=1e-6, atol=1e-9) for name in ("position", "density"))
