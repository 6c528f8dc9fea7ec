"""What the pair loops read of a neighbour, packed into its row of a table: a cache line (see `gather`).

Packed anew before each of the loops, of all that may stand in a list: particles, images, the dummy.

    motion, in the plane: x y u v volume h           in space: x y z u v w volume h
    smoothing: as motion, with the density in place of the volume
    forces, in the plane: x y weight h, 3 or 4 of s  in space: x y, 6 of s; z stays where it is
    beside, in space, where one of them is there: weight h, the other 3 of s
"""

from __future__ import annotations

from ..jit import kernel
from ..threads import barrier, share

STRESS = 2  # where s begins in space
STRESS_PLANE = 4
REST = 2  # where the rest of it begins


@kernel
def motion_of(line, solid):
    """x y z u v w volume h, those of z None in the plane. line: a row of the table, or the columns of a buffer."""
    if solid is not None:
        return line[0], line[1], line[2], line[3], line[4], line[5], line[6], line[7]
    return line[0], line[1], None, line[2], line[3], None, line[4], line[5]


@kernel
def weight_of(line, more, solid):
    """Weight and h. line, more: columns of buffers for the two tables."""
    if solid is not None:
        return more[0], more[1]
    return line[2], line[3]


@kernel
def stress_of(line, more, solid, corrected):
    """s row by row: xx xy xz yx yy yz zx zy zz, those of z None in the plane. line, more: as in both of the above."""
    if solid is not None:
        if corrected is not None:
            return line[2], line[3], line[4], line[5], line[6], line[7], more[2], more[3], more[4]
        return line[2], line[5], line[7], line[5], line[3], line[6], line[7], line[6], line[4]
    if corrected is not None:
        return line[4], line[5], None, line[6], line[7], None, None, None, None
    return line[4], line[6], None, line[6], line[5], None, None, None, None


@kernel
def _pack(thread, threads, sync, start, solid, h, x, y, z, u, v, w, weight, packed):
    """Lines of motion, of all entries from `start` on. The threads meet after it."""
    a, b = share(len(x) - start, thread, threads)
    for i in range(start + a, start + b):
        packed[i, 0] = x[i]
        packed[i, 1] = y[i]
        if solid is not None:
            packed[i, 2] = z[i]
            packed[i, 3] = u[i]
            packed[i, 4] = v[i]
            packed[i, 5] = w[i]
            packed[i, 6] = weight[i]
            if h is not None:
                packed[i, 7] = h[i]
        else:
            packed[i, 2] = u[i]
            packed[i, 3] = v[i]
            packed[i, 4] = weight[i]
            if h is not None:
                packed[i, 5] = h[i]
    barrier(sync, threads)


@kernel
def pack_motion(thread, threads, sync, start, solid, h, hoop, plain, arrays):
    """What `velocity_gradient` reads, of all entries from `start` on. The threads meet after it.

    solid: None in the plane; h: None where all are equal; hoop: None, or r u of rings; plain: None where no loop reads.
    """
    if plain is None:
        return
    u = arrays.u if hoop is None else hoop
    _pack(
        thread, threads, sync, start, solid, h, arrays.x_half, arrays.y_half, arrays.z_half, u, arrays.v, arrays.w,
        arrays.volume, arrays.packed,
    )  # fmt: skip


@kernel
def pack_smoothing(thread, threads, sync, solid, h, arrays):
    """What XSPH reads (`cures.smoothed_velocity`), of all entries. Arguments as above."""
    _pack(
        thread, threads, sync, 0, solid, h, arrays.x, arrays.y, arrays.z, arrays.u, arrays.v, arrays.w, arrays.density,
        arrays.packed,
    )  # fmt: skip


@kernel
def pack_forces(thread, threads, sync, start, z, h, mass, mixed, corrected, plain, arrays):
    """What `momentum` reads, of all entries from `start` on. The threads meet after it.

    z: None in the plane; mass, h: None where all are equal; mixed: None, or volumes weigh in place of masses;
    corrected: None, or s has all its components.
    """
    if plain is None:
        return
    weight = mass if mixed is None else arrays.volume
    packed, beside, s = arrays.packed, arrays.beside, arrays.s
    a, b = share(len(arrays.x) - start, thread, threads)
    for i in range(start + a, start + b):
        packed[i, 0] = arrays.x[i]
        packed[i, 1] = arrays.y[i]
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
    barrier(sync, threads)
