"""The numbers of a .msh section: one stream, whether they stand there as text or as bytes."""

from __future__ import annotations

import re
import struct
import warnings
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from zrno.translators.model import Floats, Ints
from zrno.translators.text import Faults, InputError

EXACT = 2**53  # doubles hold every whole number up to here
LARGEST_INT = 2**31 - 1
_LONG = np.iinfo(np.int64)
_INTEGER = re.compile(rb"[+-]?\d{1,18}")
_REAL = re.compile(rb"[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|inf(?:inity)?|nan)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Encoding:
    """version: "2.2" (all of 2), "4.0" or "4.1"; order: byte order ("<" or ">") of a binary file, else ""; size: bytes
    of a size_t in a binary file."""

    version: str
    order: str
    size: int = 8


class Numbers:
    """Hands out a section's numbers in order; a fault with its place where they are broken or too few.

    start, end: the section's bytes in the file. integers: a section of integers alone, which are then exact up to 18
    digits as text too, and read eight times faster than reals.
    """

    def __init__(
        self, faults: Faults, data: bytes, start: int, end: int, section: str, encoding: Encoding, *, integers: bool
    ) -> None:
        self.encoding = encoding
        self.binary = bool(encoding.order)
        self._order = encoding.order
        self._size = f"u{encoding.size}"
        self._faults = faults
        self._data = data
        self._start = start
        self._end = end
        self._section = section
        self._at = start if self.binary else 0
        self._values: NDArray[Any] = np.zeros(0, np.int64) if self.binary else self._parse(integers)

    @property
    def left(self) -> int:
        """Numbers, of a binary section bytes, that are not yet read."""
        return (self._end if self.binary else len(self._values)) - self._at

    def few(self, kinds: str) -> list[int]:
        """One number for each letter, without numpy's cost a call: i an integer of 4 bytes, n a size_t."""
        if self.binary:
            form = self._order + kinds.replace("n", "Q" if self.encoding.size == 8 else "I")
            if self.left < struct.calcsize(form):
                self._too_few(len(kinds))
            numbers = list(struct.unpack_from(form, self._data, self._at))
            self._at += struct.calcsize(form)
            return numbers
        if self.left < len(kinds):
            self._too_few(len(kinds))
        values = self._take(len(kinds), "i4")
        some: list[float] = values.tolist()
        if not all(-LARGEST_INT <= value < EXACT and value == int(value) for value in some):
            self._whole(values)
        return [int(value) for value in some]

    def ints(self, count: int) -> Ints:
        """Integers of 4 bytes."""
        values = self._whole(self._take(count, "i4"))
        if not self.binary and (np.abs(values) > LARGEST_INT).any():
            self.fail(f"a number in ${self._section} is too large", f"at most {LARGEST_INT}", -count)
        return values

    def sizes(self, count: int) -> Ints:
        """Integers of the size of a size_t: counts, and tags of version 4.1."""
        return self._whole(self._take(count, self._size))

    def tags(self, count: int) -> Ints:
        """Numbers of nodes and elements of version 4."""
        return self.ints(count) if self.encoding.version == "4.0" and self.binary else self.sizes(count)

    def reals(self, count: int) -> Floats:
        """Doubles; a fault where one is not finite."""
        values = self._take(count, "f8").astype(np.float64)
        if not np.isfinite(values).all():
            self.fail(f"a number in ${self._section} is not finite", "finite coordinates", -count)
        return values

    def tagged_points(self, count: int, width: int = 3) -> tuple[Ints, Floats]:
        """Records of a 4-byte tag and `width` doubles: the tags (n,), the first three doubles (n, 3)."""
        if not self.binary:
            rows = self.reals((1 + width) * count).reshape(count, 1 + width)
            return self._whole(rows[:, 0], 1 + width), np.ascontiguousarray(rows[:, 1:4])
        kind: np.dtype[Any] = np.dtype([("tag", self._order + "i4"), ("x", self._order + "f8", (width,))])
        raw = self._take(kind.itemsize * count, "u1").tobytes()
        records: NDArray[Any] = np.frombuffer(raw, kind)
        points = np.ascontiguousarray(records["x"][:, :3], np.float64)
        if not np.isfinite(points).all():
            self.fail(f"a number in ${self._section} is not finite", "finite coordinates")
        return records["tag"].astype(np.int64), points

    def rest(self) -> NDArray[Any]:
        """All integers that are left, of a binary section those of 4 bytes."""
        if self.binary:
            count = max(self.left, 0) // 4
            values: NDArray[Any] = np.frombuffer(self._data[self._at : self._at + 4 * count], self._order + "i4")
            return values if values.dtype.isnative else values.astype(np.int32)
        return self._values[self._at :]

    def skip(self, count: int, size: int = 4) -> None:
        """Go on behind the next numbers, of a binary section those of `size` bytes."""
        if count < 0 or (size * count if self.binary else count) > self.left:
            self._too_few(count)
        self._at += size * count if self.binary else count

    def fail(self, message: str, expected: str = "", offset: int = 0, text: str = "") -> NoReturn:
        """Stop with a fault at the number that was read last, or `offset` numbers from there."""
        if self.binary:
            line, column = 1 + self._data.count(b"\n", 0, self._start), 1
        else:
            line, column = self._place(max(self._at + offset, 0))
        self._faults.add(line, column, message, text, expected)
        raise InputError(self._faults.found)

    def _take(self, count: int, dtype: str) -> NDArray[Any]:
        if self.binary:
            kind = np.dtype(self._order + dtype)
            if count < 0 or count * kind.itemsize > self.left:
                self._too_few(count)
            values: NDArray[Any] = np.frombuffer(self._data[self._at : self._at + count * kind.itemsize], kind)
            self._at += count * kind.itemsize
            return values
        if count < 0 or count > self.left:
            self._too_few(count)
        text = self._values[self._at : self._at + count]
        self._at += count
        return text

    def _too_few(self, count: int) -> NoReturn:
        if not self.binary:
            self._at = len(self._values)
        self.fail(f"${self._section} ends too early", f"{count} more numbers")

    def _whole(self, values: NDArray[Any], stride: int = 1) -> Ints:
        """Numbers that must be whole, and not so large that doubles round them; they stand `stride` numbers apart."""
        if values.dtype.kind == "i":
            return values.astype(np.int64)
        good = values < EXACT if values.dtype.kind == "u" else (np.abs(values) < EXACT) & (np.rint(values) == values)
        if not good.all():
            wrong = int(np.argmin(good))
            said = f"{values[wrong]:.17g}"
            self.fail("not a whole number", "a whole number below 2^53", (wrong - len(values)) * stride, said)
        return values.astype(np.int64)

    def _parse(self, integers: bool) -> NDArray[Any]:
        text = self._data[self._start : self._end]
        if not text.strip():
            return np.zeros(0, np.int64)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", DeprecationWarning)
                values: NDArray[Any] = np.fromstring(text, np.int64 if integers else np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            self._find_broken(text, integers)
        else:
            # what is too large for 8 bytes comes back as the largest or the smallest
            if integers and (values.max() == _LONG.max or values.min() == _LONG.min):
                self._find_broken(text, integers)
            return values
        raise AssertionError("a broken number has stopped the reader")

    def _find_broken(self, text: bytes, integers: bool) -> None:
        """Faults at the words that are no numbers."""
        good = _INTEGER if integers else _REAL
        expected = f"{'whole ' if integers else ''}numbers in ${self._section}"
        first = 1 + self._data.count(b"\n", 0, self._start)
        for i, line in enumerate(text.split(b"\n")):
            for word in line.split():
                if not good.fullmatch(word):
                    said = word[:40].decode("latin-1")
                    self._faults.add(first + i, line.index(word) + 1, "not a number", said, expected)
        self._faults.stop()
        self.fail(f"${self._section} cannot be read", expected)

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
