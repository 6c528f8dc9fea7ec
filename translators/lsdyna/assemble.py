"""From tables to the model's mesh: nodes placed by their includes, node numbers to places, shapes, blocks, parts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import TABLE
from zrno.translators.lsdyna.deck import Deck, ElementRun
from zrno.translators.lsdyna.placing import place_nodes
from zrno.translators.lsdyna.shapes import default_order, order_by_place, split_solids
from zrno.translators.model import ElementBlock, Ints, Part

_SAMPLE = 200  # elements that tell the order of mid-nodes
_LARGE = {"H20": ("hex20", 20), "H27": ("hex27", 27), "T15": ("tet10", 10), "P21": ("wedge6", 6), "H64": ("hex8", 8)}
Data = dict[str, NDArray[Any]]


def nodes(deck: Deck) -> None:
    """Put all nodes into the model; a fault for a number that stands twice."""
    model, runs = deck.model, deck.nodes
    if not runs:
        return
    place_nodes(deck)
    if len(runs) == 1:
        model.node_ids, model.xyz = runs[0].ids, runs[0].xyz
    else:
        model.node_ids = np.concatenate([run.ids for run in runs])
        model.xyz = np.concatenate([run.xyz for run in runs])
    for run in runs:
        if np.isfinite(run.xyz).all():
            continue
        bad = ~np.isfinite(run.xyz).all(axis=1)
        for i in np.flatnonzero(bad)[:20].tolist():
            deck.fault(run.block.file, int(run.rows[i]), 0, "a node's place is not finite", str(run.ids[i]))
    rows = np.concatenate([run.rows for run in runs]) if len(runs) > 1 else runs[0].rows
    firsts = np.cumsum([0] + [len(run.ids) for run in runs])
    for i in _twice(model.node_ids):
        run = runs[int(np.searchsorted(firsts, i, side="right")) - 1]
        deck.fault(run.block.file, int(rows[i]), 0, "a node number stands twice", str(model.node_ids[i]),
                   "numbers that differ")  # fmt: skip
    codes = [(run.tc, run.rc) for run in runs]
    if any(tc.any() or rc.any() for tc, rc in codes):
        tc, rc = (np.concatenate(code) for code in zip(*codes, strict=True))
        model.fixed = np.concatenate([held(tc), held(rc)], axis=1)
    deck.nodes = []
    deck.index_nodes()


def held(code: Ints) -> NDArray[np.bool_]:
    """Which of three directions constraint codes hold, (n, 3): 1 x, 2 y, 3 z, 4 xy, 5 yz, 6 zx, 7 all."""
    table = np.zeros((8, 3), bool)
    for number, directions in enumerate(("", "x", "y", "z", "xy", "yz", "zx", "xyz")):
        table[number] = [axis in directions for axis in "xyz"]
    return table[np.clip(code, 0, 7)]


def _twice(numbers: Ints) -> list[int]:
    """Places of the first twenty numbers that stood before."""
    if len(numbers) < 2 or (numbers[1:] > numbers[:-1]).all():
        return []
    order = np.argsort(numbers, kind="stable")
    again = np.flatnonzero(numbers[order][1:] == numbers[order][:-1])
    return sorted(order[again[:20] + 1].tolist())


def elements(deck: Deck) -> None:
    """Make blocks of all elements, and the parts that only elements name."""
    model = deck.model
    groups: dict[tuple[Any, ...], list[ElementBlock]] = {}
    missing = 0
    for run in deck.elements:
        if run.shape == "point" and "last" in run.data:
            _expand(deck, run)
        _check_zero(deck, run)
        for kind, which, ids in _shapes(deck, run):
            missing += _to_places(deck, run, which, ids)
            ids = _in_vtk_order(deck, run, kind, ids)
            data = {key: value if which is None else value[which] for key, value in run.data.items()}
            _third_node(deck, run, data)
            own = (run.ids, run.part) if which is None else (run.ids[which], run.part[which])
            block = ElementBlock(kind, own[0], ids, own[1], run.family, data)
            key = (run.family, kind, *sorted((name, values.shape[1:]) for name, values in data.items()))
            groups.setdefault(key, []).append(block)
    if missing:
        text = "s" if missing > 1 else ""
        deck.lacks(f"{missing} element{text} point{'' if text else 's'} at nodes that are not in the file")
    _check_twice(deck)
    deck.elements = []
    deck.stop()
    model.blocks = [_joined(blocks) for blocks in groups.values()]
    _parts(deck)


def _joined(blocks: list[ElementBlock]) -> ElementBlock:
    first = blocks[0]
    if len(blocks) == 1:
        return first
    return ElementBlock(
        first.kind,
        np.concatenate([b.ids for b in blocks]),
        np.concatenate([b.nodes for b in blocks]),
        np.concatenate([b.part for b in blocks]),
        first.family,
        {name: np.concatenate([b.data[name] for b in blocks]) for name in first.data},
    )


def _check_twice(deck: Deck) -> None:
    for family in dict.fromkeys(run.family for run in deck.elements):
        runs = [run for run in deck.elements if run.family == family]
        ids = np.concatenate([run.ids for run in runs]) if len(runs) > 1 else runs[0].ids
        firsts = np.cumsum([0] + [len(run.ids) for run in runs])
        for i in _twice(ids):
            which = int(np.searchsorted(firsts, i, side="right")) - 1
            run = runs[which]
            row = int(run.rows[i - firsts[which]])
            deck.fault(run.block.file, row, 0, f"a {family} element's number stands twice", str(ids[i]),
                       "numbers that differ in a family")  # fmt: skip


def _check_zero(deck: Deck, run: ElementRun) -> None:
    """A fault for elements that lack one of the nodes that each of their shape has."""
    if not len(run.nodes) or run.nodes.min() > 0:
        return
    needed = {"solid": 4, "shell": 3, "beam": 2, "spring": 1, "point": 1}.get(run.shape, run.nodes.shape[1])
    for i in np.flatnonzero((run.nodes[:, :needed] <= 0).any(axis=1))[:20].tolist():
        deck.fault(run.block.file, int(run.rows[i]), 0, "an element has no number for one of its nodes",
                   f"element {run.ids[i]}", "numbers of nodes")  # fmt: skip


def _expand(deck: Deck, run: ElementRun) -> None:
    """Elements that stand for a range of nodes (nid .. nend): one for each node of the deck in it."""
    last = np.maximum(run.data.pop("last"), run.ids)
    order = np.sort(deck.model.node_ids)
    begin, end = np.searchsorted(order, run.ids), np.searchsorted(order, last, side="right")
    # the element itself stays where its node is missing: that is a fault of its own
    count = np.where(last > run.ids, np.maximum(end - begin, 1), 1)
    if count.sum() > len(order) + len(run.ids):
        deck.fault(run.block.file, run.block.line, 0, "ranges of nodes overlap", run.block.name, "each node once")
        return
    which = np.repeat(np.arange(len(count)), count)
    step = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    inside = (last > run.ids)[which] & (end > begin)[which]
    place = np.minimum(begin[which] + step, max(len(order) - 1, 0))
    run.ids = np.where(inside, order[place] if len(order) else 0, run.ids[which])
    run.part, run.rows = run.part[which], run.rows[which]
    run.data = {key: value[which] for key, value in run.data.items()}
    run.nodes = run.ids[:, None].copy()


def _shapes(deck: Deck, run: ElementRun) -> Iterator[tuple[str, Ints | None, Ints]]:
    """Kind, which of the elements (None: all), and their node numbers; mid-nodes still in LS-DYNA's order."""
    nodes = run.nodes
    match run.shape:
        case "point":
            yield "point1", None, nodes
        case "beam":
            yield "line2", None, nodes
        case "spring":
            ground = nodes[:, 1] == 0
            if ground.any():
                yield "point1", np.flatnonzero(ground), nodes[ground, :1]
            if not ground.all():
                yield "line2", np.flatnonzero(~ground), nodes[~ground]
        case "shell":
            yield from _shell_shapes(nodes)
        case "solid":
            if nodes.shape[1] == 10:
                ten = (nodes[:, 8:] > 0).all(axis=1)
                if ten.any():
                    yield "tet10", np.flatnonzero(ten), nodes[ten]
                if ten.all():
                    return
                others = np.flatnonzero(~ten)
                for kind, which, part in split_solids(np.ascontiguousarray(nodes[others, :8])):
                    yield kind, others if which is None else others[which], part
            else:
                yield from split_solids(nodes)
        case _:
            kind, count = _LARGE[run.shape]
            if count < nodes.shape[1]:
                deck.count(
                    f"{{n}} solids of {nodes.shape[1]} nodes are read as {kind}: their further nodes are left out",
                    len(nodes), run.block,
                )  # fmt: skip
            yield kind, None, np.ascontiguousarray(nodes[:, :count])


def _shell_shapes(nodes: Ints) -> Iterator[tuple[str, Ints | None, Ints]]:
    triangle = (nodes[:, 3] == nodes[:, 2]) | (nodes[:, 3] == 0)
    middle = nodes[:, 4:] != 0
    curved = middle[:, :3].all(axis=1)
    for kind, which in (("quad4", ~triangle & ~curved), ("tri3", triangle & ~curved),
                        ("quad8", ~triangle & curved), ("tri6", triangle & curved)):  # fmt: skip
        if not which.any():
            continue
        some = None if which.all() else np.flatnonzero(which)
        own = nodes if some is None else nodes[some]
        match kind:
            case "quad4":
                yield kind, some, np.ascontiguousarray(own[:, :4])
            case "tri3":
                yield kind, some, np.ascontiguousarray(own[:, :3])
            case "quad8":
                yield kind, some, own.copy()
            case _:  # the third side's mid-node stands last; the side that is a point may repeat a corner
                last = np.where((own[:, 7] == 0) | (own[:, 7] == own[:, 2]), own[:, 6], own[:, 7])
                yield kind, some, np.column_stack([own[:, :3], own[:, 4:6], last])


def _to_places(deck: Deck, run: ElementRun, which: Ints | None, ids: Ints) -> int:
    """Turn node numbers into places, in the array itself. Returns how many elements lack nodes where that is no fault:
    in a file without nodes, or where parts of a deck are looked at."""
    missing = deck.to_places(ids)
    if not missing:
        return 0
    if not len(deck.model.node_ids) or deck.partial:
        np.maximum(ids, -1, out=ids)
        return missing
    for i in np.flatnonzero((ids < 0).any(axis=1))[:20].tolist():
        place = i if which is None else int(which[i])
        _absent(deck, run, place, -1 - int(ids[i].min()))
    np.maximum(ids, -1, out=ids)
    return 0


def _absent(deck: Deck, run: ElementRun, place: int, node: int) -> None:
    file, row = run.block.file, int(run.rows[place])
    for line in range(row, min(row + 8, run.block.last)):
        column = (" " + file.text(line).replace(",", " ") + " ").find(f" {node} ")
        if column >= 0:
            row = line
            break
    deck.fault(file, row, max(column, 0), f"element {run.ids[place]} has a node that is not there", str(node),
               "a node of *NODE")  # fmt: skip


def _in_vtk_order(deck: Deck, run: ElementRun, kind: str, nodes: Ints) -> Ints:
    if kind not in ("hex20", "hex27") or not len(nodes):
        return nodes
    order = default_order(kind)
    sample = nodes[:: max(len(nodes) // _SAMPLE, 1)]
    if (sample >= 0).all():
        other = order_by_place(kind, deck.model.xyz[sample])
        if other is not None and other != order:
            order = other
            if kind == "hex20":
                deck.warn(run.block, "the mid-nodes of these solids are not in LS-DYNA's order: their places tell it")
    return np.ascontiguousarray(nodes[:, list(order)])


def _third_node(deck: Deck, run: ElementRun, data: Data) -> None:
    if "orientation_node" not in data:
        return
    third = data["orientation_node"]
    places = deck.places(third)
    missing = int(((places < 0) & (third != 0)).sum())
    if missing and len(deck.model.node_ids):
        deck.count("{n} beams' orientation nodes are not in the deck", missing, run.block)
    if (third == 0).all():
        del data["orientation_node"]
    else:
        data["orientation_node"] = np.where(third == 0, -1, places)


def _parts(deck: Deck) -> None:
    """The parts' dimensions; parts that no *PART defines; blocks of plane problems."""
    model = deck.model
    for block in model.blocks:
        dimension = TABLE[block.kind].dimension
        same = len(block.part) and block.part.min() == block.part.max()
        for number in [int(block.part[0])] if same else np.unique(block.part).tolist():
            if number == 0 and block.family == "mass":
                continue
            part = model.parts.get(number)
            if part is None:
                part = model.parts[number] = Part(number, native={"implied": True})
            part.dimension = max(dimension, part.dimension or 0)
    _planes(deck)


def _planes(deck: Deck) -> None:
    model = deck.model
    plane = {p.id for p in model.parts.values() if p.section in model.sections and model.sections[p.section].plane}
    areas = [b for b in model.blocks if TABLE[b.kind].dimension == 2]
    if not plane or not areas:
        return
    for block in areas:
        inside = np.isin(block.part, list(plane))
        if inside.all():
            block.family = "plane"
    flat = bool(len(model.xyz)) and bool((model.xyz[:, 2] == model.xyz[0, 2]).all())
    others = [b for b in model.blocks if b.family != "plane" and TABLE[b.kind].dimension >= 2]
    model.dimension = 2 if flat and not others else 3
