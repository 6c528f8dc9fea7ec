"""Speed of the particle solver: particle-steps a second, threads, start-up, and where the time goes.

    python tests/benchmarks/bench_sph.py [particles]

The scene is two elastic blocks that meet (20 000 particles in 3D, about 58 neighbours, 72 with the skin), the deck on
which MCM makes 0.117 million particle-steps a CPU-second. Sorting and list building are included, compiling is not. Run
it on a quiet machine.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

START = time.perf_counter()

import numpy as np  # noqa: E402  (the clock starts before the imports)

from zrno.solvers.jit import compile_seconds  # noqa: E402
from zrno.solvers.materials import Elastic  # noqa: E402
from zrno.solvers.neighbours import Cells  # noqa: E402
from zrno.solvers.sph import Body, Problem, Solver, critical, momentum, packed, pairs, particle  # noqa: E402
from zrno.solvers.threads import meeting  # noqa: E402

STEPS = 100


def blocks(particles: int) -> Problem:
    """Two blocks of 20 x 20 x 25 particles (or more), 0.1 cm apart, at 100 m/s each; cm, g, us, Mbar."""
    side = round((particles / 2 / 1.25) ** (1 / 3))
    shape = (side, side, round(1.25 * side))
    grid = 0.1 * (np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3) + 0.5)
    x = np.concatenate([grid - [0.0, 0.0, 0.1 * shape[2]], grid])
    half = len(grid)
    v = np.zeros_like(x)
    v[:half, 2], v[half:, 2] = 0.01, -0.01
    law = Elastic.from_engineering(0.7, 0.33)
    return Problem(
        dimension=3, x=x, v=v, mass=np.full(2 * half, 2.7e-3), h=np.full(2 * half, 0.12),
        density=np.full(2 * half, 2.7), body=np.repeat([0, 1], half),
        bodies=tuple(Body(i, "block", law, 2.7, 0.5, 2.0) for i in (1, 2)), end_time=1e9,
    )  # fmt: skip


def rate(problem: Problem, threads: int) -> tuple[float, float, float]:
    """Particle-steps a wall second and a CPU-second, and list builds a step, over STEPS steps after the first."""
    solver = Solver(problem, threads=threads)
    solver.advance(1e9, 1)
    builds = solver.builds
    wall, cpu = time.perf_counter(), time.process_time()
    solver.advance(1e9, STEPS)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    done = solver.n * STEPS
    return done / wall, done / cpu, (solver.builds - builds) / STEPS


def nanoseconds(call: Callable[[], Any], n: int) -> float:
    """Median CPU time a particle of a call on one thread."""
    call()
    times = []
    for _ in range(9):
        started = time.thread_time()
        call()
        times.append(time.thread_time() - started)
    return statistics.median(times) / n * 1e9


def phases(problem: Problem, builds: float) -> dict[str, float]:
    """Nanoseconds a particle-step of each phase, on one thread."""
    s = Solver(problem, threads=1)
    s.advance(1e9, 60)
    a, k, n = s._arrays(), s._numbers, s.n
    law = s._laws[0]
    sync = meeting(1)
    radius = s._shape.support * float(problem.h.max())
    assert a.x_list is not None
    cells = Cells(n, a.x_list, a.y_list, a.z_list, radius + s._skin)
    return {
        "velocity gradient": nanoseconds(
            lambda: pairs.velocity_gradient(
                0, n, a.first, a.count, a.rows, s._shape, a.packed, a.near[0, 0], True, None, k.inverse_h2,
                k.scale, None, a.gradient, None, k.corrected, a.material,
            ), n),
        "momentum": nanoseconds(
            lambda: momentum.momentum(
                0, n, a.first, a.count, a.rows, s._shape, a.packed, a.beside, *a.near[0], a.z, None, None, k.inverse_h2,
                k.force_scale, None, k.body, a.ax, a.ay, a.az, a.nearest, None, None, None, 1.0, None, None, None,
            ), n),
        "packing": nanoseconds(lambda: packed.pack_motion(0, 1, sync, 0, True, None, None, True, a), n)
        + nanoseconds(lambda: packed.pack_forces(0, 1, sync, 0, a.z, None, None, None, None, True, a), n),
        "stress": sum(
            nanoseconds(
                lambda m=m: particle.constitutive(
                    0, n, a.z, m, law, 1e-12, None, None, None, None, None, None, a, k
                ), n)
            for m in (0, 1)),
        "critical step": nanoseconds(lambda: critical.critical_step(0, n, a.z, None, None, k, a), n),
        "kick": nanoseconds(lambda: particle.kick(0, n, a.z, None, None, None, 1e-15, 1e-15, a, k), n),
        "drift": nanoseconds(lambda: particle.drift(0, n, a.z, None, None, None, None, 1.0, 1e-15, a, k), n),
        "list": builds * nanoseconds(
            lambda: s._list.build(cells, a.x_list, a.y_list, a.z_list, radius=radius, skin=s._skin), n),
        "cells and sort": builds * nanoseconds(
            lambda: s._state.sort(Cells(n, a.x_list, a.y_list, a.z_list, radius + s._skin).order, 1), n),
    }  # fmt: skip


def main(particles: int) -> None:
    """Print the figures."""
    problem = blocks(particles)
    solver = Solver(problem, threads=1)
    solver.advance(1e9, 1)
    print(f"first step {time.perf_counter() - START:.2f} s after start, {compile_seconds():.2f} s of it compiling")
    results: dict[int, list[tuple[float, float, float]]] = {1: [], 2: []}
    for _ in range(5):
        for threads, found in results.items():  # in turn, so that a drift of the machine hits both
            found.append(rate(problem, threads))
    n = len(problem.x)
    for threads, found in results.items():
        wall, cpu, builds = (statistics.median(column) for column in zip(*found, strict=True))
        print(
            f"{n} particles, {threads} thread(s): {wall / 1e6:.2f} M/s wall, {cpu / 1e6:.2f} M/s CPU, "
            f"{builds:.2f} lists a step"
        )
    print(
        f"two threads against one: {statistics.median(b[0] / a[0] for a, b in zip(*results.values(), strict=True)):.2f}"
    )
    found = phases(problem, builds)
    total = sum(found.values())
    for name, value in found.items():
        print(f"  {name:18} {value:6.0f} ns  {100 * value / total:3.0f} %")
    print(f"  {'sum':18} {total:6.0f} ns a particle-step")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20_000)
