"""Loops over three-node shells: strains at integration points, stiffness and forces from stresses, areas.

Arguments are those of `mitc4_loops`; the enhanced parameters are the two rotations of the bubble.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...jit import kernel
from .condense import condense
from .mitc3 import (
    BY_R,
    BY_S,
    TIED_R,
    TIED_S,
    base_at,
    bubble_rows,
    covariant_rows,
    drilling,
    half_metrics,
    shear_weights,
    tied_shears,
    volume_at,
)
from .mitc4 import cross_into, dot, to_local
from .shapes import functions, table
from .shell_gather import gather
from .shell_geometry import bending_geometry, of_shift_and_turn, of_turn


@kernel
def strains(
    nodes, x, u, before, turn, directors, half, points, layers, root, finite, modes, alpha, alpha_before, committed,
    strain, convex,
):  # fmt: skip
    """Strain increments (e g l, 6) of the local frames since the last state."""
    reference, thick, now, corner = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    moved, turns, step = np.empty((3, 6)), np.empty((3, 3, 3)), np.empty((3, 6))
    base, base_now, other = np.empty((5, 3)), np.empty((5, 3)), np.empty((5, 3))
    tied, metric, metric_now = np.empty((6, 2, 6, 3)), np.empty((6, 2)), np.empty((6, 2))
    weights, rows, cov, first = np.empty((2, 6, 2)), np.empty((5, 6, 3)), np.empty(5), np.empty(5)
    frame, dual, local, change = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 5))
    extra, axes, centre = np.empty((5, 2)), np.empty((2, 3)), np.empty(3)
    a, b, c = np.empty(3), np.empty(3), np.empty(3)
    many = len(points) * len(layers)
    for q in range(nodes.shape[0]):
        gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        for i in range(3):
            for k in range(6):
                step[i, k] = u[nodes[q, i], k] - before[nodes[q, i], k]
        tied_shears(reference, thick, metric, tied, base, c)
        if finite is not None:
            tied_shears(now, corner, metric_now, tied, base, c)
        convex[q] = True
        for g in range(len(points)):
            r, s = points[g, 0], points[g, 1]
            shear_weights(r, s, weights)
            base_at(r, s, reference, thick, base)
            if finite is not None:
                base_at(r, s, now, corner, base_now)
            for l in range(len(layers)):
                t = layers[l]
                volume_at(r, s, t, reference, thick, other, frame, dual, local)
                to_local(local, root, change)
                at = q * many + g * len(layers) + l
                if finite is not None:
                    half_metrics(t, weights, metric_now, base_now, cov)
                    half_metrics(t, weights, metric, base, first)
                    for k in range(5):
                        cov[k] -= first[k]
                else:
                    covariant_rows(t, weights, tied, base, thick, rows, a, b, c)
                    for k in range(5):
                        cov[k] = 0.0
                        for e in range(6):
                            for i in range(3):
                                cov[k] += rows[k, e, i] * step[i, e]
                bubble_rows(r, s, t, weights, reference, thick, change, centre, axes, other, extra, first, c)
                for row in range(5):
                    total = 0.0
                    for k in range(5):
                        total += change[row, k] * cov[k]
                    for m in range(2):
                        gone = alpha_before[q, m] if finite is None else 0.0
                        total += extra[row, m] * (alpha[q, m] - gone)
                    place = row if row < 2 else row + 1
                    value = total if row < 2 else 0.5 * total
                    strain[at, place] = value - (committed[at, place] if finite is not None else 0.0)
                strain[at, 2] = 0.0


@kernel
def integrate(
    nodes, x, u, turn, directors, half, points, point_weights, layers, layer_weights, root, drill, finite, modes,
    stress, modulus, matrix, forces, answer, rest, drilled,
):  # fmt: skip
    """Forces (e, 6, 3) of the stresses, and the stiffness (e, 6, 6, 3, 3) or None."""
    reference, thick, now, corner = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    moved, turns = np.empty((3, 6)), np.empty((3, 3, 3))
    base, base_now, other = np.empty((5, 3)), np.empty((5, 3)), np.empty((5, 3))
    tied, metric, pulled = np.empty((6, 2, 6, 3)), np.empty((6, 2)), np.empty((6, 2))
    weights, cov, rows, stiff = np.empty((2, 6, 2)), np.empty((5, 6, 3)), np.empty((5, 6, 3)), np.empty((5, 6, 3))
    frame, dual, local, change = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 5))
    extra, stiff_extra, axes, centre = np.empty((5, 2)), np.empty((5, 2)), np.empty((2, 3)), np.empty(3)
    a, b, c, d1, d2, first = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(5)
    inner, residual = np.empty((2, 2)), np.empty(2)
    mixed, back, drill_rows = np.empty((2, 6, 3)), np.empty((2, 6, 3)), np.empty((6, 3))
    tension = np.empty(5)
    many = len(points) * len(layers)
    place = (0, 1, 3, 4, 5)
    for q in range(nodes.shape[0]):
        gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        tied_shears(now, corner, metric, tied, base, c)
        forces[q] = 0.0
        drilled[q] = 0.0
        pulled[:] = 0.0
        inner[:] = 0.0
        residual[:] = 0.0
        mixed[:] = 0.0
        back[:] = 0.0
        if matrix is not None:
            matrix[q] = 0.0
        for g in range(len(points)):
            r, s = points[g, 0], points[g, 1]
            shear_weights(r, s, weights)
            base_at(r, s, reference, thick, base)
            base_at(r, s, now, corner, base_now)
            for l in range(len(layers)):
                t = layers[l]
                volume = volume_at(r, s, t, reference, thick, other, frame, dual, local)
                dv = volume * point_weights[g] * layer_weights[l]
                to_local(local, root, change)
                covariant_rows(t, weights, tied, base_now, corner, cov, a, b, c)
                for row in range(5):
                    for e in range(6):
                        for i in range(3):
                            total = 0.0
                            for k in range(5):
                                total += change[row, k] * cov[k, e, i]
                            rows[row, e, i] = total
                at = q * many + g * len(layers) + l
                bubble_rows(r, s, t, weights, reference, thick, change, centre, axes, other, extra, first, c)
                for row in range(5):
                    factor = dv * stress[at, place[row]]
                    for e in range(6):
                        for i in range(3):
                            forces[q, e, i] += factor * rows[row, e, i]
                    for m in range(2):
                        residual[m] += factor * extra[row, m]
                if matrix is None:
                    continue
                for row in range(5):
                    for e in range(6):
                        for i in range(3):
                            total = 0.0
                            for o in range(5):
                                total += modulus[at, place[row], place[o]] * rows[o, e, i]
                            stiff[row, e, i] = dv * total
                    for m in range(2):
                        total = 0.0
                        for o in range(5):
                            total += modulus[at, place[row], place[o]] * extra[o, m]
                        stiff_extra[row, m] = dv * total
                for e in range(6):
                    for f in range(6):
                        for i in range(3):
                            for row in range(5):
                                factor = rows[row, e, i]
                                for j in range(3):
                                    matrix[q, e, f, i, j] += factor * stiff[row, f, j]
                for m in range(2):
                    for o in range(2):
                        for row in range(5):
                            inner[m, o] += extra[row, m] * stiff_extra[row, o]
                    for e in range(6):
                        for row in range(5):
                            for i in range(3):
                                mixed[m, e, i] += extra[row, m] * stiff[row, e, i]
                                back[m, e, i] += rows[row, e, i] * stiff_extra[row, m]
                if finite is not None:
                    for k in range(5):
                        tension[k] = 0.0
                        for row in range(5):
                            tension[k] += dv * change[row, k] * stress[at, place[row]]
                    for p in range(6):
                        for e in range(2):
                            for k in range(2):
                                pulled[p, e] += weights[k, p, e] * tension[3 + k]
                    for k in range(3):
                        _membrane_geometry(k, tension[k], matrix, q)
                    bending_geometry(t, tension, base_now, BY_R, BY_S, corner, matrix, q)
            volume_at(r, s, 0.0, reference, thick, other, frame, dual, local)
            value = drilling(r, s, base_now, corner, frame, turns, local, drill_rows, a, b, d1, d2, c)
            if finite is None:
                value = 0.0
                for e in range(6):
                    for i in range(3):
                        value += drill_rows[e, i] * moved[i, e]
            area = _area(base) * point_weights[g] * drill[q]
            drilled[q] += 0.5 * area * value * value
            for e in range(6):
                for i in range(3):
                    forces[q, e, i] += area * value * drill_rows[e, i]
                    if matrix is not None:
                        for f in range(6):
                            for j in range(3):
                                matrix[q, e, f, i, j] += area * drill_rows[e, i] * drill_rows[f, j]
        if finite is not None and matrix is not None:
            _shear_geometry(pulled, now, corner, other, matrix, q)
        if matrix is not None:
            condense(inner, residual, mixed, back, 2, 6, 3, q, matrix, forces, answer, rest)
        else:
            for e in range(6):
                for i in range(3):
                    for m in range(2):
                        forces[q, e, i] -= answer[q, m, e, i] * residual[m]


@kernel
def _membrane_geometry(k, tension, matrix, q):
    """Stiffness of a membrane stress: rr, ss or rs."""
    for i in range(3):
        for j in range(3):
            if k == 0:
                value = BY_R[i] * BY_R[j]
            elif k == 1:
                value = BY_S[i] * BY_S[j]
            else:
                value = 0.5 * (BY_R[i] * BY_S[j] + BY_S[i] * BY_R[j])
            for m in range(3):
                matrix[q, m, m, i, j] += tension * value


@kernel
def _shear_geometry(pulled, y, d, base, matrix, q):
    """Stiffness of the shear stresses through the strains at the tying points."""
    for p in range(6):
        r, s = TIED_R[p], TIED_S[p]
        values = (1.0 - r - s, r, s)
        base_at(r, s, y, d, base)
        for a in range(2):
            pull = 0.5 * pulled[p, a]
            for j in range(3):
                for i in range(3):
                    by = BY_R[i] if a == 0 else BY_S[i]
                    of_shift_and_turn(d[j], pull * by * values[j], i, j, matrix, q)
                of_turn(d[j], base[a], pull * values[j], j, matrix, q)


@kernel
def _area(base):
    cross = np.zeros(3)
    cross_into(base[0], base[1], 1.0, cross)
    return np.sqrt(dot(cross, cross))


@kernel
def volumes(nodes, x, directors, half, points, point_weights, layers, layer_weights, volume):
    """Volume (e g l,) of each integration point."""
    reference, thick, base = np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 3))
    frame, dual, local = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    at = 0
    for q in range(nodes.shape[0]):
        for i in range(3):
            for m in range(3):
                reference[i, m] = x[nodes[q, i], m]
                thick[i, m] = half[q, i] * directors[q, i, m]
        for g in range(len(points)):
            for l in range(len(layers)):
                det = volume_at(points[g, 0], points[g, 1], layers[l], reference, thick, base, frame, dual, local)
                volume[at] = det * point_weights[g] * layer_weights[l]
                at += 1


@kernel
def frames(nodes, x, directors, half, points):
    """Local frames (e, g, 3, 3), a unit vector a row, on the mid-surface of the first shape."""
    out = np.empty((nodes.shape[0], len(points), 3, 3))
    reference, thick, base = np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 3))
    dual, local = np.empty((3, 3)), np.empty((3, 3))
    for q in range(nodes.shape[0]):
        for i in range(3):
            for m in range(3):
                reference[i, m] = x[nodes[q, i], m]
                thick[i, m] = half[q, i] * directors[q, i, m]
        for g in range(len(points)):
            volume_at(points[g, 0], points[g, 1], 0.0, reference, thick, base, out[q, g], dual, local)
    return out


def areas(nodes: NDArray[np.int64], x: NDArray[np.float64]) -> NDArray[np.float64]:
    """(e, 3, 3) integrals of products of shape functions over the mid-surface."""
    t = table("tri3", full=True)
    p = x[nodes]
    double = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    out: NDArray[np.float64] = np.einsum("e,g,gk,gl->ekl", double, t.weights, t.values, t.values)
    return out


def extrapolation(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, g) from the points in the plane to corners, by the linear field nearest to them."""
    return np.asarray(np.linalg.pinv(functions("tri3", points)[0]))
