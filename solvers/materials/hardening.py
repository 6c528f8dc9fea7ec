"""How a yield stress grows with the plastic strain: by a line, a table or a power, and the radial return of each.

The return solves |trial| - 3 G d = factor (Y(ep + d) + add) for the plastic strain increment d, exactly.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .law import dispatched, law_body

ITERATIONS = 100  # Newton's from the far side, monotone: fewer than ten but for very small exponents


class Linear(NamedTuple):
    """Y = yield_stress + modulus ep [pressure]."""

    yield_stress: float
    modulus: float


class Table(NamedTuple):
    """Y by straight lines between points: strain (n,) from 0 on, stress (n,) [pressure]; past the last it stays."""

    strain: NDArray[np.float64]
    stress: NDArray[np.float64]


class Power(NamedTuple):
    """Y = yield_stress + factor ep^exponent [pressure]; a yield stress of 0 flows from the first."""

    yield_stress: float
    factor: float
    exponent: float


def power(yield_stress: float, factor: float, exponent: float) -> Power:
    """Ludwik's hardening; ValueError where it makes no sense."""
    if not (yield_stress >= 0.0 and factor > 0.0 and exponent > 0.0 and math.isfinite(yield_stress + factor)):
        raise ValueError(f"yield stress {yield_stress!r} must not be negative, factor {factor!r} and exponent "
                         f"{exponent!r} must be positive")  # fmt: skip
    return Power(yield_stress, factor, exponent)


def ramberg_osgood(young: float, stress: float, exponent: float, offset: float = 0.002) -> Power:
    """e = s/E + offset (s/stress)^exponent: stress is where the plastic strain is `offset`. Flows from the first."""
    if not (young > 0.0 and stress > 0.0 and exponent >= 1.0 and offset > 0.0):
        raise ValueError(f"stress {stress!r} and offset {offset!r} must be positive, exponent {exponent!r} at least 1")
    return power(0.0, stress / offset ** (1.0 / exponent), 1.0 / exponent)


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


@law_body(radial_return, Power)
def _power(hardening, trial, plastic, shear3, factor, add):
    first = factor * (hardening.yield_stress + add)
    size = factor * hardening.factor
    n = hardening.exponent
    strength = first + size * math.pow(plastic, n)
    if trial <= strength:
        return 0.0, strength, 0.0
    most = (trial - strength) / shear3
    if n < 1.0:
        # in the stress s that it ends with: s + 3 G (((s - Y0)/C)^(1/n) - ep) is convex, and Newton from above safe
        p = 1.0 / n
        s = min(trial, first + size * math.pow(plastic + most, n))
        for _ in range(ITERATIONS):
            part = math.pow((s - first) / size, p)
            slope = shear3 * p * part / (s - first) + 1.0 if s > first else 1.0
            change = (s + shear3 * (part - plastic) - trial) / slope
            s -= change
            if not change > 1e-16 * trial:
                break
        s = max(s, strength)
        increment = (trial - s) / shear3
    else:
        increment = most
        for _ in range(ITERATIONS):
            at = plastic + increment
            rise = size * math.pow(at, n)
            change = (shear3 * increment + first + rise - trial) / (shear3 + n * rise / at)
            increment -= change
            if not change > 1e-16 * at:
                break
        s = trial - shear3 * increment
    after = plastic + increment
    grown = (math.pow(after, n) * after - math.pow(plastic, n) * plastic) / (n + 1.0)
    return increment, s, first * increment + size * grown


@dispatched
def yield_at(hardening, plastic):
    """Y [pressure] and its slope at a plastic strain; of a table at a corner: the slope before it."""
    raise NotImplementedError("no hardening of that class")


@law_body(yield_at, Linear)
def _linear_at(hardening, plastic):
    return hardening.yield_stress + hardening.modulus * plastic, hardening.modulus


@law_body(yield_at, Table)
def _table_at(hardening, plastic):
    strain, stress = hardening.strain, hardening.stress
    last = len(strain) - 1
    k = 0
    while k < last and strain[k + 1] < plastic:
        k += 1
    if k == last or plastic > strain[last]:
        return stress[last], 0.0
    slope = (stress[k + 1] - stress[k]) / (strain[k + 1] - strain[k])
    return stress[k] + slope * (plastic - strain[k]), slope


@law_body(yield_at, Power)
def _power_at(hardening, plastic):
    rise = hardening.factor * math.pow(plastic, hardening.exponent)
    return hardening.yield_stress + rise, hardening.exponent * rise / plastic if plastic > 0.0 else 0.0
