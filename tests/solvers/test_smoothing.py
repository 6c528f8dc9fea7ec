"""The smoothing kernel and the fast inverse root."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from zrno.solvers.sph.smoothing import SUPPORT, inverse_root, normaliser, spline, spline_slope


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_the_integral_is_one(dimension: int) -> None:
    shell = {1: lambda q: 2.0, 2: lambda q: 2.0 * np.pi * q, 3: lambda q: 4.0 * np.pi * q * q}[dimension]
    total, _ = quad(lambda q: normaliser(dimension) * spline(q) * shell(q), 0.0, SUPPORT, points=[1.0], epsabs=1e-13)
    assert total == pytest.approx(1.0, abs=1e-10)


def test_the_slope_is_the_derivative() -> None:
    for q in (0.05, 0.4, 0.99, 1.01, 1.7, 1.999):
        step = 1e-6
        numeric = (spline(q + step) - spline(q - step)) / (2.0 * step)
        assert spline_slope(q, 1.0 / q) * q == pytest.approx(numeric, rel=1e-6, abs=1e-9)
    assert spline(2.0) == spline(3.0) == spline_slope(2.5, 0.4) == 0.0


def test_inverse_root_is_exact_to_two_in_1e14() -> None:
    for s in np.logspace(-30, 30, 2001):
        assert inverse_root(s) == pytest.approx(s**-0.5, rel=2e-13 if s < 1e-28 else 3e-14)
