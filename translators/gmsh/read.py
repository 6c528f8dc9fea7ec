"""Reader of gmsh's .msh, versions 2.2 and 4.1, text and binary, without the gmsh package.

Physical groups of the highest dimension become parts; groups of lower dimension, and all named groups, node sets.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from zrno.translators.gmsh import sections
from zrno.translators.gmsh.numbers import Numbers
from zrno.translators.gmsh.sections import NO_GROUP, Mesh, Run
from zrno.translators.model import ElementBlock, Ints, Model, NodeSet, Part, Source
from zrno.translators.text import Faults, read_bytes

_HEADING = re.compile(rb"^\$(?!End)([A-Za-z]+)[ \t]*\r?\n", re.MULTILINE)


def read(path: Path | str) -> Model:
    """Read a mesh. Raises InputError with the fault's place; version 4.0 and partitioned meshes are such faults."""
    data = read_bytes(path)
    faults = Faults(str(path))
    version, order, position = _format(data, faults)
    mesh = Mesh()
    for name, first, end in _sections(data, position, faults):
        line = 1 + data.count(b"\n", 0, first)
        if name == "PhysicalNames":
            sections.physical_names(mesh, data[first:end], line, faults)
        elif name == "PartitionedEntities":
            faults.add(line, 1, "partitioned meshes are not read", expected="a mesh in one piece")
            faults.stop()
        elif name in ("Nodes", "Elements") and version == "2.2":
            text, _, _ = data[first:end].partition(b"\n")
            if not text.strip().isdigit():
                faults.add(line, 1, f"no count of ${name}", text.decode("latin-1").strip(), "a whole number")
                faults.stop()
            numbers = Numbers(faults, data, first + len(text) + 1, end, name, order)
            (sections.nodes_22 if name == "Nodes" else sections.elements_22)(mesh, numbers, int(text))
        elif name in ("Entities", "Nodes", "Elements"):
            numbers = Numbers(faults, data, first, end, name, order)
            {"Entities": sections.entities_41, "Nodes": sections.nodes_41, "Elements": sections.elements_41}[name](
                mesh, numbers
            )
    if not len(mesh.tags):
        faults.add(1 + data.count(b"\n"), 1, "a mesh without nodes", expected="$Nodes")
        faults.stop()
    return _model(mesh, str(path), version, faults, data)


def _format(data: bytes, faults: Faults) -> tuple[str, str, int]:
    """Version, byte order of a binary file ("" of text), and where the sections begin."""
    match = re.search(rb"^\$MeshFormat[ \t]*\r?\n[ \t]*(\S+)[ \t]+(\d)[ \t]+(\d+)[ \t]*\r?\n", data, re.MULTILINE)
    if match is None:
        faults.add(1, 1, "not a gmsh mesh", expected="$MeshFormat, then version, file type and data size")
        faults.stop()
    assert match is not None
    version = match[1].decode("latin-1")
    line = 1 + data.count(b"\n", 0, match.start(1))
    if version not in ("2.2", "4.1"):
        faults.add(line, 1, "this version of .msh is not read", version, "2.2 or 4.1 (gmsh -0 -format msh41 FILE)")
        faults.stop()
    if match[3] != b"8":
        faults.add(line, 1, "this data size is not read", match[3].decode(), "8")
        faults.stop()
    if match[2] == b"0":
        return version, "", match.end()
    return version, "<" if data[match.end() : match.end() + 4] == b"\x01\0\0\0" else ">", match.end() + 4


def _sections(data: bytes, position: int, faults: Faults) -> Iterator[tuple[str, int, int]]:
    """Name, first byte behind the heading, first byte of the closing mark, of each section in turn."""
    while (match := _HEADING.search(data, position)) is not None:
        name = match[1].decode("ascii")
        end = data.find(b"$End" + match[1], match.end())
        if end < 0:
            faults.add(1 + data.count(b"\n"), 1, f"the file ends inside ${name}", expected=f"$End{name}")
            faults.stop()
        yield name, match.end(), end
        position = end + 1


def _model(mesh: Mesh, path: str, version: str, faults: Faults, data: bytes) -> Model:
    model = Model(title=Path(path).stem, format="msh", version=version, node_ids=mesh.tags, xyz=mesh.xyz)
    runs = [run for run in mesh.runs if len(run.ids)]
    top = max((run.element.dimension for run in runs), default=0)
    flat = bool((mesh.xyz[:, 2] == mesh.xyz[0, 2]).all())
    model.dimension = top if top in (1, 2) and flat else 3
    indices = _indices(mesh, runs, faults, data)
    parts = _parts(mesh, runs, top, path, model)
    by_kind: dict[str, list[int]] = {}
    for i, run in enumerate(runs):
        by_kind.setdefault(run.element.name, []).append(i)
    for kind, which in by_kind.items():
        nodes = np.concatenate([indices[i] for i in which])
        order = runs[which[0]].element.from_gmsh
        model.blocks.append(
            ElementBlock(
                kind,
                np.concatenate([runs[i].ids for i in which]),
                np.ascontiguousarray(nodes[:, list(order)]) if order else nodes,
                np.concatenate([parts[i] for i in which]),
            )
        )
    _node_sets(mesh, runs, indices, top, path, model)
    return model


def _indices(mesh: Mesh, runs: list[Run], faults: Faults, data: bytes) -> list[Ints]:
    """Node tags to places in the node list; a fault for an element whose node there is not."""
    order = np.argsort(mesh.tags, kind="stable")
    tags = mesh.tags[order]
    if len(tags) > 1 and (tags[1:] == tags[:-1]).any():
        double = int(tags[1:][tags[1:] == tags[:-1]][0])
        faults.add(
            _line_of(data, b"Nodes", double), 1, "a node number stands twice", str(double), "numbers that differ"
        )
        faults.stop()
    indices = []
    for run in runs:
        place = np.minimum(np.searchsorted(tags, run.nodes), len(tags) - 1)
        for row in np.flatnonzero((tags[place] != run.nodes).any(axis=1))[:20].tolist():
            missing = int(run.nodes[row][tags[place[row]] != run.nodes[row]][0])
            element = int(run.ids[row])
            line = _line_of(data, b"Elements", element)
            faults.add(line, 1, f"element {element} has a node that is not there", str(missing), "a node of $Nodes")
        indices.append(order[place])
    faults.stop()
    return indices


def _line_of(data: bytes, section: bytes, number: int) -> int:
    """The last line of a text section that begins with a number; else the section's own line."""
    start = data.index(b"$" + section)
    rows = list(re.finditer(rb"^[ \t]*%d[ \t\r\n]" % number, data[start : data.index(b"$End" + section)], re.MULTILINE))
    return 1 + data.count(b"\n", 0, start + (rows[-1].start() if rows else 0))


def _parts(mesh: Mesh, runs: list[Run], top: int, path: str, model: Model) -> list[Ints]:
    """Fills model.parts from the groups (without any: the entities) of the highest dimension; part numbers of each run,
    0 for elements of lower dimension."""
    tops = [run for run in runs if run.element.dimension == top]
    grouped = any((run.groups != NO_GROUP).any() for run in tops)
    rest = 1 + max((int(run.groups.max()) for run in tops), default=0)
    numbers = []
    for run in runs:
        if run.element.dimension != top:
            numbers.append(np.zeros(len(run.ids), np.int64))
        elif not grouped:
            numbers.append(run.entities)
        else:
            numbers.append(np.where(run.groups == NO_GROUP, rest, run.groups))
            if run.more_groups:
                names = ", ".join(mesh.names.get((top, g), (str(g), 0))[0] for g in run.more_groups)
                model.warnings.append(
                    f"{path}: {len(run.ids)} {run.element.name} elements belong to further groups ({names}): "
                    "they are in the part of the first, and in the node sets of all"
                )
    found = [n for run, n in zip(runs, numbers, strict=True) if run.element.dimension == top]
    for number in np.unique(np.concatenate(found)).tolist() if found else ():
        name, line = mesh.names.get((top, number), ("", 0)) if grouped else ("", 0)
        if grouped and number == rest:
            name = "ungrouped"
        model.parts[number] = Part(number, name, dimension=top, source=Source(path, line) if line else None)
    return numbers


def _node_sets(mesh: Mesh, runs: list[Run], indices: list[Ints], top: int, path: str, model: Model) -> None:
    """A set for each group of lower dimension and each named group."""
    members: dict[tuple[int, int], list[Ints]] = {}
    for run, nodes in zip(runs, indices, strict=True):
        dimension = run.element.dimension
        for group in {*np.unique(run.groups).tolist(), *run.more_groups} - {NO_GROUP}:
            if dimension == top and (dimension, group) not in mesh.names:
                continue
            inside = nodes if group in run.more_groups else nodes[run.groups == group]
            members.setdefault((dimension, group), []).append(np.unique(inside))
    for (dimension, group), nodes_of in sorted(members.items()):
        name, line = mesh.names.get((dimension, group), ("", 0))
        source = Source(path, line) if line else None
        model.node_sets.append(NodeSet(group, name, np.unique(np.concatenate(nodes_of)), source))
