"""Reader of LS-DYNA keyword decks: goes through the keywords of a deck and of all that it includes, in their order."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from zrno.translators.lsdyna import assemble
from zrno.translators.lsdyna.cards import Card
from zrno.translators.lsdyna.conditions import CONDITIONS
from zrno.translators.lsdyna.control import CONTROL
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.expressions import BadExpression
from zrno.translators.lsdyna.frames import Frame
from zrno.translators.lsdyna.includes import Includes, shown, transformed
from zrno.translators.lsdyna.keywords import Registry
from zrno.translators.lsdyna.lexer import Block, File, Widths
from zrno.translators.lsdyna.loads import LOADS
from zrno.translators.lsdyna.materials import MATERIALS
from zrno.translators.lsdyna.mesh import MESH
from zrno.translators.lsdyna.parameters import is_reference
from zrno.translators.lsdyna.parts import PARTS
from zrno.translators.lsdyna.placing import PLACING
from zrno.translators.lsdyna.sets import SETS, resolve_sets
from zrno.translators.lsdyna.unread import keep
from zrno.translators.model import Model
from zrno.translators.text import Fault, InputError

_HANDLERS = Registry()
for _registry in (MESH, PLACING, PARTS, MATERIALS, SETS, CONDITIONS, LOADS, CONTROL):
    _HANDLERS.update(_registry)
_PAIR = re.compile(r"(?:^|\s)([RrIi])\s*([A-Za-z_]\w*)\s+(\S+)")
_SAY_NOTHING = ("KEYWORD", "COMMENT", "KEYWORD_ID", "KEYWORD_JOBID")


def read(path: Path | str, *, allow_outside: bool = False, partial: bool = False) -> Model:
    """Read a deck and what it includes.

    allow_outside: includes may leave the folder of the deck. partial: the deck is looked at as it is; includes and
    nodes that are not there are no faults, and stand in `Model.incomplete`. (A file without any node is a piece of a
    deck in either case.) Raises InputError with every fault, up to 20.
    """
    with np.errstate(all="ignore"):  # what overflows is looked for where it matters, and a fault there
        return _read(path, allow_outside=allow_outside, partial=partial)


def _read(path: Path | str, *, allow_outside: bool, partial: bool) -> Model:
    model = Model(format="lsdyna", version="keyword")
    deck = Deck(model, partial=partial)
    reader = _Reader(deck, Path(path), allow_outside)
    reader.file(Path(path), str(path), Widths.STANDARD)
    assemble.nodes(deck)
    if partial and deck.faults:
        deck.stop()
    assemble.elements(deck)
    resolve_sets(deck)
    for act in deck.late:
        act()
    deck.say_counts()
    deck.stop()
    return model


class _Reader:
    """Files within files."""

    def __init__(self, deck: Deck, path: Path, outside: bool) -> None:
        self.deck = deck
        self.includes = Includes(path.parent, outside)

    def file(self, path: Path, name: str, widths: Widths) -> None:
        """Read a file; its keywords are handled as they come."""
        file = File(name, path)
        if file.binary:
            raise InputError([Fault(name, 1, 1, "a binary file", expected="a keyword deck")])
        if not file.has_keywords() and not self.includes.open:
            raise InputError([Fault(name, 1, 1, "no keyword in the file", expected="an LS-DYNA deck (*KEYWORD, ...)")])
        before = file.data_before_keywords()
        if before is not None:
            self.deck.model.warnings.append(f"{name}:{before + 1}: text before the first keyword is not read")
        self.includes.open.append(path)
        self.deck.parameters.enter()
        try:
            for block in file.keywords(widths):
                self._keyword(block)
        finally:
            self.deck.parameters.leave()
            self.includes.open.pop()

    def _keyword(self, block: Block) -> None:
        deck, name = self.deck, block.name
        if name in _SAY_NOTHING:
            return
        match name.split("_"):
            case ["INCLUDE"]:
                for row, text in self.includes.names(block):
                    self._include(block, row, text, deck.frame)
            case ["INCLUDE", "TRANSFORM"]:
                found = transformed(deck, block)
                if found is not None:
                    self._include(block, *found)
            case ["INCLUDE", "PATH", *more] if more in ([], ["RELATIVE"]):
                self.includes.add_folders(deck, block, relative=bool(more))
            case ["PARAMETER", *options]:
                _parameter(deck, block, options)
            case ["TITLE"]:
                rows = block.rows(blank=False)
                if len(rows) and not deck.model.title:
                    deck.model.title = block.file.words(int(rows[0])).strip()
            case ["CASE", *_]:
                deck.warn(block, "*CASE: the cases of a deck are not told apart; what stands in them is read once")
            case _:
                handler = _HANDLERS.find(name)
                if handler is None or not handler[0](deck, block, list(handler[1])):
                    keep(deck, block)

    def _include(self, block: Block, row: int, name: str, frame: Frame) -> None:
        deck = self.deck
        path = self.includes.find(deck, block, row, name)
        if path is None:
            return
        before, deck.frame = deck.frame, frame
        said = shown(path)
        deck.model.includes.append(said)
        try:
            self.file(path, said, block.widths)
        finally:
            deck.frame = before


def _parameter(deck: Deck, block: Block, options: list[str]) -> None:
    """*PARAMETER: pairs of name and value, four a line; _EXPRESSION: a name, and its expression to the end of the line
    and on those lines behind it that name nothing."""
    rows = block.rows(blank=False).tolist()
    if options == ["DUPLICATION"]:
        for row in rows[:1]:
            deck.parameters.duplication = Card(deck, block, row, "dflag/i")["dflag"] or 1
        return
    local = "LOCAL" in options
    if "EXPRESSION" in options:
        found: list[tuple[int, str, str]] = []
        width = block.widths.of(10)
        for row in rows:
            text = block.file.text(row)
            name, _, value = text.partition(",") if "," in text[: width + 1] else (text[:width], "", text[width:])
            if not name.strip() and found:
                found[-1] = (*found[-1][:2], found[-1][2] + " " + value)
            else:
                found.append((row, name, value))
        for row, name, value in found:
            _define(deck, block, row, name, value, local=local, expression=True)
        return
    per_line = 1 if "TYPE" in options else 4
    for row in rows:
        text = block.file.text(row)
        card = Card(deck, block, row, "pair/a*8")
        pieces = [piece for _, piece in card.texts["pair"]]
        pairs = [pair for pair in zip(pieces[::2], pieces[1::2], strict=True) if pair[0]][:per_line]
        if any(not _one_word(name[1:]) or not _one_word(value) for name, value in pairs if name[0] not in "Cc"):
            # across the borders of the columns: letter, name, value between blanks
            pairs = [(kind + name, value) for kind, name, value in _PAIR.findall(text)] or pairs
        for name, value in pairs:
            _define(deck, block, row, name, value, local=local, expression=False)


def _one_word(text: str) -> bool:
    return len(text.split()) == 1 or is_reference(text)


def _define(deck: Deck, block: Block, row: int, name: str, value: str, *, local: bool, expression: bool) -> None:
    try:
        remark = deck.parameters.define(name, value, local=local, expression=expression)
    except BadExpression as error:
        if deck.partial and "not defined" in str(error):
            deck.lacks_parameter(name)
            return
        text = block.file.text(row)
        column = max(text.find(value.strip() or name.strip()), 0)
        deck.fault(block.file, row, column, f"parameter {name.strip()[1:].strip()}: {error}", value.strip(),
                   "a number, or an expression of parameters that are defined before")  # fmt: skip
    else:
        if remark:
            deck.warn(block, remark, row)
