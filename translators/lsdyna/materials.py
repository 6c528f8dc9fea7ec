"""*MAT_... and *EOS_...: laws of the model's vocabulary, and others as the text they stand in."""

from __future__ import annotations

import math
from typing import Any

from zrno.translators.lsdyna import laws
from zrno.translators.lsdyna.cards import Card
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.model import Eos, Material
from zrno.translators.text import parse_real

MATERIALS = Registry()

_LARGEST = 1e18
_NO_MATERIAL = ("ADD", "NONLOCAL", "THERMAL")


@MATERIALS("MAT", "EOS")
def _law(deck: Deck, block: Block, options: list[str]) -> bool:
    title = take(options, "TITLE")
    family = block.name.split("_")[0]
    keyword = "_".join([family, *options])
    if not options or options[0] in _NO_MATERIAL or options[0].startswith("T0"):
        return False
    row = laws.find(keyword)
    if row is None:
        return _other(deck, block, keyword, title=title)
    places = block.rows().tolist()
    while places:
        name = block.file.words(places.pop(0)).strip() if title else ""
        if not places:
            break
        _known(deck, block, places[: len(row.cards)], row, name)
        places = places[len(row.cards) :]
    return True


def _known(deck: Deck, block: Block, rows: list[int], row: laws.LawRow, name: str) -> None:
    fields: laws.Fields = {}
    lists = {key for pair in row.points.values() for key in pair}
    for i, spec in enumerate(row.cards):
        card = Card(deck, block, rows[i] if i < len(rows) else None, spec)
        for key, size in card.layout.sizes.items():
            many = size > 1 or key in lists
            if key == "unused":
                continue
            if many:
                fields.setdefault(key, []).extend(card.values(key))
            elif card.given(key):
                fields[key] = card.value(key)
    first = Card(deck, block, rows[0], row.cards[0])
    is_material = row.keyword.startswith("MAT_")
    number = first.id("mid" if is_material else "eosid", "material")
    if not number and not any(fields.values()):
        return
    for key in row.curves.values():
        if fields.get(key):
            fields[key] = deck.frame.moved(int(fields[key]), "curve")
    fields = {key: value for key, value in fields.items() if key not in ("mid", "eosid", "ro")
              and not (isinstance(value, list) and not any(value))}  # fmt: skip
    said = row.said(fields)
    frame = deck.frame
    native: dict[str, Any] = {"keyword": row.keyword, "fields": fields}
    if frame.scales:
        said = laws.scaled(said, frame.scale)
        native = {"keyword": row.keyword}
    source = deck.source(block, rows[0])
    if not all(map(math.isfinite, said.parameters.values())):
        names = [name for name, value in said.parameters.items() if not math.isfinite(value)]
        first.fault("mid" if is_material else "eosid", f"{', '.join(names)} cannot be worked out: numbers overflow")
    if is_material:
        _warn_twice(deck, block, rows[0], "material", number, number in deck.model.materials)
        density = float(first["ro"]) * frame.scale(mass=1, length=-3)
        deck.model.materials[number] = Material(
            number, name, said.law, density, said.parameters, source=source, tables=said.tables, curves=said.curves,
            native=native,
        )  # fmt: skip
    else:
        _warn_twice(deck, block, rows[0], "equation of state", number, number in deck.model.equations_of_state)
        deck.model.equations_of_state[number] = Eos(number, name, said.law, said.parameters, native, source)


def _other(deck: Deck, block: Block, keyword: str, *, title: bool) -> bool:
    """A law that the vocabulary lacks: number, density, and its cards as they are."""
    name, rows = block.titled(title)
    if not len(rows):
        return True
    first = Card(deck, block, int(rows[0]), "id/a ro/a")
    number_text, density_text = first["id"], first["ro"]
    number = parse_real(number_text) or 0.0
    number = int(number) if abs(number) < _LARGEST else 0
    if not number:
        return False  # named by letters, or nothing that we understand
    number = deck.frame.moved(number, "material")
    cards = [_text(deck, block, row) for row in rows.tolist()]
    native = {"keyword": keyword, "cards": cards, "widths": block.widths.value}
    what = "material" if keyword.startswith("MAT_") else "equation of state"
    deck.count(f"*{keyword}: the law of {{n}} {what}s is not read, kept for .k alone", 1, block)
    if deck.frame.scales:
        deck.warn(block, f"*INCLUDE_TRANSFORM: {what} {number} is not scaled")
    source = deck.source(block, int(rows[0]))
    if what == "material":
        _warn_twice(deck, block, int(rows[0]), what, number, number in deck.model.materials)
        springs = keyword.startswith(("MAT_SPRING", "MAT_DAMPER", "MAT_S0"))  # they have no density
        density = 0.0 if springs else parse_real(density_text) or 0.0
        deck.model.materials[number] = Material(number, name, "", density, source=source, native=native)
    else:
        _warn_twice(deck, block, int(rows[0]), what, number, number in deck.model.equations_of_state)
        deck.model.equations_of_state[number] = Eos(number, name, "", {}, native, source)
    return True


def _text(deck: Deck, block: Block, row: int) -> str:
    from zrno.translators.lsdyna.unread import resolved_line

    return resolved_line(deck, block, row)


def _warn_twice(deck: Deck, block: Block, row: int, what: str, number: int, before: bool) -> None:
    if before:
        deck.warn(block, f"{what} {number} stands twice: the later one counts", row)
