"""Properties (block 402): parts with their sections, and back.

Places among a property's values: plates and plane elements thickness; rods area, torsion; bars and beams area, I1, I2,
I12, torsion. FEMAP's I1 is of bending in plane 1, about the element's z axis: `izz`.
"""

from __future__ import annotations

from typing import Any

from zrno.translators.femap.cursor import Cursor
from zrno.translators.femap.topology import TYPES, UNKNOWN
from zrno.translators.model import Model, Part, Section

_THICKNESS = ("thickness",)
_BEAM = ("area", "izz", "iyy", "iyz", "j")
_OUTLINE_VERSION, _SECOND_OUTLINE_VERSION = (6, 0), (8, 1)
_SHORTEST_HEAD = 5  # numbers of a property's first line
VALUE_COUNT = 75  # written where there are values


def value_names(number: int) -> tuple[str, ...]:
    """Names of a property type's first values, as `Section.parameters` has them."""
    if number in (1, 4):
        return ("area", "j")
    if number in (2, 5, 8, 37):
        return _BEAM
    return _THICKNESS if number in range(11, 25) else ()


def read(cursor: Cursor, model: Model, version: tuple[int, int]) -> None:
    """A block of properties: each becomes a part and a section of its number."""
    odd = 0
    while not cursor.done:
        if len(cursor.lines.fields(cursor.at)) < _SHORTEST_HEAD or not _is_head(cursor):
            odd += 1
            cursor.skip(1, "")
            continue
        source = cursor.source
        number, _, material, kind, layer, system = cursor.integers(5, "a property's number", 1, 6)
        title = cursor.title()
        flags = cursor.integers(1, "a property's flags", most=4)
        laminate = cursor.wholes(cursor.count("layers"), "layers")
        values = cursor.values(cursor.count("values"), "values")
        if version >= _OUTLINE_VERSION:
            cursor.skip(cursor.count("outline points"), "outline points")
        if version >= _SECOND_OUTLINE_VERSION and not cursor.done and len(cursor.lines.fields(cursor.at)) == 1:
            cursor.skip(cursor.count("outline points"), "outline points")
        if number in model.parts:
            cursor.lines.fail(source.line - 1, "a property's number stands twice", str(number))
        known = TYPES.get(kind, UNKNOWN)
        native: dict[str, Any] = {"type": kind}
        names = value_names(kind)
        left = {i: value for i, value in enumerate(values) if value and i >= len(names)}
        for key, item, default in (("flags", flags, [0, 0, 0, 0]), ("laminate", [m for m in laminate if m], []),
                                   ("values", left, {}), ("system", system, 0),
                                   ("layer", layer, 1)):  # fmt: skip
            if item != default:
                native[key] = item
        section = Section(number, title, known.family, plane=known.plane, native=native, source=source)
        section.parameters = {name: values[i] for i, name in enumerate(names) if i < len(values) and values[i]}
        model.sections[number] = section
        model.parts[number] = Part(number, title, material or None, section=number, source=source)
    if odd:
        model.warnings.append(f"{cursor.lines.faults.path}: {odd} line(s) of block 402 belong to no property")


def _is_head(cursor: Cursor) -> bool:
    """Whether the next line can be a property's first: its number is positive, or no number at all (a fault)."""
    first = cursor.lines.fields(cursor.at)[0][1]
    return not first.lstrip(b"+-").isdigit() or int(first) > 0
