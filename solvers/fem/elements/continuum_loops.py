"""Loops over solids and plane elements: strains at integration points, stiffness and forces from stresses, masses.

Element matrices are (c, c, n, n), component by component, so that the innermost loop is over an element's nodes.
"""

from __future__ import annotations

import numpy as np

from ...jit import kernel
from .condense import condense
from .continuum import (
    MOST_MODES,
    ROUND,
    SOLID,
    deformation,
    enhanced,
    geometric_stiffness,
    gradients,
    green,
    mean_dilatation,
    strain_rows,
)


@kernel
def strains(
    nodes, x, u, before, values, slopes, weights, points, centre, plane, finite, mean, modes, alpha, alpha_before,
    strain, smallest,
):  # fmt: skip
    """Strain increments (e g, 6), tensor components, of each element (e, n) since the last state.

    x: (N, 3) where gradients are taken; u, before: (N, 6) displacements now and then; finite: True for Green's strain,
    None; mean: True for the mean dilatation, None; modes: number of enhanced ones or None, alpha, alpha_before: (e,
    modes) their parameters; smallest: (e,) least determinant of the Jacobian of an element.
    """
    e, n = nodes.shape
    d = slopes.shape[2]
    c = 3 if plane == SOLID else 2
    many = len(weights)
    coordinates, own, old = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    gradient, rows = np.empty((3, n)), np.empty((6, c, n))
    now, then = np.empty((3, 3)), np.empty((3, 3))
    new, old_strain = np.empty(6), np.empty(6)
    average = np.empty((3, n))
    extra, natural = np.empty((6, MOST_MODES)), np.empty((3, 3))
    for q in range(e):
        for k in range(n):
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
                own[k, i] = u[nodes[q, k], i]
                old[k, i] = before[nodes[q, k], i]
        if mean is not None:
            mean_dilatation(coordinates, values, slopes, weights, n, d, c, plane, gradient, average)
        smallest[q] = np.inf
        for g in range(many):
            det = gradients(coordinates, slopes, g, n, d, gradient)
            smallest[q] = min(smallest[q], det)
            radius = 1.0
            if plane == ROUND:
                radius = 0.0
                for k in range(n):
                    radius += values[g, k] * coordinates[k, 0]
            at = q * many + g
            if finite is not None:
                deformation(gradient, values, g, n, d, plane, radius, own, now)
                deformation(gradient, values, g, n, d, plane, radius, old, then)
                green(now, new)
                green(then, old_strain)
                for r in range(6):
                    strain[at, r] = new[r] - old_strain[r]
            else:
                if mean is not None:
                    strain_rows(gradient, values, g, n, c, plane, radius, None, average, rows)
                else:
                    strain_rows(gradient, values, g, n, c, plane, radius, None, None, rows)
                for r in range(6):
                    total = 0.0
                    for i in range(c):
                        for k in range(n):
                            total += rows[r, i, k] * (own[k, i] - old[k, i])
                    strain[at, r] = total if r < 3 else 0.5 * total
            if modes is not None:
                enhanced(coordinates, centre, points, modes, g, n, d, det, natural, extra)
                for r in range(6):
                    total = 0.0
                    for m in range(modes):
                        total += extra[r, m] * (alpha[q, m] - alpha_before[q, m])
                    strain[at, r] += total if r < 3 else 0.5 * total


@kernel
def integrate(
    nodes, x, u, values, slopes, weights, points, centre, plane, thickness, finite, geometric, mean, modes, stress,
    modulus, matrix, forces, answer, rest,
):  # fmt: skip
    """Forces (e, c, n) of the stresses, and the stiffness (e, c, c, n, n), or None.

    x, u, finite, mean, modes: as `strains`; thickness: (e,); geometric: True with the stiffness of the stresses, None;
    stress: (e g, 6); modulus: (e g, 6, 6). Enhanced parameters are condensed out: their change is
    -(rest + answer . change of displacement); answer: (e, modes, c, n), rest: (e, modes).
    """
    e, n = nodes.shape
    d = slopes.shape[2]
    c = 3 if plane == SOLID else 2
    many = len(weights)
    coordinates, own = np.empty((n, 3)), np.empty((n, 3))
    gradient, rows, stiff = np.empty((3, n)), np.empty((6, c, n)), np.empty((6, c, n))
    f = np.empty((3, 3))
    average = np.empty((3, n))
    size = MOST_MODES
    extra, natural, stiff_extra = np.empty((6, size)), np.empty((3, 3)), np.empty((6, size))
    inner, residual = np.empty((size, size)), np.empty(size)
    mixed, back = np.empty((size, c, n)), np.empty((size, c, n))
    for q in range(e):
        for k in range(n):
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
                if finite is not None:
                    own[k, i] = u[nodes[q, k], i]
        for i in range(c):
            for k in range(n):
                forces[q, i, k] = 0.0
        if matrix is not None:
            for i in range(c):
                for j in range(c):
                    for k in range(n):
                        for l in range(n):
                            matrix[q, i, j, k, l] = 0.0
        if mean is not None:
            mean_dilatation(coordinates, values, slopes, weights, n, d, c, plane, gradient, average)
        if modes is not None:
            for m in range(modes):
                residual[m] = 0.0
                for o in range(modes):
                    inner[m, o] = 0.0
                for i in range(c):
                    for k in range(n):
                        mixed[m, i, k] = 0.0
                        back[m, i, k] = 0.0
        for g in range(many):
            det = gradients(coordinates, slopes, g, n, d, gradient)
            dv = det * weights[g] * thickness[q]
            radius = 1.0
            if plane == ROUND:
                radius = 0.0
                for k in range(n):
                    radius += values[g, k] * coordinates[k, 0]
                dv *= radius
            at = q * many + g
            if finite is not None:
                deformation(gradient, values, g, n, d, plane, radius, own, f)
                strain_rows(gradient, values, g, n, c, plane, radius, f, None, rows)
            elif mean is not None:
                strain_rows(gradient, values, g, n, c, plane, radius, None, average, rows)
            else:
                strain_rows(gradient, values, g, n, c, plane, radius, None, None, rows)
            for i in range(c):
                for r in range(6):
                    factor = dv * stress[at, r]
                    for k in range(n):
                        forces[q, i, k] += rows[r, i, k] * factor
            if modes is not None:
                enhanced(coordinates, centre, points, modes, g, n, d, det, natural, extra)
                for m in range(modes):
                    for r in range(6):
                        residual[m] += dv * extra[r, m] * stress[at, r]
            if matrix is None:
                continue
            for j in range(c):
                for r in range(6):
                    for l in range(n):
                        stiff[r, j, l] = 0.0
                    for o in range(6):
                        factor = dv * modulus[at, r, o]
                        if factor != 0.0:
                            for l in range(n):
                                stiff[r, j, l] += factor * rows[o, j, l]
            for i in range(c):
                for j in range(c):
                    for k in range(n):
                        for r in range(6):
                            factor = rows[r, i, k]
                            if factor != 0.0:
                                for l in range(n):
                                    matrix[q, i, j, k, l] += factor * stiff[r, j, l]
            if geometric is not None:
                geometric_stiffness(gradient, values, g, n, c, d, plane, radius, stress, at, dv, matrix, q)
            if modes is not None:
                for m in range(modes):
                    for r in range(6):
                        total = 0.0
                        for o in range(6):
                            total += modulus[at, r, o] * extra[o, m]
                        stiff_extra[r, m] = dv * total
                for m in range(modes):
                    for o in range(modes):
                        for r in range(6):
                            inner[m, o] += extra[r, m] * stiff_extra[r, o]
                    for i in range(c):
                        for r in range(6):
                            for k in range(n):
                                mixed[m, i, k] += extra[r, m] * stiff[r, i, k]
                                back[m, i, k] += rows[r, i, k] * stiff_extra[r, m]
        if modes is not None and matrix is not None:
            condense(inner, residual, mixed, back, modes, c, n, q, matrix, forces, answer, rest)
        elif modes is not None:
            for i in range(c):  # what the enhanced parameters are out of balance by, through the last stiffness
                for k in range(n):
                    for m in range(modes):
                        forces[q, i, k] -= answer[q, m, i, k] * residual[m]


@kernel
def turned(nodes, x, u, before, slopes, plane, stress, out):
    """Stresses (e g, 6) turned by the spin of a step, gradients taken at x, the middle of it (Hughes & Winget 1980)."""
    e, n = nodes.shape
    d = slopes.shape[2]
    coordinates, gradient = np.empty((n, 3)), np.empty((3, n))
    spin, turn, tensor = np.zeros((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for q in range(e):
        for k in range(n):
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
        for g in range(slopes.shape[0]):
            gradients(coordinates, slopes, g, n, d, gradient)
            for i in range(3):
                for j in range(3):
                    spin[i, j] = 0.0
            for k in range(n):
                a = nodes[q, k]
                for i in range(d):
                    for j in range(d):
                        rate = (u[a, i] - before[a, i]) * gradient[j, k]
                        spin[i, j] += 0.5 * rate
                        spin[j, i] -= 0.5 * rate
            half = np.eye(3) - 0.5 * spin
            turn = np.linalg.solve(half, np.eye(3) + 0.5 * spin)
            at = q * slopes.shape[0] + g
            for row in range(6):
                i = row if row < 3 else (0 if row == 3 else 1 if row == 4 else 2)
                j = row if row < 3 else (1 if row == 3 else 2 if row == 4 else 0)
                tensor[i, j] = stress[at, row]
                tensor[j, i] = stress[at, row]
            for row in range(6):
                i = row if row < 3 else (0 if row == 3 else 1 if row == 4 else 2)
                j = row if row < 3 else (1 if row == 3 else 2 if row == 4 else 0)
                total = 0.0
                for p in range(3):
                    for o in range(3):
                        total += turn[i, p] * tensor[p, o] * turn[j, o]
                out[at, row] = total


@kernel
def volumes(nodes, x, values, slopes, weights, plane, thickness, volume):
    """Volume (e g,) of each integration point."""
    e, n = nodes.shape
    d = slopes.shape[2]
    coordinates, gradient = np.empty((n, 3)), np.empty((3, n))
    for q in range(e):
        for k in range(n):
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
        for g in range(len(weights)):
            dv = gradients(coordinates, slopes, g, n, d, gradient) * weights[g] * thickness[q]
            if plane == ROUND:
                radius = 0.0
                for k in range(n):
                    radius += values[g, k] * coordinates[k, 0]
                dv *= radius
            volume[q * len(weights) + g] = dv


@kernel
def masses(nodes, x, values, slopes, weights, plane, thickness, rho, matrix, lumped):
    """Consistent mass (e, n, n) of one component, or None; lumped (e, n), by the diagonal of the consistent one scaled
    to the element's mass (Hinton, Rock & Zienkiewicz 1976)."""
    e, n = nodes.shape
    d = slopes.shape[2]
    coordinates, gradient = np.empty((n, 3)), np.empty((3, n))
    diagonal = np.empty(n)
    for q in range(e):
        for k in range(n):
            diagonal[k] = 0.0
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
        if matrix is not None:
            for k in range(n):
                for l in range(n):
                    matrix[q, k, l] = 0.0
        total = 0.0
        for g in range(len(weights)):
            dv = gradients(coordinates, slopes, g, n, d, gradient) * weights[g] * thickness[q]
            if plane == ROUND:
                radius = 0.0
                for k in range(n):
                    radius += values[g, k] * coordinates[k, 0]
                dv *= radius
            total += dv
            for k in range(n):
                diagonal[k] += dv * values[g, k] * values[g, k]
                if matrix is not None:
                    for l in range(n):
                        matrix[q, k, l] += rho * dv * values[g, k] * values[g, l]
        own = 0.0
        for k in range(n):
            own += diagonal[k]
        for k in range(n):
            lumped[q, k] = rho * total * diagonal[k] / own
