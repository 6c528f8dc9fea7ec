"""Writer of gmsh's .msh, versions 4.1 and 2.2, text and binary: nodes, elements, parts and node sets.

Source: gmsh reference manual, "MSH file format" (4.1) and "Legacy formats" (2.2).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from zrno.translators.elements import TABLE, Element
from zrno.translators.gmsh.grouping import Grouping, Piece, group
from zrno.translators.gmsh.numbers import EXACT, LARGEST_INT
from zrno.translators.lost import report_lost
from zrno.translators.model import Floats, Ints, Model
from zrno.translators.report import Report
from zrno.translators.text import write_atomically

_CHUNK = 50_000  # rows formatted at a time
_SAID = {"title", "format", "version", "dimension", "node_ids", "xyz", "blocks", "parts", "node_sets", "warnings",
         "includes"}  # fmt: skip
_NOWHERE = "a mesh file has no place for it"


def write(model: Model, path: Path | str, *, version: str = "4.1", binary: bool = False) -> Report:
    """Write a model's mesh; the file appears whole or not at all.

    version: "4.1" or "2.2". Returns what the file cannot say. Raises ValueError for a model that is no mesh.
    """
    if version not in ("4.1", "2.2"):
        raise ValueError(f"version {version} of .msh is not written; expected 4.1 or 2.2")
    report = Report()
    writer = _Writer(model, Path(path).stem, version, binary, report)
    write_atomically(path, writer.chunks())
    return report


class _Writer:
    def __init__(self, model: Model, stem: str, version: str, binary: bool, report: Report) -> None:
        if not len(model.xyz):
            raise ValueError("the model has no nodes to write")
        if not np.isfinite(model.xyz).all():
            raise ValueError("a node's coordinate is not finite")
        self.version, self.binary = version, binary
        self.xyz = model.xyz
        self.title = model.title if model.title != stem else ""
        self.tags = _tags(model, report)
        self.grouping: Grouping = group(model, report, several=version == "4.1")
        report_lost([model], _SAID, "", _NOWHERE, report)
        report_lost(model.parts.values(), {"id", "name", "dimension", "source"}, "part", _NOWHERE, report)
        report_lost(model.blocks, {"kind", "ids", "nodes", "part"}, "element", _NOWHERE, report)
        report_lost(model.node_sets, {"id", "name", "nodes", "source"}, "node set", _NOWHERE, report)
        ids = [piece.ids for piece in self.grouping.pieces]
        if any((some < 1).any() for some in ids):
            raise ValueError("an element's number is below 1")
        largest = max(int(self.tags.max()), *(int(some.max()) for some in ids), 1)
        limit = LARGEST_INT if version == "2.2" else EXACT
        if largest > limit:
            raise ValueError(f"the number {largest} of a node or an element does not fit version {version} of .msh")

    def chunks(self) -> Iterator[bytes]:
        """The file, in pieces."""
        yield f"$MeshFormat\n{self.version} {int(self.binary)} 8\n".encode()
        yield (np.int32(1).tobytes() + b"\n" if self.binary else b"") + b"$EndMeshFormat\n"
        yield self._comments()
        if self.grouping.names:
            yield f"$PhysicalNames\n{len(self.grouping.names)}\n".encode()
            for (dimension, number), name in sorted(self.grouping.names.items()):
                yield f'{dimension} {number} "{name}"\n'.encode("utf-8", "replace")
            yield b"$EndPhysicalNames\n"
        if self.version == "2.2":
            sections = {"Nodes": self._nodes_22, "Elements": self._elements_22}
        else:
            sections = {"Entities": self._entities, "Nodes": self._nodes_41, "Elements": self._elements_41}
        for name, section in sections.items():
            yield f"${name}\n".encode()
            yield from section()
            yield (b"\n" if self.binary else b"") + f"$End{name}\n".encode()

    def _comments(self) -> bytes:
        """Remarks for our own reader; other programs skip them."""
        lines = []
        if self.title.isprintable() and self.title:
            lines.append(f"zrno title {self.title}")
        if self.grouping.lower_parts:
            lines.append("zrno parts " + " ".join(f"{dimension}:{n}" for dimension, n in self.grouping.lower_parts))
        if self.grouping.points:
            lines.append("zrno points {} {}".format(*self.grouping.points))
        text = "\n".join(["$Comments", *lines, "$EndComments", ""]) if lines else ""
        return text.encode("utf-8", "replace")

    # Version 2.2

    def _nodes_22(self) -> Iterator[bytes]:
        yield b"%d\n" % len(self.tags)
        if self.binary:
            records = np.empty(len(self.tags), [("tag", "<i4"), ("x", "<f8", 3)])
            records["tag"], records["x"] = self.tags, self.xyz
            yield records.tobytes()
            return
        for first in range(0, len(self.tags), _CHUNK):
            tags, rows = self.tags[first : first + _CHUNK].tolist(), self.xyz[first : first + _CHUNK].tolist()
            yield "".join([f"{tag} {x!r} {y!r} {z!r}\n" for tag, (x, y, z) in zip(tags, rows, strict=True)]).encode()

    def _elements_22(self) -> Iterator[bytes]:
        pieces = self.grouping.pieces
        yield b"%d\n" % sum(len(piece.ids) for piece in pieces)
        for piece in pieces:
            groups = self.grouping.entities[piece.dimension][piece.entity - 1]
            head = np.array([groups[0] if groups else 0, piece.entity])
            element = TABLE[piece.kind]
            if self.binary:
                yield np.array([element.gmsh, len(piece.ids), 2], "<i4").tobytes()
                rows = np.column_stack([piece.ids, np.tile(head, (len(piece.ids), 1)), self._nodes_of(element, piece)])
                yield rows.astype("<i4").tobytes()
            else:
                row = f"%d {element.gmsh} 2 {head[0]} {head[1]}" + " %d" * element.nodes + "\n"
                yield from _text(row, np.column_stack([piece.ids, self._nodes_of(element, piece)]))

    # Version 4.1

    def _entities(self) -> Iterator[bytes]:
        entities = [list(enumerate(some, 1)) for some in self._all_entities()]
        yield self._sizes([len(some) for some in entities])
        low, high = self.xyz.min(axis=0).tolist(), self.xyz.max(axis=0).tolist()
        for dimension, some in enumerate(entities):
            box = [*low, *high] if dimension else low
            for tag, groups in some:
                bounds = (0,) if dimension else ()
                if self.binary:
                    yield np.int32(tag).tobytes() + np.array(box).tobytes() + np.uint64(len(groups)).tobytes()
                    yield np.array(groups, "<i4").tobytes() + np.array(bounds, "<u8").tobytes()
                else:
                    yield (" ".join(map(repr, (tag, *box, len(groups), *groups, *bounds))) + "\n").encode()

    def _all_entities(self) -> list[list[tuple[int, ...]]]:
        """The entities; one for the nodes where there are no elements."""
        entities = self.grouping.entities
        return entities if any(entities) else [[], [], [], [()]]

    def _nodes_41(self) -> Iterator[bytes]:
        top = max(dimension for dimension, some in enumerate(self._all_entities()) if some)
        yield self._sizes([1, len(self.tags), int(self.tags.min()), int(self.tags.max())])
        yield self._heading(top, 1, 0, len(self.tags))
        if self.binary:
            yield self.tags.astype("<u8").tobytes()
            yield self.xyz.astype("<f8").tobytes()
        else:
            yield from _text("%d\n", self.tags[:, None])
            yield from _text("%r %r %r\n", self.xyz)

    def _elements_41(self) -> Iterator[bytes]:
        pieces = self.grouping.pieces
        ids = np.concatenate([piece.ids for piece in pieces]) if pieces else np.zeros(1, np.int64)
        yield self._sizes([len(pieces), sum(len(piece.ids) for piece in pieces), int(ids.min()), int(ids.max())])
        for piece in pieces:
            element = TABLE[piece.kind]
            yield self._heading(piece.dimension, piece.entity, element.gmsh, len(piece.ids))
            rows = np.column_stack([piece.ids, self._nodes_of(element, piece)])
            if self.binary:
                yield rows.astype("<u8").tobytes()
            else:
                yield from _text(" ".join(["%d"] * rows.shape[1]) + "\n", rows)

    def _sizes(self, numbers: list[int]) -> bytes:
        return np.array(numbers, "<u8").tobytes() if self.binary else (" ".join(map(str, numbers)) + "\n").encode()

    def _heading(self, dimension: int, entity: int, third: int, count: int) -> bytes:
        if self.binary:
            return np.array([dimension, entity, third], "<i4").tobytes() + np.uint64(count).tobytes()
        return b"%d %d %d %d\n" % (dimension, entity, third, count)

    def _nodes_of(self, element: Element, piece: Piece) -> Ints:
        """Node tags in gmsh's order."""
        if not element.from_gmsh:
            return self.tags[piece.nodes]
        nodes = np.empty_like(piece.nodes)
        nodes[:, list(element.from_gmsh)] = piece.nodes
        return self.tags[nodes]


def _tags(model: Model, report: Report) -> Ints:
    """Node numbers that a file can hold: the model's own where they are positive and differ."""
    ids, count = model.node_ids, len(model.xyz)
    if len(ids) == count and ids.min() > 0 and len(np.unique(ids)) == count:
        return ids
    report.approximate("node numbers", count, f"1 to {count}: the model's are not positive or not different")
    return np.arange(1, count + 1)


def _text(row: str, values: Ints | Floats) -> Iterator[bytes]:
    """Rows of numbers as lines of text."""
    for first in range(0, len(values), _CHUNK):
        some = values[first : first + _CHUNK]
        yield ((row * len(some)) % tuple(some.ravel().tolist())).encode()
