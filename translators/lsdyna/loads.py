"""Loads, motions and initial velocities.

LS-DYNA's base acceleration has the sign opposite to the model's acceleration of the material; its pressure on a segment
acts against the right-hand normal as the model's does, and keeps its sign.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from zrno.translators.lsdyna.cards import Card, Table, heading
from zrno.translators.lsdyna.conditions import lifetime
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.lsdyna.sets import members_of, missing, node_places, nodes_of_parts
from zrno.translators.lsdyna.unread import keep
from zrno.translators.model import BodyLoad, FaceLoad, Floats, InitialVelocity, Ints, NodalLoad

LOADS = Registry()

_MOTIONS = {0: "velocity", 1: "acceleration", 2: "displacement"}
# LS-DYNA numbers directions 1-3 and rotations 5-7: 4 and 8 are along and about a vector.
_DOFS = {1: 1, 2: 2, 3: 3, 5: 4, 6: 5, 7: 6}


@LOADS("BOUNDARY_PRESCRIBED_MOTION_NODE", "BOUNDARY_PRESCRIBED_MOTION_SET", "BOUNDARY_PRESCRIBED_MOTION_RIGID")
def _motion(deck: Deck, block: Block, options: list[str]) -> bool:
    named = take(options, "ID")
    if options:
        return False
    kind = block.name.split("_")[3]
    rows = block.rows().tolist()
    while rows:
        number, name = heading(deck, block, rows, named)
        if not rows:
            break
        card = Card(deck, block, rows.pop(0), "target/i dof/i vad/i lcid/i sf vid/i death birth")
        if card.blank():
            continue
        used = [card.row]
        if (abs(card["dof"]) in (9, 10, 11) or card["vad"] == 4) and rows:
            used.append(rows.pop(0))
        dof, vad = card["dof"], card["vad"]
        direction = _along(deck, card.id("vid", "define")) if dof == 4 else None
        if vad not in _MOTIONS or not (dof in _DOFS or direction):
            keep(deck, block, np.array(used), f"motions of vad {vad}, dof {dof} are not read")
            continue
        scale = card.real("sf", 1.0) * (direction[1] if direction else 1.0)
        powers = {0: (1, -1), 1: (1, -2), 2: (1, 0)}[vad]
        if dof not in (5, 6, 7):
            powers = powers if not card["lcid"] else (0, 0)
            scale *= deck.frame.scale(length=powers[0], time=powers[1])
        load = NodalLoad(
            _MOTIONS[vad], np.empty(0, np.int64), np.array([direction[0] if direction else _DOFS[dof]]),
            np.array([scale]), card.id("lcid", "curve") or None, number, name, source=deck.source(block, card.row),
        )  # fmt: skip
        load.birth, load.death = lifetime(card["birth"], card["death"])
        target = card.id("target", {"NODE": "node", "SET": "set", "RIGID": "part"}[kind])
        if kind == "SET":
            load.set = target
        elif kind == "RIGID":
            load.native |= {"rigid_part": target, "dof": int(load.dofs[0]), "value": scale}
            deck.count("{n} motions of rigid parts stand on the nodes of the parts", 1, block, card.row)
        deck.model.nodal_loads.append(load)
        deck.late.append(lambda k=kind, t=target, one=load, row=card.row: _spread(deck, block, row, k, t, one))  # type: ignore[misc]
    return True


def _along(deck: Deck, vector: int) -> tuple[int, float] | None:
    """The direction 1-3 of a vector along an axis, and its sign; None for another vector."""
    values = deck.vectors.get(vector)
    if values is None or (values != 0).sum() != 1:
        return None
    axis = int(np.flatnonzero(values)[0])
    return axis + 1, float(np.sign(values[axis]))


def _spread(deck: Deck, block: Block, row: int, kind: str, target: int, load: NodalLoad) -> None:
    """Put a load on the nodes that it means."""
    if kind == "SET":
        nodes = node_places(deck, target, block, row)
    elif kind == "RIGID":
        nodes = nodes_of_parts(deck, np.array([target]))
    else:
        nodes = deck.found(np.array([target]), f"*{block.name}", block, row)
        nodes = nodes[nodes >= 0]
    load.nodes = nodes
    load.dofs, load.values = np.repeat(load.dofs, len(nodes)), np.repeat(load.values, len(nodes))


@LOADS("LOAD_NODE", "LOAD_NODE_POINT", "LOAD_NODE_SET")
def _node(deck: Deck, block: Block, options: list[str]) -> bool:
    if options:
        return False
    table = Table(deck, block, block.rows(blank=False), "target/i dof/i lcid/i sf cid/i m/i*3")
    of_set = block.name.endswith("_SET")
    targets = table.ids("target", "set" if of_set else "node")
    curves, systems = table.ids("lcid", "curve"), table.ids("cid", "define")
    known = np.isin(table["dof"], list(_DOFS))
    if not known.all():
        keep(deck, block, table.rows[~known], "forces that follow nodes are not read")
    blank = table["sf"] == 0  # a factor that is blank is 1; who wants none writes no load
    factors = np.where(blank, 1.0, table["sf"])
    keys = np.column_stack([curves, systems])[known]
    for curve, system in np.unique(keys, axis=0).tolist() if known.any() else ():
        own = np.flatnonzero(known & (curves == curve) & (systems == system))
        dofs = np.array([_DOFS[d] for d in table["dof"][own].tolist()])
        row = int(table.rows[own[0]])
        if not of_set:
            load = NodalLoad("force", targets[own], dofs, factors[own], curve or None, system=system,
                             source=deck.source(block, row))  # fmt: skip
            deck.model.nodal_loads.append(load)
            deck.late.append(lambda one=load, row=row: _there(deck, block, row, one))  # type: ignore[misc]
            continue
        for i, dof in zip(own.tolist(), dofs.tolist(), strict=True):
            row = int(table.rows[i])
            load = NodalLoad("force", np.empty(0, np.int64), np.array([dof]), factors[i : i + 1], curve or None,
                             set=int(targets[i]), system=system, source=deck.source(block, row))  # fmt: skip
            deck.model.nodal_loads.append(load)
            deck.late.append(lambda one=load, row=row, t=int(targets[i]): _spread(deck, block, row, "SET", t, one))  # type: ignore[misc]
    return True


def _there(deck: Deck, block: Block, row: int, load: NodalLoad) -> None:
    """Node numbers of a load to places."""
    places = deck.places(load.nodes)
    good = places >= 0
    deck.count(f"{{n}} nodes of *{block.name} are not in the deck", int((~good).sum()), block, row)
    load.nodes, load.dofs, load.values = places[good], load.dofs[good], load.values[good]


@LOADS("LOAD_BODY_X", "LOAD_BODY_Y", "LOAD_BODY_Z", "LOAD_BODY_PARTS")
def _body(deck: Deck, block: Block, options: list[str]) -> bool:
    rows = block.rows().tolist()
    if options or not rows:
        return not options
    if block.name.endswith("PARTS"):
        number = Card(deck, block, rows[0], "psid/i").id("psid", "set")
        deck.late.append(lambda: _only_parts(deck, block, rows[0], number))
        return True
    card = Card(deck, block, rows[0], "lcid/i sf lciddr/i center*3 cid/i")
    axis = "XYZ".index(block.name[-1])
    acceleration = [0.0, 0.0, 0.0]
    acceleration[axis] = -card.real("sf", 1.0)
    if card["lciddr"] or any(card.values("center")) or card["cid"]:
        deck.count("{n} body loads have a centre, a system or a curve of their own for dynamic relaxation: not read", 1,
                   block)  # fmt: skip
    x, y, z = acceleration
    curve = card.id("lcid", "curve") or None
    deck.model.body_loads.append(BodyLoad((x, y, z), curve, source=deck.source(block, card.row)))
    return True


def _only_parts(deck: Deck, block: Block, row: int, number: int) -> None:
    this = deck.sets.get(("part", number))
    if this is None:
        missing(deck, block, row, "part set", number)
        return
    parts = tuple(members_of(deck, this).tolist())
    for load in deck.model.body_loads:
        load.parts = parts


@LOADS("LOAD_SEGMENT", "LOAD_SEGMENT_SET")
def _segment(deck: Deck, block: Block, options: list[str]) -> bool:
    named = take(options, "ID")
    if options:
        return False
    of_set = "_SET" in block.name
    rows = block.rows().tolist()
    spec = "ssid/i lcid/i sf at" if of_set else "lcid/i sf at nodes/i*5"
    while rows:
        number, name = heading(deck, block, rows, named)
        if not rows:
            break
        card = Card(deck, block, rows.pop(0), spec)
        if card.blank():
            continue
        native: dict[str, Any] = {"at": card["at"]} if card["at"] else {}
        scale = card.real("sf", 1.0) or 1.0
        load = FaceLoad(np.empty((0, 4), np.int64), np.empty((0, 1)), 0, card.id("lcid", "curve") or None, number, name,
                        native=native, source=deck.source(block, card.row))  # fmt: skip
        if of_set:
            load.set = card.id("ssid", "set")
            nodes = None
        else:
            listed = card.values("nodes")
            if listed[4]:  # eight nodes stand on two cards: corners alone are loaded
                if rows:
                    rows.pop(0)
                deck.count("{n} segment loads of eight nodes are read by their corners", 1, block)
            nodes = deck.frame.moved_all(np.array(listed[:4]), "node")
        deck.model.face_loads.append(load)
        deck.late.append(
            lambda one=load, n=nodes, s=scale, row=card.row: _faces(deck, block, row, one, n, s)  # type: ignore[misc]
        )
    return True


def _faces(deck: Deck, block: Block, row: int, load: FaceLoad, nodes: Ints | None, scale: float) -> None:
    if nodes is None:
        this = deck.sets.get(("segment", load.set or 0))
        if this is None:
            missing(deck, block, row, "segment set", load.set or 0)
            return
        faces = members_of(deck, this)
        faces = faces[(faces >= 0).all(axis=1)]
    else:
        if nodes[3] == 0:
            nodes[3] = nodes[2]
        faces = deck.places(nodes)[None]
        if (faces < 0).any():
            deck.count(f"{{n}} segments of *{block.name} have nodes that are not in the deck", 1, block, row)
            faces = faces[:0]
    load.faces = np.where(np.arange(4) == 3, np.where(faces == faces[:, 2:3], -1, faces), faces)
    load.values = np.full((len(faces), 1), scale)


@LOADS("INITIAL_VELOCITY", "INITIAL_VELOCITY_NODE", "INITIAL_VELOCITY_GENERATION")
def _initial(deck: Deck, block: Block, options: list[str]) -> bool:
    if options:
        return False
    speed = deck.frame.scale(length=1, time=-1)
    if block.name.endswith("_NODE"):
        table = Table(deck, block, block.rows(blank=False), "nid/i v*3 w*3 icid/i")
        if len(table):
            v, w = table["v"] * speed, table["w"] * deck.frame.scale(time=-1)
            ids = table.ids("nid", "node")
            _warn_system(deck, block, table["icid"])
            deck.late.append(lambda: _of_nodes(deck, block, int(table.rows[0]), ids, v, w))
        return True
    rows = block.rows().tolist()
    if block.name.endswith("_GENERATION"):
        for i in range(0, len(rows), 2):
            _generation(deck, block, rows[i : i + 2], speed)
        return True
    card = Card(deck, block, rows[0] if rows else None, "nsid/i nsidex/i boxid/i irigid/i icid/i")
    second = Card(deck, block, rows[1] if len(rows) > 1 else None, "v*3 w*3")
    third = Card(deck, block, rows[2] if len(rows) > 2 and card["nsidex"] else None, "v*3 w*3")
    _warn_system(deck, block, np.array([card["icid"]]))
    nsid, other = card.id("nsid", "set"), card.id("nsidex", "set")
    box = card.id("boxid", "define")

    def velocity(of: Card) -> tuple[Floats, Floats]:
        return np.array(of.values("v")) * speed, np.array(of.values("w")) * deck.frame.scale(time=-1)

    first_velocity, other_velocity = velocity(second), velocity(third)
    row = rows[0] if rows else block.line

    def act() -> None:
        inside = np.ones(len(deck.model.xyz), bool)
        if nsid:
            inside[:] = False
            inside[node_places(deck, nsid, block, row)] = True
        if box and box in deck.boxes:
            low, high = deck.boxes[box]
            inside &= ((deck.model.xyz >= low) & (deck.model.xyz <= high)).all(axis=1)
        elif box:
            missing(deck, block, row, "box", box)
        if other:
            left = node_places(deck, other, block, row)
            inside[left] = False
            _same(deck, block, row, np.sort(left), *other_velocity, other)
        _same(
            deck, block, row, np.flatnonzero(inside), *first_velocity, nsid if nsid and not box and not other else None
        )

    deck.late.append(act)
    return True


def _warn_system(deck: Deck, block: Block, systems: Ints) -> None:
    if systems.any():
        deck.count("{n} initial velocities are in a local system: they are taken as global", 1, block)
    if deck.frame.transformations:
        deck.count("{n} initial velocities of a placed include are not turned with it", 1, block)


def _same(deck: Deck, block: Block, row: int, nodes: Ints, v: Floats, w: Floats, number: int | None) -> None:
    """One velocity for many nodes."""
    if not len(nodes) or not (v.any() or w.any()):
        return
    rotation = np.tile(w, (len(nodes), 1)) if w.any() else None
    deck.model.initial_velocities.append(
        InitialVelocity(nodes, np.tile(v, (len(nodes), 1)), rotation, number, deck.source(block, row))
    )


def _of_nodes(deck: Deck, block: Block, row: int, ids: Ints, v: Floats, w: Floats) -> None:
    places = deck.places(ids)
    good = places >= 0
    deck.count(f"{{n}} nodes of *{block.name} are not in the deck", int((~good).sum()), block, row)
    rotation = w[good] if w.any() else None
    deck.model.initial_velocities.append(
        InitialVelocity(places[good], v[good], rotation, source=deck.source(block, row))
    )


def _generation(deck: Deck, block: Block, rows: list[int], speed: float) -> None:
    """A velocity and a rotation about an axis, of a part set (1), a part (2) or a node set (3)."""
    card = Card(deck, block, rows[0], "id/i styp/i omega v*3 ivatn/i icid/i")
    second = Card(deck, block, rows[1] if len(rows) > 1 else None, "centre*3 axis*3 phase/i irigid/i")
    if card.blank() and second.blank():
        return
    _warn_system(deck, block, np.array([card["icid"]]))
    if second["phase"]:
        deck.count("{n} initial velocities begin after dynamic relaxation (PHASE): that is not read", 1, block)
    kind = card["styp"]
    target = card.id("id", {1: "set", 2: "part", 3: "set"}.get(kind, "other"))
    v = np.array(card.values("v")) * speed
    centre = np.array(second.values("centre")) * deck.frame.length
    axis = np.array(second.values("axis"))
    length = np.linalg.norm(axis)
    omega = card.real("omega") * deck.frame.scale(time=-1) * (axis / length if length > 0 else np.zeros(3))
    row = card.row

    def act() -> None:
        if kind == 1 and ("part", target) in deck.sets:
            nodes = nodes_of_parts(deck, members_of(deck, deck.sets["part", target]))
        elif kind == 1:
            missing(deck, block, row, "part set", target)
            return
        elif kind == 2:
            nodes = nodes_of_parts(deck, np.array([target]))
        elif kind == 3:
            nodes = np.sort(node_places(deck, target, block, row))
        else:
            nodes = np.arange(len(deck.model.xyz))
        if not len(nodes):
            return
        velocity = v + np.cross(omega, deck.model.xyz[nodes] - centre)
        if not np.isfinite(velocity).all():
            deck.fault(block.file, row, 0, "the velocities are not finite numbers", str(target))
        rotation = np.tile(omega, (len(nodes), 1)) if omega.any() else None
        number = target if kind == 3 and not omega.any() else None
        deck.model.initial_velocities.append(
            InitialVelocity(nodes, velocity, rotation, number, deck.source(block, row))
        )

    deck.late.append(act)
