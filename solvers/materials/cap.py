"""Generalised cap model: a failure envelope, an elliptic or flat cap that hardens by compaction, a tension cut-off.

Source: [T] 4.6.3, after DiMaggio & Sandler 1971, Sandler & Rubin 1979; LS-DYNA MAT_025. Here compression is positive,
I = -(s_xx + s_yy + s_zz), J = sqrt(J2); names in brackets are LS-DYNA's.
- envelope  J <= Fe(I) = k - gamma exp(-B1 I) + theta I                           (k alpha, B1 beta)     (4.6.3.15)
- cap       (I - L)^2 + R^2 J^2 <= R^2 Fe(L)^2 where I > L; R = 0: I <= L                               (4.6.3.9-12)
- hardening epv = h(X), X = L + R Fe(L) (see `compaction`); the only history is L, which starts where X = X0
- L >= 0 and so epv >= h(R Fe(0)): without this limit a cohesionless cap would turn inside out at the first dilation
- soil: dilation on the envelope moves the cap back until its corner (I = L) meets the stress, then no more volumetric
  flow. Rock (LS-DYNA ftype 2): the cap never moves back
- tension   I >= T: beyond it the stress becomes the pressure T/3, without shear; the cap stays. T is not below the
  envelope's apex Fe(I) = 0. With `keeps_shear` I = T is a surface of its own instead, as in `drucker_prager`
- flow is associated on each surface, and between the two normals where they meet
- kinematic (`KinematicCap`): the surfaces are those of s - a, da = C F dep', F = 1 - (s - a):a/(2 N Fe) >= 0: a moves
  along the flow until it has N of J there. The limit surface is the envelope moved out by N: to keep it on the
  envelope, give k less N

The return to the surfaces is in `cap_return`. The state's second row is L less its start.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .cap_return import CapHardening, CapHardeningGeneral, cap_return, compaction, envelope, inside
from .invariants import elastic_trial, flow_work, second_invariant
from .law import PLASTIC_STRAIN, law_body, rotate_state, state_rows, stress_update, wave_speed
from .rotation import rotate_rows

GROWTH = 1  # row of L - L(start)


class Cap(NamedTuple):
    """Constants; start: L of the virgin material. State: plastic strain, L - start."""

    lame: float
    shear: float
    k: float
    gamma: float
    decay: float  # B1
    theta: float
    ratio: float  # R
    hardening: CapHardening | CapHardeningGeneral
    tension: float  # T, at least the envelope's apex
    start: float
    soil: bool
    keeps_shear: bool = False


class KinematicCap(NamedTuple):
    """A cap whose surfaces follow the back stress; rate: C [pressure], size: N [pressure]. State: also a (6)."""

    cap: Cap
    rate: float
    size: float


def cap(
    bulk: float,
    shear: float,
    k: float,
    *,
    hardening: CapHardening | CapHardeningGeneral,
    theta: float = 0.0,
    gamma: float = 0.0,
    decay: float = 0.0,
    ratio: float = 0.0,
    tension: float = 0.0,
    soil: bool = True,
    rate: float = 0.0,
    size: float = 0.0,
) -> Cap | KinematicCap:
    """The law of bulk and shear modulus and the constants above; ValueError where they make no sense."""
    if not (bulk > 0.0 and shear > 0.0):
        raise ValueError(f"bulk modulus {bulk!r} and shear modulus {shear!r} must be positive")
    for name, value in (("theta", theta), ("gamma", gamma), ("beta", decay), ("R", ratio), ("C", rate), ("N", size)):
        if not (value >= 0.0 and math.isfinite(value)):
            raise ValueError(f"{name} {value!r} must not be negative")
    if not (k >= gamma and math.isfinite(k)) or (k == gamma and theta + gamma * decay == 0.0):
        raise ValueError(f"alpha {k!r} must not be less than gamma {gamma!r}: the strength without pressure")
    if not (hardening.limit > 0.0 and hardening.decay > 0.0):
        raise ValueError(f"W {hardening.limit!r} and D {hardening.decay!r} must be positive: the cap hardens by them")
    if not tension <= 0.0:
        raise ValueError(f"tension cut-off {tension!r} must not be positive (compression is); without cohesion it is 0")
    if rate > 0.0 and size == 0.0:
        raise ValueError(f"kinematic hardening C {rate!r} needs an N, the size of the back stress")
    law = Cap(
        bulk - 2.0 * shear / 3.0, shear, k, gamma, decay, theta, ratio, hardening, -math.inf, 0.0, soil
    )  # fmt: skip
    least = ratio * (k - gamma)
    if hardening.decay * (hardening.first - least) > 100.0:
        raise ValueError(f"D {hardening.decay!r} and X0 {hardening.first!r} do not belong together: in one unit?")
    law = law._replace(tension=max(tension, _apex(law)), start=_start(law))
    if isinstance(hardening, CapHardeningGeneral):
        _check_hardening(law, least)
    return KinematicCap(law, rate, size) if rate > 0.0 else law


def _strength(law: Cap, first: float) -> float:
    return law.k - law.gamma * math.exp(-law.decay * first) + law.theta * first


def _apex(law: Cap) -> float:
    """I where the envelope has no strength left, -inf without one."""
    if _strength(law, 0.0) == 0.0:
        return 0.0
    if law.theta + law.gamma * law.decay == 0.0:
        return -math.inf
    low = -(law.k - law.gamma) / (law.theta + law.gamma * law.decay)  # the envelope lies below its tangent at 0
    return _bisect(law, 0.0, 0.0, low, 0.0)


def _start(law: Cap) -> float:
    """L where L + R Fe(L) = X0, at least 0."""
    first = law.hardening.first
    return 0.0 if first <= law.ratio * _strength(law, 0.0) else _bisect(law, 1.0, first, 0.0, first)


def _bisect(law: Cap, share: float, target: float, low: float, high: float) -> float:
    """Where share I + (R if share else 1) Fe(I) = target, from a bracket; on the upper side of it."""
    weight = law.ratio if share else 1.0
    while low < (middle := 0.5 * (low + high)) < high:
        if share * middle + weight * _strength(law, middle) < target:
            low = middle
        else:
            high = middle
    return high


def _check_hardening(law: Cap, least: float) -> None:
    """The general hardening may fall back: that is no hardening, and has no one cap for a compaction."""
    span = 40.0 / law.hardening.decay
    for k in range(4001):
        _, slope = compaction(law.hardening, least + span * k / 4000.0)
        if slope < 0.0:
            raise ValueError("the cap's compaction must grow with X: alpha, D1, D2, W1 or D3 make it fall")


@law_body(stress_update, Cap)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    bulk = law.lame + 2.0 / 3.0 * law.shear
    trial = mean + bulk * volumetric
    root = math.sqrt(second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    centre = max(0.0, law.start + state[GROWTH, i])
    work = 0.0
    if inside(law, -3.0 * trial, root, centre):
        mean = trial
    else:
        first, new, centre = cap_return(law, law.shear, -3.0 * trial, root, centre)
        scale = new / root if root > 0.0 else 0.0
        along = s_xx * x_xx + s_yy * x_yy + s_zz * x_zz + 2.0 * (s_xy * x_xy + s_yz * x_yz + s_zx * x_zx)
        work = flow_work(bulk, law.shear, mean, trial, -first / 3.0, along, root, scale)
        mean = -first / 3.0
        state[PLASTIC_STRAIN, i] += (root - new) / (math.sqrt(3.0) * law.shear)
        state[GROWTH, i] = centre - law.start
        x_xx *= scale
        x_yy *= scale
        x_zz *= scale
        x_xy *= scale
        x_yz *= scale
        x_zx *= scale
    return x_xx + mean, x_yy + mean, x_zz + mean, x_xy, x_yz, x_zx, work


@law_body(stress_update, KinematicCap)
def _kinematic(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.cap.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    bulk = law.cap.lame + 2.0 / 3.0 * law.cap.shear
    trial = mean + bulk * volumetric
    a_xx = state[2, i]
    a_yy = state[3, i]
    a_zz = state[4, i]
    a_xy = state[5, i]
    a_yz = state[6, i]
    a_zx = state[7, i]
    x_xx -= a_xx
    x_yy -= a_yy
    x_zz -= a_zz
    x_xy -= a_xy
    x_yz -= a_yz
    x_zx -= a_zx
    root = math.sqrt(second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx))
    centre = max(0.0, law.cap.start + state[GROWTH, i])
    work = 0.0
    if inside(law.cap, -3.0 * trial, root, centre):
        mean = trial
    else:
        first = -3.0 * trial
        along = 0.0
        if root > 0.0:
            along = (a_xx * x_xx + a_yy * x_yy + a_zz * x_zz + 2.0 * (a_xy * x_xy + a_yz * x_yz + a_zx * x_zx)) / root
        # F at the end of the increment, by the flow that the overshoot would take; along it a cannot pass N
        over = max(0.0, root - envelope(law.cap, max(first, law.cap.tension))[0])
        share = max(0.0, 1.0 - along / (2.0 * law.size)) / (1.0 + 0.5 * law.rate * over / (law.cap.shear * law.size))
        shear = law.cap.shear + 0.5 * law.rate * share
        cut = first < law.cap.tension and not law.cap.keeps_shear
        first, new, centre = cap_return(law.cap, shear, first, root, centre)
        scale = new / root if root > 0.0 else 0.0
        old = s_xx * x_xx + s_yy * x_yy + s_zz * x_zz + 2.0 * (s_xy * x_xy + s_yz * x_yz + s_zx * x_zx)
        work = flow_work(bulk, shear, mean, trial, -first / 3.0, old - along * root, root, scale)
        mean = -first / 3.0
        back = 0.5 * law.rate * share * (1.0 - scale) / shear
        if root > 0.0:
            back = min(back, max(0.0, law.size - 0.5 * along) / root)
        a_xx = 0.0 if cut else a_xx + back * x_xx
        a_yy = 0.0 if cut else a_yy + back * x_yy
        a_zz = 0.0 if cut else a_zz + back * x_zz
        a_xy = 0.0 if cut else a_xy + back * x_xy
        a_yz = 0.0 if cut else a_yz + back * x_yz
        a_zx = 0.0 if cut else a_zx + back * x_zx
        state[2, i] = a_xx
        state[3, i] = a_yy
        state[4, i] = a_zz
        state[5, i] = a_xy
        state[6, i] = a_yz
        state[7, i] = a_zx
        state[PLASTIC_STRAIN, i] += (root - new) / (math.sqrt(3.0) * shear)
        state[GROWTH, i] = centre - law.cap.start
        x_xx *= scale
        x_yy *= scale
        x_zz *= scale
        x_xy *= scale
        x_yz *= scale
        x_zx *= scale
    return x_xx + a_xx + mean, x_yy + a_yy + mean, x_zz + a_zz + mean, x_xy + a_xy, x_yz + a_yz, x_zx + a_zx, work


@law_body(rotate_state, KinematicCap)
def _rotate(law, w_xy, w_yz, w_zx, state, i):
    rotate_rows(w_xy, w_yz, w_zx, state, 2, i)


@law_body(wave_speed, KinematicCap)
def _wave(law, rho, e, state, i):
    return math.sqrt((law.cap.lame + 2.0 * law.cap.shear) / rho)


@law_body(state_rows, Cap)
def _rows(law):
    return 2


@law_body(state_rows, KinematicCap)
def _more_rows(law):
    return 8
