"""Text decks: fixed-width fields, block parsing, and faults that name their place. Shared by all readers.

A deck is a file of lines ("cards") cut into fixed columns as a Fortran format says. `Layout` holds the columns of one
kind of card, `Cards` hands out the cards of a file in order.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.faults import MAX_FAULTS as MAX_FAULTS
from zrno.translators.faults import Fault as Fault
from zrno.translators.faults import Faults as Faults
from zrno.translators.faults import InputError as InputError
from zrno.translators.files import Ints as Ints
from zrno.translators.files import line_spans as line_spans
from zrno.translators.files import read_bytes as read_bytes
from zrno.translators.files import refuse_short_lines as refuse_short_lines
from zrno.translators.files import write_atomically as write_atomically

_CHUNK = 20_000  # cards looked at together: the cut-out columns stay in the cache
_FEW = 100_000  # numbers: below this Python parses them before the jitted kernels are loaded
_REAL = re.compile(r"([+-]?)(\d+\.?\d*|\.\d+)(?:[EeDdQq]([+-]?\d+)|([+-]\d+))?$")
_INTEGER = re.compile(r"[+-]?\d+$")
_LONGEST_REAL = 1000  # characters: what is longer is no number of a person or a program
_LONGEST_INTEGER = 19  # characters that are sure to fit 64 bits
_BLANK = ord(" ")


def _table(characters: bytes) -> NDArray[np.bool_]:
    table = np.zeros(256, bool)
    table[list(characters)] = True
    return table


_DIGITS_OR_BLANK = _table(b"0123456789 ")


def parse_real(text: str, implied: int = 0) -> float | None:
    """A Fortran real: `1.0D+00`, `1.5-3`, blank = 0; None when it is none.

    implied: decimals that the format implies (the 5 of e10.5): without a point the digits are scaled by 10^-implied.
    """
    text = text.strip()
    if not text:
        return 0.0
    match = _REAL.match(text) if len(text) < _LONGEST_REAL else None
    if match is None:
        return None
    sign, mantissa, exponent, bare_exponent = match.groups()
    power = int(exponent or bare_exponent or 0)
    if "." not in mantissa:
        power -= implied
    return float(f"{sign}{mantissa}e{power}")


@dataclass(frozen=True, slots=True)
class Field:
    """A field of a card: columns start..end (from 0, end excluded), kind `i`, `e` or `a`, implied decimals."""

    name: str
    start: int
    end: int
    kind: str
    implied: int = 0


class Layout:
    """The columns of one kind of card.

    format: as Fortran writes it, e.g. "2i5,e10.0,a72"; names: one word a field, separated by blanks.
    """

    def __init__(self, format: str, names: str) -> None:
        self.format = format
        self.fields: dict[str, Field] = {}
        words = iter(names.split())
        column = 0
        for item in format.split(","):
            match = re.fullmatch(r"(\d*)([iea])(\d+)(?:\.(\d+))?", item)
            if match is None:
                raise ValueError(f"not a Fortran format: {item}")
            width = int(match[3])
            for _ in range(int(match[1] or 1)):
                name = next(words)
                self.fields[name] = Field(name, column, column + width, match[2], int(match[4] or 0))
                column += width
        self.width = column

    def only(self, name: str) -> Layout:
        """A layout of one of the fields."""
        f = self.fields[name]
        kind = f"{f.kind}{f.end - f.start}" + (f".{f.implied}" if f.implied else "")
        return Layout(f"a{f.start},{kind}", f"gap {name}") if f.start else Layout(kind, name)


class Block:
    """Cards of one layout. values: an array a numeric field, shape (n,), by name (int64 or float64).

    step: every how manieth card of the deck is one of them; quiet: no faults are noted, what is no number is 0.
    """

    def __init__(
        self, cards: Cards, layout: Layout, first: int, count: int, *, step: int = 1, quiet: bool = False
    ) -> None:
        self.layout = layout
        self._cards = cards
        self._first = first
        self._count = count
        self._step = step
        self._quiet = quiet
        self._faulty: set[tuple[int, str]] = set()
        numeric = [f for f in layout.fields.values() if f.kind != "a"]
        if count * len(numeric) < _FEW:
            self.values = {f.name: self._parse(f, range(count)) for f in numeric}
            return
        from zrno.translators import scan

        spans = cards.spans(first, first + count * step, step)
        fields = [(f.start, f.end, -1 if f.kind == "i" else f.implied) for f in numeric]
        arrays, care = scan.fixed(*spans, fields)
        self.values = {f.name: array for f, array in zip(numeric, arrays, strict=True)}
        if care is None:
            return
        for f, cared in zip(numeric, care, strict=True):
            cells = np.flatnonzero(cared)
            if len(cells):
                self.values[f.name][cells] = self._parse(f, cells.tolist())

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.values[name]

    def line(self, i: int) -> int:
        """Line of card i in its file, from 1."""
        return self._cards.line(self._first + i * self._step)

    def whole(self, i: int = 0) -> str:
        """The line of card i."""
        return self._cards.text(self._first + i * self._step)

    def letters(self, column: int) -> NDArray[np.uint8]:
        """The byte in a column (from 0) of each card: (n,); a blank past its end."""
        data, starts, ends = self._cards.spans(self._first, self._first + self._count * self._step, self._step)
        at = starts + column
        return np.where(at < ends, data[np.minimum(at, len(data) - 1)], np.uint8(_BLANK))

    def text(self, name: str, i: int = 0) -> str:
        """The text of a field of card i, without the blanks around it."""
        f = self.layout.fields[name]
        return self.whole(i)[f.start : f.end].strip()

    def place(self, name: str, i: int = 0) -> tuple[int, int]:
        """Line and column of what a field of card i says; of its first column where it is blank."""
        f = self.layout.fields[name]
        raw = self.whole(i)[f.start : f.end]
        return self.line(i), f.start + 1 + (len(raw) - len(raw.lstrip()) if raw.strip() else 0)

    def fault(self, i: int, name: str, message: str, expected: str = "") -> None:
        """Note a fault in a field of card i, unless it has one: what is no number is not also out of range."""
        if self._quiet or (i, name) in self._faulty:
            return
        self._faulty.add((i, name))
        self._cards.faults.add(*self.place(name, i), message, self.text(name, i) or "blank", expected)

    def stop(self) -> None:
        """Raise InputError when there are faults in the file so far."""
        self._cards.faults.stop()

    def sound(self, name: str, i: int = 0) -> bool:
        """Whether a field of card i has no fault so far."""
        return (i, name) not in self._faulty

    def check(self, name: str, good: NDArray[np.bool_] | bool, message: str, expected: str = "") -> None:
        """Note a fault at each card whose `good` is false."""
        for i in np.flatnonzero(~np.atleast_1d(good))[:MAX_FAULTS].tolist():
            self.fault(i, name, message, expected)

    def _parse(self, f: Field, cards: Iterable[int]) -> NDArray[Any]:
        """Numbers of one field of some cards, one by one."""
        return np.array([self._parse_one(f, i) for i in cards], np.int64 if f.kind == "i" else np.float64)

    def _parse_one(self, f: Field, i: int) -> float:
        text = self.text(f.name, i)
        if f.kind == "i":
            if _INTEGER.match(text) and len(text) < _LONGEST_INTEGER:
                return int(text)
            if text:
                self.fault(i, f.name, f"{f.name} is not an integer", f"digits in columns {f.start + 1}-{f.end}")
            return 0
        number = parse_real(text, f.implied)
        if number is None:
            self.fault(i, f.name, f"{f.name} is not a number", f"a number in columns {f.start + 1}-{f.end}")
            return 0.0
        if not np.isfinite(number):
            self.fault(i, f.name, f"{f.name} is not a finite number", "a number below 1.8E308")
            return 0.0
        return number


class Card:
    """One card: its numbers by field name."""

    def __init__(self, block: Block) -> None:
        self.block = block
        self.line = block.line(0)

    def __getitem__(self, name: str) -> Any:
        return self.block.values[name][0].item()

    def text(self, name: str) -> str:
        """The text of a field, without the blanks around it."""
        return self.block.text(name)

    def place(self, name: str) -> tuple[int, int]:
        """Line and column of what a field says."""
        return self.block.place(name)

    def fault(self, name: str, message: str, expected: str = "") -> None:
        """Note a fault in a field."""
        self.block.fault(0, name, message, expected)

    def sound(self, name: str) -> bool:
        """Whether a field has no fault so far; also where the card has no such field."""
        return self.block.sound(name)

    def check(self, name: str, good: bool, message: str, expected: str = "") -> None:
        """Note a fault in a field unless `good`."""
        if not good:
            self.fault(name, message, expected)


class Cards:
    """The cards of a deck in order: the lines of a text file without its comments.

    comments: bytes that make a line a comment when they stand in its first column, and in its second one of `second`
    where such are named (past a line's end stand blanks). An empty line is a card.
    """

    def __init__(self, path: Path | str, data: bytes, *, comments: bytes, second: bytes = b"") -> None:
        self.faults = Faults(str(path))
        self._data = data
        self._bytes = np.frombuffer(data, np.uint8)
        refuse_short_lines(path, len(data), data.count(b"\n"))
        starts, ends = line_spans(data)
        self._lines = len(starts)
        first = self._bytes[np.minimum(starts, len(data) - 1)]
        marked = _table(comments)[first] & (starts < ends)
        if second:
            marked &= _table(second)[self._bytes[np.minimum(starts + 1, len(data) - 1)]] | (ends - starts == 1)
        self._numbers: Ints | None = None  # lines of the cards, from 1, where there are comments
        if marked.any():
            keep = np.flatnonzero(~marked)
            starts, ends, self._numbers = starts[keep], ends[keep], keep + 1
        self._starts, self._ends = starts, ends
        self._next = 0

    @property
    def left(self) -> int:
        """Cards not yet read."""
        return len(self._starts) - self._next

    def line(self, card: int) -> int:
        """Line of a card (from 0) in its file, from 1."""
        if card >= len(self._starts):
            return self._lines + 1
        return card + 1 if self._numbers is None else int(self._numbers[card])

    @property
    def next_line(self) -> int:
        """Line of the next card."""
        return self.line(self._next)

    def line_of(self, ahead: int) -> int:
        """Line of the card that comes after `ahead` others."""
        return self.line(self._next + ahead)

    def text(self, card: int) -> str:
        """A card's line."""
        return self._data[self._starts[card] : self._ends[card]].decode("latin-1")

    def spans(self, first: int, last: int, step: int = 1) -> tuple[NDArray[np.uint8], Ints, Ints]:
        """All bytes of the file, and where the cards first..last (excluded; or every step-th) start and end in them."""
        return self._bytes, self._starts[first:last:step], self._ends[first:last:step]

    def grid(self, first: int, last: int, width: int) -> NDArray[np.uint8]:
        """Bytes of the cards first..last (excluded), shape (n, width): cut, and filled with blanks."""
        starts, lengths = self._starts[first:last], (self._ends - self._starts)[first:last]
        columns = np.arange(width)
        grid: NDArray[np.uint8] = self._bytes[np.minimum(starts[:, None] + columns, len(self._bytes) - 1)]
        if len(lengths) and lengths.min() < width:
            grid[columns >= lengths[:, None]] = _BLANK
        return grid

    def increasing_run(self, number: Field) -> int:
        """How many of the next cards carry increasing positive integers in a field."""
        run, last = 0, 0
        for first in range(self._next, len(self._starts), _CHUNK):
            columns = self.grid(first, min(first + _CHUNK, len(self._starts)), number.end)[:, number.start :]
            numbers = np.zeros(len(columns), np.int64)
            for column in columns.T:
                digit = column - np.int64(ord("0"))
                numbers = np.where(column == _BLANK, numbers, 10 * numbers + digit)
            good = _DIGITS_OR_BLANK[columns].all(axis=1) & (np.diff(numbers, prepend=last) > 0)
            if not good.all():
                return run + int(np.argmin(good))
            run, last = run + len(good), int(numbers[-1])
        return run

    def peek(self, layout: Layout, count: int) -> Block:
        """The next cards, at most `count`, without going past them."""
        return Block(self, layout, self._next, min(count, self.left))

    def probe(self, layout: Layout, count: int, step: int = 1, skip: int = 0) -> Block:
        """At most `count` of the next cards, every step-th after the first `skip`, without going past them.

        Nothing is noted of faults.
        """
        there = max(-(-(self.left - skip) // step), 0)
        return Block(self, layout, self._next + skip, min(count, there), step=step, quiet=True)

    def lengths(self, count: int, step: int = 1, skip: int = 0) -> Ints:
        """Bytes of the next `count` cards, or of every step-th, the first `skip` left out."""
        _, starts, ends = self.spans(self._next + skip, self._next + skip + count * step, step)
        return ends - starts

    def block(self, layout: Layout, count: int, what: str) -> Block:
        """The next `count` cards; raises InputError where the file ends before them."""
        return self.blocks([layout], count, what)[0]

    def blocks(self, layouts: Sequence[Layout], count: int, what: str) -> list[Block]:
        """The next `count` groups of cards, a layout each card of a group; raises InputError where the file ends."""
        cards = len(layouts)
        whole = min(count, self.left // cards)
        first = self._next
        blocks = [Block(self, layout, first + k, whole, step=cards) for k, layout in enumerate(layouts)]
        if count > whole:
            number = f" {whole + 1} of {count}" if count > 1 else ""
            self.faults.add(self._lines + 1, 1, "the file ends here", expected=f"{what}{number}")
            self.faults.stop()
        self._next += count * cards
        return blocks

    def card(self, layout: Layout, what: str) -> Card:
        """The next card; raises InputError where the file ends before it."""
        return Card(self.block(layout, 1, what))
