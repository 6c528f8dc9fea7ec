"""Boundary planes by images: a particle near a symmetry or periodic plane has one beyond it.

An image has the place sign * x + shift of its source; velocity and stress turn with the signs. At corners images have
images. They are made with each neighbour list, behind the particles in the same arrays, and follow their sources in
each step; nothing but the lists knows of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel
from .state import State

Floats = NDArray[np.float64]

NONE, SYMMETRY, PERIODIC, LIMIT = range(4)


@dataclass(frozen=True, slots=True)
class Plane:
    """A plane across an axis. axis: 0..2; side: -1 where the particles lie above it, 1 below; kind: as above."""

    axis: int
    side: int
    kind: int
    position: float


@kernel
def follow_motion(g0, g1, n, z, source, sign, shift, arrays):
    """Positions and velocities of the images g0..g1, which stand at n + g."""
    for g in range(g0, g1):
        i = source[g]
        arrays.x[n + g] = sign[0, g] * arrays.x[i] + shift[0, g]
        arrays.y[n + g] = sign[1, g] * arrays.y[i] + shift[1, g]
        arrays.x_half[n + g] = sign[0, g] * arrays.x_half[i] + shift[0, g]
        arrays.y_half[n + g] = sign[1, g] * arrays.y_half[i] + shift[1, g]
        arrays.u[n + g] = sign[0, g] * arrays.u[i]
        arrays.v[n + g] = sign[1, g] * arrays.v[i]
        if z is not None:
            z[n + g] = sign[2, g] * z[i] + shift[2, g]
            arrays.z_half[n + g] = sign[2, g] * arrays.z_half[i] + shift[2, g]
            arrays.w[n + g] = sign[2, g] * arrays.w[i]


@kernel
def follow_stress(g0, g1, n, z, corrected, source, sign, arrays):
    """Stress, density, volume and smoothing length of the images."""
    stress = arrays.stress
    s = arrays.s
    for g in range(g0, g1):
        i = source[g]
        xy = sign[0, g] * sign[1, g]
        yz = sign[1, g] * sign[2, g]
        zx = sign[2, g] * sign[0, g]
        j = n + g
        arrays.density[j] = arrays.density[i]
        arrays.volume[j] = arrays.volume[i]
        arrays.h[j] = arrays.h[i]
        for k in range(3):
            stress[k, j] = stress[k, i]
        stress[3, j] = xy * stress[3, i]
        s[0, j] = s[0, i]
        if z is not None:
            stress[4, j] = yz * stress[4, i]
            stress[5, j] = zx * stress[5, i]
        if corrected is not None:
            if z is not None:
                s[1, j] = xy * s[1, i]
                s[2, j] = zx * s[2, i]
                s[3, j] = xy * s[3, i]
                s[4, j] = s[4, i]
                s[5, j] = yz * s[5, i]
                s[6, j] = zx * s[6, i]
                s[7, j] = yz * s[7, i]
                s[8, j] = s[8, i]
            else:
                s[1, j] = xy * s[1, i]
                s[2, j] = xy * s[2, i]
                s[3, j] = s[3, i]
        else:
            s[1, j] = s[1, i]
            if z is not None:
                s[2, j] = s[2, i]
                s[3, j] = xy * s[3, i]
                s[4, j] = yz * s[4, i]
                s[5, j] = zx * s[5, i]
            else:
                s[2, j] = xy * s[2, i]


@dataclass(frozen=True, slots=True)
class Images:
    """source: (g,) particles, with memory for one more behind the last (see `cures._level`); sign, shift: (3, g)."""

    source: NDArray[np.int64]
    sign: Floats
    shift: Floats

    def __len__(self) -> int:
        return len(self.source)


def wrap(planes: tuple[Plane, ...], rows: list[Floats], n: int) -> None:
    """Bring particles that left a periodic box back into it. rows: for each axis (k, n) positions moved along."""
    for axis in range(len(rows)):
        low, high = _periodic(planes, axis)
        if low is None or high is None:
            continue
        length = high - low
        turns = np.floor((rows[axis][0, :n] - low) / length)
        if np.any(turns):
            rows[axis][:, :n] -= turns * length


def mirrors(planes: tuple[Plane, ...]) -> Floats | None:
    """(3, 2) coordinates of the symmetry planes below and above along each axis, infinite where there is none."""
    found = np.tile([-np.inf, np.inf], (3, 1))
    for plane in planes:
        if plane.kind == SYMMETRY:
            found[plane.axis, 0 if plane.side < 0 else 1] = plane.position
    return found if np.any(np.isfinite(found)) else None


def beyond_limit(planes: tuple[Plane, ...], x: Floats) -> NDArray[np.bool_]:
    """(n,) particles that left the problem. x: (d, n)."""
    out = np.zeros(x.shape[1], bool)
    for plane in planes:
        if plane.kind == LIMIT and plane.axis < len(x):
            out |= (x[plane.axis] - plane.position) * plane.side > 0.0
    return out


def images(planes: tuple[Plane, ...], x: Floats, reach: Any) -> Images:
    """The images of particles at x (d, n) nearer to a plane than reach (a number or (n,))."""
    d, n = x.shape
    place = x
    source = np.arange(n)
    sign = np.ones((3, n))
    shift = np.zeros((3, n))
    reach = np.broadcast_to(np.asarray(reach, dtype=float), (n,))
    for axis in range(d):
        added = []
        for plane in planes:
            if plane.axis != axis or plane.kind not in (SYMMETRY, PERIODIC):
                continue
            depth = (plane.position - place[axis]) * plane.side
            near = np.flatnonzero(depth < reach[source])
            s, t = sign[:, near].copy(), shift[:, near].copy()
            if plane.kind == SYMMETRY:
                s[axis] *= -1.0
                t[axis] = 2.0 * plane.position - t[axis]
            else:
                low, high = _periodic(planes, axis)
                assert low is not None
                assert high is not None
                t[axis] -= plane.side * (high - low)
            added.append((source[near], s, t))
        for src, s, t in added:
            source = np.concatenate((source, src))
            sign = np.concatenate((sign, s), axis=1)
            shift = np.concatenate((shift, t), axis=1)
        place = sign[:d] * x[:, source] + shift[:d]
    return Images(np.append(source[n:], 0)[:-1], np.ascontiguousarray(sign[:, n:]), np.ascontiguousarray(shift[:, n:]))


def _periodic(planes: tuple[Plane, ...], axis: int) -> tuple[float | None, float | None]:
    low = high = None
    for plane in planes:
        if plane.axis == axis and plane.kind == PERIODIC:
            if plane.side < 0:
                low = plane.position
            else:
                high = plane.position
    return low, high


def leave(s: State, planes: tuple[Plane, ...], live: int, last: float, threads: int) -> int:
    """Bring particles that left a periodic box back, and put those beyond a limit behind the others.

    Those keep the velocity that they left with. last: the step before. Returns how many are left of the `live` ones.
    """
    names = ("x", "x_half", "x_start")
    moving = [np.stack([s.rows(name)[axis] for name in names]) for axis in range(s.d)]
    wrap(planes, moving, live)
    for axis, moved in enumerate(moving):
        for name, values in zip(names, moved, strict=True):
            s.rows(name)[axis, :live] = values[:live]
    out = beyond_limit(planes, s.rows("x")[:, :live])
    if np.any(out):
        s.sort(np.concatenate((np.flatnonzero(~out), np.flatnonzero(out))), threads)
    left = live - int(np.count_nonzero(out))
    s.rows("u")[:, left:live] += 0.5 * last * s.rows("a")[:, left:live]
    s.rows("a")[:, left:live] = 0.0
    return left


def place_images(s: State, planes: tuple[Plane, ...], live: int, reach: float) -> Images:
    """Make the images of the particles near planes, with all that does not change until the next list."""
    found = images(planes, s.rows("x_list")[:, :live], reach)
    s.make_room(len(found))
    at = slice(s.n, s.n + len(found))
    for name in ("mass", "h", "h_list"):
        rows = s.rows(name)
        rows[:, at] = rows[:, found.source]
    s.material[at] = s.material[found.source]
    x = s.rows("x_list")
    x[:, at] = found.sign[: s.d] * x[:, found.source] + found.shift[: s.d]
    return found
