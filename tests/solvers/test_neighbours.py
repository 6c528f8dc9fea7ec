"""The neighbour list against a tree and against all pairs."""

from __future__ import annotations

import time

import numpy as np
import pytest
from scipy.spatial import cKDTree

from zrno.solvers.neighbours import LANES, Cells, NeighbourList


def cloud(n: int, dimension: int, seed: int = 0) -> np.ndarray:
    """(3, n + 1) random points in the unit box, the dummy far away."""
    x = np.random.default_rng(seed).random((3, n + 1))
    x[dimension:] = 0.0
    x[:dimension, n] = 1e9
    return x


def sort(x: np.ndarray, dimension: int, radius: float) -> tuple[Cells, np.ndarray]:
    n = x.shape[1] - 1
    third = x[2] if dimension == 3 else None
    x[:, :n] = x[:, Cells(n, x[0], x[1], third, radius).order]
    return Cells(n, x[0], x[1], x[2] if dimension == 3 else None, radius), x


def found(pairs: NeighbourList, i: int) -> list[int]:
    row = pairs.rows[pairs.first[i] : pairs.first[i] + pairs.count[i]]
    assert len(row) % LANES == 0
    return sorted(int(j) for j in row if j < pairs.n)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("n", [1, 7, 3000])
@pytest.mark.parametrize("threads", [1, 2])
def test_one_radius(dimension: int, n: int, threads: int) -> None:
    radius, skin = 0.08, 0.02
    cells, x = sort(cloud(n, dimension), dimension, radius + skin)
    assert np.array_equal(cells.order, np.arange(n))  # sorting sorted points changes nothing
    pairs = NeighbourList(n)
    pairs.build(cells, x[0], x[1], x[2] if dimension == 3 else None, radius=radius, skin=skin, threads=threads)
    tree = cKDTree(x[:, :n].T)
    for i, near in enumerate(tree.query_ball_point(x[:, :n].T, radius + skin)):
        assert found(pairs, i) == sorted(set(near) - {i})


@pytest.mark.parametrize("other", [None, False, True])
def test_own_radii_and_bodies(other: bool | None) -> None:
    n, skin = 1500, 0.01
    rng = np.random.default_rng(3)
    h = rng.uniform(0.005, 0.05, n + 1)
    cells, x = sort(cloud(n, 3), 3, 2.0 * h[:n].max() + skin)
    body = rng.integers(0, 3, n + 1)
    pairs = NeighbourList(n)
    group = None if other is None else body
    pairs.build(cells, x[0], x[1], x[2], radius=h[:n].max(), skin=skin, h=h, group=group, other=bool(other))
    for i in range(0, n, 7):
        near = np.linalg.norm(x[:, :n] - x[:, i : i + 1], axis=0) < h[i] + h[:n] + skin
        near[i] = False
        if other is not None:
            near &= (body[:n] != body[i]) == other
        assert found(pairs, i) == list(np.flatnonzero(near))


def test_runaways_and_clumps() -> None:
    """A few particles far away neither cost memory nor time, and coincident particles are each other's neighbours."""
    n = 20_000
    x = cloud(n, 3)
    x[:, 5] = (1e9, -1e7, 3.0)
    x[:, 6] = (1e9, -1e7, 3.05)
    x[:, 7:12] = x[:, 7:8]
    started = time.perf_counter()
    cells, x = sort(x, 3, 0.1)
    pairs = NeighbourList(n)
    pairs.build(cells, x[0], x[1], x[2], radius=0.1, skin=0.0)
    assert time.perf_counter() - started < 20.0
    assert np.prod(cells.shape) <= 8 * n + 4096
    tree = cKDTree(x[:, :n].T)
    far = np.flatnonzero(x[0, :n] > 1e8)
    for i in [*far, *range(0, n, 501)]:
        assert found(pairs, int(i)) == sorted(set(tree.query_ball_point(x[:, i], 0.1 * (1 + 1e-9))) - {int(i)})


def test_a_list_is_built_again_after_it_outgrew_its_room() -> None:
    n = 2000
    cells, x = sort(cloud(n, 2), 2, 0.05)
    pairs = NeighbourList(n)
    pairs.build(cells, x[0], x[1], None, radius=0.05, skin=0.0)
    few = pairs.count.sum()
    cells, x = sort(x, 2, 0.3)
    pairs.build(cells, x[0], x[1], None, radius=0.3, skin=0.0)
    assert pairs.count.sum() > 10 * few
    near = np.linalg.norm(x[:2, :n] - x[:2, :1], axis=0) < 0.3
    assert len(found(pairs, 0)) == near.sum() - 1


@pytest.mark.parametrize("threads", [1, 2])
def test_a_list_that_has_become_too_long_is_that_of_a_first_build(threads: int) -> None:
    n, radius = 3000, 0.08
    cells, x = sort(cloud(n, 3), 3, radius)
    pairs = NeighbourList(n)
    pairs.build(cells, x[0], x[1], x[2], radius=radius, skin=0.0, threads=threads)
    room = len(pairs.rows)
    x[:, :n] -= 0.5
    x[:, : n // 4] *= 0.8  # some blocks need more than their room, the others stand as they are
    cells, x = sort(x, 3, radius)
    pairs.build(cells, x[0], x[1], x[2], radius=radius, skin=0.0, threads=threads)
    assert len(pairs.rows) > room
    fresh = NeighbourList(n)
    fresh.build(cells, x[0], x[1], x[2], radius=radius, skin=0.0)
    for i in range(n):
        row = pairs.rows[pairs.first[i] : pairs.first[i] + pairs.count[i]]
        assert np.array_equal(row, fresh.rows[fresh.first[i] : fresh.first[i] + fresh.count[i]])
