"""Stiffness of a nine-node shell's stresses at large rotations: second variations of the strains of `mitc9`."""

from __future__ import annotations

import numpy as np

from ...jit import kernel
from .mitc4 import base_at, dot
from .mitc9 import BY_R, BY_S, PLACE, PLANE, RR, RT, SS, TIED, VALUES
from .shell_geometry import of_shift_and_turn, of_turn


@kernel
def tied_geometry(pulled, y, d, base, matrix, q):
    """Add it for what the stresses do to the tied strains, (3, 55) by powers of t."""
    push = np.empty(3)
    for p in range(TIED):
        at = PLACE[p]
        values, by_r, by_s = VALUES[at], BY_R[at], BY_S[at]
        base_at(values, by_r, by_s, y, d, base)
        if p < PLANE:
            a = 0 if p < RR or p >= SS else 1
            b = 0 if p < RR else 1
            flat, once, twice = pulled[0, p], pulled[1, p], pulled[2, p]
            for i in range(9):
                ia = by_r[i] if a == 0 else by_s[i]
                ib = by_r[i] if b == 0 else by_s[i]
                for m in range(3):
                    push[m] = once * (ib * base[a, m] + ia * base[b, m])
                    push[m] += twice * (ib * base[2 + a, m] + ia * base[2 + b, m])
                of_turn(d[i], push, 0.5, i, matrix, q)
                for j in range(9):
                    ja = by_r[j] if a == 0 else by_s[j]
                    jb = by_r[j] if b == 0 else by_s[j]
                    both = 0.5 * (ia * jb + ib * ja)
                    of_shift_and_turn(d[j], once * both, i, j, matrix, q)
                    along = dot(d[i], d[j])
                    for m in range(3):
                        matrix[q, m, m, i, j] += flat * both
                        for o in range(3):
                            value = -d[i, o] * d[j, m] + (along if m == o else 0.0)
                            matrix[q, 3 + m, 3 + o, i, j] += twice * both * value
        else:
            a = 0 if p < RT else 1
            pull = pulled[0, p]
            for j in range(9):
                for i in range(9):
                    na = by_r[i] if a == 0 else by_s[i]
                    of_shift_and_turn(d[j], 0.5 * pull * na * values[j], i, j, matrix, q)
                of_turn(d[j], base[a], 0.5 * pull * values[j], j, matrix, q)
