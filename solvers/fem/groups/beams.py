"""Straight beams of two nodes: axial force, bending with shear (Timoshenko), torsion; elastic, small displacements.

Of large ones: `turning_beams`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...materials import Elastic
from ..problem import Elements
from ..shape import Shape
from ..structure import Structure
from .group import Bad, Sink

Floats = NDArray[np.float64]


class BeamGroup:
    """A group of beams; see `group.Group`.

    The local axis x runs from the first node to the second, y lies in the plane of x and the orientation vector, z is x
    cross y; iyy and izz are about y and z. A shear area of 0 means that the beam does not shear (Euler and Bernoulli).
    """

    def __init__(self, elements: Elements, x: Floats) -> None:
        if not isinstance(elements.law, Elastic):
            raise ValueError("beams are computed elastic only")
        self.elements = elements
        self.x = x
        self.nodes = np.ascontiguousarray(elements.nodes, dtype=np.int64)
        self.dofs = np.arange(6)
        axis = x[self.nodes[:, 1]] - x[self.nodes[:, 0]]
        self.length = np.linalg.norm(axis, axis=1)
        if not (self.length > 0.0).all():
            raise Bad(int(elements.ids[int(np.argmin(self.length))]), "its length is zero")
        self.area = self._number("area")
        self.volume = self.area * self.length
        self._turn = self._axes(axis)
        self._local = self._stiffness()
        big = np.zeros((len(axis), 12, 12))
        for k in range(4):
            big[:, 3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = self._turn
        self._big = big
        stiff = np.einsum("epi,epq,eqj->eij", big, self._local, big)
        self._matrix = np.ascontiguousarray(stiff.reshape(-1, 2, 6, 2, 6).transpose(0, 2, 4, 1, 3))
        self.forces, self._trial = np.zeros((len(axis), 12)), np.zeros((len(axis), 12))
        self.energy, self._energy = np.zeros(len(axis)), np.zeros(len(axis))
        self._offsets = np.empty(0, np.int32)
        self._growth: Floats | None = None  # of their lengths by temperature, of a run with temperatures

    def _number(self, name: str, default: float | None = None) -> Floats:
        section = self.elements.section
        if default is None and not section.get(name, 0.0) > 0.0:
            raise Bad(int(self.elements.ids[0]), f"its cross-section has no {name}")
        return np.full(len(self.nodes), section.get(name, default or 0.0))

    def _axes(self, axis: Floats) -> Floats:
        """(e, 3, 3) local axes, one a row."""
        first = axis / self.length[:, None]
        toward = self.elements.orientation
        if toward is None:
            toward = np.zeros_like(axis)
        toward = np.array(toward, dtype=float)
        lost = np.linalg.norm(np.cross(first, toward), axis=1) <= 1e-9 * np.linalg.norm(toward, axis=1)
        steep = np.abs(first[:, 2]) > 0.99
        toward[lost] = np.where(steep[lost, None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
        third = np.cross(first, toward)
        third /= np.linalg.norm(third, axis=1, keepdims=True)
        return np.stack([first, np.cross(third, first), third], axis=1)

    def _stiffness(self) -> Floats:
        law = self.elements.law
        young = law.shear * (3.0 * law.lame + 2.0 * law.shear) / (law.lame + law.shear)
        length, e = self.length, len(self.length)
        k = np.zeros((e, 12, 12))
        for i, value in ((0, young * self.area / length), (3, law.shear * self._number("j", 0.0) / length)):
            k[:, i, i] = k[:, i + 6, i + 6] = value
            k[:, i, i + 6] = k[:, i + 6, i] = -value
        for inertia, shear, v, turn, sign in (("izz", "shear_area_y", 1, 5, 1.0), ("iyy", "shear_area_z", 2, 4, -1.0)):
            bend, area = young * self._number(inertia), self._number(shear, 0.0)
            soft = np.where(area > 0.0, 12.0 * bend / (law.shear * np.where(area > 0.0, area, 1.0) * length**2), 0.0)
            c = bend / ((1.0 + soft) * length**3)
            rows = [v, turn, v + 6, turn + 6]
            half = sign * 6.0 * length
            block = np.array([[12.0 + 0 * half, half, -12.0 + 0 * half, half],
                              [half, (4.0 + soft) * length**2, -half, (2.0 - soft) * length**2],
                              [-12.0 + 0 * half, -half, 12.0 + 0 * half, -half],
                              [half, (2.0 - soft) * length**2, -half, (4.0 + soft) * length**2]])  # fmt: skip
            k[np.ix_(range(e), rows, rows)] = (c * block).transpose(2, 0, 1)
        return k

    def bind(self, structure: Structure) -> None:
        self._offsets = structure.offsets(self.nodes)

    def warm(self, temperature: Floats) -> None:
        """What the nodes' temperatures (n,) at the step's end make the beams grow by."""
        above = temperature[self.nodes].mean(axis=1) - self.elements.reference
        self._growth = self.elements.expansion * above * self.length

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        local = self._moved(shape)
        if self._growth is None:
            self._trial[:] = np.einsum("epq,eq->ep", self._local, local)
            self._energy[:] = 0.5 * (local * self._trial).sum(axis=1)
        else:
            stretched = local.copy()
            stretched[:, 6] -= self._growth
            self._trial[:] = np.einsum("epq,eq->ep", self._local, stretched)
            step = local - self._moved(before)
            self._energy[:] = self.energy + 0.5 * (step * (self.forces + self._trial)).sum(axis=1)
        own = np.einsum("epi,ep->ei", self._big, self._trial).reshape(-1, 2, 6)
        sink.add(self.nodes, self.dofs, self._offsets, np.ascontiguousarray(own.transpose(0, 2, 1)), self._matrix)

    def _moved(self, shape: Shape) -> Floats:
        """(e, 12) displacements and rotations of the ends in local axes."""
        out: Floats = np.einsum("epi,ei->ep", self._big, shape.u[self.nodes].reshape(-1, 12))
        return out

    def commit(self) -> None:
        self.forces[:] = self._trial
        self.energy[:] = self._energy

    def energies(self) -> tuple[float, float]:
        return float(self.energy.sum()), 0.0

    def mass(self, sink: Sink, *, lumped: Floats | None = None) -> None:
        own = self.elements.density * self.volume
        polar = self.elements.density * self.length * (self._number("iyy", 0.0) + self._number("izz", 0.0))
        if lumped is not None:
            for c in range(3):
                np.add.at(lumped[:, c], self.nodes, 0.5 * np.column_stack([own, own]))
                np.add.at(lumped[:, 3 + c], self.nodes, 0.5 * np.column_stack([polar, polar]))
            return
        sink.add(self.nodes, self.dofs, self._offsets, np.zeros((len(own), 6, 2)), self._consistent(own, polar))

    def _consistent(self, mass: Floats, polar: Floats) -> Floats:
        """(e, 6, 6, 2, 2), by cubic deflections (Przemieniecki 1968, without rotary inertia of the section)."""
        length, e = self.length, len(mass)
        m = np.zeros((e, 12, 12))
        for i, value in ((0, mass), (3, polar)):
            m[:, i, i] = m[:, i + 6, i + 6] = value / 3.0
            m[:, i, i + 6] = m[:, i + 6, i] = value / 6.0
        for v, turn, sign in ((1, 5, 1.0), (2, 4, -1.0)):
            rows = [v, turn, v + 6, turn + 6]
            s, one = sign * length, np.ones(e)
            block = np.array([[156 * one, 22 * s, 54 * one, -13 * s], [22 * s, 4 * s**2, 13 * s, -3 * s**2],
                              [54 * one, 13 * s, 156 * one, -22 * s],
                              [-13 * s, -3 * s**2, -22 * s, 4 * s**2]])  # fmt: skip
            m[np.ix_(range(e), rows, rows)] = (mass / 420.0 * block).transpose(2, 0, 1)
        m = np.einsum("epi,epq,eqj->eij", self._big, m, self._big)
        return np.ascontiguousarray(m.reshape(-1, 2, 6, 2, 6).transpose(0, 2, 4, 1, 3))

    def weights(self) -> Floats:
        own = np.zeros(len(self.x))
        np.add.at(own, self.nodes, (0.5 * self.elements.density * self.volume)[:, None])
        return np.repeat(own[:, None], 3, axis=1)

    def output(self) -> dict[str, Floats]:
        """force: axial and shear forces, torsion and bending moments (e, 12) of both ends in local axes."""
        stress = np.zeros((len(self.nodes), 6))
        stress[:, 0] = self.forces[:, 6] / self.area
        return {"stress": stress, "force": self.forces.copy()}

    def at_nodes(self) -> tuple[Floats, Floats]:
        stress = np.zeros((len(self.nodes), 2, 6))
        stress[:, :, 0] = (self.forces[:, 6] / self.area)[:, None]
        return stress, self.volume

    def forget(self) -> None:
        """Nothing."""

    def state(self) -> dict[str, Floats]:
        return {"forces": self.forces, "energy": self.energy}

    def restore(self, data: dict[str, Floats]) -> None:
        for name, own in self.state().items():
            own[:] = data[name]
