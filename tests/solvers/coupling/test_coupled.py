"""A block of particles and a plate of shells: what one gives the other receives."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from coupled_scenes import DENSITY, HARD, SIDE, SPACING, THICKNESS, block, drop, facing, layer, momentum, plate
from scipy.optimize import curve_fit

from zrno.solvers import fem
from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.sph import Cures
from zrno.solvers.threads import available

SPEED = 2.0
STEPS = 60
RUBBED = Coulomb(0.5, 0.4)
GRAVITY = 0.00981


def run(coupled, steps=STEPS):
    for _ in range(steps):
        coupled.advance(math.inf, 1)
    return coupled


@pytest.fixture(scope="module")
def bounced():
    """Dropped on a clamped plate and iterated; the block has left it again."""
    return run(drop(plate(steps=STEPS), facing(plate(), gap=1.55, speed=SPEED), tolerance=1e-3))


def test_the_drop_keeps_momentum_and_energy(bounced):
    start = momentum(drop(plate(), facing(plate(), gap=1.55, speed=SPEED)))
    row = bounced.history()
    assert row["momentum_z"] > 1.0  # it has bounced
    assert np.abs(momentum(bounced) - start).max() < 1e-12 * abs(start[2])
    assert bounced.energy_report()["balance_error"] < 0.01
    assert abs(row["interface_energy"]) < 1e-4 * row["kinetic"]


def test_weak_coupling_keeps_momentum_and_makes_energy():
    """The reason for iterating: the force of the period before is that of another place."""
    weak = drop(plate(steps=STEPS), facing(plate(), gap=1.55, speed=SPEED))
    start = momentum(weak)
    run(weak)
    assert np.abs(momentum(weak) - start).max() < 1e-12 * abs(start[2])
    row = weak.history()
    assert row["interface_energy"] > 0.1 * row["kinetic"]
    made = weak.energy_report()["balance_error"] * row["kinetic"]
    assert made == pytest.approx(row["interface_energy"], rel=0.2)  # that is what the balance lacks


@pytest.mark.parametrize("contact", ["particles", "facets"])
def test_a_free_plate_takes_all_of_the_momentum(contact):
    structure = plate(clamped=False, steps=STEPS)
    friction = Coulomb(0.5, 0.4)
    grain = (
        facing(structure, gap=1.55, speed=SPEED, friction=friction)
        if contact == "facets"
        else block(structure, gap=4.5, speed=SPEED)
    )
    coupled = drop(structure, grain, tolerance=1e-3)
    start = momentum(coupled)
    run(coupled)
    assert coupled.structure.history()["momentum_z"] < -0.01
    assert np.abs(momentum(coupled) - start).max() < 1e-11 * abs(start[2])


@pytest.mark.parametrize("inertia", [True, False])
def test_a_checkpoint_changes_nothing(inertia):
    grain = facing(plate(), gap=1.55, speed=SPEED)
    changes = {} if inertia else {"dynamics": None}
    other = drop(plate(steps=STEPS, **changes), grain, tolerance=1e-3)
    run(other, 30)
    kept = {k: v.copy() if isinstance(v, np.ndarray) else v for k, v in other.checkpoint().items()}
    run(other, 10)
    again = drop(plate(steps=STEPS, **changes), grain, tolerance=1e-3)
    again.restore(kept)
    run(again, 10)
    one, two = other.frame(), again.frame()
    for name, values in one.particles.items():
        assert np.array_equal(values, two.particles[name]), name
    assert np.array_equal(one.nodes["displacement"], two.nodes["displacement"])
    assert other.history() == again.history()
    assert other.energy_report() == again.energy_report()


def test_threads_change_nothing():
    """2197 particles, so that they are shared out, rub on a plate that gives way: the same bits by one and two."""
    wide = plate(steps=STEPS)
    x = wide.x.copy()
    x[:, :2] = 8.0 + 2.0 * (x[:, :2] - 8.0)
    wide = dataclasses.replace(wide, x=x)
    grain = facing(wide, gap=0.5, speed=SPEED, side=13, friction=RUBBED)
    grain.v[:, 0] = SPEED
    one, two = (run(drop(wide, grain, threads=count), 8) for count in (1, 2))
    assert (one.particles.threads, two.particles.threads) == (1, min(2, available()))
    assert one.history()["structure_force_x"] != 0.0
    assert one.history() == two.history()
    for name, values in one.frame().particles.items():
        assert np.array_equal(values, two.frame().particles[name]), name


def test_the_force_at_rest_is_the_weight():
    """A block let down on a rigid plate: the plate bears it, and nothing is solved."""
    structure = dataclasses.replace(plate(steps=400, period=0.25), rigid=True, dynamics=None)
    grain = dataclasses.replace(facing(structure, gap=0.5), body_force=(0.0, 0.0, -0.00981), relaxation=0.98)
    grain.v[:] = 0.0
    coupled = run(drop(structure, grain, area=np.full(len(structure.x), 4.0)), 200)
    weight = 64 * DENSITY * 8.0 * 0.00981
    assert coupled.history()["structure_force_z"] == pytest.approx(-weight, rel=0.005)
    assert coupled.structure.guided
    assert coupled.pending.max() == 0.0
    nodes = coupled.frame().nodes
    assert nodes["contact_force"][:, 2].sum() == pytest.approx(-weight, rel=0.005)
    assert np.allclose(nodes["contact_pressure"], np.linalg.norm(nodes["contact_force"], axis=1) / 4.0, rtol=1e-14)


def test_a_linear_structure_without_inertia_is_seen_when_it_is_asked_for():
    """Its elements are evaluated for frames and checkpoints alone, and show what they did when seen every period."""
    rows, stresses = [], []
    for seen in (1, 7):
        structure = plate(dynamics=None, steps=STEPS)
        coupled = drop(structure, facing(plate(), gap=0.5, speed=SPEED), relaxation=0.2)
        for k in range(21):
            coupled.advance(math.inf, 1)
            if (k + 1) % seen == 0:
                frame = coupled.structure.frame()
        rows.append(coupled.structure.energies())
        stresses.append(frame.nodes["stress"])
        coupled.advance(math.inf, 1)
        before = coupled.structure.energies()
        coupled.structure.frame()
        after = coupled.structure.energies()
        assert before["internal"] > 1e-6
        assert after["internal"] == pytest.approx(before["internal"], rel=1e-9)  # by forces and by stresses
    assert np.abs(stresses[1] - stresses[0]).max() < 1e-9 * np.abs(stresses[0]).max()
    assert rows[1]["internal"] == pytest.approx(rows[0]["internal"], rel=1e-9)
    assert rows[1]["external_work"] == pytest.approx(rows[0]["external_work"], rel=1e-9)


def test_a_rigid_structure_turns_as_its_nodes_are_moved():
    """One edge held, the other lifted: the plate turns as a whole, about the edge that is held."""
    structure = plate(clamped=False)
    low, high = np.flatnonzero(structure.x[:, 0] == 0.0), np.flatnonzero(structure.x[:, 0] == SIDE)
    fixed = structure.fixed.copy()
    fixed[low, :3] = True
    angle = 0.3
    motion = fem.Motion(high, np.full(len(high), 2), np.full(len(high), SIDE * math.sin(angle)))
    turned = dataclasses.replace(
        structure, rigid=True, dynamics=None, fixed=fixed, motions=(motion,), steps=((1, 1.0),)
    )
    solver = fem.Solver(turned)
    solver.advance(math.inf, 1)
    x = structure.x + solver.shape.u[:, :3]
    wanted = np.column_stack(
        [structure.x[:, 0] * math.cos(angle), structure.x[:, 1], structure.x[:, 0] * math.sin(angle)]
    )
    assert np.abs(x - wanted).max() < 1e-9 * SIDE


def test_no_grain_passes_a_thin_plate():
    """50 m/s against 2 mm: particles of 2 mm would cross it in 1/25 ms, the structure's step."""
    structure = dataclasses.replace(plate(steps=100, period=0.01), rigid=True, dynamics=None)
    coupled = drop(structure, facing(structure, gap=2.0, speed=50.0, law=HARD))
    run(coupled, 60)
    below = coupled.frame().particles["position"][:, 2] < 0.5 * THICKNESS - 0.5
    assert not below.any()
    assert coupled.history()["momentum_z"] > 0.0


def on_an_incline(degrees: float, friction: Coulomb | None = RUBBED):
    """A block on a wide rigid plate that is tilted from 5 to 25 ms; its motion along the slope from 40 to 60 ms."""
    structure = plate(steps=4000, period=0.5)
    wide = structure.x.copy()
    wide[:, :2] = 8.0 + 40.0 * (wide[:, :2] - 8.0)
    structure = dataclasses.replace(structure, x=wide, rigid=True, dynamics=None)
    angle, times = math.radians(degrees), np.linspace(0.0, 30.0, 31)
    tilt = angle * np.clip((times - 5.0) / 20.0, 0.0, 1.0)
    along, across = GRAVITY * np.sin(tilt), -GRAVITY * np.cos(tilt) * np.clip(times / 5.0, 0.0, 1.0)
    curve = times, np.column_stack([along, np.zeros_like(times), across])
    grain = facing(structure, gap=0.5, friction=friction, contact_damping=0.3, body_curve=curve)
    grain.v[:] = 0.0
    coupled = drop(structure, grain)
    run(coupled, 80)
    before = coupled.frame().particles
    run(coupled, 40)
    arrays = coupled.frame().particles
    faster, way = (float((arrays[k] - before[k])[:, 0].mean()) for k in ("velocity", "displacement"))
    force = coupled.history()["structure_force_z"] / (64 * DENSITY * 8.0 * GRAVITY * math.cos(angle))
    return faster / 20.0, way, force


@pytest.mark.parametrize(
    "degrees", [20.0, 30.0, *(pytest.param(a, marks=pytest.mark.slow) for a in (5, 15, 25, 28, 40))]
)
def test_a_block_on_an_incline(degrees):
    """Sticks below mu_s = tan 26.6 degrees without creep, slides above with g (sin - mu_k cos)."""
    acceleration, way, force = on_an_incline(degrees)
    angle = math.radians(degrees)
    assert force == pytest.approx(-1.0, rel=1e-3)
    if math.tan(angle) < RUBBED.static:
        assert abs(acceleration) < 1e-6 * GRAVITY
        assert abs(way) < 1e-6 * SPACING
    else:
        wanted = GRAVITY * (math.sin(angle) - RUBBED.kinetic * math.cos(angle))
        assert acceleration == pytest.approx(wanted, rel=0.001)


@pytest.mark.slow
def test_without_friction_it_slides_freely():
    acceleration, _, force = on_an_incline(20.0, None)
    assert acceleration == pytest.approx(GRAVITY * math.sin(math.radians(20.0)), rel=0.001)
    assert force == pytest.approx(-1.0, rel=1e-3)


@pytest.mark.slow
def test_what_lies_on_a_plate_that_turns_goes_round_with_it():
    """One edge is lifted: a block that sticks keeps its place on the plate, though its centres lie off it.

    With gradient correction: without it so small a block resists being turned, and stays level on its edge.
    """
    structure = plate(clamped=False, steps=200, period=0.5)
    low, high = np.flatnonzero(structure.x[:, 0] == 0.0), np.flatnonzero(structure.x[:, 0] == SIDE)
    fixed = structure.fixed.copy()
    fixed[low, :3] = True
    rise = fem.Curve(np.array([0.0, 20.0, 80.0, 100.0]), np.array([0.0, 0.0, 1.0, 1.0]))
    sine = 0.25
    motion = fem.Motion(high, np.full(len(high), 2), np.full(len(high), SIDE * sine), 0)
    structure = dataclasses.replace(
        structure, rigid=True, dynamics=None, fixed=fixed, curves=(rise,), motions=(motion,)
    )
    grain = facing(
        structure, gap=0.5, friction=Coulomb(2.0, 2.0), contact_damping=0.3, cures=Cures(correction=True),
        body_force=(0.0, 0.0, -30.0 * GRAVITY),
    )  # fmt: skip
    grain.v[:] = 0.0
    coupled = run(drop(structure, grain), 200)
    arrays = coupled.frame().particles
    start = arrays["position"] - arrays["displacement"]
    along = arrays["position"][:, 0] * math.sqrt(1.0 - sine**2) + arrays["position"][:, 2] * sine
    lowest = start[:, 2] < 2.0
    assert np.abs(along - start[:, 0])[lowest].max() < 0.003 * SPACING


def test_a_plate_lifted_at_10_metres_a_second_keeps_its_block():
    """Up to 10 mm/ms in 8 ms, at up to 200 g: the force is the weight and what speeds the block up, and never gone."""
    period, count = 0.1, 200
    structure = plate(steps=count, period=period)
    every = np.arange(len(structure.x))
    times = period * np.arange(count + 1)
    speed = 10.0 * np.sin(0.5 * math.pi * np.clip((times - 5.0) / 8.0, 0.0, 1.0)) ** 2
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * period)])
    lift = fem.Motion(every, np.full(len(every), 2), np.ones(len(every)), 0)
    structure = dataclasses.replace(
        structure, rigid=True, dynamics=None, curves=(fem.Curve(times, way),), motions=(lift,),
        fixed=np.zeros_like(structure.fixed),
    )  # fmt: skip
    grain = facing(structure, gap=0.5, contact_damping=0.3, body_force=(0.0, 0.0, -GRAVITY))
    grain.v[:] = 0.0
    coupled = drop(structure, grain)
    force = np.zeros(count)
    for k in range(count):
        coupled.advance(math.inf, 1)
        force[k] = -coupled.force[:, 2].sum()
    mass, now = 64 * DENSITY * 8.0, times[1:]
    wanted = mass * (GRAVITY + np.gradient(speed, times)[1:])
    going = (now > 5.0) & (now <= 13.0)
    assert force[going].min() > 0.0
    assert np.abs(force - wanted).max() < 0.04 * wanted.max()  # what rings is the block
    assert force[now > 15.0].mean() == pytest.approx(mass * GRAVITY, rel=0.05)
    assert coupled.frame().particles["velocity"][:, 2] == pytest.approx(10.0, rel=2e-3)


def loaded(ratio, *, periods, **exchange):
    """A plate under a layer of grain of `ratio` times its mass, let go: (coupled, period of the plate that carries it,
    times, deflections of its middle)."""
    heavy = plate(dynamics=None, modes=1, steps=((1, 1.0),))
    elements = (dataclasses.replace(heavy.elements[0], density=DENSITY * (1.0 + ratio)),)
    modes = fem.Solver(dataclasses.replace(heavy, elements=elements))
    modes.advance(math.inf, 1)
    period = 1.0 / modes.procedure.frequency
    mass = DENSITY * ratio * THICKNESS * SPACING**2
    structure = plate(period=period / 60, steps=60 * periods)
    grain = layer(structure, ratio, stiffness=mass * (10.0 * 2.0 * math.pi / period) ** 2, gravity=50.0)
    coupled = drop(structure, grain, **exchange)
    middle = int(np.argmin(np.abs(structure.x[:, :2] - 0.5 * SIDE).sum(axis=1)))
    times, found = [0.0], [0.0]
    for _ in range(60 * periods):
        coupled.advance(math.inf, 1)
        times.append(coupled.time)
        found.append(coupled.structure.shape.u[middle, 2])
    return coupled, period, np.array(times), np.array(found)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.1, 0.3, 1.0, 3.0, 10.0])
def test_a_plate_that_carries_grain_has_the_period_of_its_added_mass(ratio):
    """Strong coupling at ratios of mass of 0.1 to 10: the grain rides on the plate."""
    _, period, t, u = loaded(ratio, periods=3, tolerance=1e-3)

    def wave(t, mean, size, omega, phase):
        return mean + size * np.cos(omega * t + phase)

    fit, _ = curve_fit(wave, t, u, p0=[u.mean(), -u.mean(), 2.0 * math.pi / period, 0.1])
    assert 2.0 * math.pi / abs(fit[2]) == pytest.approx(period, rel=0.02)
    assert -2.5 < u.min() / abs(u.mean()) < -1.5  # from rest to twice the static sag


@pytest.mark.slow
def test_weak_coupling_fails_under_grain_heavier_than_the_plate():
    """Its limit: what is documented, and why strong coupling is there."""
    light, heavy = (np.abs(loaded(ratio, periods=3)[3]).max() for ratio in (0.1, 10.0))
    steady = [np.abs(loaded(ratio, periods=3, tolerance=1e-3)[3]).max() for ratio in (0.1, 10.0)]
    assert light < 1.3 * steady[0]
    assert heavy > 50.0 * steady[1]
