"""Contact of bodies and walls in the particle solver: what is conserved, what slides, what must not pass."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from zrno.solvers.contact.friction import Coulomb, Drag
from zrno.solvers.contact.pinball import STIFF
from zrno.solvers.contact.plane import Wall
from zrno.solvers.contact.potential import matching_strength
from zrno.solvers.errors import Diverged
from zrno.solvers.materials import Elastic, sound_speed
from zrno.solvers.sph import Body, Problem, Solver, ghosts
from zrno.solvers.sph import contact as contact_module

YOUNG = 1000.0
LAW = Elastic.from_engineering(YOUNG, 0.3)
C = sound_speed(LAW, 1.0)
DX = 0.1
FRICTION = Coulomb(0.5, 0.4)
LAWS = ("potential", "pinball")
RUBBED = {"friction": FRICTION, "contact_damping": 0.2}


def mostly_slow(quick: Any, *others: Any) -> list[Any]:
    """The first in the default suite, the others with the long checks: each is a compilation of its own."""
    return [quick, *(pytest.param(other, marks=pytest.mark.slow) for other in others)]


def grid(shape: tuple[int, ...], low: tuple[float, ...], spacing: float = DX) -> np.ndarray:
    """Points whose first is `low`."""
    x = np.zeros((math.prod(shape), 3))
    axes = [a + spacing * np.arange(n) for n, a in zip(shape, low, strict=True)]
    x[:, : len(shape)] = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(shape))
    return x


def body(number: int, law: Any = LAW, density: float = 1.0, exponent: float = 4.0) -> Body:
    strength = matching_strength(sound_speed(law, density), density)
    return Body(number, "b", law, density, strength=strength, exponent=exponent)


def meeting(kind: str, speed: float = 0.1, dimension: int = 2, n: int = 6, gap: float = 2.5, **changes: Any) -> Problem:
    """Two cubes that fly at each other along x, gap spacings between their first particles."""
    shape = (n,) * dimension
    rest = (0.0,) * (dimension - 1)
    x = np.concatenate([grid(shape, (-DX * (n - 1 + gap), *rest)), grid(shape, (0.0, *rest))])
    half = len(x) // 2
    v = np.zeros_like(x)
    v[:half, 0], v[half:, 0] = speed, -speed
    options: dict[str, Any] = {
        "dimension": dimension, "x": x, "v": v, "mass": np.full(2 * half, DX**dimension), "h": np.full(2 * half, 0.12),
        "density": np.ones(2 * half), "body": np.repeat([0, 1], half), "bodies": (body(1), body(2)), "end_time": 1.0,
        "potential": kind == "potential", "pinball": STIFF if kind == "pinball" else None, "step_option": 1,
    }  # fmt: skip
    return Problem(**options | changes)


def through(solver: Solver, until: float, parts: int = 400) -> list[dict[str, float]]:
    """The rows of a run at equal times."""
    rows = []
    for k in range(parts):
        solver.advance(until * (k + 1) / parts, 10**7)
        rows.append(solver.history())
    return rows


def velocity(solver: Solver, number: int = 1) -> np.ndarray:
    particles = solver.frame().particles
    return np.asarray(particles["velocity"][particles["material"] == number].mean(axis=0))


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("extra", [{}, pytest.param(RUBBED, marks=pytest.mark.slow)])
def test_bodies_collide_part_and_keep_momentum_and_energy(kind: str, extra: dict[str, Any]) -> None:
    problem = meeting(kind, step_factor=0.2, **extra)
    x = problem.x.copy()
    x[problem.body == 1, 1] += 0.13  # not face to face: friction has something to do
    solver = Solver(dataclasses.replace(problem, x=x))
    rows = through(solver, 4.0)
    momentum = 36 * DX**2 * 0.1
    for row in rows:
        assert abs(row["momentum_x"]) < 1e-12 * momentum
        assert abs(row["momentum_y"]) < 1e-12 * momentum
    energy = rows[0]["kinetic"]
    assert max(row["contact_energy"] for row in rows) > 0.0
    assert velocity(solver)[0] < -0.05  # 0.1 before
    assert abs(rows[-1]["contact_energy"]) < 5e-3 * energy  # what it stored it gave back
    assert rows[-1]["contact_dissipated"] >= -1e-6 * energy
    assert (rows[-1]["contact_dissipated"] > 1e-3 * energy) == bool(extra)
    assert rows[-1]["contact_force_x"] == 0.0
    assert solver.energy_report()["balance_error"] < 2e-3


def slope(
    kind: str, angle: float, friction: Coulomb | None, *, damping: float = 0.3, turn: float = 0.0, **changes: Any
) -> Solver:
    """A block of 16 x 3 particles that settles and is then tilted, at t = 6 to its angle. turn: of the whole scene."""
    a = math.radians(angle)
    fall = np.array([[0.0, -1.0, 0.0], [0.0, -1.0, 0.0], [math.sin(a), -math.cos(a), 0.0]])
    spin = np.array([[math.cos(turn), math.sin(turn), 0.0], [-math.sin(turn), math.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    options: dict[str, Any]
    if kind == "plane":
        x = grid((16, 3), (0.0, DX / 2.0))
        where = np.zeros(len(x), np.int64)
        mass = np.full(len(x), DX**2)
        options = {"walls": (Wall((0.0, 0.0, 0.0), (*(np.array([0.0, 2.0]) @ spin[:2, :2]), 0.0), friction),)}
    else:
        block, wall = grid((16, 3), (0.0, 0.2 if kind == "potential" else 0.1175)), grid((46, 1), (-0.5, 0.0), 0.071)
        x = np.concatenate((block, wall))
        where = np.repeat([0, 1], (len(block), len(wall)))
        mass = np.where(where == 0, DX**2, 0.071**2)
        fixed = np.repeat(where[:, None] == 1, 3, axis=1)
        options = {
            "fixed": fixed, "friction": friction, "contact_by_normals": True, "potential": kind == "potential",
            "pinball": 1.0 if kind == "pinball" else None,
        }  # fmt: skip
    options |= {
        "dimension": 2, "x": x @ spin, "v": np.zeros_like(x), "mass": mass, "h": np.full(len(x), 0.12), "end_time": 9.0,
        "density": np.ones(len(x)), "body": where, "bodies": tuple(body(k + 1) for k in range(where.max() + 1)),
        "body_curve": (np.array([0.0, 4.0, 6.0]), fall @ spin), "contact_damping": damping, "step_option": 1,
    }  # fmt: skip
    solver = Solver(Problem(**options | changes))
    solver.advance(6.0, 10**7)
    return solver


def pace(solver: Solver, span: float = 1.0) -> tuple[float, float]:
    """Mean acceleration and way along x of the block, over a time from now on."""
    before, x = velocity(solver)[0], solver.frame().particles["position"][:48, 0].mean()
    solver.advance(solver.time + span, 10**7)
    moved = solver.frame().particles["position"][:48, 0].mean() - x
    return float(velocity(solver)[0] - before) / span, float(moved)


@pytest.mark.parametrize("kind", mostly_slow("plane", *LAWS))
@pytest.mark.parametrize("angle", [5, 10, 15, 20, 25])
def test_a_block_on_an_incline_sticks(kind: str, angle: float) -> None:
    """tan 25 degrees = 0.466 < 0.5; on a wall of particles the block's ends hold less, and 24 degrees are held."""
    angle = min(angle, 24.0) if kind == "potential" else angle
    solver = slope(kind, angle, FRICTION)
    moved = pace(solver, 2.0)[1]
    assert abs(moved) < 0.01 * 0.12  # creep, in units of h


@pytest.mark.parametrize("kind", mostly_slow("potential", "plane", "pinball"))
@pytest.mark.parametrize("angle", [30, 35, 40])
def test_a_block_on_an_incline_slides_as_coulomb_says(kind: str, angle: float) -> None:
    a = math.radians(angle)
    solver = slope(kind, angle, FRICTION)
    wanted = math.sin(a) - 0.4 * math.cos(a)
    assert pace(solver)[0] == pytest.approx(wanted, rel=0.03)


@pytest.mark.parametrize("kind", mostly_slow("plane", *LAWS))
def test_the_weight_of_a_block_at_rest_is_the_force_on_it(kind: str) -> None:
    solver = slope(kind, 0.0, FRICTION)
    rows = [solver.history()["contact_force_y"] for _ in range(50) if solver.advance(solver.time + 0.02, 10**6) is None]
    assert np.mean(rows) == pytest.approx(48 * DX**2, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["plane", *LAWS])
def test_friction_off_and_on_changes_nothing_else(kind: str) -> None:
    states = [slope(kind, 10.0, f).frame().particles["position"][:48] for f in (None, Coulomb(0.0, 0.0))]
    assert np.allclose(*states, atol=1e-6 * DX)  # the same but for round-off
    assert states[0][:, 0].mean() > 0.85  # it slides


def test_an_incline_may_lie_anyhow() -> None:
    ways = []
    for turn in (0.0, 0.7):
        solver = slope("potential", 40.0, FRICTION, turn=turn)
        ways.append(np.linalg.norm(velocity(solver)))
    assert ways[1] == pytest.approx(ways[0], rel=0.01)


@pytest.mark.slow
def test_fluid_friction_drags_by_the_surface_in_contact() -> None:
    """Two plates that slide on each other: each is braked by b times their slip over the surface where they meet."""
    upper, lower = grid((20, 3), (0.0, 0.2)), grid((20, 3), (0.0, -0.2))
    x = np.concatenate((lower, upper))
    n = len(upper)
    v = np.zeros_like(x)
    v[:n, 0], v[n:, 0] = -0.05, 0.05
    problem = meeting(
        "potential", x=x, v=v, mass=np.full(2 * n, DX**2), h=np.full(2 * n, 0.12), density=np.ones(2 * n),
        body=np.repeat([0, 1], n), friction=Drag(0.2), contact_by_normals=True,
        body_curve=None,
    )  # fmt: skip
    solver = Solver(problem)
    solver.advance(0.02, 10**6)
    force = (velocity(solver)[0] + 0.05) * n * DX**2 / 0.02
    assert force == pytest.approx(0.2 * 0.1 * 20 * DX, rel=0.05)  # its reaction on the slip: 2 %
    assert solver.history()["contact_dissipated"] == pytest.approx(force * 0.1 * 0.02, rel=0.05)


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize(("density", "young"), [(1000.0, YOUNG), (1.0, 1e6 * YOUNG), (1000.0, 1e6 * YOUNG)])
def test_bodies_that_differ_much_stay_stable(kind: str, density: float, young: float) -> None:
    hard = Elastic.from_engineering(young, 0.3)
    problem = meeting(kind, n=5, gap=1.9 if kind == "potential" else 1.21, friction=FRICTION)
    other = body(2, hard, density)
    other = dataclasses.replace(other, strength=body(1).strength)
    heavy = problem.body == 1
    problem = dataclasses.replace(
        problem, bodies=(body(1), other), mass=np.where(heavy, density, 1.0) * problem.mass,
        density=np.where(heavy, density, 1.0),
    )  # fmt: skip
    solver = Solver(problem)
    rows = [solver.history() for _ in range(4000) if solver.advance(3.0, 10) is None]
    assert max(abs(row["contact_energy"]) for row in rows) > 0.1 * 0.5 * 25 * DX**2 * 0.1**2  # they have met
    assert solver.energy_report()["balance_error"] < 0.05
    assert np.abs(solver.frame().particles["velocity"]).max() < 0.5


@pytest.mark.parametrize("kind", LAWS)
def test_coincident_particles_of_two_bodies_are_named(kind: str) -> None:
    problem = meeting(kind)
    x = problem.x.copy()
    x[40] = x[7]
    with pytest.raises(Diverged, match=r"particles \d+ and \d+ of two bodies") as caught:
        Solver(dataclasses.replace(problem, x=x)).advance(1.0, 1000)
    assert caught.value.item in (8, 41)


@pytest.mark.parametrize("kind", [*LAWS, "plane"])
def test_nothing_passes_at_three_times_the_speed_of_sound(kind: str) -> None:
    speed = 1.5 * C
    if kind == "plane":
        problem = meeting("potential", speed=2.0 * speed, n=8)
        keep = problem.body == 0
        n = int(keep.sum())
        problem = dataclasses.replace(
            problem, x=problem.x[keep], v=problem.v[keep], mass=problem.mass[:n], h=problem.h[:n],
            body=problem.body[:n], density=problem.density[:n], bodies=(body(1),), potential=False,
            walls=(Wall((0, 0, 0), (-1, 0, 0)),),
        )  # fmt: skip
    else:
        problem = meeting(kind, speed=speed, n=8)
        if kind == "pinball":
            problem = dataclasses.replace(problem, pinball=200.0)
    solver = Solver(problem)
    for _ in range(40):
        try:
            solver.advance(solver.time + 0.05 * 0.8 / speed, 10**6)
        except Diverged:
            break  # an elastic solid at such a strain may tear; it must not have been passed before
        frame = solver.frame().particles
        left = frame["position"][frame["material"] == 1, 0]
        if kind == "plane":
            assert left.max() < DX
        else:
            right = frame["position"][frame["material"] == 2, 0]
            assert left.mean() < right.mean()
            assert np.mean(left < np.median(right)) > 0.95
    assert solver.step > 20


def test_a_rigid_body_of_stiff_matter_does_not_shorten_the_step() -> None:
    stiff = Elastic.from_engineering(1e6 * YOUNG, 0.3)
    problem = meeting("potential")
    fixed = np.repeat(problem.body[:, None] == 1, 3, axis=1)
    steps = [
        Solver(
            dataclasses.replace(problem, fixed=f, bodies=(body(1), dataclasses.replace(body(2, stiff), strength=1.0)))
        ).dt
        for f in (fixed, None)
    ]
    assert steps[0] == pytest.approx(0.8 * 0.12 / (C + 0.1), rel=1e-9)
    assert steps[1] < 0.01 * steps[0]


@pytest.mark.slow
def test_a_wall_pushes_on_one_side_only_and_pulls_nothing() -> None:
    """A block thrown against a plane comes back with its energy; one behind flies on."""
    n = 6
    x = grid((n, n), (0.3, 0.0))
    v = np.zeros_like(x)
    v[:, 0] = -0.5
    problem = Problem(
        dimension=2, x=x, v=v, mass=np.full(n * n, DX**2), h=np.full(n * n, 0.12), density=np.ones(n * n),
        body=np.zeros(n * n, np.int64), bodies=(body(1),), end_time=1.0, step_factor=0.2, step_option=1,
        walls=(Wall((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)),),
    )  # fmt: skip
    solver = Solver(problem)
    rows = through(solver, 2.0)
    assert velocity(solver)[0] > 0.4
    assert max(row["contact_energy"] for row in rows) > 1e-2 * 0.5 * 0.36 * 0.25
    assert rows[-1]["contact_energy"] == pytest.approx(0.0, abs=1e-3 * 0.045)
    assert rows[-1]["contact_force_x"] == 0.0
    assert solver.energy_report()["balance_error"] < 2e-3
    assert "contact: none, 1 wall(s)" in solver.kernels()


@pytest.mark.parametrize("kind", ["plane", "potential"])
def test_threads_and_restart_change_no_bit(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("zrno.solvers.sph.solver.SMALL", 0)
    monkeypatch.setattr("zrno.solvers.sph.step.CHUNK", 16)
    solvers = [slope(kind, 28.0, FRICTION) for _ in range(2)]
    problem = solvers[0].problem
    other = Solver(problem, threads=2)
    other.advance(6.0, 10**7)
    again = Solver(problem)
    again.restore(solvers[0].checkpoint())
    assert again.history() == solvers[0].history()
    for solver in (solvers[0], other, again):
        solver.advance(7.0, 10**7)
    assert solvers[0].history()["contact_dissipated"] > 0.0
    for solver in (other, again):
        assert solver.history() == solvers[0].history()
        for name, values in solver.frame().particles.items():
            assert np.array_equal(values, solvers[0].frame().particles[name]), name


def test_one_body_has_no_contact_and_two_no_friction_unless_asked() -> None:
    alone = meeting("potential")
    one = dataclasses.replace(alone, body=np.zeros(72, np.int64), bodies=(body(1),), potential=False)
    bare = Solver(one)
    arguments = contact_module.contact_of(one, bare._shape)
    assert (arguments.law, arguments.friction, arguments.damping, arguments.walls, arguments.normals) == (None,) * 5
    for name in ("c", "contact_work", "contact_heat", "slip", "wall_slip", "colour", "mobilised"):
        assert len(bare._state.rows(name)) == 0
    two = Solver(alone)
    assert len(two._state.rows("c")) == 2
    assert len(two._state.rows("slip")) == len(two._state.rows("colour")) == 0


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        ({"potential": False, "friction": FRICTION}, "friction"),
        ({"pinball": 1.0}, "pinball"),
        ({"contact_damping": 2.0}, "damping"),
        ({"potential": False, "contact_by_normals": True}, "normals"),
        ({"friction": Drag(1.0), "friction_between": ((0, 1, FRICTION),)}, "fluid friction"),
    ],
)
def test_contact_that_makes_no_sense_is_refused(change: dict[str, Any], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        meeting("potential", **change)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["plane", "potential"])
def test_a_block_slides_in_space_as_in_the_plane(kind: str) -> None:
    """Down a slope of 35 degrees, askew to the lattice."""
    a, way = math.radians(35.0), np.array([0.8, 0.6, 0.0])
    down = np.array([0.0, 0.0, -1.0])
    fall = np.array([down, down, math.sin(a) * way + math.cos(a) * down])
    x = grid((10, 8, 2), (0.0, 0.0, DX / 2.0 if kind == "plane" else 0.19))
    n = len(x)
    if kind == "plane":
        options: dict[str, Any] = {"walls": (Wall((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), FRICTION),), "potential": False}
    else:
        x = np.concatenate((x, grid((22, 20, 1), (-0.25, -0.25, 0.0), 0.071)))
        options = {"friction": FRICTION, "contact_by_normals": True}
    where = np.repeat([0, 1], (n, len(x) - n))
    options |= {
        "x": x, "v": np.zeros_like(x), "mass": np.where(where == 0, DX**3, 0.071**3), "h": np.full(len(x), 0.12),
        "density": np.ones(len(x)), "body": where, "bodies": tuple(body(k + 1) for k in range(where.max() + 1)),
        "fixed": np.repeat(where[:, None] == 1, 3, axis=1), "contact_damping": 0.3,
        "body_curve": (np.array([0.0, 1.5, 2.5]), fall),
    }  # fmt: skip
    solver = Solver(meeting("potential", dimension=3, **options))
    solver.advance(2.5, 10**7)
    before = velocity(solver)
    solver.advance(3.1, 10**7)
    gained = (velocity(solver) - before) / 0.6
    assert gained @ way == pytest.approx(math.sin(a) - 0.4 * math.cos(a), rel=0.03)
    assert abs(gained[:2] @ [-0.6, 0.8]) < 0.01


@pytest.mark.slow
def test_half_of_a_symmetric_scene_is_as_good_as_the_whole() -> None:
    """A block pressed on a wider one, cut by a symmetry plane through both: friction sees the images."""
    upper, lower = grid((8, 3), (-0.35, 0.19)), grid((14, 3), (-0.65, -0.2))
    x = np.concatenate((upper, lower))
    where = np.repeat([0, 1], (len(upper), len(lower)))
    v = np.zeros_like(x)
    v[:, 0] = np.where(where == 0, -0.3, 0.3) * x[:, 0]  # one is squeezed, the other stretched
    v[:, 1] = np.where(where == 0, -0.1, 0.1)
    states = []
    for half in (False, True):
        keep = x[:, 0] > 0.0 if half else np.ones(len(x), bool)
        n = int(keep.sum())
        planes = (ghosts.Plane(0, -1, ghosts.SYMMETRY, 0.0),) if half else ()
        problem = meeting(
            "potential", x=x[keep], v=v[keep], mass=np.full(n, DX**2), h=np.full(n, 0.12), density=np.ones(n),
            body=where[keep], id=np.flatnonzero(keep) + 1, planes=planes, **RUBBED,
        )  # fmt: skip
        solver = Solver(problem)
        solver.advance(0.3, 10**6)
        assert solver.history()["contact_dissipated"] > 0.0
        frame = solver.frame().particles
        states.append(frame["velocity"][frame["position"][:, 0] > 0.0])
    assert np.allclose(*states, atol=1e-8)
