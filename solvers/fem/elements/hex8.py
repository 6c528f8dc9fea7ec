"""The plain eight-node hexahedron's loops at small strains: most large meshes are made of it.

They give what `continuum_loops` gives, three times as fast: all sizes are known when compiled.
"""

from __future__ import annotations

import numpy as np

from ...jit import kernel
from .continuum import gradients

N = 8


@kernel
def integrate(nodes, x, slopes, weights, stress, modulus, matrix, forces):
    """Forces (e, 3, 8) of stresses (e g, 6), and the stiffness (e, 3, 3, 8, 8) of moduli (e g, 6, 6), or None."""
    coordinates, gradient = np.empty((N, 3)), np.empty((3, N))
    s = np.empty((6, 3 * N))
    block = np.empty((3, N, 3 * N))
    for q in range(nodes.shape[0]):
        for k in range(N):
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
                forces[q, i, k] = 0.0
        if matrix is not None:
            block[:] = 0.0
        for g in range(len(weights)):
            dv = weights[g] * gradients(coordinates, slopes, g, N, 3, gradient)
            at = q * len(weights) + g
            xx, yy, zz = dv * stress[at, 0], dv * stress[at, 1], dv * stress[at, 2]
            xy, yz, zx = dv * stress[at, 3], dv * stress[at, 4], dv * stress[at, 5]
            for k in range(N):
                forces[q, 0, k] += xx * gradient[0, k] + xy * gradient[1, k] + zx * gradient[2, k]
                forces[q, 1, k] += xy * gradient[0, k] + yy * gradient[1, k] + yz * gradient[2, k]
                forces[q, 2, k] += zx * gradient[0, k] + yz * gradient[1, k] + zz * gradient[2, k]
            if matrix is None:
                continue
            for r in range(6):
                a, b, c = dv * modulus[at, r, 0], dv * modulus[at, r, 1], dv * modulus[at, r, 2]
                d, e, f = dv * modulus[at, r, 3], dv * modulus[at, r, 4], dv * modulus[at, r, 5]
                for l in range(N):
                    u, v, w = gradient[0, l], gradient[1, l], gradient[2, l]
                    s[r, l] = a * u + d * v + f * w
                    s[r, N + l] = b * v + d * u + e * w
                    s[r, 2 * N + l] = c * w + e * v + f * u
            for k in range(N):
                u, v, w = gradient[0, k], gradient[1, k], gradient[2, k]
                for m in range(3 * N):
                    block[0, k, m] += u * s[0, m] + v * s[3, m] + w * s[5, m]
                    block[1, k, m] += v * s[1, m] + u * s[3, m] + w * s[4, m]
                    block[2, k, m] += w * s[2, m] + v * s[4, m] + u * s[5, m]
        if matrix is None:
            continue
        for i in range(3):
            for j in range(3):
                for k in range(N):
                    for l in range(N):
                        matrix[q, i, j, k, l] = block[i, k, j * N + l]


@kernel
def strains(nodes, x, u, before, slopes, strain, smallest):
    """Strain increments (e g, 6), tensor components; smallest: (e,) least determinant of the Jacobian."""
    coordinates, gradient, step = np.empty((N, 3)), np.empty((3, N)), np.empty((3, N))
    rate = np.empty((3, 3))
    many = slopes.shape[0]
    for q in range(nodes.shape[0]):
        for k in range(N):
            for i in range(3):
                coordinates[k, i] = x[nodes[q, k], i]
                step[i, k] = u[nodes[q, k], i] - before[nodes[q, k], i]
        least = np.inf
        for g in range(many):
            det = gradients(coordinates, slopes, g, N, 3, gradient)
            least = min(least, det)
            for i in range(3):
                for j in range(3):
                    total = 0.0
                    for k in range(N):
                        total += step[i, k] * gradient[j, k]
                    rate[i, j] = total
            at = q * many + g
            strain[at, 0] = rate[0, 0]
            strain[at, 1] = rate[1, 1]
            strain[at, 2] = rate[2, 2]
            strain[at, 3] = 0.5 * (rate[0, 1] + rate[1, 0])
            strain[at, 4] = 0.5 * (rate[1, 2] + rate[2, 1])
            strain[at, 5] = 0.5 * (rate[2, 0] + rate[0, 2])
        smallest[q] = least
