"""Contact of a ball with a facet: a triangle, or a segment in the plane. It knows two geometries and no solver.

A ball of radius R around p and a facet with half a thickness t: d is the distance of p from the nearest point c of the
facet, the overlap R + t - d. A shell is pushed from both sides and its edges are round; a facet that bounds a solid
pushes outwards alone. The push is that of a plane (`plane`), F = k p (1 + (p/R)^2), over 1 - (p/q)^2: no force brings p
past q, the way to the middle of a shell or, into a solid, the ball's diameter.

Source of the nearest point: Ericson, Real-Time Collision Detection (2005), 5.1.5.
"""

from __future__ import annotations

import math

from ..jit import kernel
from .plane import wall_push

NEARLY = 0.999  # of the way to the middle: where an overlap is cut


@kernel
def nearest_on_segment(px, py, ax, ay, bx, by):
    """Weights (2) of the ends at the point nearest to p, and whether it lies within."""
    sx = bx - ax
    sy = by - ay
    along = ((px - ax) * sx + (py - ay) * sy) / (sx * sx + sy * sy)
    inside = 0.0 < along < 1.0
    along = min(max(along, 0.0), 1.0)
    return 1.0 - along, along, inside


@kernel
def nearest_on_triangle(px, py, pz, ax, ay, az, bx, by, bz, cx, cy, cz):
    """Weights (3) of the corners at the point nearest to p, and whether it lies within."""
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    wx, wy, wz = px - ax, py - ay, pz - az
    d1 = ux * wx + uy * wy + uz * wz
    d2 = vx * wx + vy * wy + vz * wz
    if d1 <= 0.0 and d2 <= 0.0:
        return 1.0, 0.0, 0.0, False
    wx, wy, wz = px - bx, py - by, pz - bz
    d3 = ux * wx + uy * wy + uz * wz
    d4 = vx * wx + vy * wy + vz * wz
    if d3 >= 0.0 and d4 <= d3:
        return 0.0, 1.0, 0.0, False
    third = d1 * d4 - d3 * d2
    if third <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        along = d1 / (d1 - d3)
        return 1.0 - along, along, 0.0, False
    wx, wy, wz = px - cx, py - cy, pz - cz
    d5 = ux * wx + uy * wy + uz * wz
    d6 = vx * wx + vy * wy + vz * wz
    if d6 >= 0.0 and d5 <= d6:
        return 0.0, 0.0, 1.0, False
    second = d5 * d2 - d1 * d6
    if second <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        along = d2 / (d2 - d6)
        return 1.0 - along, 0.0, along, False
    first = d3 * d6 - d5 * d4
    if first <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        along = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return 0.0, 1.0 - along, along, False
    whole = first + second + third
    return first / whole, second / whole, third / whole, True


@kernel
def facet_push(overlap, radius, most, k):
    """(force, stiffness) of an overlap that cannot pass `most`."""
    p = min(overlap, NEARLY * most)
    force, stiffness = wall_push(p, radius, k)
    s = p / most
    barrier = 1.0 / (1.0 - s * s)
    return force * barrier, stiffness * barrier + force * 2.0 * s / most * barrier * barrier


@kernel
def normal_of_triangle(ax, ay, az, bx, by, bz, cx, cy, cz):
    """Unit normal (3), right-handed."""
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    nx = uy * vz - uz * vy
    ny = uz * vx - ux * vz
    nz = ux * vy - uy * vx
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    return nx / size, ny / size, nz / size
