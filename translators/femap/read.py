"""Reader of FEMAP neutral files: goes through the blocks, then puts the model together.

Sources: FEMAP neutral file format 4.41 (blocks 100, 402, 403, 404), and the readers of FemCon and neu2fstr.
"""

from __future__ import annotations

import re
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from zrno.translators.elements import TABLE
from zrno.translators.femap import materials, properties, tables
from zrno.translators.femap.constraints import ConstraintSets
from zrno.translators.femap.cursor import Cursor
from zrno.translators.femap.framing import Block, Broken, Lines, blocks
from zrno.translators.femap.groups import Groups
from zrno.translators.femap.loads import LoadSets
from zrno.translators.femap.mesh import Elements, Nodes
from zrno.translators.model import Model, Part
from zrno.translators.text import read_bytes

_VERSION = re.compile(rb"\s*(\d{1,4})(?:\.(\d{0,9}))?")
_RESULTS = (450, 451, 1051)


@dataclass(slots=True)
class _Parsed:
    """What the blocks say, before it is put together."""

    version: tuple[int, int] = (4, 41)
    nodes: Nodes = field(default_factory=Nodes)
    elements: Elements = field(default_factory=Elements)
    materials: list[materials.Record] = field(default_factory=list)
    constraints: ConstraintSets = field(default_factory=ConstraintSets)
    loads: LoadSets = field(default_factory=LoadSets)
    groups: Groups = field(default_factory=Groups)
    other: Counter[int] = field(default_factory=Counter)
    first: dict[int, int] = field(default_factory=dict)


def read(path: Path | str) -> Model:
    """Read a model. Raises InputError with the places of what is wrong."""
    lines = Lines(path, read_bytes(path))
    model = Model(title=Path(path).stem, format="femap")
    parsed = _Parsed()
    for block in blocks(lines):
        with suppress(Broken):  # what is wrong with a block is noted: the others are looked at too
            _read_block(Cursor(lines, block), block, parsed, model)
            if not block.whole(lines):
                _end_inside(block, parsed, model, lines)
    if not len(parsed.nodes.ids) and not lines.faults.found:
        lines.fault(len(lines), 1, "a mesh without nodes", expected="block 403")
    lines.faults.stop()
    _assemble(parsed, model, lines)
    return model


def _read_block(cursor: Cursor, block: Block, parsed: _Parsed, model: Model) -> None:
    match block.number:
        case 100:
            model.title = cursor.title() or model.title
            _version(cursor, parsed, model)
        case 401:
            parsed.materials += materials.read_401(cursor, parsed.version)
        case 601:
            parsed.materials += materials.read_601(cursor)
        case 402:
            properties.read(cursor, model, parsed.version)
        case 403:
            parsed.nodes.read(cursor)
        case 404:
            parsed.elements.read(cursor)
        case 405:
            tables.read_systems(cursor, model)
        case 406 | 506:
            parsed.constraints.read(cursor)
        case 407 | 507:
            parsed.loads.read(cursor)
        case 408:
            parsed.groups.read(cursor, model)
        case 420:
            tables.read_functions(cursor, model)
        case other:
            parsed.other[other] += 1
            parsed.first.setdefault(other, block.head + 1)


def _end_inside(block: Block, parsed: _Parsed, model: Model, lines: Lines) -> None:
    """A file that ends inside a block: runs that were broken off do, in their results."""
    said = f"the file ends inside block {block.number}"
    if block.number in parsed.other:
        model.warnings.append(f"{lines.faults.path}:{len(lines) + 1}: {said}")
    else:
        lines.fault(len(lines), 1, said, expected="a line -1")


def _version(cursor: Cursor, parsed: _Parsed, model: Model) -> None:
    """The version, as two numbers: 10.3 is later than 9.31, and 4.41 earlier than 4.5."""
    word = cursor.words("the version of the format")[0]
    match = _VERSION.fullmatch(word)
    if match is None:
        cursor.lines.fail(cursor.at - 1, "not a version", word, "4.41 or the like")
    model.version = word.decode("latin-1")
    minor = (match[2] or b"0").decode()
    parsed.version = (int(match[1]), int(minor[0]))


def _assemble(parsed: _Parsed, model: Model, lines: Lines) -> None:
    path = lines.faults.path
    nodes = parsed.nodes.fill(model, lines)
    elements = parsed.elements.fill(model, lines, nodes)
    _parts(model, path)
    materials.fill(parsed.materials, model)
    parsed.constraints.fill(model, nodes, parsed.nodes.system)
    parsed.loads.fill(model, nodes, elements)
    parsed.groups.fill(model, nodes, elements)
    for number, count in parsed.other.items():
        what = "results" if number in _RESULTS else "not known here"
        model.warnings.append(f"{path}:{parsed.first[number]}: {count} block(s) {number} are not read ({what})")


def _parts(model: Model, path: str) -> None:
    """Dimensions of parts; parts that no property makes; the dimension of the space."""
    without = 0
    for block in model.blocks:
        dimension = TABLE[block.kind].dimension
        for number in np.unique(block.part).tolist():
            if number not in model.parts:
                model.parts[number] = Part(number)
                without += 1
            part = model.parts[number]
            part.dimension = max(part.dimension or 0, dimension)
    if without:
        model.warnings.append(f"{path}: {without} properties of elements are not defined")
    top = max((TABLE[block.kind].dimension for block in model.blocks), default=3)
    flat = bool((model.xyz[:, 2] == model.xyz[0, 2]).all())
    shells = any(block.family == "shell" for block in model.blocks)
    model.dimension = top if flat and top in (1, 2) and not shells else 3
