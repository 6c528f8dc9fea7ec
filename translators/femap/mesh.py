"""Nodes (block 403) and elements (block 404): from lines to arrays, and from these to blocks of the model."""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import TABLE
from zrno.translators.femap.cursor import Cursor
from zrno.translators.femap.framing import Broken, Lines
from zrno.translators.femap.ids import Places, by_value
from zrno.translators.femap.topology import GAP, LISTS, PACKED, PYRAMIDS, RIGID_2, TOPOLOGIES, TYPES, UNKNOWN
from zrno.translators.model import ElementBlock, Floats, Ints, Model
from zrno.translators.text import MAX_FAULTS

_NODE, _HEAD, _FLAGS = 14, 8, 16  # numbers that are read of these lines
_STRIDE = 7  # lines of an element
_LIST_FIELDS = 9  # of a line of a node list; lines of an element's nodes have more
_FIRST_CHUNK = 1  # elements; a chunk that has no lists is followed by one twice as long
_RIGID_TYPE = 29


def _none() -> Ints:
    return np.zeros(0, np.int64)


@dataclass(slots=True)
class Nodes:
    """rows: the line of each; fixed: (n, 6); system: the output system of each."""

    ids: Ints = field(default_factory=_none)
    xyz: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    rows: Ints = field(default_factory=_none)
    system: Ints = field(default_factory=_none)
    fixed: NDArray[np.bool_] = field(default_factory=lambda: np.zeros((0, 6), bool))

    def read(self, cursor: Cursor) -> None:
        """A block of nodes: number, systems, layer, colour, six permanent constraints, coordinates."""
        rows = cursor.rest()
        values = cursor.lines.table(rows, _NODE, "nodes", _NODE)
        ids = cursor.lines.whole(values[:, :1], rows, 1, "a node's number")[:, 0]
        system = cursor.lines.whole(values[:, :3], rows)[:, 2] if values[:, 1:3].any() else np.zeros(len(ids), np.int64)
        new = (ids, values[:, 11:14].copy(), rows, system, values[:, 5:11] != 0)
        old = (self.ids, self.xyz, self.rows, self.system, self.fixed)
        self.ids, self.xyz, self.rows, self.system, self.fixed = (
            (b if not len(a) else np.concatenate((a, b))) for a, b in zip(old, new, strict=True)
        )

    def fill(self, model: Model, lines: Lines) -> Places:
        """The model's nodes; faults for numbers that stand twice."""
        places = Places(self.ids)
        twice = places.twice()
        if twice is not None:
            lines.fault(int(self.rows[twice]), 1, "a node's number stands twice", str(int(self.ids[twice])))
            lines.faults.stop()
        model.node_ids, model.xyz = self.ids, self.xyz
        if self.fixed.any():
            model.fixed = self.fixed
            local = int((self.fixed.any(axis=1) & (self.system != 0)).sum())
            if local:
                said = f"{local} nodes with permanent constraints have a system of their own, which these do not keep"
                model.warnings.append(f"{lines.faults.path}: {said}")
        return places


@dataclass(slots=True)
class Elements:
    """Elements as they stand: head (n, 8): number, colour, property, type, topology, layer, orientation node, flag;
    rows: the line of each record."""

    head: Ints = field(default_factory=lambda: np.zeros((0, _HEAD), np.int64))
    rows: Ints = field(default_factory=_none)
    lists: int = 0  # node lists that were passed by

    def read(self, cursor: Cursor) -> None:
        """A block of elements: seven lines each, and node lists of some."""
        heads, starts = [self.head], [self.rows]
        lines, rows = cursor.lines, cursor.rest()
        at, size, searched = 0, _FIRST_CHUNK, 0
        while at < len(rows):
            some = rows[at : at + size * _STRIDE]
            some = some[: len(some) - len(some) % _STRIDE]  # a list may stand where the rest is
            begin = some[::_STRIDE]
            if not len(begin):
                cursor.at = cursor.block.last
                cursor.fail("the block ends inside an element", f"{_STRIDE} lines")
            head = lines.whole(lines.table(begin, _HEAD, "an element's first line", 5), begin)
            flags = np.zeros((len(head), _FLAGS), bool)
            last = some[_STRIDE - 1 :: _STRIDE]
            set_ones = lines.flagged(last)
            flags[set_ones] = lines.table(last[set_ones], _FLAGS, "an element's flags") != 0
            listed = flags[:, 12:].any(axis=1) | np.isin(head[:, 4], LISTS)
            count = int(np.argmax(listed)) + 1 if listed.any() else len(begin)
            if head[:count, 0].min() < 1:
                row = int(begin[int(np.argmax(head[:count, 0] < 1))])
                lines.fail(row, "not an element's number", lines.text(row), "a number from 1")
            heads.append(head[:count])
            starts.append(begin[:count])
            at += count * _STRIDE
            size = 2 * size
            if listed.any():
                wanted = max(int(flags[count - 1, 12:].sum()), 1)
                at, searched = self._pass_lists(lines, rows, at, wanted, searched)
                size = _FIRST_CHUNK
        self.head, self.rows = np.concatenate(heads), np.concatenate(starts)

    def _pass_lists(self, lines: Lines, rows: Ints, at: int, count: int, searched: int) -> tuple[int, int]:
        """The place behind the node lists of an element, each ending with -1; there may be none.

        searched: the place up to which it is known that no list ends; the second result.
        """
        for _ in range(count):
            place = max(at, searched)
            while place < len(rows) and not lines.begins_with_end(int(rows[place])):
                if len(lines.fields(int(rows[place]))) > _LIST_FIELDS:  # an element's nodes: this one has no list
                    return at, place
                place += 1
            if place == len(rows):
                return at, place
            at = place + 1
            self.lists += 1
        return at, searched

    def fill(self, model: Model, lines: Lines, places: Places) -> Places:
        """The model's elements, a block a kind and family; faults for nodes that are not there."""
        ids = Places(self.head[:, 0])
        twice = ids.twice()
        if twice is not None:
            number = str(int(self.head[twice, 0]))
            lines.fault(int(self.rows[twice]), 1, "an element's number stands twice", number)
            lines.faults.stop()
        builder = _Builder(self, model, lines, places)
        for topology, which in by_value(self.head[:, 4]):
            with suppress(Broken):  # what is wrong is noted
                builder.add(topology, which)
        lines.faults.stop()
        builder.finish()
        return ids


class _Builder:
    """Makes element blocks, topology by topology."""

    def __init__(self, elements: Elements, model: Model, lines: Lines, places: Places) -> None:
        self.elements, self.model, self.lines, self.places = elements, model, lines, places
        self.blocks: list[tuple[int, ElementBlock]] = []  # with the first element's place
        self.said: Counter[str] = Counter()
        self.first: dict[str, int] = {}

    def add(self, topology: int, which: Ints) -> None:
        """All elements of a topology; which: their places."""
        rigid = self.elements.head[which, 3] == _RIGID_TYPE
        self._say("rigid elements are not read", which[rigid])
        which = which[~rigid]
        if topology in LISTS and topology != RIGID_2:
            self._say(f"elements with node lists (topology {topology}) are not read", which)
            return
        nodes = self._nodes(which, topology)
        if topology == RIGID_2:  # or a pyramid's number, in some files
            pyramid = (nodes[:, :5] > 0).all(axis=1) & (nodes[:, 5:] == 0).all(axis=1)
            self._say("elements with node lists (topology 14) are not read", which[~pyramid])
            self._block(which[pyramid], nodes[pyramid], *TOPOLOGIES[18])
            self._say("pyramids, by the pattern of their nodes", which[pyramid])
        elif topology not in TOPOLOGIES:
            self._say(f"elements of topology {topology} are not read", which)
        else:
            kind, order = TOPOLOGIES[topology]
            other = np.zeros(len(which), bool)
            if topology in PACKED:
                other = nodes[:, GAP] != 0
                self._block(which[other], nodes[other], kind, PACKED[topology])
            if topology in PYRAMIDS:
                apex = nodes[:, 4:8]
                other = (apex[:, :1] > 0)[:, 0] & ((apex == apex[:, :1]) | (apex == 0)).all(axis=1)
                self._block(which[other], nodes[other], *TOPOLOGIES[PYRAMIDS[topology]])
                self._say("bricks whose upper face is one node, read as pyramids", which[other])
            elif topology in PYRAMIDS.values():
                self._say(f"elements of topology {topology}, read as pyramids", which)
            self._block(which[~other], nodes[~other], kind, order)

    def _nodes(self, which: Ints, topology: int) -> Ints:
        """The nodes of elements: all 20, or the first 10 where the topology needs no more."""
        found = []
        _, order = TOPOLOGIES.get(topology, ("", range(20)))
        for k in range(2 if max(order) > 9 else 1):
            lines = self.lines.below(self.elements.rows[which], 1 + k)
            found.append(
                self.lines.whole(self.lines.table(lines, 10, "an element's nodes"), lines, 0, "a node's number")
            )
        return found[0] if len(found) == 1 else np.concatenate(found, axis=1)

    def _block(self, which: Ints, nodes: Ints, kind: str, order: tuple[int, ...]) -> None:
        """Elements of one kind, family by family."""
        nodes = nodes[:, : len(order)] if order == tuple(range(len(order))) else nodes[:, list(order)]
        corners = TABLE[kind].shape.corners
        missing = (nodes[:, corners:] == 0).any(axis=1)
        if missing.any():
            self._say(f"{kind} elements lack nodes between their corners: read without these", which[missing])
            linear = next(e.name for e in TABLE.values() if e.shape is TABLE[kind].shape and e.nodes == corners)
            self._block(which[missing], nodes[missing], linear, tuple(range(corners)))
            which, nodes = which[~missing], nodes[~missing]
        at, there = self.places.of(nodes)
        if not there.all():
            for i in np.flatnonzero(~there.all(axis=1))[:MAX_FAULTS].tolist():
                number = int(nodes[i][~there[i]][0])
                row = int(self.lines.below(self.elements.rows[which[i : i + 1]], 1)[0])
                message = f"element {int(self.elements.head[which[i], 0])} has a node that is not there"
                self.lines.fault(row, 1, message, str(number), "a node of block 403")
            return
        families: dict[str, list[Ints]] = {}
        for number, some in by_value(self.elements.head[which, 3]):
            known = TYPES.get(number, UNKNOWN)
            families.setdefault(known.family, []).append(some)
            if not known.sure:
                said = f"elements of type {number} ({known.name}) are read as {known.family or 'elements of no family'}"
                self._say(said, which[some])
        for family, places in families.items():
            if len(places) == len(families) == 1:
                self._append(which, at, kind, family)
            else:
                mine = np.sort(np.concatenate(places))
                self._append(which[mine], at[mine], kind, family)

    def _append(self, which: Ints, nodes: Ints, kind: str, family: str) -> None:
        head = self.elements.head[which]
        same = next((b for _, b in self.blocks if (b.kind, b.family) == (kind, family)), None)
        block = ElementBlock(kind, head[:, 0], nodes, head[:, 2], family)
        self._own_data(block, which, head)
        if same is None:
            self.blocks.append((int(which[0]), block))
            return
        for name in {*same.data, *block.data}:
            parts = [
                b.data.get(name, np.full((len(b.ids), *_SHAPES[name][0]), _SHAPES[name][1])) for b in (same, block)
            ]
            same.data[name] = np.concatenate(parts)
        same.ids, same.nodes = np.concatenate((same.ids, block.ids)), np.concatenate((same.nodes, block.nodes))
        same.part = np.concatenate((same.part, block.part))

    def _own_data(self, block: ElementBlock, which: Ints, head: Ints) -> None:
        """Orientations of beams, and angles of the material of areas."""
        if block.family == "solid" and not head[:, 7].any():
            return
        rows = self.elements.rows[which]
        if block.family == "beam":
            orient = self.lines.table(self.lines.below(rows, 3), 3, "an element's orientation")
            if orient.any():
                block.data["orientation"] = orient
            if head[:, 6].any():
                at, there = self.places.of(head[:, 6])
                self._say("orientation nodes are not there", which[(head[:, 6] != 0) & ~there])
                block.data["orientation_node"] = np.where((head[:, 6] != 0) & there, at, -1)
        elif head[:, 7].any():
            if TABLE[block.kind].dimension == 2:
                angle = self.lines.table(self.lines.below(rows, 3), 1, "an element's angle")[:, 0]
                block.data["angle"] = np.where(head[:, 7] != 0, angle, 0.0)
            else:
                self._say("material directions are not carried", which[head[:, 7] != 0])
        if TABLE[block.kind].dimension < 3:
            ends = [self.lines.table(self.lines.below(rows, k), 3, "an element's offsets") for k in (4, 5)]
            self._say("offsets of elements are not carried", which[ends[0].any(axis=1) | ends[1].any(axis=1)])
            if block.family == "beam":
                flags = self.lines.table(self.lines.below(rows, 6), 12, "an element's releases")
                self._say("releases of beam ends are not carried", which[flags.any(axis=1)])

    def _say(self, what: str, which: Ints) -> None:
        if len(which):
            self.said[what] += len(which)
            self.first.setdefault(what, int(self.elements.rows[which[0]]) + 1)

    def finish(self) -> None:
        """The blocks by their first elements, and the warnings."""
        self.model.blocks = [block for _, block in sorted(self.blocks, key=lambda item: item[0])]
        path = self.lines.faults.path
        self.model.warnings += [f"{path}:{self.first[what]}: {count} {what}" for what, count in self.said.items()]


_SHAPES: dict[str, tuple[tuple[int, ...], float | int]] = {
    "orientation": ((3,), 0.0),
    "orientation_node": ((), -1),
    "angle": ((), 0.0),
}
