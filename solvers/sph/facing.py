"""Particles against the facets of a structure (`contact.facets`): push, Coulomb friction, and what the nodes receive.

A particle may touch several facets at once: of those it overlaps the deepest counts, and each further one whose normal
is another and whose nearest point rises above the tangent planes of those before, as in a corner. Facets of one smooth
surface are one contact, wherever their edges are. Friction remembers two contacts of a particle by their normals. It
acts at the particle's centre, as if the facet reached there: what lies on a plate that turns goes round with it, and
the moment of the friction goes to the nodes.

What a facet feels goes to its nodes by the place of the contact: each pair keeps the impulses of its nodes (`surface`
adds them up).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..bundle import bundle
from ..contact.facets import facet_push, nearest_on_segment, nearest_on_triangle, normal_of_triangle
from ..contact.friction import FORGET, follow, rub
from ..jit import kernel
from .across import CLOSING, stable_step
from .leaning import lean

MOST = 3  # contacts of a particle at once
LOOKED_AT = 12  # facets that it may overlap
SAME = 0.85  # cosine between normals from which on two facets are one surface
RISE = 0.05  # of the radius, that an edge must rise above a tangent plane to be another contact
SLOTS = 2  # contacts that friction remembers
TINY = 1e-30


@bundle
class Faces(NamedTuple):
    """What the loops see. x, v: (3, m) of the nodes; motion: (2,) fastest node, way of it since the list was built.
    pace: (f,) speed of each facet's fastest node, None where nothing sleeps.

    stiff: (bodies,) squared wave speed; radius: (bodies,) in units of h; first, count, rows: the list; thrust, impulse:
    (pairs, nodes d) of each pair on its nodes.
    """

    x: Any
    v: Any
    motion: Any
    pace: Any
    corners: Any
    half: Any
    closed: Any
    static: float
    kinetic: float
    stiff: Any
    radius: Any
    first: Any
    count: Any
    rows: Any
    thrust: Any
    impulse: Any


def slip_rows(dimension: int) -> int:
    """Rows of a particle's friction: normal, elastic slip, how far it slid and the load, for each contact."""
    return SLOTS * (2 * max(2, dimension) + 2)


@kernel
def _nearest(faces, f, px, py, pz, z, out):
    """Of facet f and a point: weights (3), the way from it (3), distance, its outward normal (3), inside: out (11)."""
    x = faces.x
    a = faces.corners[f, 0]
    b = faces.corners[f, 1]
    if z is not None:
        c = faces.corners[f, 2]
        w0, w1, w2, inside = nearest_on_triangle(
            px, py, pz, x[0, a], x[1, a], x[2, a], x[0, b], x[1, b], x[2, b], x[0, c], x[1, c], x[2, c]
        )
        nx, ny, nz = normal_of_triangle(x[0, a], x[1, a], x[2, a], x[0, b], x[1, b], x[2, b], x[0, c], x[1, c], x[2, c])
        out[2] = w2
        dx = px - w0 * x[0, a] - w1 * x[0, b] - w2 * x[0, c]
        dy = py - w0 * x[1, a] - w1 * x[1, b] - w2 * x[1, c]
        dz = pz - w0 * x[2, a] - w1 * x[2, b] - w2 * x[2, c]
    else:
        w0, w1, inside = nearest_on_segment(px, py, x[0, a], x[1, a], x[0, b], x[1, b])
        sx = x[0, b] - x[0, a]
        sy = x[1, b] - x[1, a]
        size = math.sqrt(sx * sx + sy * sy)
        nx = sy / size
        ny = -sx / size
        nz = 0.0
        out[2] = 0.0
        dx = px - w0 * x[0, a] - w1 * x[0, b]
        dy = py - w0 * x[1, a] - w1 * x[1, b]
        dz = 0.0
    out[0] = w0
    out[1] = w1
    side = dx * nx + dy * ny + dz * nz
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    if inside or distance < TINY:
        sign = 1.0 if faces.closed[f] or side >= 0.0 else -1.0
        out[3] = sign * side
        out[4] = sign * nx
        out[5] = sign * ny
        out[6] = sign * nz
    else:
        out[3] = distance if side >= 0.0 or not faces.closed[f] else np.inf  # behind the edge of a solid
        out[4] = dx / distance
        out[5] = dy / distance
        out[6] = dz / distance
    out[7] = px - dx
    out[8] = py - dy
    out[9] = pz - dz
    out[10] = 1.0 if inside else 0.0


@kernel
def _slopes(faces, f, z, out):
    """Slopes (nodes, 3) of a facet's shape functions along it."""
    x = faces.x
    a = faces.corners[f, 0]
    b = faces.corners[f, 1]
    if z is None:
        sx = x[0, b] - x[0, a]
        sy = x[1, b] - x[1, a]
        square = sx * sx + sy * sy
        out[1, 0] = sx / square
        out[1, 1] = sy / square
        out[1, 2] = 0.0
        for k in range(3):
            out[0, k] = -out[1, k]
        return
    c = faces.corners[f, 2]
    ux, uy, uz = x[0, b] - x[0, a], x[1, b] - x[1, a], x[2, b] - x[2, a]
    vx, vy, vz = x[0, c] - x[0, a], x[1, c] - x[1, a], x[2, c] - x[2, a]
    uu = ux * ux + uy * uy + uz * uz
    uv = ux * vx + uy * vy + uz * vz
    vv = vx * vx + vy * vy + vz * vz
    inverse = 1.0 / (uu * vv - uv * uv)
    out[1, 0] = (vv * ux - uv * vx) * inverse
    out[1, 1] = (vv * uy - uv * vy) * inverse
    out[1, 2] = (vv * uz - uv * vz) * inverse
    out[2, 0] = (uu * vx - uv * ux) * inverse
    out[2, 1] = (uu * vy - uv * uy) * inverse
    out[2, 2] = (uu * vz - uv * uz) * inverse
    for k in range(3):
        out[0, k] = -out[1, k] - out[2, k]


@kernel
def _contacts(faces, i, px, py, pz, z, radius, found, order, chosen):
    """The pairs of particle i that count into chosen (MOST), as rows of `found` (LOOKED_AT + 1, 13); returns how many.

    found: see `_nearest`, then the overlap and the pair.
    """
    m = 0
    spare = 0  # the row that the next facet goes to
    for k in range(faces.first[i], faces.first[i] + faces.count[i]):
        f = faces.rows[k]
        row = found[spare]
        _nearest(faces, f, px, py, pz, z, row)
        overlap = radius + faces.half[f] - row[3]
        row[11] = overlap
        row[12] = k
        if overlap <= 0.0 or (m == LOOKED_AT and overlap <= found[order[m - 1], 11]):
            continue
        if faces.closed[f] and overlap >= 2.0 * radius:  # the other side of a solid that is thinner than the particle
            continue
        used = spare
        if m < LOOKED_AT:
            m += 1
            spare = m
        else:
            spare = order[m - 1]
        at = m - 1
        while at > 0 and found[order[at - 1], 11] < overlap:
            order[at] = order[at - 1]
            at -= 1
        order[at] = used
    count = 0
    for r in range(m):
        row = found[order[r]]
        wanted = True
        for a in range(count):
            other = found[chosen[a]]
            if row[4] * other[4] + row[5] * other[5] + row[6] * other[6] > SAME:
                wanted = False
            rise = (row[7] - other[7]) * other[4] + (row[8] - other[8]) * other[5] + (row[9] - other[9]) * other[6]
            if row[10] == 0.0 and rise <= RISE * radius:
                wanted = False
        if wanted:
            chosen[count] = order[r]
            count += 1
            if count == MOST:
                break
    return count


@kernel
def _slot(slip, i, d, nx, ny, nz, taken):
    """The rows of the contact that had this normal in the step before, or of one that is free."""
    size = 2 * d + 2
    best = -1
    likeness = 0.5
    for s in range(SLOTS):
        row = s * size
        like = slip[row, i] * nx + slip[row + 1, i] * ny
        if d == 3:
            like += slip[row + 2, i] * nz
        if not taken[s] and like > likeness:
            best = s
            likeness = like
    if best < 0:
        for s in range(SLOTS):
            if not taken[s] and best < 0:
                best = s
                slip[s * size : s * size + size - 1, i] = 0.0
    return best


@kernel
def face_force(i0, i1, z, faces, law, damping, slip, heat, resting, dt, cx, arrays):
    """Adds the facets' forces to a range of particles and keeps what their nodes feel; returns the stable step.

    law: None where cx does not yet hold what other bodies and planes do. slip: None without friction, or rows as
    `slip_rows`. resting: None where nothing sleeps; a sleeper's friction keeps its load.
    """
    u, v = arrays.u, arrays.v
    least = np.inf
    d = 3 if z is not None else 2
    found = np.empty((LOOKED_AT + 1, 13))
    order = np.empty(LOOKED_AT, np.int64)
    chosen = np.empty(MOST, np.int64)
    taken = np.empty(SLOTS, np.bool_)
    slopes = np.empty((3, 3))
    couples = np.empty(3)
    size = 2 * d + 2
    for i in range(i0, i1):
        a0 = 0.0
        a1 = 0.0
        a2 = 0.0
        count = 0
        begin = faces.first[i]
        if faces.count[i] > 0:
            b = arrays.material[i]
            radius = faces.radius[b] * arrays.h[i]
            mass = arrays.mass[i]
            wave = math.sqrt(faces.stiff[b])
            k = faces.stiff[b] * mass / (4.0 * radius * radius)
            for pair in range(begin, begin + faces.count[i]):
                for c in range(d * d):
                    faces.thrust[pair, c] = 0.0
            pz = 0.0
            if z is not None:
                pz = z[i]
            count = _contacts(faces, i, arrays.x[i], arrays.y[i], pz, z, radius, found, order, chosen)
            for s in range(SLOTS):
                taken[s] = False
            total = 0.0
            for c in range(count):
                row = found[chosen[c]]
                pair = int(row[12])
                f = faces.rows[pair]
                nx = row[4]
                ny = row[5]
                nz = row[6]
                most = radius + faces.half[f] if not faces.closed[f] else 2.0 * radius
                overlap = row[11]
                force, stiffness = facet_push(overlap, radius, most, k)
                sx = u[i]
                sy = v[i]
                sz = 0.0
                if z is not None:
                    sz = arrays.w[i]
                for q in range(d):
                    node = faces.corners[f, q]
                    sx -= row[q] * faces.v[0, node]
                    sy -= row[q] * faces.v[1, node]
                    sz -= row[q] * faces.v[2, node]
                along = sx * nx + sy * ny + sz * nz
                if along < 0.0:
                    least = min(least, CLOSING * max(most - overlap, (1.0 - 0.999) * most) / -along)
                if damping is not None:
                    more = max(-force, -2.0 * damping * math.sqrt(stiffness * mass) * along)
                    force += more
                    heat[i] -= more * along * dt
                total += stiffness
                fx = force * nx
                fy = force * ny
                fz = force * nz
                arm = 0.0
                if slip is not None:
                    if row[10] > 0.0:  # a facet that turns takes along what it holds at a distance
                        arm = row[3]
                        _slopes(faces, f, z, slopes)
                        for q in range(d):
                            node = faces.corners[f, q]
                            rise = faces.v[0, node] * nx + faces.v[1, node] * ny + faces.v[2, node] * nz
                            sx += arm * slopes[q, 0] * rise
                            sy += arm * slopes[q, 1] * rise
                            sz += arm * slopes[q, 2] * rise
                    s = _slot(slip, i, d, nx, ny, nz, taken)
                    if s >= 0:
                        taken[s] = True
                        at = s * size
                        slip[at, i] = nx
                        slip[at + 1, i] = ny
                        ez = 0.0
                        if z is not None:
                            slip[at + 2, i] = nz
                            ez = slip[at + 5, i]
                        ex = slip[at + d, i]
                        ey = slip[at + d + 1, i]
                        out = ex * nx + ey * ny + ez * nz  # the surface may turn under the particle
                        ex -= out * nx
                        ey -= out * ny
                        ez -= out * nz
                        load = slip[at + size - 1, i]
                        if resting is None or arrays.still[i] == 0.0:
                            load = follow(load, force, dt, wave, arrays.h[i])
                        slip[at + size - 1, i] = load
                        tx, ty, tz, ex, ey, ez, slid, lost = rub(
                            ex, ey, ez, sx - along * nx, sy - along * ny, sz - along * nz, dt, load, force, k, mass,
                            arrays.h[i], faces.static, faces.kinetic, slip[at + size - 2, i],
                        )  # fmt: skip
                        slip[at + d, i] = ex
                        slip[at + d + 1, i] = ey
                        if z is not None:
                            slip[at + 5, i] = ez
                        slip[at + size - 2, i] = slid
                        heat[i] += lost
                        fx -= tx
                        fy -= ty
                        fz -= tz
                        for q in range(d):  # and bears its moment
                            couples[q] = arm * (slopes[q, 0] * tx + slopes[q, 1] * ty + slopes[q, 2] * tz)
                    else:
                        arm = 0.0
                a0 += fx
                a1 += fy
                a2 += fz
                for q in range(d):
                    couple = couples[q] if arm != 0.0 else 0.0
                    faces.thrust[pair, d * q] = -row[q] * fx - couple * nx
                    faces.thrust[pair, d * q + 1] = -row[q] * fy - couple * ny
                    if z is not None:
                        faces.thrust[pair, d * q + 2] = -row[q] * fz - couple * nz
            if slip is not None:
                for s in range(SLOTS):
                    if not taken[s]:
                        at = s * size
                        slip[at + d : at + 2 * d, i] = 0.0
                        slip[at + size - 1, i] = follow(slip[at + size - 1, i], 0.0, dt, FORGET * wave, arrays.h[i])
            if total > 0.0:
                least = min(least, stable_step(mass, total, damping))
            if resting is not None and arrays.still[i] != 0.0 and count > 0:
                row = found[chosen[0]]
                lean(i, int(row[12]), row, a0, a1, a2, faces, arrays.bears)
            a0 /= mass
            a1 /= mass
            a2 /= mass
        if law is None:
            cx[i] = 0.0
            arrays.cy[i] = 0.0
            if z is not None:
                arrays.cz[i] = 0.0
        if count > 0:
            cx[i] += a0
            arrays.cy[i] += a1
            arrays.ax[i] += a0
            arrays.ay[i] += a1
            if z is not None:
                arrays.cz[i] += a2
                arrays.az[i] += a2
    return least


@kernel
def add_impulse(i0, i1, duration, faces):
    """Thrust for a duration, of the pairs of a range of particles."""
    for i in range(i0, i1):
        for pair in range(faces.first[i], faces.first[i] + faces.count[i]):
            for c in range(faces.thrust.shape[1]):
                faces.impulse[pair, c] += duration * faces.thrust[pair, c]


@kernel
def move(thread, threads, dt, faces):
    """The nodes go on at their velocities, each thread its share."""
    m = faces.x.shape[1]
    for node in range(m * thread // threads, m * (thread + 1) // threads):
        for axis in range(3):
            faces.x[axis, node] += faces.v[axis, node] * dt
