"""Drucker-Prager and Mohr-Coulomb: their strengths in triaxial tests, their returns, and what they must never do."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

from zrno.solvers.materials import (
    OPEN,
    CapHardening,
    cap,
    continuous,
    drucker_prager,
    drucker_prager_soil,
    mohr_coulomb,
)
from zrno.solvers.materials.drucker_prager import cone
from zrno.solvers.materials.mohr_coulomb import mohr_coulomb_return
from zrno.solvers.materials.point import Point, drive
from zrno.solvers.materials.principal import greatest_deviator, principal

E, NU = 1000.0, 0.3


def triaxial(law: Any, confined: float, axial: float, m: int = 200) -> np.ndarray:
    """Pressed by `confined` on all sides, then strained along x with the lateral stress held; the last stress."""
    point = Point(law)
    strain = np.zeros((1, 6))
    strain[0, :3] = -confined * (1.0 - 2.0 * NU) / E
    point.move(strain)
    strain = np.zeros((m, 6))
    strain[:, 0] = axial / m
    wanted = np.tile(point.stress, (m, 1))
    return point.hold(strain, (False, True, True, False, False, False), wanted).stress[-1]


@pytest.mark.parametrize("dilation", [0.0, 15.0, 30.0])
@pytest.mark.parametrize("cohesion", [0.0, 2.0])
def test_triaxial_compression_and_extension(cohesion: float, dilation: float) -> None:
    """sigma1 = sigma3 N + 2 c sqrt N, N = tan^2(45 + phi/2), by both; and in extension by the inner cone."""
    phi = 30.0
    n = math.tan(math.radians(45.0 + phi / 2.0)) ** 2
    strong = 10.0 * n + 2.0 * cohesion * math.sqrt(n)
    weak = (10.0 - 2.0 * cohesion * math.sqrt(n)) / n
    hexagon = mohr_coulomb(E, NU, cohesion, phi, dilation)
    for law, axial, expected in (
        (hexagon, -0.1, strong),
        (drucker_prager_soil(E, NU, cohesion, phi, dilation), -0.1, strong),
        (hexagon, 0.05, weak),
        (drucker_prager_soil(E, NU, cohesion, phi, dilation, match="extension"), 0.05, weak),
    ):
        stress = triaxial(law, 10.0, axial)
        assert -stress[0] == pytest.approx(expected, rel=1e-8)
        assert -stress[1:3] == pytest.approx([10.0, 10.0], rel=1e-8)


def test_the_plane_strain_cone_collapses_as_the_hexagon_does() -> None:
    """Flowing without a change of stress in plane strain: (s1 - s3)/2 = c cos phi - (s1 + s3)/2 sin phi."""
    c, phi = 2.0, 25.0
    sine = math.sin(math.radians(phi))
    k, slope = cone(c, phi, "plane_strain")
    m = 2000
    strain = np.zeros((m, 6))
    strain[:, 0], strain[:, 1] = -0.1 * (1.0 - sine) / m, 0.1 * (1.0 + sine) / m
    stress = drive(drucker_prager(E, NU, k, slope), strain).stress[-1]
    half, middle = 0.5 * (stress[1] - stress[0]), 0.5 * (stress[0] + stress[1])
    assert half == pytest.approx(c * math.cos(math.radians(phi)) - middle * sine, rel=1e-9)


def test_tension_cut_offs() -> None:
    pull = np.full((50, 6), 0.001)
    pull[:, 3:] = 0.0
    assert drive(drucker_prager(E, NU, 1.0, 0.2, tension=-0.6), pull).stress[-1] == pytest.approx([0.2] * 3 + [0.0] * 3)
    assert drive(drucker_prager(E, NU, 1.0, 0.2), pull).stress[-1, :3] == pytest.approx([5.0 / 3.0] * 3)
    apex = 1.0 / math.tan(math.radians(30.0))
    assert drive(mohr_coulomb(E, NU, 1.0, 30.0), pull).stress[-1, :3] == pytest.approx([apex] * 3)
    assert drive(mohr_coulomb(E, NU, 1.0, 30.0, tension=0.5), pull).stress[-1, :3] == pytest.approx([0.5] * 3)
    pull[:, 1:3] = 0.0
    stress = drive(mohr_coulomb(E, NU, 1.0, 30.0, tension=0.5), pull).stress[-1]
    assert stress[0] == pytest.approx(0.5)


CUT: dict[str, tuple[Any, float]] = {
    "cone": (drucker_prager(E, NU, 1.0, 0.2, tension=-0.6), -0.6),
    "cone to its apex": (drucker_prager(E, NU, 1.0, 0.2, tension=-9.0), -5.0),
    "cap": (cap(E, 400.0, 1.0, theta=0.2, ratio=2.0, hardening=CapHardening(0.05, 0.1, 5.0), tension=-0.6), -0.6),
    "rock to its apex": (
        cap(E, 400.0, 1.0, theta=0.2, ratio=2.0, hardening=CapHardening(0.05, 0.1, 5.0), tension=-9.0, soil=False),
        -5.0,
    ),
}


@pytest.mark.parametrize("name", CUT)
def test_a_cut_off_that_keeps_shear_is_continuous(name: str, invariants: Callable) -> None:
    """Strains from zero along lines into tension end on stresses along a path without jumps; else the cut-off jumps
    by the strength at T.

    Beyond T by tension alone the shear stays what it was.
    """
    sharp, least = CUT[name]
    law = continuous(sharp)
    rng = np.random.default_rng(3)
    lines = np.repeat(rng.normal(size=(10, 1, 6)) * 0.004, 1000, axis=1)
    lines[:, :, :3] += np.linspace(-0.002, 0.01, 1000)[:, None]

    def jumps(law: Any) -> tuple[float, Any]:
        """The worst change of stress over that of strain, in elastic stiffnesses; stresses."""
        ends = np.array([[drive(law, e[None]).stress[-1] for e in line] for line in lines])
        changed, moved = np.abs(np.diff(ends, axis=1)).max(), np.abs(np.diff(lines, axis=1)).max()
        return float(changed / moved) / (E + 4.0 / 3.0 * 400.0), ends.reshape(-1, 6)

    worst, stress = jumps(law)
    assert worst < 5.0
    assert jumps(sharp)[0] > 10.0
    first, _ = invariants(stress)
    assert first.min() == pytest.approx(least, rel=1e-12)
    sheared = np.zeros((2, 6))
    sheared[0, 3], sheared[1, :3] = 0.0004, 0.002
    path = drive(law, sheared).stress
    assert path[1, 3] == pytest.approx(path[0, 3] if least > -1.0 else 0.0, abs=1e-12)
    assert drive(sharp, sheared).stress[1, 3] == 0.0


def test_grain_that_has_opened_closes_before_it_bears() -> None:
    """Pressed, pulled apart by 5 %, pressed by 4 %, and by 2 % more; without a gap it bears from the first."""
    bulk = E / (3.0 * (1.0 - 2.0 * NU))
    path = np.zeros((400, 6))
    path[:, :3] = np.repeat([-0.001, 0.051, -0.04, -0.02], 100)[:, None] / 300.0
    opened, ratcheted = (drive(drucker_prager_soil(E, NU, 0.0, 31.0, gaps=gaps), path) for gaps in (True, False))
    pressure = -opened.stress[[99, 199, 299, 399], :3].mean(axis=1)
    assert pressure == pytest.approx(bulk * np.array([0.001, 0.0, 0.0, 0.01]), abs=1e-9)
    assert opened.state[[199, 299, 399], 1] == pytest.approx([0.05, 0.01, 0.0], abs=1e-9)
    assert opened.density[-1] == pytest.approx(math.exp(0.01), rel=1e-6)  # the pressure is that of the density
    assert -ratcheted.stress[-1, :3].mean() == pytest.approx(bulk * 0.06)
    assert opened.dissipated.min() >= 0.0
    pull = np.full((100, 6), 0.01)
    assert drive(drucker_prager_soil(E, NU, 0.0, 31.0), pull).state[-1, 1] == OPEN
    assert drucker_prager_soil(E, NU, 1.0, 31.0).gaps is False
    with pytest.raises(ValueError, match="without cohesion"):
        drucker_prager_soil(E, NU, 1.0, 31.0, gaps=True)


def test_dilation_fills_the_gap_that_it_presses_on() -> None:
    """Sheared under no pressure with its neighbours held: what flows dilates, and presses, with no gap left."""
    law = drucker_prager_soil(E, NU, 0.0, 30.0, 30.0)
    path = np.zeros((100, 6))
    path[:, 3] = 1e-4
    path[0, :3] = 1e-6
    found = drive(law, path)
    assert found.stress[-1, 0] < 0.0
    assert found.state[-1, 1] == 0.0


def nearest(law: Any, trial: np.ndarray, guess: np.ndarray) -> np.ndarray:
    """The admissible principal stresses nearest to the trial in the metric of Hooke's inverse, by scipy."""
    inverse = (np.eye(3) * (1.0 + NU) - NU) / E
    planes = []
    for i in range(3):
        if math.isfinite(law.tension):
            planes.append((np.eye(3)[i], law.tension))
        for j in range(3):
            if i != j:
                planes.append((np.eye(3)[i] * (1.0 + law.sine) - np.eye(3)[j] * (1.0 - law.sine), law.cohesive))
    normals = np.array([normal for normal, _ in planes])
    limits = np.array([limit for _, limit in planes])
    found = minimize(
        lambda s: 1e3 * (s - trial) @ inverse @ (s - trial),
        guess,
        constraints=[{"type": "ineq", "fun": lambda s: limits - normals @ s, "jac": lambda s: -normals}],
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    return np.asarray(found.x)


def test_associated_returns_are_the_nearest_points_in_energy() -> None:
    """An oracle for every region of planes, edges and corners."""
    rng = np.random.default_rng(2)
    for c, phi, tension in ((1.0, 30.0, math.inf), (1.0, 30.0, 0.4), (2.0, 0.0, 1.0), (0.0, 35.0, math.inf)):
        law = mohr_coulomb(E, NU, c, phi, phi, tension=tension)
        for _ in range(60):
            trial = np.sort(rng.normal(size=3) * 5.0 + rng.normal() * 4.0)[::-1]
            outside = (1.0 + law.sine) * trial[0] - (1.0 - law.sine) * trial[2] > law.cohesive or trial[0] > law.tension
            if outside:
                got = np.array(mohr_coulomb_return(law, *trial)[:3])
                assert got == pytest.approx(nearest(law, trial, got + 0.1), abs=2e-4)


def test_principal_values_and_directions() -> None:
    rng = np.random.default_rng(4)
    cases = list(rng.normal(size=(300, 6)))
    cases += [np.array(c, dtype=float) for c in ([1, 1, 1, 0, 0, 0], [2, 1, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0] * 6)]
    cases += [np.array([1.0, 1.0, 1.0, 1e-9, 0.0, 0.0]), np.array([1e8, 1.0, 1.0, 1.0, 1e-8, 1.0])]
    for s in cases:
        p = principal(*s)
        full = np.array([[s[0], s[3], s[5]], [s[3], s[1], s[4]], [s[5], s[4], s[2]]])
        turn = np.array(p[3:]).reshape(3, 3)
        size = np.abs(s).max()
        assert np.sort(p[:3]) == pytest.approx(np.linalg.eigvalsh(full), abs=1e-14 * size)
        assert turn @ np.diag(p[:3]) @ turn.T == pytest.approx(full, abs=4e-15 * size)
        mean = np.trace(full) / 3.0
        top = greatest_deviator(*(s - mean * np.array([1, 1, 1, 0, 0, 0])))
        assert top + mean == pytest.approx(max(p[:3]), abs=1e-7 * size)


CONES = {
    "outer": drucker_prager_soil(E, NU, 1.0, 30.0, 10.0),
    "cohesionless": drucker_prager_soil(E, NU, 0.0, 30.0, 0.0),
    "associated": drucker_prager(E, NU, 1.0, 0.3),
    "cut": drucker_prager(E, NU, 1.0, 0.3, tension=0.0),
    "cut, with shear": continuous(drucker_prager(E, NU, 1.0, 0.3, tension=-0.5)),
    "von Mises": drucker_prager(E, NU, 1.0, 0.0),
}
HEXAGONS = {
    "friction": (1.0, 30.0, 10.0, math.inf),
    "cohesionless": (0.0, 35.0, 0.0, math.inf),
    "associated": (1.0, 30.0, 30.0, math.inf),
    "cut": (1.0, 30.0, 5.0, 0.2),
    "no tension": (1.0, 30.0, 0.0, 0.0),
    "Tresca": (1.0, 0.0, 0.0, math.inf),
    "Tresca cut": (1.0, 0.0, 0.0, 0.5),
    "steep": (0.1, 60.0, 0.0, math.inf),
}


@pytest.mark.parametrize("name", CONES)
def test_random_increments_stay_within_the_cone(name: str, wander: Callable, invariants: Callable) -> None:
    law = CONES[name]
    path = wander(law, 0.01)
    first, root = invariants(path.stress)
    strength = law.k + law.slope * first
    assert np.max(root - strength - 1e-10 * np.abs(strength)) < 1e-13 * E
    assert first.min() >= max(law.tension, law.apex) - 1e-12
    assert np.diff(path.state[:, 0]).min() >= 0.0


@pytest.mark.parametrize("name", HEXAGONS)
def test_random_increments_stay_within_the_hexagon(name: str, wander: Callable, principals: Callable) -> None:
    c, phi, psi, tension = HEXAGONS[name]
    law = mohr_coulomb(E, NU, c, phi, psi, tension=tension)
    path = wander(law, 0.01)
    p = principals(path.stress)
    strength = law.cohesive - (p[:, 0] + p[:, 2]) * law.sine
    assert np.max(p[:, 0] - p[:, 2] - strength - 1e-10 * np.abs(strength)) < 1e-13 * E
    assert p[:, 0].max() <= law.tension + 1e-13 * E
    assert np.diff(path.state[:, 0]).min() >= 0.0


def test_one_huge_increment_has_an_answer() -> None:
    laws = [*CONES.values(), *(mohr_coulomb(E, NU, c, phi, psi, tension=t) for c, phi, psi, t in HEXAGONS.values())]
    for law in laws:
        for size in (1.0, 1e6):
            for direction in np.vstack([np.eye(6), -np.eye(6), np.random.default_rng(1).normal(size=(20, 6))]):
                assert np.all(np.isfinite(drive(law, size * direction[None]).stress))


@pytest.mark.parametrize(
    ("build", "arguments", "wrong"),
    [
        (drucker_prager, (E, NU, -1.0, 0.1), "k"),
        (drucker_prager, (E, NU, 0.0, 0.0), "both 0"),
        (drucker_prager_soil, (E, NU, 1.0, 90.0), "friction"),
        (drucker_prager_soil, (E, NU, -1.0, 30.0), "cohesion"),
        (drucker_prager_soil, (E, NU, 1.0, 30.0, 40.0), "dilation"),
        (mohr_coulomb, (E, NU, -1.0, 30.0), "cohesion"),
        (mohr_coulomb, (E, NU, 1.0, -1.0), "friction"),
        (mohr_coulomb, (E, NU, 1.0, 30.0, -5.0), "dilation"),
        (mohr_coulomb, (E, NU, 0.0, 0.0), "both"),
        (mohr_coulomb, (0.0, NU, 1.0, 30.0), "Young"),
    ],
)
def test_constants_that_make_no_sense_are_refused(build: Callable, arguments: tuple, wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        build(*arguments)
    for law in (drucker_prager, mohr_coulomb):
        with pytest.raises(ValueError, match="tension"):
            law(E, NU, 1.0, 0.1, tension=0.5 if law is drucker_prager else -0.5)
