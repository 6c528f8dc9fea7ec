"""Smoothing kernels: shapes of q = r/h, without branches so that pair loops vectorise.

A shape is a NamedTuple; jitted loops call `shape_value` and `shape_slope` with it, and `numba.extending.overload` picks
the body by its class. W = a_d / h^d value(q), grad_i W = a_d / h^(d+2) slope(q) (x_i - x_j). Each is zero beyond its
support, which a pair loop relies on: a Verlet list holds pairs farther away.

Sources: [T] 4.4.1 (Lucy 1977; Monaghan & Lattanzio 1985, cubic; Morris 1996, quintic; Gingold & Monaghan 1977,
Gaussian), Wendland 1995 in the scaling of Dehnen & Aly 2012 to a support of 2 h.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numba.extending import overload

from ..jit import FASTMATH, kernel

_SINGLE = np.float32
_OPTIONS = {"fastmath": FASTMATH, "error_model": "numpy"}


@kernel
def inverse_root(s):
    """1/sqrt(s) to 2e-14: single precision and one Newton step, a third of the time of a double root and division."""
    y = float(_SINGLE(1.0) / math.sqrt(_SINGLE(s)))
    return y * (1.5 - 0.5 * s * y * y)


class Cubic(NamedTuple):
    """2/3 - q^2 + q^3/2 for q < 1, (2 - q)^3 / 6 for q < 2. The default, and the only one of the original program."""

    support: float = 2.0


class Quintic(NamedTuple):
    """(3 - q)^5 - 6 (2 - q)^5 + 15 (1 - q)^5, each where it is positive; support 3 h."""

    support: float = 3.0


class Lucy(NamedTuple):
    """(1 + 3 q)(1 - q)^3; support h: take h twice as long as for the cubic spline."""

    support: float = 1.0


class Gaussian(NamedTuple):
    """exp(-q^2), cut at 3 h and normalised with the cut (4e-4 of it would be lost in 3D)."""

    support: float = 3.0


class WendlandC2(NamedTuple):
    """(1 - q/2)^4 (1 + 2 q): does not pair at any number of neighbours; 2D and 3D."""

    support: float = 2.0


class WendlandC2Line(NamedTuple):
    """(1 - q/2)^3 (1 + 3 q/2): the C2 function of one dimension."""

    support: float = 2.0


class WendlandC4(NamedTuple):
    """(1 - q/2)^6 (1 + 3 q + 35/12 q^2); 2D and 3D."""

    support: float = 2.0


class WendlandC4Line(NamedTuple):
    """(1 - q/2)^5 (1 + 5/2 q + 2 q^2): the C4 function of one dimension."""

    support: float = 2.0


Shape = Cubic | Quintic | Lucy | Gaussian | WendlandC2 | WendlandC2Line | WendlandC4 | WendlandC4Line

_PI = math.pi
_CUT = (math.erf(3.0), 1.0 - math.exp(-9.0), math.erf(3.0) - 6.0 / math.sqrt(_PI) * math.exp(-9.0))

# a_d in one, two and three dimensions
_NORMAL: dict[type, tuple[float, float, float]] = {
    Cubic: (1.0, 15.0 / (7.0 * _PI), 3.0 / (2.0 * _PI)),
    Quintic: (1.0 / 120.0, 7.0 / (478.0 * _PI), 1.0 / (120.0 * _PI)),
    Lucy: (5.0 / 4.0, 5.0 / _PI, 105.0 / (16.0 * _PI)),
    Gaussian: tuple(_PI ** (-0.5 * d) / _CUT[d - 1] for d in (1, 2, 3)),
    WendlandC2Line: (5.0 / 8.0, math.nan, math.nan),
    WendlandC2: (math.nan, 7.0 / (4.0 * _PI), 21.0 / (16.0 * _PI)),
    WendlandC4Line: (3.0 / 4.0, math.nan, math.nan),
    WendlandC4: (math.nan, 9.0 / (4.0 * _PI), 495.0 / (256.0 * _PI)),
}

NAMES = ("cubic", "quintic", "lucy", "gaussian", "wendland_c2", "wendland_c4")


def shape_of(name: str, dimension: int) -> Shape:
    """The shape of a name in NAMES; ValueError for another name."""
    lines: dict[str, Shape] = {"wendland_c2": WendlandC2Line(), "wendland_c4": WendlandC4Line()}
    shapes: dict[str, Shape] = {
        "cubic": Cubic(), "quintic": Quintic(), "lucy": Lucy(), "gaussian": Gaussian(),
        "wendland_c2": WendlandC2(), "wendland_c4": WendlandC4(),
    }  # fmt: skip
    if name not in shapes:
        raise ValueError(f"no smoothing kernel {name}; there are: {', '.join(NAMES)}")
    return lines.get(name, shapes[name]) if dimension == 1 else shapes[name]


def normaliser(shape: Shape, dimension: int) -> float:
    """a_d: makes the integral of W one."""
    return _NORMAL[type(shape)][dimension - 1]


def shape_value(shape, q):
    """W h^d / a_d at q."""
    raise NotImplementedError("called from jitted code only")


def shape_slope(shape, q, inverse_q):
    """(dW/dq) / q h^d / a_d at q."""
    raise NotImplementedError("called from jitted code only")


def _cubic_value(shape, q):
    outer = max(0.0, 2.0 - q)
    inner = max(0.0, 1.0 - q)
    return (outer * outer * outer - 4.0 * inner * inner * inner) / 6.0


def _cubic_slope(shape, q, inverse_q):
    outer = max(0.0, 2.0 - q)
    inner = max(0.0, 1.0 - q)
    return (2.0 * inner * inner - 0.5 * outer * outer) * inverse_q


def _quintic_value(shape, q):
    a = max(0.0, 3.0 - q)
    b = max(0.0, 2.0 - q)
    c = max(0.0, 1.0 - q)
    return a * a * a * a * a - 6.0 * b * b * b * b * b + 15.0 * c * c * c * c * c


def _quintic_slope(shape, q, inverse_q):
    a = max(0.0, 3.0 - q)
    b = max(0.0, 2.0 - q)
    c = max(0.0, 1.0 - q)
    a *= a
    b *= b
    c *= c
    return (30.0 * b * b - 5.0 * a * a - 75.0 * c * c) * inverse_q


def _lucy_value(shape, q):
    a = max(0.0, 1.0 - q)
    return (1.0 + 3.0 * q) * a * a * a


def _lucy_slope(shape, q, inverse_q):
    a = max(0.0, 1.0 - q)
    return -12.0 * a * a


def _gaussian_value(shape, q):
    return math.exp(-q * q) if q < 3.0 else 0.0


def _gaussian_slope(shape, q, inverse_q):
    return -2.0 * math.exp(-q * q) if q < 3.0 else 0.0


def _c2_value(shape, q):
    a = max(0.0, 1.0 - 0.5 * q)
    a *= a
    return a * a * (1.0 + 2.0 * q)


def _c2_slope(shape, q, inverse_q):
    a = max(0.0, 1.0 - 0.5 * q)
    return -5.0 * a * a * a


def _c2_line_value(shape, q):
    a = max(0.0, 1.0 - 0.5 * q)
    return a * a * a * (1.0 + 1.5 * q)


def _c2_line_slope(shape, q, inverse_q):
    a = max(0.0, 1.0 - 0.5 * q)
    return -3.0 * a * a


def _c4_value(shape, q):
    a = max(0.0, 1.0 - 0.5 * q)
    a *= a
    return a * a * a * (1.0 + 3.0 * q + 35.0 / 12.0 * q * q)


def _c4_slope(shape, q, inverse_q):
    a = max(0.0, 1.0 - 0.5 * q)
    b = a * a
    return -14.0 / 3.0 * b * b * a * (1.0 + 2.5 * q)


def _c4_line_value(shape, q):
    a = max(0.0, 1.0 - 0.5 * q)
    b = a * a
    return b * b * a * (1.0 + 2.5 * q + 2.0 * q * q)


def _c4_line_slope(shape, q, inverse_q):
    a = max(0.0, 1.0 - 0.5 * q)
    a *= a
    return -3.5 * a * a * (1.0 + 2.0 * q)


_BODIES: dict[type, tuple[Any, Any]] = {
    Cubic: (_cubic_value, _cubic_slope),
    Quintic: (_quintic_value, _quintic_slope),
    Lucy: (_lucy_value, _lucy_slope),
    Gaussian: (_gaussian_value, _gaussian_slope),
    WendlandC2: (_c2_value, _c2_slope),
    WendlandC2Line: (_c2_line_value, _c2_line_slope),
    WendlandC4: (_c4_value, _c4_slope),
    WendlandC4Line: (_c4_line_value, _c4_line_slope),
}


@overload(shape_value, jit_options=_OPTIONS)
def _value_of(shape, q):
    return _BODIES[shape.instance_class][0] if isinstance(shape, types.BaseNamedTuple) else None


@overload(shape_slope, jit_options=_OPTIONS)
def _slope_of(shape, q, inverse_q):
    return _BODIES[shape.instance_class][1] if isinstance(shape, types.BaseNamedTuple) else None


@kernel
def value_at(shape, q):
    """`shape_value` for Python."""
    return shape_value(shape, q)


@kernel
def value_many(shape, q):
    """`shape_value` of an array."""
    values = np.empty_like(q)
    for i in range(len(q)):
        values[i] = shape_value(shape, q[i])
    return values


@kernel
def slope_at(shape, q):
    """`shape_slope` for Python."""
    return shape_slope(shape, q, 1.0 / q)
