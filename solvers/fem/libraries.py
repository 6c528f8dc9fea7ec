"""What factors a sparse matrix: MKL PARDISO, CHOLMOD, SuperLU; or solves without factors, by multigrid."""

from __future__ import annotations

import ctypes
import functools
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .linear import System

Floats = NDArray[np.float64]


class Singular(ArithmeticError):
    """A matrix that has no inverse. equation: the first one without a pivot, -1 unknown; answer: what was found all
    the same, None where nothing was."""

    def __init__(self, equation: int, message: str, answer: Floats | None = None) -> None:
        super().__init__(message)
        self.equation = equation
        self.answer = answer


class Factors(Protocol):
    """What a solver's library must do."""

    name: str

    def factor(self, values: Floats) -> None:
        """Of the matrix with these values; raises Singular."""

    def solve(self, right: Floats) -> Floats:
        """right: (n,) or (n, m)."""


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


ALIKE = 100  # per cent of their columns that equations of one block share: with 80 MKL 2026.2 crashes on a band matrix
BLOCKS = 5_000  # equations: below, the analysis takes next to nothing
SAME_BITS = 0x10002  # MKL_CBWR_AUTO, strict: results do not depend on where arrays lie, and a resumed run goes on alike


class Pardiso:
    """MKL PARDISO by pypardiso's library.

    single: factors, and right sides, of half the digits and half the memory; blocks: the ordering goes by groups of
    equations that have the same columns, as a node's have: less than half of the time and memory of the analysis, but
    the equation that has no pivot is not told. None: where a definite matrix is large.
    """

    name = "pardiso"

    def __init__(self, system: System, *, single: bool = False, blocks: bool | None = None) -> None:
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
        self._blocks = self._type == 2 and system.n >= BLOCKS if blocks is None else blocks
        o[23] = 1 if self._blocks or (system.threads > 1 and self._type == -2) else 0  # two-level factorisation
        o[27] = 1 if single else 0
        o[34] = 1  # numbers from 0
        o[36] = -ALIKE if self._blocks else 0
        self._number = np.float32 if single else np.float64
        self._system = system
        self._starts, self._columns = system.starts, system.columns
        self._n = system.n
        self._values: NDArray[Any] = system.values
        self._order = np.zeros(1, np.int32)
        empty = np.zeros(1)
        self._run(11, empty, empty)

    def factor(self, values: Floats) -> None:
        self._values = values.astype(self._number, copy=False)
        empty = np.zeros(1)
        try:
            self._run(22, empty, empty)
        except Singular:
            if self._blocks and self._number is np.float64:  # to know which equation it is
                Pardiso(self._system, blocks=False).factor(values)
            raise

    def solve(self, right: Floats) -> Floats:
        own = np.asfortranarray(right, dtype=self._number)
        x = np.empty_like(own)
        self._run(33, own, x)
        return x.astype(float, copy=False)

    def _run(self, phase: int, right: NDArray[Any], x: NDArray[Any]) -> None:
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


class Cholmod:
    name = "cholmod"

    def __init__(self, system: System) -> None:
        self._system = system
        self._factor: Any = None
        self._general = SuperLU(system) if system.kind != "definite" else None

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


class SuperLU:
    name = "scipy"

    def __init__(self, system: System) -> None:
        self._system = system
        self._factor: Any = None

    def factor(self, values: Floats) -> None:
        import scipy.sparse.linalg as spl

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


class Multigrid:
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
        near = self._system.near_null() if self._system.near_null is not None else None
        hierarchy = pyamg.smoothed_aggregation_solver(self._matrix, B=near, smooth="energy", max_coarse=500)
        self._precondition = hierarchy.aspreconditioner()

    def solve(self, right: Floats) -> Floats:
        import scipy.sparse.linalg as spl

        out: Floats
        if right.ndim == 2:
            return np.column_stack([self.solve(column) for column in right.T])
        out, fail = spl.cg(self._matrix, right, rtol=self.tolerance, maxiter=2000, M=self._precondition)
        if fail:
            raise Singular(-1, "conjugate gradients do not converge")
        return out
