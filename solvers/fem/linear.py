"""Sparse linear systems by what is installed: MKL PARDISO, CHOLMOD, SuperLU, or conjugate gradients with multigrid.

All take CSR; of a symmetric matrix the upper triangle. The structure is analysed once, factors serve many right sides,
and each solution's residual is checked.
"""

from __future__ import annotations

import ctypes
import functools
import importlib.util
import logging
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from numpy.typing import NDArray

Floats = NDArray[np.float64]
log = logging.getLogger("zrno")
RESIDUAL = 1e-3  # relative to the load, after refinement: above it the system is singular to working precision
POOR = 1e-6  # above it the log says so: the softest motions are only so exact
REFINED = 1e-9  # residuals above it are refined
REFINEMENTS = 3


class Singular(ArithmeticError):
    """A matrix that has no inverse. equation: the first one without a pivot, -1 unknown."""

    def __init__(self, equation: int, message: str) -> None:
        super().__init__(message)
        self.equation = equation


class Factors(Protocol):
    """What a solver's library must do."""

    name: str

    def factor(self, values: Floats) -> None:
        """Of the matrix with these values; raises Singular."""

    def solve(self, right: Floats) -> Floats:
        """right: (n,) or (n, m)."""


class System:
    """A matrix of fixed structure.

    kind: "definite", "symmetric" (indefinite) or "general"; method: "auto" or a key of METHODS; near_null: motions that
    the matrix hardly resists, for multigrid.
    """

    def __init__(
        self, starts: NDArray[np.int32], columns: NDArray[np.int32], *, kind: str = "definite", method: str = "auto",
        threads: int = 1, near_null: Callable[[], Floats] | None = None,
    ) -> None:  # fmt: skip
        self.n = len(starts) - 1
        self.kind = kind
        self.threads = threads
        self.values = np.zeros(len(columns))
        self._starts, self._columns = starts, columns
        self._method = chosen(method, self.n)
        self._near_null = near_null
        self._factors: Factors | None = None
        self.factored = False
        self.factorisations = 0

    @property
    def name(self) -> str:
        """Of the library, for the log."""
        return self._method

    @property
    def matrix(self) -> Any:
        """The stored triangle (or all of it) as scipy's CSR over the same values."""
        return sp.csr_matrix((self.values, self._columns, self._starts), shape=(self.n, self.n), copy=False)

    def full(self) -> Any:
        """The whole matrix."""
        upper = self.matrix
        return upper if self.kind == "general" else upper + sp.triu(upper, 1).T

    def product(self, x: Floats) -> Floats:
        """Matrix times a vector."""
        m = self.matrix
        out: Floats = m @ x
        if self.kind != "general":
            out = out + m.T @ x - (m.diagonal() * x.T).T
        return out

    def factor(self, kind: str | None = None) -> None:
        """Factor the values that now stand; raises Singular. kind: as what, where that changes."""
        self.factored = False  # until it has worked: a step that is halved begins with these factors
        if not np.isfinite(self.values.sum()):  # PARDISO's memory does not survive it
            raise Singular(-1, "the matrix is not finite")
        if kind is not None and kind != self.kind:
            self.kind, self._factors = kind, None
        if self._factors is None:
            self._factors = METHODS[self._method](self)
        self._factors.factor(self.values)
        self.factored = True
        self.factorisations += 1

    def solve(self, right: Floats) -> Floats:
        """x of K x = right; raises Singular where the residual is not small."""
        assert self._factors is not None
        if not self.n:
            return right.copy()
        x = self._factors.solve(right)
        scale = float(np.abs(right).max(initial=0.0))
        if scale == 0.0:
            return x
        for _ in range(REFINEMENTS):
            left = right - self.product(x)
            size = float(np.abs(left).max()) / scale
            if not size > REFINED:
                return x
            x = x + self._factors.solve(left)
        size = float(np.abs(right - self.product(x)).max()) / scale
        if not size < RESIDUAL:
            raise Singular(-1, f"the residual of the solution is {size:.1e} of the load")
        if size > POOR:
            log.warning("the linear system is ill-conditioned: the solution leaves %.1e of the load", size)
        return x


def installed() -> list[str]:
    """Methods that this machine has, best first."""
    found = ["scipy"]
    if importlib.util.find_spec("sksparse") is not None:
        found.insert(0, "cholmod")
    if importlib.util.find_spec("pypardiso") is not None:
        found.insert(0, "pardiso")
    if importlib.util.find_spec("pyamg") is not None:
        found.append("multigrid")
    return found


def chosen(method: str, n: int) -> str:
    """A method by name, or the best for n equations. ValueError for one that is not installed."""
    if method == "auto":
        return "scipy" if n < SMALL else installed()[0]
    if method not in METHODS:
        raise ValueError(f"no such linear solver {method!r}; {', '.join(METHODS)} are")
    if method not in installed():
        needs = {"pardiso": "pypardiso", "cholmod": "scikit-sparse", "multigrid": "pyamg"}[method]
        raise ValueError(f"the linear solver {method} is not installed: pip install {needs}")
    return method


SMALL = 300  # equations: below, loading a library takes longer than solving


@functools.cache
def _mkl() -> Any:
    """MKL's library. pypardiso finds it too, but looks through the whole environment: a tenth of a second."""
    beside = sorted((Path(sys.prefix) / "lib").glob("libmkl_rt.so*"))
    if beside:
        library = ctypes.CDLL(str(beside[-1]))
    else:
        from pypardiso.pardiso_wrapper import PyPardisoSolver

        library = PyPardisoSolver().libmkl
    library.MKL_CBWR_Set(ctypes.c_int(SAME_BITS))  # before its first use; where it cannot, it does as ever
    return library


SAME_BITS = 0x10002  # MKL_CBWR_AUTO, strict: results do not depend on where arrays lie, and a resumed run goes on alike


class _Pardiso:
    """MKL PARDISO by pypardiso's library."""

    name = "pardiso"

    def __init__(self, system: System) -> None:
        library = _mkl()
        self._call_library = library.pardiso
        self._call_library.restype = None
        library.MKL_Set_Num_Threads(ctypes.c_int(max(1, system.threads)))
        self._type = {"definite": 2, "symmetric": -2, "general": 11}[system.kind]
        self._handle = np.zeros(64, np.int64)
        self._options = np.zeros(64, np.int32)
        o = self._options
        o[0] = 1  # all of these are ours
        o[1] = 2  # nested dissection
        o[9] = 13 if self._type == 11 else 8  # pivots are perturbed by 10^-that
        o[10] = o[12] = 1 if self._type == 11 else 0  # scaling and matching
        o[20] = 1  # Bunch-Kaufman
        o[23] = 1 if system.threads > 1 and self._type != 11 else 0  # two-level factorisation
        o[34] = 1  # numbers from 0
        self._starts, self._columns = system._starts, system._columns
        self._n = system.n
        self._values = system.values
        self._order = np.zeros(1, np.int32)
        empty = np.zeros(1)
        self._run(11, empty, empty)

    def factor(self, values: Floats) -> None:
        self._values = values
        empty = np.zeros(1)
        self._run(22, empty, empty)

    def solve(self, right: Floats) -> Floats:
        right = np.asfortranarray(right, dtype=float)
        x = np.empty_like(right)
        self._run(33, right, x)
        return x

    def _run(self, phase: int, right: Floats, x: Floats) -> None:
        def pointer(array: NDArray[Any]) -> Any:
            return array.ctypes.data_as(ctypes.POINTER(ctypes.c_int32))

        def number(value: int) -> Any:
            return ctypes.byref(ctypes.c_int32(value))

        error = ctypes.c_int32(0)
        many = right.shape[1] if right.ndim == 2 else 1
        self._call_library(
            self._handle.ctypes.data_as(ctypes.POINTER(ctypes.c_int64)), number(1), number(1), number(self._type),
            number(phase), number(self._n), self._values.ctypes.data_as(ctypes.c_void_p), pointer(self._starts),
            pointer(self._columns), pointer(self._order), number(many), pointer(self._options), number(0),
            right.ctypes.data_as(ctypes.c_void_p), x.ctypes.data_as(ctypes.c_void_p), ctypes.byref(error),
        )  # fmt: skip
        if error.value == -4:
            raise Singular(int(self._options[29]) - 1, "a pivot is zero or negative")
        if error.value == -2:
            raise MemoryError("not enough memory for the factors")
        if error.value:
            raise RuntimeError(f"PARDISO's error {error.value} in phase {phase}")

    def __del__(self) -> None:
        if not sys.is_finalizing() and self._handle.any():
            empty = np.zeros(1)
            self._run(-1, empty, empty)


class _Cholmod:
    name = "cholmod"

    def __init__(self, system: System) -> None:
        self._system = system
        self._factor: Any = None
        self._general = _SuperLU(system) if system.kind != "definite" else None

    def factor(self, values: Floats) -> None:
        from sksparse.cholmod import CholmodNotPositiveDefiniteError, cholesky

        if self._general is not None:
            self._general.factor(values)
            return
        matrix = self._system.matrix.T.tocsc()
        try:
            if self._factor is None:
                self._factor = cholesky(matrix)
            else:
                self._factor.cholesky_inplace(matrix)
        except CholmodNotPositiveDefiniteError as error:
            raise Singular(int(error.column), "a pivot is zero or negative") from error

    def solve(self, right: Floats) -> Floats:
        out: Floats = self._general.solve(right) if self._general is not None else self._factor(right)
        return out


class _SuperLU:
    name = "scipy"

    def __init__(self, system: System) -> None:
        self._system = system
        self._factor: Any = None

    def factor(self, values: Floats) -> None:
        matrix = self._system.full().tocsc()
        symmetric = self._system.kind != "general"
        try:
            if symmetric:  # pivots stay on the diagonal, so that the ordering holds
                self._factor = spl.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                                        options={"SymmetricMode": True})  # fmt: skip
            else:
                self._factor = spl.splu(matrix)
        except RuntimeError as error:
            raise Singular(-1, "a pivot is zero") from error
        pivots = self._factor.U.diagonal()
        if self._system.kind == "definite" and not (pivots > 0.0).all():
            bad = int(np.argmin(pivots))
            raise Singular(int(np.flatnonzero(self._factor.perm_c == bad)[0]), "a pivot is zero or negative")

    def solve(self, right: Floats) -> Floats:
        out: Floats = self._factor.solve(right)
        return out


class _Multigrid:
    """Conjugate gradients, preconditioned by smoothed aggregation with the rigid motions.

    Vanek, Mandel & Brezina 1996.
    """

    name = "multigrid"
    tolerance = 1e-10

    def __init__(self, system: System) -> None:
        self._system = system
        self._precondition: Any = None
        self._matrix: Any = None

    def factor(self, values: Floats) -> None:
        import pyamg

        if self._system.kind != "definite":
            raise ValueError("conjugate gradients need a positive definite matrix; choose another linear solver")
        self._matrix = self._system.full().tocsr()
        near = self._system._near_null() if self._system._near_null is not None else None
        hierarchy = pyamg.smoothed_aggregation_solver(self._matrix, B=near, smooth="energy", max_coarse=500)
        self._precondition = hierarchy.aspreconditioner()

    def solve(self, right: Floats) -> Floats:
        out: Floats
        if right.ndim == 2:
            return np.column_stack([self.solve(column) for column in right.T])
        out, fail = spl.cg(self._matrix, right, rtol=self.tolerance, maxiter=2000, M=self._precondition)
        if fail:
            raise Singular(-1, "conjugate gradients do not converge")
        return out


METHODS: dict[str, Callable[[System], Factors]] = {
    "pardiso": _Pardiso,
    "cholmod": _Cholmod,
    "scipy": _SuperLU,
    "multigrid": _Multigrid,
}
