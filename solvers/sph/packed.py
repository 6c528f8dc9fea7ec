"""What the pair loops read of a neighbour, packed into its row of a table: a cache line (see `gather`).

Packed anew before each of the two loops, of all that may stand in a list: particles, images, the dummy.

    motion, in the plane: x y u v volume h           in space: x y z u v w volume h
    forces, in the plane: x y weight h, 3 or 4 of s  in space: x y, 6 of s; z stays where it is
    beside, in space, where one of them is there: weight h, the other 3 of s
"""

from __future__ import annotations

from ..jit import kernel

STRESS = 2  # where s begins in space
STRESS_PLANE = 4
REST = 2  # where the rest of it begins


@kernel
def pack_motion(i0, i1, solid, x, y, z, u, v, w, volume, h, packed):
    """Of the entries i0..i1. solid: None in the plane; h: None where all are equal."""
    for i in range(i0, i1):
        packed[i, 0] = x[i]
        packed[i, 1] = y[i]
        if solid is not None:
            packed[i, 2] = z[i]
            packed[i, 3] = u[i]
            packed[i, 4] = v[i]
            packed[i, 5] = w[i]
            packed[i, 6] = volume[i]
            if h is not None:
                packed[i, 7] = h[i]
        else:
            packed[i, 2] = u[i]
            packed[i, 3] = v[i]
            packed[i, 4] = volume[i]
            if h is not None:
                packed[i, 5] = h[i]


@kernel
def pack_forces(i0, i1, z, x, y, s, weight, h, corrected, packed, beside):
    """Of the entries i0..i1. z: None in the plane; weight, h: None where all are equal; corrected: as in `pairs`."""
    for i in range(i0, i1):
        packed[i, 0] = x[i]
        packed[i, 1] = y[i]
        if z is not None:
            for c in range(6):
                packed[i, STRESS + c] = s[c, i]
            if weight is not None:
                beside[i, 0] = weight[i]
            if h is not None:
                beside[i, 1] = h[i]
            if corrected is not None:
                for c in range(3):
                    beside[i, REST + c] = s[6 + c, i]
        else:
            if weight is not None:
                packed[i, 2] = weight[i]
            if h is not None:
                packed[i, 3] = h[i]
            if corrected is not None:
                packed[i, 7] = s[3, i]
            for c in range(3):
                packed[i, STRESS_PLANE + c] = s[c, i]
