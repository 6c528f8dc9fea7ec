"""Sparse linear systems by what is installed: MKL PARDISO, CHOLMOD, SuperLU, or conjugate gradients with multigrid.

All take CSR; of a symmetric matrix the upper triangle. The structure is analysed once, factors serve many right sides,
and each solution's residual is checked. PARDISO factors large definite systems in single precision first, see `mixed`.
"""

from __future__ import annotations

import importlib.util
import logging
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..threads import available
from .libraries import Cholmod, Factors, Multigrid, Pardiso, Singular, SuperLU
from .mixed import PATIENCE, Mixed, TooFewDigits
from .structure import product_of_triangle

Floats = NDArray[np.float64]
log = logging.getLogger("zrno")
RESIDUAL = 1e-3  # relative to the load, after refinement: above it the system is singular to working precision
POOR = 1e-6  # above it the log says so: the softest motions are only so exact
REFINED = 1e-9  # residuals above it are refined
REFINEMENTS = 3


class System:
    """A matrix of fixed structure.

    kind: "definite", "symmetric" (indefinite) or "general"; method: "auto" or a key of METHODS; near_null: motions that
    the matrix hardly resists, for multigrid; single: factors of single precision may do, where they pay.
    """

    def __init__(
        self, starts: NDArray[np.int32], columns: NDArray[np.int32], *, kind: str = "definite", method: str = "auto",
        threads: int = 1, near_null: Callable[[], Floats] | None = None, single: bool = False,
    ) -> None:  # fmt: skip
        self.n = len(starts) - 1
        self.kind = kind
        self.threads = threads
        self.values = np.zeros(len(columns))
        self.starts, self.columns = starts, columns
        self._method = chosen(method, self.n)
        self.near_null = near_null
        self._single = single and self.n >= LARGE and self._method == "pardiso"
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
        import scipy.sparse as sp

        return sp.csr_matrix((self.values, self.columns, self.starts), shape=(self.n, self.n), copy=False)

    def full(self) -> Any:
        """The whole matrix."""
        import scipy.sparse as sp

        upper = self.matrix
        return upper if self.kind == "general" else upper + sp.triu(upper, 1).T

    def product(self, x: Floats) -> Floats:
        """Matrix times a vector."""
        if self.kind == "general":
            full: Floats = self.matrix @ x
            return full
        out = np.empty(x.shape[::-1])
        for column, its in zip(np.atleast_2d(x.T), np.atleast_2d(out), strict=True):
            product_of_triangle(self.starts, self.columns, self.values, np.ascontiguousarray(column), its)
        return out.T

    def factor(self, kind: str | None = None, *, answers: int = 1) -> None:
        """Factor the values that now stand; raises Singular. kind: as what, where that changes; answers: right sides
        that are known to come."""
        self.factored = False  # until it has worked: a step that is halved begins with these factors
        if not np.isfinite(self.values.sum()):  # PARDISO's memory does not survive it
            raise Singular(-1, "the matrix is not finite")
        if kind is not None and kind != self.kind:
            self.kind, self._factors = kind, None
        if answers > PATIENCE and self._single:
            self._single, self._factors = False, None
        if self._single and self.kind == "definite":
            try:
                self._make(Mixed)
                return
            except TooFewDigits as error:
                self._to_double(str(error))
        self._make(METHODS[self._method])

    def _make(self, library: Callable[[System], Factors]) -> None:
        if self._factors is None:
            self._factors = library(self)
        self._factors.factor(self.values)
        self.factored = True
        self.factorisations += 1

    def _to_double(self, cause: str) -> None:
        """Drop what was made in single precision, for good."""
        log.info("single precision factors do not do (%s): all digits from here on", cause)
        self._single, self._factors = False, None

    def release(self) -> None:
        """Give the memory of the factors back, where no right side is to come."""
        self._factors, self.factored = None, False

    def solve(self, right: Floats) -> Floats:
        """x of K x = right; raises Singular where the residual is not small."""
        assert self._factors is not None
        if not self.n:
            return right.copy()
        scale = float(np.abs(right).max(initial=0.0))
        if scale == 0.0:
            return np.zeros_like(right)
        x = self._answer(right)
        for _ in range(0 if isinstance(self._factors, Mixed) else REFINEMENTS):
            left = right - self.product(x)
            size = float(np.abs(left).max()) / scale
            if not size > REFINED:
                return x
            x = x + self._factors.solve(left)
        size = float(np.abs(right - self.product(x)).max()) / scale
        if not size < RESIDUAL:
            answer = x if np.isfinite(size) else None
            raise Singular(-1, f"the residual of the solution is {size:.1e} of the load", answer)
        if size > POOR:
            log.warning("the linear system is ill-conditioned: the solution leaves %.1e of the load", size)
        return x

    def _answer(self, right: Floats) -> Floats:
        """By the factors that are there, in single precision or not."""
        assert self._factors is not None
        if isinstance(self._factors, Mixed):
            many = self._factors.answered + (right.shape[1] if right.ndim == 2 else 1) > PATIENCE
            try:
                if not many:
                    return self._factors.solve(right)
                cause = f"more than {PATIENCE} right sides"
            except TooFewDigits as error:
                cause = str(error)
            self._to_double(cause)
            self.factor()
        return self._factors.solve(right)


def threads_for(n: int, asked: int | None) -> int:
    """As many as asked; else all for a large system of n equations, one for a small one."""
    return asked or (available() if n >= ALONE else 1)


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
LARGE = 40_000  # equations of solids: above, half of the factors takes so much less time that answering by them pays
ALONE = 20_000  # equations: below, a second thread saves next to nothing

METHODS: dict[str, Callable[[System], Factors]] = {
    "pardiso": Pardiso,
    "cholmod": Cholmod,
    "scipy": SuperLU,
    "multigrid": Multigrid,
}
