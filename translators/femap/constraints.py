"""Constraints (blocks 406 and 506): sets of held nodes and of linear relations.

406: number, title, nodes until -1, relations until -1. 506: three lists of held geometry between these, and from
version 9.3 further lists behind. Lines behind what is known are passed by up to the next set.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from zrno.translators.femap.cursor import Cursor
from zrno.translators.femap.ids import Places, by_value
from zrno.translators.model import Constraint, Equation, Floats, Ints, Model, Source

_GEOMETRY_LISTS = 3
_NODE_FIELDS = 9  # number, colour, layer, six degrees of freedom


@dataclass(slots=True)
class _Set:
    """nodes: (n, 9); relations: number, and (k, 3) node, degree of freedom, coefficient."""

    number: int
    title: str
    source: Source
    nodes: Ints = field(default_factory=lambda: np.zeros((0, _NODE_FIELDS), np.int64))
    relations: list[tuple[int, Floats, Source]] = field(default_factory=list)


@dataclass(slots=True)
class ConstraintSets:
    """Sets as they are read; skipped: lines that were passed by."""

    found: list[_Set] = field(default_factory=list)
    geometry: int = 0
    skipped: int = 0

    def read(self, cursor: Cursor) -> None:
        """A block of constraint sets."""
        while not cursor.done:
            source = cursor.source
            number = cursor.integers(1, "a constraint set's number", 1)[0]
            new = _Set(number, cursor.title(), source)
            self.found.append(new)
            rows = cursor.records(1, "held nodes")
            values = cursor.lines.table(rows, _NODE_FIELDS, "held nodes", _NODE_FIELDS)
            new.nodes = cursor.lines.whole(values, rows)
            if cursor.block.number == 506:
                for _ in range(_GEOMETRY_LISTS):
                    self.geometry += len(cursor.records(1, "held geometry"))
            while not (cursor.done or cursor.at_end() or cursor.at_set(_NODE_FIELDS)):
                new.relations.append(_relation(cursor))
            self.skipped += cursor.pass_to_set(_NODE_FIELDS)

    def fill(self, model: Model, nodes: Places, system: Ints) -> None:
        """The model's constraints, those of a set with the same degrees of freedom together; and relations."""
        missing = 0
        for given in self.found:
            at, there = nodes.of(given.nodes[:, 0])
            missing += int((~there).sum())
            at, dofs = at[there], given.nodes[there, 3:] != 0
            key = system[at] * 64 + dofs @ (1 << np.arange(6))
            for value, mine in by_value(key):
                constraint = Constraint(at[mine], dofs[mine], given.number, given.title, source=given.source)
                constraint.system = value >> 6
                model.constraints.append(constraint)
            for number, terms, source in given.relations:
                at, there = nodes.of(terms[:, 0].astype(np.int64))
                if there.all():
                    dofs_of = terms[:, 1].astype(np.int64)
                    model.equations.append(Equation(at, dofs_of, terms[:, 2].copy(), number, source))
                else:
                    missing += 1
        if not self.found:
            return
        path = self.found[0].source.file
        for count, what in (
            (self.geometry, "constraints on geometry"),
            (missing, "constraints of nodes that are not there"),
            (self.skipped, "lines behind the constraints"),
        ):
            if count:
                model.warnings.append(f"{path}: {count} {what} are not read")
        if len(self.found) > 1:
            said = "all are read, where a run of FEMAP has one of them"
            model.warnings.append(f"{path}: {len(self.found)} constraint sets: {said}")


def _relation(cursor: Cursor) -> tuple[int, Floats, Source]:
    """Number, colour, layer; how many terms; a line a term."""
    source = cursor.source
    number = cursor.integers(1, "a relation's number", 1)[0]
    rows = cursor.take(cursor.count("terms"), "a relation's terms")
    terms = cursor.lines.table(rows, 3, "a relation's terms", 3)
    degrees = cursor.lines.whole(terms[:, :2], rows, 1, "a number of a node or a degree of freedom")[:, 1]
    if degrees.max(initial=1) > 6:
        row = int(rows[int(np.argmax(degrees > 6))])
        cursor.lines.fail(row, "not a degree of freedom", str(int(degrees.max())), "1 to 6")
    return number, terms, source
