"""$Elements of a .msh file, versions 2, 4.0 and 4.1.

In version 2 a row is: id, type, count of tags, tags (physical group, entity, count of partitions, partitions), nodes;
as bytes, rows of one type and count of tags stand in blocks under a heading: type, count of rows, count of tags.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import BY_GMSH, Element
from zrno.translators.gmsh.mesh import NO_GROUP, Mesh, Run
from zrno.translators.gmsh.numbers import LARGEST_INT, Numbers
from zrno.translators.model import Ints

_PYRAMID14 = 14
_LONG_RUN = 16  # rows alike from which on it pays to look for their end by doubling
_STRIDE = 1 << 16  # numbers walked through at a time where rows differ


def elements_2(mesh: Mesh, numbers: Numbers, count: int) -> None:
    """$Elements of version 2 behind its count."""
    values = numbers.rest()
    starts = _starts(numbers, values, count)
    if numbers.binary:
        kinds, sizes, tags = (values[starts + i].astype(np.int64) for i in range(3))
        widths = 1 + tags + _node_counts(kinds)
        block = np.repeat(np.arange(len(starts)), sizes)
        inside = np.arange(len(block)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        rows = starts[block] + 3 + inside * widths[block]
        kinds, tags, first_tag = kinds[block], tags[block], rows + 1
    else:
        rows = starts
        kinds, tags, first_tag = values[starts + 1], values[starts + 2], starts + 3
    if len(rows) != count:
        numbers.fail(f"a block of elements goes past the count {count}", f"{len(rows)} as the count of $Elements")
    some, first = np.unique(kinds, return_index=True)
    for kind in some[np.argsort(first)].tolist():
        element = BY_GMSH[kind]
        which = slice(None) if len(some) == 1 else np.flatnonzero(kinds == kind)
        at, n = first_tag[which], tags[which]
        groups = np.where(n > 0, np.abs(values[at].astype(np.int64)), NO_GROUP)
        entities = np.where(n > 1, values[at + np.minimum(n, 1)], NO_GROUP)
        nodes = values[(at + n)[:, None] + np.arange(element.nodes)].astype(np.int64)
        ids = values[rows[which]].astype(np.int64)
        if (groups > LARGEST_INT).any():
            numbers.fail("a physical group's number is too large", f"at most {LARGEST_INT}")
        mesh.runs.append(_without_repeats(Run(element, ids, nodes, groups, entities.astype(np.int64))))


def _without_repeats(run: Run) -> Run:
    """gmsh writes an element of several groups once for each, one row behind the other: it is one element."""
    same = (run.nodes[1:] == run.nodes[:-1]).all(axis=1) & (run.entities[1:] == run.entities[:-1])
    same &= run.groups[1:] != run.groups[:-1]
    if not same.any():
        return run
    keep = np.concatenate(([True], ~same))
    owner = np.cumsum(keep) - 1
    again = np.flatnonzero(~keep)
    order = again[np.argsort(run.groups[again], kind="stable")]
    groups, first = np.unique(run.groups[order], return_index=True)
    further = [(int(g), owner[rows]) for g, rows in zip(groups, np.split(order, first[1:]), strict=True)]
    return Run(run.element, run.ids[keep], run.nodes[keep], run.groups[keep], run.entities[keep], further)


def elements_4(mesh: Mesh, numbers: Numbers) -> None:
    """$Elements of version 4: blocks of one entity and one type."""
    old = numbers.encoding.version == "4.0"
    blocks, total = numbers.sizes(2 if old else 4).tolist()[:2]
    found: dict[int, tuple[list[Ints], list[int]]] = {}
    for _ in range(blocks):
        first, second, kind = numbers.ints(3).tolist()
        dimension, entity = (second, first) if old else (first, second)
        count = int(numbers.sizes(1)[0])
        element = _element(kind, numbers, -2)
        if dimension != element.dimension:
            numbers.fail(f"{element.name} elements on an entity of this dimension", str(element.dimension), -4 + old,
                         str(dimension))  # fmt: skip
        rows, tags = found.setdefault(kind, ([], []))
        rows.append(numbers.tags(count * (1 + element.nodes)).reshape(count, 1 + element.nodes))
        tags.append(entity)
    for kind, (rows, tags) in found.items():
        table = np.concatenate(rows)
        entities = np.repeat(np.array(tags, np.int64), [len(some) for some in rows])
        none = np.full(len(table), NO_GROUP, np.int64)
        mesh.runs.append(Run(BY_GMSH[kind], table[:, 0], table[:, 1:], none, entities))
    count = sum(len(run.ids) for run in mesh.runs)
    if count != total:
        mesh.warnings.append(f"$Elements announces {total} elements and holds {count}: those are read")


def give_groups(mesh: Mesh) -> None:
    """Version 4: the groups of the elements' entities; those of a partition take their parent's."""
    made, first_made = 0, 0
    for run in mesh.runs:
        dimension = run.dimension
        entities, inverse = np.unique(run.entities, return_inverse=True)
        order = np.argsort(inverse, kind="stable")
        rows = np.split(order, np.cumsum(np.bincount(inverse, minlength=len(entities)))[:-1])
        first = np.full(len(entities), NO_GROUP, np.int64)
        parents = entities.copy()
        further: dict[int, list[Ints]] = {}
        for i, entity in enumerate(entities.tolist()):
            groups = mesh.groups_of_entity.get((dimension, entity), ())
            parent_dimension, parent = mesh.parents.get((dimension, entity), (dimension, entity))
            if parent_dimension == dimension:
                groups = groups or mesh.groups_of_entity.get((dimension, parent), ())
                parents[i] = parent
            elif not groups:
                made += len(rows[i])
                first_made = first_made or int(run.ids[rows[i][0]])
            if groups:
                first[i] = groups[0]
            for group in groups[1:]:
                further.setdefault(group, []).append(rows[i])
        run.groups, run.entities = first[inverse], parents[inverse]
        run.further = [(group, np.concatenate(some)) for group, some in further.items()]
    if made:
        mesh.warnings.append(
            f"{made} elements stand on borders between partitions, the first is {first_made}: in no group"
        )


def _starts(numbers: Numbers, values: NDArray[Any], count: int) -> Ints:
    """Where the rows, as bytes the blocks, begin, until there are `count` elements; goes on behind the last."""
    binary = numbers.binary
    head = slice(0, 3) if binary else slice(1, 3)
    pieces: list[Ints] = []
    at, done = 0, 0
    while done < count:
        if at + 3 > len(values):
            _end(numbers, count - done)
        kind, tags = int(values[at + head.start]), int(values[at + 2])
        size = int(values[at + 1]) if binary else 1
        width = _width(numbers, at, kind, tags, size, len(values))
        alike = min(-(-(count - done) // size), (len(values) - at) // width)
        alike = _equal_rows(values[at : at + alike * width].reshape(alike, width)[:, head])
        if alike < _LONG_RUN and (walked := _walk(numbers, values, at, count - done)):
            pieces.append(np.array(walked[0], np.int64))
            at, done = walked[1], done + walked[2]
        else:
            pieces.append(at + width * np.arange(alike))
            at, done = at + alike * width, done + alike * size
    numbers.skip(at)
    return np.concatenate(pieces) if pieces else np.zeros(0, np.int64)


def _walk(numbers: Numbers, values: NDArray[Any], at: int, count: int) -> tuple[list[int], int, int] | None:
    """Steps through rows that differ: their starts, where they end and how many elements; None when one is too long."""
    piece = values[at : at + _STRIDE].tolist()
    binary = numbers.binary
    starts: list[int] = []
    i, done = 0, 0
    while done < count and i + 3 <= len(piece):
        size = piece[i + 1] if binary else 1
        width = _width(numbers, at + i, piece[i] if binary else piece[i + 1], piece[i + 2], size, len(values))
        if i + width > len(piece):
            break
        starts.append(at + i)
        i += width
        done += size
    return (starts, at + i, done) if starts else None


def _width(numbers: Numbers, at: int, kind: int, tags: int, size: int, end: int) -> int:
    """Numbers of a row, or of a block with its heading; faults where it is impossible."""
    if kind not in BY_GMSH:
        _element(kind, numbers, at + (not numbers.binary))
    row = (1 if numbers.binary else 3) + tags + BY_GMSH[kind].nodes
    width = 3 + size * row if numbers.binary else row
    if tags < 0 or size < 1:
        numbers.fail("a count below its least", "tags: 0 or more, elements of a block: 1 or more", at + 2)
    if at + width > end:
        _end(numbers, 1)
    return width


def _end(numbers: Numbers, elements: int) -> None:
    numbers.fail("$Elements ends too early", f"{elements} more elements", numbers.left)


def _node_counts(kinds: Ints) -> Ints:
    table = np.zeros(1 + max(BY_GMSH), np.int64)
    for number, element in BY_GMSH.items():
        table[number] = element.nodes
    return table[kinds]


def _equal_rows(rows: NDArray[Any]) -> int:
    """How many rows begin `rows` that equal the first."""
    size = min(1, len(rows))
    while size < len(rows):
        until = min(2 * size, len(rows))
        same = (rows[size:until] == rows[0]).all(axis=1)
        if not same.all():
            return size + int(np.argmin(same))
        size = until
    return size


def _element(kind: int, numbers: Numbers, offset: int) -> Element:
    """The element of a gmsh type; a fault at the number `offset` numbers from the one that is read next."""
    if kind not in BY_GMSH:
        full_pyramid = "13-node pyramids (gmsh option Mesh.SecondOrderIncomplete = 1)"
        numbers.fail(
            f"elements of gmsh type {kind} are not known",
            full_pyramid if kind == _PYRAMID14 else "first and second order elements",
            offset,
        )
    return BY_GMSH[kind]
