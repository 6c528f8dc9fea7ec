"""The collision of the sample of rubber rings by finite elements: it shares nothing with the solvers.

    .venv/bin/python tests/support/ring_elements.py --cells 8 16 --speed 0.06 0.1 [--law neo_hookean]

By symmetry two equal rings that meet are one ring and a smooth rigid wall, and half of that. Elements of four nodes in
plane strain with 2 x 2 points, lumped masses, central differences; Hooke's law in the Jaumann rate, as the sample's, or
a neo-Hookean solid of the same moduli; the wall is a spring to each node that is beyond it. Nothing is damped.
"""

from __future__ import annotations

import argparse
import math
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# m, s, kg: the sample's numbers
INNER, OUTER, GAP, END = 0.03, 0.04, 0.002, 0.04
DENSITY, YOUNG, POISSON = 1000.0, 1e6, 0.3975
LAME = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
C0 = math.sqrt((LAME + 2.0 / 3.0 * SHEAR) / DENSITY)
LONGITUDINAL = math.sqrt((LAME + 2.0 * SHEAR) / DENSITY)
CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))  # of an element, along the radius and along the angle


class Rebound(NamedTuple):
    """Against time, at each step: (n,). speed: of the centre of mass away from the wall, over that of the impact;
    kinetic: energy over that of the impact; touching: whether a node is beyond the wall."""

    times: Floats
    speed: Floats
    kinetic: Floats
    touching: NDArray[np.bool_]


class Hooke:
    """d sigma/dt = W sigma - sigma W + lambda tr D I + 2 G D, half of D before the turn and half after it.

    The step's velocity gradient is taken at its middle, so that a rotation turns the stress by its very angle.
    """

    def __init__(self, points: tuple[int, ...]) -> None:
        self.xx, self.yy, self.xy = np.zeros((3, *points))
        self.old = np.zeros((2, 2, *points))
        self.old[0, 0] = self.old[1, 1] = 1.0

    def nominal(self, f: Floats) -> Floats:
        """P (2, 2, ...) [Pa] of the deformation gradient now, after that of the call before."""
        (a, b), (c, d) = f - self.old
        (fa, fb), (fc, fd) = 0.5 * (f + self.old)
        self.old = f
        det = fa * fd - fb * fc
        across, back = (b * fa - a * fb) / det, (c * fd - d * fc) / det
        dxx, dyy = (a * fd - b * fc) / det, (d * fa - c * fb) / det
        turn = 2.0 * np.arctan(0.25 * (back - across))
        cos, sin = np.cos(turn), np.sin(turn)
        volumetric = 0.5 * LAME * (dxx + dyy)
        hxx, hyy, hxy = volumetric + SHEAR * dxx, volumetric + SHEAR * dyy, 0.5 * SHEAR * (across + back)
        xx, yy, xy = self.xx + hxx, self.yy + hyy, self.xy + hxy
        self.xx = cos * cos * xx - 2.0 * cos * sin * xy + sin * sin * yy + hxx
        self.yy = sin * sin * xx + 2.0 * cos * sin * xy + cos * cos * yy + hyy
        self.xy = cos * sin * (xx - yy) + (cos * cos - sin * sin) * xy + hxy
        (a, b), (c, d) = f
        xx, yy, xy = self.xx, self.yy, self.xy
        return np.array([[xx * d - xy * b, xy * a - xx * c], [xy * d - yy * b, yy * a - xy * c]])  # sigma cof F


class NeoHookean:
    """P = G (F - F^-T) + lambda ln J F^-T."""

    def __init__(self, points: tuple[int, ...]) -> None:
        pass

    def nominal(self, f: Floats) -> Floats:
        """P (2, 2, ...) [Pa] of the deformation gradient."""
        (a, b), (c, d) = f
        volume = a * d - b * c
        return SHEAR * f + (LAME * np.log(volume) - SHEAR) / volume * np.array([[d, -c], [-b, a]])


LAWS = {"hooke": Hooke, "neo_hookean": NeoHookean}


def _corners(a: Floats) -> Floats:
    """(..., r, t) at the nodes -> (..., 4, (r - 1) (t - 1)) at the corners of the elements."""
    four = [a[..., :-1, :-1], a[..., 1:, :-1], a[..., 1:, 1:], a[..., :-1, 1:]]
    return np.stack([c.reshape(*c.shape[:-2], -1) for c in four], axis=-2)


def _gathered(b: Floats, cells: int) -> Floats:
    """Sums at the nodes of what the elements have at their corners: `_corners` transposed."""
    four = b.reshape(*b.shape[:-1], cells, -1)
    out = np.zeros((*b.shape[:-2], cells + 1, four.shape[-1] + 1))
    out[..., :-1, :-1] += four[..., 0, :, :]
    out[..., 1:, :-1] += four[..., 1, :, :]
    out[..., 1:, 1:] += four[..., 2, :, :]
    out[..., :-1, 1:] += four[..., 3, :, :]
    return out


def ring_against_wall(
    cells: int, speed: float, *, law: str = "hooke", spring: float = 1.0, courant: float = 0.5, until: float = END
) -> Rebound:
    """The upper half of a ring that flies at the wall x = 0 with a speed [c0].

    cells: through the thickness, as many of the same size round it; spring: of the wall, in stiffnesses of an element;
    courant: step over the time of a wave through the narrowest element at the start.
    """
    radius = np.linspace(INNER, OUTER, cells + 1)[:, None]
    angle = np.linspace(0.0, math.pi, round(math.pi * 0.5 * (INNER + OUTER) / (OUTER - INNER) * cells) + 1)
    start = np.array([OUTER + 0.5 * GAP + radius * np.cos(angle), radius * np.sin(angle)])
    at = _corners(start)
    slopes, volumes = [], []
    for point in CORNERS:
        xi, eta = np.array(point) / math.sqrt(3.0)
        local = np.array([[0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi)] for a, b in CORNERS])
        jacobian = np.einsum("ine,nj->eij", at, local)
        slopes.append(np.einsum("nj,eji->ine", local, np.linalg.inv(jacobian)))
        volumes.append(np.linalg.det(jacobian))
    slope, volume = np.ascontiguousarray(np.stack(slopes, axis=1)), np.stack(volumes)  # (2, points, 4, n), (points, n)
    mass = _gathered(np.broadcast_to(0.25 * DENSITY * volume.sum(axis=0), at.shape[1:]), cells)
    dt = courant * INNER / (0.5 * (INNER + OUTER)) * (OUTER - INNER) / cells / LONGITUDINAL
    material = LAWS[law](volume.shape)
    identity = np.eye(2)[:, :, None, None]
    u, v = np.zeros_like(start), np.zeros_like(start)
    v[0] = -speed * C0
    steps = math.ceil(until / dt)
    along, kinetic, touching = np.zeros(steps), np.zeros(steps), np.zeros(steps, bool)
    for k in range(steps):
        nominal = material.nominal(np.einsum("jqne,ine->ijqe", slope, _corners(u)) + identity)
        force = -_gathered(np.einsum("jqne,ijqe->ine", slope, nominal * volume), cells)
        deep = np.minimum(start[0, -1] + u[0, -1], 0.0)
        force[0, -1] -= spring * (LAME + 2.0 * SHEAR) * deep
        force[1][:, [0, -1]] = 0.0
        before = v
        v = v + dt * force / mass
        middle = 0.5 * (before + v)
        along[k], kinetic[k], touching[k] = (mass * middle[0]).sum(), (mass * middle**2).sum(), deep.min() < 0.0
        u = u + dt * v
    impact = mass.sum() * speed * C0
    return Rebound(dt * np.arange(steps), along / impact, kinetic / (impact * speed * C0), touching)


def main() -> None:
    """Print a row a run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, nargs="*", default=[8, 16])
    parser.add_argument("--speed", type=float, nargs="*", default=[0.059, 0.06, 0.08, 0.1, 0.12])
    parser.add_argument("--law", choices=LAWS, default="hooke")
    parser.add_argument("--spring", type=float, default=1.0)
    parser.add_argument("--courant", type=float, default=0.5)
    asked = parser.parse_args()
    print("cells  speed [c0]  restitution  kinetic  contact ends [s]  seconds")
    for cells in asked.cells:
        for speed in asked.speed:
            began = time.perf_counter()
            found = ring_against_wall(cells, speed, law=asked.law, spring=asked.spring, courant=asked.courant)
            took, last = time.perf_counter() - began, found.times[found.touching][-1]
            numbers = f"{found.speed[-1]:11.4f}  {found.kinetic[-1]:7.3f}  {last:16.4f}  {took:7.1f}"
            print(f"{cells:5d}  {speed:10g}  {numbers}", flush=True)


if __name__ == "__main__":
    main()
