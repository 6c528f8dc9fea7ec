"""Boundary planes, body forces in time, smoothing lengths that change, dynamic relaxation."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from sph_scenes import finished, impact, jittered, lattice, one_body, periodic

from zrno.solvers.errors import Diverged
from zrno.solvers.materials import Elastic
from zrno.solvers.sph import Cures, Plane, Problem, Solver
from zrno.solvers.sph.ghosts import LIMIT, PERIODIC, SYMMETRY

_SOFT = Elastic.from_engineering(1e-3, 0.3)


@pytest.mark.parametrize(
    ("cures", "dimension"),
    [
        (Cures(), 2),
        (Cures(correction=True), 3),
        *(pytest.param(c, d, marks=pytest.mark.slow) for c, d in (
            (Cures(), 1), (Cures(), 3), (Cures(correction=True), 1), (Cures(correction=True), 2),
        )),
    ],
)  # fmt: skip
def test_half_a_model_behind_a_symmetry_plane_is_the_whole_one(dimension: int, cures: Cures) -> None:
    whole = impact(dimension, cures=cures)
    one = dataclasses.replace(whole, body=np.zeros_like(whole.body), bodies=whole.bodies[:1])
    right = whole.x[:, 0] > 0.0
    half = dataclasses.replace(
        one, x=one.x[right], v=one.v[right], mass=one.mass[right], h=one.h[right], density=one.density[right],
        body=one.body[right], planes=(Plane(0, -1, SYMMETRY, 0.0),),
    )  # fmt: skip
    a, b = finished(one, 2.0).frame().particles, finished(half, 2.0).frame().particles
    assert np.allclose(a["position"][right], b["position"], atol=1e-12)
    assert np.allclose(a["stress"][right], b["stress"], atol=1e-12)


def test_a_corner_of_symmetry_planes_is_a_quarter_of_a_body() -> None:
    x = lattice((8, 8), (-0.4, -0.4))
    v = -0.02 * x
    quarter = (x[:, 0] > 0.0) & (x[:, 1] > 0.0)
    planes = (Plane(0, -1, SYMMETRY, 0.0), Plane(1, -1, SYMMETRY, 0.0))
    a = finished(one_body(x, v), 3.0).frame().particles
    b = finished(one_body(x[quarter], v[quarter], planes=planes), 3.0).frame().particles
    assert np.allclose(a["position"][quarter], b["position"], atol=1e-12)
    assert np.allclose(a["stress"][quarter], b["stress"], atol=1e-12)


def test_a_periodic_body_does_not_care_where_the_box_begins() -> None:
    x = jittered((10, 10), 0.1)
    v = np.zeros_like(x)
    v[:, 0] = 0.05 + 0.01 * np.sin(2.0 * np.pi * x[:, 1])
    moved = x.copy()
    moved[:, :2] = (moved[:, :2] + [0.33, 0.71]) % 1.0
    a, b = (finished(one_body(y, v, planes=periodic(1.0, 1.0)), 8.0) for y in (x, moved))
    assert a.builds > 1
    p, q = a.frame().particles, b.frame().particles
    shift = q["position"] - p["position"] - [0.33, 0.71, 0.0]
    assert np.allclose(shift - np.round(shift), 0.0, atol=1e-9)
    assert np.allclose(p["stress"], q["stress"], atol=1e-9)
    assert np.allclose(p["displacement"], q["displacement"], atol=1e-9)


def test_a_periodic_plane_needs_its_opposite() -> None:
    with pytest.raises(ValueError, match="a periodic plane across x needs its opposite"):
        one_body(lattice((4, 4), (0.0, 0.0)), planes=(Plane(0, -1, PERIODIC, 0.0),))


def test_particles_beyond_a_limit_plane_leave_the_problem() -> None:
    x = lattice((4, 4), (0.0, 0.0))
    v = np.zeros_like(x)
    v[x[:, 0] > 0.2, 0] = 0.5
    x[x[:, 0] > 0.2, 0] += 1.0
    solver = finished(one_body(x, v, planes=(Plane(0, 1, LIMIT, 2.0),)), 4.0)
    assert solver.live == 8
    assert solver.history()["active"] == 8.0
    assert len(solver.frame().particles["id"]) == 8
    assert solver.energy_report()["balance_error"] < 1e-12
    v[:, 0] += 0.5
    with pytest.raises(Diverged, match="all particles have left"):
        finished(one_body(x, v, planes=(Plane(0, 1, LIMIT, 2.0),)), 40.0)


def shelf(**options: object) -> Problem:
    """A block above the edge of one that is held; it tears off, and what falls leaves the run."""
    blocks = impact(2, speed=0.0)
    above = blocks.body == 0
    x = blocks.x + np.where(above, 1.0, 0.0)[:, None] * [1.05, 0.6, 0.0]
    held = np.repeat(~above[:, None], 3, axis=1)
    planes = (Plane(1, -1, LIMIT, -1.5),)
    return dataclasses.replace(blocks, x=x, fixed=held, body_force=(0.0, -0.04, 0.0), planes=planes, **options)


def test_the_balance_is_of_what_was_handled_not_of_what_is_left() -> None:
    """The errors of what has left stay: they are more than the energies of the particle that still lies there."""
    p = shelf()
    solver = Solver(p)
    for k in range(9):  # it looks whether energy is made out of nothing at the end of each
        solver.advance(2.0 * (k + 1), 10**6)
    assert solver.live < 40
    report = solver.energy_report()
    made = abs(report["final"] - report["initial"] - report["external_work"])
    assert made > 3.0 * report["external_work"]
    assert report["balance_error"] < 0.05
    again = Solver(p)
    again.restore(solver.checkpoint())
    assert again.energy_report() == report


def falling(**options: object) -> Solver:
    return finished(one_body(lattice((4, 4), (0.0, 0.0)), **options), 2.0)  # type: ignore[arg-type]


def test_a_body_force_by_curve() -> None:
    """Constant it is that of the deck; a ramp gives the speed and the work that its integral says."""
    table = (np.array([0.0, 2.0]), np.array([[0.0, -0.02, 0.0]] * 2))
    deck, curve = falling(body_force=(0.0, -0.02, 0.0)), falling(body_curve=table)
    assert np.array_equal(deck.frame().particles["position"], curve.frame().particles["position"])
    assert curve.energy_report()["external_work"] == pytest.approx(deck.energy_report()["external_work"], rel=1e-12)
    ramp = falling(body_curve=(np.array([0.0, 1.0]), np.array([[0.0, 0.0, 0.0], [0.04, 0.0, 0.0]])), step_factor=0.1)
    assert ramp.frame().particles["velocity"][:, 0] == pytest.approx(0.02 + 0.04, rel=2e-3)
    assert ramp.energy_report()["balance_error"] < 1e-3


def squeezed(option: int) -> tuple[np.ndarray, np.ndarray]:
    x = lattice((8, 8), (-0.4, -0.4))
    v = -0.3 * x
    solver = finished(one_body(x, v, h_option=option, step_factor=0.2), 0.5)
    return np.array(solver._state.rows("h")[0, : solver.n]), np.array(solver._state.rows("density")[0, : solver.n])


def test_smoothing_lengths_follow_the_density() -> None:
    h, _ = squeezed(0)
    assert np.all(h == 0.12)
    h, rho = squeezed(2)
    assert rho.max() > 1.08
    assert np.allclose(h, 0.12 * rho**-0.5, rtol=6e-3)  # one step behind
    h, rho = squeezed(1)
    assert np.allclose(h, 0.12 * rho**-0.5, rtol=6e-3)


def test_a_body_that_grows_threefold_keeps_its_neighbours() -> None:
    """The list follows h: a run with a far larger list gives the same result."""

    def grown(skin: float) -> dict[str, np.ndarray]:
        x = lattice((6, 6), (-0.3, -0.3))
        problem: Problem = one_body(x, 1.0 * x, h_option=2, body={"least": 1e-3}, law=_SOFT, step_factor=0.3)
        solver = finished(problem, 1.0, skin=skin)
        return solver.frame().particles

    a, b = grown(0.25), grown(3.0)
    assert a["density"].min() < 0.4
    assert np.allclose(a["position"], b["position"], atol=1e-10)


def test_dynamic_relaxation_takes_motion_out() -> None:
    x = lattice((6, 6), (-0.3, -0.3))
    free, relaxed = (finished(one_body(x, -0.02 * x, relaxation=r), 20.0) for r in (1.0, 0.95))
    assert relaxed.energy_report()["kinetic"] < 1e-5 * free.energy_report()["kinetic"]
    assert free.history()["relaxation_dissipated"] == 0.0
    start, given = relaxed.energy_report(), relaxed.history()["relaxation_dissipated"]
    assert given > 0.5 * start["initial"]
    assert start["balance_error"] < 1e-3


@pytest.mark.parametrize("gravity", [0.0, -1e-3])
def test_what_relaxation_takes_of_free_particles_is_known(gravity: float) -> None:
    """Of a velocity alone 1 - r^2 in each step; falling particles end where it takes what the weight does."""
    x = lattice((3, 2), (0.0, 0.0), spacing=1.0)
    solver = Solver(one_body(x, 0.01 * np.eye(3)[[0] * 6], relaxation=0.99, body_force=(0.0, gravity, 0.0)))
    start = solver.history()["kinetic"]
    for _ in range(7):
        solver.advance(1e9, 40)
        row = solver.history()
        if not gravity:
            assert row["kinetic"] == pytest.approx(start * 0.99 ** (2 * solver.step), rel=1e-12)
        spent = row["relaxation_dissipated"]
        assert spent == pytest.approx(start - row["kinetic"] + row["external_work"], rel=1e-12)
        assert spent > 0.0


def test_transducers_and_traced_particles_are_in_the_history() -> None:
    """A transducer in a linear pressure field reads it; a trace is what the frame says."""
    x = lattice((10, 10), (0.0, 0.0))
    stress = np.zeros((len(x), 6))
    stress[:, :3] = -(1.0 - x[:, 1:2])
    problem = one_body(
        x, stress=stress, fixed=np.ones((len(x), 3), bool), traced=(7, 93),
        transducers=((0.5, 0.5, 0.0, 0), (0.33, 0.71, 0.0, 0), (9.0, 9.0, 0.0, 0)),
    )  # fmt: skip
    solver = finished(problem, 0.05)
    row, p = solver.history(), solver.frame().particles
    assert row["pressure_1"] == pytest.approx(0.5, abs=1e-3)
    assert row["pressure_2"] == pytest.approx(0.29, abs=1e-2)
    assert row["pressure_3"] == 0.0
    for number in (7, 93):
        assert row[f"particle_{number}_x"] == p["position"][number - 1, 0]
        assert row[f"particle_{number}_velocity_y"] == p["velocity"][number - 1, 1]
        assert row[f"particle_{number}_pressure"] == pytest.approx(p["pressure"][number - 1], rel=1e-14)


def test_a_symmetry_plane_throws_a_lonely_particle_back() -> None:
    x = np.array([[0.5, 0.3, 0.0]])
    v = np.array([[-0.5, -0.2, 0.0]])
    planes = (Plane(0, -1, SYMMETRY, 0.0), Plane(1, -1, SYMMETRY, 0.0), Plane(0, 1, SYMMETRY, 1.0))
    soft = one_body(x, v, planes=planes, law=_SOFT, step_option=1)
    solver = Solver(soft)
    places = []
    for until in np.arange(0.2, 4.1, 0.2):
        solver.advance(float(until), 10**6)
        places.append(solver.frame().particles["position"][0])
    assert np.min(places) >= 0.0
    assert np.max(places) <= 1.0
    assert solver.frame().particles["velocity"][0] == pytest.approx([-0.5, 0.2, 0.0], abs=0.06)
