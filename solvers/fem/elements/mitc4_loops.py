"""Loops over four-node shells: strains at integration points, stiffness and forces from stresses, areas."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...jit import kernel
from .condense import condense
from .mitc4 import (
    base_at,
    covariant_rows,
    cross_into,
    dot,
    drilling,
    enhanced_rows,
    frame_at,
    half_metrics,
    shape_at,
    tied_strains,
    tied_weights,
    to_local,
)
from .shapes import functions, surface_products
from .shell_gather import gather, gather_reference
from .shell_geometry import bending_geometry, tied_geometry


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
        gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        for i in range(4):
            for c in range(6):
                step[i, c] = u[nodes[q, i], c] - before[nodes[q, i], c]
        tied_strains(reference, thick, metric, tied, work)
        if finite is not None:
            tied_strains(now, corner, metric_now, tied, work)
        convex[q] = True
        for g in range(len(points)):
            r, s = points[g, 0], points[g, 1]
            if not tied_weights(reference, r, s, weights):
                convex[q] = False
                break
            shape_at(r, s, values, by_r, by_s)
            base_at(values, by_r, by_s, reference, thick, base)
            if finite is not None:
                base_at(values, by_r, by_s, now, corner, base_now)
            for l in range(len(layers)):
                t = layers[l]
                volume = frame_at(base, t, frame, dual, local)
                to_local(local, root, change)
                at = q * many + g * len(layers) + l
                if finite is not None:
                    half_metrics(r, s, t, weights, metric_now, base_now, cov)
                    half_metrics(r, s, t, weights, metric, base, first)
                    for k in range(5):
                        cov[k] -= first[k]
                else:
                    covariant_rows(r, s, t, weights, tied, base, values, by_r, by_s, thick, rows, vectors)
                    for k in range(5):
                        cov[k] = 0.0
                        for c in range(6):
                            for i in range(4):
                                cov[k] += rows[k, c, i] * step[i, c]
                if modes is not None:
                    enhanced_rows(reference, thick, r, s, volume, frame, root, extra, scratch)
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
    nodes, x, u, turn, directors, half, points, point_weights, layers, layer_weights, root, drill, finite, modes,
    stress, modulus, matrix, forces, answer, rest, drilled,
):  # fmt: skip
    """Forces (e, 6, 4) of the stresses, and the stiffness (e, 6, 6, 4, 4) or None; see `strains`.

    drill: (e,) penalty of the drilling rotation per area, drilled: (e,) its energy; answer, rest: of the enhanced
    strains, see `continuum_loops`.
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
    stiff, vectors, drill_rows = np.empty((5, 6, 4)), np.empty((3, 3)), np.empty((6, 4))
    frame, dual, local, change = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((5, 5))
    extra, stiff_extra = np.empty((5, 4)), np.empty((5, 4))
    inner, residual = np.empty((4, 4)), np.empty(4)
    mixed, back = np.empty((4, 6, 4)), np.empty((4, 6, 4))
    pulled, tension = np.empty(9), np.empty(5)
    many = len(points) * len(layers)
    place = (0, 1, 3, 4, 5)
    for q in range(nodes.shape[0]):
        gather(nodes, q, x, u, corner, directors, half, turn, reference, thick, now, moved, turns, finite)
        tied_strains(now, corner, metric, tied, work)
        forces[q] = 0.0
        drilled[q] = 0.0
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
            tied_weights(reference, r, s, weights)
            shape_at(r, s, values, by_r, by_s)
            base_at(values, by_r, by_s, reference, thick, base)
            base_at(values, by_r, by_s, now, corner, base_now)
            for l in range(len(layers)):
                t = layers[l]
                volume = frame_at(base, t, frame, dual, local)
                dv = volume * point_weights[g] * layer_weights[l]
                to_local(local, root, change)
                covariant_rows(r, s, t, weights, tied, base_now, values, by_r, by_s, corner, cov, vectors)
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
                    enhanced_rows(reference, thick, r, s, volume, frame, root, extra, scratch)
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
                    bending_geometry(t, tension, base_now, by_r, by_s, corner, matrix, q)
            frame_at(base, 0.0, frame, dual, local)
            value = drilling(values, by_r, by_s, base_now, corner, frame, turns, local, drill_rows)
            if finite is None:
                value = 0.0
                for c in range(6):
                    for i in range(4):
                        value += drill_rows[c, i] * moved[i, c]
            area = _area(base) * point_weights[g] * drill[q]
            drilled[q] += 0.5 * area * value * value
            for c in range(6):
                for i in range(4):
                    forces[q, c, i] += area * value * drill_rows[c, i]
                    if matrix is not None:
                        for e in range(6):
                            for j in range(4):
                                matrix[q, c, e, i, j] += area * drill_rows[c, i] * drill_rows[e, j]
        if finite is not None and matrix is not None:
            tied_geometry(pulled, now, corner, values, by_r, by_s, base, matrix, q)
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
    cross_into(base[0], base[1], 1.0, cross)
    return np.sqrt(dot(cross, cross))


@kernel
def volumes(nodes, x, directors, half, points, point_weights, layers, layer_weights, volume):
    """Volume (e g l,) of each integration point."""
    reference, thick = np.empty((4, 3)), np.empty((4, 3))
    values, by_r, by_s, base = np.empty(4), np.empty(4), np.empty(4), np.empty((5, 3))
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
    reference, thick = np.empty((4, 3)), np.empty((4, 3))
    values, by_r, by_s, base = np.empty(4), np.empty(4), np.empty(4), np.empty((5, 3))
    dual, local = np.empty((3, 3)), np.empty((3, 3))
    for q in range(nodes.shape[0]):
        gather_reference(nodes, q, x, directors, half, reference, thick)
        for g in range(len(points)):
            shape_at(points[g, 0], points[g, 1], values, by_r, by_s)
            base_at(values, by_r, by_s, reference, thick, base)
            frame_at(base, 0.0, out[q, g], dual, local)
    return out


def areas(nodes: NDArray[np.int64], x: NDArray[np.float64]) -> NDArray[np.float64]:
    """(e, 4, 4) integrals of products of shape functions over the mid-surface."""
    return surface_products("quad4", x[nodes])


def extrapolation(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(4, 4) from 2 x 2 points in the plane to corners; the mean for one point."""
    at_points = functions("quad4", points)[0]
    return np.asarray(np.linalg.inv(at_points)) if len(points) == 4 else np.full((4, len(points)), 1.0 / len(points))
