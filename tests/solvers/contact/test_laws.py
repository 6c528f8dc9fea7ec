"""Contact laws alone, a pair at a time, against the formulas as printed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from zrno.solvers.contact.friction import Coulomb, Drag, follow, stick_or_slide, turned_into
from zrno.solvers.contact.law import repulsion
from zrno.solvers.contact.pinball import Pinball, PinballImpact
from zrno.solvers.contact.plane import Wall, wall_push
from zrno.solvers.contact.potential import matching_strength, potential
from zrno.solvers.jit import kernel
from zrno.solvers.sph.smoothing import Cubic, normaliser, shape_of, value_at


@kernel
def pair(law, shape, r, h_i, h_j, m_i, m_j, rho_i, rho_j, i, j, rate, dt):
    """Force between two points at a distance r that grows at a rate, and the stiffness."""
    push, stiffness = repulsion(law, shape, r * r, h_i, h_j, m_i, m_j, rho_i, rho_j, i, j, -rate * r, dt)
    return push * r, stiffness


CUBIC = Cubic()
STRENGTH, EXPONENT = (3.0, 5.0), (2.0, 3.0)
MODULUS = np.array([2.0, 7.0])


def kernel_value(r: float, h: float, dimension: int) -> float:
    return normaliser(CUBIC, dimension) / h**dimension * value_at(CUBIC, r / h)


@pytest.mark.parametrize("dimension", [1, 2, 3])
@pytest.mark.parametrize("r", [0.3, 0.9, 1.4, 2.1])
def test_the_potential_is_the_gradient_of_one(dimension: int, r: float) -> None:
    """F = -dU/dr of U = m m (K + K) W(h) f^(n+1)/(n+1), f = W(r)/W(h)."""
    law = potential(CUBIC, dimension, STRENGTH, EXPONENT)
    h, n = 0.5 * (1.0 + 1.2), 2.5

    def energy(at: float) -> float:
        reference = kernel_value(h, h, dimension)
        return 2.0 * 3.0 * 8.0 * reference * (kernel_value(at, h, dimension) / reference) ** (n + 1.0) / (n + 1.0)

    force, stiffness = pair(law, CUBIC, r, 1.0, 1.2, 2.0, 3.0, 1.0, 1.0, 0, 1, 0.0, 0.0)
    assert force == pytest.approx((energy(r - 1e-5) - energy(r + 1e-5)) / 2e-5, rel=1e-6)
    assert pair(law, CUBIC, r, 1.2, 1.0, 3.0, 2.0, 1.0, 1.0, 1, 0, 0.0, 0.0)[0] == pytest.approx(force, rel=1e-14)
    softer = pair(law, CUBIC, r + 1e-6, 1.0, 1.2, 2.0, 3.0, 1.0, 1.0, 0, 1, 0.0, 0.0)[0]
    assert stiffness > 0.9 * (force - softer) / 1e-6  # safe for the time step
    assert pair(law, CUBIC, 2.3, 1.0, 1.2, 2.0, 3.0, 1.0, 1.0, 0, 1, 0.0, 0.0)[0] == 0.0


def test_the_matching_strength_gives_the_pressure_of_the_wave_at_one_smoothing_length() -> None:
    """The force m m (K + K) f^n W' is that of a pressure p in both bodies, m m 2 p/rho^2 W', with p = rho c^2."""
    assert 2.0 * matching_strength(3.0, 2.0) == pytest.approx(2.0 * (2.0 * 3.0**2) / 2.0**2)


def balls(r: float, h_i: float, h_j: float, g_i: float, g_j: float) -> float:
    """[T] 5.3.1, 5.3.4."""
    overlap = (h_i + h_j) / 2.0 - r
    radius_i, radius_j = h_i / 2.0, h_j / 2.0
    return g_i * g_j / (g_i + g_j) * math.sqrt(radius_i * radius_j / (radius_i + radius_j)) * max(0.0, overlap) ** 1.5


@pytest.mark.parametrize("flat", [0, 1, 2])
@pytest.mark.parametrize("r", [0.2, 0.8, 1.05, 1.2])
def test_the_pinball_is_the_formula(flat: int, r: float) -> None:
    law = Pinball(1.0, 4.0, MODULUS, flat)
    wanted = 4.0 * balls(r, 1.0, 1.2, 2.0, 7.0) / 1.1**flat
    force, stiffness = pair(law, CUBIC, r, 1.0, 1.2, 2.0, 3.0, 1.0, 1.0, 0, 1, -1.0, 0.1)
    assert force == pytest.approx(wanted, rel=1e-12, abs=1e-300)
    assert pair(law, CUBIC, r, 1.2, 1.0, 3.0, 2.0, 1.0, 1.0, 1, 0, 1.0, 0.1)[0] == pytest.approx(wanted, rel=1e-12)
    slope = (wanted - pair(law, CUBIC, r + 1e-7, 1.0, 1.2, 2.0, 3.0, 1.0, 1.0, 0, 1, 0.0, 0.0)[0]) / 1e-7
    assert stiffness == pytest.approx(slope, rel=1e-4, abs=1e-12)


def test_the_pinball_as_printed_is_the_smaller_of_two_forces_and_ends_with_the_approach() -> None:
    law = PinballImpact(1.0, 4.0, MODULUS, 0)
    a, b = 3.0 * 0.5**3, 5.0 * 0.6**3  # rho R^3

    def force(rate: float, dt: float) -> float:
        return float(pair(law, CUBIC, 0.8, 1.0, 1.2, 2.0, 3.0, 3.0, 5.0, 0, 1, rate, dt)[0])

    assert force(-1e-3, 0.1) == pytest.approx(4.0 * a * b / (a + b) * 1e-3 / 0.1, rel=1e-12)
    assert force(-1e3, 0.1) == pytest.approx(4.0 * balls(0.8, 1.0, 1.2, 2.0, 7.0), rel=1e-12)
    assert force(1e-3, 0.1) == 0.0


def slide(speeds: Any, dt: float, k: float, at_rest: float, in_motion: float, weakening: float = 0.1) -> Any:
    """Tractions along x of a point whose slip speed is given, the work done on them, and the heat."""
    elastic = slid = work = heat = 0.0
    tractions = []
    for speed in speeds:
        t, _, _, elastic, _, _, slid, lost = stick_or_slide(
            elastic, 0.0, 0.0, speed, 0.0, 0.0, dt, k, 0.0, at_rest, in_motion, weakening, slid
        )
        tractions.append(t)
        work += t * speed * dt
        heat += lost
    return np.array(tractions), work, heat, elastic


def test_a_point_sticks_as_a_spring_and_gives_its_work_back() -> None:
    speeds = 0.01 * np.cos(np.linspace(0.0, math.pi, 2001))  # there and back
    tractions, work, heat, elastic = slide(speeds, 1e-3, 50.0, 1.0, 0.5)
    assert np.allclose(tractions, 50.0 * 1e-3 * np.cumsum(speeds), atol=1e-12)
    assert tractions.max() < 1.0
    assert abs(heat) < 1e-5
    assert work == pytest.approx(0.5 * 50.0 * elastic**2 + heat, abs=1e-12)


def test_a_point_slides_at_its_limit_and_warms_by_it() -> None:
    tractions, work, heat, elastic = slide(np.full(1000, 1.0), 1e-3, 50.0, 1.0, 0.6)
    assert tractions.max() == pytest.approx(1.0, abs=0.02)
    assert np.all(tractions[200:] == pytest.approx(0.6))
    assert work == pytest.approx(heat + 0.5 * 50.0 * elastic**2, rel=1e-12)
    weaker = 0.4 * 0.1 / 2.0  # what the way down from rest to motion costs above the friction of motion
    assert heat == pytest.approx(0.6 * 1.0 + weaker, rel=0.02)


def test_bodies_that_part_as_soon_as_they_meet_have_no_friction() -> None:
    """No load, no spring: once the traction of the dashpot alone was divided by its stiffness of nothing."""
    found = stick_or_slide(0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 1e-3, 0.0, 0.3, 0.0, 0.0, 0.1, 0.0)
    assert found == (0.0,) * 8


def test_friction_is_that_of_rest_again_once_the_slip_has_turned() -> None:
    speeds = np.concatenate((np.full(500, 1.0), np.full(500, -1.0)))
    tractions = slide(speeds, 1e-3, 50.0, 1.0, 0.6)[0]
    assert tractions[499] == pytest.approx(0.6)
    assert tractions.min() == pytest.approx(-1.0, abs=0.02)


def test_elastic_slip_turns_with_the_normal_at_its_length() -> None:
    n = np.array([0.0, 0.6, 0.8])
    turned = np.array(turned_into(0.3, 0.0, 0.4, *n))
    assert abs(turned @ n) < 1e-15
    assert np.linalg.norm(turned) == pytest.approx(0.5, rel=1e-14)
    assert turned_into(0.0, 0.0, 0.0, *n) == (0.0, 0.0, 0.0)


def test_the_load_of_friction_follows_the_force() -> None:
    load = 0.0
    for _ in range(1000):
        load = follow(load, 3.0, 0.01, 10.0, 0.1)
    assert load == pytest.approx(3.0)
    assert 0.0 < follow(0.0, 3.0, 0.01, 10.0, 0.1) < 1.0


def test_a_wall_pushes_only_and_without_a_step() -> None:
    assert wall_push(-0.1, 0.5, 7.0) == (0.0, 0.0)
    force, stiffness = wall_push(0.25, 0.5, 8.0)
    assert force == pytest.approx(8.0 * 0.25 * 1.25)
    assert stiffness == pytest.approx((wall_push(0.25 + 1e-7, 0.5, 8.0)[0] - force) / 1e-7, rel=1e-5)


@pytest.mark.parametrize(
    ("make", "wrong"),
    [
        (lambda: Coulomb(0.3, 0.4), "static"),
        (lambda: Coulomb(math.nan, 0.1), "static"),
        (lambda: Coulomb(0.3, -0.1), "static"),
        (lambda: Drag(-1.0), "fluid friction"),
        (lambda: Wall((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), "normal"),
        (lambda: Wall((math.nan, 0.0, 0.0), (0.0, 0.0, 1.0)), "position"),
    ],
)
def test_numbers_that_are_none_are_refused(make: Any, wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        make()


def test_every_kernel_has_a_potential() -> None:
    for name in ("quintic", "gaussian", "wendland_c2", "lucy"):
        shape = shape_of(name, 2)
        law = potential(shape, 2, STRENGTH, EXPONENT)
        near, far = (
            pair(law, shape, r * shape.support, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0, 1, 0.0, 0.0)[0] for r in (0.3, 0.6)
        )
        assert near > far > 0.0
