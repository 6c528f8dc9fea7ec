"""What the tests of the laws share: paths of random strain, and invariants of stresses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from zrno.solvers.materials.point import Path, drive

Wander = Callable[..., Path]


@pytest.fixture(params=[50_000, pytest.param(1_000_000, marks=pytest.mark.slow)])
def wander(request: pytest.FixtureRequest) -> Wander:
    """Drive a law along random increments of all sizes; the answer is finite, and dissipates nothing negative.

    `wander(law, size)`: increments up to about `size`; the volume wanders within 10 `size` of its start and 30 %.
    """

    def walk(law: Any, size: float, **given: float) -> Path:
        rng = np.random.default_rng(7)
        m = request.param
        strain = rng.normal(size=(m, 6)) * size * 10.0 ** rng.uniform(-4.0, 0.0, size=(m, 1))
        volume = min(10.0 * size, 0.3) * np.sin(np.cumsum(rng.normal(size=m)) * 0.3)
        steps = 2.0 * np.tanh(0.5 * np.diff(volume, prepend=0.0))  # the density is rho (1 - tr/2)/(1 + tr/2)
        strain[:, :3] += (steps - strain[:, :3].sum(axis=1))[:, None] / 3.0
        path = drive(law, strain, **given)
        for answer in path:
            assert np.all(np.isfinite(answer))
        assert path.dissipated.min() >= 0.0
        assert path.dissipated.max() > 0.0
        return path

    return walk


@pytest.fixture(scope="session")
def invariants() -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """I (compression positive) and J = sqrt(J2) of stresses (m, 6)."""

    def of(s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        xx, yy, zz, xy, yz, zx = s.T
        square = ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 6.0 + xy**2 + yz**2 + zx**2
        return -(xx + yy + zz), np.sqrt(square)

    return of


@pytest.fixture(scope="session")
def principals() -> Callable[[np.ndarray], np.ndarray]:
    """Principal stresses (m, 3), the greatest first."""

    def of(s: np.ndarray) -> np.ndarray:
        xx, yy, zz, xy, yz, zx = s.T
        return np.linalg.eigvalsh(np.stack([xx, xy, zx, xy, yy, yz, zx, yz, zz], axis=1).reshape(-1, 3, 3))[:, ::-1]

    return of
