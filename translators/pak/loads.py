"""Time functions (card 14) and loads (card 15) of a PAK deck."""

from __future__ import annotations

from typing import Any

import numpy as np

from zrno.translators.control import FemControl
from zrno.translators.model import BodyLoad, Curve, FaceLoad, Floats, Ints, Model, NodalLoad, Source
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.generate import Series, read_series
from zrno.translators.pak.nodes import Numbering
from zrno.translators.text import Block, Card, Cards

_MOST_BODY_LOADS = 10
_UNREAD = {"NPGR": "pressures of thin-walled beams", "NPLJ": "pressures of axisymmetric shells"}


def read_functions(cards: Cards, model: Model) -> None:
    """Card 14: curves by their number."""
    head = cards.card(layouts.FUNCTIONS, "card 14, the number of time functions")
    head.check("NTABFT", head["NTABFT"] >= 0, "no such number of functions", "0 or more")
    cards.faults.stop()
    for number in range(1, head["NTABFT"] + 1):
        card = cards.card(layouts.FUNCTION, f"card 14-1, time function {number}")
        card.check("IBR", 1 <= card["IBR"] <= head["NTABFT"], "no such time function", f"1 to {head['NTABFT']}")
        if card["IBR"] in model.curves:
            card.fault("IBR", "this time function stands twice", "another number")
        card.check("IMAX", card["IMAX"] > 0, "no points", "the number of points, 1 or more")
        cards.faults.stop()
        block = cards.block(layouts.POINT, card["IMAX"], f"a point of time function {card['IBR']}")
        t = block["t"]
        block.check("t", np.append(True, t[1:] >= t[:-1]), "time goes back", "times in order")
        cards.faults.stop()
        source = Source(cards.faults.path, card.line)
        model.curves[card["IBR"]] = Curve(card["IBR"], "", np.column_stack([t, block["f"]]), source)


class Loads:
    """Reads the loads into the model."""

    def __init__(
        self, cards: Cards, model: Model, control: FemControl, numbering: Numbering, *, linear: bool, size: int
    ) -> None:
        self.cards = cards
        self.model = model
        self.wide = control.wide
        self.control = control
        self.numbering = numbering
        self.linear = linear
        self.size = size

    def read(self) -> None:
        """Card 15 and what it asks for."""
        head = self.cards.card(layouts.loads(self.wide), "card 15, the numbers of loads")
        for name in ("NCF", "NPP2", "NPP3", "INDZS"):
            head.check(name, head[name] >= 0, f"{name} is negative", "0 or more")
        head.check("INDZS", head["INDZS"] <= _MOST_BODY_LOADS, "too many body loads", f"at most {_MOST_BODY_LOADS}")
        for name, what in _UNREAD.items():
            head.check(name, head[name] == 0, f"{what} are not read", "0")
        self.cards.faults.stop()
        self.control.instability_zones = head["ICERNE"]
        self._nodal("force", layouts.force(self.wide), head["NCF"])
        self._lines(head["NPP2"])
        self._faces(head["NPP3"])
        if head["NTEMP"] < 0:
            self.model.warnings.append(
                f"{self.cards.faults.path}:{head.line}: the temperatures of nodes (NTEMP < 0) stand in another file"
            )
        self._nodal("temperature", layouts.TEMPERATURE, max(head["NTEMP"], 0))
        self._displacements(head)
        self._body(head["INDZS"])
        self.cards.faults.stop()

    def _displacements(self, head: Card) -> None:
        """Prescribed displacements: what their sign means depends on whether the groups are linear.

        PAK imposes f(t) in a step where NZADP > 0, f(t) - f(t - dt) where it is below; it adds that to the last state
        where a group is not linear. So a history of displacements is NZADP > 0 of linear groups, NZADP < 0 of others.
        """
        native = {} if (head["NZADP"] > 0) == self.linear else {"incremental": True}
        before = len(self.model.nodal_loads)
        self._nodal("displacement", layouts.displacement(self.wide), abs(head["NZADP"]), native)
        if native and len(self.model.nodal_loads) > before:
            what = "the last step's increment alone" if self.linear else "added to the displacement in each step"
            self.model.warnings.append(
                f"{self.cards.faults.path}:{head.line}: prescribed displacements are {what} (NZADP = {head['NZADP']})"
            )

    def _function(self, block: Block, name: str) -> Ints:
        curves = np.array([*self.model.curves, 0])
        block.check(name, np.isin(block[name], curves[:-1]), "no such time function", "one of card 14")
        return np.asarray(block[name])

    def _nodal(self, kind: str, layout: Any, count: int, native: dict[str, Any] | None = None) -> None:
        if not count:
            return
        series = read_series(self.cards, [layout], count, f"a {kind} card", key=(0, "N"), size=self.size)
        block = series.blocks[0]
        self.numbering.checked(block, "N")
        function = self._function(block, "NC")
        dof = block["IP"] if "IP" in block.values else np.zeros(len(function), np.int64)
        if kind != "temperature":
            block.check("IP", (dof >= 1) & (dof <= 6), "no such direction", "1 to 6")
        self.cards.faults.stop()
        nodes = self._generated(series, block, "N")
        shift = block["FPOM"] if "FPOM" in block.values else np.zeros(len(function))
        pairs = np.column_stack([function, shift])
        for (curve, late), rows in _alike(pairs):
            mine = rows[series.card]
            more = ({"FPOM": late} if late else {}) | (native or {})
            card = series.card[mine]
            self.model.nodal_loads.append(
                NodalLoad(kind, nodes[mine], dof[card], block["FAK"][card], int(curve), native=more,
                          source=Source(self.cards.faults.path, block.line(int(card[0]))))
            )  # fmt: skip

    def _generated(self, series: Series, block: Block, name: str) -> Ints:
        nodes = self.numbering.indices(series.numbers(block[name]))
        bad = (nodes < 0) & (series.take(block[name]) != 0)
        if bad.any():
            block.fault(int(series.card[np.argmax(bad)]), name, "a node that this card makes is not there")
            self.cards.faults.stop()
        return nodes

    def _lines(self, count: int) -> None:
        """Loads on edges of plane elements."""
        if not count:
            return
        series = read_series(self.cards, [layouts.LINE_LOAD, layouts.LINE_NODES], count, "a line load",
                             key=(1, "n1"), size=self.size)  # fmt: skip
        block, nodes = series.blocks
        function = self._function(block, "NFUN")
        block.check("IPRAV", np.isin(block["IPRAV"], (0, -1)), "no such direction", "0 (pressure) or -1 (shear)")
        faces = self._face_nodes(series, nodes, 2, 3)
        values = np.column_stack([block["v1"], block["v2"]])
        keys = np.column_stack([function, block["IPRAV"], block["ITIPE"], block["THICV"]])
        for (curve, direction, kind, thickness), rows in _alike(keys):
            native = {"ITIPE": int(kind), "THICV": float(thickness)} | ({"IPRAV": -1} if direction else {})
            self._face_load(series, block, rows, faces, values, 0, int(curve), native)

    def _faces(self, count: int) -> None:
        """Pressure and traction on faces of volumes and on shells."""
        if not count:
            return
        cards = [layouts.FACE_LOAD, layouts.nodes(self.wide, 1, 9)]
        series = read_series(self.cards, cards, count, "a face load", key=(1, "n1"), size=self.size)
        block, nodes = series.blocks
        function = self._function(block, "NFUN")
        block.check("IPRAV", np.isin(block["IPRAV"], (0, 1, 2, 3)), "no such direction", "0 (pressure), 1, 2 or 3")
        faces = self._face_nodes(series, nodes, 3, 9)
        values = np.column_stack([block[f"v{k}"] for k in range(1, 5)])
        keys = np.column_stack([function, block["IPRAV"]])
        for (curve, direction), rows in _alike(keys):
            self._face_load(series, block, rows, faces, values, int(direction), int(curve), {})

    def _face_nodes(self, series: Series, block: Block, least: int, most: int) -> Ints:
        for k in range(1, most + 1):
            self.numbering.checked(block, f"n{k}", absent=k > least)
        self.cards.faults.stop()
        return np.column_stack([self._generated(series, block, f"n{k}") for k in range(1, most + 1)])

    def _face_load(
        self, series: Series, block: Block, rows: Any, faces: Ints, values: Floats, direction: int, curve: int,
        native: dict[str, Any],
    ) -> None:  # fmt: skip
        mine = rows[series.card]
        faces = faces[mine].copy()
        if faces.shape[1] > 3:  # a triangle is written with its third node twice
            faces[faces[:, 3] == faces[:, 2], 3] = -1
        used = int(np.flatnonzero((faces >= 0).any(axis=0)).max()) + 1
        values = values[series.card[mine]]
        if (values == values[:, :1]).all():
            values = values[:, :1]
        source = Source(self.cards.faults.path, block.line(int(series.card[np.argmax(mine)])))
        self.model.face_loads.append(FaceLoad(faces[:, :used], values, direction, curve, native=native, source=source))

    def _body(self, count: int) -> None:
        block = self.cards.block(layouts.BODY, count, "a body load")
        self._function(block, "NVFUB")
        self.cards.faults.stop()
        for i in range(count):
            g = (float(block["gx"][i]), float(block["gy"][i]), float(block["gz"][i]))
            source = Source(self.cards.faults.path, block.line(i))
            self.model.body_loads.append(BodyLoad(g, int(block["NVFUB"][i]), source=source))


def _alike(keys: Any) -> list[tuple[tuple[float, ...], Any]]:
    """Cards of equal keys (n, k), in order of appearance: a key, and which cards have it (n,) bool."""
    different, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    inverse = inverse.reshape(-1)
    return [(tuple(different[k].tolist()), inverse == k) for k in np.argsort(first).tolist()]
