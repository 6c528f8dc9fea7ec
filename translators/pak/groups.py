"""Element groups of a PAK deck (card 13): a section, its parts, and a block of elements of each kind."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from zrno.translators.control import FemControl
from zrno.translators.model import ElementBlock, Ints, Model, Part, Section, Source
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.elements import MIRRORED, PLANES, SHELLS, SOLIDS, TYPES, Type, inside_out
from zrno.translators.pak.generate import Series, read_series
from zrno.translators.pak.kinds import Elements, kinds_of
from zrno.translators.pak.laws import ORTHOTROPIC
from zrno.translators.pak.materials import Numbers
from zrno.translators.pak.nodes import Numbering
from zrno.translators.pak.plan import distinct
from zrno.translators.text import Block, Card, Cards, Layout

_CHUNK = 250_000  # elements read at a time
_PLANE = {0: "stress", 1: "axisymmetric", 2: "strain"}
_REPEATED = ("IPRCO", "ISNA", "IPGS")  # 0 repeats the last element's, below 0 is 0
_KEPT = ("NETIP", "IATYP", "INDKOV", "ISTRESS", "COEF1", "COEF2", "COEF3")


class Groups:
    """Reads the groups of a deck."""

    def __init__(
        self, cards: Cards, model: Model, control: FemControl, numbering: Numbering, materials: Numbers, size: int
    ) -> None:
        self.cards = cards
        self.model = model
        self.control = control
        self.numbering = numbering
        self.materials = materials
        self.size = size
        self.linear = True
        self._last: dict[str, int] = {}  # of each family, the largest element number

    def read(self, count: int) -> None:
        """All groups."""
        for number in range(1, count + 1):
            self._group(number)
        families = {block.family for block in self.model.blocks}
        flat = bool((self.model.xyz[:, 2] == self.model.xyz[0, 2]).all())
        in_space = any(s.kind == "plane" and not s.plane for s in self.model.sections.values())
        self.model.dimension = 2 if families == {"plane"} and flat and not in_space else 3

    def warn(self, line: int, text: str) -> None:
        """Note a warning of the deck."""
        self.model.warnings.append(f"{self.cards.faults.path}:{line}: {text}")

    def _group(self, number: int) -> None:
        card = self.cards.card(layouts.group(self.control.wide), f"card 13, element group {number}")
        card.check("NETIP", card["NETIP"] in TYPES, "this element type is not read",
                   f"one of {', '.join(map(str, TYPES))}")  # fmt: skip
        card.check("NE", card["NE"] > 0, "no elements", "the number of elements, 1 or more")
        card.check("IATYP", -5 <= card["IATYP"] <= 5, "no such analysis of a group", "-5 to 5")
        card.check("NMODM", any(model == card["NMODM"] for model, _ in self.materials), "no material of this model",
                   "a model of card 11")  # fmt: skip
        self.cards.faults.stop()
        self.linear &= card["IATYP"] == 0
        kind = TYPES[card["NETIP"]]
        native: dict[str, Any] = {name: card[name] for name in _KEPT if name in ("NETIP", "IATYP") or card[name]}
        section = Section(number, kind=kind.family, native=native, source=Source(self.cards.faults.path, card.line))
        self.model.sections[number] = section
        self._head(card, section)
        pieces = list(self._elements(card, kind, section))
        elements = Elements(
            np.concatenate([p.ids for p in pieces]),
            np.concatenate([p.nmat for p in pieces]),
            _joined([p.nodes for p in pieces]),
            {name: np.concatenate([p.fields[name] for p in pieces]) for name in pieces[0].fields},
            pieces[0].line,
        )
        del pieces
        self._finish(card, kind, section, elements)

    def _head(self, card: Card, section: Section) -> None:
        """The group's own card, and what it asks for."""
        netip, native = card["NETIP"], section.native
        layout = (
            layouts.SOLID_GROUP if netip in SOLIDS else layouts.PLANE_GROUP if netip in PLANES
            else layouts.SHELL_GROUP if netip in SHELLS else None
        )  # fmt: skip
        if layout is not None:
            head = self.cards.card(layout, "the card of the element group")
            for f in layout.fields.values():
                if f.kind != "a" and (head[f.name] or f.name.startswith("NGAUS") or f.name in ("IALFA", "IETYP")):
                    native[f.name] = head[f.name]
            head.check("MSET", head["MSET"] >= 0, "MSET is negative", "0, or the number of layered materials")
            if netip in PLANES:
                head.check("IETYP", 0 <= head["IETYP"] <= 4, "no such plane problem", "0 to 4")
            self.cards.faults.stop()
            if netip in PLANES:
                section.plane = _PLANE.get(native.pop("IETYP"), "")
                if not section.plane:
                    native["IETYP"] = head["IETYP"]
            if netip in SOLIDS and card["NMODM"] in ORTHOTROPIC:
                axes = self.cards.card(layouts.MATERIAL_AXES, "the material axes of the group")
                native["axes"] = tuple(axes[name] for name in layouts.MATERIAL_AXES.fields)
            layers = [self._layers() for _ in range(min(head["MSET"], self.cards.left + 1))]
            if layers:
                native["layers"] = layers
        elif section.kind == "beam":
            self._beam(section)

    def _layers(self) -> list[tuple[int, float, float]]:
        head = self.cards.card(layouts.LAYERS, "the number of layers of a layered material")
        head.check("NSLOJ", head["NSLOJ"] > 0, "no layers", "1 or more")
        self.cards.faults.stop()
        block = self.cards.block(layouts.LAYER, head["NSLOJ"], "a layer")
        return list(zip(*(block[name].tolist() for name in layouts.LAYER.fields), strict=True))

    def _beam(self, section: Section) -> None:
        head = self.cards.card(layouts.BEAM_GROUP, "the card of the beams")
        head.check("NT", head["NT"] == 0, "the cross-section of a thin-walled beam is not read", "0")
        self.cards.faults.stop()
        card = self.cards.card(layouts.BEAM_SECTION, "the cross-section of the beams")
        section.native |= {name: head[name] for name in layouts.BEAM_GROUP.fields if head[name] or name == "NTIP"}
        names = {"POVR": "area", "YI": "iyy", "ZI": "izz", "TK": "j"}
        section.parameters = {name: card[key] for key, name in names.items()}
        section.native |= {name: card[name] for name in layouts.BEAM_SECTION.fields if card[name] and name not in names}

    # Elements

    def _elements(self, card: Card, kind: Type, section: Section) -> Iterator[Elements]:
        """The elements, some at a time; generation needs all of a group at once."""
        wide, netip, left = self.control.wide, card["NETIP"], card["NE"]
        cards: Sequence[Layout]
        if kind.family == "beam":
            cards, key = [layouts.beam(wide)], (0, "n1")
        elif kind.family == "truss":
            cards, key = [layouts.truss(wide), layouts.nodes(wide, 1, 2)], (1, "n1")
        elif netip in SOLIDS:
            more = layouts.nodes(wide, kind.corners + 1, kind.most)
            cards, key = [layouts.solid(wide), layouts.nodes(wide, 1, kind.corners), more], (1, "n1")
        else:
            cards, key = [layouts.flat(wide), layouts.nodes(wide, 1, kind.most)], (1, "n1")
        generated = kind.family != "beam" and self.cards.probe(cards[0].only("KORC"), left, len(cards))["KORC"].any()
        before: dict[str, Any] = {}
        done = 0
        while left:
            some = left if generated else min(left, _CHUNK)
            if not generated:
                self._refuse_short(cards, some, kind)
            line = self.cards.next_line
            if kind.family == "beam":
                blocks = self.cards.blocks(cards, some, "an element")
                series = Series(blocks, *[np.arange(some), *[np.zeros(some, np.int64)] * 2, np.arange(some)])
            elif netip in SOLIDS and not self.cards.lengths(some, 3, 2).any():
                empty = [cards[0], cards[1], Layout("a1", "nothing")]
                series = read_series(self.cards, empty, some, "an element", key=key, size=self.size)
            else:
                series = read_series(self.cards, cards, some, "an element", key=key, size=self.size)
            piece = self._piece(series, kind, before, done, line)
            before = {name: values[-1] for name, values in piece.fields.items()} | {"NMAT": piece.nmat[-1]}
            yield piece
            left -= some
            done += some

    def _refuse_short(self, cards: Sequence[Layout], count: int, kind: Type) -> None:
        """Lines that cannot hold an element's corners are a fault before anything large is made of them."""
        if len(cards) < 2:
            return
        width = 10 if self.control.wide else 5
        short = np.flatnonzero(self.cards.lengths(count, len(cards), 1) <= width * (kind.corners - 1))
        for i in short[:5].tolist():
            line = self.cards.line_of(i * len(cards) + 1)
            self.cards.faults.add(line, 1, "too short for an element's nodes",
                                  expected=f"{kind.corners} numbers of {width} columns")  # fmt: skip
        self.cards.faults.stop()

    def _piece(self, series: Series, kind: Type, before: dict[str, Any], done: int, line: int) -> Elements:
        blocks = series.blocks
        first = blocks[0]
        ids = series.numbers(first["NN"], by=1)
        first.check("NN", first["NN"] > 0, "an element's number is not positive", "a number from 1")
        if not self.control.free_numbering and first.sound("NN"):
            expected = np.arange(done + 1, done + len(ids) + 1)
            wrong = np.flatnonzero(ids != expected)
            if len(wrong):
                first.fault(int(series.card[wrong[0]]), "NN", "element number out of order", str(expected[wrong[0]]))
        fields: dict[str, Any] = {}
        for name in _REPEATED:
            if name in first.values:
                fields[name] = _repeat(first[name], before.get(name, -1 if name != "ISNA" else 0))
        if "THI" in first.values:
            fields["THI"] = _repeat(first["THI"], before.get("THI", 1.0))
        for name in ("BTH", "DTH", "APR", "NAP", "CTR1", "CTR2", "CTR3", "t2", "t3", "t4"):
            if name in first.values:
                fields[name] = first[name]
        nmat = _repeat(first["NMAT"], before.get("NMAT", 1))
        columns: list[Ints] = []
        for block in blocks:
            for name in block.values:
                if name[0] == "n" and name[1:].isdigit():
                    columns.append(self._nodes(series, block, name, corner=int(name[1:]) <= kind.corners))
        self.cards.faults.stop()
        if series.generated:
            nmat = series.take(nmat)
            fields = {name: series.take(values) for name, values in fields.items()}
        return Elements(ids, nmat, np.column_stack(columns), fields, line)

    def _nodes(self, series: Series, block: Block, name: str, *, corner: bool) -> Ints:
        own = self.numbering.checked(block, name, absent=not corner)
        if not series.generated:
            return own
        made = series.numbers(block[name])
        indices = self.numbering.indices(made)
        bad = (indices < 0) & (made != 0)
        if bad.any():
            block.fault(int(series.card[np.argmax(bad)]), name, "a node that generation asks for is not there")
        return indices

    def _finish(self, card: Card, kind: Type, section: Section, e: Elements) -> None:
        """Parts and blocks of a group's elements."""
        model, number = self.model, section.id
        parts: dict[int, int] = {}
        for nmat in distinct(e.nmat).tolist():
            material = self.materials.get((card["NMODM"], nmat))
            if material is None:
                card.fault("NMODM", f"an element's material {nmat} is not among those of this model")
                continue
            part = len(model.parts) + 1
            dimension = 3 if kind.family == "solid" else 2 if kind.family in ("plane", "shell") else 1
            model.parts[part] = Part(part, material=material, section=number, dimension=dimension,
                                     source=section.source, native={"NMAT": nmat})  # fmt: skip
            parts[nmat] = part
        self.cards.faults.stop()
        owners = np.zeros(int(e.nmat.max()) + 1, np.int64)
        owners[list(parts)] = list(parts.values())
        part_of = owners[e.nmat]
        last = self._last.get(kind.family, 0)
        if last and (not self.control.free_numbering or len(np.intersect1d(e.ids, self._ids(kind.family)))):
            if self.control.free_numbering:
                self.warn(e.line, f"element numbers of group {number} stand in another group too: {last} is added")
            e.ids = e.ids + last
        self._last[kind.family] = max(last, int(e.ids.max()))
        data = self._data(card, kind, section, e)
        for name, rows, nodes, more in kinds_of(card["NETIP"], kind, e, self.model.xyz, self.cards.faults, self.warn):
            nodes = self._turned(name, nodes, number, e.line)
            own = {key: values[rows] for key, values in data.items()} | more
            model.blocks.append(ElementBlock(name, e.ids[rows], nodes, part_of[rows], kind.family, own))

    def _ids(self, family: str) -> Ints:
        return np.concatenate([b.ids for b in self.model.blocks if b.family == family])

    def _data(self, card: Card, kind: Type, section: Section, e: Elements) -> dict[str, Any]:
        """What the elements have of their own; what all have alike goes to the section."""
        f, data = e.fields, {}
        for name in _REPEATED:
            if name in f:
                values = np.maximum(f[name], 0)
                if values.any():
                    if (values == values[0]).all():
                        section.native[name] = int(values[0])
                    else:
                        data[name] = values
        for name, key, switch in (("BTH", "birth", "INDBTH"), ("DTH", "death", "INDDTH")):
            if card[switch] == 1:
                data[key] = f[name]
            elif f[name].any():
                self.warn(e.line, f"the {key} times of group {section.id} are not used: {switch} is not 1")
        if "THI" in f:
            data["thickness"] = f["THI"]
            if any(f[name].any() for name in ("t2", "t3", "t4")):
                data["thickness"] = np.column_stack(
                    [f["THI"], *(np.where(f[name] == 0, f["THI"], f[name]) for name in ("t2", "t3", "t4"))]
                )
        if "APR" in f:
            if (f["APR"] == f["APR"][0]).all():
                section.parameters["area"] = float(f["APR"][0])
            else:
                data["area"] = f["APR"]
        if "CTR1" in f:
            point = np.column_stack([f["CTR1"], f["CTR2"], f["CTR3"]])
            data["orientation"] = point - self.model.xyz[e.nodes[:, 0]]
            if f["NAP"].any():
                data["NAP"] = f["NAP"]
        return data

    def _turned(self, kind: str, nodes: Ints, group: int, line: int) -> Ints:
        """Solids with positive volume: PAK stops at others."""
        if kind not in MIRRORED:
            return nodes
        wrong = inside_out(kind, nodes, self.model.xyz)
        if len(wrong):
            nodes = nodes.copy()
            nodes[wrong] = nodes[wrong][:, list(MIRRORED[kind])]
            self.warn(line, f"{len(wrong)} {kind} of group {group} are inside out, where PAK stops: turned")
        return nodes


def _joined(nodes: list[Ints]) -> Ints:
    """Nodes of pieces, of which some may have none after the corners."""
    if len(nodes) == 1:
        return nodes[0]
    most = max(some.shape[1] for some in nodes)
    if all(some.shape[1] == most for some in nodes):
        return np.concatenate(nodes)
    return np.concatenate([np.pad(some, ((0, 0), (0, most - some.shape[1])), constant_values=-1) for some in nodes])


def _repeat(values: Any, first: Any) -> Any:
    """Values where 0 repeats the one before; first: before all."""
    if values.all():
        return values
    place = np.maximum.accumulate(np.where(values != 0, np.arange(1, len(values) + 1), 0))
    return np.concatenate(([first], values)).astype(values.dtype)[place]
