"""Speed of bodies that stay whole: particle-steps a second, threads, start-up, and where the time goes.

    python tests/benchmarks/bench_lagrangian.py [particles ...]

The scene is one elastic block in 3D that shakes (21 000 and 101 000 particles, about 58 neighbours), of the size that
LAMMPS's tlsph steps through at 0.25 million particle-steps a CPU-second. Compiling is not included; nothing is searched
or sorted. Run it on a quiet machine.
"""

from __future__ import annotations

import statistics
import sys
import time

import numpy as np
from bench_sph import STEPS, nanoseconds, rate

from zrno.solvers.jit import compile_seconds
from zrno.solvers.materials import Elastic
from zrno.solvers.sph import Body, Problem, Solver, critical, lagrangian, particle
from zrno.solvers.sph.nominal import nominal_stress


def block(particles: int) -> Problem:
    """A block of aluminium whose halves run into each other at 100 m/s; cm, g, us, Mbar."""
    side = round((particles / 1.25) ** (1 / 3))
    shape = (side, side, round(1.25 * side))
    x = 0.1 * (np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3) + 0.5)
    n = len(x)
    v = np.zeros_like(x)
    v[:, 2] = np.where(x[:, 2] < 0.05 * shape[2], 0.01, -0.01)
    law = Elastic.from_engineering(0.7, 0.33)
    return Problem(
        dimension=3, x=x, v=v, mass=np.full(n, 2.7e-3), h=np.full(n, 0.12), density=np.full(n, 2.7),
        body=np.zeros(n, np.int64), bodies=(Body(1, "block", law, 2.7, 0.5, 2.0, lagrangian=True),), end_time=1e9,
    )  # fmt: skip


def phases(problem: Problem) -> dict[str, float]:
    """Nanoseconds a particle-step of each phase, on one thread."""
    s = Solver(problem, threads=1)
    s.advance(1e9, 60)
    a, k, n, r = s._arrays(), s._numbers, s.n, s._reference
    return {
        "deformation": nanoseconds(lambda: lagrangian.deformation(0, n, True, 1e-3, r, a), n),
        "law": nanoseconds(
            lambda: particle.constitutive(0, n, a.z, 0, s._laws[0], 1e-12, *[None] * 6, a, k), n),
        "nominal stress": nanoseconds(lambda: nominal_stress(0, n, a.z, r, a), n),
        "force": nanoseconds(lambda: lagrangian.internal_force(0, n, a.z, None, r, a, k), n),
        "critical step": nanoseconds(lambda: critical.critical_step(0, n, a.z, None, None, k, a), n),
        "kick": nanoseconds(lambda: particle.kick(0, n, a.z, None, None, None, 1e-15, 1e-15, a, k), n),
        "drift": nanoseconds(lambda: particle.drift(0, n, a.z, None, None, None, None, 1.0, 1e-15, a, k), n),
    }  # fmt: skip


def main(sizes: list[int]) -> None:
    """Print the figures."""
    for particles in sizes:
        problem = block(particles)
        started = time.perf_counter()
        solver = Solver(problem, threads=1)
        solver.advance(1e9, 1)
        n, reference = solver.n, solver._reference
        assert reference is not None
        lists = reference.rows.nbytes + reference.weight.nbytes
        print(
            f"{n} particles: first step after {time.perf_counter() - started:.2f} s, {compile_seconds():.2f} s of it "
            f"compiling; {len(reference.rows) / n:.0f} places in a row, {lists / n:.0f} B of list and "
            f"{solver._state.numbers.nbytes / n:.0f} B of state a particle"
        )
        for threads in (1, 2):
            wall, cpu, builds = (
                statistics.median(column) for column in zip(*(rate(problem, threads) for _ in range(5)), strict=True)
            )
            assert builds == 0.0
            print(f"  {threads} thread(s), {STEPS} steps: {wall / 1e6:.2f} M/s wall, {cpu / 1e6:.2f} M/s CPU")
        found = phases(problem)
        total = sum(found.values())
        for name, value in found.items():
            print(f"  {name:16} {value:6.0f} ns  {100 * value / total:3.0f} %")
        print(f"  {'sum':16} {total:6.0f} ns a particle-step")


if __name__ == "__main__":
    main([int(a) for a in sys.argv[1:]] or [21_000, 101_000])
