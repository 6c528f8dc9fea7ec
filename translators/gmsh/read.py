"""Reader of gmsh's .msh, versions 2, 4.0 and 4.1, text and binary, without the gmsh package.

Physical groups of the highest dimension become parts; groups of lower dimension, and all named groups, node sets.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from zrno.translators.gmsh import assemble, elements, sections
from zrno.translators.gmsh.mesh import Mesh
from zrno.translators.gmsh.numbers import Encoding, Numbers
from zrno.translators.model import Model
from zrno.translators.text import Faults, read_bytes

_HEADING = re.compile(rb"^\$(?!End)([A-Za-z]\w*)[ \t]*\r?\n", re.MULTILINE)
_FORMAT = re.compile(rb"^\$MeshFormat[ \t]*\r?\n[ \t]*(\S+)[ \t]+(\d)[ \t]+(\d+)[ \t]*\r?\n", re.MULTILINE)
_VERSIONS = {"2": "2.2", "2.0": "2.2", "2.1": "2.2", "2.2": "2.2", "4": "4.0", "4.0": "4.0", "4.1": "4.1"}
_ORDERS = {b"\1\0\0\0": "<", b"\0\0\0\1": ">"}
_ENTITIES = {"Entities": sections.entities, "PartitionedEntities": sections.partitioned_entities}
_NODES_AND_ELEMENTS = {"Nodes": sections.nodes_4, "Elements": elements.elements_4}
_SKIPPED = {
    "Periodic": "links of periodic nodes are not carried",
    "GhostElements": "ghost elements are not carried: each element is read once",
}


def read(path: Path | str) -> Model:
    """Read a mesh. Raises InputError with the place of what is wrong."""
    data = read_bytes(path)
    faults = Faults(str(path))
    encoding, position = _format(data, faults)
    mesh = Mesh()
    skipped: dict[str, list[int]] = {}
    for name, first, end, line in _sections(data, position, faults):
        if name == "PhysicalNames":
            sections.physical_names(mesh, data[first:end], line, faults)
        elif name == "Comments":
            sections.remarks(mesh, data[first:end])
        elif name in ("Nodes", "Elements") and encoding.version == "2.2":
            _section_2(mesh, name, data, first, end, line, encoding, faults)
        elif name in _NODES_AND_ELEMENTS or (name in _ENTITIES and encoding.version != "2.2"):
            numbers = Numbers(faults, data, first, end, name, encoding, integers=name == "Elements")
            (_NODES_AND_ELEMENTS | _ENTITIES)[name](mesh, numbers)
            _warn_left(mesh, numbers, name, line)
        elif name != "MeshFormat":
            skipped.setdefault(name, []).append(line)
    if not len(mesh.tags):
        faults.add(1 + data.count(b"\n"), 1, "a mesh without nodes", expected="$Nodes")
        faults.stop()
    if encoding.version != "2.2":
        elements.give_groups(mesh)
    for name, lines in skipped.items():
        times = f" ({len(lines)} sections)" if len(lines) > 1 else ""
        mesh.warnings.append(f"line {lines[0]}: ${name}{times} is skipped: {_SKIPPED.get(name, 'not part of a mesh')}")
    return assemble.model_of(mesh, str(path), encoding.version, faults, data)


def _section_2(mesh: Mesh, name: str, data: bytes, first: int, end: int, line: int, encoding: Encoding,
               faults: Faults) -> None:  # fmt: skip
    """$Nodes and $Elements of version 2: a line with a count, then rows."""
    text, newline, _ = data[first:end].partition(b"\n")
    count = text.strip()
    if not count.isdigit() or len(count) > 18:
        faults.add(line, 1, f"no count of ${name}", count[:40].decode("latin-1"), "a whole number")
        faults.stop()
    start = first + len(text) + len(newline)
    numbers = Numbers(faults, data, start, end, name, encoding, integers=name == "Elements")
    if name == "Nodes":
        sections.nodes_2(mesh, numbers, int(count))
    else:
        elements.elements_2(mesh, numbers, int(count))
    _warn_left(mesh, numbers, name, line)


def _warn_left(mesh: Mesh, numbers: Numbers, name: str, line: int) -> None:
    """Numbers behind the last that was asked for; a binary section ends with a newline."""
    if numbers.left > (2 if numbers.binary else 0):
        unit = "bytes" if numbers.binary else "numbers"
        mesh.warnings.append(f"line {line}: the last {numbers.left} {unit} of ${name} are past its counts: left out")


def _format(data: bytes, faults: Faults) -> tuple[Encoding, int]:
    """The encoding, and where the sections begin."""
    match = _FORMAT.search(data)
    if match is None:
        if data.lstrip().startswith(b"$NOD"):
            hint = "version 2.2 or later (gmsh -0 -format msh41 FILE)"
            faults.add(1, 1, "version 1 of .msh is not read", "$NOD", hint)
        else:
            faults.add(1, 1, "not a gmsh mesh", expected="$MeshFormat, then version, file type and data size")
        faults.stop()
    assert match is not None
    said = match[1][:40].decode("latin-1")
    version = _VERSIONS.get(said, "")
    line = 1 + data.count(b"\n", 0, match.start(1))
    if not version:
        faults.add(line, 1, "this version of .msh is not read", said, "2.2, 4.0 or 4.1 (gmsh -0 -format msh41 FILE)")
    if match[3] not in ((b"8",) if version == "2.2" else (b"4", b"8")):
        said = match[3][:40].decode("latin-1")
        faults.add(line, 1 + match.start(3) - match.start(1), "this data size is not read", said, "8")
    if match[2] not in (b"0", b"1"):
        said = match[2].decode("latin-1")
        faults.add(line, 1 + match.start(2) - match.start(1), "no such file type", said, "0 for text, 1 for binary")
    faults.stop()
    if match[2] == b"0":
        return Encoding(version, ""), match.end()
    one = data[match.end() : match.end() + 4]
    if one not in _ORDERS:
        faults.add(line + 1, 1, "the byte order cannot be told", expected="the number 1 in 4 bytes")
        faults.stop()
    return Encoding(version, _ORDERS[one], int(match[3])), match.end() + 4


def _sections(data: bytes, position: int, faults: Faults) -> Iterator[tuple[str, int, int, int]]:
    """Name, first byte behind the heading, first byte of the closing mark, line behind the heading, of each section."""
    line, counted = 1, 0
    while (match := _HEADING.search(data, position)) is not None:
        name, first = match[1].decode("ascii"), match.end()
        line, counted = line + data.count(b"\n", counted, first), first
        end = data.find(b"\n$End" + match[1], first - 1) + 1
        if not end:
            end = data.find(b"$End" + match[1], first)
        if end < 0:
            faults.add(1 + data.count(b"\n"), 1, f"the file ends inside ${name}", expected=f"$End{name}")
            faults.stop()
        yield name, first, end, line
        position = end + 1
