"""Elasticity and von Mises plasticity, against closed forms and tabled solutions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.solvers.materials import (
    Elastic,
    Linear,
    VonMisesIsotropic,
    VonMisesMixed,
    failing,
    sound_speed,
    state_rows,
    table,
    von_mises,
    von_mises_curve,
)
from zrno.solvers.materials.law import stress_update
from zrno.solvers.materials.point import drive


def tabled(path: Path) -> np.ndarray:
    return np.genfromtxt(path, delimiter=",", skip_header=2)


def equivalent(s: np.ndarray) -> np.ndarray:
    xx, yy, zz, xy, yz, zx = s.T
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + zx**2))


def uniaxial(strains: np.ndarray) -> np.ndarray:
    path = np.zeros((len(strains), 6))
    path[:, 0] = np.diff(strains, prepend=0.0)
    return path


def test_elastic_is_hookes_law() -> None:
    law = Elastic.from_engineering(210e9, 0.3)
    rng = np.random.default_rng(0)
    e = rng.normal(size=(50, 6)) * 1e-3
    stress, state, work, *_ = drive(law, e)
    total = np.cumsum(e, axis=0)
    trace = total[:, :3].sum(axis=1)
    expected = 2.0 * 210e9 / 2.6 * total
    expected[:, :3] += (210e9 * 0.3 / (1.3 * 0.4) * trace)[:, None]
    assert np.allclose(stress, expected, rtol=1e-12, atol=1e-3)
    assert state.shape == (50, 0)
    assert not work.any()
    assert sound_speed(law, 7850.0) == pytest.approx(6000.979831802074)


@pytest.mark.parametrize("beta", [0.0, 0.4, 1.0])
def test_von_mises_in_uniaxial_strain(shared: Path, beta: float) -> None:
    law = von_mises(210e9, 0.3, 250e6, 210e9 * 2e9 / (210e9 + 2e9), beta)
    for strain, stress, plastic in tabled(shared / "reference/sph/vonmises_uniaxial_strain.csv"):
        got, state, *_ = drive(law, uniaxial(np.linspace(0.0, strain, 11)))
        assert got[-1, 0] == pytest.approx(stress, rel=1e-10)
        assert state[-1, 0] == pytest.approx(plastic, rel=1e-9, abs=1e-15)


@pytest.mark.parametrize(("beta", "factor"), [(1.0, 1.0), (0.0, 0.0), (0.5, 0.5)])
def test_reverse_yield_tells_isotropic_from_kinematic(beta: float, factor: float) -> None:
    """After loading to ep, reversal yields at a change of the stress difference of 2 (Y0 + beta H ep)."""
    young, poisson, y0, h = 210e9, 0.3, 250e6, 2e9
    law = von_mises(young, poisson, y0, young * h / (young + h), beta)
    strains = np.concatenate([np.linspace(0.0, 0.01, 200), np.linspace(0.01, -0.01, 20001)[1:]])
    stress, state, *_ = drive(law, uniaxial(strains))
    difference = stress[:, 0] - stress[:, 1]
    top, ep = difference[199], state[199, 0]
    again = 200 + np.argmax(state[200:, 0] > ep * (1.0 + 1e-12))
    assert top - difference[again - 1] == pytest.approx(2.0 * (y0 + factor * h * ep), rel=1e-3)


def test_jaumann_rate_in_simple_shear(shared: Path) -> None:
    """Dienes 1979: s_xy/G = sin g, s_xx/G = 1 - cos g."""
    law = Elastic(0.0, 1.0)
    for gamma, s_xy, s_xx in tabled(shared / "reference/sph/jaumann_simple_shear.csv"):
        m = 20_000
        strain, spin = np.zeros((m, 6)), np.zeros((m, 3))
        strain[:, 3] = spin[:, 0] = 0.5 * gamma / m
        stress, *_ = drive(law, strain, spin=spin)
        assert stress[-1, 3] == pytest.approx(s_xy, abs=2e-3)
        assert stress[-1, 0] == pytest.approx(s_xx, abs=2e-3)
        assert stress[-1, 1] == pytest.approx(-stress[-1, 0], abs=1e-12)


@pytest.mark.parametrize("beta", [0.0, 0.3, 1.0])
def test_random_increments_stay_on_or_inside_the_yield_surface(beta: float, wander: Callable) -> None:
    young, y0, h = 200.0, 1.0, 20.0
    law = von_mises(young, 0.3, y0, young * h / (young + h), beta)
    path = wander(law, 0.02)
    relative = path.stress - (path.state[:, 1:7] if beta < 1.0 else 0.0)
    strength = y0 + beta * h * path.state[:, 0]
    assert np.max(equivalent(relative) / strength) < 1.0 + 1e-10
    assert np.all(np.diff(path.state[:, 0]) >= 0.0)


POINTS = np.array([[0.0, 1.0], [0.02, 1.6], [0.1, 1.8], [0.5, 1.7]])


def test_random_increments_of_a_table(wander: Callable) -> None:
    law = von_mises_curve(200.0, 0.3, table(POINTS, 76.9), rate=3.0, exponent=4.0)
    path = wander(law, 0.02, dt=0.1)
    increments = np.diff(path.strain, axis=0, prepend=0.0)
    increments[:, :3] -= increments[:, :3].mean(axis=1)[:, None]
    rate = np.sqrt(2.0 / 3.0 * (increments[:, :3] ** 2).sum(axis=1) + 4.0 / 3.0 * (increments[:, 3:] ** 2).sum(axis=1))
    strength = np.interp(path.state[:, 0], *POINTS.T) * (1.0 + (rate / 0.1 / 3.0) ** 0.25)
    assert np.max(equivalent(path.stress) / strength) < 1.0 + 1e-9  # the rate is from differences of sums
    assert np.all(np.diff(path.state[:, 0]) >= 0.0)


def test_a_straight_table_is_linear_hardening() -> None:
    strain = np.random.default_rng(6).normal(size=(300, 6)) * 0.01
    wanted = drive(von_mises(200.0, 0.3, 1.0, 200.0 * 20.0 / 220.0), strain)
    for hardening in (Linear(1.0, 20.0), table([[0.0, 1.0], [0.1, 3.0], [100.0, 2001.0]], 76.9)):
        path = drive(von_mises_curve(200.0, 0.3, hardening), strain)
        for got, expected in zip(path, wanted, strict=True):
            assert got == pytest.approx(expected, rel=1e-10, abs=1e-13)


@pytest.mark.parametrize("strain_rate", [0.1, 40.4, 5000.0])
def test_cowper_and_symonds(strain_rate: float) -> None:
    """Mild steel, C = 40.4/s, p = 5: in simple shear the rate is 2/sqrt(3) of the shear strain's."""
    dt = 1e-3 / strain_rate
    strain = np.zeros((100, 6))
    strain[:, 3] = strain_rate * dt * np.sqrt(3.0) / 2.0
    law = von_mises_curve(200e9, 0.3, Linear(300e6, 0.0), rate=40.4, exponent=5.0)
    path = drive(law, strain, dt=dt)
    assert equivalent(path.stress)[-1] == pytest.approx(300e6 * (1.0 + (strain_rate / 40.4) ** 0.2), rel=1e-10)


@pytest.mark.parametrize("beta", [1.0, 0.3])
def test_failure_leaves_rubble_that_closes_where_it_opened(beta: float) -> None:
    """Past the failure strain: no shear, no tension; pressure again at the volume where it would have been zero."""
    law = failing(von_mises(200.0, 0.3, 1.0, 10.0, beta), 0.05)
    bulk = 200.0 / 1.2
    pull, push = np.zeros((100, 6)), np.zeros((200, 6))
    pull[:, 0], push[:, 0] = 0.001, -0.001
    pull[:, 3] = 0.0005
    path = drive(law, np.concatenate([pull, push]))
    whole = drive(law.law, np.concatenate([pull, push]))
    first = int(np.argmax(path.state[:, 0] >= 0.05))
    assert 20 < first < 100
    assert np.array_equal(path.stress[:first], whole.stress[:first])
    assert not path.stress[first:200].any()
    assert path.stress[-1] == pytest.approx([-bulk * 0.1] * 3 + [0.0] * 3)
    held = equivalent(whole.stress[first : first + 1])[0] ** 2 / (6.0 * 200.0 / 2.6)
    held += whole.stress[first, :3].mean() ** 2 / (2.0 * bulk)
    assert path.dissipated[first] - whole.dissipated[first] == pytest.approx(held)
    assert state_rows(law) == state_rows(law.law) + 1
    assert sound_speed(law, 2.0) == sound_speed(law.law, 2.0)


def test_random_increments_of_a_failing_law(wander: Callable) -> None:
    path = wander(failing(von_mises(200.0, 0.3, 1.0, 10.0, 0.5), 2.0), 0.02)
    broken = path.state[:, 0] >= 2.0
    assert 100 < np.argmax(broken) < len(broken) - 100
    assert not path.stress[broken][:, 3:].any()
    assert path.stress[broken].max() == 0.0


def test_bodies_run_uncompiled_alike() -> None:
    """The registered body is plain Python: the same numbers without numba, so no index is out of its array."""
    law = von_mises(200.0, 0.3, 1.0, 10.0, 0.4)
    strain = np.random.default_rng(8).normal(size=(5, 6)) * 0.01
    state, stress = np.zeros((7, 1)), np.zeros(6)
    for de in strain:
        *new, _ = stress_update(law, *de, *stress, 1.0, 0.0, 1.0, state, 0)
        stress = np.array(new)
    path = drive(law, strain)
    assert stress == pytest.approx(path.stress[-1], rel=1e-12)
    assert state[:, 0] == pytest.approx(path.state[-1], rel=1e-12)


def test_back_stress_turns_with_the_body() -> None:
    """A rigid turn after kinematic hardening: the stress relative to the back stress keeps its size."""
    law = von_mises(200.0, 0.3, 1.0, 40.0, 0.0)
    pulled = uniaxial(np.linspace(0.0, 0.05, 50))
    m = 20_000
    turn = np.zeros((50 + m, 3))
    turn[50:, 0] = 0.5 * np.pi / m
    stress, state, *_ = drive(law, np.concatenate([pulled, np.zeros((m, 6))]), spin=turn)
    before, after = stress[49] - state[49, 1:7], stress[-1] - state[-1, 1:7]
    assert after[1] == pytest.approx(before[0], rel=1e-3)  # what was along x is along y
    assert after[0] == pytest.approx(before[1], rel=1e-3, abs=1e-3)


def test_a_scene_without_kinematic_hardening_has_no_back_stress() -> None:
    assert isinstance(von_mises(200.0, 0.3, 1.0, 10.0, 1.0), VonMisesIsotropic)
    assert isinstance(von_mises(200.0, 0.3, 1.0, 0.0, 0.0), VonMisesIsotropic)
    assert isinstance(von_mises(200.0, 0.3, 1.0, 10.0, 0.0), VonMisesMixed)


@pytest.mark.parametrize(
    ("arguments", "wrong"),
    [
        ((-1.0, 0.3, 1.0), "Young"),
        ((1.0, 0.5, 1.0), "Poisson"),
        ((1.0, 0.3, 0.0), "yield stress"),
        ((1.0, 0.3, 0.1, 1.0), "tangent modulus"),
        ((1.0, 0.3, 0.1, 0.1, 1.5), "beta"),
    ],
)
def test_numbers_that_are_no_material_are_refused(arguments: tuple[float, ...], wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        von_mises(*arguments)
    with pytest.raises(ValueError, match="Cowper"):
        von_mises_curve(1.0, 0.3, Linear(1.0, 0.0), rate=0.0)
    with pytest.raises(ValueError, match="failure"):
        failing(von_mises(1.0, 0.3, 1.0), 0.0)
