"""Values into the cards of a text deck, and a count of what the columns round."""

from __future__ import annotations

import unicodedata
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.real_text import real_text, real_texts
from zrno.translators.report import Report
from zrno.translators.text import Layout, parse_real


class CardText:
    """Writes cards, and notes in a report what does not fit them exactly.

    pointed: every real has a decimal point, also where only its digits would fit.
    """

    def __init__(self, report: Report, *, pointed: bool = False) -> None:
        self.report = report
        self.rounded: dict[str, int] = {}
        self._pointed = pointed

    def line(self, layout: Layout, values: dict[str, Any], what: str) -> str:
        """One card; a field without a value is 0, a text field blank.

        Raises ValueError for a number that does not fit its columns.
        """
        line = ""
        for f in layout.fields.values():
            value, width = values.get(f.name), f.end - f.start
            line = line.ljust(f.start)
            if f.kind == "a":
                text = (value or "")[:width].ljust(width)
            elif f.kind == "i":
                text = f"{int(value or 0):{width}d}"
                if len(text) > width:
                    raise ValueError(f"{what}: {f.name} = {value} does not fit {width} columns")
            else:
                implied = f.implied or int(self._pointed)
                text, exact = real_text(value or 0.0, width, implied=implied)
                if not exact:  # spelled as it will be when it is read and written again
                    text, _ = real_text(parse_real(text, f.implied) or 0.0, width, implied=implied)
                    self.note(what, 1)
                text = text.rjust(width)
            line += text
        return line.rstrip()

    def texts(self, values: NDArray[np.float64], width: int, what: str) -> list[str]:
        """Reals of a column, one by one."""
        texts, inexact = real_texts(values, width)
        self.note(what, inexact)
        return texts

    def note(self, what: str, count: int) -> None:
        """Count numbers that were rounded."""
        if count:
            self.rounded[what] = self.rounded.get(what, 0) + int(count)

    def ascii(self, text: str, width: int, what: str) -> str:
        """A text as a deck can hold it: ASCII, cut."""
        plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
        plain = "".join(letter if letter.isprintable() else " " for letter in plain).strip()
        if plain != text.strip() or len(plain) > width:
            self.report.approximate(what, 1, f"ASCII, at most {width} characters")
        return plain[:width].strip()

    def report_rounded(self) -> None:
        """Note all that was rounded in the report."""
        for what, count in self.rounded.items():
            self.report.approximate(what, count, "rounded to the deck's columns")
