"""Speed of finite elements, beside CalculiX (`ccx`) on the same meshes in the same run.

    .venv/bin/python tests/benchmarks/bench_fem.py [--peers ../shared/peers/fem] [--threads 1 2] [--repeat 3] [CASE...]

Cases: cant50k (52 k unknowns), cant200k (207 k), plast30k (31 k, von Mises, ten increments), roof70 (shells, 30 k).
Ours: seconds from the mesh in memory to stresses in memory, in a process that has its kernels; CalculiX: its whole
process, whose input and output are small beside it. Both are run by turns; the median is told, and the ratio. Memory:
the peak of a process of its own each, interpreter and libraries included, by GNU time (else not told).
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from zrno.solvers import fem
from zrno.solvers.materials import Elastic, von_mises

GNU_TIME = "/usr/bin/time"
CASES = ("cant50k", "cant200k", "plast30k", "roof70")
INPUT = {"cant50k": "cant50k_C3D8", "cant200k": "cant200k_C3D8", "plast30k": "plast30k_C3D8", "roof70": "roof70_S4"}


def abaqus(path: Path) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """Nodes, elements and node sets (indices) of a plain input file."""
    nodes, elements, sets = [], [], {}
    where, name = "", ""
    for line in path.read_text().splitlines():
        if line.startswith("*"):
            head = line.upper()
            where = head.split(",")[0]
            if where == "*NSET":
                name = head.split("NSET=")[1].split(",")[0]
                sets[name] = []
            continue
        if where == "*NODE":
            nodes.append([float(v) for v in line.split(",")[1:4]])
        elif where == "*ELEMENT":
            elements.append([int(v) - 1 for v in line.split(",")[1:] if v.strip()])
        elif where == "*NSET":
            sets[name] += [int(v) - 1 for v in line.split(",") if v.strip()]
    return np.array(nodes), np.array(elements), {k: np.array(v) for k, v in sets.items()}


def problem(case: str, peers: Path) -> fem.Problem:
    """A case as ours, on CalculiX's mesh."""
    x, nodes, sets = abaqus(peers / f"{INPUT[case]}.inp")
    n = len(x)
    fixed = np.zeros((n, 6), bool)
    ids = np.arange(1, len(nodes) + 1)
    if case == "roof70":
        crown, middle, end = x[:, 0] < 1e-9, x[:, 1] < 1e-9, x[:, 1] > x[:, 1].max() - 1e-9
        for rows, held in ((end, (0, 2)), (middle, (1, 3, 5)), (crown, (0, 4, 5))):
            for dof in held:
                fixed[rows, dof] = True
        law: Any = Elastic.from_engineering(4.32e8, 0.0)
        elements = fem.Elements(
            "quad4", "shell", nodes, ids, 1, law, density=360.0, thickness=np.full(len(nodes), 0.25)
        )
        weight = fem.BodyLoad(np.array([0.0, 0.0, -1.0]))
        return fem.Problem(case, 3, x, np.arange(1, n + 1), (elements,), fixed, body_loads=(weight,))
    tip = sets["TIP"]
    fixed[sets["FIX"], :3] = True
    if case == "plast30k":
        law = von_mises(210000.0, 0.3, 250.0, 2000 * 210000.0 / (210000.0 + 2000.0))
        elements = fem.Elements("hex8", "solid", nodes, ids, 1, law)
        curve = fem.Curve(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
        motion = fem.Motion(tip, np.full(len(tip), 2), np.full(len(tip), -6.0), 0)
        how = fem.Iteration(force=1e-4, most=30)  # CalculiX's own default tolerance
        return fem.Problem(case, 3, x, np.arange(1, n + 1), (elements,), fixed, curves=(curve,), motions=(motion,),
                           steps=((10, 0.1),), iteration=how)  # fmt: skip
    elements = fem.Elements("hex8", "solid", nodes, ids, 1, Elastic.from_engineering(210000.0, 0.3))
    load = fem.NodalLoad(tip, np.full(len(tip), 2), np.full(len(tip), -1000.0 / len(tip)))
    return fem.Problem(case, 3, x, np.arange(1, n + 1), (elements,), fixed, nodal_loads=(load,))


def ours(p: fem.Problem, threads: int) -> tuple[float, float, str]:
    """Wall and CPU seconds, and what came out."""
    start, cpu = time.perf_counter(), time.process_time()
    solver = fem.Solver(p, threads=threads)
    for _ in range(len(p.ends()) - 1):
        solver.advance(np.inf, 1)
    told = f"largest displacement {np.abs(solver.shape.u[:, :3]).max():.6g}"
    if p.motions:
        held = p.fixed[:, 2]
        told = f"reaction {solver.reaction[held, 2].sum():.6g}, {solver.assembly.system.factorisations} factorisations"
    return time.perf_counter() - start, time.process_time() - cpu, told


def calculix(case: str, peers: Path, threads: int) -> tuple[float, float]:
    """Wall and CPU seconds of a whole run."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(peers / f"{INPUT[case]}.inp", Path(folder) / "case.inp")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.perf_counter()
        environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "CCX_NPROC_EQUATION_SOLVER": str(threads)}
        done = subprocess.run(["ccx", "case"], cwd=folder, env=environment, capture_output=True, check=False)
        wall = time.perf_counter() - start
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode:
            print(done.stdout.decode()[-500:])
        return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def peak(command: list[str], folder: Path, threads: int) -> float:
    """Megabytes of a process, by GNU time: the kernel counts what a parent had before it to a child of its own."""
    told = folder / "peak"
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "CCX_NPROC_EQUATION_SOLVER": str(threads)}
    measured = [GNU_TIME, "-f", "%M", "-o", str(told), *command]
    subprocess.run(measured, cwd=folder, env=environment, capture_output=True, check=False)
    return int(told.read_text().split()[-1]) / 1024


def peaks(case: str, peers: Path, threads: int) -> str:
    """Ours, and CalculiX's where it is installed."""
    if not Path(GNU_TIME).exists():
        return ""
    with tempfile.TemporaryDirectory() as folder:
        where = Path(folder)
        own = [sys.executable, str(Path(__file__).resolve()), case, "--once", "--peers", str(peers.resolve())]
        told = f"; peak {peak([*own, '--threads', str(threads)], where, threads):.0f} MB"
        if shutil.which("ccx") is not None:
            shutil.copy(peers / f"{INPUT[case]}.inp", where / "case.inp")
            told += f", ccx {peak(['ccx', 'case'], where, threads):.0f} MB"
    return told


def main() -> None:
    """Run the cases and print a row each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", default=list(CASES))
    parser.add_argument("--peers", type=Path, default=Path(__file__).resolve().parents[3] / "shared/peers/fem")
    parser.add_argument("--threads", type=int, nargs="*", default=[1, 2])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--once", action="store_true", help="solve once and say nothing: for the peak of memory")
    chosen = parser.parse_args()
    if chosen.once:
        for case in chosen.cases:
            ours(problem(case, chosen.peers), chosen.threads[0])
        return
    with_peer = shutil.which("ccx") is not None
    for case in chosen.cases:
        p = problem(case, chosen.peers)
        ours(p, 1)  # kernels
        for threads in chosen.threads:
            mine, theirs, told = [], [], ""
            for _ in range(chosen.repeat):
                wall, cpu, told = ours(p, threads)
                mine.append((wall, cpu))
                if with_peer:
                    theirs.append(calculix(case, chosen.peers, threads))
            a = [statistics.median(column) for column in zip(*mine, strict=True)]
            line = f"{case:9} {threads} thread(s): ours {a[0]:.2f} s wall, {a[1]:.2f} s CPU ({told})"
            if theirs:
                b = [statistics.median(column) for column in zip(*theirs, strict=True)]
                line += (
                    f"; ccx {b[0]:.2f} s wall, {b[1]:.2f} s CPU; ours/ccx {a[0] / b[0]:.2f} wall, {a[1] / b[1]:.2f} CPU"
                )
            print(line + peaks(case, chosen.peers, threads), flush=True)


if __name__ == "__main__":
    sys.exit(main())
