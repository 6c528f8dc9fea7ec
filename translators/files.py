"""Whole files of text: read, cut into lines, written at once."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zrno.translators.faults import Fault, InputError

Ints = NDArray[np.int64]

_LINES_AT_A_TIME = 1 << 23  # bytes searched for line ends
_MANY_LINES, _SHORTEST_MEAN = 400_000, 8  # lines, and bytes of them with their ends: see refuse_short_lines
_NEWLINE, _RETURN = b"\n\r"


def read_bytes(path: Path | str) -> bytes:
    """The bytes of a file; InputError when it is missing, unreadable or empty."""
    where = Path(path)
    try:
        data = where.read_bytes()
    except OSError as error:
        reason = (
            "no such file" if isinstance(error, FileNotFoundError) else (error.strerror or "cannot be read").lower()
        )
        raise InputError([Fault(str(path), 1, 1, reason, expected="a readable file")]) from error
    if not data[:4096].strip() and not data.strip():
        raise InputError([Fault(str(path), 1, 1, "the file is empty", expected="a mesh or a deck")])
    return data


def refuse_short_lines(path: Path | str, size: int, lines: int) -> None:
    """Raise InputError for a file of `size` bytes that is nothing but short lines: no mesh, and a page of memory each.

    Every line costs its indices; what a real deck says takes tens of bytes a line, so that this is little beside it.
    """
    if lines > _MANY_LINES and lines * _SHORTEST_MEAN > size:
        mean = size / lines
        said = f"{lines} lines of {mean:.1f} characters on average: nothing that a mesh or a deck would say"
        expected = f"at least {_SHORTEST_MEAN} characters on average"
        raise InputError([Fault(str(path), 1, 1, said, expected=expected)])


def line_spans(data: bytes) -> tuple[Ints, Ints]:
    """First byte of each line and the byte past its last, without its end (a newline, or a carriage return and one)."""
    whole = np.frombuffer(data, np.uint8)
    pieces = range(0, len(data), _LINES_AT_A_TIME)
    ends = np.concatenate(
        [start + np.flatnonzero(whole[start : start + _LINES_AT_A_TIME] == _NEWLINE) for start in pieces]
    )
    starts = np.concatenate(([0], ends + 1))
    if starts[-1] == len(data):  # the newline that ends the last line begins no further one
        starts = starts[:-1]
    else:
        ends = np.concatenate((ends, [len(data)]))
    returned = (ends > starts) & (whole[np.maximum(ends - 1, 0)] == _RETURN)
    return starts, ends - returned


def write_atomically(path: Path | str, chunks: Iterable[bytes]) -> None:
    """Write a file under a temporary name in its folder and rename it: it appears whole or not at all."""
    target = Path(path)
    temporary = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        with temporary.open("wb") as out:
            for chunk in chunks:
                out.write(chunk)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)
