"""Rows of different lengths in one stream of integers, each saying its length in its first three numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.model import Ints

_LONG_RUN = 16  # rows alike from which on it pays to look for their end by doubling
_STRIDE = 1 << 16  # numbers walked through at a time where rows differ

# (place of the row, its first three numbers) -> (its length, how many items it holds); raises where it is impossible
Measure = Callable[[int, list[int]], tuple[int, int]]


def row_starts(values: NDArray[Any], count: int, alike: slice, measure: Measure) -> tuple[Ints, int]:
    """Where the rows begin, until they hold `count` items, and where the last ends.

    alike: of the first three numbers, those that make lengths equal. A long run of such rows costs no Python a row.
    """
    pieces: list[Ints] = []
    at, done = 0, 0
    while done < count:
        width, size = measure(at, values[at : at + 3].tolist())
        run = min(-(-(count - done) // size), (len(values) - at) // width)
        run = _equal_rows(values[at : at + run * width].reshape(run, width)[:, alike])
        walked = _walk(values, at, count - done, measure) if run < _LONG_RUN else None
        if walked is None:
            pieces.append(at + width * np.arange(run))
            at, done = at + run * width, done + run * size
        else:
            starts, at, items = walked
            pieces.append(np.array(starts, np.int64))
            done += items
    return (np.concatenate(pieces) if pieces else np.zeros(0, np.int64)), at


def _walk(values: NDArray[Any], at: int, count: int, measure: Measure) -> tuple[list[int], int, int] | None:
    """Steps through rows that differ: their starts, their end, how many items; None where the first is too long."""
    piece = values[at : at + _STRIDE].tolist()
    starts: list[int] = []
    i, done = 0, 0
    while done < count and i + 3 <= len(piece):
        width, size = measure(at + i, piece[i : i + 3])
        if i + width > len(piece):
            break
        starts.append(at + i)
        i += width
        done += size
    return (starts, at + i, done) if starts else None


def _equal_rows(rows: NDArray[Any]) -> int:
    """How many rows begin `rows` that equal the first."""
    size = min(1, len(rows))
    while size < len(rows):
        until = min(2 * size, len(rows))
        same = (rows[size:until] == rows[0]).all(axis=1)
        if not same.all():
            return size + int(np.argmin(same))
        size = until
    return size
