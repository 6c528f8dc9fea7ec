"""Shells of three, four and nine nodes with their points in the plane and through the thickness."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...materials import PLASTIC_STRAIN, state_rows
from ..elements import mitc3_loops, mitc4_loops, mitc9_loops
from ..elements.mitc3 import MODES
from ..elements.points import advance_plane_stress, elastic_modulus
from ..elements.shapes import functions, table
from ..problem import SMALL, Elements
from ..shape import Shape
from ..structure import Structure
from .group import CHUNK, Bad, Sink

Floats = NDArray[np.float64]
DRILL = 1e-3  # of the shear modulus times the thickness
_LOOPS = {3: mitc3_loops, 4: mitc4_loops, 9: mitc9_loops}
_DOUBLED = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])


class ShellGroup:
    """A group of shells of one kind; see `group.Group`."""

    def __init__(self, elements: Elements, x: Floats, directors: Floats) -> None:
        self.elements = elements
        self.x = np.ascontiguousarray(x, dtype=float)
        self.nodes = np.ascontiguousarray(elements.nodes, dtype=np.int64)
        self.dofs = np.arange(6)
        e, k = self.nodes.shape
        self._loops: Any = _LOOPS[k]
        thickness = np.zeros(e) if elements.thickness is None else np.asarray(elements.thickness, dtype=float)
        self.thickness = thickness if thickness.ndim == 2 else np.repeat(thickness[:, None], k, axis=1)
        if not (self.thickness > 0.0).all():
            raise Bad(int(elements.ids[int(np.argmin(self.thickness.min(axis=1)))]), "its thickness is not positive")
        self._half = np.ascontiguousarray(0.5 * self.thickness)
        self.directors = np.ascontiguousarray(directors)
        plane = table("quad4", elements.gauss[:2]) if k == 4 else table("quad9") if k == 9 else table("tri6", full=True)
        self._points, self._weights = np.ascontiguousarray(plane.points), plane.weights
        self._values = plane.values if k > 3 else functions("tri3", plane.points)[0]
        layers = table("line2", (elements.layers,))
        self._layers, self._layer_weights = np.ascontiguousarray(layers.points[:, 0]), layers.weights
        self._root = float(np.sqrt(elements.shear_factor))
        self._finite = None if elements.geometry == SMALL else True
        modes = elements.modes if k == 4 else MODES if k == 3 else 0  # a triangle's are its bubble
        self.modes: int | None = modes or None
        m = e * len(self._weights) * len(self._layers)
        rows = max(1, state_rows(elements.law))
        self.stress, self.trial = np.zeros((m, 6)), np.zeros((m, 6))
        self.strain, self._step = np.zeros((m, 6)), np.zeros((m, 6))
        self.history, self._history = np.zeros((rows, m)), np.zeros((rows, m))
        self.energy, self.dissipated, self._work = np.zeros(m), np.zeros(m), np.zeros(m)
        self._drilled, self.drilled = np.zeros(e), np.zeros(e)  # energy of the drilling's penalty
        self.alpha, self._alpha = np.zeros((e, modes)), np.zeros((e, modes))
        self._base, self._rest = np.zeros((e, modes)), np.zeros((e, modes))
        self._answer = np.zeros((e, modes, 6, k))
        self._assembled: Floats | None = None
        some = min(CHUNK, e)
        self._matrix, self._forces = np.empty((some, 6, 6, k, k)), np.empty((some, 6, k))
        self._modulus = np.empty((some * (m // e), 6, 6))
        self._scratch, self._kept = np.empty((rows, 2)), np.empty(rows)
        self._drill = DRILL * elastic_modulus(elements.law)[1] * self.thickness.mean(axis=1)
        self._offsets = np.empty(0, np.int32)
        self._still = np.broadcast_to(np.eye(3), (len(x), 3, 3))
        self.point_volume = np.empty(m)
        self._loops.volumes(self.nodes, self.x, self.directors, self._half, self._points, self._weights, self._layers,
                      self._layer_weights, self.point_volume)  # fmt: skip
        self.volume = self.point_volume.reshape(e, -1).sum(axis=1)
        if not (self.point_volume > 0.0).all():
            bad = int(np.argmin(self.point_volume)) // (m // e)
            raise Bad(int(elements.ids[bad]), "its area is not positive: corners that coincide or cross over")
        self.last = Shape(np.zeros((len(x), 6)))
        self.warmth = np.zeros(m if elements.expansion else 0)  # committed strain by temperature, along the surface
        self._warm: Floats | None = None  # at the step's end, of a run with temperatures

    def bind(self, structure: Structure) -> None:
        self._offsets = structure.offsets(self.nodes)

    def warm(self, temperature: Floats) -> None:
        """What the nodes' temperatures (n,) at the step's end make the points grow by, as much at all layers."""
        above = (temperature - self.elements.reference)[self.nodes]
        self._warm = np.repeat(self.elements.expansion * (above @ self._values.T).ravel(), len(self._layers))

    def evaluate(self, shape: Shape, before: Shape, dt: float, sink: Sink) -> None:
        self._history[:] = self.history
        u, start = shape.u, before.u
        turn = self._still if shape.turn is None else shape.turn
        if self.modes is not None:
            self._enhance(u)
        for lo in range(0, len(self.nodes), CHUNK):
            self._chunk(lo, min(lo + CHUNK, len(self.nodes)), u, start, turn, dt, sink)
        if self.modes is not None and sink.stiff:
            self._assembled = u.copy()
            self._base[:] = self._alpha
        self.last = shape

    def _enhance(self, u: Floats) -> None:
        if self._assembled is None:
            self._alpha[:] = self.alpha
            return
        change = (u - self._assembled)[self.nodes]
        self._alpha[:] = self._base - self._rest - np.einsum("emck,ekc->em", self._answer, change)

    def _chunk(self, lo: int, hi: int, u: Floats, before: Floats, turn: Floats, dt: float, sink: Sink) -> None:
        el = self.elements
        g = len(self._weights) * len(self._layers)
        nodes, rows = self.nodes[lo:hi], slice(lo * g, hi * g)
        shell = (nodes, self.x, u)
        convex = np.empty(hi - lo, bool)
        some = self.modes is not None
        alpha = (self._alpha[lo:hi], self.alpha[lo:hi]) if some else (None, None)
        strain = self._step[rows]
        self._loops.strains(
            *shell, before, turn, self.directors[lo:hi], self._half[lo:hi], self._points, self._layers, self._root,
            self._finite, self.modes, *alpha, self.strain[rows], strain, convex,
        )  # fmt: skip
        if not convex.all():
            raise Bad(int(el.ids[lo + int(np.argmin(convex))]), "its four corners are not convex")
        modulus = self._modulus[: (hi - lo) * g]
        seen = strain
        if self._warm is not None:  # laws see what is left of the strain
            seen = strain.copy()
            seen[:, :2] -= (self._warm[rows] - self.warmth[rows])[:, None]
        advance_plane_stress(el.law, seen, self.stress[rows], self.trial[rows], self._history, lo * g, el.density, dt,
                             self._work[rows], self._scratch, modulus, self._kept)  # fmt: skip
        if self._warm is not None:
            strain[:, 2] = seen[:, 2] + self._warm[rows] - self.warmth[rows]
        forces, matrix = self._forces[: hi - lo], self._matrix[: hi - lo] if sink.stiff else None
        answer, rest = (self._answer[lo:hi], self._rest[lo:hi]) if some else (None, None)
        self._loops.integrate(
            *shell, turn, self.directors[lo:hi], self._half[lo:hi], self._points, self._weights, self._layers,
            self._layer_weights, self._root, self._drill[lo:hi], self._finite, self.modes, self.trial[rows], modulus,
            matrix, forces, answer, rest, self._drilled[lo:hi],
        )  # fmt: skip
        sink.add(nodes, self.dofs, self._offsets[lo:hi], forces, matrix)

    def commit(self) -> None:
        self.energy += 0.5 * np.einsum("mc,mc,c->m", self.stress + self.trial, self._step, _DOUBLED)
        self.stress[:] = self.trial
        self.history[:] = self._history
        self.strain += self._step
        self.dissipated += self._work
        self.drilled[:] = self._drilled
        self.alpha[:] = self._alpha
        if self._warm is not None:
            self.warmth[:] = self._warm

    def energies(self) -> tuple[float, float]:
        return float(self.energy @ self.point_volume + self.drilled.sum()), float(self.dissipated @ self.point_volume)

    # mass

    def mass(self, sink: Sink, *, lumped: Floats | None = None) -> None:
        e = len(self.nodes)
        own = self.elements.density * self._loops.areas(self.nodes, self.x) * self.thickness[:, None, :]
        h = self.thickness.mean(axis=1)[:, None]
        if lumped is not None:
            row = own.sum(axis=1)
            for c in range(3):
                np.add.at(lumped[:, c], self.nodes, row)
                np.add.at(lumped[:, 3 + c], self.nodes, row * h**2 / 12.0)
            return
        for lo in range(0, e, CHUNK):
            hi = min(lo + CHUNK, e)
            k = self.nodes.shape[1]
            full = np.zeros((hi - lo, 6, 6, k, k))
            part = 0.5 * (own[lo:hi] + own[lo:hi].transpose(0, 2, 1))
            inertia = part * (h[lo:hi] ** 2 / 12.0)[:, :, None]
            for c in range(3):
                full[:, c, c] = part
                full[:, 3 + c, 3 + c] = inertia
            sink.add(self.nodes[lo:hi], self.dofs, self._offsets[lo:hi], np.zeros((hi - lo, 6, k)), full)

    def weights(self) -> Floats:
        own = self.elements.density * self._loops.areas(self.nodes, self.x) * self.thickness[:, None, :]
        total = np.zeros(len(self.x))
        np.add.at(total, self.nodes, own.sum(axis=2))
        return np.repeat(total[:, None], 3, axis=1)

    # what it shows

    def _global(self) -> Floats:
        """Stresses (e, 4, layers, 6) in global axes, of the shape now."""
        turn = self.last.turn
        frames = self._loops.frames(self.nodes, self.x, self.directors, self._half, self._points)
        if turn is not None:
            mean = turn[self.nodes].mean(axis=1)
            frames = np.einsum("eij,egaj->egai", mean, frames)
        e, g, layers = len(self.nodes), len(self._weights), len(self._layers)
        s = self.stress.reshape(e, g, layers, 6).copy()
        s[..., 4:] *= self._root
        tensor = np.empty((e, g, layers, 3, 3))
        for k, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
            tensor[..., i, j] = tensor[..., j, i] = s[..., k]
        out = np.swapaxes(frames, 2, 3)[:, :, None] @ tensor @ frames[:, :, None]
        return np.stack([out[..., i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))], axis=-1)

    def _faces(self) -> Floats:
        """(3, layers): what the layers' stresses are at the bottom, on average and at the top, by a straight line."""
        t, w = self._layers, self._layer_weights / 2.0
        square = float((w * t * t).sum())
        slope = w * t / square if square > 0.0 else np.zeros_like(t)
        return np.stack([w - slope, w, w + slope])

    def output(self) -> dict[str, Floats]:
        share = self.point_volume.reshape(len(self.nodes), len(self._weights), -1).sum(axis=2)
        share /= share.sum(axis=1, keepdims=True)
        bottom, middle, top = np.einsum("fl,eglc,eg->fec", self._faces(), self._global(), share)
        cells = {"stress": middle, "stress_bottom": bottom, "stress_top": top}
        if state_rows(self.elements.law):
            plastic = self.history[PLASTIC_STRAIN].reshape(len(self.nodes), -1)
            cells["plastic_strain"] = plastic.max(axis=1)
        return cells

    def at_nodes(self) -> tuple[Floats, Floats]:
        matrix = self._loops.extrapolation(self._points)
        stress = np.einsum("kg,l,eglc->ekc", matrix, self._faces()[1], self._global())
        return stress, self.volume

    def forget(self) -> None:
        self._assembled = None

    def state(self) -> dict[str, Floats]:
        warm = {"warmth": self.warmth} if len(self.warmth) else {}
        return {"stress": self.stress, "strain": self.strain, "history": self.history, "alpha": self.alpha,
                "energy": self.energy, "dissipated": self.dissipated, "drilled": self.drilled, **warm}  # fmt: skip

    def restore(self, data: dict[str, Floats]) -> None:
        for name, own in self.state().items():
            own[:] = data[name]
        self.forget()
