"""Speed of the translators on a mesh of 1,030,301 nodes and 1,000,000 hexahedra: each format written, and read again.

    python tests/benchmarks/bench_translators.py [PYTHON_WITH_DYNARS]

Each reading is a process of its own: seconds of `read` alone (medians of three, the first start's compilation apart)
and the peak memory of the process. With a Python that has `dynars` (PyPI) installed, its reading of the .k is timed in
turn with ours.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from zrno.translators import load_settings, to_particles, write
from zrno.translators.fem import to_fem
from zrno.translators.formats import FORMATS
from zrno.translators.model import ElementBlock, Material, Model, NodeSet, Part, Section

SIDE = 100
OURS = """
import sys, time
from zrno.translators import read
started = time.perf_counter()
model = read(sys.argv[1])
seconds = time.perf_counter() - started
peak = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(seconds, int(peak.split()[1]) / 1024)
"""
DYNARS = """
import sys, time
import dynars
started = time.perf_counter()
file = dynars.parse_keyword_file(sys.argv[1])
tables = file.parse_builtin("NODE"), file.parse_builtin("ELEMENT_SOLID")
seconds = time.perf_counter() - started
peak = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(seconds, int(peak.split()[1]) / 1024)
"""


def cube(side: int) -> Model:
    """side^3 hexahedra of steel, one part, one set."""
    n = side + 1
    axis = np.linspace(0.0, 1.0, n)
    xyz = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    first = np.arange(n**3).reshape(n, n, n)[:-1, :-1, :-1].ravel()
    corners = np.array([0, n * n, n * n + n, n, 1, n * n + 1, n * n + n + 1, n + 1])
    model = Model(title="cube", node_ids=np.arange(1, n**3 + 1), xyz=xyz, parts={1: Part(1, "cube", 1, section=1)})
    model.blocks = [
        ElementBlock("hex8", np.arange(1, side**3 + 1), first[:, None] + corners, np.ones(side**3, np.int64), "solid")
    ]
    model.sections = {1: Section(1, "solid", "solid")}
    model.materials = {1: Material(1, "steel", "elastic", 7.8e-9, {"E": 2.1e5, "nu": 0.3})}
    model.node_sets = [NodeSet(1, "floor", np.arange(n * n))]
    return model


def timed(python: str, script: str, path: Path) -> tuple[float, float]:
    """Seconds and peak MB of a reading in a process of its own."""
    said = subprocess.run([python, "-c", script, str(path)], capture_output=True, text=True, check=True).stdout.split()
    return float(said[0]), float(said[1])


def main(peer: str | None) -> None:
    """Print a row a format."""
    model = cube(SIDE)
    settings = load_settings(overrides={"end_time": 1, "sets.floor.fixed": "all"})
    deck, _ = to_fem(model, settings)
    with tempfile.TemporaryDirectory() as folder:
        for row in FORMATS:
            suffix = row.extensions[0]
            if not row.writer or suffix == ".vtu":
                continue
            source = to_particles(model, settings)[0] if suffix == ".mcm" else deck if suffix == ".dat" else model
            path = Path(folder) / f"cube{suffix}"
            times = []
            for _ in range(3):
                started = time.perf_counter()
                write(source, path)
                times.append(time.perf_counter() - started)
            timed(sys.executable, OURS, path)  # compiles
            runs: list[tuple[float, float]] = []
            peers: list[tuple[float, float]] = []
            for _ in range(3):
                runs.append(timed(sys.executable, OURS, path))
                if peer and suffix == ".k":
                    peers.append(timed(peer, DYNARS, path))
            seconds, memory = (statistics.median(column) for column in zip(*runs, strict=True))
            size = path.stat().st_size / 1e6
            print(
                f"{suffix:5} {size:6.0f} MB  written {statistics.median(times):5.2f} s  read {seconds:5.2f} s, "
                f"peak {memory:5.0f} MB"
            )
            if peers:
                print(f"      dynars {statistics.median(s for s, _ in peers):.2f} s")
            path.unlink()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
