"""Free vibrations: the lowest eigenvalues of K x = omega^2 M x, by Lanczos with a shift below zero."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from numpy.typing import NDArray

from .assembly import Assembly
from .linear import System
from .shape import Shape

Floats = NDArray[np.float64]
SHIFT = 1e-7  # of the mean of diag K / diag M: rigid motions make K singular, K + shift M is not


def vibrations(assembly: Assembly, count: int, *, lumped: bool = False) -> tuple[Floats, Floats]:
    """Circular frequencies squared (count,), ascending, and modes (count, n, 6), of unit modal mass."""
    start = Shape(np.zeros((assembly.n, 6)), assembly.still)
    stiffness = assembly.stiffness_values(start)
    diagonal, mass = assembly.mass(lumped=lumped)
    mass = assembly.diagonal_values(diagonal) if mass is None else mass
    s, t = assembly.structure, assembly.transform
    k, m = (sp.csr_matrix((values, s.columns, s.starts), shape=(s.count,) * 2) for values in (stiffness, mass))
    if s.symmetric:
        k, m = _full(k), _full(m)
    if t is not None:
        k, m = (t.T @ k @ t).tocsr(), (t.T @ m @ t).tocsr()
    n = k.shape[0]
    count = min(count, n - 1)
    weight = m.diagonal()
    shift = SHIFT * float(np.mean(k.diagonal()[weight > 0.0] / weight[weight > 0.0]))
    upper = sp.triu(k + shift * m).tocsr()
    upper.sort_indices()
    system = System(upper.indptr.astype(np.int32), upper.indices.astype(np.int32), kind="definite",
                    method=assembly.problem.solver, threads=assembly.threads)  # fmt: skip
    system.values[:] = upper.data
    system.factor()
    inverse = spl.LinearOperator((n, n), matvec=lambda x: system.solve(np.ascontiguousarray(x)))
    start_vector = np.random.default_rng(0).standard_normal(n)
    values, vectors = spl.eigsh(k, count, M=m, sigma=-shift, OPinv=inverse, v0=start_vector)
    order = np.argsort(values)
    return values[order], np.stack([assembly.expand(vectors[:, i]) for i in order])


def _full(upper: sp.csr_matrix) -> sp.csr_matrix:
    return (upper + sp.triu(upper, 1).T).tocsr()
