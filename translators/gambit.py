"""Reader of Gambit neutral files (.neu): nodes, elements, groups and boundary conditions.

Source: Gambit user's guide, appendix C, "Gambit neutral file format"; face numbers as gmsh's writer has them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import TABLE
from zrno.translators.gambit_elements import KINDS, RING_TO_ROWS, face_nodes
from zrno.translators.gambit_text import Section, sections
from zrno.translators.model import ElementBlock, Floats, Ints, Model, NodeSet, Part, Source
from zrno.translators.streams import row_starts
from zrno.translators.text import MAX_FAULTS, Faults, read_bytes

_GROUP = re.compile(r"GROUP:\s*(\d{1,9})\s*ELEMENTS:\s*(\d{1,18})\s*MATERIAL:\s*(\S+)\s*NFLAGS:\s*(\d{1,9})", re.I)
_NAME_WIDTH = 32
_EXACT = 2**53  # doubles hold every whole number up to here
_ONCE = ("CONTROL INFO", "NODAL COORDINATES", "ELEMENTS/CELLS")


@dataclass(slots=True)
class _Mesh:
    """What is read so far. counts: the six of the heading; ids, kind, row: of all elements in the file's order, the
    kind (place in `blocks`) and the row there; by_id: the order that sorts ids."""

    counts: list[int] = field(default_factory=list)
    tags: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    xyz: Floats = field(default_factory=lambda: np.empty((0, 3)))
    blocks: list[tuple[str, Ints, Ints]] = field(default_factory=list)  # kind, element numbers, nodes (tags, VTK order)
    ids: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    kind: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    row: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    by_id: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    groups: list[tuple[Part, Ints, Section]] = field(default_factory=list)
    conditions: list[tuple[str, int, Ints, Section]] = field(default_factory=list)  # name, type, numbers
    coded: int = 0  # conditions with codes other than 0


def read(path: Path | str) -> Model:
    """Read a mesh. Raises InputError with the place of what is wrong."""
    data = read_bytes(path)
    faults = Faults(str(path))
    model = Model(title=Path(path).stem, format="gambit")
    mesh = _Mesh()
    skipped: dict[str, int] = {}
    done: set[str] = set()
    for section in sections(data, faults):
        name = section.name
        if name in _ONCE and name in done:
            section.fail(0, f"{name} stands twice", expected="one section of this name")
        elif name == "CONTROL INFO":
            _control(section, mesh, model)
        elif name and not mesh.counts:
            section.fail(0, "CONTROL INFO does not stand first", expected="CONTROL INFO")
        elif name == "NODAL COORDINATES":
            _nodes(section, mesh)
        elif name == "ELEMENTS/CELLS":
            _elements(section, mesh)
        elif name == "ELEMENT GROUP":
            _group(section, mesh)
        elif name == "BOUNDARY CONDITIONS":
            _condition(section, mesh, model)
        elif name:
            skipped[name] = skipped.get(name, 0) + 1
        done.add(name)
    if not len(mesh.tags):
        faults.add(1 + data.count(b"\n"), 1, "a mesh without nodes", expected="NODAL COORDINATES")
        faults.stop()
    model.warnings += [f"{path}: {count} section(s) {name} are not read" for name, count in skipped.items()]
    _assemble(mesh, model, faults)
    return model


def _control(section: Section, mesh: _Mesh, model: Model) -> None:
    """Title, version and the counts NUMNP NELEM NGRPS NBSETS NDFCD NDFVL."""
    lines = section.lines(6)
    model.version = section.version
    model.title = lines[1].strip() or model.title
    words = lines[5].split()
    if len(words) < 6 or not all(re.fullmatch(r"\d{1,18}", word) for word in words[:6]):
        section.fail(5, "not the counts of a mesh", lines[5].strip(), "NUMNP NELEM NGRPS NBSETS NDFCD NDFVL")
    mesh.counts = [int(word) for word in words[:6]]
    if mesh.counts[4] not in (2, 3):
        section.fail(5, "coordinates of this number of directions are not read", words[4], "NDFCD 2 or 3")


def _nodes(section: Section, mesh: _Mesh) -> None:
    """Number and coordinates of each node."""
    count, directions = mesh.counts[0], mesh.counts[4]
    table = section.reals(count, 1 + directions, "nodes")
    mesh.tags = _whole(table[:, :1], section, 0)[:, 0]
    if mesh.tags.min(initial=1) < 1:
        row = int(np.argmax(mesh.tags < 1))
        section.fail(row, "not a node number", str(int(mesh.tags[row])), "a number from 1")
    if not np.isfinite(table).all():
        section.fail(int(np.argmin(np.isfinite(table).all(axis=1))), "a coordinate is not finite")
    mesh.xyz = np.zeros((count, 3))
    mesh.xyz[:, :directions] = table[:, 1:]


def _elements(section: Section, mesh: _Mesh) -> None:
    """Number, type, count of nodes and nodes of each element, seven nodes a line."""
    count = mesh.counts[1]
    values = section.element_numbers()

    def measure(at: int, head: list[int]) -> tuple[int, int]:
        if len(head) < 3 or at + 3 + head[2] > len(values):
            section.fail(-1, "the elements end too early", expected=f"{count} elements")
        if (head[1], head[2]) not in KINDS:
            message = f"elements of type {head[1]} with {head[2]} nodes are not read"
            read_are = "elements of first order; of second order edges, areas, bricks, tetrahedra"
            section.fail_at_number(values, at, message, read_are)
        return 3 + head[2], 1

    starts, end = row_starts(values, count, slice(1, 3), measure)
    if end < len(values):
        section.fail(-1, f"more than the {count} elements that NELEM announces", expected="as many as NELEM")
    types, sizes = values[starts + 1], values[starts + 2]
    mesh.ids, mesh.kind, mesh.row = values[starts], np.zeros(count, np.int64), np.zeros(count, np.int64)
    mesh.by_id = np.argsort(mesh.ids, kind="stable")
    for pair in dict.fromkeys(zip(types.tolist(), sizes.tolist(), strict=True)):
        kind, order = KINDS[pair]
        which = np.flatnonzero((types == pair[0]) & (sizes == pair[1]))
        nodes = values[(starts[which] + 3)[:, None] + np.array(order)]
        mesh.kind[which], mesh.row[which] = len(mesh.blocks), np.arange(len(which))
        mesh.blocks.append((kind, mesh.ids[which], nodes))


def _group(section: Section, mesh: _Mesh) -> None:
    """A group's number, count, material, flags and name; then flags, then element numbers."""
    head, name = section.lines(2)
    match = _GROUP.search(head)
    if match is None:
        section.fail(0, "not the heading of a group", head.strip(), "GROUP: n ELEMENTS: n MATERIAL: n NFLAGS: n")
    count, flags = int(match[2]), int(match[4])
    values = section.integers(2)
    extra = len(values) - count
    if extra < 0 or extra not in (flags, flags + 1):  # some programs write a flag and announce none
        section.fail(-1, "a group of another length than announced", str(extra), f"{flags} flags, {count} elements")
    material = re.match(r"(\d{1,9})(\.0*)?$", match[3])
    part = Part(int(match[1]), name.strip(), int(material[1]) if material else None)
    part.source = Source(section.path, section.line)
    mesh.groups.append((part, values[extra:], section))


def _condition(section: Section, mesh: _Mesh, model: Model) -> None:
    """Name, type (0 nodes, 1 faces), count, values an entry and codes; then the entries."""
    head = section.lines(1)[0]
    name, words = head[:_NAME_WIDTH].strip(), head[_NAME_WIDTH:].split()
    if len(words) < 3 or not all(re.fullmatch(r"-?\d{1,18}", word) for word in words):
        name, *words = head.split() or [""]
    if len(words) < 3 or not all(re.fullmatch(r"-?\d{1,18}", word) for word in words):
        section.fail(0, "not the heading of a boundary condition", head.strip(), "name, type, count, values, code")
    kind, count, values = (int(word) for word in words[:3])
    if kind not in (0, 1) or not 0 <= values <= 100:
        section.fail(0, "a boundary condition of this type is not read", head.strip(), "type 0 (nodes) or 1 (faces)")
    width = 3 if kind else 1
    table = section.reals(count, width + values, "entries", first=1)
    entries = _whole(table[:, :width], section, 1)
    mesh.coded += any(int(word) for word in words[3:])
    mesh.conditions.append((name, kind, entries, section))
    if count and values:
        said = f"{values} value(s) of each of its {count} entries are not carried"
        model.warnings.append(f"{section.path}:{section.line}: boundary condition {name}: {said}")


def _whole(table: Floats, section: Section, first: int) -> Ints:
    """Columns that must hold whole numbers; first: the line of the first row."""
    good = (np.abs(table) < _EXACT) & (np.rint(table) == table)
    if not good.all():
        row = int(np.argmin(good.all(axis=1)))
        section.fail(
            first + row, "not a whole number", f"{table[row][~good[row]][0]:g}", "numbers of nodes, elements, faces"
        )
    return table.astype(np.int64)


def _assemble(mesh: _Mesh, model: Model, faults: Faults) -> None:
    order = np.argsort(mesh.tags, kind="stable")
    ordered = mesh.tags[order]
    twice = ordered[1:][ordered[1:] == ordered[:-1]]
    if len(twice):
        faults.add(1, 1, "a node number stands twice", str(int(twice[0])), "numbers that differ")
        faults.stop()
    model.node_ids, model.xyz = mesh.tags, mesh.xyz
    for kind, ids, nodes in mesh.blocks:
        place = np.minimum(np.searchsorted(ordered, nodes), len(ordered) - 1)
        for row in np.flatnonzero((ordered[place] != nodes).any(axis=1))[:MAX_FAULTS].tolist():
            missing = int(nodes[row][ordered[place[row]] != nodes[row]][0])
            message = f"element {int(ids[row])} has a node that is not there"
            faults.add(1, 1, message, str(missing), "a node of NODAL COORDINATES")
        indices = order[place]
        if kind in RING_TO_ROWS:
            indices = _unfolded(kind, indices, model, faults.path)
        model.blocks.append(ElementBlock(kind, ids, indices, np.zeros(len(ids), np.int64)))
    faults.stop()
    top = max((TABLE[block.kind].dimension for block in model.blocks), default=3)
    flat = bool((model.xyz[:, 2] == model.xyz[0, 2]).all())
    model.dimension = top if top in (1, 2) and flat else 3
    _parts(mesh, model)
    _sets(mesh, model, order, ordered)


def _unfolded(kind: str, nodes: Ints, model: Model, path: str) -> Ints:
    """Bricks and pyramids whose base was numbered around and not, as the format has it, in rows.

    Read in rows, such a base crosses itself: the edge 0-1 runs against the edge 3-2.
    """
    base = model.xyz[nodes[:, :4]]
    along = np.einsum("ij,ij->i", base[:, 1] - base[:, 0], base[:, 2] - base[:, 3])
    crossed = int((along < 0).sum())
    if 2 * crossed > len(nodes):
        model.warnings.append(f"{path}: {len(nodes)} {kind} elements are numbered around their faces, not in rows")
        return nodes[:, list(RING_TO_ROWS[kind])]
    if crossed:
        model.warnings.append(f"{path}: {crossed} of {len(nodes)} {kind} elements cross themselves")
    return nodes


def _rows_of(ids: Ints, mesh: _Mesh, section: Section) -> Ints:
    """Places of elements in the file's order."""
    place = np.minimum(np.searchsorted(mesh.ids, ids, sorter=mesh.by_id), max(len(mesh.ids) - 1, 0))
    rows = mesh.by_id[place] if len(mesh.ids) else np.zeros(0, np.int64)
    there = mesh.ids[rows] == ids if len(mesh.ids) else np.zeros(len(ids), bool)
    if not there.all():
        section.fail(0, "an element is not there", str(int(ids[~there][0])), "a number of ELEMENTS/CELLS")
    return rows


def _parts(mesh: _Mesh, model: Model) -> None:
    """Each group is a part; elements of several are in that of the first."""
    none = -1
    owner = np.full(len(mesh.ids), none)
    again = 0
    for part, ids, section in mesh.groups:
        if part.id in model.parts:
            section.fail(0, "a group's number stands twice", str(part.id), "numbers that differ")
        rows = _rows_of(ids, mesh, section)
        again += int((owner[rows] != none).sum())
        owner[rows[owner[rows] == none]] = part.id
        model.parts[part.id] = part
    if again:
        model.warnings.append(f"{again} times an element belongs to a further group: it is in the part of its first")
    if (owner == none).any():
        rest = 1 + max(model.parts, default=0)
        model.parts[rest] = Part(rest, "ungrouped" if rest > 1 else "")
        owner[owner == none] = rest
    for i, block in enumerate(model.blocks):
        block.part[mesh.row[mesh.kind == i]] = owner[mesh.kind == i]
        for number in np.unique(block.part).tolist():
            part = model.parts[number]
            part.dimension = max(part.dimension or 0, TABLE[block.kind].dimension)


def _sets(mesh: _Mesh, model: Model, order: Ints, ordered: Ints) -> None:
    """Each boundary condition is a set: its nodes, or the nodes of its faces."""
    faces = 0
    for number, (name, kind, entries, section) in enumerate(mesh.conditions, 1):
        nodes: NDArray[Any]
        if kind == 0:
            place = np.minimum(np.searchsorted(ordered, entries[:, 0]), len(ordered) - 1)
            wrong = ordered[place] != entries[:, 0]
            if wrong.any():
                row = int(np.argmax(wrong))
                section.fail(1 + row, "a node is not there", str(int(entries[row, 0])), "a node's number")
            nodes = order[place]
        else:
            faces += 1
            nodes = _nodes_of_faces(mesh, model, entries, section)
        model.node_sets.append(NodeSet(number, name, np.unique(nodes), Source(section.path, section.line)))
    if mesh.coded:
        model.warnings.append(f"the codes of {mesh.coded} boundary condition(s) are not carried")
    if faces:
        model.warnings.append(f"{faces} boundary condition(s) of faces became node sets: the nodes of their faces")


def _nodes_of_faces(mesh: _Mesh, model: Model, entries: Ints, section: Section) -> Ints:
    rows = _rows_of(entries[:, 0], mesh, section)
    found = [np.zeros(0, np.int64)]
    for i, block in enumerate(model.blocks):
        mine = mesh.kind[rows] == i
        for face in np.unique(entries[mine, 2]).tolist():
            some = mine & (entries[:, 2] == face)
            local = face_nodes(block.kind, face)
            if local is None:
                row = int(np.argmax(some))
                section.fail(1 + row, f"a {block.kind} element has no such face", str(face), "a face's number")
            else:
                found.append(block.nodes[mesh.row[rows[some]]][:, local].ravel())
    return np.concatenate(found)
