"""Lines of a keyword file: where they start, which are keywords, and the data lines of each.

Nothing is copied: a keyword's lines are a range of the file's. `*` in column 1 begins a keyword, `$` a comment. `*END`
stops the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zrno.translators.lsdyna.bulk import load
from zrno.translators.text import Ints, refuse_short_lines

_STAR, _DOLLAR, _BLANK, _NEWLINE, _RETURN = b"*$ \n\r"
_TAIL = 1000  # rows looked at together for blank ones at the end
_ROWS_AT_A_TIME = 50_000
_KEYWORD = re.compile(r"\*\s*([^\s,(]+)\s*(.*)")


class Widths(Enum):
    """How wide fields are: as each card says, ids of eight columns in ten, or all of at most twenty in twenty."""

    STANDARD = "standard"
    I10 = "i10"
    LONG = "long"

    def of(self, width: int) -> int:
        """Columns of a field that has `width` in the standard format."""
        if self is Widths.LONG:
            return max(width, 20) if width <= 20 else 2 * width
        return 10 if self is Widths.I10 and width == 8 else width


class File:
    """A file's lines. shown: the path for messages; line numbers are from 0 here, from 1 in messages.

    bytes: all of it; starts, ends: (n,) first byte of each line and the byte past its last; first: (n,) the first byte,
    a blank of an empty line; binary: whether a byte is 0.
    """

    def __init__(self, shown: str, path: Path) -> None:
        data, ends, self.binary = load(path, shown)
        refuse_short_lines(shown, len(data), len(ends))
        if data[:3].tobytes() == b"\xef\xbb\xbf":  # a mark that some editors put before UTF-8
            data, ends = data[3:], ends - 3
        self.shown = shown
        self.bytes = data
        if len(data) and data[-1] != _NEWLINE:
            ends = np.append(ends, len(data))
        self.ends = ends
        self.starts = np.empty_like(ends)
        self.starts[:1] = 0
        np.add(ends[:-1], 1, out=self.starts[1:])
        if len(self.ends):
            # the last byte of a line that is not empty; of an empty one the newline before it, which is no matter
            self.ends -= (data[self.ends - 1] == _RETURN) & (self.ends > self.starts)
            self.first = data[np.minimum(self.starts, len(data) - 1)]
            self.first[self.starts == self.ends] = _BLANK
        else:
            self.first = np.empty(0, np.uint8)

    def raw(self, line: int) -> bytes:
        """A line's bytes."""
        return self.bytes[self.starts[line] : self.ends[line]].tobytes()

    def text(self, line: int) -> str:
        """A line, a character a byte: columns count bytes."""
        return self.raw(line).decode("latin-1")

    def words(self, line: int) -> str:
        """A line as a person wrote it."""
        raw = self.raw(line)
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError:
            return raw.decode("latin-1")

    def keywords(self, widths: Widths) -> Iterator[Block]:
        """The keywords of the file in order, up to *END. widths: of the including file; *KEYWORD may change them."""
        lines = np.flatnonzero(self.first == _STAR)
        ends = np.append(lines[1:], len(self.starts))[: len(lines)]  # none where there is no keyword
        for line, end in zip(lines.tolist(), ends.tolist(), strict=True):
            match = _KEYWORD.match(self.text(line)[:400])
            if match is None:
                continue
            name, remark = match[1].upper(), match[2].strip()
            if name == "END":
                return
            if name == "KEYWORD":
                widths = self._keyword(remark.upper(), widths, line)
            own = widths
            suffix = name[-1] if name[-1] in "+-%" else (remark if remark in ("+", "-", "%") else "")
            if suffix:
                own = {"+": Widths.LONG, "-": Widths.STANDARD, "%": Widths.I10}[suffix]
                name = name.rstrip("+-%")
            yield Block(self, name, remark, line, line + 1, end, own)

    def data_before_keywords(self) -> int | None:
        """The first line with text that stands before any keyword, or None."""
        keywords = np.flatnonzero(self.first == _STAR)
        last = int(keywords[0]) if len(keywords) else len(self.first)
        return next((i for i in range(min(last, 1000)) if self.first[i] != _DOLLAR and self.text(i).strip()), None)

    def has_keywords(self) -> bool:
        """Whether any line begins with `*` and a letter."""
        return any(_KEYWORD.match(self.text(i)) for i in np.flatnonzero(self.first == _STAR)[:10].tolist())

    def _keyword(self, remark: str, widths: Widths, line: int) -> Widths:
        options = dict(re.findall(r"(LONG|I10)\s*=\s*(\w)", remark))
        if options.get("LONG") == "Y":
            return Widths.LONG
        if options.get("LONG") in ("S", "K"):  # what they mean differs between sources: the mesh shows it
            return Widths.LONG if self._looks_long(line) else Widths.STANDARD
        if "LONG" in options:
            widths = Widths.STANDARD
        return Widths.I10 if options.get("I10") == "Y" else widths

    def _looks_long(self, line: int) -> bool:
        """Whether the first row of nodes or elements has its first number past column 8."""
        for i in np.flatnonzero(self.first == _STAR).tolist():
            if i > line and self.text(i).upper().startswith(("*NODE", "*ELEMENT")):
                row = next((self.text(k) for k in range(i + 1, len(self.first)) if self.first[k] != _DOLLAR), "")
                return "," not in row and not row[:8].strip() and bool(row[8:20].strip())
        return False


@dataclass(slots=True)
class Block:
    """A keyword and its data lines. name: upper case, without star and width suffix; line: its own; first, last: the
    lines behind it."""

    file: File
    name: str
    remark: str
    line: int
    first: int
    last: int
    widths: Widths

    def rows(self, *, blank: bool = True) -> Ints:
        """The data lines: no comments, no blank lines at the end, and none at all where not `blank`."""
        rows = self.first + np.flatnonzero(self.file.first[self.first : self.last] != _DOLLAR)
        if not blank:
            return rows[~self._blank(rows)]
        while len(rows):
            tail = rows[-_TAIL:]
            full = np.flatnonzero(~self._blank(tail))
            rows = rows[: len(rows) - len(tail) + (int(full[-1]) + 1 if len(full) else 0)]
            if len(full):
                break
        return rows

    def titled(self, titled: bool, *, blank: bool = True) -> tuple[str, Ints]:
        """The title, where the keyword has one, and the data lines behind it."""
        rows = self.rows()
        name = self.file.words(int(rows[0])).strip() if titled and len(rows) else ""
        rows = rows[int(titled) :]
        return name, rows if blank else rows[~self._blank(rows)]

    def blank_behind(self, rows: Ints, count: int) -> Ints:
        """The data lines with up to `count` of the blank ones behind them, which are cards where cards are counted."""
        every = self.first + np.flatnonzero(self.file.first[self.first : self.last] != _DOLLAR)
        return every[: len(rows) + count]

    def _blank(self, rows: Ints) -> NDArray[np.bool_]:
        """Which rows have no text. Nearly all begin with a blank: only those that end with one too are looked at."""
        file = self.file
        starts, ends = file.starts[rows], file.ends[rows]
        empty: NDArray[np.bool_] = starts == ends
        last = file.bytes[np.maximum(ends - 1, 0)]
        odd = np.flatnonzero((file.first[rows] <= _BLANK) & (last <= _BLANK) & ~empty)
        for begin in range(0, len(odd), _ROWS_AT_A_TIME):
            some = odd[begin : begin + _ROWS_AT_A_TIME]
            low = int(starts[some[0]])
            spans = np.column_stack([starts[some], ends[some]]).ravel() - low
            text = np.append(file.bytes[low : int(ends[some[-1]])] > _BLANK, False)
            empty[some] = np.add.reduceat(text, spans, dtype=np.int64)[::2] == 0
        return empty

    def data(self) -> bytes:
        """The bytes of the data lines, comments among them."""
        if self.first >= self.last:
            return b""
        return self.file.bytes[self.file.starts[self.first] : self.file.ends[self.last - 1]].tobytes()

    def __len__(self) -> int:
        return len(self.rows())
