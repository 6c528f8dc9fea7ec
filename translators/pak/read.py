"""Reader of PAK's decks, by the cards' positions: headings are comments."""

from __future__ import annotations

import re
from pathlib import Path

from zrno.translators.model import Model
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.control import analysis_of, read_control
from zrno.translators.pak.groups import Groups
from zrno.translators.pak.loads import Loads, read_functions
from zrno.translators.pak.materials import read_materials
from zrno.translators.pak.nodes import read_initial, read_nodes
from zrno.translators.text import Cards, Fault, InputError, read_bytes

_HEAD = 4096  # bytes in which the headings of another program's deck stand
_OTHER = re.compile(rb"^C.*\b(NGET|INTEB|EPSTR)\b", re.MULTILINE)  # fields of the cards 3 and 4 of PAK-F and PAK-KTM


def read(path: Path | str) -> Model:
    """Read a deck. Raises InputError with every fault, up to 20."""
    data = read_bytes(path)
    if b"\0" in data:
        raise InputError([Fault(str(path), 1, 1, "a binary file", expected="a text deck (.dat)")])
    if other := _OTHER.search(data[:_HEAD]):
        line = data.count(b"\n", 0, other.start()) + 1
        said = other[0].decode("latin-1").strip()[:40]
        raise InputError([Fault(str(path), line, 1, "a deck of PAK-F or PAK-KTM (fluid, transport), which is not read",
                                said, "a deck of PAKS")])  # fmt: skip
    cards = Cards(path, data, comments=b"Cc", second=b" *-")
    model = Model(format="pak")
    model.title = cards.card(layouts.TITLE, "the title card").text("NASLOV")
    control, basics = read_control(cards)
    model.fem_control = control
    model.analysis = analysis_of(control)
    numbering = read_nodes(cards, model, control, basics["NP"], len(data))
    read_initial(cards, model, control, numbering, len(data))
    materials = read_materials(cards, model, basics["NMATM"] or 1)
    groups = Groups(cards, model, control, numbering, materials, len(data))
    groups.read(basics["NGELEM"] or 1)
    read_functions(cards, model)
    Loads(cards, model, control, numbering, linear=groups.linear, size=len(data)).read()
    end = cards.card(layouts.END, "card 16, STOP")
    end.check("STOP", end.text("STOP") == "STOP", "the deck does not end here", "STOP")
    cards.faults.stop()
    if cards.left and any(
        cards.probe(layouts.TITLE, cards.left).whole(i).strip() for i in range(min(cards.left, 1000))
    ):
        model.warnings.append(f"{path}:{cards.next_line}: {cards.left} lines after STOP are not read")
    return model
