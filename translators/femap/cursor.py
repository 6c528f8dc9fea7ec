"""Records of a block in turn: lines of numbers, titles, counted values, lists that end with -1."""

from __future__ import annotations

import math
from typing import NoReturn

import numpy as np

from zrno.translators.femap.framing import Block
from zrno.translators.femap.lines import Lines
from zrno.translators.model import Ints, Source

_NULL = "<NULL>"
_FIRST_CHUNK, _LARGEST_CHUNK = 64, 1 << 18
_MOST_IN_A_LINE = 2048  # numbers
_SHORT = 16  # lines of a list that is read in Python


class Cursor:
    """Goes through the lines of a block; blank ones are passed by, except as titles."""

    def __init__(self, lines: Lines, block: Block) -> None:
        self.lines, self.block = lines, block
        self.at = block.first

    @property
    def source(self) -> Source:
        """The place of the next line."""
        return Source(self.lines.faults.path, self.next_line() + 1)

    def next_line(self) -> int:
        """The next line that is not blank; the block's end where there is none."""
        while self.at < self.block.last and self.lines.blank[self.at]:
            self.at += 1
        return self.at

    @property
    def done(self) -> bool:
        """Whether no line is left."""
        return self.next_line() >= self.block.last

    def fail(self, message: str, expected: str = "") -> NoReturn:
        """Leave the block with a fault at the next line."""
        text = "" if self.done else self.lines.text(self.at)
        self.lines.fail(self.at, message, text, expected)

    def words(self, what: str) -> list[bytes]:
        """The fields of the next line."""
        if self.done:
            self.fail(f"block {self.block.number} ends here", what)
        self.at += 1
        return self.lines.words(self.at - 1)

    def numbers(self, least: int, what: str) -> list[float]:
        """The numbers of the next line, at least `least`."""
        if self.done:
            self.fail(f"block {self.block.number} ends here", what)
        self.at += 1
        return self.lines.numbers(self.at - 1, least, what)

    def integers(self, least: int, what: str, smallest: float = -math.inf, most: int = 0) -> list[int]:
        """The first whole numbers of the next line: at least `least`, filled up with 0 to `most`.

        smallest: what the first of them may be.
        """
        if self.done:
            self.fail(f"block {self.block.number} ends here", what)
        self.at += 1
        return self.lines.integers(self.at - 1, least, max(least, most), smallest, what)

    def values(self, count: int, what: str) -> list[float]:
        """The next `count` numbers, on as many lines as they take."""
        found: list[float] = []
        while len(found) < count:
            found += self.numbers(1, f"{what}: {count} values")
        return found[:count]

    def wholes(self, count: int, what: str) -> list[int]:
        """The next `count` whole numbers, on as many lines as they take."""
        found = self.values(count, what)
        if not all(value.is_integer() and abs(value) < 2**53 for value in found):
            self.lines.fail(self.at - 1, f"{what} that are not whole numbers", self.lines.text(self.at - 1))
        return [int(value) for value in found]

    def count(self, what: str) -> int:
        """A count, on a line of its own; one that the block cannot hold is a fault."""
        number = self.integers(1, f"a count of {what}", 0)[0]
        left = self.block.last - self.at
        if number > _MOST_IN_A_LINE * left:
            self.lines.fail(self.at - 1, f"{number} {what} where {left} lines follow", self.lines.text(self.at - 1))
        return number

    def title(self) -> str:
        """The next line, blank or not, as it is."""
        if self.at >= self.block.last:
            self.fail(f"block {self.block.number} ends here", "a title")
        self.at += 1
        text = self.lines.text(self.at - 1)
        return "" if text == _NULL else text

    def skip(self, count: int, what: str) -> None:
        """Pass by lines that are not needed."""
        if self.at + count <= self.block.last and not self.lines.blank[self.at : self.at + count].any():
            self.at += count
            return
        for _ in range(count):
            if self.done:
                self.fail(f"block {self.block.number} ends here", what)
            self.at += 1

    def at_end(self) -> bool:
        """Whether the next line ends a list."""
        return not self.done and self.lines.begins_with_end(self.at)

    def records(self, stride: int, what: str) -> Ints:
        """The lines at which the records of a list begin, `stride` lines each, until the -1 that ends it."""
        found: list[Ints] = []
        size = _FIRST_CHUNK
        while True:
            rows = self._rows(size * stride)
            heads = rows[::stride]
            if not len(heads):
                self.fail(f"a list of {what} does not end", "a line that begins with -1")
            ends = self.lines.list_ends(heads)
            if ends.any():
                count = int(np.argmax(ends))
                found.append(heads[:count])
                self.at = int(heads[count]) + 1
                return np.concatenate(found)
            if len(rows) < len(heads) * stride:
                self.at = self.block.last
                self.fail(f"a list of {what} ends inside a record", f"{stride} lines")
            found.append(heads)
            self.at = int(rows[-1]) + 1
            size = min(2 * size, _LARGEST_CHUNK)

    def short_list(self, width: int) -> list[list[int]] | None:
        """The rows of a list that ends after a few lines of plain whole numbers; None, and nothing passed, of others.

        Files have lists of one member by the ten thousand, for which arrays are slow.
        """
        found: list[list[int]] = []
        for row in range(self.at, min(self.at + _SHORT, self.block.last)):
            words = self.lines.words(row)
            if words and words[0] == b"-1":
                self.at = row + 1
                return found
            plain = self.lines.plain(words)
            if plain is None or len(plain) < width:
                return None
            found.append(plain[:width])
        return None

    def peek(self, count: int) -> Ints:
        """The next lines that are not blank, at most `count`, without passing them."""
        return self._rows(count)

    def below(self, rows: Ints, offset: int) -> Ints:
        """The lines that stand `offset` lines below others, blank ones not counted."""
        return self.lines.below(rows, offset)

    def take(self, count: int, what: str) -> Ints:
        """The next `count` lines that are not blank."""
        rows = self._rows(count) if count else np.zeros(0, np.int64)
        if len(rows) < count:
            self.at = self.block.last
            self.fail(f"block {self.block.number} ends inside {what}", f"{count} lines")
        if count:
            self.at = int(rows[-1]) + 1
        return rows

    def at_set(self, fields: int) -> bool:
        """Whether a set begins: a number alone, a title, and a line of at least `fields` fields or a list's end."""
        if self.done:
            return False
        head, third = self.lines.words(self.at), self.at + 2
        while third < self.block.last and self.lines.blank[third]:
            third += 1
        if len(head) != 1 or not head[0].isdigit() or third >= self.block.last:
            return False
        return len(self.lines.words(third)) >= fields or self.lines.begins_with_end(third)

    def pass_to_set(self, fields: int) -> int:
        """Pass by all lines up to where a set begins; how many of them were no ends of lists."""
        passed = 0
        while not self.done and not self.at_set(fields):
            passed += not self.at_end()
            self.at += 1
        return passed

    def _rows(self, count: int) -> Ints:
        """The next lines that are not blank, at most `count`, without going past them."""
        self.next_line()
        blank, first, stop = self.lines.blank, self.at, self.at
        rows = np.zeros(0, np.int64)
        while len(rows) < count and stop < self.block.last:  # blank lines are rare: seldom more than one pass
            stop = min(max(stop + count, stop + (stop - first)), self.block.last)
            rows = first + np.flatnonzero(~blank[first:stop])
        return rows[:count]

    def rest(self) -> Ints:
        """All lines that are left and not blank."""
        return self.at + np.flatnonzero(~self.lines.blank[self.at : self.block.last])
