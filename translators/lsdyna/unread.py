"""Keywords that no reader knows: counted, and kept as text, so that a deck that is written again still has them."""

from __future__ import annotations

import re

from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.expressions import BadExpression
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.real_text import real_text
from zrno.translators.text import Ints

_REFERENCE = re.compile(r"( *)(-?(?:&\w+|<[^<>]*>))")

# Of these an include's offsets and places change nothing.
_INDEPENDENT = ("CONTROL", "DATABASE", "DAMPING")


def keep(deck: Deck, block: Block, rows: Ints | None = None, why: str = "", *, quiet: bool = False) -> None:
    """Count a keyword that is not read, or some of its rows, and keep it as text in the model's `native`."""
    if rows is None:
        rows = block.rows()
    frame = deck.frame
    kept = frame.plain or block.name.split("_")[0] in _INDEPENDENT
    what = f"*{block.name}: {why or 'not read'}"
    if not (quiet and kept):
        deck.count(
            f"{what} ({{n}}), {'kept for .k alone' if kept else 'not kept: its include moves numbers'}", 1, block
        )
    if not kept:
        return
    file = block.file
    data = block.data()
    if b"&" in data or b"<" in data:
        text = "\n".join(resolved_line(deck, block, int(row)) for row in rows)
    else:
        text = "\n".join(file.text(row) for row in rows.tolist())
    name = block.name + (f" {block.remark}" if block.remark not in ("+", "-", "%") else "")
    deck.model.native.setdefault("lsdyna", []).append((name.strip(), block.widths.value, text))


def resolved_line(deck: Deck, block: Block, row: int) -> str:
    """A line with the values of its parameters, in their columns."""

    def put(match: re.Match[str]) -> str:
        try:
            worth = deck.parameters.value(match[2])
        except BadExpression:
            return match[0]
        if isinstance(worth, float):
            worth = real_text(worth, max(min(len(match[0]), 20), 10))[0]
        return str(worth) if free else str(worth).rjust(len(match[0]))

    text = block.file.text(row)
    free = "," in text
    return _REFERENCE.sub(put, text)
