"""Equations of state: the Hugoniot, their slopes, and the energy of a step that they take into account."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.solvers.jit import kernel
from zrno.solvers.materials import (
    CapHardening,
    Elastic,
    Fluid,
    Gruneisen,
    Hydro,
    Linear,
    LinearPolynomial,
    MieGruneisen,
    Monaghan,
    PerfectGas,
    Tait,
    cap,
    constant_wave,
    failing,
    fluid,
    hydro,
    sound_speed,
    von_mises,
)
from zrno.solvers.materials.eos import coefficients
from zrno.solvers.materials.law import wave_speed
from zrno.solvers.materials.point import drive

METALS = {"Al": (2785.0, 5328.0, 1.338, 2.0), "steel": (7900.0, 4600.0, 1.49, 2.17)}
ALL = [
    LinearPolynomial(2.0, 0.1, 5.0, 7.0, 11.0, 0.4, 0.3, 0.2),
    Gruneisen(2.0, 3.0, 1.4, 0.2, 0.1, 1.8, 0.4),
    PerfectGas(1.4),
    Tait(2.0, 3.0, 7.0),
    MieGruneisen(2.0, 3.0, 1.4, 1.8, 0.7),
    Monaghan(2.0, 3.0),
]


def pressure(eos: object, rho: float, e: float) -> float:
    a, _, b, _ = coefficients(eos, rho)
    return float(a + b * e)


def test_the_hugoniot(shared: Path) -> None:
    path = shared / "reference/sph/mie_gruneisen_hugoniot.csv"
    rows = [line.split(",") for line in path.read_text().splitlines() if line[:1] not in "#m"]
    assert len(rows) == 8
    for name, *numbers in rows:
        _, _, p, rho, e = map(float, numbers)
        rho0, c, s, gamma = METALS[name]
        for b in (0.0, 1.0):
            assert pressure(MieGruneisen(rho0, c, s, gamma, b), rho, e) == pytest.approx(p, rel=1e-9)
        # the DYNA form keeps the first order of e - eH only where Gamma rho is constant: a = 0
        assert pressure(Gruneisen(rho0, c, s, 0.0, 0.0, gamma, 0.0), rho, e) == pytest.approx(p, rel=1e-9)


def test_the_formulas() -> None:
    for rho, e in ((2.5, 0.3), (1.6, 0.3)):
        mu = rho / 2.0 - 1.0
        c2, c6 = (7.0, 0.2) if mu > 0.0 else (0.0, 0.0)
        assert pressure(ALL[0], rho, e) == pytest.approx(
            0.1 + 5.0 * mu + c2 * mu**2 + 11.0 * mu**3 + (0.4 + 0.3 * mu + c6 * mu**2) * 2.0 * e
        )
        if mu > 0.0:
            below = (1.0 - 0.4 * mu - 0.2 * mu**2 / (mu + 1.0) - 0.1 * mu**3 / (mu + 1.0) ** 2) ** 2
            cold = 2.0 * 9.0 * mu * (1.0 + 0.1 * mu - 0.2 * mu**2) / below
        else:
            cold = 2.0 * 9.0 * mu
        assert pressure(ALL[1], rho, e) == pytest.approx(cold + (1.8 + 0.4 * mu) * 2.0 * e)
        assert pressure(ALL[2], rho, e) == pytest.approx(0.4 * rho * e)
        assert pressure(ALL[3], rho, e) == pytest.approx(3.0 * ((rho / 2.0) ** 7 - 1.0))
        assert pressure(ALL[5], rho, e) == pytest.approx(9.0 * (rho - 2.0))


@pytest.mark.parametrize("eos", ALL, ids=lambda eos: type(eos).__name__)
@pytest.mark.parametrize("rho", [1.2, 1.9, 2.1, 2.9])
def test_sound_speeds_are_the_slopes_of_the_pressure_at_constant_entropy(eos: object, rho: float) -> None:
    e, step = 0.8, 1e-5
    below, above = (coefficients(eos, rho - step), coefficients(eos, rho + step))
    _, a_slope, _, b_slope = coefficients(eos, rho)
    assert a_slope == pytest.approx((above[0] - below[0]) / (2.0 * step), rel=1e-7, abs=1e-9)
    assert b_slope == pytest.approx((above[2] - below[2]) / (2.0 * step), rel=1e-7, abs=1e-9)
    # de = p/rho^2 drho without heat
    heat = pressure(eos, rho, e) / rho**2 * step
    slope = (pressure(eos, rho + step, e + heat) - pressure(eos, rho - step, e - heat)) / (2.0 * step)
    assert sound_speed(fluid(eos), rho, e) == pytest.approx(max(0.0, slope) ** 0.5, rel=1e-5)


def compressed(m: int, ratio: float) -> np.ndarray:
    strain = np.zeros((m, 6))
    strain[:, 0] = -2.0 * np.tanh(0.5 * np.log(ratio) / m)
    return strain


def test_a_gas_is_compressed_along_its_adiabat_to_second_order() -> None:
    """p rho^-gamma stays; the work of the step itself is in the pressure: half the step, a quarter of the error."""
    errors = []
    for m in (20, 40):
        path = drive(fluid(PerfectGas(1.4)), compressed(m, 2.0), stress=-0.4 * np.array([1, 1, 1, 0, 0, 0]), energy=1.0)
        p = -path.stress[-1, 0]
        assert path.density[-1] == pytest.approx(2.0)
        assert p == pytest.approx(0.4 * path.density[-1] * path.energy[-1], rel=1e-12)  # the law's e is the caller's
        errors.append(abs(p / (0.4 * 2.0**1.4) - 1.0))
    assert errors[0] < 2e-4
    assert 3.9 < errors[0] / errors[1] < 4.1


@pytest.mark.parametrize("eos", ALL, ids=lambda eos: type(eos).__name__)
def test_the_pressure_is_that_of_the_density_and_energy_after_the_step(eos: object) -> None:
    rng = np.random.default_rng(3)
    strain = rng.normal(size=(200, 6)) * 0.02
    path = drive(fluid(eos, viscosity=0.1), strain, density=2.0, energy=0.5)
    wanted = [pressure(eos, rho, e) for rho, e in zip(path.density, path.energy, strict=True)]
    assert -path.stress[:, :3].mean(axis=1) == pytest.approx(wanted, rel=1e-9, abs=1e-9)
    assert path.dissipated.min() > 0.0


def test_past_the_greatest_compression_of_a_shock_fit_the_pressure_stays_finite() -> None:
    for eos in (ALL[1], ALL[4]):
        pressures = [pressure(eos, rho, 0.0) for rho in (3.0, 5.0, 7.0, 20.0)]
        assert np.all(np.isfinite(pressures))
        assert sound_speed(fluid(eos), 20.0) >= 0.0


def test_a_viscous_fluid_and_its_cut_off() -> None:
    strain = np.zeros((3, 6))
    strain[:, 3] = 0.01
    path = drive(fluid(Monaghan(2.0, 3.0), viscosity=5.0), strain, density=2.0, dt=0.5)
    assert path.stress[-1, 3] == pytest.approx(2.0 * 5.0 * 0.01 / 0.5)
    assert path.dissipated[-1] == pytest.approx(2.0 * path.stress[-1, 3] * 0.01)
    strain = np.zeros((1, 6))
    strain[:, 0] = 0.1
    for cutoff, expected in ((-np.inf, 18.0 * (0.95 / 1.05 - 1.0)), (-0.5, -0.5), (0.0, 0.0)):
        path = drive(fluid(Monaghan(2.0, 3.0), cutoff=cutoff), strain, density=2.0)
        assert -path.stress[-1, 0] == pytest.approx(expected)


@pytest.mark.parametrize("eos", ALL, ids=lambda eos: type(eos).__name__)
def test_random_increments_of_a_fluid(eos: object, wander: Callable) -> None:
    wander(fluid(eos, viscosity=0.1, cutoff=-0.5), 0.02, density=2.0, energy=0.5)


@pytest.mark.parametrize(("given", "wrong"), [({"viscosity": -1.0}, "viscosity"), ({"cutoff": 1.0}, "cut-off")])
def test_constants_that_make_no_sense_are_refused(given: dict[str, float], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        fluid(PerfectGas(1.4), **given)


@kernel
def _speeds(law, rho, e, state, c):
    for i in range(len(c)):
        c[i] = wave_speed(law, rho[i], e[i], state, i)


def test_the_wave_speed_is_asked_in_loops_where_it_is_not_constant() -> None:
    """As a solver does: the current speed by density and energy, compiled, with or without a state."""
    rho, e = np.array([2.0, 2.5]), np.array([0.5, 1.0])
    for law in (
        fluid(PerfectGas(1.4)),
        hydro(3.0, Linear(1.0, 0.0), ALL[1]),
        Elastic(1.0, 2.0),
        failing(von_mises(1.0, 0.3, 1.0), 1.0),
        cap(1.0, 1.0, 1.0, hardening=CapHardening(1.0, 1.0, 0.0), rate=1.0, size=1.0),
    ):
        assert constant_wave(law) == (not isinstance(law, Fluid | Hydro))
        for state in (None, np.zeros((8, 2))):
            c = np.empty(2)
            _speeds(law, rho, e, state, c)
            assert c == pytest.approx([sound_speed(law, *pair) for pair in zip(rho, e, strict=True)], rel=1e-14)
            if constant_wave(law):
                assert c[0] * rho[0] ** 0.5 == pytest.approx(c[1] * rho[1] ** 0.5)
    assert sound_speed(fluid(PerfectGas(1.4)), 2.0, 0.5) == pytest.approx((1.4 * 0.4 * 0.5) ** 0.5)
