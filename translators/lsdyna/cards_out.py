"""Cards as text: standard columns where every number fits exactly, else the long format of that keyword."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.lsdyna.cards import layout
from zrno.translators.lsdyna.lexer import Widths
from zrno.translators.model import Floats, Ints
from zrno.translators.real_text import real_text, real_texts
from zrno.translators.report import Report

# A card is its layout and its fields, or a line of text.
Card = tuple[str, Mapping[str, Any]] | str
_SUFFIX = {Widths.STANDARD: "", Widths.I10: " %", Widths.LONG: " +"}


class Writer:
    """Keywords of a deck as pieces of text. widths: of the deck, standard or ten-column ids."""

    def __init__(self, widths: Widths, report: Report) -> None:
        self.widths = widths
        self.report = report
        self.inexact = 0

    def keyword(self, name: str, cards: Sequence[Card]) -> bytes:
        """A keyword with its cards."""
        lines, lost = self._lines(cards, self.widths)
        suffix = ""
        if lost:
            lines, lost = self._lines(cards, Widths.LONG)
            suffix = " +"
        self.inexact += lost
        return "\n".join([f"*{name}{suffix}", *lines, ""]).encode("utf-8")

    def raw(self, name: str, widths: str, lines: Sequence[str]) -> bytes:
        """A keyword as the text that it was read from."""
        own = Widths(widths)
        suffix = "" if own is self.widths else (" -" if own is Widths.STANDARD else _SUFFIX[own])
        return "\n".join([f"*{name}{suffix}", *lines, ""]).encode("latin-1", "replace")

    def _lines(self, cards: Sequence[Card], widths: Widths) -> tuple[list[str], int]:
        lines, lost = [], 0
        for card in cards:
            if isinstance(card, str):
                lines.append(_one_line(card))
                continue
            text, wrong = _card(*card, widths)
            lines.append(text)
            lost += wrong
        return lines, lost

    def table(self, name: str, columns: Sequence[tuple[NDArray[Any], int]]) -> bytes:
        """A keyword with rows of arrays, (n,) or (n, k), and their standard widths; reals in their shortest text."""
        (grid,), suffix = self.grids([columns])
        return f"*{name}{suffix}\n".encode() + rows([grid])

    def grids(self, cards: Sequence[Sequence[tuple[NDArray[Any], int]]]) -> tuple[list[NDArray[np.uint8]], str]:
        """The characters of tables, and the suffix of a keyword with these cards."""
        found = [self._texts(columns, self.widths) for columns in cards]
        suffix = ""
        if any(lost for _, lost in found):
            found = [self._texts(columns, Widths.LONG) for columns in cards]
            suffix = " +"
        self.inexact += sum(lost for _, lost in found)
        return [np.concatenate(grids, axis=1) for grids, _ in found], suffix

    def _texts(
        self, columns: Sequence[tuple[NDArray[Any], int]], widths: Widths
    ) -> tuple[list[NDArray[np.uint8]], int]:
        grids, lost = [], 0
        for values, width in columns:
            own = widths.of(width)
            flat = values.reshape(len(values), -1)
            if flat.dtype.kind == "f":
                grid, wrong = real_grid(flat, own)
            else:
                grid, wrong = int_grid(flat, own)
            grids.append(grid)
            lost += wrong
        return grids, lost


def rows(grids: Sequence[NDArray[np.uint8]]) -> bytes:
    """Grids of characters, (n, width) each, side by side, as lines."""
    count = len(grids[0])
    end = np.full((count, 1), ord("\n"), np.uint8)
    return np.concatenate([*grids, end], axis=1).tobytes()


def int_grid(values: Ints, width: int) -> tuple[NDArray[np.uint8], int]:
    """Integers (n, k), right-justified in `width` columns each; and how many do not fit."""
    n, k = values.shape
    grid = np.full((n, k, width), ord(" "), np.uint8)
    rest = np.abs(values)
    sign = values < 0  # still to be written
    for column in range(width - 1, -1, -1):
        digits = (rest > 0) | (column == width - 1)
        grid[:, :, column] = np.where(digits, rest % 10 + ord("0"), np.where(sign, ord("-"), ord(" ")))
        sign = sign & digits
        rest = rest // 10
        if not (rest.any() or sign.any()):
            break
    return grid.reshape(n, k * width), int(((rest > 0) | sign).sum())


def real_grid(values: Floats, width: int) -> tuple[NDArray[np.uint8], int]:
    """Reals (n, k), right-justified in `width` columns each; and how many are not exact."""
    texts, lost = real_texts(values.ravel(), width)
    joined = "".join([text.rjust(width) for text in texts]).encode()
    return np.frombuffer(joined, np.uint8).reshape(len(values), -1), lost


def _card(spec: str, fields: Mapping[str, Any], widths: Widths) -> tuple[str, int]:
    """A card's line, and how many of its fields are not exact."""
    pieces, lost = [], 0
    for field in layout(spec, widths).fields:
        value = fields.get(field.name)
        if isinstance(value, list | tuple | np.ndarray):
            value = value[field.index] if field.index < len(value) else None
        width = field.end - field.start
        if value is None:
            pieces.append(" " * width)
        elif isinstance(value, str):
            pieces.append(value[:width].rjust(width))
        elif field.kind == "i" or isinstance(value, int | np.integer):
            text = str(int(value))
            lost += len(text) > width
            pieces.append(text.rjust(width)[:width])
        else:
            text, exact = real_text(float(value), width)
            lost += not exact
            pieces.append(text.rjust(width))
    return "".join(pieces).rstrip(), lost


def _one_line(text: str) -> str:
    """A title: no line breaks, and no sign that would make it a comment or a keyword."""
    text = " ".join(text.splitlines())
    return f" {text}" if text[:1] in ("*", "$") else text
