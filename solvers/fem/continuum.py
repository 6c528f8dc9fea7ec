"""Element loops of solids and plane elements: strains at integration points, stiffness and forces from stresses.

Strains are of one of three kinds: small (at the first shape), Green's (total Lagrangian, at the first shape with the
deformation gradient), or small increments at the present shape (updated Lagrangian). An element may have enhanced
strains (Simo & Rifai 1990; with Green's strain: Klinkel & Wagner 1997) or the mean dilatation (Hughes 1980), where it would
lock. Arguments that are None are pruned when compiled.

Element matrices are (c, c, n, n), component by component, so that the innermost loop is over an element's nodes.
"""

from __future__ import annotations

import numpy as np

from ..jit import kernel

SOLID, FLAT, ROUND = 0, 1, 2  # solid; plane strain or stress; axisymmetric: x is the radius, forces are per radian


@kernel
def gradients(coordinates, slopes, g, n, d, gradient):
    """Jacobian's determinant, and the shape functions' gradients (d, n) at integration point g of one element."""
    if d == 2:
        a = b = c = e = 0.0
        for k in range(n):
            a += coordinates[k, 0] * slopes[g, k, 0]
            b += coordinates[k, 0] * slopes[g, k, 1]
            c += coordinates[k, 1] * slopes[g, k, 0]
            e += coordinates[k, 1] * slopes[g, k, 1]
        det = a * e - b * c
        inverse = 1.0 / det
        for k in range(n):
            gradient[0, k] = (e * slopes[g, k, 0] - c * slopes[g, k, 1]) * inverse
            gradient[1, k] = (a * slopes[g, k, 1] - b * slopes[g, k, 0]) * inverse
        return det
    j00 = j01 = j02 = j10 = j11 = j12 = j20 = j21 = j22 = 0.0
    for k in range(n):
        x, y, z = coordinates[k, 0], coordinates[k, 1], coordinates[k, 2]
        r, s, t = slopes[g, k, 0], slopes[g, k, 1], slopes[g, k, 2]
        j00 += x * r
        j01 += x * s
        j02 += x * t
        j10 += y * r
        j11 += y * s
        j12 += y * t
        j20 += z * r
        j21 += z * s
        j22 += z * t
    c00 = j11 * j22 - j12 * j21
    c01 = j12 * j20 - j10 * j22
    c02 = j10 * j21 - j11 * j20
    det = j00 * c00 + j01 * c01 + j02 * c02
    inverse = 1.0 / det
    i00, i10, i20 = c00 * inverse, c01 * inverse, c02 * inverse
    i01, i11, i21 = (j02 * j21 - j01 * j22) * inverse, (j00 * j22 - j02 * j20) * inverse, (j01 * j20 - j00 * j21) * inverse
    i02, i12, i22 = (j01 * j12 - j02 * j11) * inverse, (j02 * j10 - j00 * j12) * inverse, (j00 * j11 - j01 * j10) * inverse
    for k in range(n):
        r, s, t = slopes[g, k, 0], slopes[g, k, 1], slopes[g, k, 2]
        gradient[0, k] = r * i00 + s * i10 + t * i20
        gradient[1, k] = r * i01 + s * i11 + t * i21
        gradient[2, k] = r * i02 + s * i12 + t * i22
    return det


@kernel
def _enhanced(coordinates, centre, points, modes, g, n, d, det, natural, enhanced):
    """Enhanced strain rows (6, modes) at point g: natural modes, mapped by the Jacobian at the centre.

    centre: slopes at the centre (1, n, d). Modes: r in rr, s in ss, (t in tt,) r and s in rs, and so on; those after
    the linear ones are bilinear (Andelfinger & Ramm 1993). natural: (d, d) scratch of the inverse Jacobian.
    """
    jacobian = np.zeros((3, 3))
    for k in range(n):
        for i in range(d):
            for a in range(d):
                jacobian[i, a] += coordinates[k, i] * centre[0, k, a]
    if d == 2:
        jacobian[2, 2] = 1.0
    inverse = np.linalg.inv(jacobian)
    det0 = np.linalg.det(jacobian)
    scale = det0 / det
    r, s = points[g, 0], points[g, 1]
    t = points[g, 2] if d == 3 else 0.0
    for m in range(modes):
        for i in range(3):
            for j in range(3):
                natural[i, j] = 0.0
        a, b, value = 0, 0, r
        if d == 2:
            if m == 1:
                a, b, value = 1, 1, s
            elif m == 2:
                a, b, value = 0, 1, r
            elif m == 3:
                a, b, value = 0, 1, s
        else:
            if m == 1:
                a, b, value = 1, 1, s
            elif m == 2:
                a, b, value = 2, 2, t
            elif m == 3:
                a, b, value = 0, 1, r
            elif m == 4:
                a, b, value = 0, 1, s
            elif m == 5:
                a, b, value = 1, 2, s
            elif m == 6:
                a, b, value = 1, 2, t
            elif m == 7:
                a, b, value = 0, 2, r
            elif m == 8:
                a, b, value = 0, 2, t
        natural[a, b] = value
        natural[b, a] = value
        for row in range(6):
            i = row if row < 3 else (0 if row == 3 else 1 if row == 4 else 2)
            j = row if row < 3 else (1 if row == 3 else 2 if row == 4 else 0)
            total = 0.0
            for p in range(3):
                for q in range(3):
                    total += inverse[p, i] * inverse[q, j] * natural[p, q]
            enhanced[row, m] = scale * total * (1.0 if row < 3 else 2.0)


@kernel
def _rows(gradient, values, g, n, c, plane, radius, deformation, mean, rows):
    """Strain rows (6, c, n) at one point: strain = rows . displacement, shears as angles.

    deformation: gradient F (3, 3), None: small; mean: (d, n) mean gradients for the dilatation, or None.
    """
    for r in range(6):
        for i in range(c):
            for k in range(n):
                rows[r, i, k] = 0.0
    if deformation is None:
        for k in range(n):
            rows[0, 0, k] = gradient[0, k]
            rows[1, 1, k] = gradient[1, k]
            rows[3, 0, k] = gradient[1, k]
            rows[3, 1, k] = gradient[0, k]
        if plane == SOLID:
            for k in range(n):
                rows[2, 2, k] = gradient[2, k]
                rows[4, 1, k] = gradient[2, k]
                rows[4, 2, k] = gradient[1, k]
                rows[5, 2, k] = gradient[0, k]
                rows[5, 0, k] = gradient[2, k]
        elif plane == ROUND:
            for k in range(n):
                rows[2, 0, k] = values[g, k] / radius
    else:
        f = deformation
        for i in range(c):
            for k in range(n):
                x, y = gradient[0, k], gradient[1, k]
                rows[0, i, k] = f[i, 0] * x
                rows[1, i, k] = f[i, 1] * y
                rows[3, i, k] = f[i, 0] * y + f[i, 1] * x
                if plane == SOLID:
                    z = gradient[2, k]
                    rows[2, i, k] = f[i, 2] * z
                    rows[4, i, k] = f[i, 1] * z + f[i, 2] * y
                    rows[5, i, k] = f[i, 2] * x + f[i, 0] * z
        if plane == ROUND:
            for k in range(n):
                rows[2, 0, k] = f[2, 2] * values[g, k] / radius
    if mean is not None:
        for i in range(c):
            for k in range(n):
                off = mean[i, k] - (rows[0, i, k] + rows[1, i, k] + rows[2, i, k])
                for r in range(3):
                    rows[r, i, k] += off / 3.0


@kernel
def _mean_dilatation(coordinates, values, slopes, weights, n, d, c, plane, gradient, mean):
    """Mean over an element of the rows of its dilatation (c, n)."""
    volume = 0.0
    for i in range(c):
        for k in range(n):
            mean[i, k] = 0.0
    for g in range(len(weights)):
        dv = weights[g] * gradients(coordinates, slopes, g, n, d, gradient)
        radius = 1.0
        if plane == ROUND:
            radius = 0.0
            for k in range(n):
                radius += values[g, k] * coordinates[k, 0]
            dv *= radius
        volume += dv
        for i in range(c):
            for k in range(n):
                mean[i, k] += dv * gradient[i, k]
        if plane == ROUND:
            for k in range(n):
                mean[0, k] += dv * values[g, k] / radius
    for i in range(c):
        for k in range(n):
            mean[i, k] /= volume


@kernel
def _deformation(gradient, values, g, n, d, plane, radius, u, deformation):
    """F = 1 + grad u of one element's displacements (n, 3)."""
    for i in range(3):
        for j in range(3):
            deformation[i, j] = 1.0 if i == j else 0.0
    for k in range(n):
        for i in range(d):
            for j in range(d):
                deformation[i, j] += u[k, i] * gradient[j, k]
        if plane == ROUND:
            deformation[2, 2] += values[g, k] * u[k, 0] / radius


@kernel
def _green(f, strain):
    """Green's strain of F, tensor components."""
    for row in range(6):
        i = row if row < 3 else (0 if row == 3 else 1 if row == 4 else 2)
        j = row if row < 3 else (1 if row == 3 else 2 if row == 4 else 0)
        total = -1.0 if i == j else 0.0
        for k in range(3):
            total += f[k, i] * f[k, j]
        strain[row] = 0.5 * total


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
    green, green_before = np.empty(6), np.empty(6)
    average = np.empty((3, n))
    extra, natural = np.empty((6, 9)), np.empty((3, 3))
    for q in range(e):
        for k in range(n):
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
                own[k, i] = u[nodes[q, k], i]
                old[k, i] = before[nodes[q, k], i]
        if mean is not None:
            _mean_dilatation(coordinates, values, slopes, weights, n, d, c, plane, gradient, average)
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
                _deformation(gradient, values, g, n, d, plane, radius, own, now)
                _deformation(gradient, values, g, n, d, plane, radius, old, then)
                _green(now, green)
                _green(then, green_before)
                for r in range(6):
                    strain[at, r] = green[r] - green_before[r]
            else:
                if mean is not None:
                    _rows(gradient, values, g, n, c, plane, radius, None, average, rows)
                else:
                    _rows(gradient, values, g, n, c, plane, radius, None, None, rows)
                for r in range(6):
                    total = 0.0
                    for i in range(c):
                        for k in range(n):
                            total += rows[r, i, k] * (own[k, i] - old[k, i])
                    strain[at, r] = total if r < 3 else 0.5 * total
            if modes is not None:
                _enhanced(coordinates, centre, points, modes, g, n, d, det, natural, extra)
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
    size = 9
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
            _mean_dilatation(coordinates, values, slopes, weights, n, d, c, plane, gradient, average)
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
                _deformation(gradient, values, g, n, d, plane, radius, own, f)
                _rows(gradient, values, g, n, c, plane, radius, f, None, rows)
            elif mean is not None:
                _rows(gradient, values, g, n, c, plane, radius, None, average, rows)
            else:
                _rows(gradient, values, g, n, c, plane, radius, None, None, rows)
            for i in range(c):
                for r in range(6):
                    factor = dv * stress[at, r]
                    for k in range(n):
                        forces[q, i, k] += rows[r, i, k] * factor
            if modes is not None:
                _enhanced(coordinates, centre, points, modes, g, n, d, det, natural, extra)
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
                _geometric(gradient, values, g, n, c, d, plane, radius, stress, at, dv, matrix, q)
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
def _geometric(gradient, values, g, n, c, d, plane, radius, stress, at, dv, matrix, q):
    for k in range(n):
        for l in range(n):
            x = stress[at, 0] * gradient[0, l] + stress[at, 3] * gradient[1, l]
            y = stress[at, 3] * gradient[0, l] + stress[at, 1] * gradient[1, l]
            value = gradient[0, k] * x + gradient[1, k] * y
            if d == 3:
                value = gradient[0, k] * (x + stress[at, 5] * gradient[2, l])
                value += gradient[1, k] * (y + stress[at, 4] * gradient[2, l])
                z = stress[at, 5] * gradient[0, l] + stress[at, 4] * gradient[1, l] + stress[at, 2] * gradient[2, l]
                value += gradient[2, k] * z
            for i in range(c):
                matrix[q, i, i, k, l] += dv * value
            if plane == ROUND:
                matrix[q, 0, 0, k, l] += dv * stress[at, 2] * values[g, k] * values[g, l] / (radius * radius)


@kernel
def condense(inner, residual, mixed, back, modes, c, n, q, matrix, forces, answer, rest):
    """Gauss elimination of the enhanced parameters; pivots stand on the diagonal, as stiffness is."""
    for m in range(modes):
        rest[q, m] = residual[m]
        for i in range(c):
            for k in range(n):
                answer[q, m, i, k] = mixed[m, i, k]
    for p in range(modes):
        pivot = 1.0 / inner[p, p]
        for m in range(p + 1, modes):
            factor = inner[m, p] * pivot
            for o in range(p, modes):
                inner[m, o] -= factor * inner[p, o]
            rest[q, m] -= factor * rest[q, p]
            for i in range(c):
                for k in range(n):
                    answer[q, m, i, k] -= factor * answer[q, p, i, k]
    for p in range(modes - 1, -1, -1):
        pivot = 1.0 / inner[p, p]
        for o in range(p + 1, modes):
            rest[q, p] -= inner[p, o] * rest[q, o]
            for i in range(c):
                for k in range(n):
                    answer[q, p, i, k] -= inner[p, o] * answer[q, o, i, k]
        rest[q, p] *= pivot
        for i in range(c):
            for k in range(n):
                answer[q, p, i, k] *= pivot
    for i in range(c):
        for k in range(n):
            for m in range(modes):
                factor = back[m, i, k]
                forces[q, i, k] -= factor * rest[q, m]
                for j in range(c):
                    for l in range(n):
                        matrix[q, i, j, k, l] -= factor * answer[q, m, j, l]


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
