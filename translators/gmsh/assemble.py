"""From the sections of a .msh file to a model: node indices, blocks, parts and node sets."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zrno.translators.gmsh.mesh import NO_GROUP, Mesh, Run
from zrno.translators.model import ElementBlock, Ints, Model, NodeSet, Part, Source
from zrno.translators.text import MAX_FAULTS, Faults

Marks = NDArray[np.bool_]
_SMALL = 1000  # elements up to which sorting their nodes is quicker than marking them


def model_of(mesh: Mesh, path: str, version: str, faults: Faults, data: bytes) -> Model:
    """The model of a mesh; a fault where an element's node is missing or a node's number stands twice."""
    model = Model(title=mesh.title or Path(path).stem, format="msh", version=version)
    model.node_ids, model.xyz = mesh.tags, mesh.xyz
    _point_at_nodes(mesh, faults, data)
    runs = [run for run in mesh.runs if len(run.ids)]
    drop = [_is_set_point(mesh, run) for run in runs]
    top = max((run.dimension for run, gone in zip(runs, drop, strict=True) if not gone.all()), default=-1)
    flat = bool((mesh.xyz[:, 2] == mesh.xyz[0, 2]).all())
    model.dimension = top if top in (1, 2) and flat else 3
    model.warnings += [f"{path}: {warning}" for warning in mesh.warnings]
    parts = _parts(mesh, runs, drop, top, path, model)
    for run, gone, part in zip(runs, drop, parts, strict=True):
        if not gone.all():
            order = run.element.from_gmsh
            nodes = np.ascontiguousarray(run.nodes[:, list(order)] if order else run.nodes)
            block = ElementBlock(run.element.name, run.ids, nodes, part)
            if gone.any():
                block = ElementBlock(block.kind, block.ids[~gone], block.nodes[~gone], block.part[~gone])
            model.blocks.append(block)
    _node_sets(mesh, runs, drop, top, path, model)
    return model


def _is_set_point(mesh: Mesh, run: Run) -> Marks:
    """Which elements are points that stand for node sets alone."""
    if mesh.points is None or run.dimension:
        return np.zeros(len(run.ids), bool)
    return (run.ids >= mesh.points[0]) & (run.ids <= mesh.points[1])


def _point_at_nodes(mesh: Mesh, faults: Faults, data: bytes) -> None:
    """Node tags of the elements become places in the node list."""
    tags, count = mesh.tags, len(mesh.tags)
    least, largest = int(tags.min()), int(tags.max())
    dense = least >= 0 and largest < 8 * count + 1000
    if dense:
        table = np.full(largest + 1, -1, np.int64)
        table[tags] = np.arange(count)
        twice = tags[table[tags] != np.arange(count)]
    else:
        order = np.argsort(tags, kind="stable")
        ordered = tags[order]
        twice = ordered[1:][ordered[1:] == ordered[:-1]]
    if len(twice):
        number = int(twice.min())
        line = _line_of(data, b"Nodes", number)
        faults.add(line, 1, "a node number stands twice", str(number), "numbers that differ")
        faults.stop()
    for run in mesh.runs:
        if dense:
            inside = (run.nodes >= 0) & (run.nodes <= largest)
            places = table[run.nodes if inside.all() else np.where(inside, run.nodes, 0)]
            there = inside & (places >= 0) & (tags[places] == run.nodes)
        else:
            at = np.minimum(np.searchsorted(ordered, run.nodes), count - 1)
            places, there = order[at], ordered[at] == run.nodes
        if not there.all():
            for row in np.flatnonzero(~there.all(axis=1))[:MAX_FAULTS].tolist():
                missing, element = int(run.nodes[row][~there[row]][0]), int(run.ids[row])
                line = _line_of(data, b"Elements", element)
                faults.add(line, 1, f"element {element} has a node that is not there", str(missing), "a node of $Nodes")
        run.nodes = places
    faults.stop()


def _line_of(data: bytes, section: bytes, number: int) -> int:
    """The last line of a text section that begins with a number; else the section's own line."""
    start = data.index(b"$" + section)
    rows = list(re.finditer(rb"^[ \t]*%d[ \t\r\n]" % number, data[start : data.index(b"$End" + section)], re.MULTILINE))
    return 1 + data.count(b"\n", 0, start + (rows[-1].start() if rows else 0))


def _is_part(mesh: Mesh, run: Run, top: int) -> Marks:
    """Whether an element's group is a part: always in the highest dimension, below it where our writer says so."""
    grouped: Marks = run.groups != NO_GROUP
    if run.dimension == top:
        return grouped
    lower = [number for dimension, number in mesh.lower_parts if dimension == run.dimension]
    grouped &= np.isin(run.groups, lower)
    return grouped


def _parts(mesh: Mesh, runs: list[Run], drop: list[Marks], top: int, path: str, model: Model) -> list[Ints]:
    """Fills model.parts from the groups (without any: the entities) of the highest dimension; part numbers of each run,
    0 for elements of lower dimension."""
    tops = [(run, ~gone) for run, gone in zip(runs, drop, strict=True) if run.dimension == top]
    grouped = any((run.groups[kept] != NO_GROUP).any() for run, kept in tops)
    rest = 1 + max((int(run.groups.max()) for run, _ in tops), default=0)
    numbers, twice = [], 0
    names: dict[int, tuple[str, int, int]] = {}  # name, line, dimension of each part
    for run, gone in zip(runs, drop, strict=True):
        own = _is_part(mesh, run, top)
        number = np.where(own, run.groups, 0)
        if run.dimension == top:
            number = np.where(own, number, rest) if grouped else run.entities
            twice += sum(len(rows) for _, rows in run.further)
        for found in np.unique(number[~gone]).tolist():
            if found or run.dimension == top:
                name, line = mesh.names.get((run.dimension, found), ("", 0))
                if run.dimension == top and not grouped:
                    name, line = "", 0
                elif run.dimension == top and found == rest:
                    name, line = "ungrouped", 0
                if names.get(found, ("", 0, -1))[2] < run.dimension:
                    names[found] = (name, line, run.dimension)
        numbers.append(number)
    for found, (name, line, dimension) in sorted(names.items()):
        model.parts[found] = Part(found, name, dimension=dimension, source=Source(path, line) if line else None)
    if twice:
        others = dict.fromkeys(group for run, _ in tops for group, _ in run.further)
        said = ", ".join(mesh.names.get((top, group), (str(group), 0))[0] for group in list(others)[:5])
        said += ", ..." if len(others) > 5 else ""
        model.warnings.append(
            f"{path}: {twice} times an element belongs to a further group ({said}): "
            "it is in the part of its first, and in the node sets of all"
        )
    return numbers


def _node_sets(mesh: Mesh, runs: list[Run], drop: list[Marks], top: int, path: str, model: Model) -> None:
    """A set for each group of lower dimension and each named group."""
    members: dict[tuple[int, int], list[Ints]] = {}
    for run, gone in zip(runs, drop, strict=True):
        dimension, part = run.dimension, _is_part(mesh, run, top) & ~gone
        order = np.argsort(run.groups, kind="stable")
        ordered = run.groups[order]
        firsts = np.flatnonzero(np.diff(ordered, prepend=-1))
        rows = np.split(order, firsts[1:])
        pairs = [(int(ordered[at]), bool(part[order[at]]), some) for at, some in zip(firsts, rows, strict=True)]
        for group, is_part, some in [*pairs, *((group, dimension == top, some) for group, some in run.further)]:
            if group != NO_GROUP and (not is_part or (dimension, group) in mesh.names):
                members.setdefault((dimension, group), []).append(run.nodes[some].ravel())
    for (dimension, group), nodes in sorted(members.items(), key=lambda item: item[0]):
        name, line = mesh.names.get((dimension, group), ("", 0))
        source = Source(path, line) if line else None
        model.node_sets.append(NodeSet(group, name, _distinct(nodes, len(mesh.tags)), source))


def _distinct(nodes: list[Ints], count: int) -> Ints:
    if sum(len(some) for some in nodes) <= _SMALL:
        return np.unique(np.concatenate(nodes))
    there = np.zeros(count, bool)
    for some in nodes:
        there[some] = True
    return np.flatnonzero(there)
