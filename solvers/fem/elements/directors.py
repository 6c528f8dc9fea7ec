"""Directors of shells: each element corner's unit normal, averaged over the smooth surface that it belongs to."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...jit import kernel
from .shapes import NODES, functions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
FOLD = math.radians(20.0)  # surfaces that meet at more are two


def directors(x: Floats, groups: list[Ints], fixed: NDArray[np.bool_], fold: float = FOLD) -> list[Floats]:
    """(e, k, 3) of the nodes of each group of shells. groups: nodes (e, k), 3, 4 or 9 of them; fixed: (n, 6).

    At a node on a symmetry plane (held across it, with no turn out of it) the director lies in the plane.
    """
    cross = [_corner_normals(x, corners) for corners in groups]
    flat_nodes = np.concatenate([g.ravel() for g in groups])
    flat_cross = np.ascontiguousarray(np.concatenate([c.reshape(-1, 3) for c in cross]))
    flat_own = np.ascontiguousarray(
        np.concatenate([_of_elements(c) if c.shape[1] < 9 else _unit(c.reshape(-1, 3)) for c in cross])
    )
    order = np.argsort(flat_nodes, kind="stable")
    starts = np.searchsorted(flat_nodes[order], np.arange(len(x) + 1))
    total = np.empty_like(flat_cross)
    _average(flat_nodes, flat_cross, flat_own, order, starts, math.cos(fold), total)
    _into_planes(total, flat_nodes, fixed)
    total = _unit(total)
    ends = np.cumsum([0, *(g.size for g in groups)])
    return [total[a:b].reshape(*g.shape, 3) for a, b, g in zip(ends[:-1], ends[1:], groups, strict=True)]


def _of_elements(cross: Floats) -> Floats:
    """Each element's normal (e k, 3), by which surfaces are told from one another; curved ones have none."""
    return np.repeat(_unit(cross.sum(axis=1)), cross.shape[1], axis=0)


def _corner_normals(x: Floats, corners: Ints) -> Floats:
    """(e, k, 3) normal at each node, as long as the area that the corner spans."""
    p = x[corners]
    if corners.shape[1] == 9:
        tangents = np.einsum("nkd,ekc->dnec", functions("quad9", np.array(NODES["quad9"]))[1], p)
        return np.ascontiguousarray(np.cross(tangents[0], tangents[1]).transpose(1, 0, 2))
    return np.cross(np.roll(p, -1, axis=1) - p, np.roll(p, 1, axis=1) - p)


def _unit(vectors: Floats) -> Floats:
    out: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
    return out


def _into_planes(vectors: Floats, nodes: Ints, fixed: NDArray[np.bool_]) -> None:
    """Drop what stands out of symmetry planes; a node that is held in all of them is clamped and keeps its director."""
    planes = np.column_stack([fixed[:, k] & fixed[:, 3 + (k + 1) % 3] & fixed[:, 3 + (k + 2) % 3] for k in range(3)])
    planes[planes.all(axis=1)] = False
    mask = planes[nodes]
    inside = np.where(mask, 0.0, vectors)
    keeps = np.linalg.norm(inside, axis=1) > 0.5 * np.linalg.norm(vectors, axis=1)
    vectors[keeps] = inside[keeps]


@kernel
def _average(nodes, cross, own, order, starts, limit, total):
    for c in range(len(nodes)):
        for i in range(3):
            total[c, i] = 0.0
        for m in range(starts[nodes[c]], starts[nodes[c] + 1]):
            other = order[m]
            turn = own[c, 0] * own[other, 0] + own[c, 1] * own[other, 1] + own[c, 2] * own[other, 2]
            if abs(turn) >= limit:
                sign = 1.0 if turn > 0.0 else -1.0
                for i in range(3):
                    total[c, i] += sign * cross[other, i]
