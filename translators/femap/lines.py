"""The text of a FEMAP neutral file: its lines, their numbers and their faults.

Fields are separated by commas, blanks or both, a last comma ends the last field. Lines that start with $COM are
comments.
Source: FEMAP neutral file format, versions 4.41 and later (file structure).
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from zrno.translators.model import Floats, Ints
from zrno.translators.text import MAX_FAULTS, Faults, line_spans, parse_real, refuse_short_lines

_LONGEST_LINE = 4096  # bytes; the format's own limit is 255
_FEW, _VERY_FEW = 50_000, 100  # numbers: fewer are parsed in Python before the jitted kernels are loaded, and after
_LARGE = 4 << 20  # bytes of a file for which they are loaded at once
_PLAIN_DIGITS = 15  # of a whole number that is sure to be below the next
_EXACT = 2.0**53  # doubles hold every whole number up to here
_EMPTY = re.compile(rb"^,|,[ \t\r\f\v]*,")
_FIELD = re.compile(rb"[ \t\r\f\v]*([^ \t\r\f\v,]*)[ \t\r\f\v]*(,?)")
_BLANKS = np.zeros(256, bool)
_BLANKS[list(b" \t\r\f\v")] = True
_BOM = b"\xef\xbb\xbf"


class Broken(Exception):
    """A block cannot be read further; what is wrong is noted in the faults."""


class Lines:
    """The lines of a file, from 0, without the blanks around them; comments are blank lines."""

    def __init__(self, path: Path | str, data: bytes) -> None:
        self.faults = Faults(str(path))
        self._encoding = "utf-8" if data.startswith(_BOM) else "latin-1"
        data = data.removeprefix(_BOM)
        self._data = data
        self._bytes = np.frombuffer(data, np.uint8)
        refuse_short_lines(path, len(data), data.count(b"\n"))
        self._begins, self._ends = line_spans(data)
        longest = int((self._ends - self._begins).max(initial=0))
        if longest > _LONGEST_LINE:
            row = int(np.argmax(self._ends - self._begins))
            self.faults.add(row + 1, 1, f"a line of {longest} characters", expected="at most 255 characters")
            self.faults.stop()
        self._starts = self._begins.copy()
        self._trim()
        self.blank = self._starts >= self._ends
        dollars = np.flatnonzero(self._bytes[np.minimum(self._starts, len(data) - 1)] == ord("$"))
        for row in dollars.tolist():
            if self._text(row)[:4].upper() == b"$COM":
                self.blank[row] = True
        self._few = _FEW if len(data) < _LARGE else _VERY_FEW
        self._any_blank = bool(self.blank.any())
        self._filled = np.flatnonzero(~self.blank) if self._any_blank else np.zeros(0, np.int64)

    def __len__(self) -> int:
        return len(self._starts)

    def _trim(self) -> None:
        """Take the blanks around the lines off their spans."""
        last = len(self._data) - 1
        rows = np.flatnonzero((self._ends > self._starts) & _BLANKS[self._bytes[np.maximum(self._ends - 1, 0)]])
        while len(rows):
            self._ends[rows] -= 1
            some = rows[self._ends[rows] > self._starts[rows]]
            rows = some[_BLANKS[self._bytes[self._ends[some] - 1]]]
        rows = np.flatnonzero((self._ends > self._starts) & _BLANKS[self._bytes[np.minimum(self._starts, last)]])
        while len(rows):
            self._starts[rows] += 1
            rows = rows[_BLANKS[self._bytes[self._starts[rows]]]]

    def _text(self, row: int) -> bytes:
        return self._data[self._starts[row] : self._ends[row]]

    def text(self, row: int) -> str:
        """A line without the blanks around it."""
        return self._text(row).decode(self._encoding, "replace")

    def fields(self, row: int) -> list[tuple[int, bytes]]:
        """The fields of a line, and the column of each, from 1."""
        line, found, at = self._text(row), [], 0
        shift = int(self._starts[row] - self._begins[row]) + 1
        while at < len(line):
            match = _FIELD.match(line, at)
            assert match is not None  # it matches anything
            found.append((match.start(1) + shift, match[1]))
            at = match.end()
        return found

    def words(self, row: int) -> list[bytes]:
        """The fields of a line."""
        line = self._text(row)
        if _EMPTY.search(line):
            return [word for _, word in self.fields(row)]
        return line.replace(b",", b" ").split()

    @staticmethod
    def plain(words: list[bytes]) -> list[int] | None:
        """The fields as whole numbers, where they are digits alone and a double holds them; else None."""
        if all(word.isdigit() and len(word) <= _PLAIN_DIGITS for word in words):
            return [int(word) for word in words]
        return None

    def numbers(self, row: int, least: int, what: str) -> list[float]:
        """The numbers of one line, at least `least`. Leaves the block after noting what is no number."""
        found: list[float] = []
        for place, word in enumerate(self.words(row)):
            number = parse_real(word.decode("latin-1"))
            if number is None or not math.isfinite(number):
                self.fail(row, "not a number", word, "a number", self.fields(row)[place][0])
            found.append(number)
        if len(found) < least:
            self.fail(row, f"{len(found)} numbers in a line of {what}", self._text(row), f"at least {least}", 1)
        return found

    def integers(self, row: int, least: int, most: int, smallest: float, what: str) -> list[int]:
        """The first whole numbers of one line, filled up with 0 to `most`; smallest: what the first may be."""
        plain = self.plain(self.words(row))
        if plain is not None and len(plain) >= max(least, 1) and plain[0] >= smallest:
            return (plain + [0] * most)[:most]
        found = (self.numbers(row, least, what.removesuffix("'s number")) + [0.0] * most)[:most]
        for place, value in enumerate(found):
            if not value.is_integer() or abs(value) >= _EXACT or (place == 0 and value < smallest):
                column, word = self.fields(row)[place]
                wanted = "a whole number" if place else what
                self.fail(row, f"not {wanted}", word, wanted, column)
        return [int(value) for value in found]

    def fault(self, row: int, column: int, message: str, text: bytes | str = "", expected: str = "") -> None:
        """Note a fault at a line (from 0; past the last: where the file ends) and a column (from 1)."""
        said = text.decode("latin-1") if isinstance(text, bytes) else text
        said = "".join(letter if letter.isprintable() else "?" for letter in said[:80])
        self.faults.add(row + 1, column, message, said, expected)

    def fail(self, row: int, message: str, text: bytes | str = "", expected: str = "", column: int = 0) -> NoReturn:
        """Note a fault and leave the block. column 0: where the line's text begins."""
        if not column:
            column = 1 + (int(self._starts[row] - self._begins[row]) if row < len(self) else 0)
        self.fault(row, column, message, text, expected)
        raise Broken

    def table(self, rows: Ints, width: int, what: str, least: int = 1) -> Floats:
        """The first `width` numbers of lines, shape (n, width), 0 where a line has fewer, but not fewer than `least`.

        what: of the lines, for messages. Leaves the block after noting what is no number.
        """
        if len(rows) * width < self._few:
            values, counts = np.zeros((len(rows), width)), np.zeros(len(rows), np.int64)
            care = np.ones(len(rows), bool)
        else:
            from zrno.translators import scan

            some = self._span(rows)
            values, counts, odd = scan.free(self._bytes, self._starts[some], self._ends[some], width)
            care = np.zeros(len(rows), bool) if odd is None else odd
        bad = False
        for i in np.flatnonzero(care).tolist():
            bad |= self._parse(int(rows[i]), values[i], counts, i)
        for i in np.flatnonzero(counts < least)[:MAX_FAULTS].tolist():
            self.fault(
                int(rows[i]),
                1,
                f"{counts[i]} numbers in a line of {what}",
                self._text(int(rows[i])),
                f"at least {least}",
            )
            bad = True
        if bad:
            raise Broken
        return values

    def flagged(self, rows: Ints) -> Ints:
        """Which of lines (places among `rows`) hold more than zeros."""
        if len(rows) < self._few:
            return np.arange(len(rows))
        from zrno.translators import scan

        some = self._span(rows)
        return np.flatnonzero(~scan.zeros(self._bytes, self._starts[some], self._ends[some]))

    @staticmethod
    def _span(rows: Ints) -> slice | Ints:
        """An index of lines: a slice where there is one, which copies nothing."""
        step = int(rows[1] - rows[0]) if len(rows) > 1 else 1
        return slice(int(rows[0]), int(rows[-1]) + 1, step) if (np.diff(rows) == step).all() else rows

    def _parse(self, row: int, values: Floats, counts: Ints, i: int) -> bool:
        """One line of a table in Python; whether it is bad."""
        fields = self.fields(row)
        counts[i] = len(fields)
        values[:] = 0.0
        for k, (column, word) in enumerate(fields[: len(values)]):
            number = parse_real(word.decode("latin-1"))
            if number is None or not np.isfinite(number):
                self.fault(row, column, "not a number", word, "a number")
                return True
            values[k] = number
        return False

    def whole(self, values: Floats, rows: Ints, least: int = -(2**53), what: str = "a whole number") -> Ints:
        """Columns of a table as integers, shape (n, k), whose first column is the lines' `values[:, 0]`.

        Notes and leaves where one is not whole, or below `least`.
        """
        with np.errstate(invalid="ignore"):  # beyond 64 bits: noted below
            found: Ints = values.astype(np.int64)
        if not found.size or (
            (found == values).all() and found.min() >= least and max(-found.min(), found.max()) < _EXACT
        ):
            return found
        good = (np.abs(values) < _EXACT) & (np.rint(values) == values) & (values >= least)
        for i in np.flatnonzero(~good.all(axis=1))[:MAX_FAULTS].tolist():
            k = int(np.argmin(good[i]))
            fields = self.fields(int(rows[i]))
            column, word = fields[k] if k < len(fields) else (1, b"")
            self.fault(int(rows[i]), column, f"not {what}", word, what)
        raise Broken

    def list_ends(self, rows: Ints) -> NDArray[np.bool_]:
        """Which of lines end a list: their first field is -1, as a whole number."""
        starts, ends, last = self._starts[rows], self._ends[rows], len(self._data) - 1
        first, second, third = (self._bytes[np.minimum(starts + k, last)] for k in range(3))
        alone = (ends == starts + 2) | (third == ord(",")) | _BLANKS[third]
        found: NDArray[np.bool_] = (ends >= starts + 2) & (first == ord("-")) & (second == ord("1")) & alone
        return found

    def begins_with_end(self, row: int) -> bool:
        """Whether a line ends a list."""
        line = self._text(row)
        return line[:2] == b"-1" and line[2:3] in (b"", b",", b" ", b"\t", b"\r", b"\f", b"\v")

    def below(self, rows: Ints, offset: int) -> Ints:
        """The lines that stand `offset` lines below others, blank ones not counted."""
        if not self._any_blank:
            return rows + offset
        found: Ints = self._filled[np.searchsorted(self._filled, rows) + offset]
        return found

    def marks(self) -> Ints:
        """The lines that are -1 and nothing else."""
        two = np.flatnonzero(self._ends - self._starts == 2)
        first = self._starts[two]
        found: Ints = two[(self._bytes[first] == ord("-")) & (self._bytes[first + 1] == ord("1"))]
        return found
