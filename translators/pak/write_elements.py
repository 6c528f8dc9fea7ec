"""Writes the element groups of a PAK deck (card 13)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from zrno.translators.card_text import CardText
from zrno.translators.columns import integers, reals, same
from zrno.translators.control import FemControl
from zrno.translators.model import Floats, Ints, Model
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.elements import PLANES, SOLIDS, TYPES
from zrno.translators.pak.laws import ORTHOTROPIC
from zrno.translators.pak.plan import Group, Materials, Piece, distinct, elements_of
from zrno.translators.text import Layout

_CHUNK = 50_000  # elements formatted at a time
_PLANE = {"stress": 0, "axisymmetric": 1, "strain": 2}
_PLASTIC_POINTS = 5  # through the thickness of a shell that is not elastic
_NEWLINE = np.uint8(ord("\n"))
Text = Any  # (n, width) bytes


def heading(layout: Layout, card: str) -> str:
    """A comment that names a card's fields, at most 80 columns."""
    names = [name for name, f in layout.fields.items() if f.kind != "a"]
    return f"C {card} {','.join(names)}"[:80]


class ElementWriter:
    """Writes groups. numbers: (nodes + 1, width) text of each node's number, blank at the end."""

    def __init__(self, model: Model, control: FemControl, materials: Materials, numbers: Text, text: CardText) -> None:
        self.model = model
        self.control = control
        self.materials = materials
        self.numbers = numbers
        self.text = text
        self.width = 10 if control.wide else 5
        self._shown: set[str] = set()

    def group(self, group: Group, first: int | None) -> Iterator[bytes]:
        """A group's cards. first: the number of its first element where they run in order, else None: their own."""
        native, wide = group.native, self.control.wide
        births = {name: any(name in p.data for p in group.pieces) for name in ("birth", "death")}
        values = {"NETIP": group.netip, "NE": group.count, "IATYP": group.analysis, "NMODM": group.law,
                  "INDBTH": births["birth"], "INDDTH": births["death"]}  # fmt: skip
        kept = {name: native[name] for name in ("INDKOV", "ISTRESS", "COEF1", "COEF2", "COEF3") if name in native}
        yield self._card("/13/", layouts.group(wide), values | kept)
        yield from self._head(group)
        for piece in elements_of(group):
            for start in range(0, len(piece.ids), _CHUNK):
                rows = slice(start, start + _CHUNK)
                some = Piece(piece.kind, piece.ids[rows], piece.part[rows], piece.nodes[rows],
                             {name: column[rows] for name, column in piece.data.items()})  # fmt: skip
                ids = some.ids if first is None else np.arange(start + first, start + first + len(some.ids))
                before = {name: column[start - 1] if start else 0 for name, column in piece.data.items()}
                yield self._elements(group, some, ids, before, births)

    def _card(self, card: str, layout: Layout, values: dict[str, Any]) -> bytes:
        return f"{heading(layout, card)}\n{self.text.line(layout, values, f'card {card}')}\n".encode("ascii")

    def _head(self, group: Group) -> Iterator[bytes]:
        native, kind = group.native, TYPES[group.netip]
        section = group.section
        if kind.family == "truss":
            return
        if kind.family == "beam":
            if section is None:
                raise ValueError("beams need a section: area, iyy, izz, j")
            yield self._card("/13-6/", layouts.BEAM_GROUP, {"NTIP": 1} | native)
            names = {"POVR": "area", "YI": "iyy", "ZI": "izz", "TK": "j"}
            missing = [name for name in names.values() if name not in section.parameters]
            if missing:
                raise ValueError(f"section {section.id} {section.name}: a beam without {', '.join(missing)}")
            yield self._card(
                "/13-6/", layouts.BEAM_SECTION, native | {key: section.parameters[name] for key, name in names.items()}
            )
            return
        points = 1 if group.netip == 33 else 2
        quadratic = any(p.nodes.shape[1] > kind.corners for p in group.pieces)
        plain = group.collapsed or quadratic or group.netip in (33, 21, 81, 83, 84)
        values: dict[str, Any] = {"NGAUSX": points, "NGAUSY": points, "NGAUSZ": points, "IALFA": -1 if plain else 0}
        if quadratic and group.netip == 3:
            values |= {"NGAUSX": 3, "NGAUSY": 3, "NGAUSZ": 3}
        if quadratic and group.netip in (2, 8):
            values |= {"NGAUSX": 3, "NGAUSY": 3}
        if "points" in native and group.netip in (2, 3) and not group.collapsed:
            values |= dict.fromkeys(("NGAUSX", "NGAUSY", "NGAUSZ"), native["points"])
        if kind.family == "shell" and group.law > 2:
            values["NGAUSZ"] = _PLASTIC_POINTS
        values |= native
        if group.netip in PLANES:
            values["IETYP"] = _PLANE.get("" if section is None else section.plane, native.get("IETYP", 0))
            if section is not None and not section.plane and "IETYP" not in native:
                self.text.report.notes.append(f"section {section.id} {section.name}: plane stress, as none is said")
            yield self._card("/13-2/", layouts.PLANE_GROUP, values)
        elif group.netip in SOLIDS:
            yield self._card("/13-3/", layouts.SOLID_GROUP, values)
            if group.law in ORTHOTROPIC:
                axes = dict(zip(layouts.MATERIAL_AXES.fields, native.get("axes", (0.0,) * 6), strict=True))
                yield self._card("/13-3/", layouts.MATERIAL_AXES, axes)
        else:
            yield self._card("/13-8/", layouts.SHELL_GROUP, values)
        for layers in native.get("layers", ()):
            yield self._card("layers", layouts.LAYERS, {"NSLOJ": len(layers)})
            for layer in layers:
                yield self._card("layer", layouts.LAYER, dict(zip(layouts.LAYER.fields, layer, strict=True)))

    # Elements: bytes (n, width) side by side

    def _elements(
        self, group: Group, piece: Piece, ids: Ints, before: dict[str, Any], births: dict[str, bool]
    ) -> bytes:
        parts = distinct(piece.part)
        nmat = np.array([self._material(part) for part in parts.tolist()])[np.searchsorted(parts, piece.part)]
        native, count = group.native, len(ids)
        family = TYPES[group.netip].family
        number = integers(ids, self.width)
        line = np.full((count, 1), _NEWLINE)

        def option(name: str) -> Text:
            return integers(self._option(name, piece, native, before), 5)

        def times(gap: int) -> list[Text]:
            if not any(births.values()):
                return []
            columns = [
                real_column(piece.data.get(name, np.zeros(count)), 10, "times of birth and death", self.text)
                for name in ("birth", "death")
            ]
            return [_blank(count, gap), *columns]

        nodes = self._nodes(piece.nodes)
        if family == "beam":
            columns = [number, nodes, integers(nmat, 5), _blank(count, 5),
                       integers(piece.data.get("NAP", np.zeros(count)).astype(np.int64), 5), _blank(count, 5),
                       *self._orientation(piece), *times(0), line]  # fmt: skip
        elif family == "truss":
            area = self._given(piece, group, "area", "area")
            columns = [number, integers(nmat, 5), option("ISNA"), real_column(area, 10, "areas", self.text),
                       integers(np.zeros(count, np.int64), 5), *times(0), line, nodes, line]  # fmt: skip
        elif group.netip in SOLIDS:
            corners = TYPES[group.netip].corners
            columns = [number, integers(nmat, 5), option("IPRCO"), option("ISNA"), option("IPGS"),
                       integers(np.zeros(count, np.int64), 5), *times(10), line,
                       self._nodes(piece.nodes[:, :corners]), line, self._nodes(piece.nodes[:, corners:]),
                       line]  # fmt: skip
        else:
            thickness, others = self._thickness(piece, group)
            ends = times(0)
            if others and not ends:
                ends = [_blank(count, 20)]
            columns = [number, integers(nmat, 5), option("IPRCO"), option("ISNA"), option("IPGS"),
                       real_column(thickness, 10, "thicknesses", self.text), integers(np.zeros(count, np.int64), 5),
                       *ends, *others, line, nodes, line]  # fmt: skip
        return np.hstack(columns).tobytes()

    def _material(self, part: int) -> int:
        material = self.model.parts[part].material
        assert material is not None
        return self.materials.number[material]

    def _nodes(self, nodes: Ints) -> Text:
        return self.numbers[nodes].reshape(len(nodes), -1)

    @staticmethod
    def _option(name: str, piece: Piece, native: dict[str, Any], before: dict[str, Any]) -> Ints:
        """A print option: 0 repeats the last element's, so that none after some is -1."""
        values = piece.data.get(name)
        if values is None:
            return np.full(len(piece.ids), int(native.get(name, 0)))
        values = values.astype(np.int64)
        last = np.append(int(before.get(name, 0)), values[:-1])
        return np.where((values == 0) & (last != 0), -1, values)

    def _given(self, piece: Piece, group: Group, key: str, what: str) -> Floats:
        """A number of each element: its own, or the section's."""
        section = group.section
        default = 0.0 if section is None else section.parameters.get(key, 0.0)
        values = np.asarray(piece.data.get(key, np.zeros(len(piece.ids))), np.float64)
        values = np.where(np.isnan(values) | (values == 0), default, values)
        if not (values > 0).all():
            part = int(piece.part[np.argmin(values)])
            raise ValueError(f"part {part} {self.model.parts[part].name}: elements without {what}".replace(" :", ":"))
        return values

    def _thickness(self, piece: Piece, group: Group) -> tuple[Floats, list[Text]]:
        """Thickness, and that of the other corners where PAK reads it."""
        section = group.section
        own = np.asarray(piece.data.get("thickness", np.zeros(len(piece.ids))), np.float64)
        parameters = {} if section is None else section.parameters
        corners = [parameters.get(f"thickness_{k}", 0.0) for k in range(1, 5)]
        if own.ndim == 1 and not own.any() and "thickness" not in parameters and any(corners):
            own = np.tile(corners, (len(own), 1))
        if own.ndim == 2:
            if abs(group.analysis) >= 3 and group.law > 4 and own.shape[1] == 4 and group.family == "shell":
                return own[:, 0], [real_column(own[:, k], 5, "thicknesses at corners", self.text) for k in (1, 2, 3)]
            if np.ptp(own, axis=1).any():
                self.text.report.approximate("thicknesses that change in a shell", len(own), "their mean")
            own = own.mean(axis=1)
        if group.family == "plane" and "thickness" not in parameters and not own.any():
            return np.ones(len(own)), []  # plane strain is a slice of unit thickness
        piece = Piece(piece.kind, piece.ids, piece.part, piece.nodes, piece.data | {"thickness": own})
        return self._given(piece, group, "thickness", "thickness"), []

    def _orientation(self, piece: Piece) -> list[Text]:
        """The point that a beam's y axis looks to."""
        start = self.model.xyz[piece.nodes[:, 0]]
        node = piece.data.get("orientation_node")
        if "orientation" in piece.data:
            point = start + piece.data["orientation"]
        elif node is not None and (node >= 0).all():
            point = self.model.xyz[node.astype(np.int64)]
        else:
            raise ValueError("beams need an orientation")
        return [reals(point[:, axis], 10)[0] for axis in range(3)]


def _blank(count: int, width: int) -> Text:
    return np.full((count, width), np.uint8(ord(" ")))


def real_column(values: Any, width: int, what: str, text: CardText) -> Any:
    """Reals as a column of text; what is rounded is noted."""
    words, said = reals(np.asarray(values, np.float64), width)
    text.note(what, int((~same(said, values)).sum()))
    return words
