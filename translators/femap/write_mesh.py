"""Nodes, elements and properties as blocks 403, 404 and 402 have them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from zrno.translators.femap.ids import by_value
from zrno.translators.femap.properties import value_names
from zrno.translators.femap.text_out import CHUNK, line, pointed, rows, title
from zrno.translators.femap.topology import NUMBERS, PYRAMIDS, TOPOLOGIES, TYPES, UNKNOWN, type_of
from zrno.translators.model import PARTICLE_FAMILIES, ElementBlock, Floats, Ints, Model, Section
from zrno.translators.report import Report

_LARGEST = 99_999_999  # number of anything
_SIMPLER = {"hex27": "hex20", "quad9": "quad8", "wedge18": "wedge15"}
_CORNERS = ("thickness_1", "thickness_2", "thickness_3", "thickness_4")
_DATA = {"orientation", "orientation_node", "angle"}


class Mesh:
    """What of a model is written as a mesh. node_ids (n,); blocks with the numbers of their elements; property_of: the
    property of each part."""

    def __init__(self, model: Model, report: Report) -> None:
        self.model, self.report = model, report
        self.own = model.format == "femap"
        self.node_ids = self._node_ids()
        self.system = np.zeros(len(model.xyz), np.int64)  # filled by the constraints
        self.blocks = [block for block in model.blocks if len(block.ids) and not self._is_particles(block)]
        self.ids = self._element_ids()
        self.parts_of = [list(by_value(block.part)) for block in self.blocks]  # number and places of each part
        blocks_of: dict[int, list[ElementBlock]] = {number: [] for number in model.parts}
        for block, parts in zip(self.blocks, self.parts_of, strict=True):
            for number, _ in parts:
                blocks_of.setdefault(number, []).append(block)
        self.blocks_of = blocks_of
        self.property_of = {number: number for number in blocks_of if 0 < number <= _LARGEST}
        top = max(self.property_of.values(), default=0)
        for number in blocks_of.keys() - self.property_of.keys():
            top += 1
            self.property_of[number] = top
            report.approximate("part numbers", 1, f"{number} as {top}: FEMAP's are from 1")

    def _is_particles(self, block: ElementBlock) -> bool:
        if block.family in PARTICLE_FAMILIES:
            self.report.drop(f"{block.family} elements", len(block.ids), "FEMAP has no particles")
        return block.family in PARTICLE_FAMILIES

    def _node_ids(self) -> Ints:
        ids, count = self.model.node_ids, len(self.model.xyz)
        if len(ids) == count and ids.min() > 0 and ids.max() <= _LARGEST and len(np.unique(ids)) == count:
            return ids
        self.report.approximate("node numbers", count, f"1 to {count}: FEMAP's differ and are from 1 to {_LARGEST}")
        return np.arange(1, count + 1)

    def _element_ids(self) -> list[Ints]:
        """Numbers of each block's elements, which must differ through all blocks."""
        ids = np.concatenate([np.zeros(0, np.int64), *(block.ids for block in self.blocks)])
        if len(ids) and (ids.min() < 1 or ids.max() > _LARGEST or len(np.unique(ids)) < len(ids)):
            said = f"1 to {len(ids)}: FEMAP's differ, whatever the family, and are from 1 to {_LARGEST}"
            self.report.approximate("element numbers", len(ids), said)
            ids = np.arange(1, len(ids) + 1)
        return np.split(ids, np.cumsum([len(block.ids) for block in self.blocks])[:-1]) if self.blocks else []

    def numbers_of(self, family: str, ids: Ints) -> Ints:
        """The numbers in the file of elements of a family; those that are not there are left out."""
        found = [np.zeros(0, np.int64)]
        for block, numbers in zip(self.blocks, self.ids, strict=True):
            if block.family == family:
                order = np.argsort(block.ids, kind="stable")
                at = np.minimum(np.searchsorted(block.ids[order], ids), len(order) - 1)
                found.append(np.where(block.ids[order][at] == ids, numbers[order][at], 0))
        if len(found) == 1:
            return found[0]
        best: Ints = np.max(found[1:], axis=0)
        return best[best > 0]

    def _section(self, part: int) -> Section | None:
        found = self.model.parts.get(part)
        return None if found is None or found.section is None else self.model.sections.get(found.section)

    def _type(self, block: ElementBlock, part: int) -> int:
        section = self._section(part)
        own = 0 if section is None or not self.own else int(section.native.get("type", 0))
        return type_of(_SIMPLER.get(block.kind, block.kind), block.family, section.plane if section else "", own)

    def nodes(self) -> Iterator[str]:
        """The body of block 403."""
        fixed = np.zeros((len(self.node_ids), 6), np.int64) if self.model.fixed is None else self.model.fixed
        for first in range(0, len(self.node_ids), CHUNK):
            some = slice(first, first + CHUNK)
            head = np.column_stack([self.node_ids[some], self.system[some], fixed[some].astype(np.int64)]).tolist()
            xyz = self.model.xyz[some].tolist()
            yield pointed(
                "".join(
                    [
                        f"{n},0,{s},1,46,{a},{b},{c},{d},{e},{f},{x!r},{y!r},{z!r},\n"
                        for (n, s, a, b, c, d, e, f), (x, y, z) in zip(head, xyz, strict=True)
                    ]
                )
            )

    def elements(self) -> Iterator[str]:
        """The body of block 404."""
        for block, ids, parts in zip(self.blocks, self.ids, self.parts_of, strict=True):
            kind = _SIMPLER.get(block.kind, block.kind)
            self._report_block(block, kind)
            topology, order = NUMBERS[kind], list(TOPOLOGIES[NUMBERS[kind]][1])
            nodes = np.zeros((len(ids), 20), np.int64)
            nodes[:, order] = self.node_ids[block.nodes[:, : len(order)]]
            for brick, pyramid in PYRAMIDS.items():
                if topology == pyramid:
                    topology = brick
                    nodes[:, 4:8] = nodes[:, 4:5]
                    nodes[:, 16:] = nodes[:, 4:5] if len(order) > 8 else 0
            types, properties = np.zeros(len(ids), np.int64), np.zeros(len(ids), np.int64)
            for number, mine in parts:
                types[mine], properties[mine] = self._type(block, number), self.property_of[number]
            angle, node, orient = self._own_data(block)
            head = np.column_stack([ids, properties, types, np.full(len(ids), topology), node, angle != 0, nodes])
            if angle.any():
                orient = np.column_stack([angle, np.zeros((len(ids), 2))])
            yield from _element_text(head, orient)

    def _own_data(self, block: ElementBlock) -> tuple[Floats, Ints, Floats | None]:
        """Angle of the material, orientation node (0: none), orientation of beams."""
        n, data = len(block.ids), block.data
        at = data.get("orientation_node", np.full(n, -1))
        node = np.where(at >= 0, self.node_ids[np.maximum(at, 0)], 0)
        orient = np.nan_to_num(data["orientation"]) if "orientation" in data else None
        return np.nan_to_num(data.get("angle", np.zeros(n))), node, orient

    def _report_block(self, block: ElementBlock, kind: str) -> None:
        count = len(block.ids)
        if kind != block.kind:
            self.report.approximate(
                f"{block.kind} elements", count, f"as {kind}, without the nodes of faces and centre"
            )
        if kind.startswith("pyramid"):
            self.report.approximate(f"{kind} elements", count, "as bricks whose upper face is one node")
        if block.family in ("tshell", "rigid"):
            self.report.approximate(f"{block.family} elements", count, "as elements of an ordinary type")
        for name, values in block.data.items():
            filled = int(np.count_nonzero(np.nan_to_num(values.reshape(count, -1)).any(axis=1)))
            if name not in _DATA:
                self.report.drop(
                    f"element {name.replace('_', ' ')}", filled, "elements have it by their properties alone"
                )

    def properties(self) -> Iterator[str]:
        """The body of block 402: a property a part."""
        for part, number in self.property_of.items():
            section, found = self._section(part), self.model.parts.get(part)
            native = section.native if section is not None and self.own else {}
            blocks = self.blocks_of[part]
            kind = int(native.get("type", 0)) or (self._type(blocks[0], part) if blocks else 25)
            families = {block.family for block in blocks}
            if len(families) > 1:
                said = f"part {part}: one property, of type {kind} ({TYPES.get(kind, UNKNOWN).name})"
                self.report.approximate("families of elements", len(families), said)
            values = self._values(section, kind, native)
            laminate = [int(m) for m in native.get("laminate", [])]
            name = (found.name if found else "") or (section.name if section else "")
            yield line((number, 110, (found.material if found else None) or 0, kind,
                        native.get("layer", 1), native.get("system", 0)))  # fmt: skip
            yield title(name, self.report) + line(native.get("flags", [0, 0, 0, 0]))
            yield line([len(laminate)]) + "".join(rows(laminate, 8))
            yield line([len(values)]) + "".join(rows(values, 5))

    def _values(self, section: Section | None, kind: int, native: dict[str, object]) -> list[float]:
        if section is None:
            return []
        names, parameters = value_names(kind), dict(section.parameters)
        corners = [parameters.pop(key) for key in _CORNERS if parameters.get(key)]
        if corners and "thickness" not in parameters:
            parameters["thickness"] = sum(corners) / len(corners)
            self.report.approximate(
                "thicknesses", int(min(corners) != max(corners)), f"section {section.id}: their mean"
            )
        lost = [key for key, value in parameters.items() if key not in names and value]
        self.report.drop("section parameters", len(lost), f"section {section.id}: {', '.join(lost)}")
        own = native.get("values", {})
        found: dict[int, float] = dict(own) if isinstance(own, dict) else {}
        found |= {i: float(parameters[name]) for i, name in enumerate(names) if parameters.get(name)}
        return [found.get(i, 0.0) for i in range(1 + max(found, default=-1))]


def _element_text(head: Ints, orient: Floats | None) -> Iterator[str]:
    """Records of seven lines. head (n, 26): number, property, type, topology, orientation node, flag, nodes."""
    start = "%d,124,%d,%d,%d,1,%d,%d,\n" + 2 * ("%d," * 10 + "\n")
    end = 2 * "0.,0.,0.,\n" + "0," * 16 + "\n"
    for first in range(0, len(head), CHUNK):
        some = head[first : first + CHUNK]
        if orient is None:
            yield ((start + "0.,0.,0.,\n" + end) * len(some)) % tuple(some.ravel().tolist())
        else:
            vectors = [pointed(f"{x!r},{y!r},{z!r},\n") for x, y, z in orient[first : first + CHUNK].tolist()]
            yield "".join([start % tuple(row) + v + end for row, v in zip(some.tolist(), vectors, strict=True)])
