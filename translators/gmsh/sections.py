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
    _, ghosts = numbers.few("ii" if old else "nn")
    numbers.skip(2 * ghosts)  # ghost entities, which hold no elements of their own
    _entities(mesh, numbers, partitioned=True)


def _entities(mesh: Mesh, numbers: Numbers, *, partitioned: bool) -> None:
    old = numbers.encoding.version == "4.0"
    for dimension, count in enumerate(numbers.few("nnnn")):
        for _ in range(count):
            if partitioned:
                tag, *parent, partitions = numbers.few("iiii" if old else "iiin")
                mesh.parents[dimension, tag] = (parent[0], parent[1])
                numbers.skip(partitions)
            else:
                (tag,) = numbers.few("i")
            numbers.skip(6 if dimension or old else 3, 8)  # corners of its box
            groups = numbers.ints(several).tolist() if (several := numbers.few("n")[0]) else []
            if dimension:
                numbers.skip(numbers.few("n")[0])  # what bounds it
            mesh.groups_of_entity[dimension, tag] = list(dict.fromkeys(map(abs, groups)))


def nodes_2(mesh: Mesh, numbers: Numbers, count: int) -> None:
    """$Nodes of version 2 behind its count."""
    tags, points = numbers.tagged_points(count)
    mesh.tags, mesh.xyz = np.concatenate((mesh.tags, tags)), np.concatenate((mesh.xyz, points))


def nodes_4(mesh: Mesh, numbers: Numbers) -> None:
    """$Nodes of version 4: blocks of tags and coordinates (and parameters on the entity)."""
    old = numbers.encoding.version == "4.0"
    blocks, total = numbers.few("nn" if old else "nnnn")[:2]
    tags, points = [mesh.tags], [mesh.xyz]
    for _ in range(blocks):
        first, second, parametric, count = numbers.few("iiin")
        dimension = second if old else first
        if not 0 <= dimension <= 3:
            numbers.fail("an entity of this dimension is not known", "0, 1, 2 or 3", -3 - (not old), str(dimension))
        if not count:
            continue
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
