"""Shells in space as particles: elements are cut into cells no longer than the spacing, a particle in each middle."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from zrno.translators.elements import TABLE
from zrno.translators.geometry import measures
from zrno.translators.model import ElementBlock, Floats, Ints


def cover(blocks: list[ElementBlock], xyz: Floats, spacing: float) -> tuple[Floats, Floats]:
    """Particles on surfaces: positions (n, 3) and areas (n,), whose sum over an element is the element's area."""
    x, areas = [np.empty((0, 3))], [np.empty(0)]
    for block in blocks:
        corners = xyz[block.nodes[:, : TABLE[block.kind].shape.corners]]
        area = measures(block, xyz)
        for group, u, v in _grids(corners, spacing):
            cells = len(u)
            x.append(_at(corners[group], u, v).reshape(-1, 3))
            areas.append(np.repeat(area[group] / cells, cells))
    return np.concatenate(x), np.concatenate(areas)


def _grids(corners: Floats, spacing: float) -> Iterator[tuple[Ints, Floats, Floats]]:
    """Elements that are cut alike: their rows, and the natural coordinates of the middles of their cells."""
    if corners.shape[1] == 3:
        longest = np.max([np.linalg.norm(corners[:, a] - corners[:, a - 1], axis=1) for a in range(3)], axis=0)
        cuts = np.maximum(np.ceil(longest / spacing - 1e-9), 1).astype(np.int64)
        for n in np.unique(cuts).tolist():
            yield np.flatnonzero(cuts == n), *_triangle_middles(n)
        return
    sides = [np.linalg.norm(corners[:, a] - corners[:, a - 1], axis=1) for a in range(4)]
    longest = np.stack([np.maximum(sides[1], sides[3]), np.maximum(sides[2], sides[0])], axis=1)
    cuts = np.maximum(np.ceil(longest / spacing - 1e-9), 1).astype(np.int64)
    for n, m in np.unique(cuts, axis=0).tolist():
        u, v = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(m) + 0.5) / m)
        yield np.flatnonzero((cuts == (n, m)).all(axis=1)), u.ravel(), v.ravel()


def _triangle_middles(n: int) -> tuple[Floats, Floats]:
    """Centroids of the n^2 equal triangles that a triangle is cut into."""
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    up, down = i + j < n, i + j < n - 1
    u = np.concatenate([i[up] + 1 / 3, i[down] + 2 / 3]) / n
    v = np.concatenate([j[up] + 1 / 3, j[down] + 2 / 3]) / n
    return u, v


def _at(corners: Floats, u: Floats, v: Floats) -> Floats:
    """Points of elements at natural coordinates: shape (elements, points, 3)."""
    if corners.shape[1] == 3:
        weights = np.stack([1 - u - v, u, v])
    else:
        weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
    return np.asarray(np.einsum("ekd,kp->epd", corners, weights))
