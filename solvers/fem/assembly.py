"""The structure as one system: its groups of elements, free degrees of freedom, relations, and the sparse matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..materials.tangent import symmetric_tangent
from . import linear, structure
from .elements.points import elastic_modulus
from .groups import make_groups
from .groups.group import Sink
from .groups.timed import TimedGroup
from .heat import Heat, has_heat
from .libraries import Singular
from .problem import SMALL, Problem
from .shape import Shape
from .stops import Stops

if TYPE_CHECKING:
    import scipy.sparse as sp

Floats = NDArray[np.float64]


def _turns(problem: Problem) -> bool:
    """Whether nodes have finite rotations."""
    return any(e.geometry != SMALL and e.family in ("shell", "beam") for e in problem.elements)


AXES = ("ux", "uy", "uz", "rx", "ry", "rz")


class Mechanism(ArithmeticError):
    """A structure that can move without resistance. node: index; dof: 0..5; answer: see `Singular`."""

    def __init__(self, node: int, dof: int, cause: str, answer: Floats | None = None) -> None:
        super().__init__(cause)
        self.node = node
        self.dof = dof
        self.answer = answer


def moment_nodes(problem: Problem) -> NDArray[np.int64]:
    """Nodes of finite rotation with a moment: one about a fixed axis has no potential, and the matrix no symmetry."""
    if not _turns(problem):
        return np.empty(0, np.int64)
    found = [load.nodes[(load.dofs > 2) & (load.values != 0.0)] for load in problem.nodal_loads]
    return np.unique(np.concatenate(found)) if found else np.empty(0, np.int64)


class Assembly:
    """Groups, equations and the matrix of a problem."""

    def __init__(self, problem: Problem, *, threads: int | None = None) -> None:
        self._moments = moment_nodes(problem)
        laws = [e.law for e in problem.elements if e.law is not None]
        symmetric = not len(self._moments) and all(symmetric_tangent(law) for law in laws)
        self.problem = problem
        self.n = len(problem.x)
        self.groups = make_groups(problem)
        active = np.zeros((self.n, 6), bool)
        for group in self.groups:
            used = np.unique(group.elements.nodes)
            active[np.ix_(used, group.dofs)] = True
        self.active_before_fixing = active
        self.active = active & ~problem.fixed
        self.prescribed = np.zeros((self.n, 6), bool)
        for motion in problem.motions:
            self.prescribed[motion.nodes, motion.dofs] = True
        self.free = self.active & ~self.prescribed
        self.structure = structure.build(self.free, [g.elements.nodes for g in self.groups], symmetric=symmetric)
        for group in self.groups:
            group.bind(self.structure)
        solid = [g for g in self.groups if g.elements.law is not None]
        self.stiffness = sum(elastic_modulus(g.elements.law)[0] * float(g.volume.sum()) for g in solid)
        self.still = np.broadcast_to(np.eye(3), (self.n, 3, 3)).copy() if _turns(problem) else None
        self.where = np.flatnonzero(self.free.ravel())
        self.transform = self._relations() if problem.relations else None
        self.threads = linear.threads_for(self.equations, threads)
        self._moment_places = self._places_of_moments()
        self.heat = Heat(problem, self.groups) if has_heat(problem) else None
        self._timed = [g for g in self.groups if isinstance(g, TimedGroup)]
        self.idle = self._idle()
        self.system = self._system(self.structure.starts, self.structure.columns)
        self.stops = self._stops()

    def _system(self, starts: NDArray[np.int32], columns: NDArray[np.int32]) -> linear.System:
        kind = "definite" if self.structure.symmetric else "general"
        solid = all(g.elements.family == "solid" for g in self.groups)  # shells are too soft for half the digits
        return linear.System(starts, columns, kind=kind, method=self.problem.solver, threads=self.threads,
                             near_null=self._rigid_motions, single=solid)  # fmt: skip

    @property
    def equations(self) -> int:
        """Unknowns."""
        return self.structure.count if self.transform is None else self.transform.shape[1]

    # elements that come and go

    def at(self, time: float, shape: Shape) -> bool:
        """Before a step from a shape that ends at a time: its temperatures. Returns whether elements came or went."""
        if self.heat is not None:
            self.heat.at(time)
        changed = [group.at(time, shape) for group in self._timed]
        if any(changed):
            self.idle = self._idle()
        return any(changed)

    def _idle(self) -> NDArray[np.bool_]:
        """(n, 6) the degrees of freedom none of whose elements is there: they stay where they are."""
        if not self._timed:
            return np.zeros((self.n, 6), bool)
        used = np.zeros((self.n, 6), bool)
        for group in self.groups:
            if not isinstance(group, TimedGroup) or group.living:
                used[np.ix_(np.unique(group.elements.nodes), group.dofs)] = True
        return self.free & ~used

    # vectors

    def gather(self, forces: Floats) -> Floats:
        """Forces (n, 6) on the unknowns."""
        own: Floats = forces.ravel()[self.where]
        return own if self.transform is None else self.transform.T @ own

    def expand(self, unknowns: Floats) -> Floats:
        """A change (n, 6) of the unknowns; zero elsewhere."""
        out = np.zeros(6 * self.n)
        out[self.where] = unknowns if self.transform is None else self.transform @ unknowns
        return out.reshape(self.n, 6)

    # matrices

    def evaluate(
        self, shape: Shape, before: Shape, dt: float, *, stiff: bool = True, moved: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """Internal forces (n, 6) at a shape, and the force of a motion `moved` (n, 6) by the stiffness.

        stiff: also fills the matrix (`factor` then makes it ready). Raises Bad.
        """
        values = self._values() if stiff else None
        sink = Sink(np.zeros((self.n, 6)), self.structure, values, moved)
        for group in self.groups:
            group.evaluate(shape, before, dt, sink)
        if self.stops is not None:
            self.stops.evaluate(shape.u, sink)
        if values is not None and len(self._moments):
            x, y, z = sink.forces[self._moments, 3:].T
            zero = np.zeros_like(x)
            turning = 0.5 * np.array([[zero, z, -y], [-z, zero, x], [y, -x, zero]]).transpose(2, 0, 1)
            kept = self._moment_places >= 0
            values[self._moment_places[kept]] += turning[kept]
        if values is not None and self.idle.any():
            values += self.diagonal_values(np.where(self.idle, self.stiffness, 0.0))
        return sink.forces, sink.of_motion

    def _places_of_moments(self) -> NDArray[np.int64]:
        """(m, 3, 3) where the rotations' own entries of the nodes with moments stand among the values, -1 nowhere."""
        s = self.structure
        places = np.full((len(self._moments), 3, 3), -1)
        for k, node in enumerate(self._moments.tolist()):
            for i in range(3):
                row = int(s.equation[node, 3 + i])
                if row < 0:
                    continue
                own = s.columns[s.starts[row] : s.starts[row + 1]]
                for j in range(3):
                    column = int(s.equation[node, 3 + j])
                    if column >= 0:
                        places[k, i, j] = s.starts[row] + int(np.searchsorted(own, column))
        return places

    def _values(self) -> Floats:
        if self.transform is None:
            self.system.values[:] = 0.0
            return self.system.values
        self._full_values = np.zeros(len(self.structure.columns))
        return self._full_values

    def factor(
        self, *, extra: Floats | None = None, scale: float = 1.0, definite: bool = True, answers: int = 1
    ) -> None:
        """Factor scale x matrix + extra (values of the same structure), for so many right sides. Raises Mechanism."""
        values = self.system.values if self.transform is None else self._full_values
        if scale != 1.0:
            values *= scale
        if extra is not None:
            values += extra
        if self.transform is not None:
            self._reduce(values)
        kind = "general" if not self.structure.symmetric else "definite" if definite else "symmetric"
        try:
            self.system.factor(kind, answers=answers)
        except Singular as error:
            raise self.mechanism(error) from error

    def _reduce(self, values: Floats) -> None:
        """The matrix of the independent unknowns."""
        import scipy.sparse as sp

        s, t = self.structure, self.transform
        assert t is not None
        upper = sp.csr_matrix((values, s.columns, s.starts), shape=(s.count, s.count))
        full = upper + sp.triu(upper, 1).T if s.symmetric else upper
        reduced = (t.T @ full @ t).tocsr()
        reduced = sp.triu(reduced).tocsr() if s.symmetric else reduced
        reduced.sort_indices()
        self.system = self._system(reduced.indptr.astype(np.int32), reduced.indices.astype(np.int32))
        self.system.values[:] = reduced.data

    def solve(self, right: Floats) -> Floats:
        """Unknowns of a right side; raises Mechanism."""
        try:
            return self.system.solve(right)
        except Singular as error:
            raise self.mechanism(error) from error

    def mechanism(self, error: Singular) -> Mechanism:
        """What a singular matrix means: where and along what the structure can move."""
        place, cause = error.equation, "the structure can move without resistance"
        if place < 0:
            cause += f", or its stiffnesses lie so far apart that numbers run out of digits ({error}): least of all"
        if place < 0 and len(self.system.values):
            place = self._softest()
        if self.transform is not None or not 0 <= place < len(self.where):
            return Mechanism(-1, 0, f"the structure can move without resistance ({error})", error.answer)
        node, dof = divmod(int(self.where[place]), 6)
        return Mechanism(node, dof, cause, error.answer)

    def _softest(self) -> int:
        """The equation with the smallest diagonal: a node that hangs loose."""
        return int(np.argmin(self.system.matrix.diagonal()))

    def mass(self, *, lumped: bool) -> tuple[Floats, Floats | None]:
        """Lumped mass (n, 6), and the consistent matrix's values in the structure, or None with lumped."""
        diagonal = np.zeros((self.n, 6))
        for group in self.groups:
            group.mass(Sink(np.zeros((self.n, 6)), None, None), lumped=diagonal)
        if lumped:
            return diagonal, None
        values = np.zeros(len(self.structure.columns))
        sink = Sink(np.zeros((self.n, 6)), self.structure, values)
        for group in self.groups:
            group.mass(sink)
        return diagonal, values

    def _stops(self) -> Stops | None:
        """The planes that nodes cannot pass, as stiff as the structure at its start asks."""
        p = self.problem
        if not p.stops:
            return None
        stops = Stops(p.stops, p.x, np.flatnonzero(self.active[:, :3].any(axis=1)))
        self.stops = None
        values = self.stiffness_values(Shape(np.zeros((self.n, 6)), self.still))
        diagonal = np.zeros(6 * self.n)
        diagonal[self.where] = values[self._diagonal_places()]
        stops.bind(self.structure, diagonal.reshape(self.n, 6))
        return stops

    def stiffness_values(self, shape: Shape, *, stops: bool = True) -> Floats:
        """Stiffness at a shape as values of the structure, with every stop touched or with none; the matrix itself
        stays as it is."""
        sink = Sink(np.zeros((self.n, 6)), self.structure, np.zeros(len(self.structure.columns)))
        for group in self.groups:
            group.evaluate(shape, shape, 0.0, sink)
        if self.stops is not None and stops:
            self.stops.evaluate(shape.u, sink, closed=True)
        assert sink.values is not None
        return sink.values

    def diagonal_values(self, diagonal: Floats) -> Floats:
        """A diagonal matrix (n, 6) as values of the structure."""
        values = np.zeros(len(self.structure.columns))
        values[self._diagonal_places()] = diagonal.ravel()[self.where]
        return values

    def _diagonal_places(self) -> NDArray[np.int64]:
        """Where the diagonal stands among the values."""
        s = self.structure
        if s.symmetric:  # each row begins with its diagonal
            return np.asarray(s.starts[:-1], np.int64)
        return np.flatnonzero(np.repeat(np.arange(s.count), np.diff(s.starts)) == s.columns)

    def full_matrix(self, what: str, shape: Shape | None = None) -> sp.csr_matrix:
        """Consistent "mass", or "stiffness" at a shape, of all degrees of freedom (6 n, 6 n), held ones too."""
        import scipy.sparse as sp

        everything = structure.build(self.active, [g.elements.nodes for g in self.groups])
        values = np.zeros(len(everything.columns))
        sink = Sink(np.zeros((self.n, 6)), everything, values)
        for group in self.groups:
            group.bind(everything)
            if what == "mass":
                group.mass(sink)
            else:
                assert shape is not None
                group.evaluate(shape, shape, 0.0, sink)
            group.bind(self.structure)
        count = everything.count
        upper = sp.csr_matrix((values, everything.columns, everything.starts), shape=(count, count))
        full = (upper + sp.triu(upper, 1).T).tocoo()
        where = np.flatnonzero(self.active.ravel())
        size = 6 * self.n
        return sp.csr_matrix((full.data, (where[full.row], where[full.col])), shape=(size, size))

    def commit(self) -> None:
        """Make the last evaluation the state to go on from."""
        for group in self.groups:
            group.commit()

    # what the unknowns are

    def _relations(self) -> sp.csr_matrix:
        """Free degrees of freedom from independent ones; chains are followed."""
        import scipy.sparse as sp

        number = self.structure.equation
        n = self.structure.count
        rows: dict[int, dict[int, float]] = {}
        for r in self.problem.relations:
            slave = int(number[r.node, r.dof])
            if slave < 0:
                continue
            terms = {int(number[a, d]): float(c) for a, d, c in zip(r.nodes, r.dofs, r.coefficients, strict=True)}
            rows[slave] = {k: c for k, c in terms.items() if k >= 0}
        for _ in range(len(rows)):
            chained = [s for s, terms in rows.items() if any(k in rows for k in terms)]
            if not chained:
                break
            for slave in chained:
                merged: dict[int, float] = {}
                for k, c in rows[slave].items():
                    for k2, c2 in rows.get(k, {k: 1.0}).items():
                        merged[k2] = merged.get(k2, 0.0) + c * c2
                rows[slave] = merged
        independent = np.setdiff1d(np.arange(n), np.array(sorted(rows), dtype=int))
        place = np.full(n, -1)
        place[independent] = np.arange(len(independent))
        entries = [(i, place[i], 1.0) for i in independent]
        entries += [(s, place[k], c) for s, terms in rows.items() for k, c in terms.items()]
        i, j, v = (np.array(column) for column in zip(*entries, strict=True))
        return sp.csr_matrix((v.astype(float), (i.astype(int), j.astype(int))), shape=(n, len(independent)))

    def _rigid_motions(self) -> Floats:
        """(unknowns, 6): three shifts and three turns, for multigrid."""
        x = self.problem.x - self.problem.x.mean(axis=0)
        modes = np.zeros((6, self.n, 6))
        for k in range(3):
            modes[k, :, k] = 1.0
            axis = np.eye(3)[k]
            modes[3 + k, :, :3] = np.cross(axis, x)
            modes[3 + k, :, 3 + k] = 1.0
        return np.column_stack([mode.ravel()[self.where] for mode in modes])
