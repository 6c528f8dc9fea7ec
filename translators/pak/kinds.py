"""What the elements of a PAK group are by their nodes: kinds, and the nodes in VTK's order."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from zrno.translators.elements import TABLE
from zrno.translators.model import Floats, Ints
from zrno.translators.pak.elements import HEX_ORDER, SOLIDS, Type, middle_order, uncollapsed
from zrno.translators.text import Faults

Kind = tuple[str, Any, Ints, dict[str, Any]]  # name in `elements.TABLE`, rows, nodes in VTK order, what else they have


@dataclass(slots=True)
class Elements:
    """Elements of a group. ids, nmat: (n,); nodes: (n, k) indices in PAK's order, -1 absent; fields: (n,) others."""

    ids: Ints
    nmat: Ints
    nodes: Ints
    fields: dict[str, Any]
    line: int


def kinds_of(
    netip: int, kind: Type, e: Elements, xyz: Floats, faults: Faults, warn: Callable[[int, str], None]
) -> Iterator[Kind]:
    """The kinds of elements in a group."""
    corners = kind.corners
    present = e.nodes[:, corners:] >= 0
    if netip == 3:
        yield from _hexahedra(e, present, warn)
        return
    if kind.family in ("plane", "shell") and corners == 4:
        yield from _flat(e, present, faults)
        return
    full = {count for count in kind.kinds if count > corners}
    some, whole = present.any(axis=1), present.all(axis=1)
    if not some.any():
        order = list(kind.order[:corners] if kind.order else range(corners))
        yield kind.kinds[corners], slice(None), e.nodes[:, np.argsort(order)], {}
        return
    _refuse_partial(faults, some & ~whole, e, f"elements of type {netip}")
    name = kind.kinds[max(full)]
    order = list(kind.order or range(corners))
    nodes = e.nodes[whole]
    if netip in SOLIDS:
        nodes = np.column_stack([nodes[:, np.argsort(order)], nodes[:, corners:]])
        place = middle_order(name, nodes, xyz)
        if place is None:
            warn(e.line, f"mid-side nodes of {name} do not lie at their edges: taken in VTK's order")
        else:
            nodes = np.column_stack([nodes[:, :corners], nodes[:, corners:][:, list(place)]])
    if not whole.all():
        yield kind.kinds[corners], ~some, e.nodes[~some][:, np.argsort(order)], {}
    yield name, whole, nodes, {}


def _refuse_partial(faults: Faults, partial: Any, e: Elements, what: str) -> None:
    if partial.any():
        faults.add(e.line, 1, f"{int(partial.sum())} {what} have some of their mid-side nodes alone",
                              f"element {int(e.ids[np.argmax(partial)])}", "all or none")  # fmt: skip
        faults.stop()


def _hexahedra(e: Elements, present: Any, warn: Callable[[int, str], None]) -> Iterator[Kind]:
    back = np.argsort(HEX_ORDER[:8])
    corners = e.nodes[:, :8][:, back]
    some = quadratic = np.zeros(len(corners), bool)
    if present.any():
        some = present.any(axis=1)
        quadratic = present[:, :12].all(axis=1)
    odd = some & ~quadratic
    together = np.zeros(len(corners), bool)
    for a, b in TABLE["hex8"].shape.edges:
        together |= corners[:, a] == corners[:, b]
    plain = ~some & ~together
    if plain.all():
        yield "hex8", slice(None), corners, {}
        return
    if plain.any():
        yield "hex8", plain, corners[plain], {}
    for middle in (False, True):
        rows = quadratic & (present[:, 12] == middle) if present.any() else quadratic
        if rows.any():
            more = {"node_21": e.nodes[rows][:, 20]} if middle else {}
            yield "hex20", rows, e.nodes[rows][:, np.argsort(HEX_ORDER[:20])], more
    if odd.any():
        warn(e.line, f"{int(odd.sum())} hexahedra have some mid-side nodes alone: read as hex8, the others kept")
        yield "hex8", odd, corners[odd], {"nodes_9_21": e.nodes[odd][:, 8:]}
    rows = np.flatnonzero(together & ~some)
    if len(rows):
        found, left = uncollapsed(corners[rows])
        for name, (which, nodes) in found.items():
            yield name, rows[which], nodes, {}
        if len(left):
            warn(e.line, f"{len(left)} hexahedra have corners that coincide and are no wedges, pyramids or tetrahedra")
            yield "hex8", rows[left], corners[rows[left]], {}


def _flat(e: Elements, present: Any, faults: Faults) -> Iterator[Kind]:
    """Quadrilaterals, and triangles that are written as such with two corners that coincide."""
    kinds = present[:, :4].all(axis=1) + 1 * present.all(axis=1)
    _refuse_partial(faults, (present.any(axis=1)) & (kinds == 0), e, "quadrilaterals")
    n = e.nodes
    triangle = (kinds == 0) & (n[:, 2] == n[:, 3])
    choices = [("quad4", (kinds == 0) & ~triangle, 4), ("tri3", triangle, 3), ("quad8", kinds == 1, 8),
               ("quad9", kinds == 2, 9)]  # fmt: skip
    for name, rows, count in choices:
        if rows.all():
            yield name, slice(None), np.ascontiguousarray(n[:, :count]), {}
        elif rows.any():
            yield name, rows, n[rows][:, :count], {}
