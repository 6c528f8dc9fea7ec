"""Nodes (block 403) and elements (block 404): from lines to arrays."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from zrno.translators.femap.assemble import Builder
from zrno.translators.femap.cursor import Cursor
from zrno.translators.femap.ids import Places, by_value
from zrno.translators.femap.lines import Broken, Lines
from zrno.translators.femap.topology import LISTS
from zrno.translators.model import Floats, Ints, Model

_NODE, _HEAD, _FLAGS = 14, 8, 16  # numbers that are read of these lines
_STRIDE = 7  # lines of an element
_LIST_FIELDS = 9  # of a line of a node list; lines of an element's nodes have more
_FIRST_CHUNK = 1  # elements; a chunk that has no lists is followed by one twice as long


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
            if size == 1 and at + _STRIDE <= len(rows):
                single, wanted = _single(lines, rows[at : at + _STRIDE])
                if wanted:  # elements with lists often follow each other: one by one they are quicker so
                    heads.append(np.array([single]))
                    starts.append(rows[at : at + 1])
                    at, searched = self._pass_lists(lines, rows, at + _STRIDE, wanted, searched)
                    continue
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
                if len(lines.words(int(rows[place]))) > _LIST_FIELDS:  # an element's nodes: this one has no list
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
        builder = Builder(self.head, self.rows, model, lines, places)
        for topology, which in by_value(self.head[:, 4]):
            with suppress(Broken):  # what is wrong is noted
                builder.add(topology, which)
        lines.faults.stop()
        builder.finish()
        return ids


def _single(lines: Lines, rows: Ints) -> tuple[list[int], int]:
    """An element's first line, and how many lists follow it."""
    head = lines.integers(int(rows[0]), 5, _HEAD, 1, "an element's number")
    flags = lines.numbers(int(rows[-1]), 1, "an element's flags")[12:_FLAGS]
    listed = sum(flag != 0 for flag in flags)
    return head, max(listed, int(head[4] in LISTS))
