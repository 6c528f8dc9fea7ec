"""Material laws at many integration points: stresses from strain increments, with the consistent tangent.

Rows are points; components xx yy zz xy yz zx, shear strains tensor components. One kernel a law serves every element.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...jit import kernel
from ...materials import state_rows
from ...materials.law import stress_update
from ...materials.tangent import stress_and_tangent


def elastic_modulus(law: Any) -> tuple[float, float]:
    """Moduli of the virgin material against uniaxial strain and against shear."""
    rows = max(1, state_rows(law))
    modulus = np.zeros((1, 6, 6))
    stress_and_tangent(law, *[0.0] * 12, 1.0, 0.0, 1.0, np.zeros((rows, 1)), 0, np.zeros((rows, 2)), modulus, 0)
    return float(modulus[0, 0, 0]), float(modulus[0, 3, 3])


ROUNDS = 30  # of the search for the strain through the thickness
SMALL = 1e-12  # of the stiffness times the largest strain
LOST = 1e6  # times that: no answer, which the solver is to see
FLAT = 1e-6  # of the elastic stiffness: on an apex, from where the elastic one leads away


@kernel
def virgin_stiffness(law, rows, dt):
    """Against uniaxial strain."""
    modulus = np.zeros((1, 6, 6))
    stress_and_tangent(
        law, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, dt, np.zeros((rows, 1)), 0,
        np.zeros((rows, 2)), modulus, 0,
    )  # fmt: skip
    return modulus[0, 2, 2]


@kernel
def advance(law, strain, before, stress, state, begin, rho, dt, work, scratch, modulus):
    """New stresses.

    strain: increments (m, 6); before, stress: (m, 6) at the last and at this state; state: (k, n) history variables, of
    which columns begin .. begin + m are these points' and are updated; work: (m,) plastic work per unit volume;
    modulus: (m, 6, 6) or None, without tangent.
    """
    for p in range(strain.shape[0]):
        d, s = strain[p], before[p]
        if modulus is None:
            out = stress_update(
                law, d[0], d[1], d[2], d[3], d[4], d[5], s[0], s[1], s[2], s[3], s[4], s[5], rho, 0.0, dt, state,
                begin + p,
            )  # fmt: skip
        else:
            out = stress_and_tangent(
                law, d[0], d[1], d[2], d[3], d[4], d[5], s[0], s[1], s[2], s[3], s[4], s[5], rho, 0.0, dt, state,
                begin + p, scratch, modulus, p,
            )  # fmt: skip
        stress[p, 0] = out[0]
        stress[p, 1] = out[1]
        stress[p, 2] = out[2]
        stress[p, 3] = out[3]
        stress[p, 4] = out[4]
        stress[p, 5] = out[5]
        work[p] = out[6]


@kernel
def advance_plane_stress(law, strain, before, stress, state, begin, rho, dt, work, scratch, modulus, kept):
    """As `advance`, with the strain zz that leaves no stress zz; it is written into `strain`.

    modulus: (m, 6, 6), with zz condensed out of it: its row and column are zero; kept: (k,) scratch.
    """
    rows = state.shape[0]
    elastic = virgin_stiffness(law, rows, dt)
    for p in range(strain.shape[0]):
        d, s = strain[p], before[p]
        for k in range(rows):
            kept[k] = state[k, begin + p]
        tolerance, stiff = 0.0, 0.0
        for _ in range(ROUNDS):
            for k in range(rows):
                state[k, begin + p] = kept[k]
            out = stress_and_tangent(
                law, d[0], d[1], d[2], d[3], d[4], d[5], s[0], s[1], s[2], s[3], s[4], s[5], rho, 0.0, dt, state,
                begin + p, scratch, modulus, p,
            )  # fmt: skip
            stiff = modulus[p, 2, 2]
            most = max(abs(d[0]), abs(d[1]), abs(d[2]), abs(d[3]), abs(d[4]), abs(d[5]))
            tolerance = SMALL * max(stiff * most, abs(s[0]), abs(s[1]))
            if abs(out[2]) <= tolerance:
                break
            d[2] -= out[2] / (stiff if stiff > FLAT * elastic else elastic)
        stress[p, 0] = out[0] if abs(out[2]) <= LOST * tolerance else np.nan
        stress[p, 1] = out[1]
        stress[p, 2] = 0.0
        stress[p, 3] = out[3]
        stress[p, 4] = out[4]
        stress[p, 5] = out[5]
        work[p] = out[6]
        soft = 1.0 / stiff if stiff > 0.0 else 0.0
        for r in range(6):
            if r != 2:
                factor = modulus[p, r, 2] * soft
                for c in range(6):
                    if c != 2:
                        modulus[p, r, c] -= factor * modulus[p, 2, c]
        for r in range(6):
            modulus[p, r, 2] = 0.0
            modulus[p, 2, r] = 0.0


@kernel
def advance_uniaxial(law, strain, before, stress, state, rho, dt, work, scratch, modulus, kept):
    """As `advance`, of bars: strain, stresses and modulus along them (m,); across them there is no stress.

    The transverse strains that leave none are found by Newton's method, two at a time.
    """
    rows = state.shape[0]
    tangent = np.empty((1, 6, 6))
    for p in range(strain.shape[0]):
        for k in range(rows):
            kept[k] = state[k, p]
        axial, y, z = strain[p], 0.0, 0.0
        for _ in range(ROUNDS):
            for k in range(rows):
                state[k, p] = kept[k]
            out = stress_and_tangent(
                law, axial, y, z, 0.0, 0.0, 0.0, before[p], 0.0, 0.0, 0.0, 0.0, 0.0, rho, 0.0, dt, state, p, scratch,
                tangent, 0,
            )  # fmt: skip
            a, b = tangent[0, 1, 1], tangent[0, 1, 2]
            c, d = tangent[0, 2, 1], tangent[0, 2, 2]
            det = a * d - b * c
            if max(abs(out[1]), abs(out[2])) <= SMALL * max(a * max(abs(axial), abs(y), abs(z)), abs(before[p])):
                break
            y -= (d * out[1] - b * out[2]) / det
            z -= (a * out[2] - c * out[1]) / det
        stress[p] = out[0]
        work[p] = out[6]
        cross_y = (d * tangent[0, 1, 0] - b * tangent[0, 2, 0]) / det
        cross_z = (a * tangent[0, 2, 0] - c * tangent[0, 1, 0]) / det
        modulus[p] = tangent[0, 0, 0] - tangent[0, 0, 1] * cross_y - tangent[0, 0, 2] * cross_z
