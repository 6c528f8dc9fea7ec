"""Bodies of revolution: x is the distance r from the axis, y runs along it, a particle is a ring.

The radial strain is by r u, so that a state of equal pressure is in balance up to the axis; the force is the transpose
of the strain, so that its work is that of the strain and no pair makes momentum along the axis. With the area of a
ring's section A = m/(2 pi r rho) in place of the plane's volume, sums over the neighbours and their images across the
axis (Petschek & Libersky 1993 have the radial row, hoop stress and images; the axial row's weights are as Brookshaw's,
2003):

    e_rr = (1/r_i) sum A_j (r_j u_j - r_i u_i) dW/dr - u_i/r_i    du/dz = (1/r_i) sum A_j (r_j u_j - r_i u_i) dW/dz
    grad v = sum A_j (v_j - v_i) grad W                           e_tt = u_i/r_i
    a_r = (1/rho_i) sum A_j (sigma_i + sigma_j)_r. grad W + (sigma_rr - sigma_tt)_i / (rho_i r_i)
    a_z = (1/(rho_i r_i)) sum A_j (r_i sigma_i + r_j sigma_j)_z. grad W

`pairs` does the sums, with r u for u, with r sigma in the axial row of s, and A for the volume. m is of the whole ring.
"""

from __future__ import annotations

import math

import numpy as np

from ..jit import kernel
from .ghosts import SYMMETRY, Plane

AXIS = Plane(0, -1, SYMMETRY, 0.0)  # what every such problem has among its planes
TURN = 2.0 * math.pi
NO_FORCE = np.zeros(3)


@kernel
def flow(i0, i1, hoop, arrays):
    """hoop = r u half a step back; of an image as of its source, since both r and u turn."""
    for i in range(i0, i1):
        hoop[i] = arrays.x_half[i] * arrays.u[i]


@kernel
def radial_strain(i0, i1, arrays):
    """Makes the radial row of the gradient of what `pairs` made of r u."""
    gradient = arrays.gradient
    for i in range(i0, i1):
        inverse = 1.0 / arrays.x_half[i]
        gradient[0, i] = (gradient[0, i] - arrays.u[i]) * inverse
        gradient[1, i] *= inverse


@kernel
def areas(i0, i1, arrays):
    """Of the rings' sections, as the volumes of the plane."""
    for i in range(i0, i1):
        arrays.volume[i] = arrays.mass[i] / (TURN * arrays.x[i] * arrays.density[i])


@kernel
def hoop_force(i0, i1, body, arrays):
    """Ends what `pairs` began: hoop stress, the axial row's radius, the body force."""
    stress = arrays.stress
    for i in range(i0, i1):
        inverse = 1.0 / arrays.x[i]
        arrays.ax[i] += (stress[0, i] - stress[2, i]) / arrays.density[i] * inverse + body[0]
        arrays.ay[i] = arrays.ay[i] * inverse + body[1]


@kernel
def closest(i0, i1, length, arrays):
    """The time in which a particle of the block goes a share of its way to the axis."""
    least = np.inf
    for i in range(i0, i1):
        if arrays.u[i] < 0.0:
            least = min(least, -length * arrays.x[i] / arrays.u[i])
    return least
