"""The front of a collapsing column of an inviscid, incompressible liquid: `samples/dam_break/reference/inviscid.csv`.

    .venv/bin/python tests/benchmarks/inviscid_dam.py [--compare RESULT...]

An independent solution for the sample: potential flow by boundary elements, no particles and no tuned number. A column
1 wide and 2 high stands between the planes x = 0 and y = 0; gravity is 1/2, so that time is T = t sqrt(2 g / a). The
free surface is a row of nodes z = x + iy from the floor to the wall, with the potential phi; w = phi + i psi is
analytic within, psi = 0 on both planes, which are taken in by reflection. Cauchy's integral over linear elements gives
psi (Vinje & Brevig 1981); then dz/dt = conj(dw/dz) and dphi/dt = |dz/dt|^2 / 2 - g y, by Runge and Kutta. Elements are
a third as long as the liquid is deep there, between two bounds, and are laid anew every other step; every fourth step
the surface is smoothed by five points (Longuet-Higgins & Cokelet 1976). The column's upper corner is rounded by a
fiftieth of its width.

It prints how far the fronts of two meshes differ, and what is lost of area and energy; with --compare also how far the
results of `zrno run` are from the solution, and all of them from the experiments.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from zrno.pipelines import load
from zrno.pipelines.measures import Cloud, front

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

GRAVITY = 0.5
HEIGHT = 2.0
ROUND = 0.02
END = 3.7
CORE = 20001  # points of a spline that the length of elements is summed over
HERE = Path(__file__).resolve().parents[2] / "samples" / "dam_break" / "reference"


def stream_function(z: Complexes, phi: Floats) -> Floats:
    """psi at the nodes z (n + 1,), from the floor to the wall, where the potential is phi; 0 at both ends."""
    n = len(z) - 1
    back = np.arange(n - 1, -1, -1)
    node = np.concatenate([np.arange(n + 1), back, np.arange(1, n + 1), back[:-1]])
    quarter = np.repeat([0, 1, 2, 3], [n + 1, n, n, n - 1])
    at = z[node]
    at = np.choose(quarter, [at, -at.conj(), -at, at.conj()])
    sign = np.array([1.0, -1.0, 1.0, -1.0])[quarter]
    k = np.arange(n + 1)
    before, after = (k - 1) % len(at), (k + 1) % len(at)
    way = at - z[:, None]
    apart = way.copy()
    apart[k, k] = 1.0
    log = np.log(np.roll(apart, -1, axis=1) / apart)
    log[k, k] = log[k, before] = 0.0  # the elements that meet in the node come below
    along = np.roll(at, -1) - at
    factor = log * np.roll(way, -1, axis=1) / along - np.roll(log * way / along, 1, axis=1)
    corner = np.log((at[after] - z) / (at[before] - z))
    factor[k, k] += corner - 2j * np.pi * (corner.imag > 0.0)
    of_phi, of_psi = np.zeros((2, n + 1, n + 1))
    np.add.at(of_phi.T, node, factor.real.T)
    np.add.at(of_psi.T, node, -(factor.imag * sign).T)
    psi = np.zeros(n + 1)
    psi[1:-1] = np.linalg.solve(of_psi[1:-1, 1:-1], -(of_phi @ phi)[1:-1])
    return psi


def _beyond(f: Floats, low: float, high: float, many: int) -> Floats:
    """f, reflected at both ends: even (1) or odd (-1)."""
    return np.concatenate([low * f[many:0:-1], f, high * f[-2 : -2 - many : -1]])


def _slope(f: Floats, low: float, high: float) -> Floats:
    e = _beyond(f, low, high, 3)
    return (45.0 * (e[4:-2] - e[2:-4]) - 9.0 * (e[5:-1] - e[1:-5]) + e[6:] - e[:-6]) / 60.0


def _smooth(f: Floats, low: float, high: float) -> Floats:
    e = _beyond(f, low, high, 2)
    return (-e[:-4] + 4.0 * e[1:-3] + 10.0 * e[2:-2] + 4.0 * e[3:-1] - e[4:]) / 16.0


def _on_planes(z: Complexes) -> Complexes:
    z[0], z[-1] = z[0].real, 1j * z[-1].imag
    return z


def rates(z: Complexes, phi: Floats) -> tuple[Complexes, Floats]:
    """dz/dt and dphi/dt."""
    psi = stream_function(z, phi)
    dz = _slope(z.real, 1, -1) + 1j * _slope(z.imag, -1, 1)
    dw = _slope(phi, 1, 1) + 1j * _slope(psi, -1, -1)
    v = _on_planes(np.conj(dw / dz))
    return v, 0.5 * np.abs(v) ** 2 - GRAVITY * z.imag


def laid_anew(z: Complexes, phi: Floats, fine: float, coarse: float) -> tuple[Complexes, Floats]:
    """Nodes by the depth of the liquid, elements between the lengths fine and coarse."""
    s = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(z)))])
    x, y, p = (
        CubicSpline(s, f, bc_type=ends)
        for f, ends in (
            (z.real, ((1, 0.0), "not-a-knot")), (z.imag, ("not-a-knot", (1, 0.0))), (phi, ((1, 0.0), (1, 0.0)))
        )
    )  # fmt: skip
    u = np.linspace(0.0, s[-1], CORE)
    count = np.concatenate([[0.0], np.cumsum(1.0 / np.clip(0.35 * y(u), fine, coarse))[:-1] * u[1]])
    t = np.interp(np.linspace(0.0, count[-1], int(count[-1]) + 2), count, u)
    return _on_planes(x(t) + 1j * y(t)), p(t)


def area_and_energy(z: Complexes, phi: Floats) -> tuple[float, float, float]:
    """Area, kinetic and potential energy of the quarter, for a density of one."""
    psi = stream_function(z, phi)
    x, y = z.real, z.imag
    area = 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])
    kinetic = 0.5 * np.sum(0.5 * (phi[1:] + phi[:-1]) * np.diff(psi))
    a, b = y[:-1], y[1:]
    weight = -GRAVITY / 6.0 * np.sum(np.diff(x) * (a * a + a * b + b * b))
    return float(area), float(abs(kinetic)), float(weight)


def collapse(fine: float, coarse: float, longest: float) -> tuple[Floats, list[tuple[float, float, float]]]:
    """(steps, 2) T and the front, and area and energies at the start and the end."""
    bend = np.exp(1j * np.linspace(0.0, 0.5 * np.pi, 30)) * ROUND
    z = np.concatenate([
        1.0 + 1j * np.linspace(0.0, HEIGHT - ROUND, 400)[:-1], (1.0 - ROUND) + 1j * (HEIGHT - ROUND) + bend,
        np.linspace(1.0 - ROUND, 0.0, 200)[1:] + 1j * HEIGHT,
    ])  # fmt: skip
    z, phi = laid_anew(z, np.zeros(len(z)), fine, coarse)
    kept = [area_and_energy(z, phi)]
    t, found = 0.0, [(0.0, 1.0)]
    while t < END:
        v1, p1 = rates(z, phi)
        length = np.abs(np.diff(z))
        stretch = 0.25 * np.min(length / np.maximum(np.abs(np.diff(v1)), 1e-9))
        dt = min(longest, stretch, 0.3 * float(np.sqrt(length.min())))
        v2, p2 = rates(z + 0.5 * dt * v1, phi + 0.5 * dt * p1)
        v3, p3 = rates(z + 0.5 * dt * v2, phi + 0.5 * dt * p2)
        v4, p4 = rates(z + dt * v3, phi + dt * p3)
        z = _on_planes(z + dt / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4))
        phi = phi + dt / 6.0 * (p1 + 2.0 * p2 + 2.0 * p3 + p4)
        t += dt
        found.append((t, float(z[0].real)))
        if len(found) % 2 == 0:
            z, phi = laid_anew(z, phi, fine, coarse)
        if len(found) % 4 == 0:
            z = _smooth(z.real, 1, -1) + 1j * _smooth(z.imag, -1, 1)
            phi = _smooth(phi, 1, 1)
    kept.append(area_and_energy(z, phi))
    return np.array(found), kept


def compare(name: str, time: Floats, place: Floats) -> None:
    """Prints the error over each set of experiments: by its own clock, and with the clock set at its first point."""
    text = name
    for file in ("front", "front_2", "front_koshizuka_oka"):
        lines = (HERE / f"{file}.csv").read_text().splitlines()
        t, x = np.loadtxt([line for line in lines if line[0].isdigit()], delimiter=",", usecols=(2, 3)).T
        moved = x > 1.0
        t, x = t[moved], x[moved]
        early = t[0] - np.interp(x[0], place, time)
        errors = [np.linalg.norm(np.interp(t - s, time, place) - x) / np.linalg.norm(x) for s in (0.0, early)]
        text += f" | {file} {100 * errors[0]:.1f} %, {100 * errors[1]:.1f} % from its first point on (lag {early:.2f})"
    print(text, flush=True)


def main(results: list[str]) -> None:
    """Solve, say how well, write, compare."""
    coarse, _ = collapse(0.01, 0.06, 0.01)
    fine, kept = collapse(0.005, 0.03, 0.005)
    at = np.arange(0.0, END, 0.1)
    place = np.interp(at, *fine.T)
    worst = np.abs(np.interp(at, *coarse.T) - place).max()
    (area, _, before), (end_area, kinetic, weight) = kept
    lost = 1.0 - (kinetic + weight) / before
    print(f"two meshes differ by {worst:.4f}; lost: area {1.0 - end_area / area:.1e}, energy {lost:.1e}")
    rows = "".join(f"{t / np.sqrt(2.0 * 9.81):.6f},{x:.4f},{t:.1f},{x:.4f}\n" for t, x in zip(at, place, strict=True))
    head = (
        "# Front of the same column without viscosity, its dam gone at once: potential flow by boundary elements,\n"
        "# tests/benchmarks/inviscid_dam.py. T = t sqrt(2 g / a), Z = x / a, here for a = 1 m and g = 9.81 m/s^2.\n"
    )
    (HERE / "inviscid.csv").write_text(head + "time,front,T,Z\n" + rows)
    compare("inviscid", at, place)
    for result in results:
        found: Any = load(Path(result))
        time = np.array(found.times) * np.sqrt(2.0 * 9.81)
        seen = [front(Cloud(found.arrays("particles", k), 2).of(1), axis="x", heap=True) for k in range(len(time))]
        here = np.interp(at[at <= time[-1]], time, seen)
        there = place[at <= time[-1]]
        error = np.linalg.norm(here - there) / np.linalg.norm(there)
        compare(f"{result}: {100 * error:.1f} % off the inviscid one", time, np.array(seen))


if __name__ == "__main__":
    main(sys.argv[2:] if sys.argv[1:2] == ["--compare"] else [])
