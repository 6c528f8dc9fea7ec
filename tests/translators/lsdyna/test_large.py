"""A deck of a million nodes and a million hexahedra: that it is right, and what memory it takes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.lsdyna import read

N = 100


def write_grid(path: Path) -> None:
    """A grid of N x N x N cubes, 156 MB of text."""
    steps = np.arange(N + 1)
    z, y, x = (axis.ravel() * 0.0123456789 for axis in np.meshgrid(steps, steps, steps, indexing="ij"))
    k, j, i = (axis.ravel() for axis in np.meshgrid(steps[:-1], steps[:-1], steps[:-1], indexing="ij"))
    row, layer = N + 1, (N + 1) ** 2
    first = k * layer + j * row + i + 1
    corners = np.stack([first + d for d in (0, 1, 1 + row, row)] + [first + layer + d for d in (0, 1, 1 + row, row)], 1)
    with path.open("w") as file:
        file.write("*KEYWORD\n*NODE\n")
        for start in range(0, len(x), 100_000):
            part = slice(start, start + 100_000)
            rows = zip(x[part].tolist(), y[part].tolist(), z[part].tolist(), strict=True)
            file.write("".join(f"{n:8d}{a:16.9e}{b:16.9e}{c:16.9e}{0:8d}{0:8d}\n"
                               for n, (a, b, c) in enumerate(rows, start + 1)))  # fmt: skip
        file.write("*ELEMENT_SOLID\n")
        form = "%8d" * 10 + "\n"
        for start in range(0, len(corners), 100_000):
            rows = corners[start : start + 100_000].tolist()
            file.write("".join(form % (n, 1, *nodes) for n, nodes in enumerate(rows, start + 1)))
        file.write("*END\n")


@pytest.mark.slow
def test_a_million_nodes(tmp_path: Path) -> None:
    path = tmp_path / "grid.k"
    write_grid(path)
    model = read(path)
    assert model.node_ids.tolist() == list(range(1, (N + 1) ** 3 + 1))
    (block,) = model.blocks
    assert (block.kind, block.nodes.shape) == ("hex8", (N**3, 8))
    edge = model.xyz[block.nodes[:, 6]] - model.xyz[block.nodes[:, 0]]
    assert np.allclose(edge, 0.0123456789, rtol=1e-6)
    assert model.xyz[-1].tolist() == [float(f"{N * 0.0123456789:.9e}")] * 3
    code = (  # the process's own peak: ru_maxrss would begin with that of the process that starts it
        "import sys; from zrno.translators.lsdyna import read; read(sys.argv[1]);"
        "print(next(line.split()[1] for line in open('/proc/self/status') if line.startswith('VmHWM')))"
    )
    run = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True)
    assert int(run.stdout) < 600 * 1024
