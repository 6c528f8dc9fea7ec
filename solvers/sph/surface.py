"""The surface of a structure between the steps of a run: its facets, where its nodes are, what they have received.

The loops of `facing` keep the impulses of each pair of a particle and a facet; they are added up here, in the order of
the list, when somebody asks: the result does not depend on threads.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..contact.facet_search import candidates
from ..contact.friction import Coulomb
from ..jit import kernel
from .facing import Faces

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Facets:
    """The surface of a structure that particles touch.

    nodes: (m, 3) places at the start; corners: (f, 3) triangles, or (f, 2) segments; half: (f,) half the thickness;
    closed: (f,) whether only the side of the normal is outside (of a segment: the right of its way).
    """

    nodes: Floats
    corners: Ints
    half: Floats
    closed: NDArray[np.bool_]
    friction: Coulomb | None = None


@kernel
def _to_nodes(corners, rows, impulse, d, total):
    for pair in range(len(rows)):
        for q in range(d):
            node = corners[rows[pair], q]
            for axis in range(d):
                total[node, axis] += impulse[pair, d * q + axis]


class Surface:
    """The facets of a run between its steps: places and velocities of the nodes, the list, impulses.

    stiff, radius: see `Faces`; watched: whether particles sleep on them.
    """

    def __init__(self, facets: Facets, dimension: int, stiff: Floats, radius: Floats, *, watched: bool) -> None:
        self.d = max(2, dimension)
        self.facets = facets
        self.x = np.ascontiguousarray(facets.nodes.T)
        self.v = np.zeros_like(self.x)
        self.motion = np.zeros(2)
        self._pace = np.zeros(len(facets.corners)) if watched else None
        self.total = np.zeros((len(facets.nodes), 3))  # impulse that has been added up
        self._stiff, self._radius = stiff, radius
        none = np.zeros(0, np.int64)
        self._list: tuple[Ints, ...] = none, none, none
        self._pairs = np.zeros((0, self.d**2)), np.zeros((0, self.d**2))

    def faces(self) -> Faces:
        """What the loops see; views."""
        friction = self.facets.friction or Coulomb(0.0, 0.0)
        return Faces(
            self.x, self.v, self.motion, self._pace, self.facets.corners, self.facets.half, self.facets.closed,
            friction.static, friction.kinetic, self._stiff, self._radius, *self._list, *self._pairs,  # type: ignore[call-arg]
        )  # fmt: skip

    def build(self, x: Floats, y: Floats, z: Floats | None, n: int, largest: float, spare: float) -> None:
        """List the facets of each of the first n particles. largest: radius; spare: that they may go until the next."""
        self.settle()
        reach = np.where(self.facets.closed, 2.0, 1.0) * largest + self.facets.half + spare
        self._list = candidates(x, y, z, n, self.x, self.facets.corners, reach)
        pairs = len(self._list[2])
        self._pairs = np.zeros((pairs, self.d**2)), np.zeros((pairs, self.d**2))
        self.motion[1] = 0.0

    def largest(self, h: Floats, body: Ints) -> float:
        """The radius of the largest particle. h, body: of all."""
        return float((self._radius[body] * h).max())

    def settle(self) -> None:
        """Add the impulses of the pairs to those of the nodes."""
        _to_nodes(self.facets.corners, self._list[2], self._pairs[1], self.d, self.total)
        self._pairs[1][:] = 0.0

    # as `driving.Driven`

    def read(self, name: str) -> Floats:
        """(m, 3) of the nodes: x, u (velocity), impulse, thrust."""
        if name == "thrust":
            thrust = np.zeros_like(self.total)
            _to_nodes(self.facets.corners, self._list[2], self._pairs[0], self.d, thrust)
            return thrust
        if name == "impulse":
            self.settle()
            return self.total.copy()
        return np.ascontiguousarray({"x": self.x, "u": self.v}[name].T)

    def write(self, name: str, values: Floats | float) -> None:
        """Set velocities `u`, or `impulse`."""
        if name == "impulse":
            self.settle()
            self.total[:] = values
            return
        self.v[:] = np.asarray(values).T
        self._measure()

    def _measure(self) -> None:
        """How fast the nodes are."""
        speed = np.sqrt((self.v**2).sum(axis=0))
        self.motion[0] = float(speed.max(initial=0.0))
        if self._pace is not None:
            self._pace[:] = speed[self.facets.corners].max(axis=1)

    # to be continued

    def state(self) -> dict[str, Any]:
        """Arrays of a checkpoint."""
        self.settle()
        first, count, rows = self._list
        kept = {"x": self.x, "v": self.v, "motion": self.motion, "total": self.total, "thrust": self._pairs[0]}
        lists = {"first": first, "count": count, "rows": rows}
        return {f"facets_{name}": values.copy() for name, values in {**kept, **lists}.items()}

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint."""
        for name, values in (("x", self.x), ("v", self.v), ("motion", self.motion), ("total", self.total)):
            values[:] = data[f"facets_{name}"]
        self._measure()
        self._list = tuple(np.array(data[f"facets_{name}"]) for name in ("first", "count", "rows"))
        thrust = np.array(data["facets_thrust"])
        self._pairs = thrust, np.zeros_like(thrust)
