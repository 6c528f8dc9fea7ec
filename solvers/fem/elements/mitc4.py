"""The four-node shell MITC4+ at one point: assumed strains, local frames, drilling.

Transverse shear by Dvorkin & Bathe 1984, membrane strains by Ko, Lee & Bathe 2017 (Comput. Struct. 182, eq. 27), the
drilling rotation tied to the membrane's by Hughes & Brezzi 1989, and four enhanced membrane strains (Simo & Rifai 1990)
where asked. Nodes are at (r, s) = (-1,-1) (1,-1) (1,1) (-1,1); u = N_i (u_i + t h_i/2 theta_i x V_i). With finite
rotations strains are Green's (half-metrics against those of the first shape), nodes turn by R_i and v_i = R_i V_i.

Covariant strains are tensor components rr ss rs rt st; those in the local frame of a point are 11 22 12 23 31, whose
shears across the thickness carry the square root of the shear factor, so that the laws see it on both sides alike.
"""

from __future__ import annotations

import numpy as np

from ...jit import kernel

# tying points (r, s) and what is tied there: membrane rr rr ss ss rs, then rt rt st st
TIED_R = np.array([0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0])
TIED_S = np.array([1.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0])
CORNER_R = np.array([-1.0, 1.0, 1.0, -1.0])
CORNER_S = np.array([-1.0, -1.0, 1.0, 1.0])
MODES = 4


@kernel
def shape_at(r, s, values, by_r, by_s):
    for i in range(4):
        values[i] = 0.25 * (1.0 + CORNER_R[i] * r) * (1.0 + CORNER_S[i] * s)
        by_r[i] = 0.25 * CORNER_R[i] * (1.0 + CORNER_S[i] * s)
        by_s[i] = 0.25 * CORNER_S[i] * (1.0 + CORNER_R[i] * r)


@kernel
def base_at(values, by_r, by_s, y, d, base):
    """base (5, 3): mid-surface y_r, y_s, their slopes along t, and y_t. d: (n, 3) half-thickness directors."""
    for m in range(3):
        a = b = c = e = f = 0.0
        for i in range(len(values)):
            a += by_r[i] * y[i, m]
            b += by_s[i] * y[i, m]
            c += by_r[i] * d[i, m]
            e += by_s[i] * d[i, m]
            f += values[i] * d[i, m]
        base[0, m] = a
        base[1, m] = b
        base[2, m] = c
        base[3, m] = e
        base[4, m] = f


@kernel
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross_into(a, b, scale, out):
    out[0] += scale * (a[1] * b[2] - a[2] * b[1])
    out[1] += scale * (a[2] * b[0] - a[0] * b[2])
    out[2] += scale * (a[0] * b[1] - a[1] * b[0])


@kernel
def tied_strains(y, d, metric, rows, work):
    """Half-metrics (9,) and their rows (9, 6, 4) at the tying points, t = 0. work: (5, 3), (3, 4), (3,) scratch."""
    base, functions, cross = work
    values, by_r, by_s = functions[0], functions[1], functions[2]
    for p in range(9):
        shape_at(TIED_R[p], TIED_S[p], values, by_r, by_s)
        base_at(values, by_r, by_s, y, d, base)
        for c in range(6):
            for i in range(4):
                rows[p, c, i] = 0.0
        if p < 5:
            a = 0 if p < 2 or p == 4 else 1
            b = 0 if p < 2 else 1
            metric[p] = 0.5 * dot(base[a], base[b])
            for i in range(4):
                na = by_r[i] if a == 0 else by_s[i]
                nb = by_r[i] if b == 0 else by_s[i]
                for m in range(3):
                    rows[p, m, i] = 0.5 * (na * base[b, m] + nb * base[a, m])
        else:
            a = 0 if p < 7 else 1
            metric[p] = 0.5 * dot(base[a], base[4])
            for i in range(4):
                na = by_r[i] if a == 0 else by_s[i]
                cross[:] = 0.0
                cross_into(d[i], base[a], 0.5 * values[i], cross)
                for m in range(3):
                    rows[p, m, i] = 0.5 * na * base[4, m]
                    rows[p, 3 + m, i] = cross[m]


@kernel
def tied_weights(x, r, s, weights):
    """What the tied membrane strains A B C D E give to rr, ss, rs at (r, s): weights (3, 5). 1, or 0 where the shape
    is not convex."""
    xr, xs, xd = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(4):
        for m in range(3):
            xr[m] += 0.25 * CORNER_R[i] * x[i, m]
            xs[m] += 0.25 * CORNER_S[i] * x[i, m]
            xd[m] += 0.25 * CORNER_R[i] * CORNER_S[i] * x[i, m]
    n = np.zeros(3)
    cross_into(xr, xs, 1.0, n)
    area = np.sqrt(dot(n, n))
    for m in range(3):
        n[m] /= area
    mr, ms = np.zeros(3), np.zeros(3)
    cross_into(xs, n, 1.0 / area, mr)
    cross_into(n, xr, 1.0 / area, ms)
    cr, cs = dot(xd, mr), dot(xd, ms)
    den = cr * cr + cs * cs - 1.0
    if not den < -1e-6:
        return 0
    a = cr * (cr - 1.0) / (2.0 * den)
    b = cr * (cr + 1.0) / (2.0 * den)
    c = cs * (cs - 1.0) / (2.0 * den)
    e = cs * (cs + 1.0) / (2.0 * den)
    f = 2.0 * cr * cs / den
    q = (a, b, c, e, f)
    for k in range(5):
        weights[0, k] = (s * s - 1.0) * q[k]
        weights[1, k] = (r * r - 1.0) * q[k]
        weights[2, k] = r * s * q[k]
    weights[0, 0] += 0.5 * (1.0 + s)
    weights[0, 1] += 0.5 * (1.0 - s)
    weights[1, 2] += 0.5 * (1.0 + r)
    weights[1, 3] += 0.5 * (1.0 - r)
    weights[2, 0] += 0.25 * r
    weights[2, 1] -= 0.25 * r
    weights[2, 2] += 0.25 * s
    weights[2, 3] -= 0.25 * s
    weights[2, 4] += 1.0
    return 1


@kernel
def frame_at(base, t, frame, dual, local):
    """Volume of the base at t, its dual vectors (3, 3) g^r g^s g^t, and the local frame (3, 3) e1 e2 e3."""
    gr, gs, gt = np.empty(3), np.empty(3), base[4]
    for m in range(3):
        gr[m] = base[0, m] + t * base[2, m]
        gs[m] = base[1, m] + t * base[3, m]
    dual[:] = 0.0
    cross_into(gs, gt, 1.0, dual[0])
    cross_into(gt, gr, 1.0, dual[1])
    cross_into(gr, gs, 1.0, dual[2])
    volume = dot(dual[2], gt)
    for k in range(3):
        for m in range(3):
            dual[k, m] /= volume
    length = np.sqrt(dot(gt, gt))
    frame[:] = 0.0
    for m in range(3):
        frame[2, m] = gt[m] / length
    cross_into(gs, frame[2], 1.0, frame[0])
    length = np.sqrt(dot(frame[0], frame[0]))
    for m in range(3):
        frame[0, m] /= length
    cross_into(frame[2], frame[0], 1.0, frame[1])
    for a in range(3):
        for k in range(3):
            local[a, k] = dot(frame[a], dual[k])
    return volume


@kernel
def to_local(local, root, change):
    """change (5, 5): local strains 11 22 12 23 31, shears as angles, from covariant rr ss rs rt st (tensor)."""
    for row in range(5):
        a = (0, 1, 0, 1, 2)[row]
        b = (0, 1, 1, 2, 0)[row]
        f = 1.0 if row < 2 else 2.0
        if row > 2:
            f *= root
        change[row, 0] = f * local[a, 0] * local[b, 0]
        change[row, 1] = f * local[a, 1] * local[b, 1]
        change[row, 2] = f * (local[a, 0] * local[b, 1] + local[a, 1] * local[b, 0])
        change[row, 3] = f * (local[a, 0] * local[b, 2] + local[a, 2] * local[b, 0])
        change[row, 4] = f * (local[a, 1] * local[b, 2] + local[a, 2] * local[b, 1])


@kernel
def covariant_rows(r, s, t, weights, tied, base, values, by_r, by_s, d, rows, work):
    """Covariant rows (5, 6, 4) at a point from the tied ones, and what bending adds along t."""
    for k in range(3):
        for c in range(6):
            for i in range(4):
                total = 0.0
                if c < 3:
                    for p in range(5):
                        total += weights[k, p] * tied[p, c, i]
                rows[k, c, i] = total
    for c in range(6):
        for i in range(4):
            rows[3, c, i] = 0.5 * ((1.0 + s) * tied[5, c, i] + (1.0 - s) * tied[6, c, i])
            rows[4, c, i] = 0.5 * ((1.0 + r) * tied[7, c, i] + (1.0 - r) * tied[8, c, i])
    ga, gb = work[0], work[1]
    for k in range(3):
        a = (0, 1, 0)[k]
        b = (0, 1, 1)[k]
        for m in range(3):  # at t, for the turning part
            ga[m] = base[a, m] + t * base[2 + a, m]
            gb[m] = base[b, m] + t * base[2 + b, m]
        for i in range(4):
            na = by_r[i] if a == 0 else by_s[i]
            nb = by_r[i] if b == 0 else by_s[i]
            cross = work[2]
            cross[:] = 0.0
            cross_into(d[i], ga, 0.5 * t * nb, cross)
            cross_into(d[i], gb, 0.5 * t * na, cross)
            for m in range(3):
                rows[k, m, i] += 0.5 * t * (na * base[2 + b, m] + nb * base[2 + a, m])
                rows[k, 3 + m, i] += cross[m]


@kernel
def half_metrics(r, s, t, weights, metric, base, out):
    """Covariant half-metrics (5,) at a point."""
    for k in range(3):
        a = (0, 1, 0)[k]
        b = (0, 1, 1)[k]
        total = 0.0
        for p in range(5):
            total += weights[k, p] * metric[p]
        bend = dot(base[a], base[2 + b]) + dot(base[2 + a], base[b])
        out[k] = total + 0.5 * t * bend + 0.5 * t * t * dot(base[2 + a], base[2 + b])
    out[3] = 0.5 * ((1.0 + s) * metric[5] + (1.0 - s) * metric[6])
    out[4] = 0.5 * ((1.0 + r) * metric[7] + (1.0 - r) * metric[8])


@kernel
def enhanced_rows(x, d, r, s, volume, frame, root, extra, scratch):
    """Enhanced rows (5, 4), mapped by the base at the element's centre."""
    values, by_r, by_s, base, local, change, own_frame, dual = scratch
    shape_at(0.0, 0.0, values, by_r, by_s)
    base_at(values, by_r, by_s, x, d, base)
    at_centre = frame_at(base, 0.0, own_frame, dual, local)
    for a in range(3):
        for k in range(3):
            local[a, k] = dot(frame[a], dual[k])
    to_local(local, root, change)
    scale = at_centre / volume
    for row in range(5):
        extra[row, 0] = scale * change[row, 0] * r
        extra[row, 1] = scale * change[row, 1] * s
        extra[row, 2] = scale * change[row, 2] * r
        extra[row, 3] = scale * change[row, 2] * s


@kernel
def drilling(values, by_r, by_s, base, d, frame, turns, local, rows):
    """Drilling value and its rows (6, n) at t = 0: the membrane's turn less the nodes' (total Lagrangian).

    base, d: now; frame, local: of the first shape; turns: (n, 3, 3) of the nodes.
    """
    n = len(values)
    d1, d2, y1, y2 = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    own1, own2, push, cross = np.empty((n, 3)), np.empty((n, 3)), np.empty(3), np.empty(3)
    for i in range(n):
        for m in range(3):
            own1[i, m] = dot(turns[i, m], frame[0])
            own2[i, m] = dot(turns[i, m], frame[1])
            d1[m] += values[i] * own1[i, m]
            d2[m] += values[i] * own2[i, m]
    for m in range(3):
        y1[m] = local[0, 0] * base[0, m] + local[0, 1] * base[1, m] + local[0, 2] * base[4, m]
        y2[m] = local[1, 0] * base[0, m] + local[1, 1] * base[1, m] + local[1, 2] * base[4, m]
    for m in range(3):
        push[m] = local[0, 2] * d2[m] - local[1, 2] * d1[m]
    for i in range(n):
        n1 = local[0, 0] * by_r[i] + local[0, 1] * by_s[i]
        n2 = local[1, 0] * by_r[i] + local[1, 1] * by_s[i]
        cross[:] = 0.0
        cross_into(own2[i], y1, 0.5 * values[i], cross)
        cross_into(own1[i], y2, -0.5 * values[i], cross)
        cross_into(d[i], push, 0.5 * values[i], cross)
        for m in range(3):
            rows[m, i] = 0.5 * (n1 * d2[m] - n2 * d1[m])
            rows[3 + m, i] = cross[m]
    return 0.5 * (dot(y1, d2) - dot(y2, d1))
