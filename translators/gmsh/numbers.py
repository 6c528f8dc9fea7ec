"""The numbers of a .msh section: one stream, whether they stand there as text or as bytes."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.text import Faults


class Numbers:
    """Hands out a section's numbers in order; a fault with its place where they are broken or too few.

    start: the section's first byte in the file. binary: byte order ("<" or ">") of a binary file, else "".
    """

    def __init__(self, faults: Faults, data: bytes, start: int, end: int, section: str, binary: str) -> None:
        self._faults = faults
        self._data = data
        self._start = start
        self._end = end
        self._section = section
        self.binary = binary
        self._at = start if binary else 0
        self._values: NDArray[np.float64] = np.zeros(0) if binary else self._parse()

    def ints(self, count: int) -> NDArray[np.int64]:
        """Integers of 4 bytes."""
        return self._take(count, "i4").astype(np.int64)

    def sizes(self, count: int) -> NDArray[np.int64]:
        """Integers of 8 bytes: counts and tags of version 4."""
        return self._take(count, "u8").astype(np.int64)

    def reals(self, count: int) -> NDArray[np.float64]:
        """Doubles; a fault where one is not finite."""
        values = self._take(count, "f8").astype(np.float64)
        if not np.isfinite(values).all():
            self.fail(f"a number in ${self._section} is not finite", "finite coordinates", -len(values))
        return values

    def tagged_points(self, count: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Records of a 4-byte tag and three doubles: the tags (n,), the points (n, 3)."""
        if not self.binary:
            rows = self.reals(4 * count).reshape(count, 4)
            return rows[:, 0].astype(np.int64), np.ascontiguousarray(rows[:, 1:])
        raw = self._take(28 * count, "u1").tobytes()
        kind: np.dtype[Any] = np.dtype([("tag", self.binary + "i4"), ("x", self.binary + "f8", (3,))])
        records: NDArray[Any] = np.frombuffer(raw, kind)
        return records["tag"].astype(np.int64), records["x"].astype(np.float64)

    def ahead(self, count: int) -> NDArray[Any]:
        """The next numbers, of a binary section integers of 4 bytes, which stay unread."""
        at = self._at
        values = self._take(count, "i4")
        self._at = at
        return values

    def ahead_all(self) -> NDArray[Any]:
        """All numbers that are left, of a binary section integers of 4 bytes, which stay unread."""
        if self.binary:
            return np.frombuffer(self._data, self.binary + "i4", max(self._end - self._at, 0) // 4, self._at)
        return self._values[self._at :]

    def fail(self, message: str, expected: str = "", offset: int = 0) -> None:
        """Stop with a fault at the number that was read last, or `offset` numbers from there."""
        if self.binary:
            line, column = 1 + self._data.count(b"\n", 0, self._start), 1
        else:
            line, column = self._place(max(self._at + offset, 0))
        self._faults.add(line, column, message, expected=expected)
        self._faults.stop()

    def _take(self, count: int, dtype: str) -> NDArray[Any]:
        if self.binary:
            kind = np.dtype(self.binary + dtype)
            if count < 0 or self._at + count * kind.itemsize > len(self._data):
                self.fail(f"the file ends inside ${self._section}", f"{count} more numbers")
            values = np.frombuffer(self._data, kind, count, self._at)
            self._at += count * kind.itemsize
            return values
        if count < 0 or self._at + count > len(self._values):
            self._at = len(self._values)
            self.fail(f"${self._section} ends too early", f"{count} more numbers")
        text = self._values[self._at : self._at + count]
        self._at += count
        return text

    def _parse(self) -> NDArray[np.float64]:
        text = self._data[self._start : self._end]
        if not text.strip():
            return np.zeros(0)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", DeprecationWarning)
                return np.fromstring(text, np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            self._find_broken(text)
            raise

    def _find_broken(self, text: bytes) -> None:
        first = 1 + self._data.count(b"\n", 0, self._start)
        for i, line in enumerate(text.split(b"\n")):
            for word in line.split():
                try:
                    float(word)
                except ValueError:
                    said = word.decode("latin-1")
                    self._faults.add(
                        first + i, line.index(word) + 1, "not a number", said, f"numbers in ${self._section}"
                    )
        self._faults.stop()

    def _place(self, number: int) -> tuple[int, int]:
        """Line and column of a number of a text section, by counting words."""
        first = 1 + self._data.count(b"\n", 0, self._start)
        lines = self._data[self._start : self._end].split(b"\n")
        for i, line in enumerate(lines):
            words = line.split()
            if number < len(words):
                column = 0
                for word in words[: number + 1]:
                    column = line.index(word, column) + len(word)
                return first + i, column - len(words[number]) + 1
            number -= len(words)
        return first + len(lines) - 1, 1
