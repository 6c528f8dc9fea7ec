"""Which groups a model's elements make in a PAK deck: of one type, one section and one material model each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from zrno.translators.elements import TABLE
from zrno.translators.model import ElementBlock, Ints, Material, Model, Section
from zrno.translators.pak.elements import COLLAPSED, HEX_ORDER, SHELLS, TYPES
from zrno.translators.pak.laws import model_of
from zrno.translators.report import Report

_MOST_MATERIALS = 100
_TRIANGLE_NODES = {3: (0, 1, 2, 2), 6: (0, 1, 2, 3, 4, 5)}


@dataclass(slots=True)
class Piece:
    """Elements of one block in a group. nodes: (n, k) indices in PAK's order, -1 absent; data: as the block's."""

    kind: str
    ids: Ints
    part: Ints
    nodes: Ints
    data: dict[str, Any]


@dataclass(slots=True)
class Group:
    """A group: type, material model, analysis, section (None: none), elements. collapsed: corners may coincide."""

    netip: int
    law: int
    analysis: int
    section: Section | None
    collapsed: bool
    pieces: list[Piece] = field(default_factory=list)

    @property
    def native(self) -> dict[str, Any]:
        """The section's own numbers by PAK's names."""
        return {} if self.section is None else self.section.native

    @property
    def family(self) -> str:
        """Family of the elements."""
        return TYPES[self.netip].family

    @property
    def count(self) -> int:
        """How many elements."""
        return sum(len(piece.ids) for piece in self.pieces)


@dataclass(slots=True)
class Materials:
    """The deck's materials. models: model -> its materials in order; number: material -> number within its model."""

    models: dict[int, list[Material]]
    number: dict[int, int]


def plan_materials(model: Model, report: Report) -> Materials:
    """Numbers of all materials that PAK can say; those of elements must be sayable. Raises ValueError."""
    owners = {int(part) for block in model.blocks if _type_family(model, block) for part in distinct(block.part)}
    used = {model.parts[part].material for part in owners if part in model.parts}
    models: dict[int, list[Material]] = {}
    number: dict[int, int] = {}
    for key, material in model.materials.items():
        try:
            law = model_of(material)
        except ValueError as error:
            if key in used:
                raise
            report.drop("materials of no element", 1, str(error))
            continue
        models.setdefault(law, []).append(material)
        number[key] = len(models[law])
    for law, materials in models.items():
        if len(materials) > _MOST_MATERIALS:
            raise ValueError(f"{len(materials)} materials of model {law}: PAK takes {_MOST_MATERIALS}")
    return Materials(models, number)


def plan_groups(model: Model, report: Report) -> list[Group]:
    """The groups in order of appearance. Raises ValueError for elements without a material."""
    groups: dict[tuple[Any, ...], Group] = {}
    for block in model.blocks:
        family = _type_family(model, block)
        if not family:
            what = f"{block.family} {block.kind}".strip()
            report.drop(f"{what} elements", len(block.ids), "a PAK deck has none such")
            continue
        parts = distinct(block.part)
        first = [int(np.argmax(block.part == part)) for part in parts.tolist()]
        keys: dict[tuple[Any, ...], list[int]] = {}
        for part in parts[np.argsort(first)].tolist():
            key = _key(model, block, family, part, report)
            if key is not None:
                keys.setdefault(key, []).append(part)
            else:
                report.drop(f"{block.kind} elements", int((block.part == part).sum()),
                            "PAK's own prisms and pyramids fail its patch test, and a collapsed hexahedron of second "
                            "order is not the same element")  # fmt: skip
        for key, members in keys.items():
            netip, section, law, analysis, collapsed = key
            group = groups.setdefault(
                key, Group(netip, law, analysis, None if section is None else model.sections[section], collapsed)
            )
            rows: Any = slice(None) if len(members) == len(parts) else np.isin(block.part, members)
            group.pieces.append(_piece(block, rows, netip, report))
    return list(groups.values())


def _type_family(model: Model, block: ElementBlock) -> str:
    """The family that a block's elements have in a deck; "" where there is none."""
    dimension = TABLE[block.kind].dimension
    family = block.family
    if not family:
        family = {3: "solid", 2: "plane" if model.dimension == 2 else "shell"}.get(dimension, "")
    sayable = {"solid": 3, "plane": 2, "shell": 2, "beam": 1, "truss": 1}
    return family if sayable.get(family) == dimension and block.kind != "line3" else ""


def _key(
    model: Model, block: ElementBlock, family: str, part: int, report: Report
) -> tuple[int, int | None, int, int, bool] | None:
    """What elements of one group have in common; None where PAK has no such element."""
    owner = model.parts.get(part)
    if owner is None or owner.material is None or owner.material not in model.materials:
        name = f"part {part} {owner.name if owner else ''}".strip()
        raise ValueError(f"{name}: a PAK deck needs a material for each part")
    section = model.sections.get(owner.section) if owner.section is not None else None
    asked = None if section is None else section.native.get("NETIP")
    law = model_of(model.materials[owner.material])
    kind = block.kind
    collapsed = False
    if family == "solid":
        if kind in ("wedge15", "wedge18", "pyramid13"):
            return None
        netip = 33 if kind in ("tet4", "tet10") else 3
        if kind == "tet4" and asked == 3:
            netip = 3
        collapsed = netip == 3 and kind in COLLAPSED and asked != 3
    elif family in ("plane", "shell"):
        triangle = TABLE[kind].shape.corners == 3
        quadrilaterals = 84 if section is None else section.native.get("quadrilaterals", 84)
        own = (2, 21) if family == "plane" else (quadrilaterals if kind == "quad4" else 8, 81)
        netip = own[triangle]
        if asked is not None and asked in TYPES and TYPES[asked].family == family:
            first_order = kind in ("quad4", "tri3") or asked not in (84, 85)
            fits = first_order and (TYPES[asked].corners == (3 if triangle else 4) or kind == "tri3")
            netip = asked if fits else netip
    else:
        netip = 6 if family == "beam" else 1
    analysis = 0 if law <= 2 else 1
    if section is not None:
        analysis = int(section.native.get("IATYP", analysis))
    _check_analysis(analysis, law, f"part {part} {owner.name}".strip())
    return netip, None if section is None else section.id, law, analysis, collapsed


def _check_analysis(analysis: int, law: int, what: str) -> None:
    """PAK stops at other pairs."""
    kind = abs(analysis)
    if (law >= 3 and kind == 0) or (law <= 2 and kind == 1) or (law <= 4 and kind >= 4):
        raise ValueError(f"{what}: material model {law} does not go with the analysis IATYP = {analysis}")


def _piece(block: ElementBlock, rows: Any, netip: int, report: Report) -> Piece:
    nodes = block.nodes[rows]
    data = {name: values[rows] for name, values in block.data.items()}
    kind = block.kind
    if netip == 3:
        if kind in COLLAPSED:
            nodes = nodes[:, list(COLLAPSED[kind])]
        if kind == "hex27":
            report.approximate("hex27 elements", len(nodes), "nodes of faces are left out: PAK has 21")
            nodes = nodes[:, list(HEX_ORDER)]
        else:
            nodes = nodes[:, list(HEX_ORDER[: min(nodes.shape[1], 20)])]
        if "node_21" in data:
            nodes = np.column_stack([nodes, data.pop("node_21")])
        if "nodes_9_21" in data:
            nodes = np.column_stack([nodes[:, :8], data.pop("nodes_9_21")])
    elif TYPES[netip].corners == 4 and TABLE[kind].shape.corners == 3:
        nodes = nodes[:, list(_TRIANGLE_NODES[nodes.shape[1]])]
    if kind == "tet10":
        report.approximate("tet10 elements", len(nodes), "PAK's order of mid-side nodes and its integration of them "
                           "are not verified")  # fmt: skip
    if netip in SHELLS and kind == "tri6" and TYPES[netip].corners == 4:
        raise ValueError("triangles of second order do not go into a group of quadrilaterals")
    return Piece(kind, block.ids[rows], block.part[rows], nodes, data)


def elements_of(group: Group) -> Iterator[Piece]:
    """The elements as they are written: in the order of their numbers where a group has several kinds."""
    if len(group.pieces) == 1:
        yield group.pieces[0]
        return
    most = max(piece.nodes.shape[1] for piece in group.pieces)
    pieces = group.pieces
    ids = np.concatenate([p.ids for p in pieces])
    order = np.argsort(ids, kind="stable")
    nodes = [np.pad(p.nodes, ((0, 0), (0, most - p.nodes.shape[1])), constant_values=-1) for p in pieces]
    data = {}
    for name in {name for piece in pieces for name in piece.data}:
        shape = next(p.data[name].shape[1:] for p in pieces if name in p.data)
        columns = [p.data.get(name, np.zeros((len(p.ids), *shape))) for p in pieces]
        data[name] = np.concatenate(columns)[order]
    yield Piece("", ids[order], np.concatenate([p.part for p in pieces])[order], np.concatenate(nodes)[order], data)


def distinct(numbers: Ints) -> Ints:
    """The different numbers of an array, in order; quick where they are all the same."""
    if len(numbers) and numbers.min() == numbers.max():
        return numbers[:1]
    return np.unique(numbers)
