"""Sleeping: grain that has come to rest is held where it is, and not computed, until something pushes it.

A particle whose speed, and that of all its neighbours, has stayed under a limit for a time falls asleep: its motion
ends (what it had is dissipated), its place is held. A sleeper with an awake neighbour is `HELD`: strain, law and force
go on, so that action, work and energy are those of any held particle. One whose neighbours all sleep is `DEEP`: nothing
of it changes, and nothing is computed.

What wakes a sleeper is the push that it is given, a speed: push' = (a - a when it fell asleep) - push/tau. It wakes
when that passes the limit, at once if it is pushed hard, in the end if for long with BEARS of its weight, and not by
what swings to and fro. Of the held that is found in each step, of the deep in each LOOK-th, when the forces on all are
found. Who wakes has its neighbours held from then on: a disturbance wakes ring after ring of neighbours.

On a structure nobody falls asleep while what it touches is not quiet, and a sleeper wakes at once when that moves
faster than the limit. It is held while a facet near it moves at all, on one that stands still it may be deep. What it
exerts on facets stays the mean of before (`leaning`). Particles that are nodes of a structure do not sleep.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..jit import kernel
from . import leaning
from .particle import DRIVEN
from .problem import Floats, Problem

AWAKE, HELD, DEEP = 0.0, 1.0, 2.0  # values of the row `still`
LOOK = 32  # steps between looks at all sleepers, and at who may fall asleep
PASSAGES = 100.0  # of a wave through a smoothing length, that a particle has to be quiet for
BEARS = 0.02  # of its weight, that a sleeper holds out against
STANDS = 1e-3  # of the limit of speed: what a facet's way in LOOK steps changes of a force is then within BEARS
TINY = 1e-300  # a time that is none
MEANS = 5.0  # times over which a force is meant, within that
FALLS = 10.0  # times in which gravity makes the limit of the speed, for the same: longer than a throw's turning point


class Resting(NamedTuple):
    """speed: under which a particle is quiet; time: that it must have been so; memory: tau, of its push.

    relaxed: its limit over the step, by what dynamic relaxation bears of a weight that creeps down.
    """

    speed: float
    time: float
    memory: float
    relaxed: float


def resting(p: Problem, wave: Floats) -> Resting | None:
    """The limits of a problem; None where nothing sleeps. wave: (bodies,) speeds, zero of rigid ones.

    ValueError where sleeping is asked for and cannot be.
    """
    if p.sleep <= 0.0:
        return None
    weight = math.sqrt(sum(a * a for a in (p.body_force if p.body_curve is None else p.body_curve[1][-1])))
    hindered = {
        "without a constant base acceleration": weight == 0.0,
        "with total-Lagrangian bodies": any(b.lagrangian for b in p.bodies),
        "with local time steps": p.local_steps is True,
        "with the arithmetic of the original program": p.original,
        "with XSPH": p.cures.xsph > 0.0,
        "with a changing h": p.h_option != 0,
        "in an axisymmetric run": p.axisymmetric,
    }
    for name, there in hindered.items():
        if there:
            raise ValueError(f"particles cannot sleep {name}")
    h = float(p.h.max())
    speed = p.sleep * math.sqrt(weight * h)
    slowest = float(np.min(wave, where=wave > 0.0, initial=np.inf))
    relaxed = BEARS * weight / (1.0 - p.relaxation) if p.relaxation < 1.0 else np.inf
    return Resting(speed, max(PASSAGES * h / slowest, FALLS * speed / weight), speed / (BEARS * weight), relaxed)


def columns(still: Floats) -> dict[str, float]:
    """What the history says of the sleepers. still: the row, (0 | 1, n)."""
    if not len(still):
        return {}
    return {"asleep": float(np.count_nonzero(still)), "deep": float(np.count_nonzero(still == DEEP))}


@kernel
def run_of(i, end, resting, most, still):
    """The first stretch of particles in i..end whose `still` is `most` at most; all where nothing sleeps."""
    if resting is None:
        return i, end
    while i < end and still[i] > most:
        i += 1
    last = i
    while last < end and still[last] <= most:
        last += 1
    return i, last


@kernel
def _restless(i, n, first, count, rows, source, offset, row, least, only, fixed):
    """Whether a listed neighbour's entry of a row is below `least`. source: of images, which stand from offset on.

    only: None, or a bit of `fixed` that counts a neighbour in.
    """
    for k in range(first[i], first[i] + count[i]):
        j = np.int64(rows[k])
        if j >= n:
            if source is None:
                continue  # the dummy
            if j - offset >= len(source):
                continue
            j = source[j - offset]
        if row[j] < least and (only is None or fixed[j] & only):
            return True
    return False


@kernel
def _alone(i, n, cx, source, offset, row, least, only, arrays):
    """Whether no neighbour, of any body, is below `least`; see `_restless`."""
    a = arrays
    if _restless(i, n, a.first, a.count, a.rows, source, offset, row, least, only, a.fixed):
        return False
    return cx is None or not _restless(i, n, a.c_first, a.c_count, a.c_rows, source, offset, row, least, only, a.fixed)


@kernel
def no_diffusion(i0, i1, density_rate, stress_rate, arrays):
    """Sleepers of a range do not diffuse: without the creep that answers it, it would push them awake."""
    for i in range(i0, i1):
        if arrays.still[i] != AWAKE:
            if density_rate is not None:
                density_rate[i] = 0.0
            if stress_rate is not None:
                stress_rate[:, i] = 0.0


@kernel
def wake(i0, i1, n, z, cx, resting, source, offset, driven, faces, look, dt, arrays):
    """Wakes those of a range that have been pushed enough, or whose structure moves; returns whether there are any.

    dt: the last step.
    """
    woken = 0.0
    d = 3 if z is not None else 2
    for i in range(i0, i1):
        if arrays.still[i] == AWAKE or (arrays.still[i] == DEEP and not look):
            continue
        span = LOOK * dt if arrays.still[i] == DEEP else dt
        kept = math.exp(-span / resting.memory)
        speed2 = 0.0
        for k in range(d):
            a = arrays.ax[i] if k == 0 else arrays.ay[i]
            if z is not None and k == 2:
                a = arrays.az[i]
            if (arrays.fixed[i] >> k) & 1 == 0:
                lasting = (a - arrays.push[d + k, i]) * resting.memory
                arrays.push[k, i] = kept * arrays.push[k, i] + (1.0 - kept) * lasting
            speed2 += arrays.push[k, i] ** 2
        called = speed2 > resting.speed * resting.speed
        if faces is not None:
            called = called or leaning.pace(i, faces, True) > resting.speed
        if driven is not None and arrays.still[i] == HELD:
            called = called or not _alone(i, n, cx, source, offset, arrays.quiet, TINY, DRIVEN, arrays)
        if called:
            woken = 1.0
            arrays.still[i] = AWAKE
            arrays.quiet[i] = 0.0
            arrays.u[i] = -0.5 * dt * arrays.ax[i]  # at rest now, half a step after u
            arrays.v[i] = -0.5 * dt * arrays.ay[i]
            if z is not None:
                arrays.w[i] = -0.5 * dt * arrays.az[i]
    return woken


@kernel
def fall_asleep(i0, i1, n, z, cx, resting, source, offset, dt, arrays):
    """Puts those of a range to sleep that have been quiet for long, as have their neighbours. dt: the last step."""
    d = 3 if z is not None else 2
    for i in range(i0, i1):
        if arrays.still[i] != AWAKE or arrays.quiet[i] < resting.time or arrays.fixed[i] & DRIVEN:
            continue
        if not _alone(i, n, cx, source, offset, arrays.quiet, resting.time, None, arrays):
            continue
        motion = 0.0
        for k in range(d):
            a = arrays.ax[i] if k == 0 else arrays.ay[i]
            u = arrays.u[i] if k == 0 else arrays.v[i]
            if z is not None and k == 2:
                a = arrays.az[i]
                u = arrays.w[i]
            if (arrays.fixed[i] >> k) & 1 == 0:
                motion += 0.5 * (u + 0.5 * dt * a) ** 2
            arrays.push[k, i] = 0.0
            arrays.push[d + k, i] = a
        arrays.energy[i] += motion
        arrays.dissipated[i] += motion
        arrays.u[i] = 0.0
        arrays.v[i] = 0.0
        arrays.x_half[i] = arrays.x[i]
        arrays.y_half[i] = arrays.y[i]
        if z is not None:
            arrays.w[i] = 0.0
            arrays.z_half[i] = z[i]
        arrays.still[i] = HELD


@kernel
def settle(i0, i1, n, cx, resting, source, offset, faces, fresh, arrays):
    """Tells the sleepers of a range apart: held beside somebody awake or a facet that moves, deep otherwise.

    fresh: the lists are new, and have no forces of facets yet: who is near one is held.
    """
    for i in range(i0, i1):
        if arrays.still[i] != AWAKE:
            deep = _alone(i, n, cx, source, offset, arrays.still, HELD, None, arrays)
            if faces is not None:
                deep = deep and not (fresh and faces.count[i] > 0)
                deep = deep and leaning.pace(i, faces, False) <= STANDS * resting.speed
            arrays.still[i] = DEEP if deep else HELD


@kernel
def count_quiet(i0, i1, z, resting, faces, dt, arrays):
    """How long each awake particle of a range and the facets that it touches have been quiet, with the step to come."""
    for i in range(i0, i1):
        if arrays.still[i] != AWAKE:
            continue
        speed2 = arrays.u[i] ** 2 + arrays.v[i] ** 2
        if z is not None:
            speed2 += arrays.w[i] ** 2
        quiet = speed2 < min(resting.speed, resting.relaxed * dt) ** 2
        if faces is not None:
            quiet = quiet and leaning.pace(i, faces, True) <= resting.speed
            leaning.remember(i, min(1.0, MEANS * dt / resting.time), faces, arrays.bears)
        arrays.quiet[i] = arrays.quiet[i] + dt if quiet else 0.0
