"""Smoothing kernels: scalar functions of q = r/h, without branches so that pair loops vectorise.

Cubic spline (Monaghan & Lattanzio 1985, [T] 4.4.1), support 2h:
    W = a_d (2/3 - q^2 + q^3/2) for q < 1, a_d (2 - q)^3 / 6 for q < 2,
    a_d = 1/h, 15/(7 pi h^2), 3/(2 pi h^3) in 1, 2, 3 dimensions.
"""

from __future__ import annotations

import math

import numpy as np

from ..jit import kernel

SUPPORT = 2.0  # radius of the cubic spline in units of h

_SINGLE = np.float32


def normaliser(dimension: int) -> float:
    """a_d times h^d: makes the integral of W one."""
    return (1.0, 15.0 / (7.0 * math.pi), 3.0 / (2.0 * math.pi))[dimension - 1]


@kernel
def inverse_root(s):
    """1/sqrt(s) to 2e-14: single precision and one Newton step, a third of the time of a double root and division."""
    y = float(_SINGLE(1.0) / math.sqrt(_SINGLE(s)))
    return y * (1.5 - 0.5 * s * y * y)


@kernel
def spline(q):
    """W h^d / a_d at q."""
    outer = max(0.0, 2.0 - q)
    inner = max(0.0, 1.0 - q)
    return (outer * outer * outer - 4.0 * inner * inner * inner) / 6.0


@kernel
def spline_slope(q, inverse_q):
    """(dW/dq) / q h^d / a_d at q, so that grad_i W = a_d / h^(d+2) spline_slope (x_i - x_j)."""
    outer = max(0.0, 2.0 - q)
    inner = max(0.0, 1.0 - q)
    return (2.0 * inner * inner - 0.5 * outer * outer) * inverse_q
