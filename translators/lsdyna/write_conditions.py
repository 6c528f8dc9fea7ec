"""Curves, systems, sets, constraints, loads, motions, velocities and contacts as cards."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.lsdyna.cards_out import Card, Writer
from zrno.translators.lsdyna.control import TARGETS
from zrno.translators.model import (
    Constraint,
    Contact,
    Curve,
    FaceLoad,
    InitialVelocity,
    Ints,
    Model,
    NodalLoad,
    NodeSet,
    PartSet,
    SegmentSet,
)
from zrno.translators.report import Report

_VAD = {"velocity": 0, "acceleration": 1, "displacement": 2}
_DOFS = {1: 1, 2: 2, 3: 3, 4: 5, 5: 6, 6: 7}
_SETS = {"solid": "SET_SOLID", "shell": "SET_SHELL_LIST", "plane": "SET_SHELL_LIST", "beam": "SET_BEAM",
         "truss": "SET_BEAM", "tshell": "SET_TSHELL", "spring": "SET_DISCRETE"}  # fmt: skip
_SPC = "target/i cid/i dofs/i*6"
_MOTION = "target/i dof/i vad/i lcid/i sf vid/i death birth"
_LOAD = "target/i dof/i lcid/i sf cid/i"
_CONTACT_SECOND = ("fs", "fd", "dc", "vc", "vdc", "penchk", "bt", "dt")


class Conditions:
    """The model's conditions; sets and curves that they need and the model lacks are made."""

    def __init__(self, model: Model, writer: Writer, report: Report) -> None:
        self.model, self.writer, self.report = model, writer, report
        self.numbers = model.node_ids if len(model.node_ids) == len(model.xyz) else np.arange(1, len(model.xyz) + 1)
        self.curves = dict(model.curves)
        self.part_sets = list(model.part_sets)
        self.constant: int | None = None
        self.largest: dict[str, int] = {}  # number of each kind of set
        self.node_sets: dict[int, NodeSet] = {}
        for one in reversed(model.node_sets):  # the first of a number is what it means
            self.node_sets[one.id] = one
        self.segment_sets = {one.id: one for one in reversed(model.segment_sets)}

    def pieces(self) -> Iterator[bytes]:
        """All keywords; what others refer to is made while they are."""
        made = [
            *(self._constraint(c) for c in self.model.constraints),
            *(piece for load in self.model.nodal_loads for piece in self._nodal(load)),
            *(self._faces(load) for load in self.model.face_loads),
            *self._body(),
            *(self._initial(v) for v in self.model.initial_velocities),
            *(self._contact(c) for c in self.model.contacts),
        ]
        for curve in self.curves.values():
            yield self._curve(curve)
        yield from self._systems()
        yield from self._sets()
        yield from made

    # What is referred to

    def _titled(self, name: str, title: str, cards: Sequence[Card]) -> bytes:
        if title:
            return self.writer.keyword(f"{name}_TITLE", [title[:80], *cards])
        return self.writer.keyword(name, cards)

    def _curve(self, curve: Curve) -> bytes:
        head: Card = ("lcid/i", {"lcid": curve.id})
        points: list[Card] = [("point/20*2", {"point": point}) for point in curve.points.tolist()]
        return self._titled("DEFINE_CURVE", curve.name, [head, *points])

    def _systems(self) -> Iterator[bytes]:
        for system in self.model.systems.values():
            if system.kind != "rectangular":
                self.report.drop("coordinate systems", 1, f"system {system.id} is {system.kind}")
                continue
            origin = system.origin
            first: Card = ("cid/i o*3 l*3", {"cid": system.id, "o": origin, "l": origin + system.axes[0]})
            yield self._titled(
                "DEFINE_COORDINATE_SYSTEM", system.name, [first, ("p*3", {"p": origin + system.axes[1]})]
            )

    def _sets(self) -> Iterator[bytes]:
        seen: set[tuple[str, int]] = set()
        model = self.model
        every: list[tuple[str, Any, Ints]] = [
            *(("SET_NODE_LIST", s, self.numbers[s.nodes]) for s in model.node_sets),
            *((_SETS.get(s.family, ""), s, s.elements) for s in model.element_sets),
            *(("SET_PART_LIST", s, s.parts) for s in self.part_sets),
        ]
        for name, one, _ in every:
            self.largest[name] = max(self.largest.get(name, 0), one.id)
        self.largest["SET_SEGMENT"] = max((s.id for s in model.segment_sets), default=0)
        for name, one, members in every:
            if not name:
                self.report.drop("element sets", 1, f"a keyword deck has no sets of {one.family or 'mixed'} elements")
                continue
            number = self._free_number(seen, name, one.id, one.name)
            head: list[Card] = [*([one.name[:80]] if one.name else []), ("sid/i", {"sid": number})]
            title = "_TITLE" if one.name else ""
            yield self.writer.keyword(name + title, head) + self._list(members)
        for segments in model.segment_sets:
            yield self._segment_set(segments, seen)

    def _free_number(self, seen: set[tuple[str, int]], kind: str, number: int, name: str) -> int:
        if number <= 0 or (kind, number) in seen:
            new = 1 + max([self.largest.get(kind, 0), *(n for k, n in seen if k == kind)])
            self.report.notes.append(f"set {name or number} is numbered {new}: its number stood twice, or was none")
            number = new
        seen.add((kind, number))
        return number

    def _list(self, members: Ints) -> bytes:
        """Numbers, eight a line; what is wider than ten columns cannot be (the largest is checked)."""
        texts = [f"{n:10d}" for n in members.tolist()]
        return "".join("".join(texts[i : i + 8]) + "\n" for i in range(0, len(texts), 8)).encode()

    def _segment_set(self, one: SegmentSet, seen: set[tuple[str, int]]) -> bytes:
        number = self._free_number(seen, "SET_SEGMENT", one.id, one.name)
        head: list[Card] = [*([one.name[:80]] if one.name else []), ("sid/i", {"sid": number})]
        piece = self.writer.keyword("SET_SEGMENT" + ("_TITLE" if one.name else ""), head)
        nodes = self.numbers[one.segments]
        return piece + "".join("".join(f"{n:10d}" for n in row) + "\n" for row in nodes.tolist()).encode()

    def _lcid(self, curve: int | None, native: bool = True) -> int:
        """A curve's number; where there is none, a constant one is made for decks of other formats."""
        if curve is not None:
            return curve
        if self.model.format == "lsdyna" and native:
            return 0
        if self.constant is None:
            self.constant = max(self.curves, default=0) + 1
            self.curves[self.constant] = Curve(self.constant, "constant", np.array([[0.0, 1.0], [1e20, 1.0]]))
        return self.constant

    def _of_set(self, number: int | None, nodes: Ints) -> bool:
        """Whether nodes are exactly those of a node set."""
        own = self.node_sets.get(number) if number is not None else None
        return own is not None and len(own.nodes) == len(nodes) and np.array_equal(np.sort(own.nodes), np.sort(nodes))

    # Constraints, loads, motions

    def _constraint(self, one: Constraint) -> bytes:
        name = "BOUNDARY_SPC_"
        cards: list[Any] = []
        limited = one.birth is not None or one.death is not None
        uniform = bool(len(one.dofs)) and bool((one.dofs == one.dofs[:1]).all())
        rows: list[tuple[int, NDArray[Any]]]
        if one.set is not None and uniform and self._of_set(one.set, one.nodes):
            name += "SET"
            rows = [(one.set, one.dofs[0])]
        else:
            name += "NODE"
            rows = list(zip(self.numbers[one.nodes].tolist(), one.dofs, strict=True))
        named = bool(one.id or one.name) and len(rows) == 1
        for target, dofs in rows:
            if named:
                cards.append(f"{one.id:10d}{one.name[:70]}".rstrip())
            cards.append((_SPC, {"target": target, "cid": one.system, "dofs": dofs.astype(int).tolist()}))
            if limited:
                cards.append(("birth death", {"birth": one.birth or 0.0, "death": one.death or 1e20}))
        if not rows:
            return b""
        return self._rows(name + "_BIRTH_DEATH" * limited + "_ID" * named, cards)

    def _rows(self, name: str, cards: list[Any]) -> bytes:
        """A keyword whose first line may be a number and a heading, which are no title."""
        piece = self.writer.keyword(name, [card for card in cards if not isinstance(card, str)])
        if not any(isinstance(card, str) for card in cards):
            return piece
        lines = piece.decode().split("\n")
        width = 20 if lines[0].endswith(" +") else 10
        head = cards[0]
        lines.insert(1, head[:10].rjust(width) + head[10:])
        return "\n".join(lines).encode()

    def _nodal(self, load: NodalLoad) -> Iterator[bytes]:
        if load.kind not in (*_VAD, "force"):
            self.report.drop(f"{load.kind}s of nodes", len(load.nodes), "not written to a keyword deck")
            return
        lcid = self._lcid(load.curve)
        uniform = len(np.unique(load.dofs)) == 1 and len(np.unique(load.values)) == 1
        rigid = load.native.get("rigid_part")
        dofs, values = load.dofs.tolist(), load.values.tolist()
        if rigid is not None and (uniform or not len(dofs)):
            kind, targets = "RIGID", [int(rigid)]
            dofs, values = dofs or [load.native["dof"]], values or [load.native["value"]]
        elif uniform and self._of_set(load.set, load.nodes):
            kind, targets = "SET", [int(load.set or 0)]
        else:
            kind, targets = "NODE", self.numbers[load.nodes].tolist()
        cards: list[Any] = []
        named = bool(load.id or load.name) and len(targets) == 1 and load.kind != "force"
        if named:
            cards.append(f"{load.id:10d}{load.name[:70]}".rstrip())
        if load.kind != "force" and load.system:
            self.report.drop("motions' systems", len(targets), "motions are along the global axes")
        for target, dof, value in zip(targets, dofs, values, strict=False):
            if load.kind == "force":
                fields = {"target": target, "dof": _DOFS[dof], "lcid": lcid, "sf": value, "cid": load.system}
                cards.append((_LOAD, fields))
                continue
            fields = {"target": target, "dof": _DOFS[dof], "vad": _VAD[load.kind], "lcid": lcid, "sf": value,
                      "death": load.death, "birth": load.birth}  # fmt: skip
            cards.append((_MOTION, fields))
        if not cards or (named and len(cards) == 1):
            return
        if load.kind == "force":
            if load.birth is not None or load.death is not None:
                self.report.drop("forces' times", len(targets), "forces begin and end by their curve alone")
            yield self.writer.keyword("LOAD_NODE_SET" if kind == "SET" else "LOAD_NODE_POINT", cards)
        else:
            yield self._rows(f"BOUNDARY_PRESCRIBED_MOTION_{kind}" + "_ID" * named, cards)

    def _faces(self, load: FaceLoad) -> bytes:
        if load.direction:
            self.report.drop("tractions on faces", len(load.faces), "a keyword deck has pressures alone")
            return b""
        if not len(load.faces):
            return b""
        values = load.values.mean(axis=1)
        self.report.approximate("pressures", int((np.ptp(load.values, axis=1) != 0).sum()), "one mean value a face")
        if (load.faces[:, :2] < 0).any() or load.faces.shape[1] < 3 or (load.faces[:, 2] < 0).any():
            self.report.drop("pressures on edges", len(load.faces), "a keyword deck has pressures on areas alone")
            return b""
        four = np.column_stack([load.faces[:, :4], load.faces[:, 2]])[:, :4]
        four[:, 3] = np.where(four[:, 3] < 0, four[:, 2], four[:, 3])
        lcid, at = self._lcid(load.curve), load.native.get("at")
        own = self.segment_sets.get(load.set) if load.set is not None else None
        named = "_ID" if load.id or load.name else ""
        cards: list[Any] = [f"{load.id:10d}{load.name[:70]}".rstrip()] if named else []
        if own is not None and np.array_equal(own.segments, four) and len(np.unique(values)) == 1:
            fields = {"ssid": own.id, "lcid": lcid, "sf": values[0], "at": at}
            return self._rows("LOAD_SEGMENT_SET" + named, [*cards, ("ssid/i lcid/i sf at", fields)])
        rows = [
            ("lcid/i sf at nodes/i*4", {"lcid": lcid, "sf": value, "at": at, "nodes": nodes})
            for value, nodes in zip(values.tolist(), self.numbers[four].tolist(), strict=True)
        ]
        if named and len(rows) > 1:
            named, cards = "", []
        return self._rows("LOAD_SEGMENT" + named, [*cards, *rows])

    def _body(self) -> Iterator[bytes]:
        limits = {load.parts for load in self.model.body_loads}
        for load in self.model.body_loads:
            lcid = self._lcid(load.curve)
            for axis, value in zip("XYZ", load.acceleration, strict=True):
                if value:
                    cards: list[Card] = [("lcid/i sf", {"lcid": lcid, "sf": -value})]
                    yield self.writer.keyword(f"LOAD_BODY_{axis}", cards)
        if len(limits) > 1:
            self.report.approximate(
                "body loads", len(self.model.body_loads), "a keyword deck has one set of loaded parts"
            )
        parts = next((p for p in limits if p is not None), None)
        if parts is not None:
            own = next((s for s in self.part_sets if tuple(s.parts.tolist()) == parts), None)
            if own is None:
                number = 1 + max((s.id for s in self.part_sets), default=0)
                own = PartSet(number, "under body loads", np.array(parts, np.int64))
                self.part_sets.append(own)
            yield self.writer.keyword("LOAD_BODY_PARTS", [("psid/i", {"psid": own.id})])

    def _initial(self, one: InitialVelocity) -> bytes:
        v, w = one.velocity, one.rotation if one.rotation is not None else np.zeros_like(one.velocity)
        if not len(v):
            return b""
        uniform = bool((v == v[0]).all() and (w == w[0]).all())
        everything = one.set is None and np.array_equal(one.nodes, np.arange(len(self.numbers)))
        if uniform and (everything or self._of_set(one.set, one.nodes)):
            cards: list[Card] = [("nsid/i", {"nsid": one.set or 0}), ("v*6", {"v": [*v[0], *w[0]]})]
            return self.writer.keyword("INITIAL_VELOCITY", cards)
        columns = [(self.numbers[one.nodes], 10), (v, 10)] + ([(w, 10)] if w.any() else [])
        return self.writer.table("INITIAL_VELOCITY_NODE", columns)

    def _contact(self, one: Contact) -> bytes:
        kept: dict[str, Any] = one.native.get("lsdyna", {})
        codes = {name: number for number, name in TARGETS.items()} | {"all": 5}
        types = []
        for i, (kind, _) in enumerate((one.a, one.b)):
            read = kept.get("types", [None, None])[i]
            same = read is not None and (TARGETS.get(read) == kind or kind in ("all", "other"))
            types.append(read if same else codes.get(kind, 5))
        boxes = kept.get("first", [0, 0, 0, 0])
        first = {"v": [one.a[1], one.b[1], *types, *boxes]}
        second = list(kept.get("second", [None] * 8))
        for i, value in enumerate((one.static, one.kinetic)):
            if value or (second[i] is not None and abs(second[i]) < 1e10):
                second[i] = value
        fields = {name: value for name, value in zip(_CONTACT_SECOND, second, strict=True) if value is not None}
        name = f"CONTACT_{one.kind or 'AUTOMATIC_SURFACE_TO_SURFACE'}"
        named = bool(one.id or one.name)
        cards: list[Any] = [f"{one.id:10d}{one.name[:70]}".rstrip()] if named else []
        cards += [("v/i*8", first), ("fs fd dc vc vdc penchk/i bt dt", fields)]
        more = kept.get("more") or [""]
        piece = self._rows(name + "_ID" * named, cards)
        if kept.get("widths", self.writer.widths.value) == "long" and kept.get("more"):
            self.report.approximate("contacts", 1, "further cards in long format are written as they were")
        return piece + ("\n".join(more) + "\n").encode("latin-1", "replace")
