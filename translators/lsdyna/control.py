"""*CONTROL_..., *DATABASE_BINARY_D3PLOT and *CONTACT_...: what of them the model has words for."""

from __future__ import annotations

from typing import Any

from zrno.translators.lsdyna.cards import Card, heading
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.lsdyna.unread import keep, resolved_line
from zrno.translators.model import Contact

CONTROL = Registry()

# Fields of the first card that the model's `Analysis` holds: attribute -> place, and the power of a time it has.
ANALYSIS: dict[str, dict[str, tuple[int, int]]] = {
    "CONTROL_TERMINATION": {"end_time": (0, 1)},
    "CONTROL_TIMESTEP": {"initial_step": (0, 1), "step_factor": (1, 0)},
    "DATABASE_BINARY_D3PLOT": {"output_interval": (0, 1)},
}
_OTHER_CONTACTS = ("INTERIOR", "ENTITY", "GEBOD", "1D", "2D", "COUPLING", "GUIDED", "RIGID", "ADD", "EXCLUDE", "AUTO")
TARGETS = {0: "segment set", 1: "shell set", 2: "part set", 3: "part", 4: "node set", 5: "all", 6: "other parts"}


@CONTROL("CONTROL_TERMINATION", "CONTROL_TIMESTEP", "DATABASE_BINARY_D3PLOT")
def _analysis(deck: Deck, block: Block, options: list[str]) -> bool:
    if options:
        return False
    rows = block.rows().tolist()
    card = Card(deck, block, rows[0] if rows else None, "v/a*8")
    values = Card(deck, block, rows[0] if rows else None, "v*2")
    analysis = deck.model.analysis
    for name, (place, power) in ANALYSIS[block.name].items():
        text = card.texts["v"][place][1]
        value = float(values.value("v", place)) if text else 0.0
        value *= deck.frame.time**power
        setattr(analysis, name, value or None)
    # the rest of the cards is kept: a deck that is written again has it with the model's values put in
    kept: dict[str, Any] = deck.model.native.setdefault("lsdyna_control", {})
    kept[block.name] = (block.widths.value, [resolved_line(deck, block, row) for row in rows])
    if block.name == "CONTROL_TERMINATION":
        analysis.kind = analysis.kind or "explicit"
    return True


@CONTROL("CONTROL_IMPLICIT_GENERAL", "CONTROL_IMPLICIT_DYNAMICS", "CONTROL_IMPLICIT_EIGENVALUE")
def _implicit(deck: Deck, block: Block, options: list[str]) -> bool:
    rows = block.rows().tolist()
    if not options and rows:
        first = Card(deck, block, rows[0], "flag/i dt0")
        analysis = deck.model.analysis
        kind = block.name.split("_")[2]
        if kind == "EIGENVALUE" and first["flag"]:
            analysis.kind = "eigenvalues"
        elif kind == "DYNAMICS" and first["flag"] and analysis.kind != "eigenvalues":
            analysis.kind = "dynamic"
        elif kind == "GENERAL" and first["flag"]:
            if analysis.kind in ("", "explicit"):
                analysis.kind = "static"
            analysis.initial_step = first["dt0"] or analysis.initial_step
    keep(deck, block, quiet=True)  # as text: the model has words for the kind of analysis alone
    return True


@CONTROL("CONTACT")
def _contact(deck: Deck, block: Block, options: list[str]) -> bool:
    named = take(options, "ID", "TITLE")
    if not options or options[0] in _OTHER_CONTACTS or "MPP" in options or options[-1] == "SMOOTH":
        return False
    rows = block.rows()
    places = rows.tolist()
    number, name = heading(deck, block, places, named)
    if not places:
        return False
    first = Card(deck, block, places[0], "a/i b/i atyp/i btyp/i abox/i bbox/i apr/i bpr/i")
    second = Card(deck, block, places[1] if len(places) > 1 else None, "fs fd dc vc vdc penchk/i bt dt")
    sides = []
    for side in "ab":
        kind = TARGETS.get(first[f"{side}typ"], "other")
        if kind == "segment set" and first[side] == 0:
            kind = "all"
        offset = "part" if kind == "part" else "set"
        sides.append((kind, first.id(side, offset)))
    static, kinetic = (float(second[name]) if abs(second[name]) < 1e10 else 0.0 for name in ("fs", "fd"))
    if not deck.frame.plain:
        deck.count("*INCLUDE_TRANSFORM: {n} contacts' boxes and further cards are as in their file", 1, block)
    contact = Contact("_".join(options), sides[0], sides[1], static, kinetic, number, name, source=deck.source(block))
    contact.native = {
        "lsdyna": {
            "first": [first[name] for name in ("abox", "bbox", "apr", "bpr")],
            "second": [second.value(name) if second.given(name) else None for name in second.layout.sizes],
            "more": [resolved_line(deck, block, row) for row in places[2:]],
            "widths": block.widths.value,
            "types": [first["atyp"], first["btyp"]],
        }
    }
    deck.model.contacts.append(contact)
    return True
