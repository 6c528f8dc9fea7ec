"""What the loops over shells take of one element."""

from __future__ import annotations

from ...jit import kernel


@kernel
def gather_reference(nodes, q, x, directors, half, reference, thick):
    """The first shape of one shell."""
    for i in range(nodes.shape[1]):
        for m in range(3):
            reference[i, m] = x[nodes[q, i], m]
            thick[i, m] = half[q, i] * directors[q, i, m]


@kernel
def gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite):
    """One shell of k nodes: first shape (k, 3) and half-thickness directors, those now, displacement (k, 6), turns."""
    for i in range(nodes.shape[1]):
        a = nodes[q, i]
        for m in range(3):
            reference[i, m] = x[a, m]
            thick[i, m] = half[q, i] * directors[q, i, m]
            now[i, m] = x[a, m] + (u[a, m] if finite is not None else 0.0)
            for k in range(3):
                turns[i, m, k] = turn[a, m, k] if finite is not None else (1.0 if m == k else 0.0)
        for c in range(6):
            moved[i, c] = u[a, c]
        for m in range(3):
            total = 0.0
            for k in range(3):
                total += turns[i, m, k] * thick[i, k]
            corner[i, m] = total
