"""What a solid or plane element is at one integration point: gradients, strains by displacement, enhanced strains.

Strains are of one of three kinds: small (at the first shape), Green's (total Lagrangian, at the first shape with the
deformation gradient), or small increments at the present shape (updated Lagrangian). An element may have enhanced
strains (Simo & Rifai 1990; with Green's strain: Klinkel & Wagner 1997) or the mean dilatation (Hughes 1980), where it
would lock. Arguments that are None are pruned when compiled.
"""

from __future__ import annotations

import numpy as np

from ...jit import kernel

SOLID, FLAT, ROUND = 0, 1, 2  # solid; plane strain or stress; axisymmetric: x is the radius, forces are per radian
MOST_MODES = 12


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
    i01, i11, i21 = (
        (j02 * j21 - j01 * j22) * inverse,
        (j00 * j22 - j02 * j20) * inverse,
        (j01 * j20 - j00 * j21) * inverse,
    )
    i02, i12, i22 = (
        (j01 * j12 - j02 * j11) * inverse,
        (j02 * j10 - j00 * j12) * inverse,
        (j00 * j11 - j01 * j10) * inverse,
    )
    for k in range(n):
        r, s, t = slopes[g, k, 0], slopes[g, k, 1], slopes[g, k, 2]
        gradient[0, k] = r * i00 + s * i10 + t * i20
        gradient[1, k] = r * i01 + s * i11 + t * i21
        gradient[2, k] = r * i02 + s * i12 + t * i22
    return det


@kernel
def enhanced(coordinates, centre, points, modes, g, n, d, det, natural, enhanced):
    """Enhanced strain rows (6, modes) at point g: natural modes, mapped by the Jacobian at the centre.

    centre: slopes at the centre (1, n, d). Modes: r in rr, s in ss, (t in tt,) r and s in rs, and so on; after those 9
    of hexahedra three bilinear ones of the dilatation (Korelc & Wriggers 1996: 12). natural: (3, 3) scratch.
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
            elif m == 9:
                value = r * s
            elif m == 10:
                value = s * t
            elif m == 11:
                value = t * r
        natural[a, b] = value
        natural[b, a] = value
        if m > 8:
            natural[1, 1] = value
            natural[2, 2] = value
        for row in range(6):
            i = row if row < 3 else (0 if row == 3 else 1 if row == 4 else 2)
            j = row if row < 3 else (1 if row == 3 else 2 if row == 4 else 0)
            total = 0.0
            for p in range(3):
                for q in range(3):
                    total += inverse[p, i] * inverse[q, j] * natural[p, q]
            enhanced[row, m] = scale * total * (1.0 if row < 3 else 2.0)


@kernel
def strain_rows(gradient, values, g, n, c, plane, radius, deformation, mean, rows):
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
def mean_dilatation(coordinates, values, slopes, weights, n, d, c, plane, gradient, mean):
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
def deformation(gradient, values, g, n, d, plane, radius, u, deformation):
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
def green(f, strain):
    """Green's strain of F, tensor components."""
    for row in range(6):
        i = row if row < 3 else (0 if row == 3 else 1 if row == 4 else 2)
        j = row if row < 3 else (1 if row == 3 else 2 if row == 4 else 0)
        total = -1.0 if i == j else 0.0
        for k in range(3):
            total += f[k, i] * f[k, j]
        strain[row] = 0.5 * total


@kernel
def geometric_stiffness(gradient, values, g, n, c, d, plane, radius, stress, at, dv, matrix, q):
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
