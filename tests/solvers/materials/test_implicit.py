"""Laws for finite elements against closed forms (reference/fem/material_point.csv names the rows), and random paths."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from zrno.solvers import materials as laws
from zrno.solvers.materials.point import Path, Point, drive

E, NU = 210000.0, 0.3
LATERAL = (False, True, True, False, False, False)


def equivalent(s: np.ndarray) -> np.ndarray:
    xx, yy, zz, xy, yz, zx = s.T
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + zx**2))


def bar(law: Any, strains: np.ndarray, **more: Any) -> Path:
    """A law pulled along x to each of the strains, without stress across."""
    steps = np.zeros((len(strains), 6))
    steps[:, 0] = np.diff(strains, prepend=0.0)
    return Point(law, **more).hold(steps, LATERAL, np.zeros((len(strains), 6)))


def test_j2_1_linear_hardening_in_tension() -> None:
    h = 2000.0
    e = np.linspace(0.0, 0.02, 21)[1:]
    stress = bar(laws.von_mises(E, NU, 250.0, E * h / (E + h)), e).stress[:, 0]
    wanted = np.where(e > 250.0 / E, 250.0 + E * h / (E + h) * (e - 250.0 / E), E * e)
    np.testing.assert_allclose(stress, wanted, rtol=1e-9)


@pytest.mark.parametrize("curve", ["linear", "power", "table"])
@pytest.mark.parametrize("beta", [0.0, 0.3, 1.0])
def test_j2_2_reverse_yield(beta: float, curve: str) -> None:
    """smax - 2 (sy + b (smax - sy)), b the isotropic share: also of curves."""
    shear = E / 2.6
    hardening = {"linear": laws.Linear(250.0, 2000.0), "power": laws.power(250.0, 300.0, 0.5),
                 "table": laws.table([[0.0, 250.0], [0.004, 300.0], [0.5, 500.0]], shear)}[curve]  # fmt: skip
    law = laws.von_mises_curve(E, NU, hardening, beta)
    up = bar(law, np.linspace(0.0, 0.01, 6)[1:])
    top, ep = up.stress[-1, 0], up.state[-1, 0]
    y = {"linear": 250.0 + 2000.0 * ep, "power": 250.0 + 300.0 * math.sqrt(ep),
         "table": float(np.interp(ep, [0.0, 0.004, 0.5], [250.0, 300.0, 500.0]))}[curve]  # fmt: skip
    assert top == pytest.approx(y, rel=1e-9)
    turn = top - 2.0 * (250.0 + beta * (top - 250.0))
    back = 0.01 - (top - turn) / E
    before, after = (bar(law, np.array([0.002, 0.004, 0.006, 0.008, 0.01, back + d])) for d in (1e-7, -1e-7))
    assert before.state[-1, 0] == before.state[-2, 0]
    assert after.state[-1, 0] > after.state[-2, 0]
    assert before.stress[-1, 0] == pytest.approx(turn, abs=1e-7 * E * 2)


def test_j2_3_simple_shear() -> None:
    strain = np.zeros((20, 6))
    strain[:, 3] = 0.001
    stress = drive(laws.von_mises(E, NU, 250.0), strain).stress[-1]
    assert stress == pytest.approx([0.0, 0.0, 0.0, 250.0 / math.sqrt(3.0), 0.0, 0.0], abs=1e-9)


def test_a_power_of_one_is_linear_and_a_power_is_met_exactly() -> None:
    strain = np.random.default_rng(6).normal(size=(300, 6)) * 0.01
    for beta in (0.4, 1.0):
        wanted = drive(laws.von_mises(200.0, NU, 1.0, 200.0 * 20.0 / 220.0, beta), strain)
        path = drive(laws.von_mises_curve(200.0, NU, laws.power(1.0, 20.0, 1.0), beta), strain)
        for got, expected in zip(path, wanted, strict=True):
            assert got == pytest.approx(expected, rel=1e-9, abs=1e-12)
    for n in (0.1, 0.5, 1.6):
        path = drive(laws.von_mises_curve(200.0, NU, laws.power(1.0, 20.0, n)), strain)
        assert equivalent(path.stress).max() <= 1.0 + 20.0 * path.state[-1, 0] ** n + 1e-9
        flows = np.diff(path.state[:, 0], prepend=0.0) > 0.0
        assert equivalent(path.stress[flows]) == pytest.approx(1.0 + 20.0 * path.state[flows, 0] ** n, rel=1e-11)


def test_ramberg_and_osgood() -> None:
    """e = s/E + 0.002 (s/s0)^n, at any stress."""
    law = laws.von_mises_curve(E, NU, laws.ramberg_osgood(E, 300.0, 8.0))
    wanted = np.array([30.0, 150.0, 300.0, 450.0])
    path = bar(law, wanted / E + 0.002 * (wanted / 300.0) ** 8)
    np.testing.assert_allclose(path.stress[:, 0], wanted, rtol=1e-8)


CURVES = {
    "power": laws.power(1.0, 3.0, 0.3), "steep power": laws.power(1.0, 3.0, 1.7),
    "Ramberg-Osgood": laws.ramberg_osgood(200.0, 1.0, 6.0),
    "table": laws.table([[0.0, 1.0], [0.02, 1.6], [0.1, 1.8], [0.5, 1.7]], 76.9),
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "beta"),
    [(name, beta) for name in CURVES for beta in (0.0, 0.4) if (name, beta) != ("Ramberg-Osgood", 0.0)],
)
def test_random_increments_of_curves_with_back_stress(name: str, beta: float, wander: Callable) -> None:
    law = laws.von_mises_curve(200.0, NU, CURVES[name], beta)
    path = wander(law, 0.02)
    ep = path.state[:, 0]
    assert np.all(np.diff(ep) >= 0.0)
    if isinstance(law.hardening, laws.Power):
        first, y = (
            law.hardening.yield_stress,
            law.hardening.yield_stress + law.hardening.factor * ep**law.hardening.exponent,
        )
    else:
        first, y = 1.0, np.interp(ep, law.hardening.strain, law.hardening.stress)
    relative = equivalent(path.stress - path.state[:, 1:7])
    assert np.max(relative - first - beta * (y - first)) < 1e-9 * y.max()


@pytest.mark.parametrize("name", ["power", "steep power", "Ramberg-Osgood"])
def test_random_increments_of_a_power(name: str, wander: Callable) -> None:
    curve = CURVES[name]
    path = wander(laws.von_mises_curve(200.0, NU, curve), 0.02)
    y = curve.yield_stress + curve.factor * path.state[:, 0] ** curve.exponent  # type: ignore[union-attr]
    assert np.max(equivalent(path.stress) - y) < 1e-9 * y.max()


def test_orthotropic_stiffness() -> None:
    """Uniaxial stress along each axis; the whole stiffness turned by the coordinates' own change."""
    young, poisson, shear = (12.0, 5.0, 3.0), (0.3, 0.25, 0.05), (2.0, 1.0, 1.5)
    law = laws.orthotropic(young, poisson, shear)
    for k in range(3):
        held = [j < 3 and j != k for j in range(6)]
        strain = np.zeros((1, 6))
        strain[0, k] = 0.01
        path = Point(law).hold(strain, tuple(held), np.zeros((1, 6)))
        assert path.stress[0, k] == pytest.approx(0.01 * young[k])
        assert path.strain[0, (k + 1) % 3] == pytest.approx(-0.01 * poisson[k])
        strain = np.zeros((1, 6))
        strain[0, 3 + k] = 0.5 * 0.01
        assert drive(law, strain).stress[0, 3 + k] == pytest.approx(0.01 * shear[k])
    axes = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turned = laws.orthotropic(young, poisson, shear, axes)
    e = np.random.default_rng(2).normal(size=6)
    tensor = np.array([[e[0], e[3], e[5]], [e[3], e[1], e[4]], [e[5], e[4], e[2]]])
    own = axes @ tensor @ axes.T
    six = own[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    s = drive(law, six[None]).stress[0]
    back = axes.T @ np.array([[s[0], s[3], s[5]], [s[3], s[1], s[4]], [s[5], s[4], s[2]]]) @ axes
    assert drive(turned, e[None]).stress[0] == pytest.approx(back[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]])
    assert laws.orthotropic((E,) * 3, (NU,) * 3, (E / 2.6,) * 3).stiffness[0, :2] == pytest.approx(
        [E * 0.7 / (1.3 * 0.4), E * 0.3 / (1.3 * 0.4)]
    )


def test_dp_1_and_2_strengths_of_the_cone_and_its_apex() -> None:
    k, alpha = 2.0, 0.2
    law = laws.drucker_prager(1000.0, NU, k, alpha)
    e = np.linspace(0.0, 0.05, 21)[1:]
    assert bar(law, -e).stress[-1, 0] == pytest.approx(-k / (1.0 / math.sqrt(3.0) - alpha), rel=1e-9)
    assert bar(law, e).stress[-1, 0] == pytest.approx(k / (1.0 / math.sqrt(3.0) + alpha), rel=1e-9)
    pull = np.zeros((5, 6))
    pull[:, :3] = 0.01
    assert drive(law, pull).stress[-1, :3].sum() == pytest.approx(k / alpha)


def test_cap_1_hydrostatic_compression() -> None:
    w, d, x0 = 0.066, 0.67, 0.189
    law = laws.cap(66.7, 40.0, 0.25, gamma=0.18, decay=0.67, ratio=2.5, hardening=laws.CapHardening(w, d, x0))
    press = np.zeros((40, 6))
    press[:, :3] = -0.001
    path = drive(law, press)
    x = -path.stress[:, :3].sum(axis=1)
    volume = -path.strain[:, :3].sum(axis=1) - x / (3.0 * 66.7)
    np.testing.assert_allclose(volume, w * (1.0 - np.exp(-d * (x - x0))), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("power", [0.5, 1.0, 3.0])
def test_pz_1_creep(power: float) -> None:
    """Under s > sy the plastic strain grows by gamma ((s - sy)/sy)^N: a held stress."""
    law = laws.perzyna_yield(E, NU, 250.0, 0.02, power)
    point = Point(law, dt=1e-9)  # loaded at once
    held = (True, True, True, False, False, False)
    wanted = np.zeros((1, 6))
    wanted[0, 0] = 300.0
    point.hold(np.zeros((1, 6)), held, wanted)
    point.dt = 0.1
    path = point.hold(np.zeros((10, 6)), held, np.repeat(wanted, 10, axis=0))
    rate = np.diff(path.strain[:, 0]) / 0.1
    np.testing.assert_allclose(rate, 0.02 * 0.2**power, rtol=1e-8)
    np.testing.assert_allclose(np.diff(path.state[:, 0]) / 0.1, rate, rtol=1e-8)


def test_pz_1_relaxation_and_its_limit() -> None:
    """At a held strain s - sy falls as exp(-t/tau), tau = sy/(E gamma); an endless rate is plasticity without time."""
    law = laws.perzyna_yield(E, NU, 250.0, 1e-3)
    tau = 250.0 / (E * 1e-3)
    m = 400
    point = Point(law, dt=1e-9)
    first = point.hold(np.array([[0.002, 0, 0, 0, 0, 0]]), LATERAL, np.zeros((1, 6))).stress[0, 0]
    point.dt = tau / m
    path = point.hold(np.zeros((m, 6)), LATERAL, np.zeros((m, 6)))
    assert path.stress[-1, 0] - 250.0 == pytest.approx((first - 250.0) * math.exp(-1.0), rel=2.0 / m)
    strain = np.random.default_rng(3).normal(size=(50, 6)) * 0.002
    wanted = drive(laws.von_mises(E, NU, 250.0, E * 2000.0 / (E + 2000.0)), strain)
    fast = drive(laws.perzyna_yield(E, NU, 250.0, 1e12, hardening=2000.0), strain)
    np.testing.assert_allclose(fast.stress, wanted.stress, atol=1e-6 * 250.0)
    k, alpha = 1.0, 0.2
    cone = drive(laws.drucker_prager(1000.0, NU, k, alpha), strain)
    fast = drive(laws.perzyna(1000.0, NU, k, alpha, rate=1e12), strain)
    np.testing.assert_allclose(fast.stress, cone.stress, atol=1e-6)


def test_one_element_of_modified_perzyna_is_faster_stronger(invariants: Callable) -> None:
    """A cone with overstress under axial strain: at ten times the rate the overstress is ten times as high at the end,
    where kappa grows as the strain does."""
    law = laws.perzyna(7000.0, 0.35, 1.0, 0.1, rate=1.0, power=1.0, hardening=0.0)
    over = []
    for rate in (0.01, 0.1):
        strain = np.zeros((400, 6))
        strain[:, 0], strain[:, 1:3] = -1e-4, 0.5e-4  # shear alone: the mean stress is held by dilation
        path = drive(law, strain, dt=1e-4 / rate)
        first, root = invariants(path.stress)
        over.append(float((root - 1.0 - 0.1 * first)[-1]))
    assert over[1] / over[0] == pytest.approx(10.0, rel=0.05)


CLAY = laws.cam_clay(20000.0, 0.3, 1.1, 0.15, 0.03, 100.0, 0.9)


def test_cam_clay_on_its_lines() -> None:
    """All-round pressure: elastic to pc, then dv = dp/K + (lambda - kappa)/(1 + e0) ln(p/pc)."""
    press = np.zeros((100, 6))
    press[:, :3] = -0.0005
    path = drive(CLAY, press)
    p = -path.stress[:, :3].mean(axis=1)
    volume = -path.strain[:, :3].sum(axis=1)
    bulk = 20000.0 / 1.2
    np.testing.assert_allclose(volume, p / bulk + 0.12 / 1.9 * np.log(np.maximum(p, 100.0) / 100.0), rtol=1e-9)


@pytest.mark.parametrize("confined", [20.0, 90.0])
def test_cam_clay_comes_to_its_critical_state(confined: float) -> None:
    """Triaxial compression, dry and wet: q = M p in the end; q = 3 M p0/(3 - M)."""
    point = Point(CLAY)
    point.move(np.array([[-confined * 0.4 / 20000.0] * 3 + [0.0] * 3]))
    m = 1500
    strain = np.zeros((m, 6))
    strain[:, 0] = -0.001
    path = point.hold(strain, LATERAL, np.tile(point.stress, (m, 1)))
    q = path.stress[:, 1] - path.stress[:, 0]
    assert q[-1] == pytest.approx(3.0 * 1.1 * confined / (3.0 - 1.1), rel=1e-3)
    assert (q.max() > 1.05 * q[-1]) == (confined == 20.0)  # the dry one softens
    assert path.state[-1, 1] * (1.0 if confined == 90.0 else -1.0) > 0.0  # and dilates


def test_random_increments_of_cam_clay(wander: Callable, invariants: Callable) -> None:
    path = wander(laws.cam_clay(1000.0, NU, 1.1, 0.15, 0.03, 4.0, 0.9), 0.01)
    first, root = invariants(path.stress)
    p, pc = first / 3.0, 4.0 * np.exp(1.9 / 0.12 * path.state[:, 1])
    assert np.max((3.0 * root**2 / 1.1**2 + p * (p - pc)) / (p**2 + pc**2)) < 1e-9


@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_random_increments_of_perzyna(slope: float, wander: Callable, invariants: Callable) -> None:
    """Never above what the increment's elastic trial has; kappa only grows."""
    law = laws.perzyna(1000.0, NU, 1.0, slope, rate=0.01, power=2.0, hardening=20.0)
    path = wander(law, 0.01)
    first, root = invariants(path.stress)
    assert np.diff(path.state[:, 1]).min() >= 0.0
    over = root - 1.0 - slope * first - 20.0 * path.state[:, 1]
    grown = np.diff(path.state[:, 1], prepend=0.0)
    flows = (grown > 0.0) & (root > 1e-9)
    assert grown[flows] == pytest.approx(0.01 * np.maximum(over[flows], 0.0) ** 2, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(
    ("build", "arguments", "wrong"),
    [
        (laws.power, (-1.0, 1.0, 1.0), "yield stress"),
        (laws.power, (1.0, 0.0, 1.0), "factor"),
        (laws.ramberg_osgood, (E, 300.0, 0.5), "exponent"),
        (laws.orthotropic, ((1.0, 1.0, 0.0), (0.0,) * 3, (1.0,) * 3), "moduli"),
        (laws.orthotropic, ((1.0,) * 3, (0.6,) * 3, (1.0,) * 3), "release energy"),
        (laws.orthotropic, ((1.0,) * 3, (0.1,) * 3, (1.0,) * 3, np.ones((3, 3))), "right angles"),
        (laws.cam_clay, (1.0, 0.3, 0.0, 0.2, 0.1, 1.0, 1.0), "M 0.0"),
        (laws.cam_clay, (1.0, 0.3, 1.0, 0.1, 0.2, 1.0, 1.0), "lambda"),
        (laws.perzyna_yield, (1.0, 0.3, 0.0, 1.0), "k 0.0"),
        (laws.perzyna_yield, (1.0, 0.3, 1.0, 1.0, 1.0, -1.0), "hardening"),
        (laws.von_mises_curve, (1.0, 0.3, laws.Linear(1.0, 0.0), 1.5), "beta"),
    ],
)
def test_constants_that_make_no_sense_are_refused(build: Callable, arguments: tuple, wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        build(*arguments)
    with pytest.raises(ValueError, match="flow"):
        laws.perzyna(1.0, 0.3, 1.0, 0.2, rate=1.0, flow=0.3)
    with pytest.raises(ValueError, match="needs a yield stress"):
        laws.von_mises_curve(1.0, 0.3, laws.power(0.0, 1.0, 0.5), 0.0)
    with pytest.raises(ValueError, match="rate"):
        laws.von_mises_curve(1.0, 0.3, laws.Linear(1.0, 0.0), 0.5, rate=1.0)
