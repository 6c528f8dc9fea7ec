"""The cap model: tabled solutions, its rate equations solved finely by another program, and what it must never do."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from zrno.solvers.materials import Cap, CapHardening, CapHardeningGeneral, KinematicCap, cap, sound_speed
from zrno.solvers.materials.point import Point, drive

Invariants = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

# McCormick Ranch sand [ksi] (reference/sph/cap_hydrostatic.csv)
K, G, SAND = 66.7, 40.0, CapHardening(0.066, 0.67, 0.189)


def sand(**changed: object) -> Cap:
    law = cap(K, G, **{"k": 0.25, "gamma": 0.18, "decay": 0.67, "ratio": 2.5, "hardening": SAND} | changed)  # type: ignore[arg-type]
    assert isinstance(law, Cap)
    return law


LAWS = {
    "elliptic": sand(),
    "flat": sand(ratio=0.0),
    "rock": sand(soil=False),
    "flat rock": sand(ratio=0.0, soil=False),
    "with tension": sand(tension=-0.1),
    "with tension and its shear": sand(tension=-0.1, soil=False)._replace(keeps_shear=True),
    "cut at the apex": sand(tension=-9.0)._replace(keeps_shear=True),
    "Drucker-Prager": sand(gamma=0.0, decay=0.0, theta=0.2, k=0.1),
    "cohesionless": sand(k=0.18, hardening=SAND._replace(first=0.0)),
    "cohesionless cone": sand(k=0.0, gamma=0.0, theta=0.25, hardening=SAND._replace(first=0.0)),
    "cohesionless flat": sand(k=0.18, ratio=0.0, hardening=SAND._replace(first=0.0)),
    "general hardening": sand(hardening=CapHardeningGeneral(0.066, 0.67, 0.189, 0.5, 0.9, 0.2, 0.005, 1.0)),
    # OpenSees' CapPlasticity defaults [Pa], its norm of s being sqrt(2) J (reference/sph/opensees_concrete_cap.csv)
    "concrete": cap(
        1.1e10, 1e10, 2.6614e7 / 2**0.5, gamma=7.9979e6 / 2**0.5, decay=6.3816e-8, theta=0.11 / 2**0.5,
        ratio=4.43, hardening=CapHardening(0.42, 4.6412e-10, 1.1032e8), tension=-2.0684e6,
    ),
}  # fmt: skip


def strength(law: Cap, first: np.ndarray) -> np.ndarray:
    return law.k - law.gamma * np.exp(-law.decay * first) + law.theta * first


def compaction(law: Cap, centre: float) -> tuple[float, float]:
    """epv and its slope in L, of the simple hardening, written anew."""
    w, d, x0 = law.hardening[:3]
    fe = law.k - law.gamma * np.exp(-law.decay * centre) + law.theta * centre
    slope = law.gamma * law.decay * np.exp(-law.decay * centre) + law.theta
    left = w * np.exp(-d * (centre + law.ratio * fe - x0))
    return w - left, d * left * (1.0 + law.ratio * slope)


class Rates:
    """The rate equations in I, J and L (compression positive), for strain rates whose deviator keeps its direction.

    push: rate of volume strain, shear: rate of the root of the deviator's second invariant.
    """

    def __init__(self, law: Cap, push: float, shear: float) -> None:
        self.law, self.push, self.shear = law, push, shear
        self.bulk = law.lame + 2.0 / 3.0 * law.shear

    def slope(self, first: float) -> float:
        return float(self.law.gamma * self.law.decay * np.exp(-self.law.decay * first) + self.law.theta)

    def elastic(self, t: float, y: np.ndarray) -> list[float]:
        return [9.0 * self.bulk * self.push / 3.0, 2.0 * self.law.shear * self.shear, 0.0]

    def envelope(self, t: float, y: np.ndarray) -> list[float]:
        first, _, centre = y
        i, j, _ = self.elastic(t, y)
        n = self.slope(first)
        flow = (j - n * i) / (self.law.shear + 9.0 * self.bulk * n * n)
        back = -3.0 * n * flow / compaction(self.law, centre)[1] if self.law.soil else 0.0
        return [i + 9.0 * self.bulk * n * flow, j - self.law.shear * flow, back]

    def corner(self, t: float, y: np.ndarray) -> list[float]:
        rate = 3.0 * self.bulk * self.push / (1.0 + 3.0 * self.bulk * compaction(self.law, y[2])[1])
        return [rate, self.slope(y[0]) * rate, rate]

    def ellipse(self, t: float, y: np.ndarray) -> list[float]:
        first, root, centre = y
        i, j, _ = self.elastic(t, y)
        d, square = first - centre, self.law.ratio**2
        volume, shear = 6.0 * d, square * root  # of the flow
        growth = volume / compaction(self.law, centre)[1]
        fe = float(strength(self.law, centre))
        harder = (2.0 * d + 2.0 * square * fe * self.slope(centre)) * growth
        below = 2.0 * d * 3.0 * self.bulk * volume + 2.0 * square * root * 2.0 * self.law.shear * shear + harder
        flow = (2.0 * d * i + 2.0 * square * root * j) / below
        return [i - 3.0 * self.bulk * volume * flow, j - 2.0 * self.law.shear * shear * flow, growth * flow]


def table(path: Path, skip: int) -> np.ndarray:
    return np.genfromtxt(path, delimiter=",", skip_header=skip)


def centres(law: Cap, state: np.ndarray) -> np.ndarray:
    return law.start + state[:, 1]


def along(push: float, shear: float, m: int) -> np.ndarray:
    """m increments: volume strain `push` (compression positive) in all, and simple shear of the invariant `shear`."""
    strain = np.zeros((m, 6))
    strain[:, :3] = -push / 3.0 / m
    strain[:, 3] = shear / m
    return strain


def test_hydrostatic_compression(shared: Path) -> None:
    law = sand()
    for first, _, _, plastic, total in table(shared / "reference/sph/cap_hydrostatic.csv", 4):
        stress, state, *_ = drive(law, along(total, 0.0, 100))
        assert -stress[-1, :3].sum() == pytest.approx(first, rel=1e-9, abs=1e-12)
        assert compaction(law, centres(law, state)[-1])[0] == pytest.approx(plastic, rel=1e-9, abs=1e-12)


def test_uniaxial_strain(shared: Path) -> None:
    law = sand()
    m = 1000
    strain = np.zeros((m, 6))
    strain[:, 0] = -0.05 / m
    stress, state, *_ = drive(law, strain)
    for e, axial, lateral, difference, plastic, x in table(
        shared / "reference/sph/cap_uniaxial_strain_exact.csv", 1
    ):  # fmt: skip
        if e < 0.01:
            continue
        k = round(e / 0.05 * m) - 1
        centre = centres(law, state)[k]
        got = [-stress[k, 0], -stress[k, 1], stress[k, 1] - stress[k, 0], compaction(law, centre)[0]]
        assert got == pytest.approx([axial, lateral, difference, plastic], rel=1e-4)
        assert centre + law.ratio * strength(law, centre) == pytest.approx(x, rel=1e-4)


def compacted(law: Cap, volume: float, first: float) -> Point:
    """A point compacted by a volume strain, then unloaded to I = first."""
    point = Point(law)
    point.move(along(volume, 0.0, 4000))
    point.move(along((first + point.stress[:3].sum()) / (3.0 * K), 0.0, 1))
    assert -point.stress[:3].sum() == pytest.approx(first, rel=1e-9)
    return point


@pytest.mark.parametrize(
    "law", [sand(), sand(ratio=0.0), sand(gamma=0.0, decay=0.0, theta=0.2, k=0.1), sand(soil=False)]
)
def test_dilation_moves_the_cap_back_until_its_corner_holds_the_stress(law: Cap, invariants: Invariants) -> None:
    """Sheared at constant volume: elastic, on the envelope, and at the corner; rock's cap stays where it is."""
    m, shear = 4000, 0.03
    point = compacted(law, 0.01, 0.05)
    start = [0.05, 0.0, float(centres(law, point.state.T)[0])]
    rates = Rates(law, 0.0, shear)

    def yields(t: float, y: np.ndarray) -> float:
        return float(y[1] - strength(law, y[0]))

    def meets(t: float, y: np.ndarray) -> float:
        return float(y[2] - y[0])

    yields.terminal = meets.terminal = True  # type: ignore[attr-defined]
    options = {"method": "LSODA", "rtol": 1e-11, "atol": 1e-13, "dense_output": True}
    first = solve_ivp(rates.elastic, (0.0, 1.0), start, events=yields, **options)
    second = solve_ivp(rates.envelope, (first.t[-1], 1.0), first.y[:, -1], events=meets, **options)
    assert second.status == 1  # the corner was met, also by rock: the stress comes to it
    third = solve_ivp(rates.corner, (second.t[-1], 1.0), second.y[:, -1], **options)

    path = point.move(along(0.0, shear, m))
    got = np.column_stack([*invariants(path.stress), centres(law, path.state)])
    for part in (first, second, third):
        low, high = part.t[0], part.t[-1]
        for t in np.linspace(low, high, 6)[1:]:
            k = int(t * m + 1e-9) - 1
            assert got[k] == pytest.approx(part.sol(np.clip((k + 1) / m, low, high)), rel=2e-3, abs=2e-4)
    start_of_corner = round(second.t[-1] * m) + 10
    assert np.ptp(got[start_of_corner:, 0]) < 1e-9  # no more volumetric flow
    assert (got[-1, 2] < start[2] * 0.95) == law.soil


def test_a_cap_that_is_sheared_and_pressed_follows_the_rate_equations(invariants: Invariants) -> None:
    law = sand()
    m, push, shear = 4000, 0.02, 0.02
    point = Point(law)
    point.move(along(0.01, 0.0, 4000))
    first = -point.stress[:3].sum()
    start = [first, 1e-9, float(centres(law, point.state.T)[0])]
    exact = solve_ivp(Rates(law, push, shear).ellipse, (0.0, 1.0), start, method="LSODA", rtol=1e-10, atol=1e-12,
                      dense_output=True)  # fmt: skip
    path = point.move(along(push, shear, m))
    got = np.column_stack([*invariants(path.stress), centres(law, path.state)])
    for k in range(m // 10 - 1, m, m // 10):
        assert got[k] == pytest.approx(exact.sol((k + 1) / m), rel=1e-3)


def test_a_flat_cap_that_is_sheared_and_pressed_follows_the_rate_equations(invariants: Invariants) -> None:
    """Pressed the stress stays with the cap, I = L; its shear is elastic until it meets the envelope at the corner."""
    law = sand(ratio=0.0)
    m, push, shear = 4000, 0.02, 0.005
    point = Point(law)
    point.move(along(0.01, 0.0, 4000))
    rates = Rates(law, push, shear)

    def on_cap(t: float, y: np.ndarray) -> list[float]:
        rate = rates.corner(t, y)[0]
        return [rate, 2.0 * law.shear * shear, rate]

    def yields(t: float, y: np.ndarray) -> float:
        return float(y[1] - strength(law, y[0]))

    yields.terminal = True  # type: ignore[attr-defined]
    options = {"method": "LSODA", "rtol": 1e-10, "atol": 1e-12, "dense_output": True}
    start = [-point.stress[:3].sum(), 0.0, float(centres(law, point.state.T)[0])]
    first = solve_ivp(on_cap, (0.0, 1.0), start, events=yields, **options)
    second = solve_ivp(rates.corner, (first.t[-1], 1.0), first.y[:, -1], **options)
    assert 0.2 < first.t[-1] < 0.8
    path = point.move(along(push, shear, m))
    got = np.column_stack([*invariants(path.stress), centres(law, path.state)])
    for k in range(m // 10 - 1, m, m // 10):
        t = (k + 1) / m
        assert got[k] == pytest.approx((first if t < first.t[-1] else second).sol(t), rel=1e-3)


def test_tension_ends_at_the_cut_off_and_leaves_the_cap(invariants: Invariants) -> None:
    law = sand(tension=-0.05)
    point = compacted(law, 0.01, 0.1)
    before = centres(law, point.state.T)[0]
    path = point.move(along(-0.01, 0.0005, 1000))
    first, root = invariants(path.stress)
    strain = np.arange(1, 1001) * 0.01 / 1000.0
    elastic = 0.1 - 3.0 * K * strain > -0.05 + 1e-9
    assert first[elastic] == pytest.approx((0.1 - 3.0 * K * strain)[elastic], rel=1e-9)
    assert first[~elastic] == pytest.approx(-0.05)
    assert root[~elastic].max() < 1e-15
    assert centres(law, path.state)[-1] == before


@pytest.mark.parametrize("name", LAWS)
def test_random_increments_stay_within_the_surfaces(name: str, wander: Callable, invariants: Invariants) -> None:
    law = LAWS[name]
    size = 0.1 * float(law.k - law.gamma * np.exp(-law.decay) + law.theta) / law.shear if name == "concrete" else 0.01
    path = wander(law, size)
    first, root = invariants(path.stress)
    centre = np.maximum(0.0, centres(law, path.state))
    assert first.min() >= law.tension - 1e-10 * abs(law.tension) - 1e-15 * law.shear
    on = np.maximum(strength(law, np.minimum(first, centre)), 1e-6 * law.shear * size)
    assert np.max((root - strength(law, np.minimum(first, centre))) / on) < 1e-10
    if law.ratio > 0.0:
        beyond = first > centre
        radius = np.hypot(first - centre, law.ratio * root)[beyond]
        assert np.max(radius / (law.ratio * strength(law, centre[beyond]))) < 1.0 + 1e-10
    else:
        assert np.max(first - centre) <= 1e-10 * first.max()
    if not law.soil:
        assert np.diff(centre).min() >= -1e-12 * centre.max()
    assert path.state[:, 1].max() > 0.0  # the cap was met


def kinematic(rate: float) -> KinematicCap:
    law = cap(K, G, 0.25, gamma=0.18, decay=0.67, ratio=2.5, hardening=SAND, rate=rate, size=0.03)
    assert isinstance(law, KinematicCap)
    return law


def test_random_increments_of_the_kinematic_cap(wander: Callable, invariants: Invariants) -> None:
    law = kinematic(20.0)
    path = wander(law, 0.01)
    back = path.state[:, 2:8]
    assert invariants(back)[1].max() > 0.02
    first, root = invariants(path.stress - back)
    centre = np.maximum(0.0, law.cap.start + path.state[:, 1])
    fe = strength(law.cap, np.minimum(first, centre))
    assert np.max(root / fe) < 1.0 + 1e-10


@pytest.mark.parametrize("rate", [0.1, 20.0, 1e6])
def test_no_increment_takes_the_back_stress_past_its_size(rate: float, invariants: Invariants) -> None:
    for size in (0.01, 1.0, 100.0):
        strain = np.vstack([along(0.05, 0.0, 1), along(0.0, size, 1), along(0.0, size, 1)])
        _, state, *_ = drive(kinematic(rate), strain)
        assert invariants(state[:, 2:])[1].max() <= 0.03 * (1.0 + 1e-12)


def test_the_back_stress_follows_its_rate_equation() -> None:
    """Sheared on a level envelope: a = N (1 - exp(-C ep/N)), s = k + a, exactly."""
    given = {"hardening": SAND, "tension": -1.0}
    law = cap(K, G, 0.25, rate=2.0, size=0.1, **given)  # type: ignore[arg-type]
    for m, close in ((2000, 1e-3), (20000, 1e-4)):
        path = drive(law, along(0.0, 0.1, m))
        shear = path.stress[:, 3]
        plastic = path.strain[:, 3] - shear / (2.0 * G)
        back = path.state[:, 5]
        assert back == pytest.approx(0.1 * (1.0 - np.exp(-2.0 * plastic / 0.1)), abs=0.1 * close)
        assert shear[-1] == pytest.approx(0.25 + back[-1], rel=1e-10)


def test_kinematic_hardening_moves_the_envelope_by_its_size(invariants: Invariants) -> None:
    """Sheared back and forth from I = 0.5: strength Fe + N each way at last; C = 0 is the plain cap."""
    point = compacted(kinematic(20.0), 0.03, 0.5)
    for sign in (1.0, -1.0, 1.0):
        path = point.move(along(0.0, sign * 0.2, 20000))
        first, root = invariants(path.stress)
        assert root[-1] == pytest.approx(strength(kinematic(20.0).cap, first[-1]) + 0.03, rel=2e-3)
    assert isinstance(cap(K, G, 0.25, hardening=SAND, size=0.03), Cap)


def test_a_cohesionless_cap_falls_apart_and_holds_again() -> None:
    """Without cohesion and cut-off 0, X0 = 0: no NaN where the original program gives it."""
    law = LAWS["cohesionless"]
    point = Point(law)
    path = point.move(np.concatenate([along(-0.01, 0.02, 50), along(0.03, 0.0, 300), along(-0.05, 0.03, 50)]))
    assert np.all(np.isfinite(path.stress))
    assert not path.stress[:50].any()
    assert path.stress[349, 0] < -0.1
    assert not path.stress[-1].any()


def test_one_huge_increment_has_an_answer() -> None:
    for law in LAWS.values():
        for size in (1.0, 1e3, 1e6):
            for direction in np.vstack([np.eye(6), -np.eye(6), np.random.default_rng(1).normal(size=(20, 6))]):
                stress, state, *_ = drive(law, size * direction[None])
                assert np.all(np.isfinite(stress))
                assert np.all(np.isfinite(state))


def test_the_virgin_cap_starts_at_x0() -> None:
    for law in LAWS.values():
        least = law.ratio * float(strength(law, 0.0))
        assert law.start + law.ratio * float(strength(law, law.start)) == pytest.approx(
            max(law.hardening.first, least), rel=1e-12
        )
    assert LAWS["cohesionless"].tension == 0.0
    assert LAWS["with tension"].tension == -0.1
    apex = sand(tension=-100.0).tension
    assert strength(sand(), apex) == pytest.approx(0.0, abs=1e-15)
    assert sound_speed(LAWS["elliptic"], 2.0) == pytest.approx(((K + 4.0 * G / 3.0) / 2.0) ** 0.5)


@pytest.mark.parametrize(
    ("changed", "wrong"),
    [
        ({"k": 0.1}, "alpha"),
        ({"k": 0.0, "gamma": 0.0, "theta": 0.0}, "alpha"),
        ({"theta": -1.0}, "theta"),
        ({"ratio": -1.0}, "R"),
        ({"hardening": SAND._replace(limit=0.0)}, "W"),
        ({"hardening": SAND._replace(decay=-1.0)}, "D"),
        ({"hardening": SAND._replace(first=1e6)}, "X0"),
        ({"tension": 0.1}, "tension"),
        ({"rate": 1.0}, "N"),
        ({"hardening": CapHardeningGeneral(0.066, 0.67, 0.189, 2.0, 0.0, 0.0, 0.0, 0.0)}, "grow"),
    ],
)
def test_constants_that_make_no_sense_are_refused(changed: dict[str, object], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        sand(**changed)
