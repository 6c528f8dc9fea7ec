"""A nine-node shell of the MITC family at one point: where strains are tied. What it shares with four nodes: `mitc4`.

Membrane and bending strains, at every t, are near MITC9's (Bucalem & Bathe 1993, Int. J. Numer. Methods Eng. 36), which
ties rr at r = +-1/sqrt(3), s = 0, +-sqrt(3/5), ss with r and s exchanged, rs at the four points +-1/sqrt(3). That fails
the patch test unless elements are parallelograms, and distorted thin ones lock. Here rr is linear along r as there, and
across it given by the strains along the two edges, s = +-1, which neighbours share, and by its mean, weighed by 1/J as
constant stresses weigh it: J^2 sigma^rr depends on r alone. rs is the bilinear field with the moments of rs by 1, r, s,
rs, weighed alike. In a parallelogram that is MITC9's.

Transverse shear, at t = 0, not as there: its six points a strain lock thin distorted plates. As in the plate of Bathe,
Brezzi & Fortin 1989 (Comput. Struct. 32) rt is spanned by 1 r s rs s^2, st by 1 r s rs r^2, given by the strains along
the edges at their two Gauss points and by their means. That plate has no ninth node of deflection; here it has, so the
gradient of the bubble (1 - r^2)(1 - s^2) joins the span, and the moment of the strains with it joins what is given.
Nodes are in VTK's order: corners, middles of edges, centre.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...jit import kernel
from .mitc4 import base_at, cross_into, dot
from .shapes import NODES, functions

NODE_R, NODE_S = (np.array(column, dtype=float) for column in zip(*NODES["quad9"], strict=True))
TWO = 1.0 / np.sqrt(3.0)
THREE = np.sqrt(0.6)
_LOW, _HIGH = (-TWO, TWO), (-THREE, 0.0, THREE)
_ENDS = (-1.0, 1.0)
_PLACES = np.array(
    [(r, s) for s in _HIGH for r in _LOW]
    + [(r, s) for r in _HIGH for s in _LOW]
    + [(r, s) for s in _HIGH for r in _HIGH]
    + [(r, s) for s in _ENDS for r in _LOW]
    + [(r, s) for r in _ENDS for s in _LOW]
)
_values, _slopes = functions("quad9", _PLACES)
VALUES = np.ascontiguousarray(_values)
BY_R, BY_S = np.ascontiguousarray(_slopes[:, :, 0]), np.ascontiguousarray(_slopes[:, :, 1])
# the tied strains rr, ss, on two edges and inside, rs, then rt and st, inside and on two edges; where each stands
_INSIDE, _EDGES_R, _EDGES_S = range(12, 21), range(21, 25), range(25, 29)
PLACE = np.array([*_EDGES_R, *range(6), *_EDGES_S, *range(6, 12), *_INSIDE, *_INSIDE, *_EDGES_R, *_INSIDE, *_EDGES_S])
RR, SS, PLANE, RT, TIED = 10, 20, 29, 42, 55  # where rr, ss, rs, rt, st end
FIRST = np.array([0, RR, SS, PLANE, PLANE])
COUNT = np.array([10, 10, 9, 26, 26])
_INNER = _PLACES[12:21]
GAUSS, LINE_WEIGHT = (np.ascontiguousarray(v) for v in np.polynomial.legendre.leggauss(3))
WEIGHT = np.outer(LINE_WEIGHT, LINE_WEIGHT).ravel()
BILINEAR = np.column_stack([np.ones(9), _INNER[:, 0], _INNER[:, 1], _INNER[:, 0] * _INNER[:, 1]])


def _shear_functions(r: float, s: float) -> NDArray[np.float64]:
    """(2, 11) what rt and st are spanned by."""
    return np.array([[1, r, s, r * s, s * s, 0, 0, 0, 0, 0, r * (1 - s * s)],
                     [0, 0, 0, 0, 0, 1, r, s, r * s, r * r, s * (1 - r * r)]])  # fmt: skip


def _shear_weights() -> NDArray[np.float64]:
    """(11, 26) amounts of these functions that give the same edge strains, means and moment as the tied strains."""
    means = WEIGHT / 4.0
    moments = [_INNER[:, k] * (1.0 - _INNER[:, 1 - k] ** 2) * means for k in (0, 1)]
    given = np.zeros((11, 26))
    given[0, :9], given[1, 13:22] = means, means
    given[2, :9], given[2, 13:22] = moments
    given[3:7, 9:13], given[7:11, 22:26] = np.eye(4), np.eye(4)
    spanned = np.array([_shear_functions(*_PLACES[PLACE[p]])[0 if p < RT else 1] for p in range(PLANE, TIED)])
    return np.ascontiguousarray(np.linalg.solve(given @ spanned, given))


SHEAR = _shear_weights()


@kernel
def shape_at(r, s, values, by_r, by_s):
    for i in range(9):
        a, by_a = _line(r, NODE_R[i])
        b, by_b = _line(s, NODE_S[i])
        values[i] = a * b
        by_r[i] = by_a * b
        by_s[i] = a * by_b


@kernel
def _line(x, at):
    """The quadratic that is 1 at -1, 0 or 1, and its slope."""
    if at == 0.0:
        return 1.0 - x * x, -2.0 * x
    return 0.5 * x * (x + at), x + 0.5 * at


@kernel
def own_weights(x, d, base):
    """Of an element, by its first shape: (4, 9) amounts of 1, r, s, rs in rs by the strains at the nine points, and
    (2, 3, 10) amounts of 1 - s^2 in rr (1 - r^2 in ss) on the three Gauss lines by the tied ones."""
    square, right = np.zeros((4, 4)), np.empty((4, 9))
    cross, area = np.empty(3), np.empty((3, 3))
    for p in range(9):
        base_at(VALUES[12 + p], BY_R[12 + p], BY_S[12 + p], x, d, base)
        cross[:] = 0.0
        cross_into(base[0], base[1], 1.0, cross)
        area[p // 3, p % 3] = np.sqrt(dot(cross, cross))
        own = WEIGHT[p] / area[p // 3, p % 3]
        for i in range(4):
            right[i, p] = own * BILINEAR[p, i]
            for j in range(4):
                square[i, j] += right[i, p] * BILINEAR[p, j]
    means = np.zeros((2, 3, 10))
    for c in range(2):
        for g in range(3):
            high, low = 0.5 * (1.0 + GAUSS[g] / TWO), 0.5 * (1.0 - GAUSS[g] / TWO)
            total = 0.0
            for k in range(3):
                y = GAUSS[k]
                own = LINE_WEIGHT[k] / (area[k, g] if c == 0 else area[g, k])
                total += own * (1.0 - y * y)
                for m in range(2):
                    side = own * (low if m == 0 else high)
                    means[c, g, m] -= 0.5 * (1.0 - y) * side
                    means[c, g, 2 + m] -= 0.5 * (1.0 + y) * side
                    means[c, g, 4 + 2 * k + m] += side
            for p in range(10):
                means[c, g, p] /= total
    return np.linalg.solve(square, right), means


@kernel
def tied_weights(r, s, skew, means, weights):
    """What the tied strains give to their component at (r, s): weights (5, 26). skew, means: of `own_weights`."""
    for p in range(9):
        weights[2, p] = skew[0, p] + r * skew[1, p] + s * skew[2, p] + r * s * skew[3, p]
    for k in range(2):
        x, y = (r, s) if k == 0 else (s, r)  # along the strain, across
        z = x / THREE
        for p in range(10):
            inner = 0.5 * z * (z - 1.0) * means[k, 0, p] + (1.0 - z * z) * means[k, 1, p]
            weights[k, p] = (1.0 - y * y) * (inner + 0.5 * z * (z + 1.0) * means[k, 2, p])
        for m in range(2):
            side = 0.5 * (1.0 - x / TWO) if m == 0 else 0.5 * (1.0 + x / TWO)
            weights[k, m] += 0.5 * (1.0 - y) * side
            weights[k, 2 + m] += 0.5 * (1.0 + y) * side
    along_r = (1.0, r, s, r * s, s * s)
    along_s = (1.0, r, s, r * s, r * r)
    for p in range(26):
        weights[3, p] = r * (1.0 - s * s) * SHEAR[10, p]
        weights[4, p] = s * (1.0 - r * r) * SHEAR[10, p]
        for m in range(5):
            weights[3, p] += along_r[m] * SHEAR[m, p]
            weights[4, p] += along_s[m] * SHEAR[5 + m, p]


@kernel
def tied_strains(y, d, metric, rows, base):
    """Half-metrics (3, 55) and their rows (3, 55, 6, 9) at the tying points, by powers 0, 1, 2 of t."""
    rows[:] = 0.0
    metric[:] = 0.0
    cross = np.empty(3)
    for p in range(TIED):
        at = PLACE[p]
        values, by_r, by_s = VALUES[at], BY_R[at], BY_S[at]
        base_at(values, by_r, by_s, y, d, base)
        if p < PLANE:
            a = 0 if p < RR or p >= SS else 1
            b = 0 if p < RR else 1
            metric[0, p] = 0.5 * dot(base[a], base[b])
            metric[1, p] = 0.5 * (dot(base[a], base[2 + b]) + dot(base[2 + a], base[b]))
            metric[2, p] = 0.5 * dot(base[2 + a], base[2 + b])
            for i in range(9):
                na = by_r[i] if a == 0 else by_s[i]
                nb = by_r[i] if b == 0 else by_s[i]
                for m in range(3):
                    rows[0, p, m, i] = 0.5 * (na * base[b, m] + nb * base[a, m])
                    rows[1, p, m, i] = 0.5 * (na * base[2 + b, m] + nb * base[2 + a, m])
                for j in range(2):
                    cross[:] = 0.0
                    cross_into(d[i], base[2 * j + a], 0.5 * nb, cross)
                    cross_into(d[i], base[2 * j + b], 0.5 * na, cross)
                    for m in range(3):
                        rows[1 + j, p, 3 + m, i] = cross[m]
        else:
            a = 0 if p < RT else 1
            metric[0, p] = 0.5 * dot(base[a], base[4])
            for i in range(9):
                na = by_r[i] if a == 0 else by_s[i]
                cross[:] = 0.0
                cross_into(d[i], base[a], 0.5 * values[i], cross)
                for m in range(3):
                    rows[0, p, m, i] = 0.5 * na * base[4, m]
                    rows[0, p, 3 + m, i] = cross[m]


@kernel
def of_step(rows, step, change):
    """Changes (3, 55) of the tied strains by a small motion (9, 6)."""
    for j in range(3):
        for p in range(TIED):
            total = 0.0
            for c in range(6):
                for i in range(9):
                    total += rows[j, p, c, i] * step[i, c]
            change[j, p] = total


@kernel
def strains_at(t, weights, tied, out):
    """Covariant strains (5,) at a point of the tied ones (3, 55)."""
    for k in range(5):
        total = 0.0
        for m in range(COUNT[k]):
            p = FIRST[k] + m
            total += weights[k, m] * (tied[0, p] + t * (tied[1, p] + t * tied[2, p]))
        out[k] = total


@kernel
def blend(weights, tied, out):
    """Rows (3, 5, 6, 9) in the plane's point of the tied ones, by powers of t."""
    out[:] = 0.0
    for k in range(5):
        for j in range(3 if k < 3 else 1):
            for m in range(COUNT[k]):
                factor = weights[k, m]
                own = tied[j, FIRST[k] + m]
                for c in range(6):
                    for i in range(9):
                        out[j, k, c, i] += factor * own[c, i]
