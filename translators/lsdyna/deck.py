"""A deck while it is read: the model so far, what waits for the last node, faults of all its files, remarks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.lsdyna.frames import Frame
from zrno.translators.lsdyna.lexer import Block, File
from zrno.translators.lsdyna.parameters import Parameters
from zrno.translators.model import Floats, Ints, Model, Source
from zrno.translators.text import MAX_FAULTS, Fault, InputError

_MANY = 500_000  # numbers: with so many the jitted loop pays for its loading
_TABLE_ROOM = 8  # a table of all numbers is used where they are at most so many times the nodes


@dataclass(slots=True)
class NodeRun:
    """The nodes of one keyword: numbers, coordinates, constraint codes, and where they stand."""

    block: Block
    rows: Ints
    ids: Ints
    xyz: Floats
    tc: Ints
    rc: Ints
    transformations: tuple[int, ...]


@dataclass(slots=True)
class ElementRun:
    """The elements of one keyword, by node numbers (0: none). corners: what `nodes` means, see `elements`."""

    family: str
    block: Block
    rows: Ints
    ids: Ints
    part: Ints
    nodes: Ints
    shape: str
    data: dict[str, Any] = field(default_factory=dict)


class Deck:
    """What the handlers of keywords share.

    partial: what is missing (includes, nodes of elements) is noted in `Model.incomplete` and no fault.
    """

    def __init__(self, model: Model, *, partial: bool) -> None:
        self.model = model
        self.partial = partial
        self.parameters = Parameters()
        self.frame = Frame()
        self.faults: list[Fault] = []
        self.nodes: list[NodeRun] = []
        self.elements: list[ElementRun] = []
        self.transformations: dict[int, list[tuple[str, list[float], Block, int]]] = {}
        self.boxes: dict[int, tuple[Floats, Floats]] = {}
        self.vectors: dict[int, Floats] = {}
        self.late: list[Callable[[], None]] = []  # what needs all nodes, in the order of the deck
        self.sets: dict[tuple[str, int], Any] = {}
        self.universe: dict[str, Ints] = {}  # all numbers of a kind, in order, once the mesh is there
        self.depth = 0  # of the sets that are being worked out
        self._counts: dict[str, tuple[int, str]] = {}
        self._places: dict[int, int] | None = None
        self._order: Ints | None = None
        self._table: NDArray[np.int32] | None = None

    # Faults and remarks

    def fault(self, file: File, row: int, column: int, message: str, text: str = "", expected: str = "") -> None:
        """Note a fault at a line and a column (both from 0) of a file; raises InputError at the twentieth."""
        if len(text) > 60:
            text = text[:57] + "..."
        self.faults.append(Fault(file.shown, row + 1, column + 1, message, text, expected))
        if len(self.faults) >= MAX_FAULTS:
            self.stop()

    def stop(self) -> None:
        """Raise InputError when there are faults."""
        if self.faults:
            raise InputError(sorted(set(self.faults)))

    def source(self, block: Block, row: int | None = None) -> Source:
        """Where an item stands."""
        return Source(block.file.shown, (block.line if row is None else row) + 1)

    def warn(self, block: Block, message: str, row: int | None = None) -> None:
        """Remark on one thing."""
        self.model.warnings.append(f"{block.file.shown}:{(block.line if row is None else row) + 1}: {message}")

    def count(self, what: str, number: int, block: Block, row: int | None = None) -> None:
        """Remark on many alike: they are added up, and the place of the first is said."""
        before, place = self._counts.get(what, (0, ""))
        place = place or f"{block.file.shown}:{(block.line if row is None else row) + 1}"
        if number:
            self._counts[what] = (before + number, place)

    def say_counts(self) -> None:
        """Put the remarks that were added up into the model's warnings."""
        for what, (number, place) in self._counts.items():
            self.model.warnings.append(f"{place}: {what.replace('{n}', str(number))}")

    def lacks(self, message: str) -> None:
        """Note that the model lacks something that the deck names."""
        self.model.incomplete.append(message)
        self.model.warnings.append(message)

    def lacks_parameter(self, text: str) -> None:
        """Note a parameter that a file which is looked at alone does not define."""
        message = f"parameter {text.lstrip('-')} is not defined in the file"
        if message not in self.model.incomplete and len(self.model.incomplete) < 2 * MAX_FAULTS:
            self.lacks(message)

    # Nodes by number

    def index_nodes(self) -> None:
        """Make numbers of nodes findable: `Model.node_ids` is complete."""
        ids = self.model.node_ids
        if not len(ids):
            return
        largest = int(ids.max())
        if ids.min() >= 0 and largest <= _TABLE_ROOM * len(ids) + 1_000_000:
            self._table = np.full(largest + 2, -1, np.int32)
            self._table[ids] = np.arange(len(ids), dtype=np.int32)
        else:
            self._order = np.argsort(ids, kind="stable")

    def places(self, ids: Ints) -> Ints:
        """Places of nodes in `Model.xyz` by their numbers, -1 where there is no such node."""
        if self._table is not None:
            last = len(self._table) - 1
            return self._table[np.where((ids < 0) | (ids > last), last, ids)].astype(np.int64)
        if self._order is None:
            return np.full(ids.shape, -1, np.int64)
        sorted_ids = self.model.node_ids[self._order]
        place = np.minimum(np.searchsorted(sorted_ids, ids), len(sorted_ids) - 1)
        return np.where(sorted_ids[place] == ids, self._order[place], -1)

    def to_places(self, ids: Ints) -> int:
        """Numbers (n, k) to places, in the array itself: where there is no such node, -1 minus its number. Returns how
        many rows lack one."""
        if self._table is not None and ids.size > _MANY:
            from zrno.translators.lsdyna.kernels import to_places

            return to_places(ids, self._table)
        places = self.places(ids)
        ids[:] = np.where(places < 0, -1 - np.maximum(ids, 0), places)
        return int((ids < 0).any(axis=1).sum())

    def found(self, ids: Ints, what: str, block: Block, row: int | None = None) -> Ints:
        """Places of nodes that a keyword lists; those that are not in the deck are left out, and counted."""
        places = self.places(ids)
        if not len(self.model.node_ids):
            return places  # a fragment: they are known to be missing
        missing = int((places < 0).sum())
        if missing:
            self.count(f"{{n}} nodes of {what} are not in the deck", missing, block, row)
            return places[places >= 0]
        return places
