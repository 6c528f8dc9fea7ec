"""Seconds a frame of one million particles with every particle array, by format and precision.

    .venv/bin/python tests/benchmarks/bench_vtk.py [FOLDER] [--particles N] [--frames K]

FOLDER should be in memory (/dev/shm) to measure the writer apart from the disk; `copy` is the same number of bytes
written from one array, the least that any writer of such a file could take there.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.vtk import write_points

SHAPES = {
    "velocity": 3, "density": 1, "mass": 1, "radius": 1, "pressure": 1, "stress": 6, "von_mises": 1,
    "plastic_strain": 1, "displacement": 3,
}  # fmt: skip


def particle_arrays(count: int) -> tuple[NDArray[np.float64], dict[str, NDArray[np.float64] | NDArray[np.int64]]]:
    """Points (count, 3) and every array of the result folder, random."""
    random = np.random.default_rng(1)
    arrays: dict[str, NDArray[np.float64] | NDArray[np.int64]] = {
        "id": np.arange(1, count + 1),
        "material": np.full(count, 1),
    }
    for name, components in SHAPES.items():
        values = random.random((count, components))
        arrays[name] = values[:, 0].copy() if components == 1 else values
    return random.random((count, 3)), arrays


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", default="/dev/shm")
    parser.add_argument("--particles", type=int, default=1_000_000)
    parser.add_argument("--frames", type=int, default=9)
    given = parser.parse_args()
    points, arrays = particle_arrays(given.particles)
    with tempfile.TemporaryDirectory(dir=given.folder) as folder:
        for format in ("vtp", "vtk", "vtkhdf"):
            for precision in ("single", "double"):
                path = Path(folder) / f"frame.{format}"
                seconds = []
                for _ in range(given.frames):
                    path.unlink(missing_ok=True)
                    start = time.perf_counter()
                    write_points(path, points, arrays, 1.0, format=format, precision=precision)  # type: ignore[arg-type]
                    seconds.append(time.perf_counter() - start)
                size = path.stat().st_size
                path.unlink()
                data = np.zeros(size, np.uint8)
                copies = []
                for _ in range(given.frames):
                    start = time.perf_counter()
                    with path.open("wb", buffering=0) as out:
                        out.write(data.data)
                    copies.append(time.perf_counter() - start)
                    path.unlink()
                print(
                    f"{format:7s} {precision:7s} median {statistics.median(seconds):.4f} s  min {min(seconds):.4f} s  "
                    f"{size / 1e6:.0f} MB  copy {statistics.median(copies):.4f} s"
                )


if __name__ == "__main__":
    main()
