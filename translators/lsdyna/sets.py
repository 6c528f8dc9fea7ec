"""*SET_...: groups by lists, ranges, boxes, parts and other sets; worked out when the whole deck is known.

A set is a row of steps that add or take away. Ranges pick what is in the deck, so that a wide one costs nothing; where
a file has none of the kind at all, its numbers are kept as they are listed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from zrno.translators.lsdyna.cards import Card, Table
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.model import ElementSet, Ints, NodeSet, PartSet, SegmentSet
from zrno.translators.text import parse_real

SETS = Registry()

FAMILIES = {"SHELL": "shell", "SOLID": "solid", "BEAM": "beam", "TSHELL": "tshell", "DISCRETE": "spring"}
KINDS = {"NODE": "node", "PART": "part", "SEGMENT": "segment", **FAMILIES}
# Blocks whose numbers a family's sets mean: areas of a plane problem are shells there.
_OF_FAMILY = {"shell": ("shell", "plane")}
# Types of the sets that *SET_NODE_ADD_ADVANCED names, by number.
_ADVANCED = {1: "node", 2: "shell", 3: "beam", 4: "solid", 5: "segment", 6: "spring", 7: "tshell"}
_MOST_LISTED = 1_000_000  # numbers of ranges in a file that has nothing to pick from
_DEEPEST = 200  # sets of sets
_MOST_WORK = 50  # times as much as there is to pick from


@dataclass(slots=True)
class SetSteps:
    """A set as its keywords say it. steps: what to do (add, or take away), and how to find the members."""

    kind: str
    id: int
    name: str
    block: Block
    row: int
    steps: list[tuple[bool, Callable[[], Ints]]] = field(default_factory=list)
    members: Ints | None = None
    busy: bool = False


@SETS("SET")
def _set(deck: Deck, block: Block, options: list[str]) -> bool:
    if not options or options[0] not in KINDS:
        return False
    kind = KINDS[options.pop(0)]
    title, collect = take(options, "TITLE"), take(options, "COLLECT")
    take(options, "LIST")
    take(options, "SMOOTH")
    layout = "_".join(options)
    if layout not in ("", "GENERATE", "GENERATE_INCREMENT", "COLUMN", "GENERAL", "ADD", "INTERSECT", "ADD_ADVANCED"):
        return False
    if kind == "segment" and layout not in ("", "GENERAL", "ADD"):
        return False
    name, rows = block.titled(title)
    if not len(rows):
        return True
    head = Card(deck, block, int(rows[0]), "sid/i da/a*5")
    number = head.id("sid", "set")
    key = (kind, number)
    if any(parse_real(text) not in (0.0, None) for _, text in head.texts["da"][:4]) and kind != "part":
        deck.count("{n} sets have attributes: they are not read", 1, block)
    if key in deck.sets and not collect:
        deck.warn(block, f"{kind} set {number} stands twice: the later one counts")
    if key not in deck.sets or not collect:
        deck.sets[key] = SetSteps(kind, number, name, block, int(rows[0]))
    _steps(deck, deck.sets[key], block, rows[1:], layout)
    return True


def _steps(deck: Deck, this: SetSteps, block: Block, rows: Ints, layout: str) -> None:
    kind = this.kind
    numbers = {"node": "node", "part": "part", "segment": "node"}.get(kind, "element")

    def members(table: Table, name: str) -> Ints:
        found = table.ids(name, numbers).ravel()
        kept: Ints = found[found != 0]
        return kept

    match layout:
        case "ADD" | "INTERSECT":
            others = Table(deck, block, rows, "ids/i*8").ids("ids", "set").ravel()
            others = others[others != 0]
            this.steps.append((True, lambda: _combined(deck, this, kind, others, intersect=layout == "INTERSECT")))
        case "ADD_ADVANCED":
            pairs = Table(deck, block, rows, "pair/i*8")["pair"].reshape(-1, 2)
            for other, code in pairs[pairs[:, 0] != 0].tolist():
                moved, which = deck.frame.moved(other, "set"), _ADVANCED.get(code, "")
                if kind != "node" or not which:
                    deck.count("{n} members of *SET_..._ADD_ADVANCED are not read", 1, block)
                else:
                    this.steps.append((True, lambda w=which, o=moved: _nodes_of_set(deck, this, w, o)))  # type: ignore[misc]
        case "GENERATE":
            pairs = Table(deck, block, rows, "pair/i*8").ids("pair", numbers).reshape(-1, 2)
            pairs = pairs[pairs[:, 0] != 0]
            steps = np.ones(len(pairs), np.int64)
            this.steps.append((True, lambda: _ranges(deck, this, pairs[:, 0], pairs[:, 1], steps)))
        case "GENERATE_INCREMENT":
            table = Table(deck, block, rows, "begin/i end/i step/i")
            begin, end, step = table.ids("begin", numbers), table.ids("end", numbers), np.maximum(table["step"], 1)
            this.steps.append((True, lambda: _ranges(deck, this, begin, end, step)))
        case "GENERAL":
            _general(deck, this, block, rows)
        case "COLUMN":
            listed = members(Table(deck, block, rows, "id/i"), "id")
            deck.count("{n} sets by columns: the members' attributes are not read", 1, block)
            this.steps.append((True, lambda: listed))
        case _ if kind == "segment":
            segments = Table(deck, block, rows, "nodes/i*4").ids("nodes", "node")
            this.steps.append((True, lambda: _segments(deck, this, segments)))
        case _:
            listed = members(Table(deck, block, rows, "ids/i*8"), "ids")
            this.steps.append((True, lambda: listed))


def _general(deck: Deck, this: SetSteps, block: Block, rows: Ints) -> None:
    """Rows of an option and up to seven numbers; D before an option takes away."""
    kind = this.kind
    own = {"node": "NODE", "part": "PART", "segment": "SEG"}.get(kind, "ELEM")
    for row in rows.tolist():
        card = Card(deck, block, row, "option/a values/i*7")
        option = card["option"].upper()
        if not option:
            continue
        add = not option.startswith("D") or option == "DISCRETE"
        word = option if add else option[1:]
        if word == "ALL" and kind != "segment":
            this.steps.append((add, lambda: _universe(deck, kind)))
            continue
        values = np.array([v for v in card.values("values") if v], np.int64)
        frame = deck.frame
        if word == own and kind == "segment":
            nodes = np.append(values, values[-1:])[:4] if len(values) == 3 else values[:4]
            if len(nodes) == 4:
                four = frame.moved_all(nodes, "node")[None]
                this.steps.append((add, lambda s=four: _segments(deck, this, s)))  # type: ignore[misc]
        elif word == own:
            listed = frame.moved_all(values, {"node": "node", "part": "part"}.get(kind, "element"))
            this.steps.append((add, lambda v=listed: v))  # type: ignore[misc]
        elif word == "PART" and kind not in ("part", "segment"):
            parts = frame.moved_all(values, "part")
            this.steps.append((add, lambda p=parts: _of_parts(deck, kind, p)))  # type: ignore[misc]
        elif word == "BOX" and kind == "node":
            boxes = frame.moved_all(values, "define")
            this.steps.append((add, lambda b=boxes: _in_boxes(deck, this, b)))  # type: ignore[misc]
        elif word in ("SET", f"SET_{own}") and kind != "segment":
            others = frame.moved_all(values, "set")
            this.steps.append((add, lambda o=others: _combined(deck, this, kind, o, intersect=False)))  # type: ignore[misc]
        elif kind == "node" and word.removeprefix("SET_") in KINDS and word.startswith("SET_"):
            which, others = KINDS[word.removeprefix("SET_")], frame.moved_all(values, "set")
            for other in others.tolist():
                this.steps.append((add, lambda w=which, o=other: _nodes_of_set(deck, this, w, o)))  # type: ignore[misc]
        else:
            deck.count(f"*SET_..._GENERAL: {{n}} rows of the option {option} are not read", 1, block, row)


def resolve_sets(deck: Deck) -> None:
    """Work out all sets and put them into the model."""
    model = deck.model
    lost = 0
    for this in deck.sets.values():
        found = members_of(deck, this)
        source = deck.source(this.block, this.row)
        match this.kind:
            case "node":
                lost += not len(model.node_ids) and len(found) > 0
                what = f"node set {this.id}"
                places = deck.found(found, what, this.block, this.row)
                model.node_sets.append(NodeSet(this.id, this.name, places, source))
            case "part":
                model.part_sets.append(PartSet(this.id, this.name, found, source))
            case "segment":
                lost += not len(model.node_ids) and len(found) > 0
                model.segment_sets.append(SegmentSet(this.id, this.name, found, source))
            case family:
                model.element_sets.append(ElementSet(this.id, this.name, family, found, source))
    if lost:
        deck.lacks(f"{lost} sets name nodes that are not in the file")


def members_of(deck: Deck, this: SetSteps) -> Ints:
    """A set's members: numbers, or places of nodes (n, 4) of segments. Each once, in the order of the file."""
    if this.members is not None:
        return this.members
    shape = (0, 4) if this.kind == "segment" else (0,)
    if this.busy or deck.depth > _DEEPEST:
        message = "the set is made of itself" if this.busy else "sets are made of sets, too deep"
        deck.fault(this.block.file, this.row, 0, message, str(this.id))
        return np.empty(shape, np.int64)
    this.busy = True
    deck.depth += 1
    members = np.empty(shape, np.int64)
    pending: list[Ints] = []
    for add, find in this.steps:
        if add:
            pending.append(find())
            continue
        members, pending = np.concatenate([members, *pending]), []
        away = find()
        if this.kind == "segment":
            gone = {tuple(sorted(s)) for s in away.tolist()}
            members = members[[tuple(sorted(s)) not in gone for s in members.tolist()]]
        else:
            members = members[~np.isin(members, away)]
    members = np.concatenate([members, *pending])
    if this.kind != "segment" and len(members) > 1 and not (members[1:] > members[:-1]).all():
        _, first = np.unique(members, return_index=True)
        members = members[np.sort(first)]
    this.busy = False
    deck.depth -= 1
    this.members = members
    return members


def node_places(deck: Deck, number: int, block: Block, row: int) -> Ints:
    """Places of the nodes of a node set that a keyword names; a fault where there is no such set."""
    this = deck.sets.get(("node", number))
    if this is None:
        missing(deck, block, row, "node set", number)
        return np.empty(0, np.int64)
    places = deck.places(members_of(deck, this))
    return places[places >= 0]


def missing(deck: Deck, block: Block, row: int, what: str, number: int) -> None:
    """Say that a keyword names what is not there; where a deck is only looked at, or is a piece of one, it may be."""
    if deck.partial or not len(deck.model.node_ids):
        deck.count(f"{{n}} times a {what} is named that is not in the file", 1, block, row)
    else:
        deck.fault(block.file, row, 0, f"there is no {what} of this number", str(number))


def _universe(deck: Deck, kind: str) -> Ints:
    """All numbers of a kind, in order."""
    if kind not in deck.universe:
        model = deck.model
        match kind:
            case "node":
                found = model.node_ids
            case "part":
                found = np.array(list(model.parts), np.int64)
            case family:
                names = _OF_FAMILY.get(family, (family,))
                found = np.concatenate([np.empty(0, np.int64), *(b.ids for b in model.blocks if b.family in names)])
        deck.universe[kind] = np.sort(found)
    return deck.universe[kind]


def _ranges(deck: Deck, this: SetSteps, begin: Ints, end: Ints, step: Ints) -> Ints:
    universe = _universe(deck, this.kind)
    if not len(universe):
        if (np.maximum(end - begin, 0) // step + 1).astype(float).sum() > _MOST_LISTED:
            deck.count("{n} sets are ranges of too many numbers that are not in the file", 1, this.block)
            return np.empty(0, np.int64)
        pieces = [np.arange(b, e + 1, s) for b, e, s in zip(begin, end, step, strict=True)]
        return np.concatenate([*pieces, np.empty(0, np.int64)])
    low, high = np.searchsorted(universe, begin), np.searchsorted(universe, end, side="right")
    whole = (step == 1) & (high > low)
    change = np.zeros(len(universe) + 1, np.int64)
    np.add.at(change, low[whole], 1)
    np.add.at(change, high[whole], -1)
    inside = np.cumsum(change)[:-1] > 0
    others = np.flatnonzero((step != 1) & (high > low))
    if (high - low)[others].sum() > _MOST_WORK * (len(universe) + _MOST_LISTED):
        deck.fault(this.block.file, this.row, 0, "the ranges of the set overlap too often", str(this.id))
        return np.empty(0, np.int64)
    for i in others.tolist():
        part = universe[low[i] : high[i]]
        inside[low[i] : high[i]] |= (part - begin[i]) % step[i] == 0
    return universe[inside]


def _combined(deck: Deck, this: SetSteps, kind: str, others: Ints, *, intersect: bool) -> Ints:
    found = []
    for number in others.tolist():
        other = deck.sets.get((kind, number))
        if other is None:
            missing(deck, this.block, this.row, f"{kind} set", number)
        else:
            found.append(members_of(deck, other))
    if not found:
        return np.empty((0, 4) if kind == "segment" else 0, np.int64)
    if intersect:
        common = found[0]
        for more in found[1:]:
            common = common[np.isin(common, more)]
        return common
    return np.concatenate(found)


def _nodes_of_set(deck: Deck, this: SetSteps, kind: str, number: int) -> Ints:
    """Numbers of the nodes of a set of another kind."""
    members = _combined(deck, this, kind, np.array([number]), intersect=False)
    model = deck.model
    if kind == "node" or not len(model.node_ids):
        return members if kind == "node" else np.empty(0, np.int64)
    if kind == "segment":
        return model.node_ids[np.unique(members[members >= 0])]
    if kind == "part":
        return _of_parts(deck, "node", members)
    names = _OF_FAMILY.get(kind, (kind,))
    found = [b.nodes[np.isin(b.ids, members)].ravel() for b in model.blocks if b.family in names]
    return _numbers(deck, found)


def _of_parts(deck: Deck, kind: str, parts: Ints) -> Ints:
    """Numbers of the nodes or elements of parts."""
    blocks = deck.model.blocks
    if kind == "node":
        return _numbers(deck, [b.nodes[np.isin(b.part, parts)].ravel() for b in blocks])
    names = _OF_FAMILY.get(kind, (kind,))
    found = [b.ids[np.isin(b.part, parts)] for b in blocks if b.family in names]
    return np.sort(np.concatenate(found)) if found else np.empty(0, np.int64)


def _numbers(deck: Deck, places: list[Ints]) -> Ints:
    if not places:
        return np.empty(0, np.int64)
    used = np.unique(np.concatenate(places))
    return np.sort(deck.model.node_ids[used[used >= 0]]) if len(deck.model.node_ids) else np.empty(0, np.int64)


def nodes_of_parts(deck: Deck, parts: Ints) -> Ints:
    """Places of the nodes of parts."""
    found = [b.nodes[np.isin(b.part, parts)].ravel() for b in deck.model.blocks]
    used = np.unique(np.concatenate(found)) if found else np.empty(0, np.int64)
    return used[used >= 0]


def _in_boxes(deck: Deck, this: SetSteps, boxes: Ints) -> Ints:
    found = []
    for number in boxes.tolist():
        box = deck.boxes.get(number)
        if box is None:
            missing(deck, this.block, this.row, "box", number)
        elif len(deck.model.xyz):
            inside = ((deck.model.xyz >= box[0]) & (deck.model.xyz <= box[1])).all(axis=1)
            found.append(np.sort(deck.model.node_ids[inside]))
    return np.concatenate(found) if found else np.empty(0, np.int64)


def _segments(deck: Deck, this: SetSteps, nodes: Ints) -> Ints:
    """Places of the nodes of segments; those that lack one are left out, and counted."""
    nodes = np.where(nodes[:, 3:4] == 0, np.column_stack([nodes[:, :3], nodes[:, 2]]), nodes)
    places = deck.places(nodes)
    if not len(deck.model.node_ids):
        return places
    good = (places >= 0).all(axis=1)
    lost = int((~good).sum())
    if lost:
        deck.count(f"{{n}} segments of segment set {this.id} have nodes that are not in the deck", lost, this.block)
    return places[good]
