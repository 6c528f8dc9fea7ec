"""The pressure of grain on a surface that is finer than the grain: forces spread over what a particle bears on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Floats = NDArray[np.float64]


def pressure(x: Floats, force: Floats, area: Floats, reach: float) -> Floats:
    """(m,) force by area at nodes x (m, 3), of forces (m, 3) that are each spread evenly over the nodes within reach.

    area: (m,) of each node. What it adds up to over the surface is the sum of the forces; where no other node is within
    reach it is a node's force by its own area.
    """
    pushed = np.flatnonzero(force.any(axis=1))
    found = np.zeros_like(force)
    if not len(pushed):
        return np.zeros(len(x))
    near = cKDTree(x).query_ball_point(x[pushed], reach)
    count = np.array([len(rows) for rows in near])
    to = np.concatenate([np.asarray(rows, np.int64) for rows in near])
    owner = np.repeat(np.arange(len(pushed)), count)
    borne = np.bincount(owner, area[to], minlength=len(pushed))
    each = force[pushed] / np.maximum(borne, np.finfo(float).tiny)[:, None]
    for k in range(3):
        found[:, k] = np.bincount(to, each[owner, k], minlength=len(x))
    size: Floats = np.linalg.norm(found, axis=1)
    return size
