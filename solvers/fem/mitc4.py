"""The four-node shell MITC4+: element loops for strains, stiffness and forces.

Transverse shear by Dvorkin & Bathe 1984, membrane strains by Ko, Lee & Bathe 2017 (Comput. Struct. 182, eq. 27), the
drilling rotation tied to the membrane's by Hughes & Brezzi 1989, and four enhanced membrane strains (Simo & Rifai 1990)
where asked. Nodes are at (r, s) = (-1,-1) (1,-1) (1,1) (-1,1); u = N_i (u_i + t h_i/2 theta_i x V_i). With finite
rotations strains are Green's (half-metrics against those of the first shape), nodes turn by R_i and v_i = R_i V_i.

Covariant strains are tensor components rr ss rs rt st; those in the local frame of a point are 11 22 12 23 31, whose
shears across the thickness carry the square root of the shear factor, so that the laws see it on both sides alike.
"""

from __future__ import annotations

import numpy as np

from ..jit import kernel
from .continuum import condense
from .shapes import functions, table

# tying points (r, s) and what is tied there: membrane rr rr ss ss rs, then rt rt st st
TIED_R = np.array([0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0])
TIED_S = np.array([1.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0])
CORNER_R = np.array([-1.0, 1.0, 1.0, -1.0])
CORNER_S = np.array([-1.0, -1.0, 1.0, 1.0])
MODES = 4


@kernel
def _shape(r, s, values, by_r, by_s):
    for i in range(4):
        values[i] = 0.25 * (1.0 + CORNER_R[i] * r) * (1.0 + CORNER_S[i] * s)
        by_r[i] = 0.25 * CORNER_R[i] * (1.0 + CORNER_S[i] * s)
        by_s[i] = 0.25 * CORNER_S[i] * (1.0 + CORNER_R[i] * r)


@kernel
def _base(values, by_r, by_s, y, d, base):
    """base (5, 3): mid-surface y_r, y_s, their slopes along t, and y_t. d: (4, 3) half-thickness directors."""
    for m in range(3):
        a = b = c = e = f = 0.0
        for i in range(4):
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
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def _cross_into(a, b, scale, out):
    out[0] += scale * (a[1] * b[2] - a[2] * b[1])
    out[1] += scale * (a[2] * b[0] - a[0] * b[2])
    out[2] += scale * (a[0] * b[1] - a[1] * b[0])


@kernel
def _tied(y, d, metric, rows, work):
    """Half-metrics (9,) and their rows (9, 6, 4) at the tying points, t = 0. work: (5, 3), (3, 4), (3,) scratch."""
    base, functions, cross = work
    values, by_r, by_s = functions[0], functions[1], functions[2]
    for p in range(9):
        _shape(TIED_R[p], TIED_S[p], values, by_r, by_s)
        _base(values, by_r, by_s, y, d, base)
        for c in range(6):
            for i in range(4):
                rows[p, c, i] = 0.0
        if p < 5:
            a = 0 if p < 2 or p == 4 else 1
            b = 0 if p < 2 else 1
            metric[p] = 0.5 * _dot(base[a], base[b])
            for i in range(4):
                na = by_r[i] if a == 0 else by_s[i]
                nb = by_r[i] if b == 0 else by_s[i]
                for m in range(3):
                    rows[p, m, i] = 0.5 * (na * base[b, m] + nb * base[a, m])
        else:
            a = 0 if p < 7 else 1
            metric[p] = 0.5 * _dot(base[a], base[4])
            for i in range(4):
                na = by_r[i] if a == 0 else by_s[i]
                cross[:] = 0.0
                _cross_into(d[i], base[a], 0.5 * values[i], cross)
                for m in range(3):
                    rows[p, m, i] = 0.5 * na * base[4, m]
                    rows[p, 3 + m, i] = cross[m]


@kernel
def _weights(x, r, s, weights):
    """What the tied membrane strains A B C D E give to rr, ss, rs at (r, s): weights (3, 5). 1, or 0 where the shape
    is not convex."""
    xr, xs, xd = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(4):
        for m in range(3):
            xr[m] += 0.25 * CORNER_R[i] * x[i, m]
            xs[m] += 0.25 * CORNER_S[i] * x[i, m]
            xd[m] += 0.25 * CORNER_R[i] * CORNER_S[i] * x[i, m]
    n = np.zeros(3)
    _cross_into(xr, xs, 1.0, n)
    area = np.sqrt(_dot(n, n))
    for m in range(3):
        n[m] /= area
    mr, ms = np.zeros(3), np.zeros(3)
    _cross_into(xs, n, 1.0 / area, mr)
    _cross_into(n, xr, 1.0 / area, ms)
    cr, cs = _dot(xd, mr), _dot(xd, ms)
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
def _frame(base, t, frame, dual, local):
    """Volume of the base at t, its dual vectors (3, 3) g^r g^s g^t, and the local frame (3, 3) e1 e2 e3."""
    gr, gs, gt = np.empty(3), np.empty(3), base[4]
    for m in range(3):
        gr[m] = base[0, m] + t * base[2, m]
        gs[m] = base[1, m] + t * base[3, m]
    dual[:] = 0.0
    _cross_into(gs, gt, 1.0, dual[0])
    _cross_into(gt, gr, 1.0, dual[1])
    _cross_into(gr, gs, 1.0, dual[2])
    volume = _dot(dual[2], gt)
    for k in range(3):
        for m in range(3):
            dual[k, m] /= volume
    length = np.sqrt(_dot(gt, gt))
    frame[:] = 0.0
    for m in range(3):
        frame[2, m] = gt[m] / length
    _cross_into(gs, frame[2], 1.0, frame[0])
    length = np.sqrt(_dot(frame[0], frame[0]))
    for m in range(3):
        frame[0, m] /= length
    _cross_into(frame[2], frame[0], 1.0, frame[1])
    for a in range(3):
        for k in range(3):
            local[a, k] = _dot(frame[a], dual[k])
    return volume


@kernel
def _to_local(local, root, change):
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
def _covariant(r, s, t, weights, tied, base, values, by_r, by_s, d, rows, work):
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
            _cross_into(d[i], ga, 0.5 * t * nb, cross)
            _cross_into(d[i], gb, 0.5 * t * na, cross)
            for m in range(3):
                rows[k, m, i] += 0.5 * t * (na * base[2 + b, m] + nb * base[2 + a, m])
                rows[k, 3 + m, i] += cross[m]


@kernel
def _metrics(r, s, t, weights, metric, base, out):
    """Covariant half-metrics (5,) at a point."""
    for k in range(3):
        a = (0, 1, 0)[k]
        b = (0, 1, 1)[k]
        total = 0.0
        for p in range(5):
            total += weights[k, p] * metric[p]
        bend = _dot(base[a], base[2 + b]) + _dot(base[2 + a], base[b])
        out[k] = total + 0.5 * t * bend + 0.5 * t * t * _dot(base[2 + a], base[2 + b])
    out[3] = 0.5 * ((1.0 + s) * metric[5] + (1.0 - s) * metric[6])
    out[4] = 0.5 * ((1.0 + r) * metric[7] + (1.0 - r) * metric[8])


@kernel
def _enhanced(x, d, r, s, volume, frame, root, extra, scratch):
    """Enhanced rows (5, 4), mapped by the base at the element's centre."""
    values, by_r, by_s, base, local, change, own_frame, dual = scratch
    _shape(0.0, 0.0, values, by_r, by_s)
    _base(values, by_r, by_s, x, d, base)
    at_centre = _frame(base, 0.0, own_frame, dual, local)
    for a in range(3):
        for k in range(3):
            local[a, k] = _dot(frame[a], dual[k])
    _to_local(local, root, change)
    scale = at_centre / volume
    for row in range(5):
        extra[row, 0] = scale * change[row, 0] * r
        extra[row, 1] = scale * change[row, 1] * s
        extra[row, 2] = scale * change[row, 2] * r
        extra[row, 3] = scale * change[row, 2] * s


@kernel
def _drill(values, by_r, by_s, base, d, frame, turns, local, rows):
    """Drilling value and its rows (6, 4) at t = 0: the membrane's turn less the nodes' (total Lagrangian).

    base, d: now; frame, local: of the first shape; turns: (4, 3, 3) of the nodes.
    """
    d1, d2, y1, y2 = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    own1, own2, push, cross = np.empty((4, 3)), np.empty((4, 3)), np.empty(3), np.empty(3)
    for i in range(4):
        for m in range(3):
            own1[i, m] = _dot(turns[i, m], frame[0])
            own2[i, m] = _dot(turns[i, m], frame[1])
            d1[m] += values[i] * own1[i, m]
            d2[m] += values[i] * own2[i, m]
    for m in range(3):
        y1[m] = local[0, 0] * base[0, m] + local[0, 1] * base[1, m] + local[0, 2] * base[4, m]
        y2[m] = local[1, 0] * base[0, m] + local[1, 1] * base[1, m] + local[1, 2] * base[4, m]
    for m in range(3):
        push[m] = local[0, 2] * d2[m] - local[1, 2] * d1[m]
    for i in range(4):
        n1 = local[0, 0] * by_r[i] + local[0, 1] * by_s[i]
        n2 = local[1, 0] * by_r[i] + local[1, 1] * by_s[i]
        cross[:] = 0.0
        _cross_into(own2[i], y1, 0.5 * values[i], cross)
        _cross_into(own1[i], y2, -0.5 * values[i], cross)
        _cross_into(d[i], push, 0.5 * values[i], cross)
        for m in range(3):
            rows[m, i] = 0.5 * (n1 * d2[m] - n2 * d1[m])
            rows[3 + m, i] = cross[m]
    return 0.5 * (_dot(y1, d2) - _dot(y2, d1))


@kernel
def _gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite):
    """One element: first shape (4, 3) and half-thickness directors, those now, displacement (4, 6), nodes' turns."""
    for i in range(4):
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


@kernel
def strains(
    nodes, x, u, before, turn, directors, half, points, layers, root, finite, modes, alpha, alpha_before, committed,
    strain, convex,
):  # fmt: skip
    """Strain increments (e 4 l, 6) 11 22 33 12 23 31, tensor components of the local frames, since the last state.

    x: (N, 3); u, before: (N, 6); turn: (N, 3, 3); directors: (e, 4, 3); half: (e, 4) half thickness; points: (4, 2) in
    the plane; layers: (l,) along t; root: of the shear factor; finite: True with finite rotation, None; committed: (e 4
    l, 6) strain so far; convex: (e,) set False for an element that is not.
    """
    reference, thick, now, corner = np.empty((4, 3)), np.empty((4, 3)), np.empty((4, 3)), np.empty((4, 3))
    moved, turns, step = np.empty((4, 6)), np.empty((4, 3, 3)), np.empty((4, 6))
    values, by_r, by_s = np.empty(4), np.empty(4), np.empty(4)
    base, base_now, other = np.empty((5, 3)), np.empty((5, 3)), np.empty((5, 3))
    work = (np.empty((5, 3)), np.empty((3, 4)), np.empty(3))
    scratch = (np.empty(4), np.empty(4), np.empty(4), other, np.empty((3, 3)), np.empty((5, 5)), np.empty((3, 3)),
               np.empty((3, 3)))  # fmt: skip
    tied, metric, metric_now = np.empty((9, 6, 4)), np.empty(9), np.empty(9)
    weights, rows, cov, first = np.empty((3, 5)), np.empty((5, 6, 4)), np.empty(5), np.empty(5)
    frame, dual, local, change = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 5))
    extra, vectors = np.empty((5, 4)), np.empty((3, 3))
    many = len(points) * len(layers)
    for q in range(nodes.shape[0]):
        _gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        for i in range(4):
            for c in range(6):
                step[i, c] = u[nodes[q, i], c] - before[nodes[q, i], c]
        _tied(reference, thick, metric, tied, work)
        if finite is not None:
            _tied(now, corner, metric_now, tied, work)
        convex[q] = True
        for g in range(len(points)):
            r, s = points[g, 0], points[g, 1]
            if not _weights(reference, r, s, weights):
                convex[q] = False
                break
            _shape(r, s, values, by_r, by_s)
            _base(values, by_r, by_s, reference, thick, base)
            if finite is not None:
                _base(values, by_r, by_s, now, corner, base_now)
            for l in range(len(layers)):
                t = layers[l]
                volume = _frame(base, t, frame, dual, local)
                _to_local(local, root, change)
                at = q * many + g * len(layers) + l
                if finite is not None:
                    _metrics(r, s, t, weights, metric_now, base_now, cov)
                    _metrics(r, s, t, weights, metric, base, first)
                    for k in range(5):
                        cov[k] -= first[k]
                else:
                    _covariant(r, s, t, weights, tied, base, values, by_r, by_s, thick, rows, vectors)
                    for k in range(5):
                        cov[k] = 0.0
                        for c in range(6):
                            for i in range(4):
                                cov[k] += rows[k, c, i] * step[i, c]
                if modes is not None:
                    _enhanced(reference, thick, r, s, volume, frame, root, extra, scratch)
                for row in range(5):
                    total = 0.0
                    for k in range(5):
                        total += change[row, k] * cov[k]
                    if modes is not None:
                        for m in range(4):
                            gone = alpha_before[q, m] if finite is None else 0.0
                            total += extra[row, m] * (alpha[q, m] - gone)
                    place = row if row < 2 else row + 1
                    value = total if row < 2 else 0.5 * total
                    strain[at, place] = value - (committed[at, place] if finite is not None else 0.0)
                strain[at, 2] = 0.0


@kernel
def integrate(
    nodes, x, u, turn, directors, half, points, point_weights, layers, layer_weights, root, drill, finite, modes, stress,
    modulus, matrix, forces, answer, rest,
):  # fmt: skip
    """Forces (e, 6, 4) of the stresses, and the stiffness (e, 6, 6, 4, 4) or None; see `strains`.

    drill: (e,) penalty of the drilling rotation per area; answer, rest: of the enhanced strains, see `continuum`.
    """
    reference, thick, now, corner = np.empty((4, 3)), np.empty((4, 3)), np.empty((4, 3)), np.empty((4, 3))
    moved, turns = np.empty((4, 6)), np.empty((4, 3, 3))
    values, by_r, by_s = np.empty(4), np.empty(4), np.empty(4)
    base, base_now, other = np.empty((5, 3)), np.empty((5, 3)), np.empty((5, 3))
    work = (np.empty((5, 3)), np.empty((3, 4)), np.empty(3))
    scratch = (np.empty(4), np.empty(4), np.empty(4), other, np.empty((3, 3)), np.empty((5, 5)), np.empty((3, 3)),
               np.empty((3, 3)))  # fmt: skip
    tied, metric = np.empty((9, 6, 4)), np.empty(9)
    weights, cov, rows = np.empty((3, 5)), np.empty((5, 6, 4)), np.empty((5, 6, 4))
    stiff, vectors, drilling = np.empty((5, 6, 4)), np.empty((3, 3)), np.empty((6, 4))
    frame, dual, local, change = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 5))
    extra, stiff_extra = np.empty((5, 4)), np.empty((5, 4))
    inner, residual = np.empty((4, 4)), np.empty(4)
    mixed, back = np.empty((4, 6, 4)), np.empty((4, 6, 4))
    pulled, tension = np.empty(9), np.empty(5)
    many = len(points) * len(layers)
    place = (0, 1, 3, 4, 5)
    for q in range(nodes.shape[0]):
        _gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        _tied(now, corner, metric, tied, work)
        forces[q] = 0.0
        pulled[:] = 0.0
        if matrix is not None:
            matrix[q] = 0.0
        if modes is not None:
            inner[:] = 0.0
            residual[:] = 0.0
            mixed[:] = 0.0
            back[:] = 0.0
        for g in range(len(points)):
            r, s = points[g, 0], points[g, 1]
            _weights(reference, r, s, weights)
            _shape(r, s, values, by_r, by_s)
            _base(values, by_r, by_s, reference, thick, base)
            _base(values, by_r, by_s, now, corner, base_now)
            for l in range(len(layers)):
                t = layers[l]
                volume = _frame(base, t, frame, dual, local)
                dv = volume * point_weights[g] * layer_weights[l]
                _to_local(local, root, change)
                _covariant(r, s, t, weights, tied, base_now, values, by_r, by_s, corner, cov, vectors)
                for row in range(5):
                    for c in range(6):
                        for i in range(4):
                            rows[row, c, i] = 0.0
                    for k in range(5):
                        factor = change[row, k]
                        for c in range(6):
                            for i in range(4):
                                rows[row, c, i] += factor * cov[k, c, i]
                at = q * many + g * len(layers) + l
                for row in range(5):
                    factor = dv * stress[at, place[row]]
                    for c in range(6):
                        for i in range(4):
                            forces[q, c, i] += factor * rows[row, c, i]
                if modes is not None:
                    _enhanced(reference, thick, r, s, volume, frame, root, extra, scratch)
                    for m in range(4):
                        for row in range(5):
                            residual[m] += dv * extra[row, m] * stress[at, place[row]]
                if matrix is None:
                    continue
                for row in range(5):
                    for c in range(6):
                        for i in range(4):
                            stiff[row, c, i] = 0.0
                    for o in range(5):
                        factor = dv * modulus[at, place[row], place[o]]
                        for c in range(6):
                            for i in range(4):
                                stiff[row, c, i] += factor * rows[o, c, i]
                for c in range(6):
                    for e in range(6):
                        for i in range(4):
                            for row in range(5):
                                factor = rows[row, c, i]
                                for j in range(4):
                                    matrix[q, c, e, i, j] += factor * stiff[row, e, j]
                if modes is not None:
                    for row in range(5):
                        for m in range(4):
                            total = 0.0
                            for o in range(5):
                                total += modulus[at, place[row], place[o]] * extra[o, m]
                            stiff_extra[row, m] = dv * total
                    for m in range(4):
                        for o in range(4):
                            for row in range(5):
                                inner[m, o] += extra[row, m] * stiff_extra[row, o]
                        for c in range(6):
                            for row in range(5):
                                for i in range(4):
                                    mixed[m, c, i] += extra[row, m] * stiff[row, c, i]
                                    back[m, c, i] += rows[row, c, i] * stiff_extra[row, m]
                if finite is not None:
                    for k in range(5):
                        tension[k] = 0.0
                        for row in range(5):
                            tension[k] += dv * change[row, k] * stress[at, place[row]]
                    for k in range(3):
                        for p in range(5):
                            pulled[p] += weights[k, p] * tension[k]
                    pulled[5] += 0.5 * (1.0 + s) * tension[3]
                    pulled[6] += 0.5 * (1.0 - s) * tension[3]
                    pulled[7] += 0.5 * (1.0 + r) * tension[4]
                    pulled[8] += 0.5 * (1.0 - r) * tension[4]
                    _bending_geometry(t, tension, base_now, by_r, by_s, corner, matrix, q)
            _frame(base, 0.0, frame, dual, local)
            value = _drill(values, by_r, by_s, base_now, corner, frame, turns, local, drilling)
            if finite is None:
                value = 0.0
                for c in range(6):
                    for i in range(4):
                        value += drilling[c, i] * moved[i, c]
            area = _area(base) * point_weights[g] * drill[q]
            for c in range(6):
                for i in range(4):
                    forces[q, c, i] += area * value * drilling[c, i]
                    if matrix is not None:
                        for e in range(6):
                            for j in range(4):
                                matrix[q, c, e, i, j] += area * drilling[c, i] * drilling[e, j]
        if finite is not None and matrix is not None:
            _tied_geometry(pulled, now, corner, values, by_r, by_s, base, matrix, q)
        if modes is not None and matrix is not None:
            condense(inner, residual, mixed, back, 4, 6, 4, q, matrix, forces, answer, rest)
        elif modes is not None:
            for c in range(6):
                for i in range(4):
                    for m in range(4):
                        forces[q, c, i] -= answer[q, m, c, i] * residual[m]


@kernel
def _area(base):
    cross = np.zeros(3)
    _cross_into(base[0], base[1], 1.0, cross)
    return np.sqrt(_dot(cross, cross))


@kernel
def _of_turn(d, p, scale, i, matrix, q):
    """Second variation of p . d under turns of node i, symmetric: theta-theta block."""
    along = _dot(p, d)
    for m in range(3):
        for n in range(3):
            value = 0.5 * (p[m] * d[n] + d[m] * p[n]) - (along if m == n else 0.0)
            matrix[q, 3 + m, 3 + n, i, i] += scale * value


@kernel
def _of_shift_and_turn(d, scale, i, j, matrix, q):
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
def _tied_geometry(pulled, y, d, values, by_r, by_s, base, matrix, q):
    """Stiffness of the stresses through the strains at the tying points."""
    for p in range(9):
        if pulled[p] == 0.0:
            continue
        _shape(TIED_R[p], TIED_S[p], values, by_r, by_s)
        _base(values, by_r, by_s, y, d, base)
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
                    _of_shift_and_turn(d[j], 0.5 * pulled[p] * na * values[j], i, j, matrix, q)
                _of_turn(d[j], base[a], 0.5 * pulled[p] * values[j], j, matrix, q)


@kernel
def _bending_geometry(t, tension, base, by_r, by_s, d, matrix, q):
    """Stiffness of the stresses through the strains that grow along t."""
    push = np.empty(3)
    for k in range(3):
        a = (0, 1, 0)[k]
        b = (0, 1, 1)[k]
        pull = tension[k]
        for i in range(4):
            ia = by_r[i] if a == 0 else by_s[i]
            ib = by_r[i] if b == 0 else by_s[i]
            for m in range(3):
                push[m] = ib * (base[a, m] + t * base[2 + a, m]) + ia * (base[b, m] + t * base[2 + b, m])
            _of_turn(d[i], push, 0.5 * t * pull, i, matrix, q)
            for j in range(4):
                ja = by_r[j] if a == 0 else by_s[j]
                jb = by_r[j] if b == 0 else by_s[j]
                both = 0.5 * (ia * jb + ib * ja)
                _of_shift_and_turn(d[j], t * pull * both, i, j, matrix, q)
                along = _dot(d[i], d[j])
                scale = t * t * pull * both
                for m in range(3):
                    for n in range(3):
                        value = -d[i, n] * d[j, m] + (along if m == n else 0.0)
                        matrix[q, 3 + m, 3 + n, i, j] += scale * value


@kernel
def volumes(nodes, x, directors, half, points, point_weights, layers, layer_weights, volume):
    """Volume (e g l,) of each integration point."""
    reference, thick = np.empty((4, 3)), np.empty((4, 3))
    values, by_r, by_s, base = np.empty(4), np.empty(4), np.empty(4), np.empty((5, 3))
    frame, dual, local = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    at = 0
    for q in range(nodes.shape[0]):
        for i in range(4):
            for m in range(3):
                reference[i, m] = x[nodes[q, i], m]
                thick[i, m] = half[q, i] * directors[q, i, m]
        for g in range(len(points)):
            _shape(points[g, 0], points[g, 1], values, by_r, by_s)
            _base(values, by_r, by_s, reference, thick, base)
            for l in range(len(layers)):
                det = _frame(base, layers[l], frame, dual, local)
                volume[at] = det * point_weights[g] * layer_weights[l]
                at += 1


@kernel
def frames(nodes, x, directors, half, points):
    """Local frames (e, g, 3, 3), a unit vector a row, on the mid-surface of the first shape."""
    out = np.empty((nodes.shape[0], len(points), 3, 3))
    reference, thick = np.empty((4, 3)), np.empty((4, 3))
    values, by_r, by_s, base = np.empty(4), np.empty(4), np.empty(4), np.empty((5, 3))
    frame, dual, local = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for q in range(nodes.shape[0]):
        for i in range(4):
            for m in range(3):
                reference[i, m] = x[nodes[q, i], m]
                thick[i, m] = half[q, i] * directors[q, i, m]
        for g in range(len(points)):
            _shape(points[g, 0], points[g, 1], values, by_r, by_s)
            _base(values, by_r, by_s, reference, thick, base)
            _frame(base, 0.0, frame, dual, local)
            out[q, g] = frame
    return out


def areas(nodes, x):
    """(e, 4, 4) integrals of products of shape functions over the mid-surface."""
    t = table("quad4", full=True)
    tangents = np.einsum("gkd,eki->egdi", t.slopes, x[nodes])
    area = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=2) * t.weights
    return np.einsum("eg,gk,gl->ekl", area, t.values, t.values)


def extrapolation(points):
    """(4, 4) from 2 x 2 points in the plane to corners; the mean for one point."""
    at_points = functions("quad4", points)[0]
    return np.linalg.inv(at_points) if len(points) == 4 else np.full((4, len(points)), 1.0 / len(points))
