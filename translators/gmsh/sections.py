"""The sections of a .msh file but its elements: names, remarks, entities and nodes of versions 2, 4.0 and 4.1.

Sources: gmsh reference manual, "MSH file format" (4.1) and "Legacy formats" (2, 4.0); binary 4.0: what gmsh 4.0 read.
"""

from __future__ import annotations

import re

import numpy as np

from zrno.translators.gmsh.mesh import Mesh
from zrno.translators.gmsh.numbers import Numbers
from zrno.translators.text import Faults

_NAME = re.compile(rb'\s*(\d{1,9})\s+(-?\d{1,10})\s+"(.*)"\s*$')
_REMARK = re.compile(rb"zrno (title|parts|points) (.*)")
_PAIR = re.compile(rb"(\d):(\d{1,10})")
_RANGE = re.compile(rb"(\d{1,18}) (\d{1,18})")


def physical_names(mesh: Mesh, text: bytes, line: int, faults: Faults) -> None:
    """$PhysicalNames; `line` is the section's first."""
    for i, row in enumerate(text.splitlines()[1:], 1):
        match = _NAME.match(row)
        if match is not None:
            mesh.names[int(match[1]), abs(int(match[2]))] = (match[3].decode("utf-8", "replace"), line + i)
        elif row.strip():
            said = row[:80].decode("utf-8", "replace")
            faults.add(line + i, 1, "not a physical name", said, 'dimension, number, "name"')
    faults.stop()


def remarks(mesh: Mesh, text: bytes) -> None:
    """$Comments: what our own writer noted for us; other programs skip the section."""
    for match in _REMARK.finditer(text):
        said = match[2].rstrip(b"\r")
        if match[1] == b"title":
            mesh.title = said.decode("utf-8", "replace")
        elif match[1] == b"parts":
            mesh.lower_parts |= {(int(d), int(n)) for d, n in _PAIR.findall(said)}
        elif found := _RANGE.fullmatch(said):
            mesh.points = int(found[1]), int(found[2])


def entities(mesh: Mesh, numbers: Numbers) -> None:
    """$Entities: which physical groups an entity belongs to."""
    _entities(mesh, numbers, partitioned=False)


def partitioned_entities(mesh: Mesh, numbers: Numbers) -> None:
    """$PartitionedEntities: also, which entity a partition's entity is a piece of."""
    old = numbers.encoding.version == "4.0"
    counts = numbers.ints(2) if old else numbers.sizes(2)
    numbers.ints(2 * int(counts[1]))  # ghost entities, which hold no elements of their own
    _entities(mesh, numbers, partitioned=True)


def _entities(mesh: Mesh, numbers: Numbers, *, partitioned: bool) -> None:
    old = numbers.encoding.version == "4.0"
    for dimension, count in enumerate(numbers.sizes(4).tolist()):
        for _ in range(count):
            tag = int(numbers.ints(1)[0])
            if partitioned:
                parent_dimension, parent = numbers.ints(2).tolist()
                mesh.parents[dimension, tag] = (parent_dimension, parent)
                numbers.ints(int((numbers.ints(1) if old else numbers.sizes(1))[0]))
            numbers.reals(6 if dimension or old else 3)
            groups = numbers.ints(int(numbers.sizes(1)[0]))
            if dimension:
                numbers.ints(int(numbers.sizes(1)[0]))
            mesh.groups_of_entity[dimension, tag] = list(dict.fromkeys(np.abs(groups).tolist()))


def nodes_2(mesh: Mesh, numbers: Numbers, count: int) -> None:
    """$Nodes of version 2 behind its count."""
    mesh.tags, mesh.xyz = numbers.tagged_points(count)


def nodes_4(mesh: Mesh, numbers: Numbers) -> None:
    """$Nodes of version 4: blocks of tags and coordinates (and parameters on the entity)."""
    old = numbers.encoding.version == "4.0"
    blocks, total = numbers.sizes(2 if old else 4).tolist()[:2]
    tags, points = [mesh.tags], [mesh.xyz]
    for _ in range(blocks):
        first, second, parametric = numbers.ints(3).tolist()
        dimension = second if old else first
        count = int(numbers.sizes(1)[0])
        if not 0 <= dimension <= 3:
            numbers.fail("an entity of this dimension is not known", "0, 1, 2 or 3", -2 - (not old), str(dimension))
        width = 3 + (dimension if parametric else 0)
        if old:
            some, rows = numbers.tagged_points(count, width)
        else:
            some = numbers.tags(count)
            rows = numbers.reals(count * width).reshape(count, width)[:, :3]
        tags.append(some)
        points.append(rows)
    mesh.tags, mesh.xyz = np.concatenate(tags), np.concatenate(points)
    if len(mesh.tags) != total:
        mesh.warnings.append(f"$Nodes announces {total} nodes and holds {len(mesh.tags)}: those are read")
