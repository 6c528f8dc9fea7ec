"""Equations of state, all linear in the energy: p = A(rho) + B(rho) e, compression positive, e per unit mass.

So the pressure at the end of a step, whose own work enters e, has a closed form (`implicit_pressure`), and the speed of
sound is c^2 = dp/drho + B p/rho^2. mu = rho/rho0 - 1; energies per volume of the decks are rho0 e. Sources: LS-DYNA
EOS_001 and EOS_004; Monaghan 1994; Murnaghan 1944.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..jit import kernel
from .law import dispatched, law_body

LEAST_ROOM = 0.05  # the shock fits have an infinite pressure at a finite density: their denominator stops here


class LinearPolynomial(NamedTuple):
    """p = C0 + C1 mu + C2 mu^2 + C3 mu^3 + (C4 + C5 mu + C6 mu^2) rho0 e; C2 and C6 count in compression only."""

    density: float
    c0: float
    c1: float
    c2: float
    c3: float
    c4: float
    c5: float
    c6: float


class Gruneisen(NamedTuple):
    """Shock velocity C + S1 up + S2 (up/us) up + S3 (up/us)^2 up, Gruneisen's gamma0 and its correction a.

    p = rho0 C^2 mu (1 + (1 - gamma0/2) mu - a mu^2/2)/(1 - (S1 - 1) mu - S2 mu^2/(mu + 1) - S3 mu^3/(mu + 1)^2)^2
    + (gamma0 + a mu) rho0 e in compression, rho0 C^2 mu + (gamma0 + a mu) rho0 e in expansion.
    """

    density: float
    c: float
    s1: float
    s2: float
    s3: float
    gamma: float
    a: float


class PerfectGas(NamedTuple):
    """p = (gamma - 1) rho e."""

    gamma: float


class Tait(NamedTuple):
    """Murnaghan's, of water Tait's: p = B ((rho/rho0)^gamma - 1)."""

    density: float
    b: float
    gamma: float


class MieGruneisen(NamedTuple):
    """p = pH + Gamma rho (e - eH) about the Hugoniot us = C + S up, Gamma = gamma0 (rho0/rho)^b.

    With eta = 1 - rho0/rho: pH = rho0 C^2 eta/(1 - S eta)^2, eH = pH eta/(2 rho0); in expansion pH = rho0 C^2 mu,
    eH = 0.
    e counts from the initial temperature T0; e = cv (T - T0) is the temperature at the initial density.
    """

    density: float
    c: float
    s: float
    gamma: float
    b: float


class Monaghan(NamedTuple):
    """p = c0^2 (rho - rho0)."""

    density: float
    c: float


@dispatched
def coefficients(eos, rho):
    """A, dA/drho, B, dB/drho of p = A + B e."""
    raise NotImplementedError("no equation of state of that class")


@law_body(coefficients, LinearPolynomial)
def _linear_polynomial(eos, rho):
    mu = rho / eos.density - 1.0
    c2 = eos.c2 if mu > 0.0 else 0.0
    c6 = eos.c6 if mu > 0.0 else 0.0
    return (
        eos.c0 + mu * (eos.c1 + mu * (c2 + mu * eos.c3)),
        (eos.c1 + mu * (2.0 * c2 + mu * 3.0 * eos.c3)) / eos.density,
        eos.density * (eos.c4 + mu * (eos.c5 + mu * c6)),
        eos.c5 + 2.0 * mu * c6,
    )


@law_body(coefficients, Gruneisen)
def _gruneisen(eos, rho):
    mu = rho / eos.density - 1.0
    a, slope = mu, 1.0
    if mu > 0.0:
        x = mu / (mu + 1.0)
        room = 1.0 - (eos.s1 - 1.0) * mu - mu * x * (eos.s2 + eos.s3 * x)
        # dx/dmu = (1 - x)^2, and mu (1 - x) = x
        closing = -(eos.s1 - 1.0) - x * (eos.s2 + eos.s3 * x) - x * (1.0 - x) * (eos.s2 + 2.0 * eos.s3 * x)
        if room < LEAST_ROOM:
            room, closing = LEAST_ROOM, 0.0
        above = mu * (1.0 + mu * (1.0 - 0.5 * eos.gamma - 0.5 * eos.a * mu))
        rise = 1.0 + mu * (2.0 - eos.gamma - 1.5 * eos.a * mu)
        a = above / (room * room)
        slope = (rise - 2.0 * above * closing / room) / (room * room)
    stiffness = eos.density * eos.c * eos.c
    return stiffness * a, eos.c * eos.c * slope, eos.density * (eos.gamma + eos.a * mu), eos.a


@law_body(coefficients, PerfectGas)
def _perfect_gas(eos, rho):
    return 0.0, 0.0, (eos.gamma - 1.0) * rho, eos.gamma - 1.0


@law_body(coefficients, Tait)
def _tait(eos, rho):
    power = math.pow(rho / eos.density, eos.gamma)
    return eos.b * (power - 1.0), eos.b * eos.gamma * power / rho, 0.0, 0.0


@law_body(coefficients, MieGruneisen)
def _mie_gruneisen(eos, rho):
    mu = rho / eos.density - 1.0
    gamma = eos.gamma * math.pow(1.0 + mu, -eos.b)
    b = gamma * rho
    b_slope = gamma * (1.0 - eos.b)
    c2 = eos.c * eos.c
    if mu <= 0.0:
        return eos.density * c2 * mu, c2, b, b_slope
    eta = mu / (1.0 + mu)
    room = 1.0 - eos.s * eta
    closing = -eos.s
    if room < LEAST_ROOM:
        room, closing = LEAST_ROOM, 0.0
    shock = eos.density * c2 * eta / (room * room)
    energy = 0.5 * shock * eta / eos.density
    turn = eos.density / (rho * rho)  # d eta/drho
    shock_slope = eos.density * c2 * (1.0 - 2.0 * eta * closing / room) / (room * room) * turn
    energy_slope = 0.5 * (shock_slope * eta + shock * turn) / eos.density
    return shock - b * energy, shock_slope - b_slope * energy - b * energy_slope, b, b_slope


@law_body(coefficients, Monaghan)
def _monaghan(eos, rho):
    return eos.c * eos.c * (rho - eos.density), eos.c * eos.c, 0.0, 0.0


@kernel
def implicit_pressure(eos, rho, e, volumetric, before, work):
    """p at the end of an increment of volume whose own work, by the mean pressure, is taken from e.

    before: p at its start; work: of the deviator per volume. The caller is to let e grow by the same sum, over the mean
    of the densities before and after, rho the one after and the ratio of the two (1 - tr/2)/(1 + tr/2): rho (1 - tr) is
    of the first order, and a vibration then heats.
    """
    a, _, b, _ = coefficients(eos, rho)
    specific = (1.0 - 0.5 * volumetric) / rho  # 1 over the mean density
    # an increment that more than halves the volume has no such answer; it gets a finite one
    room = max(0.5, 1.0 + 0.5 * b * specific * volumetric)
    return (a + b * (e + specific * (work - 0.5 * before * volumetric))) / room


@kernel
def squared_sound(eos, rho, e):
    """(dp/drho at constant entropy), at least 0."""
    a, a_slope, b, b_slope = coefficients(eos, rho)
    return max(0.0, a_slope + b_slope * e + b * (a + b * e) / (rho * rho))
