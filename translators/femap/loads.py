"""Loads (blocks 407 and 507): sets of gravity, loads on nodes, pressures on elements, temperatures.

Sources: FemCon (M. Topalovic) for both, neu2fstr (FrontISTR) for 507. A set is: number, title, options, then structural
loads of 12 lines (407) or 7 (507) each until -1; 507: loads on geometry until -1; temperatures of nodes until -1, and
of elements until -1; from version 9.3 further lists.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from zrno.translators.femap.cursor import Cursor
from zrno.translators.femap.ids import Places, by_value
from zrno.translators.femap.topology import faces_of
from zrno.translators.model import BodyLoad, FaceLoad, Floats, Ints, Model, NodalLoad, Source

_OPTION_LINES, _FEWEST, _MOST = 9, 4, 16  # between the heat options and the first load: usual, and what is tried
_MOST_FUNCTION = 10**9
_SET_FIELDS = 5  # numbers of a set's third line
# 407's numbers of load types, as 507 has them
TYPES_407 = {1: 1, 2: 3, 3: 7, 5: 11, 6: 10, 7: 5, 8: 12, 10: 41, 11: 42, 13: 47, 14: 44, 15: 45, 16: 46}
_NAMES = {10: "heat flux on nodes", 11: "heat generation at nodes", 12: "nonlinear transient loads",
          41: "distributed line loads", 44: "heat flux on elements", 45: "convection", 46: "radiation",
          47: "heat generation in elements"}  # fmt: skip
# kinds of `NodalLoad`: 507's types of the degrees of freedom 1 to 3, and of 4 to 6
KINDS = {"force": (1, 2), "displacement": (3, 4), "velocity": (5, 6), "acceleration": (7, 8)}
PRESSURE = 42


@dataclass(slots=True)
class _Set:
    """number (n,), type (n,), system (n,), function (n,) of structural loads; flags (n, k): degree of freedom is loaded
    (or the face's number in the first); values (n, k); temperatures (m, 5): node, .., .., value, function."""

    number: int
    title: str
    source: Source
    gravity: list[float] = field(default_factory=list)
    functions: list[int] = field(default_factory=list)
    head: Ints = field(default_factory=lambda: np.zeros((0, 4), np.int64))
    flags: Ints = field(default_factory=lambda: np.zeros((0, 6), np.int64))
    values: Floats = field(default_factory=lambda: np.zeros((0, 6)))
    temperatures: Floats = field(default_factory=lambda: np.zeros((0, 6)))


@dataclass(slots=True)
class LoadSets:
    """Sets as they are read; said: what is not read, with counts."""

    found: list[_Set] = field(default_factory=list)
    said: Counter[str] = field(default_factory=Counter)

    def read(self, cursor: Cursor) -> None:
        """A block of load sets."""
        while not cursor.done:
            source = cursor.source
            number = cursor.integers(1, "a load set's number", 1)[0]
            new = _Set(number, cursor.title(), source)
            self.found.append(new)
            self._options(cursor, new)
            if cursor.block.number == 407:
                self._structural_407(cursor, new)
            else:
                self._structural_507(cursor, new)
                self.said["lines of loads on geometry"] += self._pass_list(cursor)
            new.temperatures = self._temperatures(cursor)
            self.said["temperatures of elements"] += len(self._temperatures(cursor))
            self.said["lines behind the loads"] += cursor.pass_to_set(_SET_FIELDS)

    def _options(self, cursor: Cursor, new: _Set) -> None:
        """What stands before the loads: gravity is kept."""
        _, _, temperature, gravity, spin = cursor.numbers(_SET_FIELDS, "options of a load set")[:5]
        new.gravity = cursor.numbers(3, "gravity")[:6]
        new.functions = [int(value) for value in new.gravity[3:] if value.is_integer() and abs(value) < _MOST_FUNCTION]
        turning = cursor.numbers(3, "rotational acceleration")
        cursor.skip(1, "an origin")
        omega = cursor.numbers(3, "a rotational velocity")
        if not gravity:
            self.said["gravity that is switched off"] += any(new.gravity[:3])
            new.gravity = []
        self.said["rotational accelerations"] += bool(gravity) and any(turning[:3])
        self.said["rotational velocities"] += bool(spin) and any(omega[:3])
        self.said["default temperatures"] += bool(temperature)
        cursor.skip(5, "heat options")

    def _pass_options(self, cursor: Cursor, lines: int) -> None:
        """Pass by options up to the first load; their number differs between versions."""
        rows = cursor.peek(_MOST + 2)
        counts = [len(cursor.lines.fields(int(row))) for row in rows]
        ends = [cursor.lines.begins_with_end(int(row)) for row in rows]
        tries = [_OPTION_LINES, *(k for k in range(_FEWEST, _MOST) if k != _OPTION_LINES)]
        for k in tries:
            if k < len(rows) and (ends[k] or self._is_load(counts[k:], lines)):
                cursor.at = int(rows[k])
                return
        cursor.fail("no loads behind the options of a load set", "loads, or a line that begins with -1")

    @staticmethod
    def _is_load(counts: list[int], lines: int) -> bool:
        """Whether lines with these counts of fields can begin a load."""
        if len(counts) < 3:
            return False
        if lines == 12:
            return counts[0] >= 5 and counts[1] == counts[2] == 2
        return counts[0] >= 5 and counts[1] == 3 and counts[2] >= 3

    def _structural_407(self, cursor: Cursor, new: _Set) -> None:
        """Heading, phase and coefficient, six lines of degree of freedom (or face) and value, four lines."""
        self._pass_options(cursor, 12)
        rows = cursor.records(12, "loads")
        lines = cursor.lines
        head = lines.whole(lines.table(rows, 6, "a load's first line", 2), rows)
        types = np.array([TYPES_407.get(number, -number) for number in head[:, 1].tolist()], np.int64)
        new.head = np.column_stack([head[:, 0], types, head[:, 4], head[:, 5]])
        pairs = [lines.table(cursor.below(rows, k), 2, "a load's values", 2) for k in range(2, 8)]
        new.flags = np.column_stack([lines.whole(p[:, :1], cursor.below(rows, k)) for k, p in enumerate(pairs, 2)])
        new.values = np.column_stack([p[:, 1] for p in pairs])

    def _structural_507(self, cursor: Cursor, new: _Set) -> None:
        """Heading, three degrees of freedom (or a face), values, functions, three lines."""
        self._pass_options(cursor, 7)
        rows = cursor.records(7, "loads")
        lines = cursor.lines
        head = lines.whole(lines.table(rows, 5, "a load's first line", 2), rows)
        below = [cursor.below(rows, k) for k in range(4)]
        functions = lines.whole(lines.table(below[3], 1, "a load's functions"), below[3])
        new.head = np.column_stack([head[:, 0], head[:, 1], head[:, 4], functions[:, 0]])
        new.flags = lines.whole(lines.table(below[1], 3, "a load's degrees of freedom"), below[1])
        new.values = lines.table(below[2], 3, "a load's values")

    @staticmethod
    def _pass_list(cursor: Cursor) -> int:
        """Pass by a list whose records are not known; how many lines it has."""
        passed = 0
        while not cursor.done and not cursor.at_end():
            passed += 1
            cursor.at += 1
        if not cursor.done:
            cursor.at += 1
        return passed

    @staticmethod
    def _temperatures(cursor: Cursor) -> Floats:
        """Number, colour, layer, value, and a function in the last field; where the set has this list."""
        if cursor.done or cursor.at_set(_SET_FIELDS):
            return np.zeros((0, 6))
        rows = cursor.records(1, "temperatures")
        values = cursor.lines.table(rows, 6, "temperatures", 4)
        cursor.lines.whole(values[:, :1], rows)
        return values

    def fill(self, model: Model, nodes: Places, elements: Places) -> None:
        """The model's loads."""
        for given in self.found:
            if any(given.gravity[:3]):
                self._gravity(model, given)
            types = given.head[:, 1]
            for kind in KINDS:
                mine = np.flatnonzero(np.isin(types, KINDS[kind]))
                self._nodal(model, given, kind, 3 * (types[mine] == KINDS[kind][1]), mine, nodes)
            self._pressures(model, given, np.flatnonzero(types == PRESSURE), elements)
            for number, some in by_value(types[~np.isin(types, [PRESSURE, *np.ravel([*KINDS.values()])])]):
                self.said[_NAMES.get(number, f"loads of type {abs(number)}")] += len(some)
            at, there = nodes.of(given.temperatures[:, 0].astype(np.int64))
            self.said["loads on nodes that are not there"] += int((~there).sum())
            if there.any():
                load = NodalLoad("temperature", at[there], np.zeros(there.sum(), np.int64),
                                 given.temperatures[there, 3].copy(), id=given.number, name=given.title,
                                 source=given.source)  # fmt: skip
                model.nodal_loads.append(load)
        if self.found:
            path = self.found[0].source.file
            model.warnings += [f"{path}: {count} {what}: not read" for what, count in self.said.items() if count]
            if len(self.found) > 1:
                said = "all are read, where a run of FEMAP has one of them"
                model.warnings.append(f"{path}: {len(self.found)} load sets: {said}")

    def _gravity(self, model: Model, given: _Set) -> None:
        x, y, z = given.gravity[:3]
        functions = {f for f, a in zip(given.functions, given.gravity[:3], strict=False) if a}
        curve = next(iter(functions)) if len(functions) == 1 else 0
        self.said["functions of gravity that differ"] += len(functions) > 1
        model.body_loads.append(BodyLoad((x, y, z), curve or None, source=given.source))

    def _nodal(self, model: Model, given: _Set, kind: str, add: Ints, mine: Ints, nodes: Places) -> None:
        """Loads of one kind, those with one function and system together; add: to numbers of degrees of freedom."""
        at, there = nodes.of(given.head[mine, 0])
        self.said["loads on nodes that are not there"] += int((~there).sum())
        mine, at, add = mine[there], at[there], add[there]
        pairs, inverse = np.unique(given.head[mine, 2:], axis=0, return_inverse=True)
        for which, some in by_value(inverse.reshape(-1)):
            load, dof = np.nonzero(given.flags[mine[some]])
            if len(load):
                system, curve = pairs[which].tolist()
                terms = (at[some][load], dof + 1 + add[some][load], given.values[mine[some]][load, dof])
                new = NodalLoad(kind, *terms, curve or None, given.number, given.title, None, system)
                new.source = given.source
                model.nodal_loads.append(new)

    def _pressures(self, model: Model, given: _Set, which: Ints, elements: Places) -> None:
        """Pressures on faces, those with one function together."""
        _, there = elements.of(given.head[which, 0])
        self.said["pressures on elements that are not there"] += int((~there).sum())
        which = which[there]
        faces, values = np.full((len(which), 4), -1), given.values[which, :1]
        done = np.zeros(len(which), bool)
        for block in model.blocks:
            at, mine = Places(block.ids).of(given.head[which, 0])
            for number, corners in enumerate(faces_of(block.kind), 1):
                hit = np.flatnonzero(mine & (given.flags[which, 0] == number))
                faces[hit, : len(corners)] = block.nodes[at[hit]][:, list(corners)]
                done[hit] = True
        self.said["pressures on faces that are not known"] += int((~done).sum())
        which, faces, values = which[done], faces[done], values[done]
        for curve, some in by_value(given.head[which, 3]):
            load = FaceLoad(faces[some], values[some], curve=curve or None)
            load.id, load.name, load.source = given.number, given.title, given.source
            model.face_loads.append(load)
