"""The solid with an equation of state: against the law without one, its strength, its spall, its energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from zrno.solvers.materials import (
    Gruneisen,
    Hydro,
    Linear,
    LinearPolynomial,
    hydro,
    sound_speed,
    table,
    von_mises_curve,
)
from zrno.solvers.materials.point import drive

K, G = 160.0, 80.0
BULK = LinearPolynomial(1.0, 0.0, K, 0.0, 0.0, 0.0, 0.0, 0.0)
COPPER = Gruneisen(8.93, 3.94, 1.49, 0.0, 0.0, 1.99, 0.47)  # mm/us, GPa
POINTS = [[0.0, 0.5], [0.01, 0.7], [0.1, 0.8]]


def uniaxial(strain: float, m: int) -> np.ndarray:
    path = np.zeros((m, 6))
    path[:, 0] = strain / m
    return path


@pytest.mark.parametrize("hardening", [Linear(0.5, 3.0), table(POINTS, G)], ids=["linear", "table"])
def test_without_energy_the_deviator_is_von_mises(hardening: Linear) -> None:
    young, poisson = 9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G))
    strain = np.random.default_rng(5).normal(size=(200, 6)) * 0.003
    wanted = drive(von_mises_curve(young, poisson, hardening), strain)
    path = drive(hydro(G, hardening, BULK), strain)
    mean, other = path.stress[:, :3].mean(axis=1), wanted.stress[:, :3].mean(axis=1)
    assert path.stress[:, 3:] == pytest.approx(wanted.stress[:, 3:], abs=1e-12)
    assert path.stress[:, :3] - mean[:, None] == pytest.approx(wanted.stress[:, :3] - other[:, None], abs=1e-12)
    assert path.state[:, 0] == pytest.approx(wanted.state[:, 0], abs=1e-13)
    assert path.dissipated == pytest.approx(wanted.dissipated, abs=1e-13)
    assert -mean == pytest.approx(K * (path.density - 1.0), rel=1e-12)


def test_the_strength_of_a_table_is_the_table(invariants: Callable) -> None:
    law = hydro(G, table(POINTS, G), BULK)
    strain = np.zeros((300, 6))
    strain[:, 3] = 0.0005
    for path in (drive(law, strain), drive(law, strain.sum(axis=0, keepdims=True))):  # one increment is exact too
        _, root = invariants(path.stress)
        plastic = path.state[:, 0]
        strength = np.interp(plastic, *np.array(POINTS).T)
        assert (np.sqrt(3.0) * root / strength)[-1] == pytest.approx(1.0, rel=1e-12)
        assert plastic[-1] == pytest.approx(2.0 / np.sqrt(3.0) * 0.15 - strength[-1] / (3.0 * G), rel=1e-12)
        spent = np.trapezoid(np.interp(x := np.linspace(0.0, plastic[-1], 200001), *np.array(POINTS).T), x)
        assert path.dissipated.sum() == pytest.approx(spent, rel=1e-6)


def test_pressure_and_energy_belong_together() -> None:
    """The law's pressure is that of the energy which the caller then has, plastic work included."""
    law = hydro(47.7, Linear(0.12, 0.1), COPPER)
    strain = uniaxial(-0.3, 300)
    strain[:, 3] = 0.001
    path = drive(law, strain, density=8.93)
    mu = path.density / 8.93 - 1.0
    above = 1.0 + (1.0 - 1.99 / 2.0) * mu - 0.47 / 2.0 * mu**2
    wanted = 8.93 * 3.94**2 * mu * above / (1.0 - 0.49 * mu) ** 2 + (1.99 + 0.47 * mu) * 8.93 * path.energy
    assert -path.stress[:, :3].mean(axis=1) == pytest.approx(wanted, rel=1e-10)
    assert sound_speed(law, 8.93) == pytest.approx((3.94**2 + 4.0 / 3.0 * 47.7 / 8.93) ** 0.5)


def test_pressure_hardens() -> None:
    law = hydro(G, Linear(0.1, 0.0), BULK, a1=0.2, a2=0.01)
    path = drive(law, uniaxial(-0.1, 100))
    p = -path.stress[-1, :3].mean()
    assert path.stress[-1, 1] - path.stress[-1, 0] == pytest.approx(0.1 + 0.2 * p + 0.01 * p**2, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "peak"),
    [
        ({"spall": 1, "cutoff": -1.0}, 1.0),
        ({"spall": 3, "cutoff": -1.0}, 1.0),
        ({"spall": 2, "cutoff": -1.5}, 1.5 - 2.0 / 3.0 * 0.5),
        ({"failure": 0.002}, None),
    ],
    ids=str,
)
def test_spall_and_failure(given: dict[str, float], peak: float | None) -> None:
    """Pulled apart: tension up to a peak; then a limit (1), or rubble: nothing pulled or sheared, pressure pressed."""
    law = hydro(G, Linear(0.5, 0.0), BULK, **given)  # type: ignore[arg-type]
    pull = uniaxial(0.02, 2000)
    path = drive(law, np.concatenate([pull, uniaxial(-0.04, 2000)]))
    tension = path.stress[:, :3].mean(axis=1)
    broken = path.state[:, 1] > 0.0
    if peak is not None:
        assert tension[:2000].max() == pytest.approx(peak, rel=2e-3)
    if given.get("spall") == 1:
        assert not broken.any()
        assert tension[1999] == pytest.approx(-law.cutoff)
        return
    first = int(np.argmax(broken))
    assert 0 < first < 2000
    if "failure" in given:
        assert path.state[first, 0] == pytest.approx(0.002, rel=1e-2)
    assert not path.stress[first:2000].any()
    assert path.stress[-1, 0] == path.stress[-1, 1] == pytest.approx(-K * (path.density[-1] - 1.0))
    assert path.stress[-1, 0] < -1.0
    assert path.dissipated[first] > path.dissipated[first - 1]


CASES = {
    "Linear": hydro(G, Linear(0.5, 3.0), BULK),
    "pressure": hydro(G, Linear(0.5, 3.0), BULK, a1=0.3, a2=0.01),
    "table": hydro(47.7, table(POINTS, 47.7), COPPER._replace(density=1.0)),
    "spall": hydro(G, Linear(0.5, 3.0), BULK, spall=2, cutoff=-5.0),
}


@pytest.mark.parametrize("name", CASES)
def test_random_increments(name: str, wander: Callable, invariants: Callable) -> None:
    law: Hydro = CASES[name]
    path = wander(law, 0.01)
    first, root = invariants(path.stress)
    push = np.maximum(first / 3.0, 0.0)
    plastic = path.state[:, 0]
    strength = 0.5 + 3.0 * plastic if name != "table" else np.interp(plastic, *np.array(POINTS).T)
    strength = strength + (law.a1 + law.a2 * push) * push
    assert np.max(np.sqrt(3.0) * root / strength) < 1.0 + 1e-10
    assert np.diff(plastic).min() >= 0.0


@pytest.mark.parametrize(
    ("given", "wrong"),
    [
        ({"shear": 0.0}, "shear"),
        ({"hardening": Linear(-1.0, 0.0)}, "yield"),
        ({"a1": -1.0}, "a1"),
        ({"cutoff": 1.0}, "cut-off"),
        ({"spall": 4}, "spall"),
        ({"failure": 0.0}, "failure"),
    ],
)
def test_constants_that_make_no_sense_are_refused(given: dict[str, object], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        hydro(**{"shear": 1.0, "hardening": Linear(1.0, 0.0), "eos": BULK} | given)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("points", "wrong"),
    [
        ([], "points"),
        ([[0.1, 1.0]], "begin"),
        ([[0.0, 1.0], [0.0, 2.0]], "grow"),
        ([[0.0, 0.0]], "positive"),
        ([[0.0, 1.0], [0.1, 0.001]], "fall"),
        ([[0.0, np.nan]], "points"),
    ],
)
def test_tables_that_make_no_sense_are_refused(points: list[list[float]], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        table(points, 1.0)
