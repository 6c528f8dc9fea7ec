"""*BOUNDARY_SPC, and what conditions refer to: *DEFINE_CURVE, coordinate systems, boxes, vectors."""

from __future__ import annotations

import numpy as np

from zrno.translators.lsdyna.cards import Card, Table, heading
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.lsdyna.sets import node_places
from zrno.translators.lsdyna.unread import keep
from zrno.translators.model import Constraint, CoordinateSystem, Curve, Floats, Ints

CONDITIONS = Registry()

NEVER = 1e20  # a death time from which on nothing ends


def lifetime(birth: float, death: float) -> tuple[float | None, float | None]:
    """Birth and death as the model has them: None where it is from the start, or for ever."""
    return birth or None, death if 0 < death < NEVER else None


@CONDITIONS("BOUNDARY_SPC_NODE", "BOUNDARY_SPC_SET")
def _spc(deck: Deck, block: Block, options: list[str]) -> bool:
    named, limited = take(options, "ID"), "BIRTH" in options and "DEATH" in options
    if limited:
        options = [word for word in options if word not in ("BIRTH", "DEATH")]
    if options:
        return False
    of_set = "_SET" in block.name
    rows = block.rows()
    per = 1 + named + limited
    spec = "target/i cid/i dofs/i*6"
    if per == 1 and not of_set:
        table = Table(deck, block, block.rows(blank=False), spec)
        targets, systems = table.ids("target", "node"), table.ids("cid", "define")
        dofs = table["dofs"] != 0
        for system in np.unique(systems).tolist():
            own = systems == system
            _add(deck, block, targets[own], dofs[own], system, int(table.rows[own][0]))
        return True
    for start in range(0, len(rows), per):
        group = rows[start : start + per].tolist()
        number, name = heading(deck, block, group, named)
        if not group:
            break
        card = Card(deck, block, group[0], spec)
        if card.blank():
            continue
        birth, death = 0.0, 0.0
        if limited and len(group) > 1:
            times = Card(deck, block, group[1], "birth death")
            birth, death = times["birth"], times["death"]
        held = np.array(card.values("dofs")) != 0
        system = card.id("cid", "define")
        target = card.id("target", "set" if of_set else "node")
        if of_set:
            _of_set(deck, block, card.row, target, held, system, number, name, birth, death)
        else:
            _add(deck, block, np.array([target]), held[None], system, card.row, number, name, birth, death)
    return True


def _of_set(
    deck: Deck, block: Block, row: int, target: int, held: Ints, system: int, number: int, name: str, birth: float,
    death: float,
) -> None:  # fmt: skip
    constraint = Constraint(np.empty(0, np.int64), np.empty((0, 6), bool), number, name, target, system,
                            deck.source(block, row), *lifetime(birth, death))  # fmt: skip
    deck.model.constraints.append(constraint)

    def act() -> None:
        constraint.nodes = node_places(deck, target, block, row)
        constraint.dofs = np.tile(held, (len(constraint.nodes), 1))

    deck.late.append(act)


def _add(
    deck: Deck, block: Block, targets: Ints, held: Ints, system: int, row: int, number: int = 0, name: str = "",
    birth: float = 0.0, death: float = 0.0,
) -> None:  # fmt: skip
    constraint = Constraint(np.empty(0, np.int64), np.empty((0, 6), bool), number, name, None, system,
                            deck.source(block, row), *lifetime(birth, death))  # fmt: skip
    deck.model.constraints.append(constraint)

    def act() -> None:
        places = deck.places(targets)
        there = places >= 0
        if not there.all():
            deck.count(f"{{n}} nodes of *{block.name} are not in the deck", int((~there).sum()), block, row)
        constraint.nodes, constraint.dofs = places[there], held[there].astype(bool)

    deck.late.append(act)


@CONDITIONS("DEFINE_CURVE")
def _curve(deck: Deck, block: Block, options: list[str]) -> bool:
    title = take(options, "TITLE")
    if options:
        return False
    name, rows = block.titled(title, blank=False)
    if not len(rows):
        return True
    head = Card(deck, block, int(rows[0]), "lcid/i sidr/i sfa sfo offa offo dattyp/i lcint/i")
    number = head.id("lcid", "curve")
    points = Table(deck, block, rows[1:], "point/20*2")["point"]
    scale = np.array([head.real("sfa") or 1.0, head.real("sfo") or 1.0])
    offset = np.array([head.real("offa"), head.real("offo")])
    with np.errstate(over="ignore", invalid="ignore"):
        scaled = (points + offset) * scale if (offset != 0).any() or (scale != 1).any() else points
    if not np.isfinite(scaled).all():
        head.fault("sfa", "a curve's points are not finite numbers with its scale", "smaller factors")
    if head["sidr"]:
        deck.count("{n} curves are for dynamic relaxation too (SIDR): that is not read", 1, block)
    if number in deck.model.curves:
        deck.warn(block, f"curve {number} stands twice: the later one counts")
    if deck.frame.scales:
        deck.count("*INCLUDE_TRANSFORM: {n} curves are not scaled: what they mean is not known", 1, block)
    deck.model.curves[number] = Curve(number, name, np.ascontiguousarray(scaled), deck.source(block, int(rows[0])))
    return True


@CONDITIONS("DEFINE_BOX", "DEFINE_VECTOR")
def _region(deck: Deck, block: Block, options: list[str]) -> bool:
    title = take(options, "TITLE")
    if options:
        return False
    box = block.name.startswith("DEFINE_BOX")
    for row in block.rows().tolist()[int(title) :: 1 + title]:
        card = Card(deck, block, row, "id/i values*6")
        values = np.array(card.values("values")) * deck.frame.length
        number = card.id("id", "define")
        if box:
            deck.boxes[number] = (values[::2], values[1::2])
        else:
            deck.vectors[number] = values[3:] - values[:3]
    keep(deck, block, why="used for what refers to it, and not kept", quiet=True)
    return True


@CONDITIONS("DEFINE_COORDINATE_SYSTEM", "DEFINE_COORDINATE_VECTOR", "DEFINE_COORDINATE_NODES")
def _system(deck: Deck, block: Block, options: list[str]) -> bool:
    title = take(options, "TITLE")
    if options:
        return False
    name, found = block.titled(title)
    rows = found.tolist()
    if not rows:
        return True
    kind = block.name.split("_")[2]
    row = rows[0]
    length = deck.frame.length
    if kind == "NODES":
        card = Card(deck, block, row, "cid/i nodes/i*3 flag/i dir/a")
        number = card.id("cid", "define")
        nodes = deck.frame.moved_all(np.array(card.values("nodes")), "node")
        if card["dir"].upper() not in ("", "X"):
            return False
        deck.late.insert(0, lambda: _by_nodes(deck, block, row, number, name, nodes))
        return True
    if kind == "SYSTEM":
        card = Card(deck, block, row, "cid/i origin*3 along*3 cidl/i")
        second = Card(deck, block, rows[1] if len(rows) > 1 else None, "plane*3")
        origin = np.array(card.values("origin"))
        x, plane = np.array(card.values("along")) - origin, np.array(second.values("plane")) - origin
        if card["cidl"]:
            return False
    else:
        card = Card(deck, block, row, "cid/i x*3 plane*3 nid/i")
        origin, x, plane = np.zeros(3), np.array(card.values("x")), np.array(card.values("plane"))
        if card["nid"]:
            return False
    _put_system(deck, block, row, card.id("cid", "define"), name, origin * length, x, plane)
    return True


def _by_nodes(deck: Deck, block: Block, row: int, number: int, name: str, nodes: Ints) -> None:
    places = deck.places(nodes)
    if (places < 0).any():
        deck.count("{n} coordinate systems name nodes that are not in the deck", 1, block, row)
        return
    origin, along, plane = deck.model.xyz[places]
    _put_system(deck, block, row, number, name, origin, along - origin, plane - origin)


def _put_system(
    deck: Deck, block: Block, row: int, number: int, name: str, origin: Floats, x: Floats, plane: Floats
) -> None:
    """x: along the local x; plane: in the local xy plane."""
    z = np.cross(x, plane)
    lengths = np.linalg.norm(x), np.linalg.norm(z)
    if not (np.isfinite(lengths).all() and min(lengths) > 0):
        deck.fault(block.file, row, 0, "the axes of the coordinate system do not span a plane", str(number))
        return
    axes = np.array([x / lengths[0], np.cross(z, x) / (lengths[0] * lengths[1]), z / lengths[1]])
    if deck.frame.transformations:
        deck.count("{n} coordinate systems of a placed include are not turned with it", 1, block, row)
    deck.model.systems[number] = CoordinateSystem(number, name, "rectangular", origin, axes, deck.source(block, row))
