"""Elements that come and go: a group within whose life it is one of the structure, and outside it nothing.

A group is there in the steps that end after its birth and not after its death. The shape in which it is born is its
strain-free one: from there its displacements count, and with finite strain or rotation its places and directors too.
When it goes its forces go at once; what strain energy it held is lost.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..problem import SMALL, Elements
from ..shape import Shape
from ..structure import Structure
from .group import Group, Sink

Floats = NDArray[np.float64]
Maker = Callable[[Floats, Floats | None], Group]
_NEAR = 1e-9  # of a time: rounding of sums of steps


class TimedGroup:
    """A group with one birth and one death; see `group.Group`. make: the group at places (n, 3) of the nodes, and what
    they have turned by (n, 3, 3) or None. ValueError where the elements' times differ."""

    def __init__(self, elements: Elements, x: Floats, make: Maker) -> None:
        self.elements = elements
        self._x, self._make = x, make
        self._inner = make(x, None)
        self._birth, self._death = one_life(elements)
        self.dofs = self._inner.dofs
        self.living = False
        self._born = False
        self._u = np.zeros((len(x), 6))
        self._turn: Floats | None = None
        self._structure: Structure | None = None

    def lives(self, time: float) -> bool:
        """Whether it is there in a step that ends at a time."""
        slack = _NEAR * abs(time)
        return self._birth < time - slack and time - slack <= self._death

    def at(self, time: float, shape: Shape) -> bool:
        """Before a step from a shape that ends at a time. Returns whether it came or went."""
        lives = self.lives(time)
        if lives == self.living:
            return False
        if lives and not self._born:
            self._begin(shape.u.copy(), None if shape.turn is None else shape.turn.copy())
        self.living = lives
        return True

    def _begin(self, u: Floats, turn: Floats | None) -> None:
        self._u, self._turn = u, turn
        if self.elements.geometry != SMALL:
            self._inner = self._make(self._x + u[:, :3], turn)
            if self._structure is not None:
                self._inner.bind(self._structure)

    def _moved(self, shape: Shape) -> Shape:
        turn = shape.turn
        if turn is not None and self._turn is not None:
            turn = np.ascontiguousarray(turn @ self._turn.transpose(0, 2, 1))
        return Shape(shape.u - self._u, turn)

    # what the assembly asks, of the group while it is there

    @property
    def volume(self) -> Floats:
        return self._inner.volume

    def bind(self, structure: Structure) -> None:
        self._structure = structure
        self._inner.bind(structure)

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        if self.living:
            self._inner.evaluate(self._moved(shape), self._moved(before), dt, sink)

    def commit(self) -> None:
        if self.living:
            self._inner.commit()
            self._born = True

    def mass(self, sink: Sink, *, lumped: Floats | None = None) -> None:
        if self.living:
            self._inner.mass(sink, lumped=lumped)

    def weights(self) -> Floats:
        return self._inner.weights()

    def energies(self) -> tuple[float, float]:
        internal, flow = self._inner.energies()
        return (internal, flow) if self.living else (internal, internal)

    def output(self) -> dict[str, Floats]:
        cells = self._inner.output()
        if not self.living:
            cells = {name: np.zeros_like(values) for name, values in cells.items()}
        cells["alive"] = np.full(len(self.elements.ids), float(self.living))
        return cells

    def at_nodes(self) -> tuple[Floats, Floats]:
        stress, volume = self._inner.at_nodes()
        return (stress, volume) if self.living else (np.zeros_like(stress), np.zeros_like(volume))

    def forget(self) -> None:
        self._inner.forget()

    def state(self) -> dict[str, Floats]:
        own = {"life": np.array([self.living, self._born], float), "born_u": self._u}
        if self._turn is not None:
            own["born_turn"] = self._turn
        return own | self._inner.state()

    def restore(self, data: dict[str, Floats]) -> None:
        self.living, self._born = (bool(v) for v in data["life"])
        if self.living or self._born:
            self._begin(np.array(data["born_u"]), np.array(data["born_turn"]) if "born_turn" in data else None)
        self._inner.restore(data)


def has_life(elements: Elements) -> bool:
    """Whether elements are born or die."""
    return any(times is not None and bool(np.any(times)) for times in (elements.birth, elements.death))


def one_life(elements: Elements) -> tuple[float, float]:
    """Birth and death of all elements of a group; a death of 0 is none."""
    times = []
    for name, values in (("birth", elements.birth), ("death", elements.death)):
        own = np.zeros(1) if values is None else np.unique(values)
        if len(own) > 1:
            raise ValueError(f"elements of one group have {len(own)} times of {name}")
        times.append(float(own[0]))
    return times[0], times[1] or np.inf
