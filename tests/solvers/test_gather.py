"""Rows of a table brought together, eight at a time."""

from __future__ import annotations

import numpy as np
import pytest

from zrno.solvers.gather import LANES, ROOM, gather, table
from zrno.solvers.jit import kernel


@kernel
def _brought(rows, numbers, buffer):
    for at in range(0, len(numbers), LANES):
        gather(rows, numbers, at, buffer, at, 5)


def test_rows_stand_as_columns() -> None:
    rows = table(40)
    rows[:] = np.random.default_rng(1).normal(size=rows.shape)
    numbers = np.random.default_rng(2).integers(0, 40, 24).astype(np.uint32)
    buffer = np.full((LANES, ROOM), np.nan)
    _brought(rows, numbers, buffer)
    assert np.array_equal(buffer[:5, :24], rows[numbers, :5].T)
    assert np.isnan(buffer[:5, 24:]).all()
    assert np.isnan(buffer[5:]).all()


@pytest.mark.parametrize("count", [0, 1, 7, 1000])
def test_a_row_is_a_cache_line(count: int) -> None:
    rows = table(count)
    assert rows.shape == (count, LANES)
    assert not rows.any()
    assert rows.ctypes.data % 64 == 0 or count == 0
    assert rows.flags.c_contiguous
