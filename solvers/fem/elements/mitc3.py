"""The three-node shell MITC3+ (Lee, Lee & Bathe 2014) at one point; what it shares with four nodes is in `mitc4`.

Membrane strains are constant. A cubic bubble of rotation, condensed out of each element, and transverse shear strains
tied at six points keep it from locking. Natural coordinates: nodes at (0, 0), (1, 0), (0, 1).
"""

from __future__ import annotations

import numpy as np

from ...jit import kernel
from .mitc4 import cross_into, dot, frame_at

_D = 1e-4
# where shear is tied (r, s): A B C, then D E F next to the centre
TIED_R = np.array([1 / 6, 2 / 3, 1 / 6, 1 / 3 + _D, 1 / 3 - 2 * _D, 1 / 3 + _D])
TIED_S = np.array([2 / 3, 1 / 6, 1 / 6, 1 / 3 - 2 * _D, 1 / 3 + _D, 1 / 3 + _D])
BY_R = np.array([-1.0, 1.0, 0.0])
BY_S = np.array([-1.0, 0.0, 1.0])
MODES = 2


@kernel
def shear_weights(r, s, weights):
    """What the tied e_rt, e_st at the six points give to e_rt and e_st at (r, s): weights (2, 6, 2)."""
    weights[:] = 0.0
    bend = (3.0 * s - 1.0) / 3.0, (1.0 - 3.0 * r) / 3.0
    weights[0, 1, 0] = 2.0 / 3.0
    weights[0, 1, 1] = -1.0 / 3.0
    weights[1, 0, 1] = 2.0 / 3.0
    weights[1, 0, 0] = -1.0 / 3.0
    for k in range(2):
        weights[k, 2, 0] = 1.0 / 3.0
        weights[k, 2, 1] = 1.0 / 3.0
        weights[k, 5, 0] += bend[k]
        weights[k, 3, 0] -= bend[k]
        weights[k, 5, 1] -= bend[k]
        weights[k, 4, 1] += bend[k]


@kernel
def base_at(r, s, y, d, base):
    """base (5, 3): y_r, y_s, their slopes along t, and y_t; y, d: (3, 3) places and half-thickness directors."""
    for m in range(3):
        base[0, m] = y[1, m] - y[0, m]
        base[1, m] = y[2, m] - y[0, m]
        base[2, m] = d[1, m] - d[0, m]
        base[3, m] = d[2, m] - d[0, m]
        base[4, m] = (1.0 - r - s) * d[0, m] + r * d[1, m] + s * d[2, m]


@kernel
def bubble(r, s):
    """The bubble and its slopes along r and s."""
    t = 1.0 - r - s
    return 27.0 * r * s * t, 27.0 * s * (t - r), 27.0 * r * (t - s)


@kernel
def middle(d, turn, out):
    """Half-thickness director at the centre (3,), and two unit vectors across it (2, 3): the bubble's axes."""
    for m in range(3):
        out[m] = (d[0, m] + d[1, m] + d[2, m]) / 3.0
    k = 0
    for m in range(3):
        if abs(out[m]) < abs(out[k]):
            k = m
    turn[:] = 0.0
    axis = np.zeros(3)
    axis[k] = 1.0
    cross_into(out, axis, 1.0, turn[0])
    length = np.sqrt(dot(turn[0], turn[0]))
    for m in range(3):
        turn[0, m] /= length
    cross_into(out, turn[0], 1.0, turn[1])
    length = np.sqrt(dot(turn[1], turn[1]))
    for m in range(3):
        turn[1, m] /= length


@kernel
def tied_shears(y, d, metric, rows, base, cross):
    """Half-metrics (6, 2) and rows (6, 2, 6, 3) of e_rt, e_st at the tying points."""
    for p in range(6):
        r, s = TIED_R[p], TIED_S[p]
        base_at(r, s, y, d, base)
        values = (1.0 - r - s, r, s)
        for a in range(2):
            metric[p, a] = 0.5 * dot(base[a], base[4])
            for i in range(3):
                by = BY_R[i] if a == 0 else BY_S[i]
                cross[:] = 0.0
                cross_into(d[i], base[a], 0.5 * values[i], cross)
                for m in range(3):
                    rows[p, a, m, i] = 0.5 * by * base[4, m]
                    rows[p, a, 3 + m, i] = cross[m]


@kernel
def covariant_rows(t, weights, tied, base, d, rows, ga, gb, cross):
    """Covariant rows (5, 6, 3) rr ss rs rt st at a point of the layer t."""
    for k in range(3):
        a = (0, 1, 0)[k]
        b = (0, 1, 1)[k]
        for m in range(3):
            ga[m] = base[a, m] + t * base[2 + a, m]
            gb[m] = base[b, m] + t * base[2 + b, m]
        for i in range(3):
            na = BY_R[i] if a == 0 else BY_S[i]
            nb = BY_R[i] if b == 0 else BY_S[i]
            cross[:] = 0.0
            cross_into(d[i], ga, 0.5 * t * nb, cross)
            cross_into(d[i], gb, 0.5 * t * na, cross)
            for m in range(3):
                rows[k, m, i] = 0.5 * (na * gb[m] + nb * ga[m])
                rows[k, 3 + m, i] = cross[m]
    for k in range(2):
        for c in range(6):
            for i in range(3):
                total = 0.0
                for p in range(6):
                    for a in range(2):
                        total += weights[k, p, a] * tied[p, a, c, i]
                rows[3 + k, c, i] = total


@kernel
def half_metrics(t, weights, metric, base, out):
    """Covariant half-metrics (5,) at a point."""
    for k in range(3):
        a = (0, 1, 0)[k]
        b = (0, 1, 1)[k]
        bend = dot(base[a], base[2 + b]) + dot(base[2 + a], base[b])
        out[k] = 0.5 * (dot(base[a], base[b]) + t * bend + t * t * dot(base[2 + a], base[2 + b]))
    for k in range(2):
        total = 0.0
        for p in range(6):
            for a in range(2):
                total += weights[k, p, a] * metric[p, a]
        out[3 + k] = total


@kernel
def bubble_rows(r, s, t, weights, y, d, change, centre, axes, base, extra, cov, cross):
    """Local rows (5, 2) of the bubble's two rotations, at the first shape. change: covariant to local."""
    middle(d, axes, centre)
    _, by_r, by_s = bubble(r, s)
    base_at(r, s, y, d, base)
    for m in range(2):
        for k in range(3):
            a = (0, 1, 0)[k]
            b = (0, 1, 1)[k]
            na = by_r if a == 0 else by_s
            nb = by_r if b == 0 else by_s
            cross[:] = 0.0
            cross_into(axes[m], centre, 1.0, cross)
            total = 0.0
            for j in range(3):
                total += cross[j] * (nb * (base[a, j] + t * base[2 + a, j]) + na * (base[b, j] + t * base[2 + b, j]))
            cov[k] = 0.5 * t * total
        for k in range(2):
            total = 0.0
            for p in range(6):
                there, _, _ = bubble(TIED_R[p], TIED_S[p])
                for a in range(2):
                    if weights[k, p, a] != 0.0:
                        total += weights[k, p, a] * 0.5 * there * dot(cross, base[a])
            cov[3 + k] = total
        for row in range(5):
            extra[row, m] = 0.0
            for k in range(5):
                extra[row, m] += change[row, k] * cov[k]


@kernel
def drilling(r, s, base, d, frame, turns, local, rows, d1, d2, y1, y2, cross):
    """Drilling value and its rows (6, 3) at t = 0; as `mitc4.drilling`."""
    values = (1.0 - r - s, r, s)
    d1[:] = 0.0
    d2[:] = 0.0
    for i in range(3):
        for m in range(3):
            d1[m] += values[i] * dot(turns[i, m], frame[0])
            d2[m] += values[i] * dot(turns[i, m], frame[1])
    for m in range(3):
        y1[m] = local[0, 0] * base[0, m] + local[0, 1] * base[1, m] + local[0, 2] * base[4, m]
        y2[m] = local[1, 0] * base[0, m] + local[1, 1] * base[1, m] + local[1, 2] * base[4, m]
    push, own = np.empty(3), np.empty(3)
    for m in range(3):
        push[m] = local[0, 2] * d2[m] - local[1, 2] * d1[m]
    for i in range(3):
        n1 = local[0, 0] * BY_R[i] + local[0, 1] * BY_S[i]
        n2 = local[1, 0] * BY_R[i] + local[1, 1] * BY_S[i]
        cross[:] = 0.0
        for m in range(3):
            own[m] = dot(turns[i, m], frame[1])
        cross_into(own, y1, 0.5 * values[i], cross)
        for m in range(3):
            own[m] = dot(turns[i, m], frame[0])
        cross_into(own, y2, -0.5 * values[i], cross)
        cross_into(d[i], push, 0.5 * values[i], cross)
        for m in range(3):
            rows[m, i] = 0.5 * (n1 * d2[m] - n2 * d1[m])
            rows[3 + m, i] = cross[m]
    return 0.5 * (dot(y1, d2) - dot(y2, d1))


@kernel
def volume_at(r, s, t, y, d, base, frame, dual, local):
    """Volume at a point, and the frames of `mitc4.frame_at`."""
    base_at(r, s, y, d, base)
    return frame_at(base, t, frame, dual, local)
