"""Fields of cards: fixed columns, long or ten-column ids, or commas; one card at a time, or a table of many at once.

A layout is a text: "eid/i8 pid/i8 mass/16 note/a20 x*3" - name, kind (i integer, a text, else a real), columns (10
unless said) and how many of it there are. Large tables go through the jitted kernels of `scan`; rows with commas or
parameters, and cells that are odd, one by one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.lsdyna.bulk import in_threads
from zrno.translators.lsdyna.expressions import BadExpression
from zrno.translators.lsdyna.lexer import Block, Widths
from zrno.translators.lsdyna.parameters import is_reference
from zrno.translators.text import Ints, parse_real

if TYPE_CHECKING:
    from zrno.translators.lsdyna.deck import Deck

_FEW = 100_000  # numbers: below this Python parses them before the jitted kernels are loaded
_ROWS_AT_A_TIME = 25_000
_MANY = 1000  # rows that take care: as many are looked at for commas all at once
_NONE = np.empty(0, np.int64)
_LARGEST = 2**62
_EXACT = 2**53  # integers that a double holds
_ITEM = re.compile(r"(\w+)(?:/([ia]?)(\d*))?(?:\*(\d+))?$")
_INTEGER = re.compile(r"[+-]?\d{1,18}$")
# A real with one digit before its point and two of an exponent, as %E writes it; or a number between blanks.
_WIDE = re.compile(r"[+-]?\d\.\d+[EeDd][+-]\d\d(?=[\s+-]|\d\.|$)|(?<=\s)[+-]?\d+(?=\s|$)")


@dataclass(frozen=True, slots=True)
class Field:
    """A field of a layout: its name, its place among those of that name, kind "i", "a" or "e", columns (from 0)."""

    name: str
    index: int
    kind: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Layout:
    """The fields of a card in one width. sizes: how many there are of each name."""

    fields: tuple[Field, ...]
    sizes: dict[str, int]
    kinds: dict[str, str]


@lru_cache(maxsize=512)
def layout(spec: str, widths: Widths) -> Layout:
    """The columns that a layout's text names."""
    fields: list[Field] = []
    sizes: dict[str, int] = {}
    kinds: dict[str, str] = {}
    column = 0
    for item in spec.split():
        match = _ITEM.match(item)
        if match is None:
            raise ValueError(f"not a layout: {item}")
        name, kind, width, count = match[1], match[2] or "e", widths.of(int(match[3] or 10)), int(match[4] or 1)
        sizes[name], kinds[name] = count, kind
        for index in range(count):
            fields.append(Field(name, index, kind, column, column + width))
            column += width
    return Layout(tuple(fields), sizes, kinds)


def _is_value(text: str) -> bool:
    """Whether a text may be a number or stand for one."""
    return is_reference(text) or parse_real(text) is not None


class Card:
    """One card: its fields by name, blank ones as 0 or ""."""

    def __init__(self, deck: Deck, block: Block, row: int | None, spec: str) -> None:
        self.deck, self.block = deck, block
        self.row = block.line if row is None else row
        self.layout = layout(spec, block.widths)
        self.texts: dict[str, list[tuple[int, str]]] = {name: [] for name in self.layout.sizes}
        text = "" if row is None else block.file.text(row)
        if "," in text:
            column = 0
            pieces = text.split(",")
            for i, field in enumerate(self.layout.fields):
                piece = pieces[i] if i < len(pieces) else ""
                self.texts[field.name].append((column, piece.strip()))
                column += len(piece) + 1
        else:
            for field in self.layout.fields:
                self.texts[field.name].append((field.start, text[field.start : field.end].strip()))
            if text and not all(self._sound(f) for f in self.layout.fields):
                self._from_slipped(text)

    def __getitem__(self, name: str) -> Any:
        return self.value(name, 0)

    def value(self, name: str, index: int = 0, default: Any = None) -> Any:
        """A field's value: float, int or str by its kind; `default` (else 0 or "") where it is blank."""
        kind = self.layout.kinds[name]
        text = self.texts[name][index][1]
        if not text:
            return default if default is not None else {"i": 0, "a": "", "e": 0.0}[kind]
        if kind == "a" and not is_reference(text):
            return text
        if is_reference(text):
            try:
                worth = self.deck.parameters.value(text)
            except BadExpression as error:
                if self.deck.partial:
                    self.deck.lacks_parameter(text)
                else:
                    self.fault(name, str(error), "a parameter that is defined before", index)
                return {"i": 0, "a": "", "e": 0.0}[kind]
            if kind == "a":
                return str(worth)
            if isinstance(worth, str):
                return self._number(name, index, worth, kind)
            return self._whole(name, index, float(worth), text) if kind == "i" and isinstance(worth, float) else worth
        return self._number(name, index, text, kind)

    def values(self, name: str) -> list[Any]:
        """All fields of a name."""
        return [self.value(name, i) for i in range(self.layout.sizes[name])]

    def given(self, name: str) -> bool:
        """Whether a field is not blank."""
        return bool(self.texts[name][0][1])

    def real(self, name: str, default: float = 0.0) -> float:
        """A real, `default` where it is blank."""
        return float(self.value(name, 0, default))

    def id(self, name: str, kind: str) -> int:
        """A number of an item, moved by what its file's include adds to numbers of this kind; 0 stays 0."""
        number = int(self[name])
        return self.deck.frame.moved(number, kind)

    def fault(self, name: str, message: str, expected: str = "", index: int = 0) -> None:
        """Note a fault in a field."""
        column, text = self.texts[name][index]
        raw = self.block.file.text(self.row)
        column = max(raw.find(text, column), column) if text else column
        self.deck.fault(self.block.file, self.row, column, message, text or "blank", expected)

    def blank(self) -> bool:
        """Whether no field is given."""
        return not any(text for texts in self.texts.values() for _, text in texts)

    def _sound(self, field: Field) -> bool:
        """Whether a field's text can be what its kind says."""
        text = self.texts[field.name][field.index][1]
        if not text or field.kind == "a":
            return True
        if is_reference(text):
            name = text.lstrip("-&").lower()
            return text[0] in "<-" or name in self.deck.parameters.names
        return bool(_INTEGER.match(text)) or parse_real(text) is not None

    def _from_slipped(self, text: str) -> None:
        """Fields of a row whose texts do not stand in their columns: by blanks, or, where reals that are too wide for
        their columns follow each other without any, by the form of those. Only where that explains all of the row."""
        fields = self.layout.fields
        if any(f.kind == "a" for f in fields):
            return
        places = [(m.start(), m[0]) for m in re.finditer(r"\S+", text)]
        if not any(start < f.end < start + len(t) for start, t in places for f in fields):
            return
        whole = len(places)
        if len(places) > len(fields) or not all(_is_value(t) for _, t in places):
            ids = [f for f in fields if f.kind == "i"]
            count = next((i for i, f in enumerate(fields) if f.kind != "i"), len(fields))
            start = fields[count].start if count < len(fields) else len(text)
            found = [(start + m.start(), m[0]) for m in _WIDE.finditer(text[start:])]
            rest = _WIDE.sub("", text[start:])
            head = [self.texts[f.name][f.index] for f in fields[:count]]
            places = [*head, *found]
            whole = len(found)
            if rest.strip() or not ids or not all(_is_value(t) for _, t in head if t):
                return
        if len(places) > len(fields) or whole < 2:
            return
        self.deck.count("{n} rows have texts across the borders of their columns: they are told apart by blanks", 1,
                        self.block, self.row)  # fmt: skip
        self.texts = {name: [] for name in self.layout.sizes}
        for i, field in enumerate(fields):
            self.texts[field.name].append(places[i] if i < len(places) else (field.start, ""))

    def _number(self, name: str, index: int, text: str, kind: str) -> Any:
        if kind == "i" and _INTEGER.match(text):
            return int(text)
        number = parse_real(text)
        if number is None or not np.isfinite(number):
            self.fault(name, f"{name} is not {'an integer' if kind == 'i' else 'a number'}", "", index)
            return 0 if kind == "i" else 0.0
        return self._whole(name, index, number, text) if kind == "i" else number

    def _whole(self, name: str, index: int, number: float, text: str) -> int:
        if number != int(number) or abs(number) > _LARGEST:
            self.fault(name, f"{name} is not an integer", "a whole number", index)
            return 0
        return int(number)


def heading(deck: Deck, block: Block, rows: list[int], named: bool) -> tuple[int, str]:
    """The number and the text of a card that _ID puts before another; it is taken from the rows."""
    if not named or not rows:
        return 0, ""
    card = Card(deck, block, rows.pop(0), "id/i")
    width = block.widths.of(10)
    return int(card["id"]), block.file.words(card.row)[width:].strip()


class Table:
    """Many cards of one layout. values: an array a name, (n,), or (n, k) where the layout has k of it."""

    def __init__(self, deck: Deck, block: Block, rows: Ints, spec: str) -> None:
        self.deck, self.block, self.rows, self.spec = deck, block, rows, spec
        self.layout = layout(spec, block.widths)
        self.values: dict[str, NDArray[Any]] = {}
        for name, size in self.layout.sizes.items():
            shape = (len(rows),) if size == 1 else (len(rows), size)
            kind = self.layout.kinds[name]
            self.values[name] = np.zeros(shape, np.int64 if kind == "i" else np.float64)
        if len(rows) * len(self.layout.fields) < _FEW:
            odd = np.arange(len(rows))
        else:
            odd = self._fixed()
            if len(odd) > _MANY:
                odd = self._free(odd)
        for i in odd.tolist():
            self._one(i)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.values[name]

    def __len__(self) -> int:
        return len(self.rows)

    def ids(self, name: str, kind: str) -> Ints:
        """Numbers of items, moved as `Card.id` does."""
        return self.deck.frame.moved_all(self.values[name], kind)

    def card(self, i: int) -> Card:
        """One of the cards."""
        return Card(self.deck, self.block, int(self.rows[i]), self.spec)

    def fault(self, i: int, name: str, message: str, expected: str = "", index: int = 0) -> None:
        """Note a fault in a field of card i."""
        self.card(i).fault(name, message, expected, index)

    def without_blank(self, name: str) -> Table:
        """The table without the rows that are blank, which are looked for where a field is 0."""
        zero = np.flatnonzero(self.values[name] == 0)
        blank = [i for i in zero.tolist() if not self.block.file.text(int(self.rows[i])).strip()]
        if blank:
            self.rows = np.delete(self.rows, blank)
            self.values = {key: np.delete(values, blank, axis=0) for key, values in self.values.items()}
        return self

    def _fixed(self) -> Ints:
        """All rows as fixed columns; returns those with a cell that takes care: commas, parameters, odd numbers."""
        from zrno.translators import scan

        file = self.block.file
        numeric = [f for f in self.layout.fields if f.kind != "a"]
        columns = [(f.start, f.end, -1 if f.kind == "i" else 0) for f in numeric]

        def some(start: int) -> Ints:
            lines = self.rows[start : start + _ROWS_AT_A_TIME]
            arrays, care = scan.fixed(file.bytes, file.starts[lines], file.ends[lines], columns)
            self._put(numeric, arrays, slice(start, start + len(lines)))
            return _NONE if care is None else start + np.flatnonzero(care.any(axis=0))

        return np.concatenate([_NONE, *in_threads(some, range(0, len(self.rows), _ROWS_AT_A_TIME))])

    def _free(self, which: Ints) -> Ints:
        """Rows whose fields commas separate; returns those among `which` that take care, or have no comma."""
        from zrno.translators import scan

        file, fields = self.block.file, self.layout.fields
        if any(f.kind == "a" for f in fields):
            return which
        whole = np.array([f.kind == "i" for f in fields])

        def some(start: int) -> Ints:
            part = which[start : start + _ROWS_AT_A_TIME]
            lines = self.rows[part]
            grid, count, care = scan.free(
                file.bytes, file.starts[lines], file.ends[lines], len(fields), only_commas=True
            )
            numbers = np.where(np.isfinite(grid), grid, 0.5)
            odd = (whole & ((numbers != np.rint(numbers)) | (abs(numbers) > _EXACT))).any(axis=1) | (count < 2)
            if care is not None:
                odd |= care
            grid[odd] = 0.0
            self._put(list(fields), [c.astype(np.int64) if w else c for c, w in zip(grid.T, whole, strict=True)], part)
            rest: Ints = part[odd]
            return rest

        return np.concatenate([_NONE, *in_threads(some, range(0, len(which), _ROWS_AT_A_TIME))])

    def _put(self, fields: list[Field], arrays: list[NDArray[Any]], place: Any) -> None:
        for field, array in zip(fields, arrays, strict=True):
            target = self.values[field.name]
            if self.layout.sizes[field.name] == 1:
                target[place] = array
            else:
                target[place, field.index] = array

    def _one(self, i: int) -> None:
        card = self.card(i)
        for field in self.layout.fields:
            if field.kind == "a":
                continue
            target = self.values[field.name]
            if self.layout.sizes[field.name] == 1:
                target[i] = card.value(field.name)
            else:
                target[i, field.index] = card.value(field.name, field.index)
