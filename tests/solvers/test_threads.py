"""Barriers: no thread passes before all have come."""

from __future__ import annotations

import numpy as np
import pytest

from zrno.solvers.jit import kernel
from zrno.solvers.threads import barrier, claim, meeting, run, share


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


@kernel
def work_off(thread, threads, sync, board, pieces, rounds):
    """Each thread counts what it does of all pieces, in each round anew."""
    for k in range(rounds):
        piece = claim(sync, thread, threads, pieces)
        while piece < pieces:
            board[k, piece] += 1 + 10 * thread
            piece = claim(sync, thread, threads, pieces)
        barrier(sync, threads)
    return 0


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_each_piece_is_done_once_a_round(threads: int) -> None:
    board = np.zeros((200, 7), np.int64)
    run(work_off, threads, board, 7, 200)
    assert np.all(board % 10 == 1)


def test_a_thread_begins_with_its_own_share_and_then_helps_the_others() -> None:
    sync = meeting(2)
    assert [claim(sync, 1, 2, 5) for _ in range(6)] == [2, 3, 4, 0, 1, 5]
