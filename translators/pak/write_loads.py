"""Writes time functions (card 14) and loads (card 15) of a PAK deck."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from zrno.translators.card_text import CardText
from zrno.translators.columns import integers
from zrno.translators.control import FemControl
from zrno.translators.lost import report_lost
from zrno.translators.model import BodyLoad, Curve, FaceLoad, Ints, Model, NodalLoad, Section
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.control import end_time
from zrno.translators.pak.edges import nodal_forces
from zrno.translators.pak.write_elements import heading, real_column
from zrno.translators.pak.write_nodes import WIDEST_SHORT
from zrno.translators.text import Layout

_MOST_BODY_LOADS = 10
_ALWAYS = -1  # stands for the function that is 1 at all times
_NO_PLACE = "a PAK deck has no place for it"
Text = Any  # (n, width) bytes


class LoadWriter:
    """Writes the loads of a model. ids: numbers of the nodes; linear: whether all groups are."""

    def __init__(self, model: Model, ids: Ints, control: FemControl, text: CardText, *, linear: bool) -> None:
        self.model = model
        self.ids = ids
        self.control = control
        self.text = text
        self.report = text.report
        self.linear = linear
        self.nodal = {kind: list(self._nodal(kind)) for kind in ("force", "temperature", "displacement")}
        self.lines, self.faces = self._face_loads()
        self.bodies = self._body_loads()
        self.functions = self._functions()

    def chunks(self) -> Iterator[bytes]:
        """Cards 14 and 15."""
        yield from self._function_lines()
        wide = self.control.wide
        totals = [not load.native.get("incremental") for load in self.nodal["displacement"]]
        sign = 1 if not totals or totals[0] == self.linear else -1
        counts = {
            "NCF": _count(self.nodal["force"]), "NPP2": sum(len(load.faces) for load in self.lines),
            "NPP3": sum(len(load.faces) for load in self.faces), "NTEMP": _count(self.nodal["temperature"]),
            "NZADP": sign * _count(self.nodal["displacement"]), "INDZS": len(self.bodies),
            "ICERNE": self.control.instability_zones,
        }  # fmt: skip
        yield self._card("/15/", layouts.loads(wide), counts)
        for kind, card, layout in (
            ("force", "/15-1/", layouts.force(wide)),
            ("lines", "/15-2/", layouts.LINE_LOAD),
            ("faces", "/15-3/", layouts.FACE_LOAD),
            ("temperature", "/15-7/", layouts.TEMPERATURE),
            ("displacement", "/15-8/", layouts.displacement(wide)),
        ):
            loads: list[Any] = {"lines": self.lines, "faces": self.faces}.get(kind) or self.nodal.get(kind) or []
            if loads:
                yield f"{heading(layout, card)}\n".encode()
            for load in loads:
                yield self._rows(kind, load)
        for load in self.bodies:
            values = dict(zip(("gx", "gy", "gz"), load.acceleration, strict=True))
            yield self._card("/15-9/", layouts.BODY, {"NVFUB": self._number(load.curve), **values})

    def _card(self, card: str, layout: Layout, values: dict[str, Any]) -> bytes:
        return f"{heading(layout, card)}\n{self.text.line(layout, values, f'card {card}')}\n".encode("ascii")

    # Which loads a deck can say

    def _nodal(self, kind: str) -> Iterator[NodalLoad]:
        """The loads of a kind."""
        total: bool | None = None
        for load in self.model.nodal_loads:
            if load.kind != kind or load.native.get("initial") or not len(load.nodes):
                continue
            what = f"{kind}s of nodes"
            if load.system:
                self.report.drop(what, len(load.nodes), "in a local system")
                continue
            if load.birth is not None or load.death is not None:
                self.report.drop(f"times of birth and death of {what}", 1, _NO_PLACE)
            if kind == "displacement":
                mine = not load.native.get("incremental")
                total = mine if total is None else total
                if mine != total:
                    self.report.drop(what, len(load.nodes), "total and incremental ones do not go together")
                    continue
            if kind == "temperature" and (far := self.ids[load.nodes] > WIDEST_SHORT).any():
                self.report.drop(what, int(far.sum()), "PAK reads their nodes' numbers in five columns")
                load = NodalLoad(kind, load.nodes[~far], load.dofs[~far], load.values[~far], load.curve)
            yield load

    def report_others(self) -> None:
        """Note the loads that PAK does not have."""
        said = ("force", "temperature", "displacement")
        for load in self.model.nodal_loads:
            if load.kind not in said and not load.native.get("initial"):
                self.report.drop(f"prescribed {load.kind} of nodes", len(load.nodes), _NO_PLACE)
        plain = {"faces", "values", "direction", "curve", "id", "name", "set", "native", "source"}
        report_lost(self.model.face_loads, plain, "face load", _NO_PLACE, self.report)

    def _face_loads(self) -> tuple[list[FaceLoad], list[FaceLoad]]:
        """Loads on edges of plane elements, and on faces."""
        planes = {b.family for b in self.model.blocks} <= {"plane", "", "truss", "beam"} and self.model.dimension == 2
        lines: list[FaceLoad] = []
        faces: list[FaceLoad] = []
        for load in self.model.face_loads:
            if not len(load.faces):
                continue
            edge = "ITIPE" in load.native or load.faces.shape[1] == 2 or planes
            if edge and load.direction:
                self._traction(load)
            elif edge and (self.ids[load.faces[load.faces >= 0]] > WIDEST_SHORT).any():
                self.report.drop("loads on edges", len(load.faces), "PAK reads their nodes' numbers in five columns")
            else:
                (lines if edge else faces).append(load)
        return lines, faces

    def _traction(self, load: FaceLoad) -> None:
        """A traction on edges of plane elements among the forces on nodes."""
        if load.direction == 3:
            self.report.drop("tractions on edges", len(load.faces), "along z")
            return
        plane = self._plane()
        round_ = plane.plane == "axisymmetric"
        thickness = plane.parameters.get("thickness", 1.0)
        forces, lost = nodal_forces(self.model.xyz, load, thickness, axisymmetric=round_)
        self.report.approximate("tractions on edges", len(load.faces), "as forces on their nodes")
        self.report.drop("forces of tractions", lost, "on nodes of the axis")
        if len(forces.nodes):
            self.nodal["force"].append(forces)

    def _body_loads(self) -> list[BodyLoad]:
        kept: list[BodyLoad] = []
        for load in self.model.body_loads:
            if load.parts is not None and set(load.parts) != set(self.model.parts):
                self.report.drop("body loads of some parts", 1, "PAK's act on all")
            elif len(kept) == _MOST_BODY_LOADS:
                self.report.drop("body loads", 1, f"PAK takes {_MOST_BODY_LOADS}")
            else:
                kept.append(load)
        return kept

    # Time functions

    def _functions(self) -> dict[int, tuple[int, Any]]:
        """Curve -> its number in the deck and its points."""
        loads: list[Any] = [*(load for some in self.nodal.values() for load in some), *self.lines, *self.faces,
                            *self.bodies]  # fmt: skip
        used = {load.curve for load in loads}
        curves = self.model.curves
        own = set(curves) == set(range(1, len(curves) + 1))  # a deck's numbers stay
        keep = [key for key in curves if own or key in used]
        for key in used - {None}:
            if key not in curves:
                raise ValueError(f"a load names curve {key}, which the model does not have")
        numbers = {key: key if own else place for place, key in enumerate(keep, 1)}
        found = {key: (numbers[key], self._extended(curves[key])) for key in keep}
        if None in used or not found:
            end = 2 * end_time(self.control)
            found[_ALWAYS] = (len(found) + 1, np.array([(0.0, 1.0), (end, 1.0)]))
        return found

    def _number(self, curve: int | None) -> int:
        return self.functions[_ALWAYS if curve is None else curve][0]

    def _extended(self, curve: Curve) -> Any:
        """A curve that reaches past the end: PAK stops where a rounded time lies behind its last point."""
        points = curve.points
        if not len(points) or (np.diff(points[:, 0]) < 0).any():
            raise ValueError(f"curve {curve.id} {curve.name}: a time function needs points in the order of time")
        end, step = end_time(self.control), self.control.periods[-1][1]
        if points[-1, 0] > end + 0.5 * step:
            return points
        self.report.notes.append(
            f"time function {curve.id}: its last value holds on to {end + step:g}: PAK wants one past the end {end:g}"
        )
        return np.vstack([points, [end + step, points[-1, 1]]])

    def _function_lines(self) -> Iterator[bytes]:
        most = max(len(points) for _, points in self.functions.values())
        yield self._card("/14/", layouts.FUNCTIONS, {"NTABFT": len(self.functions), "MAXTFT": most})
        for number, points in self.functions.values():
            yield self._card("/14-1/", layouts.FUNCTION, {"IBR": number, "IMAX": len(points)})
            columns = [real_column(points[:, k], 10, "time functions", self.text) for k in (0, 1)]
            yield np.hstack([*columns, _line(len(points))]).tobytes()

    # Cards of loads: bytes side by side

    def _rows(self, kind: str, load: Any) -> bytes:
        if kind in ("lines", "faces"):
            return self._face_rows(load, edges=kind == "lines")
        count, wide = len(load.nodes), self.control.wide
        number = np.full(count, self._number(load.curve))
        what = f"{kind}s of nodes"
        columns = [integers(self.ids[load.nodes], 10 if wide and kind != "temperature" else 5)]
        if kind != "temperature":
            columns.append(integers(load.dofs, 5))
        columns += [integers(number, 5), real_column(load.values, 10, what, self.text), _zero(count)]
        if kind == "force":
            shift = np.full(count, float(load.native.get("FPOM", 0.0)))
            columns.append(real_column(shift, 10, what, self.text))
        return np.hstack([*columns, _line(count)]).tobytes()

    def _face_rows(self, load: FaceLoad, *, edges: bool) -> bytes:
        count, native = len(load.faces), load.native
        number = integers(np.full(count, self._number(load.curve)), 5)
        width = 2 if edges else 4
        values = load.values.reshape(count, -1)
        places = np.minimum(np.arange(width), values.shape[1] - 1)
        reals = [real_column(values[:, k], 10, "face loads", self.text) for k in places.tolist()]
        most = 3 if edges else 9
        faces = np.pad(load.faces, ((0, 0), (0, max(most - load.faces.shape[1], 0))), constant_values=-1)[:, :most]
        if edges:
            plane = self._plane()
            kind = int(native.get("ITIPE", {"axisymmetric": 1, "strain": 2}.get(plane.plane, 0)))
            thickness = np.full(count, float(native.get("THICV", plane.parameters.get("thickness", 1.0))))
            first = [integers(np.full(count, kind), 5), number,
                     integers(np.full(count, int(native.get("IPRAV", 0))), 5), *reals,
                     real_column(thickness, 10, "face loads", self.text), _zero(count)]  # fmt: skip
        else:
            faces[:, 3] = np.where(faces[:, 3] < 0, faces[:, 2], faces[:, 3])
            direction = integers(np.full(count, load.direction), 5)
            first = [number, direction, *reals, _zero(count)]
        columns = 10 if self.control.wide and not edges else 5
        nodes = np.where(faces.ravel() < 0, 0, self.ids[faces.ravel()])
        text = integers(nodes, columns).reshape(count, most, columns).copy()
        text[faces < 0] = ord(" ")
        return np.hstack([*first, _line(count), text.reshape(count, -1), _line(count)]).tobytes()

    def _plane(self) -> Section:
        """The first section of plane elements."""
        parts = (self.model.parts[int(b.part[0])] for b in self.model.blocks if b.family == "plane" and len(b.part))
        sections = (self.model.sections.get(part.section or 0) for part in parts)
        return next((section for section in sections if section is not None), Section(0))


def _count(loads: list[NodalLoad]) -> int:
    return sum(len(load.nodes) for load in loads)


def _zero(count: int) -> Text:
    return integers(np.zeros(count, np.int64), 5)


def _line(count: int) -> Text:
    return np.full((count, 1), np.uint8(ord("\n")))
