"""The text of a Gambit neutral file: sections between a heading and ENDOFSECTION, their numbers and their faults.

Numbers stand in fixed columns, but some programs shift these: numbers are read by words. Integers that fill their
columns touch; then they are parted by their columns first.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from zrno.translators.model import Floats, Ints
from zrno.translators.text import Faults, InputError

_END = re.compile(rb"^[ \t]*ENDOFSECTION[^\n]*(\n|\Z)", re.MULTILINE)
_HEADING = re.compile(rb"[ \t]*(.*?)[ \t]*(\d+(?:\.\d*)*)?[ \t]*\r?\n")
_COMMENT = re.compile(rb"^/[^\n]*", re.MULTILINE)
_INTEGER = re.compile(rb"[+-]?\d{1,18}")
_D_TO_E = bytes.maketrans(b"dD", b"EE")
_HEAD_BYTES = 4096  # of a section: its first lines stand there
_LONGEST_LINE = 200  # of lines in columns
_BLANK = ord(" ")


@dataclass(slots=True)
class Section:
    """name: heading without the version; text: what stands below it; line: of the first line of the text."""

    name: str
    version: str
    text: bytes
    line: int
    path: str

    def lines(self, count: int) -> list[str]:
        """The first lines."""
        found = self.text[:_HEAD_BYTES].decode("latin-1").split("\n")[:count]
        return [line.rstrip("\r") for line in found] + [""] * (count - len(found))

    def fail(self, row: int, message: str, text: str = "", expected: str = "") -> NoReturn:
        """Stop with a fault at a line of the text, from 0; -1: where the section ends."""
        line = self.line + (row if row >= 0 else self.text.count(b"\n"))
        faults = Faults(self.path)
        faults.add(line, 1, message, text[:80], expected)
        raise InputError(faults.found)

    def fail_at_number(self, values: Ints, at: int, message: str, expected: str) -> NoReturn:
        """Stop with a fault at the line that begins with a number: an element's."""
        row = re.search(rb"^[ \t]*%d[ \t]" % int(values[at]), self.text, re.MULTILINE)
        self.fail(self.text.count(b"\n", 0, row.start()) if row else 0, message, expected=expected)

    def reals(self, count: int, width: int, what: str, *, first: int = 0) -> Floats:
        """A table of `count` lines and `width` numbers behind the first lines."""
        text = self._below(first)
        values = _words(text.translate(_D_TO_E), np.float64) if 2 * count * width <= len(text) + 1 else None
        if values is None or len(values) != count * width:
            self._fail_at_table(text, first, count, width, what)
        return values.reshape(count, width)

    def integers(self, first: int) -> Ints:
        """All integers below the first lines, 10I8 a line."""
        text = self._below(first)
        return self._whole(_parted(text, 0) or text, first)

    def element_numbers(self) -> Ints:
        """Numbers of element lines (I8,1X,I2,1X,I2,1X,7I8, continued 15X,7I8) as one stream."""
        text = self._below(0)
        return self._whole(_parted(text, 15) or text, 0)

    def _whole(self, text: bytes, first: int) -> Ints:
        values = _words(text, np.int64)
        if values is None:
            for row, line in enumerate(text.split(b"\n"), first):
                for word in line.split():
                    if not _INTEGER.fullmatch(word):
                        self.fail(row, "not a whole number", word.decode("latin-1"), "digits")
            self.fail(first, "not whole numbers", expected="digits")
        return values

    def _fail_at_table(self, text: bytes, first: int, count: int, width: int, what: str) -> NoReturn:
        """Stop at the first line of a table that has not `width` numbers, or at its end."""
        rows = 0
        for row, line in enumerate(text.split(b"\n"), first):
            words = line.split()
            if words and (len(words) != width or _words(line.translate(_D_TO_E), np.float64) is None):
                said = line.decode("latin-1").strip()
                self.fail(row, f"not a line of {what}", said, f"{width} number{'s' * (width > 1)}")
            rows += bool(words)
        self.fail(-1, f"{rows} {what} where {count} are announced", expected=f"{count} {what}")

    def _below(self, first: int) -> bytes:
        """The text behind its first lines, without comments."""
        start = 0
        for _ in range(first):
            start = self.text.find(b"\n", start) + 1
            if not start:
                return b""
        text = self.text[start:]
        return _COMMENT.sub(b"", text) if b"\n/" in text or text.startswith(b"/") else text


def sections(data: bytes, faults: Faults) -> Iterator[Section]:
    """The sections in turn; a fault where one does not end."""
    at, line = 0, 1
    data = data.removeprefix(b"\xef\xbb\xbf")
    for end in _END.finditer(data):
        text = data[at : end.start()]
        stripped = text.lstrip(b" \t\r\n")
        while stripped.startswith(b"/"):
            stripped = stripped.partition(b"\n")[2].lstrip(b" \t\r\n")
        start = line + text.count(b"\n", 0, len(text) - len(stripped))
        match = _HEADING.match(stripped)
        if match is not None:
            name = match[1].decode("latin-1").upper()
            version = (match[2] or b"").decode("latin-1")
            yield Section(name, version, stripped[match.end() :], start + 1, faults.path)
        elif stripped:
            yield Section(stripped[:80].decode("latin-1").upper().strip(), "", b"", start + 1, faults.path)
        line += data.count(b"\n", at, end.end())
        at = end.end()
    if data[at:].strip():
        name = data[at:].strip().split(b"\n", 1)[0][:40].decode("latin-1").strip()
        faults.add(1 + data.count(b"\n"), 1, f"the file ends inside {name}", expected="ENDOFSECTION")
        faults.stop()


def _words(text: bytes, dtype: type) -> NDArray[Any] | None:
    """The numbers of a text; None where it holds anything else."""
    if not text.strip():
        return np.zeros(0, dtype)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            values: NDArray[Any] = np.fromstring(text, dtype, sep=" ")
    except (DeprecationWarning, ValueError):
        return None
    if dtype is np.int64 and (values.max() == np.iinfo(np.int64).max or values.min() == np.iinfo(np.int64).min):
        return None
    return values


def _parted(text: bytes, head: int) -> bytes | None:
    """A text whose integers, in columns of 8 behind `head` columns, touch: with blanks between them. Else None."""
    rows = [row for row in text.replace(b"\r", b"").split(b"\n") if row.strip()]
    longest = max(map(len, rows), default=0)
    if longest > _LONGEST_LINE or longest <= head + 8:
        return None
    grid = np.array(rows, f"S{longest}").view(np.uint8).reshape(len(rows), longest)
    grid = np.where(grid == 0, np.uint8(_BLANK), grid)
    full = (grid != _BLANK) & (grid != ord("\t"))
    cuts = np.arange(head + 8, longest, 8)
    if not (full[:, cuts - 1] & full[:, cuts]).any() or (head and full[:, [8, 11, 14]].any()):
        return None
    lengths = longest - np.argmax(full[:, ::-1], axis=1) - head
    if (lengths % 8).any():
        return None  # not in these columns: a long word is one number
    parted = np.insert(grid, cuts, _BLANK, axis=1)
    ends = np.full((len(parted), 1), ord("\n"), np.uint8)
    return np.concatenate((parted, ends), axis=1).tobytes()
