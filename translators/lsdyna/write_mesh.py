"""Nodes and elements as tables of a keyword deck."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import TABLE
from zrno.translators.lsdyna.cards_out import Writer, rows
from zrno.translators.lsdyna.shapes import default_order, eight_nodes
from zrno.translators.model import ElementBlock, Ints, Model
from zrno.translators.report import Report

_CHUNK = 100_000
Columns = Sequence[tuple[NDArray[Any], int]]

# What stands for an element that LS-DYNA has not: its corners.
_CORNERS = {
    "line3": "line2", "quad9": "quad8", "pyramid13": "pyramid5", "wedge15": "wedge6", "wedge18": "wedge6",
}  # fmt: skip
# Families whose numbers LS-DYNA keeps apart.
_SPACE = {"plane": "shell", "truss": "beam"}


class Mesh:
    """The model's mesh as it will be written."""

    def __init__(self, model: Model, report: Report) -> None:
        self.model, self.report = model, report
        self.node_ids = model.node_ids
        if len(self.node_ids) != len(model.xyz) or (self.node_ids <= 0).any():
            self.node_ids = np.arange(1, len(model.xyz) + 1)
        self.blocks = self._blocks()

    def largest_of_sets(self) -> int:
        """The largest number that stands in ten columns of a set."""
        model = self.model
        members = [*(s.elements for s in model.element_sets), *(s.parts for s in model.part_sets)]
        numbers = [s.id for s in model.node_sets] + [s.id for s in model.element_sets]
        numbers += [s.id for s in model.part_sets] + [s.id for s in model.segment_sets]
        return max([0, *numbers, *(int(m.max(initial=0)) for m in members)])

    def largest_id(self) -> int:
        """The largest number that stands in eight columns."""
        numbers = [int(self.node_ids.max(initial=0))]
        for block in self.blocks:
            numbers += [int(block.ids.max(initial=0)), int(block.part.max(initial=0))]
        return max(numbers)

    def pieces(self, writer: Writer) -> Iterator[bytes]:
        """*NODE and the elements' keywords."""
        model = self.model
        if len(model.xyz):
            yield from self._nodes(writer)
        for block in self.blocks:
            for start in range(0, len(block.ids), _CHUNK):
                part = slice(start, start + _CHUNK)
                own = ElementBlock(
                    block.kind, block.ids[part], block.nodes[part], block.part[part], block.family,
                    {name: values[part] for name, values in block.data.items()},
                )  # fmt: skip
                yield self._elements(own, writer)

    def _nodes(self, writer: Writer) -> Iterator[bytes]:
        xyz, fixed = self.model.xyz, self.model.fixed
        for start in range(0, len(xyz), _CHUNK):
            part = slice(start, start + _CHUNK)
            columns: list[tuple[NDArray[Any], int]] = [(self.node_ids[part], 8), (xyz[part], 16)]
            if fixed is not None and fixed[part].any():
                codes = np.stack([code(fixed[part, :3]), code(fixed[part, 3:])], axis=1)
                columns.append((codes, 8))
            yield writer.table("NODE", columns)

    def _blocks(self) -> list[ElementBlock]:
        """Blocks that can be written: with parts, of kinds that there are, no number twice in a family."""
        found = []
        parts = self.model.parts
        for block in self.model.blocks:
            family = block.family or {0: "", 1: "beam", 2: "shell", 3: "solid"}[TABLE[block.kind].dimension]
            if family not in _FAMILIES:
                self.report.drop(f"{block.kind} elements", len(block.ids), "a keyword deck has no such elements")
                continue
            kept = np.ones(len(block.ids), bool) if family == "mass" else block.part != 0
            if parts:
                self.report.drop(f"{block.kind} elements", int((~kept).sum()), "they belong to no part")
            else:
                kept[:] = True
            if not kept.any():
                continue
            kind, nodes = block.kind, block.nodes[kept]
            if kind in _CORNERS:
                kind = _CORNERS[kind]
                nodes = nodes[:, : TABLE[kind].nodes]
                self.report.approximate(f"{block.kind} elements", len(nodes), f"written as {kind}")
            if family == "tshell" and kind not in ("hex8", "wedge6"):
                family = "solid"
            data = {name: values[kept] for name, values in block.data.items()}
            part = np.where(block.part[kept] == 0, 0 if family == "mass" else 1, block.part[kept])
            found.append(ElementBlock(kind, block.ids[kept], nodes, part, family, data))
        self._renumber(found)
        return found

    def _renumber(self, blocks: list[ElementBlock]) -> None:
        for space in ("solid", "shell", "tshell", "beam", "spring", "mass"):
            own = [b for b in blocks if _SPACE.get(b.family, b.family) == space]
            if not own:
                continue
            ids = np.concatenate([b.ids for b in own])
            if len(np.unique(ids)) == len(ids) and ids.min() > 0:
                continue
            self.report.notes.append(f"{len(ids)} {space} elements are numbered anew: numbers stood twice")
            first = 1
            for block in own:
                block.ids = np.arange(first, first + len(block.ids))
                first += len(block.ids)

    def _elements(self, block: ElementBlock, writer: Writer) -> bytes:
        nodes = np.where(block.nodes >= 0, self.node_ids[block.nodes], 0)
        return _FAMILIES[block.family](self, block, nodes, writer)

    def _known(self, block: ElementBlock, *names: str) -> dict[str, NDArray[Any]]:
        """The data that a keyword says; the rest is reported."""
        for name in block.data:
            if name not in names:
                self.report.drop(f"{block.family} elements' {name}", len(block.ids), "not written to a keyword deck")
        return {name: block.data[name] for name in names if name in block.data}

    def _solid(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "axis_a", "axis_d")
        head = np.column_stack([block.ids, block.part])
        kind = block.kind
        if kind in ("hex20", "hex27"):
            order = np.argsort(default_order(kind))
            own = nodes[:, order]
            cards = [[(head, 8)], *([(own[:, i : i + 10], 8)] for i in range(0, own.shape[1], 10))]
            return several(writer, f"ELEMENT_SOLID_{'H20' if kind == 'hex20' else 'H27'}", cards)
        if kind == "tet10":
            return several(writer, "ELEMENT_SOLID (ten nodes format)", [[(head, 8)], [(nodes, 8)]])
        own = nodes[:, list(eight_nodes(kind))]
        row: Columns = [(np.column_stack([head, own]), 8)]
        if "axis_a" in data and "axis_d" in data:
            return several(writer, "ELEMENT_SOLID_ORTHO", [row, [(data["axis_a"], 16)], [(data["axis_d"], 16)]])
        return writer.table("ELEMENT_SOLID", row)

    def _tshell(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "angle")
        own = nodes[:, list(eight_nodes(block.kind, thick=True))]
        row: Columns = [(np.column_stack([block.ids, block.part, own]), 8)]
        if "angle" in data:
            values = np.zeros((len(own), 5))
            values[:, 4] = data["angle"]
            return several(writer, "ELEMENT_TSHELL_BETA", [row, [(values, 16)]])
        return writer.table("ELEMENT_TSHELL", row)

    def _shell(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "thickness", "angle", "offset")
        order = {"tri3": (0, 1, 2, 2), "quad4": (0, 1, 2, 3), "tri6": (0, 1, 2, 2, 3, 4, 5),
                 "quad8": tuple(range(8))}[block.kind]  # fmt: skip
        row: Columns = [(np.column_stack([block.ids, block.part, nodes[:, list(order)]]), 8)]
        cards: list[Columns] = [row]
        name = "ELEMENT_SHELL"
        if "thickness" in data or "angle" in data:
            values = np.zeros((len(nodes), 5))
            thickness = np.nan_to_num(data.get("thickness", np.zeros(len(nodes)))).reshape(len(nodes), -1)
            corners = thickness.shape[1]
            values[:, :4] = thickness if corners == 4 else thickness[:, [0, 1, 2, 2] if corners == 3 else [0] * 4]
            values[:, 4] = np.nan_to_num(data.get("angle", 0.0))
            cards.append([(values, 16)])
            if len(order) > 4:  # mid-nodes have thicknesses too: 0 is the mean of the corners
                cards.append([(np.zeros((len(nodes), 4)), 16)])
            name += "_THICKNESS" if "thickness" in data else "_BETA"
        if "offset" in data:
            cards.append([(np.nan_to_num(data["offset"]), 16)])
            name += "_OFFSET"
        return several(writer, name, cards)

    def _beam(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "orientation", "orientation_node", "releases", "section_values", "offsets", "volume",
                           "inertia")  # fmt: skip
        third = data.get("orientation_node", np.full(len(nodes), -1))
        numbers = np.where(third >= 0, self.node_ids[third], 0)
        columns = [block.ids, block.part, nodes, numbers]
        if "releases" in data:
            columns.append(data["releases"])
        cards: list[Columns] = [[(np.column_stack(columns), 8)]]
        name = "ELEMENT_BEAM"
        if "section_values" in data:
            cards.append([(data["section_values"], 16)])
            name += "_THICKNESS"
        elif "volume" in data:
            cards.append([(np.column_stack([data["volume"], data.get("inertia", np.zeros(len(nodes)))]), 16)])
            name += "_SCALAR"
        if "offsets" in data:
            cards.append([(data["offsets"], 10)])
            name += "_OFFSET"
        if "orientation" in data:
            cards.append([(data["orientation"], 10)])
            name += "_ORIENTATION"
        return several(writer, name, cards)

    def _spring(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "direction", "scale", "print", "offset")
        count = len(nodes)
        second = nodes[:, 1] if nodes.shape[1] > 1 else np.zeros(count, np.int64)
        ids = np.column_stack([block.ids, block.part, nodes[:, 0], second, data.get("direction", np.zeros(count, int))])
        columns: list[tuple[NDArray[Any], int]] = [(ids, 8)]
        if set(data) & {"scale", "print", "offset"}:
            columns += [(data.get("scale", np.ones(count)), 16), (data.get("print", np.zeros(count, int)), 8)]
            columns.append((data.get("offset", np.zeros(count)), 16))
        return writer.table("ELEMENT_DISCRETE", columns)

    def _mass(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "mass")
        mass = data.get("mass", np.zeros(len(nodes)))
        columns: list[tuple[NDArray[Any], int]] = [(np.column_stack([block.ids, nodes]), 8), (mass, 16)]
        if block.part.any():
            columns.append((block.part, 8))
        return writer.table("ELEMENT_MASS", columns)

    def _sph(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "mass", "volume")
        mass = data.get("mass", np.zeros(len(nodes)))
        if "volume" in data:  # a negative mass is a volume
            mass = np.where(data["volume"] > 0, -data["volume"], mass)
        return writer.table("ELEMENT_SPH", [(np.column_stack([nodes, block.part]), 8), (mass, 16)])

    def _sphere(self, block: ElementBlock, nodes: Ints, writer: Writer) -> bytes:
        data = self._known(block, "mass", "volume", "inertia", "radius")
        zero = np.zeros(len(nodes))
        of = "volume" if "volume" in data else "mass"
        values = np.column_stack([data.get(name, zero) for name in (of, "inertia", "radius")])
        name = "ELEMENT_DISCRETE_SPHERE" + ("_VOLUME" if of == "volume" else "")
        return writer.table(name, [(np.column_stack([nodes, block.part]), 8), (values, 16)])


_FAMILIES = {
    "solid": Mesh._solid, "tshell": Mesh._tshell, "shell": Mesh._shell, "plane": Mesh._shell, "beam": Mesh._beam,
    "truss": Mesh._beam, "spring": Mesh._spring, "mass": Mesh._mass, "sph": Mesh._sph, "sphere": Mesh._sphere,
}  # fmt: skip


def code(held: NDArray[np.bool_]) -> Ints:
    """Constraint codes of three directions held or not, (n, 3)."""
    codes: Ints = np.array([0, 1, 2, 4, 3, 6, 5, 7])[held @ np.array([1, 2, 4])]
    return codes


def several(writer: Writer, name: str, cards: Sequence[Columns]) -> bytes:
    """A keyword whose elements have several cards each: the tables of the cards, a row of each in turn."""
    if len(cards) == 1:
        return writer.table(name, cards[0])
    grids, suffix = writer.grids(cards)
    width = max(grid.shape[1] for grid in grids)
    blank = ord(" ")
    whole = np.full((len(grids[0]), len(grids), width), blank, np.uint8)
    for i, grid in enumerate(grids):
        whole[:, i, : grid.shape[1]] = grid
    first, _, remark = name.partition(" ")
    head = f"*{first}{suffix}" + (f" {remark}" if remark and not suffix else "")
    return f"{head}\n".encode() + rows([whole.reshape(-1, width)])
