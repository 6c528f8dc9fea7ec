"""*PART, *SECTION_... and *HOURGLASS numbers: what the elements of a part have in common."""

from __future__ import annotations

from typing import Any

from zrno.translators.lsdyna.cards import Card
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.lsdyna.tables import PARTS_CARD, SECTIONS, SectionRow
from zrno.translators.model import Part, Section

PARTS = Registry()

# Cards behind a part's own, by the words of its keyword; inertia has one more where it names a system.
_PART_CARDS = {"INERTIA": 3, "REPOSITION": 1, "CONTACT": 1, "PRINT": 1, "ATTACHMENT_NODES": 1, "FIELD": 1}


@PARTS("PART")
def _part(deck: Deck, block: Block, options: list[str]) -> bool:
    words = "_".join(options)
    given = []
    for word in _PART_CARDS:
        if word in words:
            given.append(word)
            words = words.replace(word, "").strip("_").replace("__", "_")
    if words:
        return False
    rows = block.rows().tolist()
    while rows:
        title = block.file.words(rows[0]).rstrip()[:200].strip()
        if len(rows) == 1:
            if title:
                deck.fault(
                    block.file, rows[0], 0, "a part without its card", title, "a title line, then pid, secid, .."
                )
            return True
        card = Card(deck, block, rows[1], PARTS_CARD)
        number = card.id("pid", "part")
        native: dict[str, Any] = {}
        for name, kind in (("hgid", "other"), ("grav", "curve"), ("adpopt", ""), ("tmid", "material")):
            if card[name]:
                native[name] = card.id(name, kind)
        more = []
        if "INERTIA" in given:
            inertia = Card(deck, block, rows[2] if len(rows) > 2 else None, "xc yc zc tm ircs/i")
            more.append(3 + (inertia["ircs"] == 1))
        more += [_PART_CARDS[word] for word in given if word != "INERTIA"]
        extra = rows[2 : 2 + sum(more)]
        if extra:
            native["options"] = "_".join(given)
            native["cards"] = [block.file.text(row) for row in extra]
            if block.widths.value == "long":
                native["long"] = True
            if "INERTIA" in given or "REPOSITION" in given:
                deck.count("{n} parts' cards of inertia or position are not read, kept for .k alone", 1, block)
        if number <= 0:
            card.fault("pid", "a part's number is not positive", "1 or more")
        if number in deck.model.parts:
            deck.warn(block, f"part {number} stands twice: the later one counts", rows[1])
        deck.model.parts[number] = Part(
            number,
            title,
            material=card.id("mid", "material") or None,
            section=card.id("secid", "other") or None,
            eos=card.id("eosid", "material") or None,
            source=deck.source(block, rows[1]),
            native=native,
        )
        rows = rows[2 + sum(more) :]
    return True


@PARTS("SECTION")
def _section(deck: Deck, block: Block, options: list[str]) -> bool:
    title = take(options, "TITLE")
    row_of = SECTIONS.get("_".join(options))
    if row_of is None:
        return False
    rows = block.rows().tolist()
    while rows:
        name = ""
        if title:
            name = block.file.words(rows.pop(0)).strip()
            if not rows:
                break
        used = _one_section(deck, block, rows, row_of, name)
        rows = rows[used:]
    return True


def _one_section(deck: Deck, block: Block, rows: list[int], table: SectionRow, name: str) -> int:
    """Read a section from its first row; returns how many rows it takes."""
    fields: dict[str, Any] = {}
    first = Card(deck, block, rows[0], table.cards[0])
    number = first.id("secid", "other")
    for i, spec in enumerate(table.cards_of(int(first["elform"]) if "elform" in first.layout.sizes else 0)):
        card = Card(deck, block, rows[i] if i < len(rows) else None, spec)
        for key in card.layout.sizes:
            if key not in ("secid", "unused") and card.given(key):
                fields[key] = card[key]
    count = len(table.cards_of(int(fields.get("elform", 0))))
    if fields.get("icomp") == 1 and table.kind in ("shell", "tshell"):
        layers = -(-int(min(max(fields.get("nip", 2), 0), 1000)) // 8)
        deck.count("{n} sections' layer angles are not read", 1, block)
        count += layers
    if abs(int(fields.get("elform", 0))) >= 100 and len(rows) > count:
        deck.count("{n} sections of user elements: their further cards are not read", 1, block)
        count = len(rows)
    if not number:
        return count
    if number in deck.model.sections:
        deck.warn(block, f"section {number} stands twice: the later one counts", rows[0])
    if deck.frame.length != 1.0:
        fields = {key: value * deck.frame.length ** table.powers.get(key, 0) for key, value in fields.items()}
    deck.model.sections[number] = Section(
        number,
        name,
        table.kind,
        table.parameters(fields),
        plane=table.plane(fields),
        native={"keyword": table.keyword, **fields},
        source=deck.source(block, rows[0]),
    )
    return count
