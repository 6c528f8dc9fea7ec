"""What a model's parts and node sets are as entities and physical groups of a .msh file.

A part is a physical group of its elements' dimension. A node set is the group of those elements of lower dimension
whose nodes it is; where there are none such, of point elements of its own. An entity holds elements of the same groups.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from zrno.translators.elements import TABLE
from zrno.translators.gmsh.numbers import LARGEST_INT
from zrno.translators.model import Ints, Model, NodeSet
from zrno.translators.report import Report


@dataclass(slots=True)
class Piece:
    """Elements of one type on one entity. nodes: (n, k) indices in VTK's order."""

    kind: str
    entity: int
    ids: Ints
    nodes: Ints

    @property
    def dimension(self) -> int:
        """Of its elements."""
        return TABLE[self.kind].dimension


@dataclass(slots=True)
class Grouping:
    """entities: the groups of each, entity i + 1 of a dimension at [dimension][i]; names: (dimension, group) -> name;
    lower_parts: the groups below the highest dimension that are parts; points: first and last of the point elements
    that stand for node sets."""

    pieces: list[Piece] = field(default_factory=list)
    entities: list[list[tuple[int, ...]]] = field(default_factory=lambda: [[], [], [], []])
    names: dict[tuple[int, int], str] = field(default_factory=dict)
    lower_parts: dict[tuple[int, int], None] = field(default_factory=dict)  # an ordered set
    points: tuple[int, int] | None = None


def group(model: Model, report: Report, *, several: bool) -> Grouping:
    """Entities and groups of a model; several: whether an element may belong to more than one group (version 4)."""
    return _Grouper(model, report, several).result


class _Grouper:
    def __init__(self, model: Model, report: Report, several: bool) -> None:
        self.model, self.report, self.several = model, report, several
        self.result = Grouping()
        self.blocks = [block for block in model.blocks if len(block.ids)]
        self.dimensions = [TABLE[block.kind].dimension for block in self.blocks]
        self.top = max(self.dimensions, default=0)
        self.used: set[tuple[int, int]] = set()
        self.places: dict[tuple[int, tuple[int, ...]], int] = {}
        self.labels = [np.zeros(len(block.ids), np.int64) for block in self.blocks]  # places in self.result.entities
        self._parts()
        rest = [nodes for nodes in model.node_sets if not self._is_implied(nodes)]
        report.drop("node sets", sum(not len(s.nodes) for s in rest), "empty: a group has elements")
        self._sets([nodes for nodes in rest if len(nodes.nodes)])
        self.result.pieces[:0] = self._pieces()

    def _parts(self) -> None:
        """Each part's elements are an entity and a group of their own."""
        numbers = self._part_numbers()
        alone = 0
        for block, dimension, label in zip(self.blocks, self.dimensions, self.labels, strict=True):
            for number, some in _rows_by_value(block.part):
                owned = number in numbers
                label[some] = self._entity(dimension, (numbers[number],) if owned else ())
                if owned:
                    part = self.model.parts.get(number)
                    self._use(dimension, numbers[number], part.name if part else "")
                    if dimension < self.top:
                        self.result.lower_parts[dimension, numbers[number]] = None
                elif dimension == self.top:
                    alone += len(some)
        if alone:
            self.report.notes.append(f"{alone} elements are in no part: in a .msh file they are in no group")
        bare = len(self.model.parts.keys() - numbers.keys())
        self.report.drop("parts", bare, "without elements: a group has some")

    def _part_numbers(self) -> dict[int, int]:
        """The group's number of each part that elements have; 0 is none."""
        found = {int(n) for block in self.blocks for n in np.unique(block.part)}
        wanted = sorted(n for n in found if n != 0 or n in self.model.parts)
        numbers = {n: n for n in wanted if 0 < n <= LARGEST_INT}
        odd = [n for n in wanted if n not in numbers]
        free = (n for n in range(1, len(wanted) + 1) if n not in numbers)
        numbers |= dict(zip(odd, free, strict=False))
        self.report.approximate("part numbers", len(odd), f"renumbered: a group's is from 1 to {LARGEST_INT}")
        return numbers

    def _is_implied(self, nodes: NodeSet) -> bool:
        """Whether reading a named part makes this set anyhow."""
        part = self.model.parts.get(nodes.id)
        if part is None or not nodes.name or part.name != nodes.name:
            return False
        wanted = np.unique(nodes.nodes)
        for dimension in set(self.dimensions):
            there = [
                block.nodes[block.part == nodes.id].ravel()
                for block, own in zip(self.blocks, self.dimensions, strict=True)
                if own == dimension
            ]
            if np.array_equal(np.unique(np.concatenate(there)), wanted):
                return True
        return False

    def _sets(self, sets: list[NodeSet]) -> None:
        points: list[tuple[int, str, Ints]] = []
        renumbered = 0
        wanted = {nodes.id for nodes in sets}
        free = (n for n in itertools.count(1) if (0, n) not in self.used and n not in wanted)
        inside = np.zeros(len(self.model.xyz), bool)
        for nodes in sets:
            inside[nodes.nodes] = True
            if not self._as_elements(nodes, inside):
                number = nodes.id
                if not 0 < number <= LARGEST_INT or (0, number) in self.used:
                    number = next(free)
                    renumbered += 1
                self._use(0, number, nodes.name)
                points.append((number, nodes.name, np.flatnonzero(inside)))
            inside[nodes.nodes] = False
        self.report.approximate("node set numbers", renumbered, "renumbered: two sets as point groups, or none from 1")
        first = 1 + max((int(block.ids.max()) for block in self.blocks), default=0)
        for number, _, where in points:
            entity = self._entity(0, (number,))
            last = first + len(where) - 1
            self.result.points = (self.result.points[0] if self.result.points else first, last)
            self.result.pieces.append(Piece("point1", entity + 1, np.arange(first, last + 1), where[:, None]))
            first = last + 1

    def _as_elements(self, nodes: NodeSet, inside: np.ndarray) -> bool:
        """Give a set's number to the elements of lower dimension that have all its nodes and no other."""
        for dimension in range(self.top - 1, -1, -1):
            if (dimension, nodes.id) in self.used or not 0 < nodes.id <= LARGEST_INT:
                continue
            reached = np.zeros(len(inside), bool)
            chosen: list[tuple[int, Ints]] = []
            for i, (block, own) in enumerate(zip(self.blocks, self.dimensions, strict=True)):
                if own == dimension:
                    rows = np.flatnonzero(inside[block.nodes].all(axis=1))
                    reached[block.nodes[rows]] = True
                    chosen.append((i, rows))
            if not chosen or not np.array_equal(reached, inside):
                continue
            entities = self.result.entities[dimension]
            old = np.unique(np.concatenate([self.labels[i][rows] for i, rows in chosen])).tolist()
            if not self.several and any(entities[label] for label in old):
                continue
            self._use(dimension, nodes.id, nodes.name)
            for label in old:
                new = self._entity(dimension, (*entities[label], nodes.id))
                for i, rows in chosen:
                    some = self.labels[i][rows]
                    self.labels[i][rows] = np.where(some == label, new, some)
            return True
        return False

    def _entity(self, dimension: int, groups: tuple[int, ...]) -> int:
        entities = self.result.entities[dimension]
        place = self.places.setdefault((dimension, groups), len(entities))
        if place == len(entities):
            entities.append(groups)
        return place

    def _use(self, dimension: int, number: int, name: str) -> None:
        self.used.add((dimension, number))
        plain = "".join(letter if letter.isprintable() else " " for letter in name)
        if plain != name:
            self.report.approximate("names", 1, "letters that are not printed are blanks")
        if plain:
            self.result.names[dimension, number] = plain

    def _pieces(self) -> Iterator[Piece]:
        for block, label in zip(self.blocks, self.labels, strict=True):
            for entity, some in _rows_by_value(label):
                yield Piece(block.kind, entity + 1, block.ids[some], block.nodes[some])


def _rows_by_value(values: Ints) -> Iterator[tuple[int, Ints]]:
    """Each value and the rows that have it."""
    order = np.argsort(values, kind="stable")
    ordered = values[order]
    firsts = np.flatnonzero(np.concatenate(([True], ordered[1:] != ordered[:-1])))
    yield from zip(ordered[firsts].tolist(), np.split(order, firsts[1:]), strict=True)
