"""Solids and plane elements with their integration points: strains, laws, stiffness, a chunk of elements at a time."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...materials import PLASTIC_STRAIN, state_rows
from ..elements import continuum, hex8, shapes
from ..elements import continuum_loops as loops
from ..elements.points import advance, advance_plane_stress
from ..problem import SMALL, UPDATED, Elements
from ..shape import Shape
from ..structure import Structure
from .group import CHUNK, Bad, Sink

Floats = NDArray[np.float64]
_PLANES = {"": continuum.SOLID, "strain": continuum.FLAT, "stress": continuum.FLAT, "axisymmetric": continuum.ROUND}


class ContinuumGroup:
    """A group of solids or plane elements; see `group.Group`."""

    def __init__(self, elements: Elements, x: Floats) -> None:
        self.elements = elements
        self.x = np.ascontiguousarray(x, dtype=float)
        self.nodes = np.ascontiguousarray(elements.nodes, dtype=np.int64)
        self.plane = _PLANES[elements.plane] if elements.family == "plane" else continuum.SOLID
        self.dofs = np.arange(3 if self.plane == continuum.SOLID else 2)
        self.table = shapes.table(elements.kind, elements.gauss)
        t = self.table
        centre = np.zeros((1, t.points.shape[1]))
        self._centre = np.ascontiguousarray(shapes.functions(elements.kind, centre)[1])
        self._slopes = np.ascontiguousarray(t.slopes)
        self._values = np.ascontiguousarray(t.values)
        e, points = len(self.nodes), t.count
        m = e * points
        self.thickness = np.ones(e) if elements.thickness is None else _mean(elements.thickness)
        self.rows = max(1, state_rows(elements.law))
        self.stress, self.trial = np.zeros((m, 6)), np.zeros((m, 6))
        self._turned = np.zeros((m, 6)) if elements.geometry == UPDATED else self.stress  # what a step begins with
        self.strain = np.zeros((m, 6))
        self._strain_step = np.zeros((m, 6))
        self.history, self._history = np.zeros((self.rows, m)), np.zeros((self.rows, m))
        self._work, self.dissipated, self.energy = np.zeros(m), np.zeros(m), np.zeros(m)
        self.modes: int | None = elements.modes or None
        k, c = self.nodes.shape[1], len(self.dofs)
        modes = elements.modes
        self.alpha, self._alpha = np.zeros((e, modes)), np.zeros((e, modes))
        self._base, self._rest = np.zeros((e, modes)), np.zeros((e, modes))
        self._answer = np.zeros((e, modes, c, k)) if modes else np.zeros((1, 0, c, k))
        self._assembled: Floats | None = None
        self._offsets = np.empty(0, np.int32)
        some = min(CHUNK, e)
        self._matrix = np.empty((some, c, c, k, k))
        self._forces = np.empty((some, c, k))
        self._modulus = np.empty((some * points, 6, 6))
        self._scratch, self._kept = np.empty((self.rows, 2)), np.empty(self.rows)
        self.warmth = np.zeros(m if elements.expansion else 0)  # committed strain by temperature, in all directions
        self._warm: Floats | None = None  # at the step's end, of a run with temperatures
        self.small = elements.geometry == SMALL
        self._plain = self.small and elements.kind == "hex8" and not elements.mean and not modes
        self._finite = None if elements.geometry in (SMALL, UPDATED) else True
        self.volume = np.zeros(e)
        self.point_volume = np.zeros(m)
        self._volumes()

    def bind(self, structure: Structure) -> None:
        self._offsets = structure.offsets(self.nodes)

    # state

    def warm(self, temperature: Floats) -> None:
        """What the nodes' temperatures (n,) at the step's end make the points grow by."""
        above = (temperature - self.elements.reference)[self.nodes]
        self._warm = self.elements.expansion * (above @ self._values.T).ravel()

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        self._evaluate(shape.u, before.u, dt, sink)

    def _evaluate(self, u: Floats, before: Floats, dt: float, sink: Sink) -> None:
        self._history[:] = self.history
        if self.modes is not None:
            self._enhance(u)
        updated = self.elements.geometry == UPDATED
        places = self.x + u[:, :3] if updated else self.x
        middle = self.x + 0.5 * (u[:, :3] + before[:, :3]) if updated else self.x
        for lo in range(0, len(self.nodes), CHUNK):
            self._chunk(lo, min(lo + CHUNK, len(self.nodes)), u, before, dt, middle, places, sink)
        if self.modes is not None and sink.stiff:
            self._assembled = u.copy()
            self._base[:] = self._alpha

    def _enhance(self, u: Floats) -> None:
        """The enhanced parameters that go with a displacement, by the last stiffness."""
        if self._assembled is None:
            self._alpha[:] = self.alpha
            return
        change = (u - self._assembled)[self.nodes][:, :, self.dofs]
        self._alpha[:] = self._base - self._rest - np.einsum("emck,ekc->em", self._answer, change)

    def _chunk(self, lo: int, hi: int, u: Floats, before: Floats, dt: float, middle: Floats, places: Floats,
               sink: Sink) -> None:  # fmt: skip
        el, t = self.elements, self.table
        g = t.count
        nodes, rows = self.nodes[lo:hi], slice(lo * g, hi * g)
        mean = True if el.mean else None
        smallest = np.empty(hi - lo)
        alpha = (self._alpha[lo:hi], self.alpha[lo:hi]) if self.modes is not None else (None, None)
        strain = self._strain_step[rows]
        if self._plain:
            hex8.strains(nodes, middle, u, before, self._slopes, strain, smallest)
        else:
            loops.strains(
                nodes, middle, u, before, self._values, self._slopes, t.weights, t.points, self._centre, self.plane,
                self._finite, mean, self.modes, *alpha, strain, smallest,
            )  # fmt: skip
        if not (smallest > 0.0).all():
            raise Bad(int(el.ids[lo + int(np.argmin(smallest))]), "its volume is not positive")
        if el.geometry == UPDATED:
            self._turn(nodes, middle, u, before, rows)
        old = self._turned[rows]
        modulus = self._modulus[: (hi - lo) * g]
        whole = strain
        if self._warm is not None:  # laws see what is left of the strain
            strain = whole.copy()
            strain[:, :3] -= (self._warm[rows] - self.warmth[rows])[:, None]
        if el.plane == "stress":
            advance_plane_stress(el.law, strain, old, self.trial[rows], self._history, lo * g, el.density, dt,
                                 self._work[rows], self._scratch, modulus, self._kept)  # fmt: skip
        else:
            advance(el.law, strain, old, self.trial[rows], self._history, lo * g, el.density, dt, self._work[rows],
                    self._scratch, modulus if sink.stiff else None)  # fmt: skip
        if self._warm is not None and el.plane == "stress":
            whole[:, 2] = strain[:, 2] + self._warm[rows] - self.warmth[rows]
        forces, matrix = self._forces[: hi - lo], self._matrix[: hi - lo] if sink.stiff else None
        if self._plain:
            hex8.integrate(nodes, places, self._slopes, t.weights, self.trial[rows], modulus, matrix, forces)
            sink.add(nodes, self.dofs, self._offsets[lo:hi], forces, matrix)
            return
        answer, rest = (self._answer[lo:hi], self._rest[lo:hi]) if self.modes is not None else (None, None)
        loops.integrate(
            nodes, places, u, self._values, self._slopes, t.weights, t.points, self._centre, self.plane,
            self.thickness[lo:hi], self._finite, None if self.small else True, mean, self.modes, self.trial[rows],
            modulus, matrix, forces, answer, rest,
        )  # fmt: skip
        if matrix is not None and rest is not None and np.isnan(rest).any():
            bad = int(np.argmax(np.isnan(rest).any(axis=1)))
            raise Bad(int(el.ids[lo + bad]), "its enhanced strains have no stiffness left, as where all of it flows "
                      "without hardening; its mean dilatation (fem.dilatation mean) carries that")  # fmt: skip
        sink.add(nodes, self.dofs, self._offsets[lo:hi], forces, matrix)

    def _turn(self, nodes: Any, middle: Floats, u: Floats, before: Floats, rows: slice) -> None:
        """Turn the committed stress with the material (Hughes & Winget 1980)."""
        loops.turned(nodes, middle, u, before, self._slopes, self.plane, self.stress[rows], self._turned[rows])

    def commit(self) -> None:
        doubled = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
        self.energy += 0.5 * np.einsum("mc,mc,c->m", self._turned + self.trial, self._strain_step, doubled)
        self.stress[:] = self.trial
        self.history[:] = self._history
        self.strain += self._strain_step
        self.dissipated += self._work
        self.alpha[:] = self._alpha
        if self._warm is not None:
            self.warmth[:] = self._warm

    # what it has

    def _volumes(self) -> None:
        t = self.table
        loops.volumes(self.nodes, self.x, self._values, self._slopes, t.weights, self.plane, self.thickness,
                          self.point_volume)  # fmt: skip
        self.volume[:] = self.point_volume.reshape(len(self.nodes), -1).sum(axis=1)
        if not (self.volume > 0.0).all():
            bad = int(np.argmin(self.volume))
            raise Bad(int(self.elements.ids[bad]), "its volume is not positive")

    def _masses(self, *, consistent: bool) -> tuple[Floats, Floats | None]:
        full = shapes.table(self.elements.kind, full=True)
        e, k = self.nodes.shape
        lumped, matrix = np.empty((e, k)), np.empty((e, k, k)) if consistent else None
        loops.masses(self.nodes, self.x, np.ascontiguousarray(full.values), np.ascontiguousarray(full.slopes),
                         full.weights, self.plane, self.thickness, self.elements.density, matrix, lumped)  # fmt: skip
        return lumped, matrix

    def mass(self, sink: Sink, *, lumped: Floats | None = None) -> None:
        own, matrix = self._masses(consistent=lumped is None)
        if lumped is not None:
            for dof in self.dofs:
                np.add.at(lumped[:, dof], self.nodes, own)
            return
        assert matrix is not None
        c, (e, k) = len(self.dofs), self.nodes.shape
        for lo in range(0, e, CHUNK):
            hi = min(lo + CHUNK, e)
            full = np.zeros((hi - lo, c, c, k, k))
            for i in range(c):
                full[:, i, i] = matrix[lo:hi]
            sink.add(self.nodes[lo:hi], self.dofs, self._offsets[lo:hi], np.zeros((hi - lo, c, k)), full)

    def energies(self) -> tuple[float, float]:
        """Internal energy, what flow has taken included, and that alone."""
        return float(self.energy @ self.point_volume), float(self.dissipated @ self.point_volume)

    def weights(self) -> Floats:
        """Mass of each node by its shape function: what a uniform acceleration does."""
        matrix = self._masses(consistent=True)[1]
        assert matrix is not None
        out = np.zeros((len(self.x), 3))
        own = np.zeros(len(self.x))
        np.add.at(own, self.nodes, matrix.sum(axis=2))
        out[:, self.dofs] = own[:, None]
        return out

    def output(self) -> dict[str, Floats]:
        g, e = self.table.count, len(self.nodes)
        w = self.point_volume.reshape(e, g) / self.volume[:, None]
        cells = {"stress": np.einsum("eg,egc->ec", w, self.stress.reshape(e, g, 6))}
        if state_rows(self.elements.law):
            plastic = self.history[PLASTIC_STRAIN].reshape(e, g)
            cells["plastic_strain"] = (w * plastic).sum(axis=1)
        return cells

    def at_nodes(self) -> tuple[Floats, Floats]:
        matrix = shapes.extrapolation(self.elements.kind, self.elements.gauss)
        return np.einsum("kg,egc->ekc", matrix, self.stress.reshape(len(self.nodes), -1, 6)), self.volume

    def forget(self) -> None:
        self._assembled = None

    def state(self) -> dict[str, Floats]:
        warm = {"warmth": self.warmth} if len(self.warmth) else {}
        return {"stress": self.stress, "strain": self.strain, "history": self.history, "alpha": self.alpha,
                "energy": self.energy, "dissipated": self.dissipated, **warm}  # fmt: skip

    def restore(self, data: dict[str, Floats]) -> None:
        for name, own in self.state().items():
            own[:] = data[name]
        self.forget()


def _mean(thickness: Floats) -> Floats:
    return np.ascontiguousarray(thickness if thickness.ndim == 1 else thickness.mean(axis=1), dtype=float)
