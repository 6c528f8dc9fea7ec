"""Cures of the method's known defects: each does what it is for, and the defect is there without it."""

from __future__ import annotations

import dataclasses
import itertools
from typing import Any

import numpy as np
import pytest
from sph_scenes import ELASTIC, finished, impact, jittered, lattice, one_body, periodic, smoothed_velocities

from zrno.solvers.materials import Elastic
from zrno.solvers.sph import Cures, Plane, Problem, Solver, bearing, packed, pairs, particle
from zrno.solvers.sph.ghosts import SYMMETRY
from zrno.solvers.sph.smoothing import value_at
from zrno.solvers.sph.step import INSTANT
from zrno.solvers.threads import meeting

NOBODY = meeting(1)  # to wait for


def gradients(problem: Problem, slope: np.ndarray) -> np.ndarray:
    """(n, d, d) gradients that the loop finds of the linear velocity field slope x."""
    solver = Solver(problem, threads=1)
    a, numbers, n, d = solver._arrays(), solver._numbers, solver.n, problem.dimension
    x = solver._state.rows("x")[:d, :n]
    solver._state.rows("u")[:d, :n] = slope @ x
    solid = True if d == 3 else None
    packed.pack_motion(0, 1, NOBODY, 0, solid, None, None, True, a)
    pairs.velocity_gradient(
        0, n, a.first, a.count, a.rows, solver._shape, a.packed, a.near[0, 0], solid, None,
        numbers.inverse_h2, numbers.scale, None, a.gradient, a.correction if problem.cures.correction else None,
        numbers.corrected, a.material,
    )  # fmt: skip
    return np.array(a.gradient[:, :n].T.reshape(n, d, d))


@pytest.mark.parametrize("shape", [(9, 9), (5, 5, 5)])
def test_corrected_gradients_of_linear_fields_are_exact_in_disorder_and_at_free_surfaces(
    shape: tuple[int, ...],
) -> None:
    d = len(shape)
    slope = np.random.default_rng(1).normal(size=(d, d))
    x = jittered(shape)
    plain = gradients(one_body(x, dimension=d), slope) - slope
    exact = gradients(one_body(x, dimension=d, cures=Cures(correction=True)), slope) - slope
    assert np.abs(plain).max() > 0.3
    assert np.abs(exact).max() < 1e-12 * np.abs(slope).max() * 10


def test_the_correction_of_a_particle_that_sees_two_others_from_afar_is_bounded() -> None:
    """Its shape matrix is small but well conditioned; the whole inverse multiplied velocities by thousands."""
    x = np.array([[0.0, 0.0, 0.0], [0.23, 0.0, 0.0], [0.0, 0.23, 0.0]])
    problem = one_body(x, cures=Cures(correction=True))
    seen = gradients(problem, np.eye(2))
    assert 0.01 < seen[0, 0, 0] < 0.5  # far from exact, and no harm
    solver = Solver(problem, threads=1)
    a = solver._arrays()
    packed.pack_motion(0, 1, NOBODY, 0, None, None, None, True, a)
    pairs.velocity_gradient(
        0, 3, a.first, a.count, a.rows, solver._shape, a.packed, a.near[0, 0], None, None,
        solver._numbers.inverse_h2, solver._numbers.scale, None, a.gradient, a.correction,
        solver._numbers.corrected, a.material,
    )  # fmt: skip
    assert np.abs(a.correction[:3, :3]).max() < 1.0 / pairs.SEEN


def turned(problem: Problem, turns: int, steps: int, start: tuple[float, ...]) -> np.ndarray:
    """(4, n) stresses of a body whose particles are led round in circles, from a uniform stress xx yy zz xy on."""
    solver = Solver(problem, threads=1)
    s, n = solver._state, solver.n
    s.rows("stress")[:, :n] = np.array(start)[:, None]
    x0 = s.rows("x")[:, :n] - s.rows("x")[:, :n].mean(axis=1)[:, None]
    angles = np.linspace(0.0, 2.0 * np.pi * turns, steps + 1)
    a, numbers = solver._arrays(), solver._numbers
    correction = a.correction if problem.cures.correction else None
    for before, after in itertools.pairwise(angles):
        old, new = (np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]]) @ x0 for t in (before, after))
        s.rows("x_half")[:, :n] = 0.5 * (old + new)
        s.rows("u")[:, :n] = new - old
        packed.pack_motion(0, 1, NOBODY, 0, None, None, None, True, a)
        pairs.velocity_gradient(
            0, n, a.first, a.count, a.rows, solver._shape, a.packed, a.near[0, 0], None, None, numbers.inverse_h2,
            numbers.scale, None, a.gradient, correction,
            numbers.corrected, a.material,
        )  # fmt: skip
        particle.constitutive(
            0, n, None, 0, ELASTIC, 1.0, correction, None, None, None, None, None, a, numbers
        )  # fmt: skip
        s.rows("density")[:, :n] = 1.0
    return s.rows("stress")[:, :n].copy()


def test_ten_turns_leave_no_stress_with_the_correction() -> None:
    """The reference list is that of the start: its neighbours stay the same as the body turns."""
    x = jittered((7, 7))
    corrected = one_body(x, cures=Cures(correction=True))
    stress = turned(corrected, 10, 3000, (0.0, 0.0, 0.0, 0.0))
    assert np.abs(stress).max() < 1e-6 * (ELASTIC.lame + 2.0 * ELASTIC.shear / 3.0)
    kept = turned(corrected, 10, 3000, (0.3, -0.1, 0.05, 0.2))
    assert np.allclose(kept, np.array([0.3, -0.1, 0.05, 0.2])[:, None], atol=1e-6)
    wrong = turned(one_body(x), 1, 300, (0.0, 0.0, 0.0, 0.0))
    assert np.abs(wrong).max() > 0.1


@pytest.mark.parametrize(
    ("cures", "dimension"),
    [
        (Cures(correction=True), 2),
        (Cures(True, 0.3, 0.2), 3),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in (
            (Cures(correction=True), 3), (Cures(artificial_stress=0.3), 2), (Cures(artificial_stress=0.3), 3),
            (Cures(True, 0.3, 0.2), 2),
        )),
    ],
)  # fmt: skip
def test_cures_keep_momentum_and_energy(dimension: int, cures: Cures) -> None:
    solver = finished(impact(dimension, step_factor=0.2, cures=cures), 2.0)
    row = solver.history()
    one = 0.01 * 6**dimension * 0.1**dimension
    for axis in "xyz":
        assert abs(row[f"momentum_{axis}"]) < 1e-12 * one
    assert solver.energy_report()["balance_error"] < 4e-3


def spinning(cures: Cures) -> float:
    """Relative change of the angular momentum of a disk of grains that turns half round."""
    x = lattice((12, 12), (-0.6, -0.6))
    x = x[np.hypot(x[:, 0], x[:, 1]) < 0.55]
    rate = 0.02
    v = np.stack([-rate * x[:, 1], rate * x[:, 0], 0.0 * x[:, 0]], axis=1)
    solver = finished(one_body(x, v, cures=cures), np.pi / rate)
    p = solver.frame().particles
    now = np.sum(p["position"][:, 0] * p["velocity"][:, 1] - p["position"][:, 1] * p["velocity"][:, 0])
    before = rate * np.sum(x[:, 0] ** 2 + x[:, 1] ** 2)
    return float(now / before - 1.0)


def test_a_disk_that_spins_keeps_its_angular_momentum_by_the_correction_alone() -> None:
    """Plain gradients see half of a turn at a free surface and strain it: the disk swings back within half a turn."""
    assert abs(spinning(Cures(correction=True))) < 1e-3
    assert abs(spinning(Cures())) > 0.5


def drift_of_spin(amount: float, law: Any, cures: Cures) -> float:
    """Relative change of the angular momentum of a shaken block of 8 x 8 that spins at 0.05 for 8.

    amount: by which its particles stand off their lattice, of the spacing.
    """
    x = jittered((8, 8), amount)
    x[:, :2] -= x[:, :2].mean(axis=0)
    v = np.zeros_like(x)
    v[:, 0], v[:, 1] = -0.05 * x[:, 1], 0.05 * x[:, 0]
    v[:, :2] += 0.01 * np.random.default_rng(2).uniform(-1.0, 1.0, (len(x), 2))

    def moment(solver: Solver) -> float:
        p = solver.frame().particles
        (px, py, _), (vx, vy, _) = p["position"].T, p["velocity"].T
        return float(np.sum(p["mass"] * (px * vy - py * vx)))

    problem = one_body(x, v, law=law, cures=cures)
    return moment(finished(problem, 8.0)) / moment(Solver(problem)) - 1.0


@pytest.mark.parametrize("stress", [0.0, 0.3])
def test_angular_momentum_of_isotropic_stress_is_exact(stress: float) -> None:
    """Pressure, its viscosity and the artificial stress act along the pair; only stress that is not isotropic turns."""
    cures = Cures(artificial_stress=stress)
    assert abs(drift_of_spin(0.2, Elastic(1.0, 0.0), cures)) < 1e-12
    assert abs(drift_of_spin(0.2, ELASTIC, cures)) > 1e-3  # of a solid: the table says how much, and what cures it


@pytest.mark.parametrize("amount", [0.0, 0.2])
def test_the_correction_keeps_the_angular_momentum_of_a_solid(amount: float) -> None:
    assert abs(drift_of_spin(amount, ELASTIC, Cures(correction=True))) < 1e-3


def pulled_lattice(cures: Cures, until: float = 5.0) -> tuple[float, float]:
    """A periodic lattice under uniform tension, slightly disturbed: nearest distance in spacings, kinetic energy."""
    n = 12
    x = lattice((n, n), (0.0, 0.0))
    v = np.zeros_like(x)
    v[:, :2] = 1e-4 * np.random.default_rng(5).uniform(-1.0, 1.0, (len(x), 2))
    stress = np.tile([0.1, 0.1, 0.1, 0.0, 0.0, 0.0], (len(x), 1))
    energy = np.full(len(x), 0.01)  # about what it takes to stretch the body so
    problem = one_body(x, v, planes=periodic(0.1 * n, 0.1 * n), cures=cures, stress=stress, energy=energy)
    solver = finished(problem, until)
    p = solver.frame().particles["position"][:, :2]
    d = p[:, None] - p[None]
    d -= 0.1 * n * np.round(d / (0.1 * n))
    r = np.hypot(d[..., 0], d[..., 1]) + 10.0 * np.eye(len(p))
    return float(r.min() / 0.1), solver.energy_report()["kinetic"]


def test_artificial_stress_stops_the_tension_instability() -> None:
    """Under tension the plain method's particles pair off (W'' sigma > 0, Swegle et al. 1995)."""
    without, _ = pulled_lattice(Cures())
    cured, _ = pulled_lattice(Cures(artificial_stress=0.3))
    assert without < 0.5
    assert cured > 0.95


def noisy_fluid(**body: float) -> tuple[float, float]:
    """Density noise of a periodic body at rest, before and after a while."""
    n = 12
    x = lattice((n, n), (0.0, 0.0))
    noise = 1.0 + 0.01 * np.random.default_rng(7).uniform(-1.0, 1.0, len(x))
    problem = one_body(x, density=noise, planes=periodic(1.2, 1.2), body=body)
    solver = finished(problem, 2.0)
    return float(np.std(noise)), float(np.std(solver.frame().particles["density"]))


def test_density_diffusion_smooths_noise_and_nothing_does_without_it() -> None:
    before, after = noisy_fluid()
    assert after == pytest.approx(before, rel=1e-12)  # an elastic solid without an equation of state does not feel it
    before, after = noisy_fluid(density_diffusion=0.1)
    assert after < 0.25 * before


def test_stress_diffusion_smooths_stripes_and_keeps_the_mean() -> None:
    n = 12
    x = lattice((n, n), (0.0, 0.0))
    stripes = 1e-3 * (-1.0) ** np.arange(len(x))
    means, spreads = [], []
    for factor in (0.0, 0.1):
        problem = one_body(
            x, planes=periodic(1.2, 1.2), body={"stress_diffusion": factor}, fixed=np.ones((len(x), 3), bool),
            stress=np.outer(stripes, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
        )  # fmt: skip
        solver = finished(problem, 1.0)
        stress = solver.frame().particles["stress"][:, 1]
        means.append(float(np.mean(stress)))
        spreads.append(float(np.std(stress)))
    assert spreads[0] == pytest.approx(1e-3)
    assert spreads[1] < 1e-4
    assert means == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_stress_diffusion_leaves_grain_at_rest_on_a_plane_alone(dimension: int) -> None:
    """Vertical stress rho g z, half of it sideways; up to the free surface, and to the plane with its images."""
    x = lattice((8, 10, 5)[:dimension], (0.0,) * dimension)
    low = float(x[:, 1].min()) - 0.05
    depth = low + 1.0 - x[:, 1]
    problem = one_body(
        x, dimension=dimension, planes=(Plane(1, -1, SYMMETRY, low),), body={"stress_diffusion": 0.1},
        fixed=np.ones((len(x), 3), bool), body_force=(0.0, -2e-3, 0.0),
        stress=np.outer(-2e-3 * depth, [0.5, 1.0, 0.5, 0.0, 0.0, 0.0]),
    )  # fmt: skip
    stress = finished(problem, 1.0).frame().particles["stress"]
    assert np.abs(stress[:, 1] + 2e-3 * depth).max() < 1e-9
    assert np.abs(stress[:, [0, 2]] + 1e-3 * depth[:, None]).max() < 1e-9


@pytest.mark.parametrize("correction", [False, True])
@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_a_wall_bears_the_stress_of_what_lies_on_it(dimension: int, correction: bool) -> None:
    """rho g z goes on into the wall, shear as it is, and the wall keeps its density."""
    x = lattice((8, 10, 5)[:dimension], (0.0,) * dimension)
    wall = x[:, 1] < x[:, 1].min() + 0.25
    depth = x[:, 1].max() - x[:, 1]
    stress = np.outer(-2e-3 * depth, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    stress[:, 3] = 1e-4
    base = one_body(x, dimension=dimension)
    body = base.bodies[0]
    problem = dataclasses.replace(
        base, bodies=(body, dataclasses.replace(body, number=2, bearing=True)), body=wall.astype(np.int64),
        fixed=np.ones((len(x), 3), bool), body_force=(0.0, -2e-3, 0.0), cures=Cures(correction=correction),
        stress=np.where(wall[:, None], 0.0, stress),
    )  # fmt: skip
    solver = finished(problem, 0.1)
    found = solver.frame().particles
    near = wall & (x[:, 1] > x[:, 1].min() + 0.05)  # the lowest of the three rows sees nothing but wall
    assert np.abs(found["stress"][near] - stress[near]).max() < 1e-9
    assert found["density"][wall].tolist() == [1.0] * int(wall.sum())


@pytest.mark.parametrize("correction", [False, True])
@pytest.mark.parametrize("shape", [(8, 8), (5, 5, 5)])
def test_a_wall_that_moves_is_strained_by_what_leans_on_it_alone(shape: tuple[int, ...], correction: bool) -> None:
    """Wall on wall exerts nothing: its work would be energy out of nothing."""
    d = len(shape)
    x = jittered(shape)
    wall = x[:, 1] < np.median(x[:, 1])
    v = np.random.default_rng(2).normal(size=x.shape) * (np.arange(3) < d)
    base = one_body(x, v, dimension=d, cures=Cures(correction=correction))
    bodies = (base.bodies[0], dataclasses.replace(base.bodies[0], number=2, bearing=True))
    solver = Solver(dataclasses.replace(base, bodies=bodies, body=wall.astype(np.int64)), threads=1)
    a, n, solid = solver._arrays(), solver.n, True if d == 3 else None
    a.x_half[:n], a.y_half[:n] = a.x[:n], a.y[:n]
    if solid:
        a.z_half[:n] = a.z[:n]
    walls = a.material[:n] == 1
    volume = a.volume.copy()

    def gradient(correction: np.ndarray | None) -> np.ndarray:
        packed.pack_motion(0, 1, NOBODY, 0, solid, None, None, True, a)
        pairs.velocity_gradient(
            0, n, a.first, a.count, a.rows, solver._shape, a.packed, a.near[0, 0], solid, None,
            solver._numbers.inverse_h2, solver._numbers.scale, None, a.gradient, correction,
            solver._numbers.corrected, a.material,
        )  # fmt: skip
        return np.array(a.gradient[:, :n].T.reshape(n, d, d))

    a.volume[:n][walls] = 0.0
    wanted = gradient(None)
    a.volume[:] = volume
    whole = gradient(a.correction if correction else None)
    if correction:
        b = np.array([[0, 2], [2, 1]] if d == 2 else [[0, 3, 5], [3, 1, 4], [5, 4, 2]])
        wanted = np.einsum("iab,ibc->iac", wanted, a.correction[b][:, :, :n].transpose(2, 0, 1))
    bearing.without_walls(0, n, solid, solver._shape, a.correction if correction else None, a, solver._numbers)
    found = np.array(a.gradient[:, :n].T.reshape(n, d, d))
    assert np.array_equal(found[~walls], whole[~walls])
    assert np.abs(whole - wanted)[walls].max() > 0.1
    assert np.abs(found - wanted)[walls].max() < 1e-12 * np.abs(whole).max()


def test_smoothed_velocities_move_particles_and_conserve_momentum() -> None:
    n = 10
    x = lattice((n, n), (0.0, 0.0))
    v = np.zeros_like(x)
    v[:, 0] = 1e-3 * (-1.0) ** np.arange(n * n)
    moved = []
    for factor in (0.0, 0.5):
        solver = finished(one_body(x, v, planes=periodic(1.0, 1.0), cures=Cures(xsph=factor)), 0.05)
        p = solver.frame().particles
        moved.append(float(np.abs(p["displacement"][:, 0]).max()))
        assert abs(solver.history()["momentum_x"]) < 1e-18
    assert moved[1] < 0.75 * moved[0]


@pytest.mark.parametrize("own", [True, False])
@pytest.mark.parametrize("shape", [(7, 6), (4, 4, 4)])
def test_smoothed_velocities_are_the_sum_pair_by_pair(shape: tuple[int, ...], own: bool) -> None:
    """Own densities, and own smoothing lengths and masses."""
    d, x = len(shape), jittered(shape, 0.2)
    n, noise = len(x), np.random.default_rng(5)
    v = noise.normal(size=(n, 3)) * (np.arange(3) < d)
    changes = {"h": noise.uniform(0.11, 0.13, n), "mass": noise.uniform(0.5, 1.0, n)} if own else {}
    problem = one_body(x, v, dimension=d, density=noise.uniform(0.9, 1.1, n), cures=Cures(xsph=0.4), **changes)
    solver = Solver(problem, threads=1)
    a, shape_of_kernel = solver._arrays(), solver._shape
    found = smoothed_velocities(solver, 0.4)
    place = np.stack([a.x, a.y, a.z][:d])[:, :n]
    motion = np.stack([a.u, a.v, a.w][:d])[:, :n]
    for i in range(n):
        h = 0.5 * (a.h[i] + a.h[:n])
        q = np.linalg.norm(place - place[:, i : i + 1], axis=0) / h
        w = np.array([value_at(shape_of_kernel, max(one, 1e-15)) for one in q]) * solver._numbers.normal / h**d
        weight = 2.0 * a.mass[:n] / (a.density[i] + a.density[:n]) * w
        wanted = motion[:, i] + 0.4 * (weight * (motion - motion[:, i : i + 1])).sum(axis=1)
        assert found[:, i] == pytest.approx(wanted, rel=0.0, abs=1e-12 * np.abs(wanted).max())


def test_pair_viscosity_dissipates_what_motion_loses() -> None:
    body = {"alpha": 0.2, "beta": 0.4, "linear": 0.0, "quadratic": 0.0}
    x = lattice((8, 8), (0.0, 0.0))
    v = np.zeros_like(x)
    v[:, 0] = -0.01 * np.sign(x[:, 0] - 0.4)
    loose, viscous = (
        finished(one_body(x, v, body=b, step_factor=0.1), 2.0).energy_report()
        for b in ({"linear": 0.0, "quadratic": 0.0}, body)
    )
    assert loose["dissipated"] == 0.0
    assert viscous["dissipated"] > 0.2 * viscous["initial"]
    assert viscous["balance_error"] < 1e-2


def test_all_cures_together_depend_on_no_thread_and_go_on_bit_for_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("zrno.solvers.sph.solver.SMALL", 0)
    n = 12
    x = jittered((n, n), 0.05)
    v = np.zeros_like(x)
    v[:, 0] = 0.02 * np.sin(2.0 * np.pi * x[:, 1] / 1.2)
    body = {"alpha": 0.1, "density_diffusion": 0.1, "stress_diffusion": 0.1}
    problem = one_body(x, v, planes=periodic(1.2, 1.2), cures=Cures(True, 0.3, 0.2), h_option=2, body=body)
    frames: list[dict[str, Any]] = [finished(problem, 8.0, threads=t).frame().particles for t in (1, 2)]
    first = Solver(problem, threads=2)
    first.advance(8.0, 31)
    second = Solver(problem, threads=1)
    second.restore(first.checkpoint())
    second.advance(8.0, 10**6)
    for name, values in frames[0].items():
        assert np.array_equal(values, frames[1][name]), name
        assert np.array_equal(values, second.frame().particles[name]), name
    assert second.builds > 1


def test_an_instant_is_no_division_by_zero() -> None:
    assert 0.0 / INSTANT == 0.0
