"""The reference configuration of bodies that stay whole: its neighbour list, and the lists of what bodies they meet.

The list is made once, before the first step, and is never searched again; a run of one such body has no other. Where
several bodies repel each other, the lists of pairs of different bodies are made anew only when something
has moved by half of what is left between the bodies' boxes.

A symmetry plane has images of the particles that were near it at the start, once and for all: they are neighbours like
any others, and follow their sources.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..bundle import bundle
from ..jit import exact_kernel, kernel
from ..neighbours import Cells, NeighbourList
from . import ghosts
from .nominal import KAPPA
from .pairs import TINY, WELL
from .problem import Problem
from .smoothing import inverse_root, normaliser, shape_slope, shape_value
from .state import Floats, State

NEAREST = 1e-3  # of h: particles nearer to a symmetry plane lie on it


@bundle
class Reference(NamedTuple):
    """What the loops of `lagrangian` know of the reference configuration; nothing of it changes in a run.

    first, count: (n,), zero for particles of other bodies and for those without neighbours; rows: numbers of the
    neighbours (uint32); weight: c of each (single precision, negative, zero in the padding). inverse: (6 | 3, n + 1)
    M^-1, trace: (n + 1,) of M. volume, density: (n + 1,) at the start. stiffness: (bodies,) the share of Young's
    modulus that resists hourglass modes.
    """

    first: Any
    count: Any
    rows: Any
    weight: Any
    inverse: Any
    trace: Any
    volume: Any
    density: Any
    stiffness: Any


@exact_kernel
def _weigh(n, first, count, rows, dummy, shape, x, y, z, h, volume, normal, dimension, weight):
    """c_ij = V_i V_j a_d / h_ij^(d+2) slope(r/h_ij): the very same number for (i, j) and (j, i)."""
    for i in range(n):
        for k in range(first[i], first[i] + count[i]):
            j = np.int64(rows[k])
            weight[k] = 0.0
            if j == dummy:
                continue
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            r2 = dx * dx + dy * dy
            if z is not None:
                dz = z[i] - z[j]
                r2 += dz * dz
            mean = 0.5 * (h[i] + h[j])
            q2 = r2 / (mean * mean) + TINY
            inverse_q = inverse_root(q2)
            q = q2 * inverse_q
            if shape_value(shape, q) <= 0.0:
                continue
            c = normal * shape_slope(shape, q, inverse_q) / mean ** (dimension + 2)
            weight[k] = (volume[i] * volume[j]) * c


@kernel
def _shape_matrices(n, first, count, rows, weight, x, y, z, matrix):
    """matrix: (n, 3, 3) sum_j -c_ij X_ij (x) X_ij."""
    for i in range(n):
        for k in range(first[i], first[i] + count[i]):
            j = rows[k]
            c = -np.float64(weight[k])
            dx = x[i] - x[j]
            dy = y[i] - y[j]
            matrix[i, 0, 0] += c * dx * dx
            matrix[i, 0, 1] += c * dx * dy
            matrix[i, 1, 1] += c * dy * dy
            if z is not None:
                dz = z[i] - z[j]
                matrix[i, 0, 2] += c * dx * dz
                matrix[i, 1, 2] += c * dy * dz
                matrix[i, 2, 2] += c * dz * dz


def _young(law: Any) -> float:
    return float(law.shear * (3.0 * law.lame + 2.0 * law.shear) / (law.lame + law.shear))


def check(p: Problem) -> None:
    """ValueError where a problem asks of bodies that stay whole what they cannot do together."""
    wrong = {
        "periodic and limit planes": any(plane.kind != ghosts.SYMMETRY for plane in p.planes),
        "symmetry planes of several bodies": bool(p.planes) and len(np.unique(p.body)) > 1,
        "the arithmetic of the original program": p.original,
        "kernel contact between bodies (but with the other kinds)": len(np.unique(p.body)) > 1 and not p.apart,
    }
    for body in p.bodies:
        if body.lagrangian:
            named = f" (body {body.name})"
            wrong |= {
                "pair viscosity" + named: bool(body.alpha or body.beta),
                "density or stress diffusion" + named: bool(body.density_diffusion or body.stress_diffusion),
            }
            if not getattr(body.law, "shear", 0.0) > 0.0:
                raise ValueError(f"body {body.name} has no shear stiffness: it does not stay whole")
            if not 0.0 <= body.hourglass <= 1.0:
                raise ValueError(f"the hourglass factor {body.hourglass!r} of body {body.name} must lie within 0 .. 1")
    for name, there in wrong.items():
        if there:
            raise ValueError(f"the total-Lagrangian formulation does not go together with {name}")


def place_images(p: Problem, s: State, shape: Any) -> ghosts.Images:
    """The images of the start, with all that the reference list needs of them.

    ValueError where a particle does not lie on the right side of a plane: it would meet its own image.
    """
    start = s.rows("x_start")[:, : s.n]
    for plane in p.planes:
        depth = (plane.position - start[plane.axis]) * plane.side
        beyond = np.flatnonzero(depth <= NEAREST * s.rows("h")[0, : s.n])
        if len(beyond):
            raise ValueError(
                f"{len(beyond)} particle(s) lie on the symmetry plane {'xyz'[plane.axis]} = {plane.position:g} or "
                f"beyond it, the first is particle {s.id[beyond[0]]}: a body that stays whole begins half a spacing "
                "from it"
            )
        reach = shape.support * float(p.h.max())
        if depth.min() > 0.5 * reach:
            raise ValueError(
                f"no particle is near the symmetry plane {'xyz'[plane.axis]} = {plane.position:g}: a body that stays "
                "whole stands on its planes from the start; what it is to meet later is a wall (sph.walls)"
            )
    s.rows("x_list")[:] = s.rows("x_start")
    found = ghosts.place_images(s, p.planes, s.n, shape.support * float(p.h.max()))
    at = slice(s.n, s.n + len(found))
    for name in ("x", "x_start"):
        s.rows(name)[:, at] = s.rows("x_list")[:, at]
    s.rows("density")[:, at] = s.rows("density")[:, found.source]
    return found


def build(p: Problem, s: State, shape: Any, threads: int, images: int = 0, *, by_cell: bool = True) -> Reference:
    """The reference configuration is that of the start; hourglass control begins with its full stiffness.

    images: that stand behind the particles; by_cell: whether the particles stand in the order of the cells.

    ValueError where a particle's neighbours lie in a plane or a line and leave its deformation open.
    """
    n = s.n
    whole = np.array([b.lagrangian for b in p.bodies])[s.material[:n]]
    x, y, z = (s.row("x_start", k) for k in range(3))
    assert x is not None
    assert y is not None
    h = s.rows("h")[0]
    density = s.rows("density")[0].copy()
    volume = np.divide(
        s.rows("mass")[0], density, out=np.zeros(s.dummy + 1), where=density > 0.0
    )  # empty room has none
    radius = shape.support * float(h[:n].max())
    uniform = bool(np.all(h[:n] == h[0]))
    reach = {"radius": radius if uniform else 0.5 * radius, "h": None if uniform else h * (0.5 * shape.support)}
    listed = NeighbourList(n)
    group = (
        None if images else np.where(whole, s.material[:n], -1 - np.arange(n))
    )  # others are nobody's neighbours here
    if images or not by_cell:  # images are of one body, see `check`
        listed.build_mapped(n, images, n, x, y, z, dummy=s.dummy, skin=0.0, group=group, threads=threads, **reach)
    else:
        listed.build(
            Cells(n, x, y, z, radius), x, y, z, skin=0.0, group=group, other=False, threads=threads, dummy=s.dummy,
            **reach,
        )  # fmt: skip
    weight = np.zeros(len(listed.rows), np.float32)
    _weigh(
        n, listed.first, listed.count, listed.rows, s.dummy, shape, x, y, z, h, volume,
        normaliser(shape, p.dimension), p.dimension, weight,
    )  # fmt: skip
    matrix = np.zeros((n, 3, 3))
    _shape_matrices(n, listed.first, listed.count, listed.rows, weight, x, y, z, matrix)
    trace = np.zeros(s.dummy + 1)
    trace[:n] = np.trace(matrix, axis1=1, axis2=2)
    reference = Reference(
        first=listed.first, count=np.where(trace[:n] > 0.0, listed.count, 0), rows=listed.rows, weight=weight,
        inverse=_inverses(p, s, matrix, listed.count), trace=trace, volume=volume, density=density,
        stiffness=np.array([b.hourglass * _young(b.law) for b in p.bodies]),
    )  # fmt: skip
    s.rows("hourglass")[KAPPA, :n] = reference.stiffness[s.material[:n]] * (reference.count > 0)
    return reference


def _inverses(p: Problem, s: State, matrix: Floats, count: NDArray[np.int64]) -> Floats:
    """(6 | 3, dummy + 1) rows of M^-1; zero for a particle without neighbours, which then bears no stress."""
    n, d = s.n, p.dimension
    full = matrix[:, :d, :d]
    full = full + np.triu(full, 1).transpose(0, 2, 1)
    mean = np.trace(full, axis1=1, axis2=2) / d
    fit = np.linalg.det(full) > WELL * mean**d
    open_ones = np.flatnonzero((mean > 0.0) & ~fit)
    if len(open_ones):
        i = open_ones[0]
        raise ValueError(
            f"the total-Lagrangian formulation cannot tell the deformation of {len(open_ones)} particle(s), the first "
            f"is particle {s.id[i]} of {p.bodies[s.material[i]].name}: its {d}D neighbourhood is too thin, "
            "it needs two layers of particles or more"
        )
    inverse = np.zeros((n, 3, 3))
    inverse[fit, :d, :d] = np.linalg.inv(full[fit])
    rows = np.zeros((6 if d == 3 else 3, s.dummy + 1))
    parts = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)) if d == 3 else ((0, 0), (1, 1), (0, 1))
    for row, (a, b) in zip(rows, parts, strict=True):
        row[:n] = inverse[:, a, b]
    return rows


def gap(s: State, bodies: int) -> float:
    """The least distance between the boxes around two bodies at the places of the list, 0 where two overlap."""
    x = s.rows("x_list")[:, : s.n]
    owned = [x[:, s.material[: s.n] == m] for m in range(bodies)]
    low, high = (np.stack([edge(part, axis=1) for part in owned if part.size]) for edge in (np.min, np.max))
    apart = np.maximum(0.0, np.maximum(low[:, None] - high[None], low[None] - high[:, None]))
    distance = np.sqrt((apart**2).sum(axis=2))
    np.fill_diagonal(distance, np.inf)
    return float(distance.min())


def relist(
    p: Problem, s: State, own: NeighbourList, others: NeighbourList, kernel_reach: tuple[float, Floats | None],
    contact_reach: tuple[float, Floats | None], skin: float, threads: int,
) -> float:  # fmt: skip
    """Lists of the places x_list: `own` of bodies of the plain kind, `others` of pairs of different bodies.

    kernel_reach, contact_reach: search radius and lengths of each, as `NeighbourList.build` has them. Nothing is
    sorted. Returns how far particles may go before the next call; infinite where there is nothing to list.
    """
    n = s.n
    x, y, z = s.row("x_list", 0), s.row("x_list", 1), s.row("x_list", 2)
    assert x is not None
    assert y is not None
    whole = np.array([b.lagrangian for b in p.bodies])
    far = np.inf
    radius, h = kernel_reach
    if not np.all(whole):
        group = np.where(whole[s.material], -1 - np.arange(s.dummy + 1), s.material)
        own.build_mapped(
            n, 0, n, x, y, z, dummy=s.dummy, radius=radius, skin=skin, h=h, group=group, other=False, threads=threads
        )
        far = 0.5 * skin
    if not p.apart or len(np.unique(s.material[:n])) == 1:
        return far
    radius, h = contact_reach
    free = gap(s, len(p.bodies)) - (radius if h is None else 2.0 * radius)
    if free > skin:
        others.count[:] = 0
        return min(far, 0.5 * free)
    others.build_mapped(
        n, 0, n, x, y, z, dummy=s.dummy, radius=radius, skin=skin, h=h, group=s.material, other=True, threads=threads
    )
    return 0.5 * skin
