"""A mesh as CalculiX includes it: nodes, elements of one of its types, sets of nodes. (Its manual, 2.20, 7.)

Loads, materials and steps are the user's own input file, which says `*INCLUDE, INPUT=...`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.model import Ints, Model
from zrno.translators.text import write_atomically

TYPES = {
    "C3D4": "tet4", "C3D10": "tet10", "C3D6": "wedge6", "C3D15": "wedge15",
    "C3D8": "hex8", "C3D8I": "hex8", "C3D8R": "hex8", "C3D20": "hex20", "C3D20R": "hex20",
    "S3": "tri3", "S6": "tri6", "S4": "quad4", "S4R": "quad4", "S8": "quad8", "S8R": "quad8",
    "CPE3": "tri3", "CPE6": "tri6", "CPE4": "quad4", "CPE4R": "quad4", "CPE8": "quad8", "CPE8R": "quad8",
    "CPS3": "tri3", "CPS6": "tri6", "CPS4": "quad4", "CPS4R": "quad4", "CPS8": "quad8", "CPS8R": "quad8",
    "CAX3": "tri3", "CAX6": "tri6", "CAX4": "quad4", "CAX4R": "quad4", "CAX8": "quad8", "CAX8R": "quad8",
}  # fmt: skip
"""CalculiX's types of elements by the kind of ours whose nodes they have, in the same order."""
_CHUNK = 10_000
_A_LINE = 8  # numbers: its lines end after 132 characters


def of_type(model: Model, name: str) -> bool:
    """Whether all elements of the model's parts can be of a type."""
    kinds = {block.kind for block in model.blocks if np.isin(block.part, list(model.parts)).any()}
    return kinds == {TYPES[name]}


def write_mesh(path: Path, model: Model, name: str, sets: Mapping[str, Ints]) -> None:
    """Write the elements of the model's parts as one type, in the set EALL and one a part; nodes in NALL.

    name: of TYPES; sets: further sets of nodes (indices), beside the model's own.
    """
    write_atomically(path, _pieces(model, name, {s.name: s.nodes for s in model.node_sets if s.name} | dict(sets)))


def _pieces(model: Model, name: str, sets: Mapping[str, Ints]) -> Iterator[bytes]:
    used = np.zeros(len(model.xyz), bool)
    blocks = [(b, np.isin(b.part, list(model.parts))) for b in model.blocks if b.kind == TYPES[name]]
    for block, mine in blocks:
        used[block.nodes[mine].ravel()] = True
    numbers = np.flatnonzero(used)
    yield b"*NODE, NSET=NALL\n"
    for first in range(0, len(numbers), _CHUNK):
        rows = numbers[first : first + _CHUNK]
        numbered = np.column_stack([rows + 1, model.xyz[rows]])
        yield _rows(numbered, "%d,%.12g,%.12g,%.12g\n")  # it reads 20 characters a number, and what is longer wrongly
    count = 0
    for block, mine in blocks:
        for part in np.unique(block.part[mine]).tolist():
            nodes = block.nodes[mine & (block.part == part)] + 1
            yield f"*ELEMENT, TYPE={name}, ELSET={_word(model.parts[part].name or f'PART{part}')}\n".encode()
            numbered = np.column_stack([np.arange(count + 1, count + 1 + len(nodes)), nodes])
            count += len(nodes)
            card = _card(numbered.shape[1])
            for first in range(0, len(nodes), _CHUNK):
                yield _rows(numbered[first : first + _CHUNK], card)
    yield b"*ELSET, ELSET=EALL, GENERATE\n1,%d\n" % count
    for label, members in sets.items():
        kept = np.asarray(members)[used[members]] + 1
        if len(kept):
            yield f"*NSET, NSET={_word(label)}\n".encode()
            whole = len(kept) // _A_LINE * _A_LINE
            yield _rows(kept[:whole].reshape(-1, _A_LINE), _card(_A_LINE))
            if whole < len(kept):
                yield _rows(kept[None, whole:], _card(len(kept) - whole))


def _word(name: str) -> str:
    """A name as CalculiX takes it: upper case, at most 80 characters, no blanks."""
    return "".join(c if c.isalnum() or c in "_-." else "_" for c in name.upper())[:80]


def _card(count: int) -> str:
    """How so many whole numbers are said: after a comma they go on in the next line."""
    pieces = [",".join(["%d"] * min(_A_LINE, count - i)) for i in range(0, count, _A_LINE)]
    return ",\n".join(pieces) + "\n"


def _rows(table: NDArray[Any], card: str) -> bytes:
    """Rows (n, k) of numbers, each by a card with k places."""
    return (card * len(table) % tuple(table.ravel().tolist())).encode()
