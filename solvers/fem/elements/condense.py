"""Parameters that one element alone has, condensed out of its matrix."""

from __future__ import annotations

import numpy as np

from ...jit import kernel

LEAST = 1e-9  # a pivot over what it was: less is round-off


@kernel
def condense(inner, residual, mixed, back, modes, c, n, q, matrix, forces, answer, rest):
    """Gauss elimination of the enhanced parameters; pivots stand on the diagonal, as stiffness is.

    Where one has no stiffness left, `rest` is not a number. residual: is written over.
    """
    for m in range(modes):
        rest[q, m] = residual[m]
        residual[m] = LEAST * abs(inner[m, m])
        for i in range(c):
            for k in range(n):
                answer[q, m, i, k] = mixed[m, i, k]
    for p in range(modes):
        if abs(inner[p, p]) <= residual[p]:
            rest[q, p] = np.nan
            inner[p, p] = residual[p] if residual[p] > 0.0 else 1.0
        pivot = 1.0 / inner[p, p]
        for m in range(p + 1, modes):
            factor = inner[m, p] * pivot
            for o in range(p, modes):
                inner[m, o] -= factor * inner[p, o]
            rest[q, m] -= factor * rest[q, p]
            for i in range(c):
                for k in range(n):
                    answer[q, m, i, k] -= factor * answer[q, p, i, k]
    for p in range(modes - 1, -1, -1):
        pivot = 1.0 / inner[p, p]
        for o in range(p + 1, modes):
            rest[q, p] -= inner[p, o] * rest[q, o]
            for i in range(c):
                for k in range(n):
                    answer[q, p, i, k] -= inner[p, o] * answer[q, o, i, k]
        rest[q, p] *= pivot
        for i in range(c):
            for k in range(n):
                answer[q, p, i, k] *= pivot
    for i in range(c):
        for k in range(n):
            for m in range(modes):
                factor = back[m, i, k]
                forces[q, i, k] -= factor * rest[q, m]
                for j in range(c):
                    for l in range(n):
                        matrix[q, i, j, k, l] -= factor * answer[q, m, j, l]
