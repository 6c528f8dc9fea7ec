"""Which facets each point may touch: a grid of cells over the facets, and a list for each point.

A facet stands in all cells that the box around it, widened by the reach, meets; a point looks into its own cell. Cells
are as large as it takes to keep their entries within a few times the facets and points.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
ROOM = 8  # entries and cells, in units of facets and points


@kernel
def _entries(low, high, origin, size, dims, starts, rows, fill):
    """Counts the entries of each cell into starts[1:], or fills rows behind starts (fill)."""
    for f in range(low.shape[1]):
        a0 = int((low[0, f] - origin[0]) / size)
        a1 = int((high[0, f] - origin[0]) / size)
        b0 = int((low[1, f] - origin[1]) / size)
        b1 = int((high[1, f] - origin[1]) / size)
        c0 = int((low[2, f] - origin[2]) / size)
        c1 = int((high[2, f] - origin[2]) / size)
        for a in range(a0, a1 + 1):
            for b in range(b0, b1 + 1):
                for c in range(c0, c1 + 1):
                    cell = (a * dims[1] + b) * dims[2] + c
                    if fill:
                        rows[starts[cell]] = f
                        starts[cell] += 1
                    else:
                        starts[cell + 1] += 1


@kernel
def _candidates(x, y, z, n, low, high, origin, size, dims, starts, entries, first, count, rows, fill):
    """Facets whose widened box each point lies in: counts, or rows behind first (fill). Returns their number."""
    total = 0
    for i in range(n):
        first[i] = total
        found = 0
        pz = z[i] if z is not None else 0.0
        a = (x[i] - origin[0]) / size
        b = (y[i] - origin[1]) / size
        c = (pz - origin[2]) / size
        if 0.0 <= a < dims[0] and 0.0 <= b < dims[1] and 0.0 <= c < dims[2]:
            cell = (int(a) * dims[1] + int(b)) * dims[2] + int(c)
            for k in range(starts[cell], starts[cell + 1]):
                f = entries[k]
                if not (low[0, f] <= x[i] <= high[0, f] and low[1, f] <= y[i] <= high[1, f]):
                    continue
                if z is not None and not low[2, f] <= pz <= high[2, f]:
                    continue
                if fill:
                    rows[total + found] = f
                found += 1
        count[i] = found
        total += found
    return total


def candidates(
    x: Floats, y: Floats, z: Floats | None, n: int, nodes: Floats, facets: Ints, reach: Floats
) -> tuple[Ints, Ints, Ints]:
    """first, count (n,) and rows: the facets that lie within reach of each of the first n points, by their boxes.

    nodes: (3, m) places; facets: (f, 2 or 3) of them; reach: (f,).
    """
    corners = nodes[:, facets]
    low, high = corners.min(axis=2) - reach, corners.max(axis=2) + reach
    first, count = np.zeros(n, np.int64), np.zeros(n, np.int64)
    origin = low.min(axis=1)
    extent = np.maximum(high.max(axis=1) - origin, 1e-300)
    size = float(np.median((high - low).max(axis=0)))
    allowed = ROOM * (len(facets) + n) + 1000
    while True:
        dims = (extent / size).astype(np.int64) + 1
        cells = np.prod(dims.astype(float))
        entries = np.prod((high - low) / size + 1.0, axis=0).sum()
        if cells <= allowed and entries <= allowed:
            break
        size *= 1.5
    starts = np.zeros(int(cells) + 1, np.int64)
    none = np.zeros(0, np.int64)
    _entries(low, high, origin, size, dims, starts, none, False)
    starts = np.cumsum(starts)
    held = np.empty(int(starts[-1]), np.int64)
    _entries(low, high, origin, size, dims, starts[:-1].copy(), held, True)
    total = _candidates(x, y, z, n, low, high, origin, size, dims, starts, held, first, count, none, False)
    rows = np.empty(total, np.int64)
    _candidates(x, y, z, n, low, high, origin, size, dims, starts, held, first, count, rows, True)
    return first, count, rows
