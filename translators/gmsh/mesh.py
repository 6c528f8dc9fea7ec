"""What the sections of a .msh file say, before it becomes a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from zrno.translators.elements import Element
from zrno.translators.model import Floats, Ints

NO_GROUP = 0


@dataclass(slots=True)
class Run:
    """Elements of one type.

    ids: (n,); nodes: (n, k) tags in gmsh's order; groups: (n,) first physical group, NO_GROUP none; entities: (n,)
    elementary entity; further: further physical groups and the rows that belong to them.
    """

    element: Element
    ids: Ints
    nodes: Ints
    groups: Ints
    entities: Ints
    further: list[tuple[int, Ints]] = field(default_factory=list)

    @property
    def dimension(self) -> int:
        """Of its elements."""
        return self.element.dimension


@dataclass(slots=True)
class Mesh:
    """What the sections say.

    names: (dimension, group) -> (name, line); groups_of_entity, parents: by (dimension, tag), parents of a partition's
    entities. title, lower_parts and points are remarks of our own writer: the groups of lower dimension that are parts,
    and the first and the last of the point elements that stand for node sets.
    """

    tags: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    xyz: Floats = field(default_factory=lambda: np.empty((0, 3)))
    runs: list[Run] = field(default_factory=list)
    names: dict[tuple[int, int], tuple[str, int]] = field(default_factory=dict)
    groups_of_entity: dict[tuple[int, int], Sequence[int]] = field(default_factory=dict)
    parents: dict[tuple[int, int], tuple[int, int]] = field(default_factory=dict)
    title: str = ""
    lower_parts: set[tuple[int, int]] = field(default_factory=set)
    points: tuple[int, int] | None = None
    warnings: list[str] = field(default_factory=list)
