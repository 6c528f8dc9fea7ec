"""Writer of PAK's decks: numbers in columns with a point in each real, cards headed by comments naming the fields."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from zrno.translators.card_text import CardText
from zrno.translators.columns import integers, reals
from zrno.translators.control import FemControl
from zrno.translators.lost import report_lost
from zrno.translators.model import Ints, Model
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.control import control_rows
from zrno.translators.pak.laws import WARM, law_rows
from zrno.translators.pak.plan import plan_groups, plan_materials
from zrno.translators.pak.write_elements import ElementWriter, heading
from zrno.translators.pak.write_loads import LoadWriter
from zrno.translators.pak.write_nodes import (
    WIDEST_SHORT,
    codes_of,
    initial_rows,
    node_rows,
    relation_lines,
    relations_of,
    suppressed_of,
)
from zrno.translators.report import Report
from zrno.translators.text import Layout, write_atomically

_MOST_PERIODS = 100
_LONGEST_NAME = 20  # of a file, on PAK's input
_ROUNDING = 1e-10  # of the bounding box, that narrow coordinates may cost: volumes are kept to 1e-9
_SAID = {
    "title", "format", "version", "dimension", "node_ids", "xyz", "node_data", "blocks", "parts", "sections",
    "materials", "curves", "fixed", "constraints", "equations", "nodal_loads", "face_loads", "body_loads",
    "initial_velocities", "analysis", "fem_control", "includes", "warnings",
}  # fmt: skip
_NOWHERE = "a PAK deck has no place for it"


def write(model: Model, path: Path | str) -> Report:
    """Write the model's finite elements as a deck; the file appears whole or not at all.

    Returns what the deck cannot say. Raises ValueError for a model that no deck can be made of.
    """
    writer = _Writer(model)
    write_atomically(path, writer.chunks())
    if len(Path(path).name) > _LONGEST_NAME:
        writer.report.notes.append(f"{Path(path).name}: PAK takes names of at most {_LONGEST_NAME} characters")
    return writer.report


class _Writer:
    def __init__(self, model: Model) -> None:
        if not len(model.xyz):
            raise ValueError("the model has no nodes to write")
        if not np.isfinite(model.xyz).all():
            raise ValueError("a node's coordinate is not finite")
        self.model = model
        self.report = Report()
        self.text = CardText(self.report, pointed=True)
        self.materials = plan_materials(model, self.report)
        self.groups = plan_groups(model, self.report)
        if not self.groups:
            raise ValueError("the model has no finite elements that a PAK deck can say")
        self.ids = self._node_ids()
        self.first = self._first_numbers()
        self.control = self._control()
        self.codes = codes_of(model, self.control, self.groups, self.report)
        self.suppressed = suppressed_of(model, self.control, self.groups)
        self.relations = relations_of(model, self.codes, self.suppressed, self.report)
        linear = all(group.analysis == 0 for group in self.groups)
        self.loads = LoadWriter(model, self.ids, self.control, self.text, linear=linear)
        self.loads.report_others()
        report_lost([model], _SAID, "", _NOWHERE, self.report)
        report_lost(model.parts.values(), {"id", "name", "material", "dimension", "source", "section", "native"},
                    "part", _NOWHERE, self.report)  # fmt: skip

    def chunks(self) -> Iterator[bytes]:
        """The deck's text, in pieces; the report is complete after the last."""
        model, control = self.model, self.control
        yield _joined(["C /1/ NASLOV", self._title()])
        counts = (len(self.ids), len(self.groups), len(self.materials.models))
        for card, layout, values in control_rows(control, *counts, self.suppressed):
            yield self._card(card, layout, values)
        yield from node_rows(model, self.ids, self.codes, control, self.text)
        yield _joined(relation_lines(self.relations, self.ids, control, self.text))
        yield from initial_rows(model, self.ids, control, self.text)
        yield from self._materials()
        numbers = np.vstack([integers(self.ids, 10 if control.wide else 5), self._no_number()])
        elements = ElementWriter(model, control, self.materials, numbers, self.text)
        for group in self.groups:
            yield from elements.group(group, None if control.free_numbering else 1)
        yield from self.loads.chunks()
        yield _joined(["C /16/", "STOP"])
        self.text.report_rounded()

    def _card(self, card: str, layout: Layout, values: dict[str, Any]) -> bytes:
        return _joined([heading(layout, card), self.text.line(layout, values, f"card {card}")])

    def _no_number(self) -> Any:
        return np.full((1, 10 if self.control.wide else 5), np.uint8(ord(" ")))

    def _title(self) -> str:
        title = self.text.ascii(self.model.title, 79, "title")
        return f" {title}" if title[:1] in ("C", "c") else title  # else it could be a comment

    # Numbers

    def _node_ids(self) -> Ints:
        ids, count = self.model.node_ids, len(self.model.xyz)
        if len(ids) == count and ids.min() > 0 and ((np.diff(ids) > 0).all() or len(np.unique(ids)) == count):
            return ids
        self.report.approximate("node numbers", count, f"1 to {count}: the model's are not positive or not different")
        return np.arange(1, count + 1)

    def _first_numbers(self) -> bool:
        """Whether the elements are numbered as a deck without numbers of its own is read: on and on in a family."""
        last: dict[str, int] = {}
        for group in self.groups:
            ids = np.concatenate([piece.ids for piece in group.pieces])
            if len(group.pieces) > 1:
                ids = np.sort(ids)
            start = last.get(group.family, 0) + 1
            if not np.array_equal(ids, np.arange(start, start + len(ids))):
                return False
            last[group.family] = start + len(ids) - 1
        return True

    def _control(self) -> FemControl:
        model, analysis = self.model, self.model.analysis
        control = model.fem_control or FemControl(dynamic=int(analysis.kind == "dynamic"))
        periods = control.periods or [_one_period(analysis.end_time, analysis.initial_step)]
        if len(periods) > _MOST_PERIODS:
            raise ValueError(f"{len(periods)} periods of steps: PAK takes {_MOST_PERIODS}")
        largest = max(int(self.ids.max()), *(int(p.ids.max()) for g in self.groups for p in g.pieces), len(self.ids))
        smallest = min(int(p.ids.min()) for g in self.groups for p in g.pieces)
        if smallest < 1:
            raise ValueError(f"an element's number is not positive: {smallest}")
        ordered = bool(np.array_equal(self.ids, np.arange(1, len(self.ids) + 1)))
        wide = control.wide or largest > WIDEST_SHORT or not self._fits()
        free = control.free_numbering or not ordered or not self.first
        return replace(control, wide=wide, free_numbering=free, free_format=False, periods=periods)

    def _fits(self) -> bool:
        """Whether ten columns hold the coordinates closely."""
        xyz = self.model.xyz
        size = float(np.linalg.norm(np.ptp(xyz, axis=0))) or float(np.abs(xyz).max())
        try:
            said = [reals(xyz[:, axis], 10)[1] for axis in range(3)]
        except ValueError:
            return False
        return bool(np.abs(np.column_stack(said) - xyz).max() <= _ROUNDING * size)

    # Materials

    def _materials(self) -> Iterator[bytes]:
        yield _joined([heading(layouts.MODEL, "/11/")])
        for law, materials in self.materials.models.items():
            points = max(int(m.native.get("NTFUN", 2 if law == WARM else 1)) for m in materials)
            values = {"MODEL": law, "materials": len(materials), "points": points + 2}
            yield _joined([self.text.line(layouts.MODEL, values, "card /11/")])
        for law, materials in self.materials.models.items():
            for material in materials:
                number = next(self.materials.number[k] for k, m in self.model.materials.items() if m is material)
                head: dict[str, Any] = {
                    "MOD": law,
                    "MAT": number,
                    "GUST": material.density,
                    "rest": material.native.get("rest"),
                }
                yield self._card("/12/", layouts.MATERIAL, head)
                for row in law_rows(material, law, self.report):
                    if isinstance(row, str):
                        yield _joined([row])
                    else:
                        layout, numbers = row
                        yield _joined([self._shortened(layout, numbers, f"material {material.id}")])
                report_lost([material], {"id", "name", "law", "density", "parameters", "source", "tables", "native"},
                            "material", _NOWHERE, self.report)  # fmt: skip

    def _shortened(self, layout: Layout, values: dict[str, Any], what: str) -> str:
        """A card without the spare fields at its end."""
        line = self.text.line(layout, values, what)
        named = [f.end for name, f in layout.fields.items() if values.get(name) or not name[-1].isdigit()]
        return line[: max(named)].rstrip()


def _one_period(end: float | None, step: float | None) -> tuple[int, float]:
    """Steps to an end, from what other formats say."""
    if not end or end <= 0:
        return 1, 1.0
    if not step or step <= 0 or step >= end:
        return 1, end
    steps = min(max(round(end / step), 1), WIDEST_SHORT)
    return steps, end / steps


def _joined(lines: Any) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode("ascii", "replace")
