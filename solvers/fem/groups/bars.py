"""Trusses: two nodes, one stress; small strain, or Green's strain with the rotation that comes with it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...materials import PLASTIC_STRAIN, state_rows
from ..elements.points import advance_uniaxial
from ..problem import SMALL, Elements
from ..shape import Shape
from ..structure import Structure
from .group import Bad, Sink

Floats = NDArray[np.float64]


class BarGroup:
    """A group of trusses; see `group.Group`."""

    def __init__(self, elements: Elements, x: Floats) -> None:
        self.elements = elements
        self.x = x
        self.nodes = np.ascontiguousarray(elements.nodes, dtype=np.int64)
        self.dofs = np.arange(3)
        self._axis = x[self.nodes[:, 1]] - x[self.nodes[:, 0]]
        self.length = np.linalg.norm(self._axis, axis=1)
        if not (self.length > 0.0).all():
            raise Bad(int(elements.ids[int(np.argmin(self.length))]), "its length is zero")
        e = len(self.nodes)
        area = elements.value if elements.value is not None else np.full(e, elements.section.get("area", 0.0))
        self.area = np.asarray(area, dtype=float)
        if not (self.area > 0.0).all():
            raise Bad(int(elements.ids[int(np.argmin(self.area))]), "its cross-section has no area")
        self.volume = self.area * self.length
        rows = max(1, state_rows(elements.law))
        self.stress, self.trial = np.zeros(e), np.zeros(e)
        self.strain, self._step = np.zeros(e), np.zeros(e)
        self.history, self._history = np.zeros((rows, e)), np.zeros((rows, e))
        self.energy, self.dissipated, self._work = np.zeros(e), np.zeros(e), np.zeros(e)
        self._scratch, self._kept = np.empty((rows, 2)), np.empty(rows)
        self._offsets = np.empty(0, np.int32)
        self.warmth = np.zeros(e if elements.expansion else 0)  # committed strain by temperature
        self._warm: Floats | None = None  # at the step's end, of a run with temperatures

    def bind(self, structure: Structure) -> None:
        self._offsets = structure.offsets(self.nodes)

    def warm(self, temperature: Floats) -> None:
        """What the nodes' temperatures (n,) at the step's end make the bars grow by."""
        above = temperature[self.nodes].mean(axis=1) - self.elements.reference
        self._warm = self.elements.expansion * above

    def _strain_of(self, shape: Shape) -> Floats:
        moved = shape.u[self.nodes[:, 1], :3] - shape.u[self.nodes[:, 0], :3]
        strain = (self._axis * moved).sum(axis=1)
        if self.elements.geometry != SMALL:
            strain = strain + 0.5 * (moved * moved).sum(axis=1)
        out: Floats = strain / self.length**2
        return out

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        self._step[:] = self._strain_of(shape) - self._strain_of(before)
        self._history[:] = self.history
        modulus = np.empty(len(self.nodes))
        el = self.elements
        seen = self._step if self._warm is None else self._step - (self._warm - self.warmth)
        advance_uniaxial(el.law, seen, self.stress, self.trial, self._history, el.density, dt, self._work,
                         self._scratch, modulus, self._kept)  # fmt: skip
        small = self.elements.geometry == SMALL
        axis = self._axis
        if not small:
            axis = axis + shape.u[self.nodes[:, 1], :3] - shape.u[self.nodes[:, 0], :3]
        row = axis / self.length[:, None] ** 2  # strain = row . (u2 - u1)
        pull = (self.trial * self.volume)[:, None] * row
        forces = np.stack([-pull, pull], axis=2)
        matrix = None
        if sink.stiff:
            block = (modulus * self.volume)[:, None, None] * row[:, :, None] * row[:, None, :]
            if not small:
                block = block + (self.trial * self.area / self.length)[:, None, None] * np.eye(3)
            signs = np.array([[1.0, -1.0], [-1.0, 1.0]])
            matrix = np.ascontiguousarray(block[:, :, :, None, None] * signs)
        sink.add(self.nodes, self.dofs, self._offsets, np.ascontiguousarray(forces), matrix)

    def commit(self) -> None:
        self.energy += 0.5 * (self.stress + self.trial) * self._step
        self.stress[:] = self.trial
        self.history[:] = self._history
        self.strain += self._step
        self.dissipated += self._work
        if self._warm is not None:
            self.warmth[:] = self._warm

    def energies(self) -> tuple[float, float]:
        return float(self.energy @ self.volume), float(self.dissipated @ self.volume)

    def mass(self, sink: Sink, *, lumped: Floats | None = None) -> None:
        own = self.elements.density * self.volume
        if lumped is not None:
            for c in self.dofs:
                np.add.at(lumped[:, c], self.nodes, 0.5 * np.column_stack([own, own]))
            return
        matrix = own[:, None, None, None, None] * np.eye(3)[:, :, None, None] * (np.ones((2, 2)) + np.eye(2)) / 6.0
        sink.add(self.nodes, self.dofs, self._offsets, np.zeros((len(own), 3, 2)), np.ascontiguousarray(matrix))

    def weights(self) -> Floats:
        own = np.zeros(len(self.x))
        np.add.at(own, self.nodes, (0.5 * self.elements.density * self.volume)[:, None])
        return np.repeat(own[:, None], 3, axis=1)

    def output(self) -> dict[str, Floats]:
        stress = np.zeros((len(self.nodes), 6))
        stress[:, 0] = self.stress
        cells = {"stress": stress}
        if state_rows(self.elements.law):
            cells["plastic_strain"] = self.history[PLASTIC_STRAIN].copy()
        return cells

    def at_nodes(self) -> tuple[Floats, Floats]:
        stress = np.zeros((len(self.nodes), 2, 6))
        stress[:, :, 0] = self.stress[:, None]
        return stress, self.volume

    def forget(self) -> None:
        """Nothing."""

    def state(self) -> dict[str, Floats]:
        warm = {"warmth": self.warmth} if len(self.warmth) else {}
        return {"stress": self.stress, "strain": self.strain, "history": self.history, "energy": self.energy,
                "dissipated": self.dissipated, **warm}  # fmt: skip

    def restore(self, data: dict[str, Floats]) -> None:
        for name, own in self.state().items():
            own[:] = data[name]
