"""The sections of a .msh file: names, entities, nodes and elements of versions 2.2 and 4.1.

Source: gmsh reference manual, "MSH file format" (4.1) and "Legacy formats" (2.2).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import BY_GMSH, Element
from zrno.translators.gmsh.numbers import Numbers
from zrno.translators.model import Floats, Ints
from zrno.translators.text import Faults

_NAME = re.compile(rb'\s*(\d+)\s+(\d+)\s+"(.*)"\s*$')
_PYRAMID14 = 14
NO_GROUP = 0


@dataclass(slots=True)
class Run:
    """Elements of one type. ids (n,), nodes (n, k): tags in gmsh's order; groups: (n,) physical group, NO_GROUP none;
    entities: (n,) elementary entity; more_groups: further physical groups that all of them belong to."""

    element: Element
    ids: Ints
    nodes: Ints
    groups: Ints
    entities: Ints
    more_groups: tuple[int, ...] = ()


@dataclass(slots=True)
class Mesh:
    """What the sections say. names: (dimension, group) -> (name, line)."""

    tags: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    xyz: Floats = field(default_factory=lambda: np.empty((0, 3)))
    runs: list[Run] = field(default_factory=list)
    names: dict[tuple[int, int], tuple[str, int]] = field(default_factory=dict)
    groups_of_entity: dict[tuple[int, int], list[int]] = field(default_factory=dict)


def physical_names(mesh: Mesh, text: bytes, line: int, faults: Faults) -> None:
    """$PhysicalNames; `line` is the section's first."""
    for i, row in enumerate(text.splitlines()[1:], 1):
        match = _NAME.match(row)
        if match is None:
            faults.add(line + i, 1, "not a physical name", row.decode("utf-8", "replace"), 'dimension, number, "name"')
        else:
            mesh.names[int(match[1]), int(match[2])] = (match[3].decode("utf-8", "replace"), line + i)
    faults.stop()


def nodes_22(mesh: Mesh, numbers: Numbers, count: int) -> None:
    """$Nodes of version 2.2 behind its count."""
    mesh.tags, mesh.xyz = numbers.tagged_points(count)


def elements_22(mesh: Mesh, numbers: Numbers, count: int) -> None:
    """$Elements of version 2.2 behind its count: rows of id, type, tags, nodes; binary: blocks of equal rows."""
    if numbers.binary:
        while count > 0:
            kind, size, tags = (int(value) for value in numbers.ahead(3))
            element = _element(kind, numbers, 0)
            # gmsh gives each element a block of its own: equal ones are taken together
            width = 1 + tags + element.nodes
            block = 3 + max(size, 1) * width
            many = _equal_rows(numbers.ahead_all(), block, -(-count // max(size, 1)), slice(0, 3))
            rows = numbers.ints(max(many, 1) * block).reshape(-1, block)[:, 3:].reshape(-1, width)
            mesh.runs.append(_run_22(element, rows[:, :1], rows[:, 1:]))
            count -= len(rows)
        return
    while count > 0:
        kind, tags = (int(value) for value in numbers.ahead(3)[1:])
        element = _element(kind, numbers, 1)
        width = 3 + tags + element.nodes
        size = _equal_rows(numbers.ahead_all(), width, count, slice(1, 3))
        rows = numbers.ints(max(size, 1) * width).reshape(-1, width)
        mesh.runs.append(_run_22(element, rows[:, :1], rows[:, 3:]))
        count -= len(rows)


def _run_22(element: Element, ids: Ints, rows: Ints) -> Run:
    """rows: tags, then nodes; the first tag is the physical group, the second the entity."""
    tags, nodes = rows[:, : -element.nodes], rows[:, -element.nodes :]
    none = np.full(len(rows), NO_GROUP, np.int64)
    groups = np.abs(tags[:, 0]) if tags.shape[1] > 0 else none
    return Run(element, ids[:, 0], nodes, groups, tags[:, 1] if tags.shape[1] > 1 else none)


def _equal_rows(values: NDArray[Any], width: int, limit: int, head: slice) -> int:
    """How many rows of this width, at most `limit`, begin `values` with the `head` of the first."""
    rows = values[: min(limit, len(values) // width) * width].reshape(-1, width)[:, head]
    size = min(1, len(rows))
    while size < len(rows):
        until = min(2 * size, len(rows))
        same = (rows[size:until] == rows[0]).all(axis=1)
        if not same.all():
            return size + int(np.argmin(same))
        size = until
    return size


def entities_41(mesh: Mesh, numbers: Numbers) -> None:
    """$Entities of version 4.1: which physical groups an entity belongs to."""
    for dimension, count in enumerate(numbers.sizes(4).tolist()):
        for _ in range(count):
            tag = int(numbers.ints(1)[0])
            numbers.reals(3 if dimension == 0 else 6)
            groups = numbers.ints(int(numbers.sizes(1)[0]))
            if dimension:
                numbers.ints(int(numbers.sizes(1)[0]))
            mesh.groups_of_entity[dimension, tag] = np.abs(groups).tolist()


def nodes_41(mesh: Mesh, numbers: Numbers) -> None:
    """$Nodes of version 4.1: blocks of tags, then coordinates (and parameters on the entity)."""
    blocks = int(numbers.sizes(4)[0])
    tags, points = [], []
    for _ in range(blocks):
        dimension, _entity, parametric = numbers.ints(3).tolist()
        count = int(numbers.sizes(1)[0])
        tags.append(numbers.sizes(count))
        width = 3 + (dimension if parametric else 0)
        points.append(numbers.reals(count * width).reshape(count, width)[:, :3])
    if blocks:
        mesh.tags, mesh.xyz = np.concatenate(tags), np.concatenate(points)


def elements_41(mesh: Mesh, numbers: Numbers) -> None:
    """$Elements of version 4.1: blocks of one entity and one type."""
    for _ in range(int(numbers.sizes(4)[0])):
        dimension, entity, kind = numbers.ints(3).tolist()
        count = int(numbers.sizes(1)[0])
        element = _element(kind, numbers, -2)
        rows = numbers.sizes(count * (1 + element.nodes)).reshape(count, 1 + element.nodes)
        groups = mesh.groups_of_entity.get((dimension, entity)) or [NO_GROUP]
        full = np.full(count, groups[0], np.int64)
        mesh.runs.append(Run(element, rows[:, 0], rows[:, 1:], full, np.full(count, entity), tuple(groups[1:])))


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
