"""Barriers: no thread passes before all have come."""

from __future__ import annotations

import numpy as np
import pytest

from zrno.solvers.jit import kernel
from zrno.solvers.threads import barrier, run, share


@kernel
def rounds(thread, threads, sync, board, n):
    """Each thread writes its round number and, behind the barrier, counts who has not written it yet."""
    late = 0
    for k in range(n):
        board[thread, 0] = k
        barrier(sync, threads)
        for other in range(threads):
            late += board[other, 0] != k
        barrier(sync, threads)
    return late


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_nobody_is_late(threads: int) -> None:
    assert run(rounds, threads, np.zeros((threads, 8), np.int64), 2000) == [0] * threads


def test_shares_cover_everything_once() -> None:
    for n in (0, 1, 5, 1000):
        for threads in (1, 2, 3, 8):
            ranges = [share(n, t, threads) for t in range(threads)]
            assert [i for a, b in ranges for i in range(a, b)] == list(range(n))
