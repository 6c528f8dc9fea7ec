"""Groups (block 408): node sets and element sets.

A group has rules (which numbers it takes) and lists (which it has); lists count, and rules where there are none.
Sources: neu2fstr (FrontISTR) for the records, FEMAP's own files for the kinds of rules and lists.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from zrno.translators.femap.cursor import Cursor
from zrno.translators.femap.ids import Places, by_value
from zrno.translators.femap.lines import Broken
from zrno.translators.model import ElementSet, Ints, Model, NodeSet, Source

NODE_LIST, ELEMENT_LIST = 7, 8
NODE_RULE, ELEMENT_RULE = 17, 21
CLIP_LINES = 20  # of a group, behind its layers
_ADD = 1  # of a rule's range: what is not added is taken away


@dataclass(slots=True)
class _Group:
    """lists: numbers by kind of list; rules: (n, 4) first, last, step, sign by kind of rule."""

    number: int
    title: str
    source: Source
    lists: dict[int, Ints] = field(default_factory=dict)
    rules: dict[int, Ints] = field(default_factory=dict)

    def members(self, kind: int, rule: int, ids: Ints) -> Ints:
        """Numbers of nodes or elements: as the list has them, else those of `ids` that the rule takes."""
        if kind in self.lists or rule not in self.rules or not len(ids):
            return self.lists.get(kind, np.zeros(0, np.int64))
        taken: NDArray[np.bool_] = np.zeros(len(ids), bool)
        for first, last, step, sign in self.rules[rule].tolist():
            hit = (ids >= first) & (ids <= (last or first)) & ((ids - first) % max(step, 1) == 0)
            taken[hit] = sign == _ADD
        return ids[taken]


@dataclass(slots=True)
class Groups:
    """Groups as they are read; made into sets when the mesh is there."""

    found: list[_Group] = field(default_factory=list)

    def read(self, cursor: Cursor, model: Model) -> None:
        """A block of groups; what has another form than the known one is passed by with a warning."""
        faults = cursor.lines.faults.found
        known = len(faults)
        try:
            while not cursor.done:
                self.found.append(_read(cursor))
        except Broken:
            fault = faults[known]
            del faults[known:]
            place = f"{fault.path}:{fault.line}:{fault.column}"
            model.warnings.append(f"{place}: the groups from here on are not read: {fault.message}")

    def fill(self, model: Model, nodes: Places, elements: Places) -> None:
        """The model's sets: a node set a group, an element set a group and family."""
        other: Counter[str] = Counter()
        missing = 0
        blocks = [block for block in model.blocks if len(block.ids)]
        known = Places(np.concatenate([np.zeros(0, np.int64), *(block.ids for block in blocks)]))
        owner = np.repeat(np.arange(len(blocks)), [len(block.ids) for block in blocks])
        for group in self.found:
            members = group.members(NODE_LIST, NODE_RULE, nodes.ids)
            if len(members):
                at, there = nodes.of(members)
                missing += int((~there).sum())
                if there.any():
                    model.node_sets.append(NodeSet(group.number, group.title, at[there], group.source))
            ids = group.members(ELEMENT_LIST, ELEMENT_RULE, elements.ids)
            if len(ids):
                at, there = known.of(ids)
                missing += int((~there).sum())
                families: dict[str, list[Ints]] = {}
                for block, some in by_value(owner[at[there]]):
                    families.setdefault(blocks[block].family, []).append(some)
                for family, places in families.items():
                    mine = ids[there][np.sort(np.concatenate(places))]
                    model.element_sets.append(ElementSet(group.number, group.title, family, mine, group.source))
            for kind in group.lists.keys() - {NODE_LIST, ELEMENT_LIST}:
                other[f"lists of kind {kind}"] += 1
            for kind in group.rules.keys() - {NODE_RULE, ELEMENT_RULE}:
                other[f"rules of kind {kind}"] += 1
        if self.found:
            path = self.found[0].source.file
            model.warnings += [f"{path}: {count} {what} of groups are not read" for what, count in other.items()]
            if missing:
                model.warnings.append(f"{path}: {missing} members of groups are not read: they are not in the mesh")


def _read(cursor: Cursor) -> _Group:
    source = cursor.source
    number = cursor.integers(2, "a group's number", 1)[0]
    group = _Group(number, cursor.title(), source)
    cursor.skip(1 + CLIP_LINES, "layers and clipping")
    for lists, width, what in ((group.rules, 4, "rules"), (group.lists, 1, "lists")):
        cursor.integers(1, f"the number of {what}", 0)
        while not cursor.at_end():
            kind = cursor.integers(1, f"the kind of {what}", 0)[0]
            short = cursor.short_list(width)
            if short is not None:
                values = np.array(short, np.int64).reshape(-1, width)
            else:
                rows = cursor.records(1, what)
                values = cursor.lines.whole(cursor.lines.table(rows, width, what), rows)
            if len(values):
                lists[kind] = values if width > 1 else values[:, 0]
        cursor.skip(1, what)
    return group
