"""The nine-node shell MITC9 over many elements, as `mitc4_loops`: strains, stiffness and forces, areas.

It has no enhanced strains: the arguments of theirs are there because the group calls all shells alike.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...jit import kernel
from . import shapes
from .mitc4 import base_at, cross_into, dot, drilling, frame_at, to_local
from .mitc9 import COUNT, FIRST, TIED, blend, of_step, own_weights, shape_at, strains_at, tied_strains, tied_weights
from .mitc9_geometry import tied_geometry
from .shell_gather import gather, gather_reference


@kernel
def strains(
    nodes, x, u, before, turn, directors, half, points, layers, root, finite, modes, alpha, alpha_before, committed,
    strain, convex,
):  # fmt: skip
    """Strain increments (e g l, 6) since the last state; see `mitc4_loops.strains`."""
    reference, thick, now, corner = np.empty((9, 3)), np.empty((9, 3)), np.empty((9, 3)), np.empty((9, 3))
    moved, turns, step = np.empty((9, 6)), np.empty((9, 3, 3)), np.empty((9, 6))
    values, by_r, by_s, base = np.empty(9), np.empty(9), np.empty(9), np.empty((5, 3))
    tied, metric, first = np.empty((3, TIED, 6, 9)), np.empty((3, TIED)), np.empty((3, TIED))
    weights, cov = np.empty((5, 26)), np.empty(5)
    frame, dual, local, change = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 5))
    many = len(points) * len(layers)
    for q in range(nodes.shape[0]):
        gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        if finite is not None:
            tied_strains(reference, thick, first, tied, base)
            tied_strains(now, corner, metric, tied, base)
            for j in range(3):
                for p in range(TIED):
                    metric[j, p] -= first[j, p]
        else:
            for i in range(9):
                for c in range(6):
                    step[i, c] = u[nodes[q, i], c] - before[nodes[q, i], c]
            tied_strains(reference, thick, first, tied, base)
            of_step(tied, step, metric)
        convex[q] = True
        skew, means = own_weights(reference, thick, base)
        for g in range(len(points)):
            r, s = points[g, 0], points[g, 1]
            tied_weights(r, s, skew, means, weights)
            shape_at(r, s, values, by_r, by_s)
            base_at(values, by_r, by_s, reference, thick, base)
            for l in range(len(layers)):
                t = layers[l]
                frame_at(base, t, frame, dual, local)
                to_local(local, root, change)
                strains_at(t, weights, metric, cov)
                at = q * many + g * len(layers) + l
                for row in range(5):
                    total = 0.0
                    for k in range(5):
                        total += change[row, k] * cov[k]
                    place = row if row < 2 else row + 1
                    value = total if row < 2 else 0.5 * total
                    strain[at, place] = value - (committed[at, place] if finite is not None else 0.0)
                strain[at, 2] = 0.0


@kernel
def integrate(
    nodes, x, u, turn, directors, half, points, point_weights, layers, layer_weights, root, drill, finite, modes,
    stress, modulus, matrix, forces, answer, rest, drilled,
):  # fmt: skip
    """Forces (e, 6, 9) of the stresses, and the stiffness (e, 6, 6, 9, 9) or None; see `mitc4_loops.integrate`."""
    reference, thick, now, corner = np.empty((9, 3)), np.empty((9, 3)), np.empty((9, 3)), np.empty((9, 3))
    moved, turns = np.empty((9, 6)), np.empty((9, 3, 3))
    values, by_r, by_s = np.empty(9), np.empty(9), np.empty(9)
    base, base_now = np.empty((5, 3)), np.empty((5, 3))
    tied, metric = np.empty((3, TIED, 6, 9)), np.empty((3, TIED))
    weights, blended = np.empty((5, 26)), np.empty((3, 5, 6, 9))
    by_power = blended.reshape((3, 5, 54))
    rows, stiff, inner, push = np.empty((5, 54)), np.empty((5, 54)), np.empty((54, 54)), np.empty(54)
    drill_rows = np.empty((6, 9))
    frame, dual, local, change = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 5))
    pulled, tension = np.empty((3, TIED)), np.empty(5)
    many = len(points) * len(layers)
    place = (0, 1, 3, 4, 5)
    for q in range(nodes.shape[0]):
        gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        tied_strains(now, corner, metric, tied, base)
        skew, means = own_weights(reference, thick, base)
        inner[:] = 0.0
        push[:] = 0.0
        drilled[q] = 0.0
        pulled[:] = 0.0
        for g in range(len(points)):
            r, s = points[g, 0], points[g, 1]
            tied_weights(r, s, skew, means, weights)
            blend(weights, tied, blended)
            shape_at(r, s, values, by_r, by_s)
            base_at(values, by_r, by_s, reference, thick, base)
            base_at(values, by_r, by_s, now, corner, base_now)
            for l in range(len(layers)):
                t = layers[l]
                volume = frame_at(base, t, frame, dual, local)
                dv = volume * point_weights[g] * layer_weights[l]
                to_local(local, root, change)
                at = q * many + g * len(layers) + l
                rows[:] = 0.0
                for row in range(5):
                    for k in range(5):
                        factor = change[row, k]
                        for c in range(54):
                            rows[row, c] += factor * (
                                by_power[0, k, c] + t * (by_power[1, k, c] + t * by_power[2, k, c])
                            )
                    factor = dv * stress[at, place[row]]
                    for c in range(54):
                        push[c] += factor * rows[row, c]
                if matrix is None:
                    continue
                stiff[:] = 0.0
                for row in range(5):
                    for o in range(5):
                        factor = dv * modulus[at, place[row], place[o]]
                        for c in range(54):
                            stiff[row, c] += factor * rows[o, c]
                for a in range(54):
                    for row in range(5):
                        factor = rows[row, a]
                        for c in range(54):
                            inner[a, c] += factor * stiff[row, c]
                if finite is not None:
                    for k in range(5):
                        tension[k] = 0.0
                        for row in range(5):
                            tension[k] += dv * change[row, k] * stress[at, place[row]]
                    _pull(t, weights, tension, pulled)
            volume = frame_at(base, 0.0, frame, dual, local)
            value = drilling(values, by_r, by_s, base_now, corner, frame, turns, local, drill_rows)
            if finite is None:
                value = 0.0
                for c in range(6):
                    for i in range(9):
                        value += drill_rows[c, i] * moved[i, c]
            flat = drill_rows.reshape(54)
            area = _area(base) * point_weights[g] * drill[q]
            drilled[q] += 0.5 * area * value * value
            for a in range(54):
                push[a] += area * value * flat[a]
                if matrix is not None:
                    factor = area * flat[a]
                    for c in range(54):
                        inner[a, c] += factor * flat[c]
        for c in range(6):
            for i in range(9):
                forces[q, c, i] = push[9 * c + i]
        if matrix is not None:
            for c in range(6):
                for e in range(6):
                    for i in range(9):
                        for j in range(9):
                            matrix[q, c, e, i, j] = inner[9 * c + i, 9 * e + j]
            if finite is not None:
                tied_geometry(pulled, now, corner, base, matrix, q)


@kernel
def _pull(t, weights, tension, pulled):
    """What the stresses at a point do to the tied strains, by powers of t."""
    for k in range(5):
        for m in range(COUNT[k]):
            value = weights[k, m] * tension[k]
            p = FIRST[k] + m
            pulled[0, p] += value
            if k < 3:
                pulled[1, p] += t * value
                pulled[2, p] += t * t * value


@kernel
def _area(base):
    cross = np.zeros(3)
    cross_into(base[0], base[1], 1.0, cross)
    return np.sqrt(dot(cross, cross))


@kernel
def volumes(nodes, x, directors, half, points, point_weights, layers, layer_weights, volume):
    """Volume (e g l,) of each integration point."""
    reference, thick = np.empty((9, 3)), np.empty((9, 3))
    values, by_r, by_s, base = np.empty(9), np.empty(9), np.empty(9), np.empty((5, 3))
    frame, dual, local = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    at = 0
    for q in range(nodes.shape[0]):
        gather_reference(nodes, q, x, directors, half, reference, thick)
        for g in range(len(points)):
            shape_at(points[g, 0], points[g, 1], values, by_r, by_s)
            base_at(values, by_r, by_s, reference, thick, base)
            for l in range(len(layers)):
                det = frame_at(base, layers[l], frame, dual, local)
                volume[at] = det * point_weights[g] * layer_weights[l]
                at += 1


@kernel
def frames(nodes, x, directors, half, points):
    """Local frames (e, g, 3, 3), a unit vector a row, on the mid-surface of the first shape."""
    out = np.empty((nodes.shape[0], len(points), 3, 3))
    reference, thick = np.empty((9, 3)), np.empty((9, 3))
    values, by_r, by_s, base = np.empty(9), np.empty(9), np.empty(9), np.empty((5, 3))
    dual, local = np.empty((3, 3)), np.empty((3, 3))
    for q in range(nodes.shape[0]):
        gather_reference(nodes, q, x, directors, half, reference, thick)
        for g in range(len(points)):
            shape_at(points[g, 0], points[g, 1], values, by_r, by_s)
            base_at(values, by_r, by_s, reference, thick, base)
            frame_at(base, 0.0, out[q, g], dual, local)
    return out


def areas(nodes: NDArray[np.int64], x: NDArray[np.float64]) -> NDArray[np.float64]:
    """(e, 9, 9) integrals of products of shape functions over the mid-surface."""
    return shapes.surface_products("quad9", x[nodes])


def extrapolation(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(9, g) from the 3 x 3 points in the plane to the nodes: the bilinear field nearest to them."""
    return shapes.extrapolation("quad9")
