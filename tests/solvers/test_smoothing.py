"""The smoothing kernels and the fast inverse root."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from zrno.solvers.sph.smoothing import (
    NAMES,
    inverse_root,
    normaliser,
    shape_of,
    slope_at,
    value_at,
)


@pytest.mark.parametrize("dimension", [1, 2, 3])
@pytest.mark.parametrize("name", NAMES)
def test_the_integral_is_one(name: str, dimension: int) -> None:
    shape = shape_of(name, dimension)
    shell = {1: lambda q: 2.0, 2: lambda q: 2.0 * np.pi * q, 3: lambda q: 4.0 * np.pi * q * q}[dimension]
    total, _ = quad(
        lambda q: normaliser(shape, dimension) * value_at(shape, q) * shell(q), 0.0, shape.support,
        points=[1.0, 2.0][: int(shape.support) - 1] or None, epsabs=1e-13,
    )  # fmt: skip
    assert total == pytest.approx(1.0, abs=1e-10)


@pytest.mark.parametrize("dimension", [1, 3])
@pytest.mark.parametrize("name", NAMES)
def test_the_slope_is_the_derivative_and_nothing_reaches_beyond_the_support(name: str, dimension: int) -> None:
    shape = shape_of(name, dimension)
    for q in np.array([0.02, 0.2, 0.499, 0.501, 0.85, 0.999]) * shape.support:
        step = 1e-6
        numeric = (value_at(shape, q + step) - value_at(shape, q - step)) / (2.0 * step)
        assert slope_at(shape, q) * q == pytest.approx(numeric, rel=1e-6, abs=1e-8 * value_at(shape, 0.0))
    assert (
        value_at(shape, shape.support)
        == value_at(shape, 1.5 * shape.support)
        == slope_at(shape, 1.2 * shape.support)
        == 0.0
    )


def test_an_unknown_kernel_is_refused_with_the_names_there_are() -> None:
    with pytest.raises(ValueError, match="no smoothing kernel cubc; there are: cubic, quintic"):
        shape_of("cubc", 3)


def test_inverse_root_is_exact_to_two_in_1e14() -> None:
    for s in np.logspace(-30, 30, 2001):
        assert inverse_root(s) == pytest.approx(s**-0.5, rel=2e-13 if s < 1e-28 else 3e-14)
