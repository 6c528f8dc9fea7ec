"""What each part of a coupled run costs: friction, plasticity, a deformable plate, stress that turns.

    .venv/bin/python tests/benchmarks/bench_coupled.py [--side 20] [--periods 10] [--repeat 5]

A block of side^3 particles slides on a plate of 8 x 8 shells; the variants are run by turns. Printed are medians of
the processor's time a particle-step, of the particles alone, and of the structure's seconds a step.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import statistics
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from coupled_scenes import SPACING, facing, plate

from zrno.solvers import fem, sph
from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.coupling import Coupled, Exchange
from zrno.solvers.materials import Elastic, drucker_prager_soil

GRAIN = Elastic.from_engineering(50.0, 0.3)
SAND = drucker_prager_soil(50.0, 0.3, 0.0, 30.0, 0.0)
RUBBED = Coulomb(0.5, 0.4)
SPEED = 0.1


def variant(side: int, *, friction: Coulomb | None, law: Any, rigid: bool, facets: bool = True) -> Coupled:
    """A coupled run of a block on a plate that is as wide; without facets the block flies."""
    structure = plate(steps=10_000, period=0.02)
    x = structure.x.copy()
    x[:, :2] = 8.0 + side * SPACING / 8.0 * (x[:, :2] - 8.0)
    structure = dataclasses.replace(structure, x=x, rigid=rigid, dynamics=None if rigid else structure.dynamics)
    grain = facing(structure, gap=0.5, side=side, law=law, friction=friction, body_force=(0.0, 0.0, -0.00981))
    grain.v[:] = (SPEED, 0.0, 0.0)
    nodes = np.arange(len(structure.x))
    if not facets:
        grain = dataclasses.replace(grain, facets=None, driven=None)
    return Coupled(fem.Solver(structure), sph.Solver(grain, threads=1), Exchange(nodes)) if facets else grain


def main() -> None:
    """Run the variants by turns and print their times."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--side", type=int, default=20)
    parser.add_argument("--periods", type=int, default=10)
    parser.add_argument("--repeat", type=int, default=5)
    given = parser.parse_args()
    variants = {
        "elastic block, rigid plate": {"friction": None, "law": GRAIN, "rigid": True},
        "and friction": {"friction": RUBBED, "law": GRAIN, "rigid": True},
        "and plasticity (Drucker-Prager)": {"friction": RUBBED, "law": SAND, "rigid": True},
        "and a deformable plate": {"friction": RUBBED, "law": SAND, "rigid": False},
    }
    alone = sph.Solver(variant(given.side, friction=None, law=GRAIN, rigid=True, facets=False), threads=1)
    runs = {name: variant(given.side, **options) for name, options in variants.items()}
    times: dict[str, list[float]] = {name: [] for name in ["the block alone", *runs]}
    steels: dict[str, list[float]] = {name: [] for name in runs}
    n = alone.n
    for turn in range(given.repeat + 1):  # the first compiles
        began, step = time.process_time(), alone.step
        alone.advance(alone.time + 0.02 * given.periods, 10**9)
        spent = {"the block alone": (time.process_time() - began) / (alone.step - step)}
        for name, run in runs.items():
            run.seconds = dict.fromkeys(run.seconds, 0.0)
            step, total = run.particles.step, 0.0
            for _ in range(given.periods):
                before = time.process_time()
                steel = run.seconds["structure"]
                run.advance(math.inf, 1)
                total += time.process_time() - before - (run.seconds["structure"] - steel)
            spent[name] = total / (run.particles.step - step)
            if turn:
                steels[name].append(run.seconds["structure"] / given.periods)
        if turn:
            for name, value in spent.items():
                times[name].append(1e9 * value / n)
    print(f"{n} particles, {given.repeat} x {given.periods} periods")
    for name, values in times.items():
        steel = f"{1e3 * statistics.median(steels[name]):8.2f} ms" if name in steels else ""
        print(f"{name:35s} {statistics.median(values):8.0f} ns a particle-step   structure {steel} a step")


if __name__ == "__main__":
    main()
