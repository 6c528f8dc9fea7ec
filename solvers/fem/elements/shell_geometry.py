"""Stiffness of a shell's stresses at large rotations: second variations of the strains of `mitc4` and `mitc3`.

Turns are spatial; their second variation is taken symmetric, which it is where nodes are in balance.
"""

from __future__ import annotations

import numpy as np

from ...jit import kernel
from .mitc4 import TIED_R, TIED_S, base_at, dot, shape_at


@kernel
def of_turn(d, p, scale, i, matrix, q):
    """Second variation of p . d under turns of node i, symmetric: theta-theta block."""
    along = dot(p, d)
    for m in range(3):
        for n in range(3):
            value = 0.5 * (p[m] * d[n] + d[m] * p[n]) - (along if m == n else 0.0)
            matrix[q, 3 + m, 3 + n, i, i] += scale * value


@kernel
def of_shift_and_turn(d, scale, i, j, matrix, q):
    """Second variation scale du_i . (theta_j x d_j), and its transpose."""
    for m in range(3):
        for n in range(3):
            if m == n:
                continue
            k = 3 - m - n
            sign = 1.0 if (n - m) % 3 == 1 else -1.0
            value = scale * sign * d[k]
            matrix[q, m, 3 + n, i, j] += value
            matrix[q, 3 + n, m, j, i] += value


@kernel
def tied_geometry(pulled, y, d, values, by_r, by_s, base, matrix, q):
    """Stiffness of the stresses through the strains at the tying points."""
    for p in range(9):
        if pulled[p] == 0.0:
            continue
        shape_at(TIED_R[p], TIED_S[p], values, by_r, by_s)
        base_at(values, by_r, by_s, y, d, base)
        if p < 5:
            for i in range(4):
                for j in range(4):
                    if p < 2:
                        value = by_r[i] * by_r[j]
                    elif p < 4:
                        value = by_s[i] * by_s[j]
                    else:
                        value = 0.5 * (by_r[i] * by_s[j] + by_s[i] * by_r[j])
                    for m in range(3):
                        matrix[q, m, m, i, j] += pulled[p] * value
        else:
            a = 0 if p < 7 else 1
            for j in range(4):
                for i in range(4):
                    na = by_r[i] if a == 0 else by_s[i]
                    of_shift_and_turn(d[j], 0.5 * pulled[p] * na * values[j], i, j, matrix, q)
                of_turn(d[j], base[a], 0.5 * pulled[p] * values[j], j, matrix, q)


@kernel
def bending_geometry(t, tension, base, by_r, by_s, d, matrix, q):
    """Stiffness of the stresses through the strains that grow along t."""
    push = np.empty(3)
    n = len(by_r)
    for k in range(3):
        a = (0, 1, 0)[k]
        b = (0, 1, 1)[k]
        pull = tension[k]
        for i in range(n):
            ia = by_r[i] if a == 0 else by_s[i]
            ib = by_r[i] if b == 0 else by_s[i]
            for m in range(3):
                push[m] = ib * (base[a, m] + t * base[2 + a, m]) + ia * (base[b, m] + t * base[2 + b, m])
            of_turn(d[i], push, 0.5 * t * pull, i, matrix, q)
            for j in range(n):
                ja = by_r[j] if a == 0 else by_s[j]
                jb = by_r[j] if b == 0 else by_s[j]
                both = 0.5 * (ia * jb + ib * ja)
                of_shift_and_turn(d[j], t * pull * both, i, j, matrix, q)
                along = dot(d[i], d[j])
                scale = t * t * pull * both
                for m in range(3):
                    for o in range(3):
                        value = -d[i, o] * d[j, m] + (along if m == o else 0.0)
                        matrix[q, 3 + m, 3 + o, i, j] += scale * value
