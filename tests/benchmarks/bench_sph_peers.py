"""Speed of the particle solver beside LAMMPS' MACHDYN (`lmp`) on the peers' scene, in the same run by turns.

    .venv/bin/python tests/benchmarks/bench_sph_peers.py [--cells 22 37] [--repeat 3] [--steps 50]

Two elastic cubes of 2 x 2 x 2 cm meet at 100 m/s each; h = 1.3 spacings, cubic kernel, 70 to 80 neighbours; 22
particles an edge are 21 296, 37 are 101 306. Then two rings in the plane. Rates are particle-steps a CPU-second of one
thread, without start and compiling; two threads beside one by turns, by the wall. Debian's LAMMPS has no MACHDYN:
without it our own figures alone are told.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from zrno.solvers.materials import Elastic
from zrno.solvers.sph import Body, Cures, Problem, Solver

CURES = {
    "plain": Cures(),
    "correction": Cures(correction=True),
    "artificial stress and correction": Cures(artificial_stress=0.3, correction=True),
}


def blocks(cells: int, *, cures: Cures | None = None) -> Problem:
    """The scene, in mm, ms, kg and GPa as LAMMPS has it."""
    dx = 20.0 / cells
    grid = dx * (np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) + 0.5)
    x = np.concatenate([grid - np.array([20.0 + dx, 0.0, 0.0]), grid + np.array([dx, 0.0, 0.0])])
    half, n = len(grid), 2 * len(grid)
    v = np.zeros((n, 3))
    v[:half, 0], v[half:, 0] = 100.0, -100.0
    law = Elastic.from_engineering(70.0, 0.33)
    rho = 2.7e-6
    return Problem(
        dimension=3, x=x, v=v, mass=np.full(n, rho * dx**3), h=np.full(n, 1.3 * dx), density=np.full(n, rho),
        body=np.repeat([0, 1], half),
        bodies=tuple(Body(i, "block", law, rho, 0.5, 2.0) for i in (1, 2)),
        end_time=1e9, cures=cures or Cures(),
    )  # fmt: skip


def rings() -> Problem:
    """Two elastic rings of 30 and 40 mm in plane strain meet at 10 m/s each; h = 1.5 spacings, 28 neighbours."""
    dx, rho = 0.47, 1.2e-6
    side = dx * (np.arange(-90, 91) + 0.5)
    x = np.stack(np.meshgrid(side, side, [0.0], indexing="ij"), axis=-1).reshape(-1, 3)
    x = x[(np.hypot(x[:, 0], x[:, 1]) > 30.0) & (np.hypot(x[:, 0], x[:, 1]) < 40.0)]
    half, n = len(x), 2 * len(x)
    v = np.zeros((n, 3))
    v[:half, 0], v[half:, 0] = 10.0, -10.0
    away = np.array([41.5, 0.0, 0.0])
    law = Elastic.from_engineering(0.03, 0.3975)
    return Problem(
        dimension=2, x=np.concatenate([x - away, x + away]), v=v, mass=np.full(n, rho * dx**2),
        h=np.full(n, 1.5 * dx), density=np.full(n, rho), body=np.repeat([0, 1], half),
        bodies=tuple(Body(i, "ring", law, rho, 0.5, 2.0) for i in (1, 2)), end_time=1e9,
    )  # fmt: skip


def ours(problem: Problem, steps: int, threads: int = 1) -> tuple[float, float, float]:
    """Particle-steps a CPU-second and a wall second after the first steps, and MB of the process."""
    solver = Solver(problem, threads=threads)
    solver.advance(1e9, 3)
    wall, cpu = time.perf_counter(), time.process_time()
    solver.advance(1e9, steps)
    done = solver.n * steps
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return done / (time.process_time() - cpu), done / (time.perf_counter() - wall), peak


def lammps(script: Path, cells: int, steps: int) -> float:
    """Particle-steps a second that it says of its own loop."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["lmp", "-in", str(script), "-var", "nx", str(cells), "-var", "steps", str(steps)]
        told = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False).stdout
    found = re.findall(r"Loop time of ([\d.e+-]+) on 1 procs for (\d+) steps with (\d+) atoms", told)
    if not found:
        print(told[-800:])
        return float("nan")
    seconds, done, atoms = found[-1]
    return int(done) * int(atoms) / float(seconds)


def tell(
    name: str, scene: Callable[[], Problem], repeat: int, steps: int, theirs: Callable[[], float] | None = None
) -> None:
    """Print a row: medians of one and two threads and the peer by turns."""
    for threads in (1, 2):
        ours(scene(), 3, threads)  # kernels
    one, two, peer = [], [], []
    for _ in range(repeat):
        one.append(ours(scene(), steps))
        two.append(ours(scene(), steps, 2))
        if theirs:
            peer.append(theirs())
    cpu = statistics.median(m[0] for m in one)
    faster = statistics.median(b[1] / a[1] for a, b in zip(one, two, strict=True))
    other = f"{statistics.median(peer) / 1e6:6.2f}" if peer else " " * 6
    n = len(scene().x)
    print(
        f"{n:9} {name:34} {cpu / 1e6:8.2f} {two[-1][2]:9.0f} {faster:11.2f} {other}  {os.getloadavg()[0]:.1f}",
        flush=True,
    )


def main() -> None:
    """Print a row a size and kind."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, nargs="*", default=[22, 37])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--steps", type=int, default=50)
    parser.add_argument("--script", type=Path,
                        default=Path(__file__).resolve().parents[3] / "shared/peers/sph/lmp_block3d.in")  # fmt: skip
    chosen = parser.parse_args()
    said = (
        subprocess.run(["lmp", "-h"], capture_output=True, text=True, check=False).stdout if shutil.which("lmp") else ""
    )
    peer = "smd/ulsph" in said
    print(f"{'particles':>9} {'scene':34} {'M/s CPU':>8} {'MB so far':>9} {'two threads':>11} {'ulsph':>6}  load")
    for cells in chosen.cells:
        for name, cures in CURES.items():
            theirs = partial(lammps, chosen.script, cells, chosen.steps) if peer and name == "plain" else None
            tell(f"blocks, {name}", partial(blocks, cells, cures=cures), chosen.repeat, chosen.steps, theirs)
    tell("rings in the plane", rings, chosen.repeat, chosen.steps)


if __name__ == "__main__":
    sys.exit(main())
