"""What contact costs: nanoseconds a particle-step of two blocks that lie on each other, by law and friction.

    python tests/benchmarks/bench_contact.py [particles]

Compiling is not counted. Of a cube of 27 000 particles a thirtieth touches: the cost of a particle in contact is many
times what a particle of the scene pays for it, and is printed beside it. Run it on a quiet machine.
"""

from __future__ import annotations

import dataclasses
import statistics
import sys
import time
from typing import Any

import numpy as np

from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.contact.pinball import STIFF
from zrno.solvers.contact.plane import Wall
from zrno.solvers.contact.potential import matching_strength
from zrno.solvers.materials import Elastic, sound_speed
from zrno.solvers.sph import Body, Problem, Solver

STEPS = 50
REPEATS = 7


def blocks(particles: int, gap: float) -> Problem:
    """Two equal blocks in 3D, the second `gap` spacings above the first, pressed together slowly."""
    side = round((particles / 2) ** (1 / 3))
    grid = 0.1 * np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    x = np.concatenate([grid, grid + np.array([0.0, 0.0, 0.1 * (side - 1 + gap)])])
    half = len(grid)
    v = np.zeros_like(x)
    v[:half, 2], v[half:, 2], v[half:, 0] = 1e-4, -1e-4, 1e-4
    law = Elastic.from_engineering(0.7, 0.33)
    strength = matching_strength(sound_speed(law, 2.7), 2.7)
    return Problem(
        dimension=3, x=x, v=v, mass=np.full(2 * half, 2.7e-3), h=np.full(2 * half, 0.12),
        density=np.full(2 * half, 2.7), body=np.repeat([0, 1], half),
        bodies=tuple(Body(i, "block", law, 2.7, 0.5, 2.0, strength=strength, exponent=4.0) for i in (1, 2)),
        end_time=1e9, step_option=1,
    )  # fmt: skip


def main(particles: int) -> None:
    """Print the figures."""
    friction = Coulomb(0.5, 0.4)
    apart, near = blocks(particles, 1.8), blocks(particles, 1.18)
    one = dataclasses.replace(apart, body=np.zeros(len(apart.x), np.int64), bodies=apart.bodies[:1])
    floor = (Wall((0.0, 0.0, -0.049), (0.0, 0.0, 1.0), friction),)
    scenes: dict[str, Problem] = {
        "one body": one,
        "kernel contact": apart,
        "potential": dataclasses.replace(apart, potential=True),
        "potential, friction": dataclasses.replace(apart, potential=True, friction=friction),
        "potential, normals": dataclasses.replace(apart, potential=True, friction=friction, contact_by_normals=True),
        "pinball": dataclasses.replace(near, pinball=STIFF),
        "pinball, friction": dataclasses.replace(near, pinball=STIFF, friction=friction),
        "one body on a wall": dataclasses.replace(one, walls=floor),
    }
    solvers = {name: Solver(problem, threads=1) for name, problem in scenes.items()}
    times: dict[str, list[float]] = {name: [] for name in scenes}
    for solver in solvers.values():
        solver.advance(1e9, 2)
    for _ in range(REPEATS):
        for name, solver in solvers.items():  # in turn, so that a drift of the machine hits all
            started = time.process_time()
            solver.advance(1e9, STEPS)
            times[name].append((time.process_time() - started) / STEPS / solver.n * 1e9)
    base = statistics.median(times["one body"])
    for name, found in times.items():
        solver: Any = solvers[name]
        touching = int(np.count_nonzero(solver._others.count[: solver.n])) if solver.problem.apart else 0
        cost = statistics.median(found)
        each = f"{(cost - base) * solver.n / touching:6.0f} ns a particle near the other body" if touching else ""
        print(f"{name:20} {cost:6.0f} ns a particle-step ({cost - base:+5.0f})  {touching:5} near  {each}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 27_000)
