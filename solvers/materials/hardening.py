"""How a yield stress grows with the plastic strain: linearly or by a table, and the radial return that it asks for.

The return solves |trial| - 3 G d = factor (Y(ep + d) + add) for the plastic strain increment d, exactly.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .law import dispatched, law_body


class Linear(NamedTuple):
    """Y = yield_stress + modulus ep [pressure]."""

    yield_stress: float
    modulus: float


class Table(NamedTuple):
    """Y by straight lines between points: strain (n,) from 0 on, stress (n,) [pressure]; past the last it stays."""

    strain: NDArray[np.float64]
    stress: NDArray[np.float64]


def table(points: Any, shear: float) -> Table:
    """A table of (n, 2) plastic strains and yield stresses; ValueError where it makes no sense."""
    points = np.array(points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 1 or not np.all(np.isfinite(points)):
        raise ValueError("a hardening table needs points of plastic strain and yield stress")
    strain, stress = points.T
    if strain[0] != 0.0:
        raise ValueError(f"a hardening table must begin at plastic strain 0, not {strain[0]:g}")
    if np.any(np.diff(strain) <= 0.0):
        raise ValueError("the plastic strains of a hardening table must grow")
    if np.any(stress <= 0.0):
        raise ValueError("the yield stresses of a hardening table must be positive")
    if np.any(np.diff(stress) <= -3.0 * shear * np.diff(strain)):
        raise ValueError("a hardening table must not fall by more than 3 G of the strain")
    return Table(np.ascontiguousarray(strain), np.ascontiguousarray(stress))


@dispatched
def radial_return(hardening, trial, plastic, shear3, factor, add):
    """d [-], the strength after it [pressure] and the work per volume; trial: sqrt(3 J2), shear3: 3 G."""
    raise NotImplementedError("no hardening of that class")


@law_body(radial_return, Linear)
def _linear(hardening, trial, plastic, shear3, factor, add):
    strength = factor * (hardening.yield_stress + hardening.modulus * plastic + add)
    if trial <= strength:
        return 0.0, strength, 0.0
    slope = factor * hardening.modulus
    increment = (trial - strength) / (shear3 + slope)
    return increment, strength + slope * increment, (strength + 0.5 * slope * increment) * increment


@law_body(radial_return, Table)
def _table(hardening, trial, plastic, shear3, factor, add):
    strain = hardening.strain
    stress = hardening.stress
    last = len(strain) - 1
    k = 0
    while k < last and strain[k + 1] <= plastic:
        k += 1
    increment = 0.0
    work = 0.0
    left = trial
    while True:
        at = plastic + increment
        slope = factor * (stress[k + 1] - stress[k]) / (strain[k + 1] - strain[k]) if k < last else 0.0
        strength = factor * (stress[k] + add) + slope * (at - strain[k])
        if left <= strength:
            return increment, strength, work
        step = (left - strength) / (shear3 + slope)
        if k == last or at + step <= strain[k + 1]:
            return increment + step, strength + slope * step, work + (strength + 0.5 * slope * step) * step
        step = strain[k + 1] - at
        work += (strength + 0.5 * slope * step) * step
        increment += step
        left -= shear3 * step
        k += 1
