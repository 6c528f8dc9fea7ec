"""From the records of elements to blocks of the model, one a kind and family."""

from __future__ import annotations

from collections import Counter

import numpy as np

from zrno.translators.elements import TABLE
from zrno.translators.femap.ids import Places, by_value
from zrno.translators.femap.lines import Lines
from zrno.translators.femap.topology import GAP, LISTS, PACKED, PYRAMIDS, RIGID_2, TOPOLOGIES, TYPES, UNKNOWN
from zrno.translators.model import ElementBlock, Ints, Model
from zrno.translators.text import MAX_FAULTS

_RIGID_TYPE = 29
_SHAPES: dict[str, tuple[tuple[int, ...], float | int]] = {
    "orientation": ((3,), 0.0),
    "orientation_node": ((), -1),
    "angle": ((), 0.0),
}


class Builder:
    """Makes element blocks, topology by topology."""

    def __init__(self, head: Ints, rows: Ints, model: Model, lines: Lines, places: Places) -> None:
        self.head, self.rows = head, rows  # as `mesh.Elements` has them
        self.model, self.lines, self.places = model, lines, places
        self.blocks: list[tuple[int, ElementBlock]] = []  # with the first element's place
        self.said: Counter[str] = Counter()
        self.first: dict[str, int] = {}

    def add(self, topology: int, which: Ints) -> None:
        """All elements of a topology; which: their places."""
        rigid = self.head[which, 3] == _RIGID_TYPE
        self._say("rigid elements are not read", which[rigid])
        which = which[~rigid]
        if topology in LISTS and topology != RIGID_2:
            self._say(f"elements with node lists (topology {topology}) are not read", which)
            return
        if topology not in TOPOLOGIES and topology != RIGID_2:
            self._say(f"elements of topology {topology} are not read", which)
            return
        nodes = self._nodes(which, topology)
        if topology == RIGID_2:  # or a pyramid's number, in some files
            pyramid = (nodes[:, :5] > 0).all(axis=1) & (nodes[:, 5:] == 0).all(axis=1)
            self._say("elements with node lists (topology 14) are not read", which[~pyramid])
            self._block(which[pyramid], nodes[pyramid], *TOPOLOGIES[18])
            self._say("pyramids, by the pattern of their nodes", which[pyramid])
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
            lines = self.lines.below(self.rows[which], 1 + k)
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
                row = int(self.lines.below(self.rows[which[i : i + 1]], 1)[0])
                message = f"element {int(self.head[which[i], 0])} has a node that is not there"
                self.lines.fault(row, 1, message, str(number), "a node of block 403")
            return
        families: dict[str, list[Ints]] = {}
        for number, some in by_value(self.head[which, 3]):
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
        head = self.head[which]
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
        rows = self.rows[which]
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
            self.first.setdefault(what, int(self.rows[which[0]]) + 1)

    def finish(self) -> None:
        """The blocks by their first elements, and the warnings."""
        self.model.blocks = [block for _, block in sorted(self.blocks, key=lambda item: item[0])]
        path = self.lines.faults.path
        self.model.warnings += [f"{path}:{self.first[what]}: {count} {what}" for what, count in self.said.items()]
