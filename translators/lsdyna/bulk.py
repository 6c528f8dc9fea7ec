"""Work on large files in pieces, by all processors: numpy, jitted kernels and the system's reads let each other run."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from zrno.translators.text import Fault, InputError, Ints, read_bytes

_MOST_THREADS = 8
_LARGE = 1 << 20  # bytes of a file that is read in pieces
_PIECE = 1 << 23  # bytes read at a time
_SEARCHED = 1 << 20  # bytes searched at a time for the ends of lines: they stay in the cache
_NEWLINE = ord("\n")
Result = TypeVar("Result")


def in_threads(do: Callable[[int], Result], starts: range) -> list[Result]:
    """do(start) of each start, in as many threads as there are processors."""
    threads = min(len(os.sched_getaffinity(0)), len(starts), _MOST_THREADS)
    if threads < 2:
        return [do(start) for start in starts]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(do, starts))


def load(path: Path, shown: str) -> tuple[NDArray[np.uint8], Ints, bool]:
    """A file's bytes; the places of all its line ends; whether a byte is 0. Raises InputError."""
    if not path.is_file() or path.stat().st_size < _LARGE:
        data = np.frombuffer(_read(path, shown), np.uint8)
        return data, *_line_ends(data, 0)
    # a new array is much faster to fill than Python's bytes: the system gives it large pages
    data = np.empty(path.stat().st_size, np.uint8)

    def piece(start: int) -> tuple[Ints, bool]:
        view = data[start : start + _PIECE]
        with path.open("rb", buffering=0) as file:
            file.seek(start)
            filled = 0
            while filled < len(view):
                count = file.readinto(view[filled:].data)
                if not count:
                    raise InputError([Fault(shown, 1, 1, "the file changed while it was read")])
                filled += count
        return _line_ends(view, start)

    try:
        found = in_threads(piece, range(0, len(data), _PIECE))
    except OSError as error:
        reason = (error.strerror or "cannot be read").lower()
        raise InputError([Fault(shown, 1, 1, reason, expected="a readable file")]) from error
    return data, np.concatenate([ends for ends, _ in found]), any(binary for _, binary in found)


def _read(path: Path, shown: str) -> bytes:
    try:
        return read_bytes(path)
    except InputError as error:
        fault = error.faults[0]
        raise InputError([Fault(shown, 1, 1, fault.message, expected=fault.expected)]) from error


def _line_ends(data: NDArray[np.uint8], first: int) -> tuple[Ints, bool]:
    ends, binary = [np.empty(0, np.int64)], False
    for start in range(0, len(data), _SEARCHED):
        piece = data[start : start + _SEARCHED]
        ends.append(first + start + np.flatnonzero(piece == _NEWLINE))
        binary |= not piece.min()
    return np.concatenate(ends), binary
