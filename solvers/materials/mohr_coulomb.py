"""Mohr-Coulomb, perfectly plastic, flow by a dilation angle, with a tension cut-off: return in principal stresses.

p1 - p3 + (p1 + p3) sin phi <= 2 c cos phi for every pair of principal stresses (tension positive), p <= T; flow along
(1 + sin psi) of the greater and -(1 - sin psi) of the lesser (de Souza Neto, Peric & Owen 2008, 8.2). Both surfaces are
planes, so each return has a closed form. They are tried in turn, and the first that is admissible (no negative
multiplier, all planes kept) is the answer:
1. one plane: shear p1 p3; tension p1
2. two: the edges p2 = p3 and p1 = p2 of the shear planes, the edge p1 = p2 = T, shear and tension
3. the corners (T, T, T), (T, T, m), (T, m, m), m = (T (1 + sin phi) - 2 c cos phi)/(1 - sin phi): the nearest in
   energy. T is at most the apex c/tan phi, which is the first of them.
A point inside the cone that lies within the hexagon is elastic without any principal stress.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..jit import kernel
from .invariants import elastic_trial, second_invariant
from .law import PLASTIC_STRAIN, lame_constants, law_body, state_rows, stress_update
from .principal import principal


class MohrCoulomb(NamedTuple):
    """lame, shear; cohesive: 2 c cos phi; sine, flow: of phi and psi; tension: T. State: plastic strain."""

    lame: float
    shear: float
    cohesive: float
    sine: float
    flow: float
    tension: float


def mohr_coulomb(
    young: float, poisson: float, cohesion: float, friction: float, dilation: float = 0.0, *, tension: float = math.inf
) -> MohrCoulomb:
    """The law of cohesion [pressure], friction and dilation angle [degrees]. tension: the greatest principal stress."""
    if not (cohesion >= 0.0 and math.isfinite(cohesion)):
        raise ValueError(f"cohesion {cohesion!r} must not be negative")
    if not 0.0 <= friction < 90.0:
        raise ValueError(f"friction angle {friction!r} must lie between 0 and 90 degrees")
    if not 0.0 <= dilation <= friction:
        raise ValueError(f"dilation angle {dilation!r} must lie between 0 and the friction angle {friction!r}")
    if cohesion == 0.0 and friction == 0.0:
        raise ValueError("cohesion and friction angle must not both be 0")
    if not tension >= 0.0:
        raise ValueError(f"tension cut-off {tension!r} must not be negative: it is the greatest principal stress")
    angle = math.radians(friction)
    apex = cohesion / math.tan(angle) if friction > 0.0 else math.inf
    return MohrCoulomb(
        *lame_constants(young, poisson),
        2.0 * cohesion * math.cos(angle),
        math.sin(angle),
        math.sin(math.radians(dilation)),
        min(tension, apex),
    )


@kernel
def kept(law, p1, p2, p3, slack):
    """Whether all planes are kept."""
    top = max(p1, p2, p3)
    low = min(p1, p2, p3)
    return (1.0 + law.sine) * top - (1.0 - law.sine) * low <= law.cohesive + slack and top <= law.tension + slack


@kernel
def taken(law, a1, a2, a3, r1, r2, r3):
    """a . D r: what a multiplier of the flow r takes off the plane a; D is Hooke's."""
    return law.lame * (a1 + a2 + a3) * (r1 + r2 + r3) + 2.0 * law.shear * (a1 * r1 + a2 * r2 + a3 * r3)


@kernel
def _pair(law, p1, p2, p3, a, f_a, b, f_b, r, q):
    """The return to the planes a and b by the flows r and q, and the lesser multiplier; f: the planes' excess."""
    aa = taken(law, a[0], a[1], a[2], r[0], r[1], r[2])
    ab = taken(law, a[0], a[1], a[2], q[0], q[1], q[2])
    ba = taken(law, b[0], b[1], b[2], r[0], r[1], r[2])
    bb = taken(law, b[0], b[1], b[2], q[0], q[1], q[2])
    below = aa * bb - ab * ba
    m = (f_a * bb - f_b * ab) / below
    n = (f_b * aa - f_a * ba) / below
    spread = law.lame * (m * (r[0] + r[1] + r[2]) + n * (q[0] + q[1] + q[2]))
    g2 = 2.0 * law.shear
    return (
        p1 - spread - g2 * (m * r[0] + n * q[0]),
        p2 - spread - g2 * (m * r[1] + n * q[1]),
        p3 - spread - g2 * (m * r[2] + n * q[2]),
        min(m, n),
    )


@kernel
def planes(law, case):
    """What a case returns to: the first plane and its flow, the second plane and its flow (0 in cases 0 and 1)."""
    up, down = 1.0 + law.sine, 1.0 - law.sine
    rise, fall = 1.0 + law.flow, 1.0 - law.flow
    none = (0.0, 0.0, 0.0)
    e1 = (1.0, 0.0, 0.0)
    e2 = (0.0, 1.0, 0.0)
    a, r = (up, 0.0, -down), (rise, 0.0, -fall)
    if case == 1 or case == 4:
        a, r = e1, e1
    b, q = none, none
    if case == 2:
        b, q = (up, -down, 0.0), (rise, -fall, 0.0)
    elif case == 3:
        b, q = (0.0, up, -down), (0.0, rise, -fall)
    elif case == 4:
        b, q = e2, e2
    elif case == 5:
        b, q = e1, e1
    return a, r, b, q


@kernel
def mohr_coulomb_return(law, p1, p2, p3):
    """The principal stresses on the surfaces, and the case, 0..5 (`planes`) or -1 for a corner; p1 >= p2 >= p3 is the
    trial, outside."""
    slack = 1e-13 * (abs(p1) + abs(p3) + law.cohesive)
    up, down = 1.0 + law.sine, 1.0 - law.sine
    f13 = up * p1 - down * p3 - law.cohesive
    f12 = up * p1 - down * p2 - law.cohesive
    f23 = up * p2 - down * p3 - law.cohesive
    t1 = p1 - law.tension
    t2 = p2 - law.tension
    finite = law.tension < math.inf
    for case in range(6):
        a, r, b, q = planes(law, case)
        f_a = t1 if case == 1 or case == 4 else f13
        f_b = f12 if case == 2 else f23 if case == 3 else t2 if case == 4 else t1
        if not finite and (case == 1 or case >= 4):
            continue
        if case < 2:
            m = f_a / taken(law, a[0], a[1], a[2], r[0], r[1], r[2])
            spread = law.lame * m * (r[0] + r[1] + r[2])
            g2 = 2.0 * law.shear * m
            n1, n2, n3 = p1 - spread - g2 * r[0], p2 - spread - g2 * r[1], p3 - spread - g2 * r[2]
        else:
            n1, n2, n3, m = _pair(law, p1, p2, p3, a, f_a, b, f_b, r, q)
        if m >= 0.0 and kept(law, n1, n2, n3, slack):
            return n1, n2, n3, case
    low = min(law.tension, (up * law.tension - law.cohesive) / down)
    best1, best2, best3 = p1, p2, p3  # a NaN stays one
    least = math.inf
    for corner in range(3):
        n2 = law.tension if corner < 2 else low
        n3 = law.tension if corner < 1 else low
        d1, d2, d3 = p1 - law.tension, p2 - n2, p3 - n3
        # the complementary energy of the plastic part, times E
        nu2 = law.lame / (law.lame + law.shear)
        energy = d1 * d1 + d2 * d2 + d3 * d3 - nu2 * (d1 * d2 + d2 * d3 + d3 * d1)
        if energy < least:
            least = energy
            best1, best2, best3 = law.tension, n2, n3
    return best1, best2, best3, -1


@kernel
def well_inside(law, mean, square):
    """Within the inner cone J sqrt(3 + sin^2 phi) <= c cos phi - mean sin phi, and J 2/sqrt 3 <= T - mean."""
    room = 0.5 * law.cohesive - mean * law.sine
    left = law.tension - mean
    inner = room >= 0.0 and square * (3.0 + law.sine**2) <= 3.0 * room * room
    return inner and left >= 0.0 and 4.0 * square <= 3.0 * left * left


@law_body(stress_update, MohrCoulomb)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    volumetric, mean, x_xx, x_yy, x_zz, x_xy, x_yz, x_zx = elastic_trial(
        law.shear, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    )
    mean += (law.lame + 2.0 / 3.0 * law.shear) * volumetric
    square = second_invariant(x_xx, x_yy, x_zz, x_xy, x_yz, x_zx)
    if well_inside(law, mean, square):
        return x_xx + mean, x_yy + mean, x_zz + mean, x_xy, x_yz, x_zx, 0.0
    n_xx, n_yy, n_zz, n_xy, n_yz, n_zx = _principal_return(
        law, x_xx + mean, x_yy + mean, x_zz + mean, x_xy, x_yz, x_zx, state, i
    )
    # by the mean of old and new stress, as in `flow_work`: plastic strains by Hooke's inverse
    g2 = 2.0 * law.shear
    d_xx, d_yy, d_zz = x_xx + mean - n_xx, x_yy + mean - n_yy, x_zz + mean - n_zz
    share = law.lame / (3.0 * law.lame + g2) * (d_xx + d_yy + d_zz)
    work = (s_xx + n_xx) * (d_xx - share) + (s_yy + n_yy) * (d_yy - share) + (s_zz + n_zz) * (d_zz - share)
    work += 2.0 * ((s_xy + n_xy) * (x_xy - n_xy) + (s_yz + n_yz) * (x_yz - n_yz) + (s_zx + n_zx) * (x_zx - n_zx))
    return n_xx, n_yy, n_zz, n_xy, n_yz, n_zx, max(0.0, 0.5 * work / g2)


@kernel
def sorted_principal(s_xx, s_yy, s_zz, s_xy, s_yz, s_zx):
    """As `principal`, the greatest value first."""
    p, q, r, ax, bx, cx, ay, by, cy, az, bz, cz = principal(s_xx, s_yy, s_zz, s_xy, s_yz, s_zx)
    if p < q:
        p, q, ax, bx, ay, by, az, bz = q, p, bx, ax, by, ay, bz, az
    if q < r:
        q, r, bx, cx, by, cy, bz, cz = r, q, cx, bx, cy, by, cz, bz
    if p < q:
        p, q, ax, bx, ay, by, az, bz = q, p, bx, ax, by, ay, bz, az
    return p, q, r, ax, bx, cx, ay, by, cy, az, bz, cz


@kernel
def _principal_return(law, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, state, i):
    p, q, r, ax, bx, cx, ay, by, cy, az, bz, cz = sorted_principal(s_xx, s_yy, s_zz, s_xy, s_yz, s_zx)
    if kept(law, p, q, r, 0.0):
        return s_xx, s_yy, s_zz, s_xy, s_yz, s_zx
    n, m, l, _ = mohr_coulomb_return(law, p, q, r)
    d1, d2, d3 = p - n, q - m, r - l
    square = (d1 - d2) ** 2 + (d2 - d3) ** 2 + (d3 - d1) ** 2
    state[PLASTIC_STRAIN, i] += math.sqrt(2.0 * square) / (6.0 * law.shear)
    return (
        n * ax * ax + m * bx * bx + l * cx * cx,
        n * ay * ay + m * by * by + l * cy * cy,
        n * az * az + m * bz * bz + l * cz * cz,
        n * ax * ay + m * bx * by + l * cx * cy,
        n * ay * az + m * by * bz + l * cy * cz,
        n * az * ax + m * bz * bx + l * cz * cx,
    )


@law_body(state_rows, MohrCoulomb)
def _rows(law):
    return 1
