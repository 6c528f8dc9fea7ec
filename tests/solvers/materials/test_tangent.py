"""Consistent tangents against derivatives of the stress update that are taken anew, at states along random paths."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from zrno.solvers import materials as laws
from zrno.solvers.jit import kernel
from zrno.solvers.materials.law import PLASTIC_STRAIN, state_rows, stress_update
from zrno.solvers.materials.tangent import stress_and_tangent, symmetric_tangent

E, NU = 1000.0, 0.3
SIZE = 0.01  # of the strain increments
ANEW = 150  # states of a path; a longer one would dilate until hardly any step flows
SAND = laws.CapHardening(0.066, 0.67, 0.189)
POINTS = laws.table([[0.0, 1.0], [0.02, 1.6], [0.1, 1.8], [0.5, 1.7]], 384.0)


def _sand(**changed: Any) -> Any:
    return laws.cap(66.7, 40.0, **{"k": 0.25, "gamma": 0.18, "decay": 0.67, "ratio": 2.5, "hardening": SAND} | changed)


LAWS: dict[str, Any] = {
    "elastic": laws.Elastic.from_engineering(E, NU),
    "orthotropic": laws.orthotropic((E, 400.0, 200.0), (0.3, 0.2, 0.05), (150.0, 80.0, 120.0)),
    "isotropic": laws.von_mises(E, NU, 1.0, 20.0),
    "mixed": laws.von_mises(E, NU, 1.0, 20.0, 0.3),
    "table": laws.von_mises_curve(E, NU, POINTS),
    "power": laws.von_mises_curve(E, NU, laws.power(1.0, 3.0, 0.4)),
    "steep power": laws.von_mises_curve(E, NU, laws.power(1.0, 3.0, 1.7)),
    "Ramberg-Osgood": laws.von_mises_curve(E, NU, laws.ramberg_osgood(E, 2.0, 5.0)),
    "kinematic power": laws.von_mises_curve(E, NU, laws.power(1.0, 3.0, 0.4), 0.25),
    "kinematic table": laws.von_mises_curve(E, NU, POINTS, 0.0),
    "rate": laws.von_mises_curve(E, NU, POINTS, rate=0.05, exponent=4.0),
    "cone": laws.drucker_prager_soil(E, NU, 1.0, 30.0, 10.0),
    "associated cone": laws.drucker_prager_soil(E, NU, 1.0, 30.0, 30.0),
    "cut cone": laws.continuous(laws.drucker_prager(E, NU, 1.0, 0.3, tension=-0.6)),
    "cohesionless cone": laws.drucker_prager_soil(E, NU, 0.0, 30.0, 5.0),
    "hexagon": laws.mohr_coulomb(E, NU, 1.0, 30.0, 10.0),
    "associated hexagon": laws.mohr_coulomb(E, NU, 1.0, 20.0, 20.0),
    "cut hexagon": laws.mohr_coulomb(E, NU, 1.0, 30.0, 5.0, tension=0.3),
    "Tresca": laws.mohr_coulomb(E, NU, 1.0, 0.0),
    "cap": _sand(),
    "flat cap": _sand(ratio=0.0),
    "rock": _sand(soil=False),
    "cohesionless cap": _sand(k=0.18, hardening=SAND._replace(first=0.0)),
    "cut cap": laws.continuous(_sand(tension=-0.05)),
    "kinematic cap": _sand(k=0.22, rate=20.0, size=0.03),
    "clay": laws.cam_clay(E, NU, 1.1, 0.15, 0.03, 4.0, 0.9),
    "Perzyna": laws.perzyna_yield(E, NU, 1.0, 0.02),
    "Perzyna's power": laws.perzyna(E, NU, 1.0, 0.2, rate=0.02, power=3.0, hardening=30.0),
    "Perzyna's root": laws.perzyna(E, NU, 1.0, 0.2, rate=0.02, power=0.5, flow=0.1),
}
SYMMETRIC = {name for name, law in LAWS.items() if symmetric_tangent(law)}


def step(law: Any, e: Any, s: Any, state: Any, scratch: Any, modulus: Any, out: Any) -> float:
    """One update with its tangent, the stress to `out`; the plastic strain that it adds."""
    before = state[PLASTIC_STRAIN, 0]
    a = stress_and_tangent(
        law, e[0], e[1], e[2], e[3], e[4], e[5], s[0], s[1], s[2], s[3], s[4], s[5], 1.0, 0.0, 1.0, state, 0, scratch,
        modulus, 0,
    )  # fmt: skip
    for k in range(6):
        out[k] = a[k]
    grown: float = state[PLASTIC_STRAIN, 0] - before
    return grown


def differences(law: Any, e: Any, s: Any, state: Any, kept: Any, size: float, found: Any) -> None:
    """found (6, 6): central differences of the fourth order of the update, shears as angles."""
    for c in range(6):
        for r in range(6):
            found[r, c] = 0.0
        for k in range(4):
            move = (2.0, 1.0, -1.0, -2.0)[k] * size
            weight = (-1.0, 8.0, -8.0, 1.0)[k] / (12.0 * size) * (1.0 if c < 3 else 0.5)
            for row in range(state.shape[0]):
                kept[row, 0] = state[row, 0]
            old = e[c]
            e[c] += move
            a = stress_update(
                law, e[0], e[1], e[2], e[3], e[4], e[5], s[0], s[1], s[2], s[3], s[4], s[5], 1.0, 0.0, 1.0, kept, 0
            )
            e[c] = old
            for r in range(6):
                found[r, c] += weight * a[r]


def _along(step: Any, differences: Any) -> Any:
    def along(law: Any, strain: Any, state: Any, errors: Any, doubts: Any, skew: Any, flows: Any) -> None:
        rows = state.shape[0]
        kept, scratch = np.zeros((rows, 1)), np.zeros((rows, 2))
        s, out = np.zeros(6), np.zeros(6)
        modulus, coarse, fine = np.zeros((1, 6, 6)), np.zeros((6, 6)), np.zeros((6, 6))
        for m in range(len(strain)):
            if m % ANEW == 0:
                s[:] = 0.0
                state[:] = 0.0
            e = strain[m]
            size = 1e-3 * np.abs(e).max()
            differences(law, e, s, state, kept, size, coarse)
            differences(law, e, s, state, kept, 0.5 * size, fine)
            flows[m] = step(law, e, s, state, scratch, modulus, out)
            doubts[m] = np.abs(coarse - fine).max()
            errors[m] = np.abs(modulus[0] - fine).max()
            skew[m] = np.abs(modulus[0] - modulus[0].T).max()
            for k in range(6):
                s[k] = out[k]

    return along


def _strain(count: int) -> np.ndarray:
    rng = np.random.default_rng(11)
    strain = rng.normal(size=(count, 6)) * SIZE * 10.0 ** rng.uniform(-1.5, 0.0, size=(count, 1))
    volume = 2.0 * SIZE * np.sin(np.cumsum(rng.normal(size=count)) * 0.3) - SIZE
    volume[::ANEW] = 0.0
    strain[:, :3] += (np.diff(volume, prepend=0.0) - strain[:, :3].sum(axis=1))[:, None] / 3.0
    return strain


def _check(name: str, count: int, along: Any) -> None:
    law = LAWS[name]
    answers = [np.zeros(count) for _ in range(4)]
    along(law, _strain(count), np.zeros((max(1, state_rows(law)), 1)), *answers)
    errors, doubts, skew, flows = answers
    scale = laws.sound_speed(law, 1.0) ** 2
    smooth = doubts < 1e-8 * scale  # both steps agree: no border of the law's regions between
    assert smooth.mean() > 0.9
    assert errors[smooth].max() < 1e-6 * scale
    if state_rows(law):
        assert (flows[smooth] > 0.0).mean() > 0.1
    if name in SYMMETRIC:
        assert skew[smooth].max() < 1e-6 * scale
    else:
        assert skew[smooth].max() > 1e-3 * scale


@pytest.mark.parametrize("name", LAWS)
def test_the_tangent_is_the_derivative_of_the_update(name: str) -> None:
    """Not compiled: the bodies are plain Python."""
    _check(name, ANEW, _along(step, differences))


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_the_tangent_at_many_states(name: str) -> None:
    _check(name, 100_000, kernel(_along(kernel(step), kernel(differences))))
