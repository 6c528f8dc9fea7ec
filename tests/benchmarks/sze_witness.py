"""Is the published curve of Sze, Liu and Lo (2004), 3.6, converged? The same cylinder by CalculiX's 20-node solids.

    .venv/bin/python tests/benchmarks/sze_witness.py [--cells 20 40] [--to 54] [--step 1]

An octant of the cylinder (R 100, L 200, t 1, E 30000, nu 0.3) on rigid diaphragms, pinched by a prescribed deflection
at its middle; C3D20R, one through the thickness, NLGEOM. Prints the load over the published one at some deflections.
20 cells an edge take minutes, 40 half an hour on a busy machine. Ours: `tests/solvers/fem/test_benchmarks_shells.py`.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

RADIUS, HALF, THICKNESS = 100.0, 100.0, 1.0
FULL = 12000.0  # load of the reference; the octant bears a quarter of it
LOOKED_AT = (9.561, 15.648, 23.164, 29.375, 36.208, 51.5)
# a 20-node element's nodes on a grid of half edges, in CalculiX's order
BRICK = (
    (0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0), (2, 1, 0),
    (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1),
)  # fmt: skip


def deck(cells: int, deflection: float, step: float) -> str:
    """CalculiX's input."""
    numbers: dict[tuple[int, int, int], int] = {}
    last = 2 * cells
    elements = []
    for a in range(cells):
        for b in range(cells):
            corners = [(2 * a + i, 2 * b + j, k) for i, j, k in BRICK]
            elements.append([numbers.setdefault(c, len(numbers) + 1) for c in corners])
    lines = ["*NODE,NSET=ALL"]
    for (i, j, k), number in numbers.items():
        angle, r = 0.5 * np.pi * i / last, RADIUS + 0.5 * (k - 1) * THICKNESS
        lines.append(f"{number},{r * np.sin(angle):.12g},{HALF * j / last:.12g},{r * np.cos(angle):.12g}")
    lines.append("*ELEMENT,TYPE=C3D20R,ELSET=E")
    for number, nodes in enumerate(elements, 1):
        lines += [f"{number},{','.join(map(str, nodes[:15]))},", ",".join(map(str, nodes[15:]))]
    sets = {
        "DIAPHRAGM": [n for (_, j, k), n in numbers.items() if j == 0 and k == 1],
        "MIDDLE": [n for (_, j, _), n in numbers.items() if j == last],
        "TOPLINE": [n for (i, _, _), n in numbers.items() if i == 0],
        "SIDE": [n for (i, _, _), n in numbers.items() if i == last],
        "PINCHED": [n for (i, j, _), n in numbers.items() if i == 0 and j == last],
    }
    for name, nodes in sets.items():
        lines += [f"*NSET,NSET={name}", *(f"{n}," for n in nodes)]
    share = step / deflection
    return "\n".join(
        [
            *lines, "*MATERIAL,NAME=M", "*ELASTIC", "30000.,0.3", "*SOLID SECTION,ELSET=E,MATERIAL=M",
            "*BOUNDARY", "DIAPHRAGM,1,1", "DIAPHRAGM,3,3", "MIDDLE,2,2", "TOPLINE,1,1", "SIDE,3,3",
            "*STEP,NLGEOM,INC=2000", "*STATIC", f"{share},1.,1e-5,{share}",
            "*BOUNDARY", f"PINCHED,3,3,{-deflection}", "*NODE PRINT,NSET=PINCHED,TOTALS=ONLY", "RF", "*END STEP", "",
        ]
    )  # fmt: skip


def curve(cells: int, deflection: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Deflections and loads over the full one, as far as CalculiX comes."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "pinched.inp").write_text(deck(cells, deflection, step))
        subprocess.run(["ccx", "pinched"], cwd=folder, capture_output=True, check=False)
        printed = (Path(folder) / "pinched.dat").read_text()
    found = np.array(re.findall(r"PINCHED and time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", printed), dtype=float)
    return found[:, 0] * deflection, -found[:, 3] / (0.25 * FULL)


def main() -> None:
    """Print a row a mesh."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, nargs="*", default=[20, 40])
    parser.add_argument("--to", type=float, default=54.0)
    parser.add_argument("--step", type=float, default=1.0)
    chosen = parser.parse_args()
    table = Path(__file__).resolve().parents[3] / "shared/reference/fem/sze36_pinched_cylinder_diaphragm.csv"
    reference = np.loadtxt(table, delimiter=",", comments="#", skiprows=2)
    published = np.interp(LOOKED_AT, reference[:, 1], reference[:, 0])
    print("w            ", " ".join(f"{w:7.2f}" for w in LOOKED_AT))
    for cells in chosen.cells:
        w, load = curve(cells, chosen.to, chosen.step)
        ratio = [f"{np.interp(at, w, load) / p:7.3f}" if at <= w[-1] else "      -"
                 for at, p in zip(LOOKED_AT, published, strict=True)]  # fmt: skip
        print(f"{cells:4} x {cells:<4}  ", " ".join(ratio), flush=True)


if __name__ == "__main__":
    main()
