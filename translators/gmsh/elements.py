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
from zrno.translators.streams import row_starts

_PYRAMID14 = 14


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
    blocks, total = numbers.few("nn" if old else "nnnn")[:2]
    found: dict[int, tuple[list[Ints], list[int]]] = {}
    for _ in range(blocks):
        first, second, kind, count = numbers.few("iiin")
        dimension, entity = (second, first) if old else (first, second)
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

    def measure(at: int, head: list[int]) -> tuple[int, int]:
        if len(head) < 3:
            numbers.fail("$Elements ends too early", f"{count} elements", len(values))
        kind = head[0] if binary else head[1]
        tags, size = head[2], head[1] if binary else 1
        if kind not in BY_GMSH:
            _element(kind, numbers, at + (not binary))
        row = tags + BY_GMSH[kind].nodes
        width = 3 + size * (1 + row) if binary else 3 + row
        if tags < 0 or size < 1:
            numbers.fail("a count below its least", "tags: 0 or more, elements of a block: 1 or more", at + 2)
        if at + width > len(values):
            numbers.fail("$Elements ends too early", f"{count} elements", len(values))
        return width, size

    starts, end = row_starts(values, count, slice(0, 3) if binary else slice(1, 3), measure)
    numbers.skip(end)
    return starts


def _node_counts(kinds: Ints) -> Ints:
    table = np.zeros(1 + max(BY_GMSH), np.int64)
    for number, element in BY_GMSH.items():
        table[number] = element.nodes
    return table[kinds]


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
