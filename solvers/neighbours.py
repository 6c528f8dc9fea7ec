"""Neighbour search: cells, sorting by cell, Verlet lists. One for smoothed particles, discrete elements and contact.

Particles are kept in the order of their cells (x fastest), so that the candidates of a particle in one row of cells are
one contiguous range. Cells are half a search radius wide (a quarter along x): rows out of reach are skipped, and the
range along x is clipped to the chord of the search sphere. Each particle gets a full row of neighbours, padded to whole
vectors with the number of a dummy particle that the caller keeps far away: a loop over the row has no remainder and one
writer, so it needs no locks and its result does not depend on the number of threads.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .jit import kernel
from .threads import claim, run

BLOCK = 256  # particles whose rows share one stretch of memory
LANES = 8  # rows are padded to this many entries
FAR = 1.0e12  # the dummy particle's coordinate in units of the search radius; its square is finite in single precision
_CHUNK = 1024  # candidates sifted at once
_ROWS = 64  # rows of cells looked at at once

Floats = NDArray[np.float64]


@kernel
def _cell_of(value, origin, inverse_size, count):
    """Cell along one axis. Everything beyond the grid belongs to its outermost cells, so the map stays monotone."""
    scaled = (value - origin) * inverse_size
    return np.int64(min(max(scaled, 0.0), count - 1.0))


@kernel
def _count_cells(n, x, y, z, origin, inverse, shape, cell, start):
    for i in range(n):
        c = _cell_of(x[i], origin[0], inverse[0], shape[0])
        c += shape[0] * _cell_of(y[i], origin[1], inverse[1], shape[1])
        if z is not None:
            c += shape[0] * shape[1] * _cell_of(z[i], origin[2], inverse[2], shape[2])
        cell[i] = c
        start[c + 1] += 1
    for c in range(len(start) - 1):
        start[c + 1] += start[c]


@kernel
def _sort_by_cell(n, cell, start, order):
    """A stable counting sort; `start` is moved on by one cell and moved back."""
    for i in range(n):
        c = cell[i]
        order[start[c]] = i
        start[c] += 1
    for c in range(len(start) - 1, 0, -1):
        start[c] = start[c - 1]
    start[0] = 0


@kernel
def _sift(i, m, candidates, x, y, z, h, reach, group, other, distance, out, at, end):
    """Append to out[at:end] those of the first m candidates that are neighbours of i; returns how many they are."""
    xi = x[i]
    yi = y[i]
    for k in range(np.uint64(m)):
        j = candidates[k]
        dx = xi - x[j]
        dy = yi - y[j]
        r2 = dx * dx + dy * dy
        if z is not None:
            dz = z[i] - z[j]
            r2 += dz * dz
        if h is not None:  # noqa: SIM108  (numba prunes this branch where there is no h)
            radius = h[i] + h[j] + reach
        else:
            radius = reach
        distance[k] = r2 - radius * radius
    if group is not None:
        for k in range(np.uint64(m)):
            if (group[candidates[k]] != group[i]) != other:
                distance[k] = 1.0
    kept = np.uint64(at)
    if at + m <= end:
        for k in range(np.uint64(m)):  # branch-free: most candidates are neighbours, in no order that can be guessed
            out[kept] = candidates[k]
            kept += np.uint64(distance[k] < 0.0)
    else:  # perhaps no room: only count what does not fit
        for k in range(np.uint64(m)):
            if distance[k] < 0.0:
                if kept < np.uint64(end):
                    out[kept] = candidates[k]
                kept += np.uint64(1)
    return np.int64(kept) - at


@kernel
def _gaps(value, radius, origin, size, shape, gap):
    """Squared distances from a coordinate to the cells within reach along one axis.

    Returns the first cell, how many.
    """
    c0 = _cell_of(value - radius, origin, 1.0 / size, shape)
    c1 = _cell_of(value + radius, origin, 1.0 / size, shape)
    for c in range(c0, c1 + 1):
        below = origin + c * size - value if c > 0 else 0.0
        above = value - origin - (c + 1) * size if c < shape - 1 else 0.0
        distance = max(0.0, max(below, above))
        gap[c - c0] = distance * distance
    return c0, c1 - c0 + 1


@kernel
def _fill_rows(
    i0, i1, n, x, y, z, h, reach, h_max, origin, size, shape, start, group, other, first, count, rows, at, end, dummy
):
    """Rows of neighbours of particles i0..i1 into rows[at:end]; returns the room that they need.

    h: None (the search radius is reach for all) or smoothing lengths (radius h_i + h_j + reach, the largest h being
    h_max). group: None, or numbers of bodies; then only neighbours of the same body (other False) or of another
    (other True) are kept.
    """
    nx = shape[0]
    ny = shape[1]
    last = nx - 1.0
    origin_x = origin[0]
    inverse_x = 1.0 / size[0]
    gap_y = np.empty(shape[1])
    gap_z = np.zeros(shape[2])
    chord = np.empty(_ROWS)
    base = np.empty(_ROWS)
    low = np.empty(_ROWS, np.int64)
    high = np.empty(_ROWS, np.int64)
    distance = np.empty(_CHUNK)
    candidates = np.empty(_CHUNK + LANES, np.uint32)
    lanes = np.arange(LANES).astype(np.uint32)
    needed = at
    for i in range(i0, i1):
        xi = x[i]
        radius = reach
        if h is not None:
            radius += h[i] + h_max
        radius *= 1.0 + 1e-12
        square = radius * radius
        z0 = np.int64(0)
        nz = np.int64(1)
        if z is not None:
            z0, nz = _gaps(z[i], radius, origin[2], size[2], shape[2], gap_z)
        y0, n_y = _gaps(y[i], radius, origin[1], size[1], shape[1], gap_y)
        total = 0
        m = 0
        a = np.int64(0)
        b = np.int64(0)
        while b < nz:
            # the next rows of cells within reach, and the chord of the search sphere in them
            r = np.uint64(0)
            while b < nz and r < _ROWS:
                chord[r] = square - gap_y[np.uint64(a)] - gap_z[np.uint64(b)]
                base[r] = np.float64(nx * (y0 + a + ny * (z0 + b)))
                r += np.uint64(chord[r] > 0.0)
                a += 1
                if a == n_y:
                    a = np.int64(0)
                    b += 1
            for k in range(r):
                half = np.sqrt(chord[k])
                low[k] = np.int64(base[k] + np.floor(min(max((xi - half - origin_x) * inverse_x, 0.0), last)))
                high[k] = np.int64(base[k] + np.floor(min(max((xi + half - origin_x) * inverse_x, 0.0), last)) + 1.0)
            for k in range(r):
                j = start[np.uint64(low[k])]
                j1 = start[np.uint64(high[k])]
                while j < j1:
                    if m + LANES > _CHUNK:
                        total += _sift(
                            i, m, candidates, x, y, z, h, reach, group, other, distance, rows, needed + total, end
                        )
                        m = 0
                    for lane in range(LANES):  # a whole vector; what is too much is overwritten by the next range
                        candidates[np.uint64(m + lane)] = np.uint32(j) + lanes[lane]
                    more = min(LANES, j1 - j)
                    m += more
                    if j <= i < j + more:  # not its own neighbour
                        m -= 1
                        candidates[np.uint64(m - more + 1 + i - j)] = candidates[np.uint64(m)]
                    j += more
        total += _sift(i, m, candidates, x, y, z, h, reach, group, other, distance, rows, needed + total, end)
        padded = (total + LANES - 1) // LANES * LANES
        if needed + padded <= end:
            for k in range(needed + total, needed + padded):
                rows[k] = dummy
        first[i] = needed
        count[i] = padded
        needed += padded
    return needed - at


@kernel
def _fill(
    thread,
    threads,
    sync,
    n,
    x,
    y,
    z,
    h,
    reach,
    h_max,
    origin,
    size,
    shape,
    start,
    group,
    other,
    first,
    count,
    rows,
    room,
    needed,
    dummy,
):
    """Rows of all blocks. needed: (blocks,) gets the room of each; where there is less its rows mean nothing."""
    b = claim(sync, thread, threads, len(needed))
    while b < len(needed):
        i0 = b * BLOCK
        i1 = min(n, i0 + BLOCK)
        needed[b] = _fill_rows(
            i0, i1, n, x, y, z, h, reach, h_max, origin, size, shape, start, group, other, first, count, rows,
            room[b], room[b + 1], dummy,
        )  # fmt: skip
        b = claim(sync, thread, threads, len(needed))


def blocks(n: int) -> int:
    """Blocks of n particles."""
    return (n + BLOCK - 1) // BLOCK


class Cells:
    """A grid of cells over a set of points, and the order that sorts the points by cell.

    x, y, z: coordinates (>= n,), z None in the plane; radius: the largest search radius. Points far outside the bulk
    (the outer per cent, where a plain box would need too many cells) fall into the outermost cells: a single runaway
    particle costs nothing.
    """

    def __init__(self, n: int, x: Floats, y: Floats, z: Floats | None, radius: float) -> None:
        axes = [a[:n] for a in (x, y, z) if a is not None]
        size = np.full(3, 0.5 * radius)
        size[0] = 0.25 * radius
        low, high = np.zeros(3), np.zeros(3)
        most = 8 * n + 4096
        for d, axis in enumerate(axes):
            low[d], high[d] = axis.min(), axis.max()
        if np.prod((high - low) / size + 1.0) > most:
            for d, axis in enumerate(axes):
                low[d], high[d] = np.percentile(axis, (1.0, 99.0))
            low -= radius
            high += radius
        while np.prod((high - low) / size + 1.0) > most:
            size *= 1.26
        self.n = n
        self.origin = low
        self.size = size
        self.shape = (np.floor((high - low) / size) + 1).astype(np.int64)
        self.shape[len(axes) :] = 1
        self.start = np.zeros(int(np.prod(self.shape)) + 1, np.int64)
        cell = np.empty(n, np.int64)
        self.order = np.empty(n, np.int64)
        _count_cells(n, x, y, z, self.origin, 1.0 / self.size, self.shape, cell, self.start)
        _sort_by_cell(n, cell, self.start, self.order)


class NeighbourList:
    """A Verlet list: all pairs nearer than their search radius plus a skin.

    first, count: (n,) where the row of a particle begins in `rows` and how long it is (a multiple of 8; the rest is the
    dummy's number n). The list holds until a particle has moved by half the skin.
    """

    def __init__(self, n: int) -> None:
        self.n = n
        self.first: NDArray[np.int64] = np.zeros(n, np.int64)
        self.count: NDArray[np.int64] = np.zeros(n, np.int64)
        self.rows: NDArray[np.uint32] = np.empty(0, np.uint32)
        self._room: NDArray[np.int64] = np.zeros(blocks(n) + 1, np.int64)

    def build(
        self,
        cells: Cells,
        x: Floats,
        y: Floats,
        z: Floats | None,
        *,
        radius: float,
        skin: float,
        h: Floats | None = None,
        group: Any = None,
        other: bool = False,
        threads: int = 1,
        dummy: int | None = None,
    ) -> None:
        """List the neighbours of points that are already in the order of `cells`.

        radius: search radius where h is None, else the largest h (the pair's radius is h_i + h_j). group, other: keep
        pairs of one body only, or of different bodies only. dummy: pads the rows; by default the number of points.
        """
        reach = skin if h is not None else radius + skin
        needed = np.empty(blocks(self.n), np.int64)
        while True:
            run(
                _fill, threads, cells.n, x, y, z, h, reach, radius, cells.origin, cells.size, cells.shape, cells.start,
                group, other, self.first, self.count, self.rows, self._room, needed,
                cells.n if dummy is None else dummy,
            )  # fmt: skip
            if np.all(needed <= np.diff(self._room)):
                return
            roomy = (needed * 1.1).astype(np.int64) // LANES * LANES + 4 * LANES
            self._room = np.concatenate(([0], np.cumsum(roomy)))
            self.rows = np.empty(0, np.uint32)  # the old go before the new come: a third of a run's memory
            self.rows = np.empty(int(self._room[-1]), np.uint32)

    def build_mapped(
        self,
        live: int,
        extra: int,
        offset: int,
        x: Floats,
        y: Floats,
        z: Floats | None,
        *,
        dummy: int,
        radius: float,
        skin: float,
        h: Floats | None = None,
        group: Any = None,
        other: bool = False,
        threads: int = 1,
    ) -> None:
        """As `build`, of points in any order: the first `live` ones and `extra` ones from `offset` on.

        Only the first get rows that are meant. dummy: pads the rows.
        """
        reach = radius + skin if h is None else 2.0 * radius + skin
        chosen = np.concatenate((np.arange(live), np.arange(offset, offset + extra)))
        count = len(chosen)
        cells = Cells(count, x[chosen], y[chosen], None if z is None else z[chosen], reach)
        order = chosen[cells.order]
        sorted_list = NeighbourList(count)
        sorted_list.build(
            cells, x[order], y[order], None if z is None else z[order], radius=radius, skin=skin,
            h=None if h is None else h[order], group=None if group is None else group[order], other=other,
            threads=threads,
        )  # fmt: skip
        _map_rows(count, order, dummy, sorted_list.first, sorted_list.count, sorted_list.rows)
        real = order < live
        self.first[order[real]] = sorted_list.first[real]
        self.count[order[real]] = sorted_list.count[real]
        self.rows = sorted_list.rows


@kernel
def _map_rows(count, order, dummy, first, counts, rows):
    """Numbers of sorted points in the rows become numbers of points."""
    for i in range(count):
        for k in range(first[i], first[i] + counts[i]):
            rows[k] = order[rows[k]] if rows[k] < count else dummy
