"""Bodies that stay whole: exact linear fields, conservation, hourglass control, closed forms, and what is refused."""

from __future__ import annotations

import csv
import dataclasses
import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.solvers.contact.pinball import STIFF
from zrno.solvers.errors import Diverged
from zrno.solvers.exact.oscillating_plate import OscillatingPlate
from zrno.solvers.materials import Elastic, sound_speed, von_mises
from zrno.solvers.sph import Body, Cures, Problem, Solver, lagrangian, particle
from zrno.solvers.sph.ghosts import LIMIT, SYMMETRY, Plane
from zrno.solvers.sph.nominal import KAPPA, PSI, nominal_stress
from zrno.solvers.sph.surface import Facets

ELASTIC = Elastic.from_engineering(1.0, 0.3)
BULK = ELASTIC.lame + 2.0 / 3.0 * ELASTIC.shear
BODY = Body(1, "b", ELASTIC, 1.0, lagrangian=True)


def lattice(shape: tuple[int, ...], spacing: float = 0.1) -> np.ndarray:
    x = np.zeros((math.prod(shape), 3))
    axes = [spacing * (np.arange(n) + 0.5) for n in shape]
    x[:, : len(shape)] = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(shape))
    return x


def block(shape: tuple[int, ...], spacing: float = 0.1, **changes: Any) -> Problem:
    """One elastic body on a lattice, at rest."""
    x = changes.pop("x", None)
    x = lattice(shape, spacing) if x is None else x
    n, d = len(x), len(shape)
    options: dict[str, Any] = {
        "dimension": d,
        "x": x,
        "v": np.zeros_like(x),
        "mass": np.full(n, spacing**d),
        "h": np.full(n, 1.2 * spacing),
        "density": np.ones(n),
        "body": np.zeros(n, np.int64),
        "bodies": (BODY,),
        "end_time": 1e9,
    }
    return Problem(**options | changes)


def irregular(dimension: int) -> Problem:
    """A cloud with places, masses and smoothing lengths of its own everywhere."""
    random = np.random.default_rng(5)
    shape = (30,) if dimension == 1 else (7,) * dimension
    p = block(shape)
    n = len(p.x)
    x = p.x.copy()
    x[:, :dimension] += 0.02 * random.uniform(-1.0, 1.0, (n, dimension))
    return dataclasses.replace(p, x=x, mass=p.mass * random.uniform(0.8, 1.2, n), h=p.h * random.uniform(1.0, 1.2, n))


def impose(s: Solver, x: np.ndarray, dt: float = 1.0) -> None:
    """Move the particles to x (d, n), in the solver's order, and take what follows from it: strain, stress, force."""
    a, n = s._arrays(), s.n
    solid = True if s.problem.dimension == 3 else None
    z = a.z if solid else None
    s._state.rows("x")[: len(x), :n] = x
    lagrangian.deformation(0, n, solid, dt, s._reference, a)
    particle.constitutive(0, n, z, 0, s._laws[0], dt, None, None, None, None, None, None, a, s._numbers)
    assert nominal_stress(0, n, z, s._reference, a) == -1.0
    lagrangian.internal_force(0, n, z, None, s._reference, a, s._numbers)


@pytest.mark.parametrize("dimension", [pytest.param(1, marks=pytest.mark.slow), 2, 3])
def test_a_linear_field_is_exact_and_meets_no_hourglass_control(dimension: int) -> None:
    problem = irregular(dimension)
    s = Solver(dataclasses.replace(problem, bodies=(dataclasses.replace(BODY, law=Elastic(1e-20, 1e-20)),)))
    kappa = s._state.rows("hourglass")[KAPPA]
    kappa[: s.n] = s._reference.stiffness[0] / 1e-20  # hourglass control of a material that has no other stress
    s._reference.stiffness[:] = kappa[0]
    d, n = s._state.d, s.n
    map_ = np.array([[1.3, 0.2, -0.1], [0.1, 0.8, 0.3], [0.05, -0.2, 1.1]])[:d, :d]
    if dimension == 1:
        map_ = np.diag([1.3, 1.0])
    start = s._state.rows("x_start")[:, :n].copy()
    impose(s, map_ @ start)
    f = s._state.rows("deformation")[:, :n].reshape(d, d, n) + np.eye(d)[:, :, None]
    assert np.abs(f - map_[:, :, None]).max() < 1e-12
    assert np.allclose(s._state.rows("density")[0, :n], 1.0 / np.linalg.det(map_), rtol=1e-12, atol=0.0)
    force = s._state.rows("a")[:, :n] * s._state.rows("mass")[0, :n]
    area = 0.1 ** (dimension - 1)
    assert np.abs(force).max() < 1e-12 * kappa[0] * area
    zigzag = np.zeros_like(start)
    zigzag[0] = 1e-3 * np.cos(np.pi * np.floor(start[:dimension] / 0.1).sum(axis=0))
    impose(s, map_ @ start + zigzag)
    force = s._state.rows("a")[:, :n] * s._state.rows("mass")[0, :n]
    assert np.abs(force).max() > 1e-3 * kappa[0] * area
    assert np.sum(force * zigzag) < 0.0  # against the zigzag


def test_weights_are_the_same_from_both_sides() -> None:
    s = Solver(irregular(3))
    r = s._reference
    assert r is not None
    dense = np.zeros((s.n, s.n), np.float32)
    for i in range(s.n):
        at = slice(r.first[i], r.first[i] + r.count[i])
        real = r.rows[at] < s.n
        dense[i, r.rows[at][real]] = r.weight[at][real]
    assert np.count_nonzero(dense) > 20 * s.n
    assert np.array_equal(dense, dense.T)


@pytest.mark.parametrize("dimension", [2, 3])
def test_ten_turns_leave_no_stress_and_turn_what_there_was(dimension: int) -> None:
    s = Solver(irregular(dimension))
    n, d = s.n, dimension
    start = s._state.rows("x_start")[:, :n].copy()
    before = np.array([[2e-3, 5e-4, -3e-4], [5e-4, -1e-3, 2e-4], [-3e-4, 2e-4, 1e-3]])
    if d == 2:
        before[2] = before[:, 2] = 0.0
    parts = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))[: 6 if d == 3 else 4]
    for row, part in zip(s._state.rows("stress"), parts, strict=True):
        row[:n] = before[part]
    axis = np.array([1.0, 2.0, 2.0]) / 3.0 if d == 3 else np.array([0.0, 0.0, 1.0])
    cross = np.cross(np.eye(3), -axis)
    turns, per_turn = 10, 60
    for k in range(1, turns * per_turn + 16):  # and a quarter
        angle = 2.0 * math.pi * k / per_turn
        turn = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
        impose(s, turn[:d, :d] @ start)
    after = turn @ before @ turn.T
    for row, part in zip(s._state.rows("stress"), parts, strict=True):
        assert np.abs(row[:n] - after[part]).max() < 1e-6 * BULK
    assert np.abs(s._state.rows("energy")[0, :n]).max() < 1e-12


def spinning(dimension: int, **changes: Any) -> Problem:
    """An irregular body that flies, spins and shakes."""
    p = irregular(dimension)
    random = np.random.default_rng(8)
    v = np.zeros_like(p.x)
    v[:, :dimension] = 0.01 + 0.01 * random.uniform(-1.0, 1.0, (len(v), dimension))
    v[:, 0] -= 0.05 * p.x[:, 1]
    v[:, 1] += 0.05 * p.x[:, 0]
    return dataclasses.replace(p, v=v, **changes)


@pytest.mark.parametrize("dimension", [2, 3])
def test_momentum_moment_and_energy(dimension: int) -> None:
    problem = spinning(dimension, bodies=(dataclasses.replace(BODY, quadratic=0.0, linear=0.0),))
    s = Solver(problem)

    def moments() -> np.ndarray:
        x, u, mass = (s._state.rows(name)[:, : s.n] for name in ("x", "u", "mass"))
        if dimension == 2:
            moment = mass[0] @ (x[0] * u[1] - x[1] * u[0])
            return np.array([*(mass * u).sum(axis=1), moment])
        return np.concatenate(((mass * u).sum(axis=1), (mass * np.cross(x.T, u.T).T).sum(axis=1)))

    start = moments()
    s.advance(20.0, 10**6)
    assert np.allclose(moments(), start, rtol=0.0, atol=1e-12 * np.abs(start).max())
    row = s.history()
    assert row["artificial_energy"] > 1e-3 * row["kinetic"]  # the shaking is at the particles' own scale
    assert s.energy_report()["balance_error"] < 1e-2
    assert s.builds == 1  # it flew twice its reach and more, and nothing was searched
    assert len(s._list.rows) == 0


def bars(n: int) -> tuple[float, float]:
    """Symmetric impact of two unit bars in uniaxial strain: plateau stress / (rho c v), front / (c t)."""
    dx, speed = 1.0 / n, 1e-4
    x = np.zeros((2 * n, 3))
    x[:, 0] = (np.arange(2 * n) + 0.5 - n) * dx
    v = np.zeros_like(x)
    v[:n, 0], v[n:, 0] = speed, -speed
    c = sound_speed(ELASTIC, 1.0)
    body = dataclasses.replace(BODY, linear=0.5)
    s = Solver(block((2 * n,), dx, x=x, v=v, bodies=(body,), step_factor=0.5))
    s.advance(0.5 / c, 10**6)
    frame = s.frame().particles
    stress = -frame["stress"][:, 0] / (c * speed)
    where = frame["position"][:, 0]
    right = where > 0.0
    return float(np.mean(stress[np.abs(where) < 0.35])), float(np.interp(-0.5, -stress[right], where[right])) / 0.5


def test_a_bar_wave_arrives_in_time() -> None:
    """d'Alembert. The gradients being exact for linear fields, the wave has the speed of the material."""
    plateau, front = bars(200)
    assert plateau == pytest.approx(1.0, abs=0.02)
    assert front == pytest.approx(1.0, abs=0.01)


def stretching(whole: bool) -> Solver:
    """A strip that its own speed stretches by half, and by more in its middle."""
    p = block((40, 10))
    v = np.zeros_like(p.x)
    v[:, 0] = 0.5 * (p.x[:, 0] - p.x[:, 0].mean())
    return Solver(dataclasses.replace(p, v=v, bodies=(dataclasses.replace(BODY, lagrangian=whole),), step_factor=0.4))


def test_stretch_by_half_does_not_tear_the_lattice() -> None:
    s = stretching(True)
    longest = 0.0
    while s.time < 4.0:
        s.advance(s.time + 0.1, 10**6)
        place = s.frame().particles["position"].reshape(40, 10, 3)
        longest = max(longest, np.ptp(place[:, 5, 0]) / 3.9)
        gaps = np.diff(place[:, 5, 0])
        assert np.abs(np.diff(gaps, 2)).max() < 0.1 * gaps.mean()  # no zigzag in them
    assert longest > 1.5
    assert s.energy_report()["balance_error"] < 1e-2


def test_the_plain_formulation_tears_that_lattice() -> None:
    """W'' sigma > 0: its particles clump until two of them coincide."""
    with pytest.raises(Diverged, match="clump"):
        stretching(False).advance(4.0, 10**6)


def test_hourglass_control_holds_a_mode_without_energy() -> None:
    """A checkerboard of velocities strains nothing that a mean gradient sees: it grows unless controlled."""
    sizes = []
    for hourglass in (BODY.hourglass, 0.0):
        p = block((14, 14))
        sign = (-1.0) ** np.floor(p.x[:, :2] / 0.1 + 0.01).sum(axis=1)
        inside = np.all(np.abs(p.x[:, :2] - 0.7) < 0.4, axis=1)
        v = np.zeros_like(p.x)
        v[:, 0] = 1e-4 * sign * inside
        s = Solver(dataclasses.replace(p, v=v, bodies=(dataclasses.replace(BODY, hourglass=hourglass),)))
        largest = 0.0
        for _ in range(20):
            s.advance(s.time + 0.25, 10**6)
            moved = s.frame().particles["displacement"][:, 0]
            largest = max(largest, abs(np.mean((moved * sign)[inside])))
        sizes.append(largest)
    assert sizes[0] < 1e-5
    assert sizes[1] > 10.0 * sizes[0]


def plate(layers: int, periods: float) -> tuple[float, float]:
    """The oscillating plate of Gray, Monaghan & Swift: mean period / thin plate's, last amplitude / first."""
    length, thick, law = 0.2, 0.02, Elastic.from_engineering(2e6, 0.3975)
    exact = OscillatingPlate(length=length, thickness=thick, young=2e6, poisson=0.3975, density=1000.0)
    dx, clamp = thick / layers, 4
    x = lattice((10 * layers + clamp, layers), dx)
    x[:, 0] -= clamp * dx
    kl = 1.8751040687119611
    s = kl * x[:, 0] / length

    def shape(s: Any) -> Any:
        first = (np.cos(kl) + np.cosh(kl)) * (np.cosh(s) - np.cos(s))
        return first + (np.sin(kl) - np.sinh(kl)) * (np.sinh(s) - np.sin(s))

    free = x[:, 0] > 0.0
    v = np.zeros_like(x)
    v[:, 1] = np.where(free, 0.01 * math.sqrt(_bulk(law) / 1000.0) * shape(s) / shape(kl), 0.0)
    fixed = np.repeat(~free[:, None], 3, axis=1)
    body = Body(1, "plate", law, 1000.0, linear=0.0, quadratic=0.0, lagrangian=True)
    problem = block((10 * layers + clamp, layers), dx, x=x, v=v, fixed=fixed, bodies=(body,))
    n = len(x)
    problem = dataclasses.replace(problem, mass=np.full(n, 1000.0 * dx * dx), density=np.full(n, 1000.0))
    solver = Solver(problem)
    tip = int(np.flatnonzero(solver._state.id[:n] == n)[0])
    times, places = [0.0], [0.0]
    while times[-1] < periods * exact.period():
        solver.advance(1e9, 10**7, times[-1] + 0.01 * exact.period())
        times.append(solver.time)
        places.append(solver._state.rows("x")[1, tip] - x[-1, 1])
    t, y = np.array(times), np.array(places)
    up = np.flatnonzero((y[:-1] <= 0.0) & (y[1:] > 0.0))
    crossed = t[up] - y[up] * (t[up + 1] - t[up]) / (y[up + 1] - y[up])
    period = (crossed[-1] - crossed[0]) / (len(crossed) - 1)
    largest = [y[(t >= a) & (t < b)].max() for a, b in itertools.pairwise(crossed)]
    assert solver.energy_report()["balance_error"] < 1e-3
    return period / exact.period(), largest[-1] / largest[0]


def _bulk(law: Elastic) -> float:
    return law.lame + 2.0 / 3.0 * law.shear


def test_a_plate_oscillates() -> None:
    """A plate this thick is 1 % slower than the thin one of the formula (Timoshenko); ten layers add 2 %."""
    period, _ = plate(10, 1.1)
    assert period == pytest.approx(1.01, abs=0.03)


@pytest.mark.slow
def test_a_plate_keeps_its_amplitude_over_ten_periods() -> None:
    period, kept = plate(12, 10.5)
    assert period == pytest.approx(1.0, abs=0.03)
    assert kept == pytest.approx(1.0, abs=0.05)


def taylor(cells: int) -> tuple[float, float, dict[str, float]]:
    """Copper rod at 227 m/s on a rigid frictionless wall (mm, us, g): length, greatest radius, last row.

    The wall holds the axial motion of the foot's first layer; it slides on it freely.
    """
    radius, length, rho = 3.2, 32.4, 8.93e-3
    dx = radius / cells
    rows = round(length / dx)
    x = lattice((2 * cells, 2 * cells, rows), dx)
    x[:, :2] -= radius
    x[:, 2] *= length / (rows * dx)
    x = x[np.hypot(x[:, 0], x[:, 1]) <= radius]
    n = len(x)
    foot = x[:, 2] < dx
    v = np.zeros_like(x)
    v[:, 2] = np.where(foot, 0.0, -0.227)
    fixed = np.zeros((n, 3), bool)
    fixed[foot, 2] = True
    young, hardening = 117e-3, 0.1e-3
    law = von_mises(young, 0.35, 0.4e-3, young * hardening / (young + hardening))
    problem = Problem(
        dimension=3, x=x, v=v, mass=np.full(n, rho * math.pi * radius**2 * length / n), h=np.full(n, 1.2 * dx),
        density=np.full(n, rho), body=np.zeros(n, np.int64), bodies=(Body(1, "rod", law, rho, lagrangian=True),),
        end_time=80.0, fixed=fixed,
    )  # fmt: skip
    s = Solver(problem)
    s.advance(80.0, 10**6)
    place = s.frame().particles["position"]
    wide = float(np.hypot(place[:, 0], place[:, 1]).max()) + 0.5 * dx
    return float(np.ptp(place[:, 2])) + length / rows, wide, s.history() | s.energy_report()


def published(shared: Path, quantity: str) -> tuple[float, float]:
    """The range of the literature."""
    lines = [
        line for line in (shared / "reference" / "sph" / "taylor_bar.csv").read_text().splitlines() if line[:1] != "#"
    ]
    low, high = next(row for row in csv.DictReader(lines) if row["quantity"] == quantity)["published"].split("-")
    return float(low), float(high)


def test_a_coarse_rod_mushrooms(shared: Path) -> None:
    """Three particles across the radius: 1600 of them. Finer ones: tests/samples/test_taylor_bar.py."""
    length, radius, row = taylor(3)
    low, high = published(shared, "final length mm")
    assert 0.96 * low < length < 1.04 * high
    low, high = published(shared, "final max radius mm")
    assert 0.9 * low < radius < 1.1 * high
    assert row["balance_error"] < 1e-2
    assert row["max_plastic_strain"] > 1.5


def pair(second: Body, gap: float = 0.1) -> Problem:
    """A body that stays whole and another one beside it, which run into each other."""
    p = block((8, 8))
    x = np.concatenate((p.x, p.x + np.array([0.8 + gap, 0.0, 0.0])))
    n = len(p.x)
    v = np.zeros_like(x)
    v[:n, 0], v[n:, 0] = 0.01, -0.01
    first = dataclasses.replace(BODY, strength=5.0, exponent=4.0)
    return block(
        (16, 8), x=x, v=v, body=np.repeat([0, 1], n), potential=True,
        bodies=(first, dataclasses.replace(second, number=2, strength=5.0, exponent=4.0)),
    )  # fmt: skip


@pytest.mark.parametrize(("whole", "balls"), [(True, False), (False, False), (True, True)])
def test_contact_with_either_kind_gives_the_energy_back(whole: bool, balls: bool) -> None:
    problem = pair(dataclasses.replace(BODY, lagrangian=whole))
    if balls:
        problem = dataclasses.replace(problem, potential=False, pinball=STIFF)
    s = Solver(problem)
    largest = 0.0
    while s.time < 16.0:
        s.advance(s.time + 0.5, 10**6)
        row = s.history()
        largest = max(largest, row["contact_energy"])
        assert abs(row["momentum_x"]) < 1e-14
    assert largest > 1e-2 * 2.0 * 0.5 * 0.64 * 0.01**2
    left = s.frame().particles["velocity"][:64, 0].mean()
    assert left < 0.0
    assert s.energy_report()["balance_error"] < 1e-2


def test_bodies_far_apart_are_not_searched() -> None:
    s = Solver(pair(BODY, gap=2.0))
    s.advance(20.0, 10**6)  # each went 0.2, the list's own skin is 0.03
    assert s.builds == 1


@pytest.mark.parametrize("whole", [True, False])
def test_the_number_of_threads_changes_no_bit(whole: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("zrno.solvers.sph.solver.SMALL", 0)
    problem = pair(dataclasses.replace(BODY, lagrangian=whole), gap=0.05)
    frames = []
    for threads in (1, 2):
        s = Solver(problem, threads=threads)
        s.advance(8.0, 10**6)
        frames.append(s.frame().particles)
    for name, values in frames[0].items():
        assert np.array_equal(values, frames[1][name]), name


@pytest.mark.parametrize("whole", [True, False])
def test_a_checkpoint_goes_on_bit_for_bit(whole: bool) -> None:
    problem = pair(dataclasses.replace(BODY, lagrangian=whole), gap=0.05)
    one = Solver(problem)
    one.advance(6.1, 10**6)
    other = Solver(problem)
    other.restore(one.checkpoint())
    assert one.builds > 2
    for s in (one, other):
        s.advance(9.0, 10**6)
    assert one.history() == other.history()
    for name, values in one.frame().particles.items():
        assert np.array_equal(values, other.frame().particles[name]), name


def test_fall_and_what_is_fixed() -> None:
    p = block((6, 6), body_force=(0.1, -0.2, 0.0))
    fixed = np.zeros((36, 3), bool)
    fixed[:, 0] = True
    s = Solver(dataclasses.replace(p, fixed=fixed))
    s.advance(1.0, 10**6)
    moved = s.frame().particles["displacement"]
    assert np.all(moved[:, 0] == 0.0)
    assert np.allclose(moved[:, 1], -0.1, atol=1e-12)


def test_a_particle_alone_flies_on() -> None:
    p = block((6, 6))
    x = p.x.copy()
    x[35] = [9.0, 9.0, 0.0]
    v = np.zeros_like(x)
    v[35, 0] = 0.5
    s = Solver(dataclasses.replace(p, x=x, v=v))
    s.advance(1.0, 10**6)
    moved = s.frame().particles["displacement"]
    assert moved[35, 0] == pytest.approx(0.5, rel=1e-12)
    assert np.all(moved[:35] == 0.0)


@pytest.mark.parametrize("rate", [-1.0, 1.0])
def test_a_body_that_does_not_stay_whole_stops_the_run_by_name(rate: float) -> None:
    """So soft a body is crushed or drawn out by its own speed."""
    p = block((10, 10))
    v = np.zeros_like(p.x)
    v[:, 0] = rate * (p.x[:, 0] - 0.5)
    body = dataclasses.replace(BODY, law=Elastic.from_engineering(1e-6, 0.3), linear=0.0, quadratic=0.0)
    s = Solver(dataclasses.replace(p, v=v, bodies=(body,)))
    with pytest.raises(Diverged, match="times that of the start") as caught:
        s.advance(100.0, 10**6)
    assert caught.value.step == s.step > 0
    assert 1 <= caught.value.item <= 100


PLANE = Plane(axis=0, side=-1, kind=SYMMETRY, position=0.0)
METAL = von_mises(1.0, 0.3, 0.02, 0.1)


def folded(dimension: int, whole: bool) -> Solver:
    """A block of metal that is squeezed along x and sheared, symmetric about each axis: all of it, or a corner."""
    n, at = 5, 0.3  # the planes lie there
    x = lattice((n,) * dimension)
    v = np.zeros_like(x)
    for k in range(dimension):
        v[:, k] = (0.3 if k else -0.5) * x[:, k] * (1.0 + 2.0 * x[:, 0] * x[:, 1])
    x[:, :dimension] += at
    if whole:
        for k in range(dimension):
            x = np.concatenate((x, x))
            v = np.concatenate((v, v))
            half = len(x) // 2
            x[half:, k] = 2.0 * at - x[half:, k]
            v[half:, k] *= -1.0
    body = dataclasses.replace(BODY, law=METAL)
    planes = tuple(Plane(k, -1, SYMMETRY, at) for k in range(dimension))
    return Solver(block((n,) * dimension, x=x, v=v, bodies=(body,), planes=() if whole else planes, step_factor=0.5))


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_symmetry_planes_are_the_other_half(dimension: int) -> None:
    """Edges and corners, where images have images, among them."""
    part, all_of_it = folded(dimension, whole=False), folded(dimension, whole=True)
    for s in (part, all_of_it):
        s.advance(1.0, 10**6)
    n = part.n
    assert part.step == all_of_it.step
    one, other = part.frame().particles, all_of_it.frame().particles
    assert one["plastic_strain"].max() > 0.1
    for name in ("position", "velocity", "stress", "plastic_strain"):
        assert np.allclose(one[name], other[name][:n], rtol=0.0, atol=1e-6 * np.abs(other[name]).max()), name
    assert part.history()["kinetic"] * 2**dimension == pytest.approx(all_of_it.history()["kinetic"], rel=1e-6)
    assert part.energy_report()["balance_error"] < 1e-2


def test_a_body_in_a_corner_goes_on_bit_for_bit() -> None:
    one, other = folded(2, whole=False), folded(2, whole=False)
    one.advance(0.45, 10**6)
    other.restore(one.checkpoint())
    for s in (one, other):
        s.advance(1.0, 10**6)
    assert one.history() == other.history()
    for name, values in one.frame().particles.items():
        assert np.array_equal(values, other.frame().particles[name]), name


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        ({"planes": (dataclasses.replace(PLANE, kind=LIMIT),)}, "limit planes"),
        (
            {"planes": (PLANE,), "bodies": (BODY, BODY), "body": np.arange(36) // 18, "potential": True},
            "of several bodies",
        ),
        ({"planes": (dataclasses.replace(PLANE, position=0.05),)}, "6 particle.s. lie on the symmetry plane x = 0.05"),
        ({"planes": (dataclasses.replace(PLANE, position=-1.0),)}, "no particle is near the symmetry plane x = -1"),
        ({"original": True}, "original"),
        ({"bodies": (BODY, BODY), "body": np.arange(36) // 18}, "kernel contact"),
        ({"bodies": (dataclasses.replace(BODY, law=Elastic(1.0, 0.0)),)}, "shear"),
        ({"bodies": (dataclasses.replace(BODY, alpha=0.1),)}, "pair viscosity"),
        ({"bodies": (dataclasses.replace(BODY, stress_diffusion=0.1),)}, "diffusion"),
        ({"bodies": (dataclasses.replace(BODY, hourglass=2.0),)}, "hourglass"),
        ({"x": lattice((6, 6)) * [1.0, 0.0, 0.0] + [0.0, 0.05, 0.0]}, "too thin"),
    ],
)
def test_what_does_not_go_together_is_refused(change: dict[str, Any], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        Solver(block((6, 6), **change))


def test_energy_of_the_hourglass_modes_is_that_of_their_force() -> None:
    """kappa psi, a function of the places alone, against the work of the force along a path."""
    s = Solver(dataclasses.replace(irregular(2), bodies=(dataclasses.replace(BODY, linear=0.0, quadratic=0.0),)))
    n = s.n
    s._laws = (Elastic(0.0, 0.0),)
    start = s._state.rows("x_start")[:, :n].copy()
    change = 0.01 * np.random.default_rng(3).uniform(-1.0, 1.0, start.shape)
    mass = s._state.rows("mass")[0, :n]
    steps, work = 50, 0.0
    for k in range(steps):  # the force is linear in the places: the rule of middles is exact
        impose(s, start + (k + 0.5) / steps * change)
        work += np.sum(mass * s._state.rows("a")[:, :n] * change) / steps
    impose(s, start + change)
    hourglass = s._state.rows("hourglass")[:, :n]
    stored = np.sum(hourglass[KAPPA] * hourglass[PSI])
    assert stored > 0.0
    assert work == pytest.approx(-stored, rel=1e-9)
    assert -s._state.rows("artificial_work")[0, :n].sum() == pytest.approx(stored, rel=1e-9)


def test_a_body_that_stays_whole_meets_facets_that_were_far_away_at_the_start() -> None:
    """Its own neighbours need no new list, the facets near it do: it flew through them. It rebounds with its energy."""
    ends = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    floor = Facets(ends, np.array([[0, 1]]), np.zeros(1), np.zeros(1, bool))
    p = block((4, 4), v=np.tile([0.0, -0.02, 0.0], (16, 1)), facets=floor)
    solver = Solver(dataclasses.replace(p, x=p.x + np.array([-0.2, 0.5, 0.0])), threads=1)
    solver.advance(60.0, 10**6)
    found = solver.frame().particles
    assert found["position"][:, 1].min() > 0.1
    assert 0.7 * 0.02 < found["velocity"][:, 1].mean() <= 0.02
    assert solver.energy_report()["balance_error"] < 0.01


def test_a_corrected_body_meets_one_that_stays_whole() -> None:
    """The correction wants a strain before the first step, in which nothing has moved: no rate of deformation by it."""
    x = np.concatenate([lattice((4, 4)), lattice((4, 4)) + np.array([0.0, 0.5, 0.0])])
    v = np.repeat([[0.0, 0.01, 0.0], [0.0, -0.01, 0.0]], 16, axis=0)
    bodies = BODY, dataclasses.replace(BODY, number=2, lagrangian=False)
    p = block((4, 4), x=x, v=v, bodies=bodies, body=np.repeat([0, 1], 16), pinball=STIFF, cures=Cures(correction=True))
    solver = Solver(p, threads=1)
    solver.advance(20.0, 10**6)
    velocity = solver.frame().particles["velocity"][:, 1].reshape(2, 16).mean(axis=1)
    assert velocity == pytest.approx([-0.01, 0.01], rel=0.2)
    assert solver.energy_report()["balance_error"] < 0.01
