"""Particles that a structure drives: nodes whose velocity is given, and the impulse of what pushes them.

The thrust on such a particle is the force of all particles of other bodies. Its impulse is summed at both ends of each
step, as the momentum of the others is: between two synchronised states what grain loses, nodes receive, to round-off.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel
from .across import interface_force
from .particle import DRIVEN
from .state import State
from .surface import Surface

Floats = NDArray[np.float64]


@kernel
def thrust_by_contact(i0, i1, z, cx, arrays):
    """The contact law's force on the driven among a range of particles."""
    for i in range(i0, i1):
        if arrays.fixed[i] & DRIVEN:
            arrays.thrust[0, i] = cx[i] * arrays.mass[i]
            arrays.thrust[1, i] = arrays.cy[i] * arrays.mass[i]
            if z is not None:
                arrays.thrust[2, i] = arrays.cz[i] * arrays.mass[i]


@kernel
def thrust_by_kernel(i0, i1, z, shape, weight, power, rows_apart, arrays, numbers):
    """The momentum sum's force on them: of kernel contact."""
    for i in range(i0, i1):
        if arrays.fixed[i] & DRIVEN:
            arrays.thrust[:, i] = 0.0
            interface_force(
                i, i + 1, arrays.first, arrays.count, arrays.rows, shape, arrays.x, arrays.y, z, arrays.s, weight,
                arrays.h, power, numbers.normal, arrays.material, arrays.material[i], rows_apart, arrays.thrust[:, i],
            )  # fmt: skip


@kernel
def add_impulse(i0, i1, duration, arrays):
    """Thrust for a duration."""
    for i in range(i0, i1):
        if arrays.fixed[i] & DRIVEN:
            for k in range(len(arrays.impulse)):
                arrays.impulse[k, i] += duration * arrays.thrust[k, i]


class Nodes:
    """The driven particles of a state as it stands, in the order of their numbers."""

    def __init__(self, state: State, n: int) -> None:
        self._state = state
        places = np.flatnonzero(state.fixed[:n] & DRIVEN)
        self._places = places[np.argsort(state.id[places], kind="stable")]

    def read(self, name: str) -> Floats:
        """(m, 3) of a row of vectors."""
        rows = self._state.rows(name)
        out = np.zeros((len(self._places), 3))
        out[:, : len(rows)] = rows[:, self._places].T
        return out

    def write(self, name: str, values: Floats | float) -> None:
        """Set a row of vectors; values: (m, 3) or a number."""
        rows = self._state.rows(name)
        rows[:, self._places] = values if np.isscalar(values) else np.asarray(values).T[: len(rows)]


class Driven:
    """What a structure moves of a run, particles or facets: to be read and set between two steps.

    given: work of what moves it, up to where its impulse was last taken.
    """

    def __init__(self, state: State, n: int, surface: Surface | None) -> None:
        self._state, self._n, self._surface = state, n, surface
        self.given = 0.0

    @property
    def _rows(self) -> Nodes | Surface:
        return self._surface or Nodes(self._state, self._n)

    def read(self, name: str) -> Floats:
        """(m, 3) of its nodes: x, u (velocity), impulse; of particles any row of vectors."""
        return self._rows.read(name)

    def go(self, velocity: Floats) -> None:
        """From here on at these velocities (m, 3)."""
        self.take_impulse()
        self._rows.write("u", velocity)

    def take_impulse(self) -> Floats:
        """(m, 3) impulse on the nodes since it was last taken."""
        rows = self._rows
        impulse = rows.read("impulse")
        self.given -= float(np.sum(impulse * rows.read("u")))
        rows.write("impulse", 0.0)
        return impulse

    def kept(self) -> dict[str, Any]:
        """What a checkpoint holds of it beside the particles' rows."""
        return {"given": self.given, **({} if self._surface is None else self._surface.state())}

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint."""
        self.given = float(data["given"])
        if self._surface is not None:
            self._surface.restore(data)

    @property
    def work(self) -> float:
        """Work of what moves it."""
        rows = self._rows
        return self.given - float(np.sum(rows.read("impulse") * rows.read("u")))
