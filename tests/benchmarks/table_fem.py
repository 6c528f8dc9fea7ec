"""The table of linear benchmarks of solvers/fem/VERIFICATION.md: value, reference, error, unknowns, seconds.

    .venv/bin/python tests/benchmarks/table_fem.py

References are those of reference/fem/linear_benchmarks.csv (MacNeal & Harder 1985, NAFEMS, Timoshenko, Ko et al.), each
on meshes that get finer. Seconds: from the mesh in memory to the answer, kernels compiled before.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import fem_cases as cases
from fem_meshes import nine, quads

Row = tuple[str, str, float, float, str, list[tuple[str, Callable[[], cases.Found]]]]


def squares(build: Callable[[int], cases.Found], sizes: tuple[int, ...]) -> list[tuple[str, Callable[[], cases.Found]]]:
    """Meshes of n x n elements."""
    return [(f"{n} x {n}", lambda n=n: build(n)) for n in sizes]  # type: ignore[misc]


def boxes(
    build: Callable[[tuple[int, int, int]], cases.Found], sizes: tuple[tuple[int, int, int], ...]
) -> list[tuple[str, Callable[[], cases.Found]]]:
    """Meshes of bricks."""
    return [(" x ".join(map(str, cuts)), lambda cuts=cuts: build(cuts)) for cuts in sizes]  # type: ignore[misc]


SHELL, NINE, BRICK = "4-node shell, enhanced", "9-node shell", "hex8, enhanced"
BEAM = ((6, 1, 1), (12, 2, 1), (24, 4, 2))

# id, what, reference, suggested tolerance [%], element, meshes
ROWS: list[Row] = [
    ("SLR", "Scordelis-Lo roof", 0.3024, 1.0, SHELL, squares(cases.roof, (8, 16, 32, 64))),
    ("PCD", "pinched cylinder", 1.8248e-5, 3.0, SHELL, squares(cases.cylinder, (16, 32, 64))),
    ("HS18", "pinched hemisphere, hole", 0.0940, 1.5, SHELL, squares(cases.hemisphere, (8, 16, 32, 64))),
    ("HS", "pinched hemisphere, whole", 0.0924, 1.5, SHELL,
     [(f"3 x {n} x {n}", lambda n=n: cases.full_hemisphere(n, quads, 6.825e7, 1.0)) for n in (8, 16, 32)]),
    *((name, f"twisted beam, {what}", reference, 1.0, SHELL,
       [(f"{n} x {n // 6}", lambda n=n, t=t, dof=dof: cases.twisted(n, t, dof)) for n in (12, 24, 48)])
      for name, what, reference, t, dof in (
          ("TB1", "thick, in plane", 5.424e-3, 0.32, 1), ("TB2", "thick, out of plane", 1.754e-3, 0.32, 2),
          ("TB3", "thin, in plane", 5.256e-3, 0.0032, 1), ("TB4", "thin, out of plane", 1.294e-3, 0.0032, 2))),
    ("SC1", "cantilever, pulled", 3e-5, 1.0, BRICK, boxes(lambda cuts: cases.straight_beam(cuts, 0), BEAM)),
    ("SC2", "cantilever, in plane", 0.1081, 2.0, BRICK, boxes(lambda cuts: cases.straight_beam(cuts, 1), BEAM)),
    ("SC3", "cantilever, out of plane", 0.4321, 2.0, BRICK, boxes(lambda cuts: cases.straight_beam(cuts, 2), BEAM)),
    ("SC4", "cantilever, twisted", 0.03411, 10.0, BRICK,
     boxes(cases.twist_of_bricks, ((6, 1, 1), (24, 8, 4), (48, 12, 8)))),
    ("SC4", "the same", 0.03411, 10.0, NINE,
     [(f"{n} x {n // 6}", lambda n=n: cases.twist_of_shells(n)) for n in (12, 24)]),
    ("CB1", "curved beam, in plane", 0.088519352226485, 2.0, SHELL,
     [(f"{n} x {n // 12}", lambda n=n: cases.curved(n, 0)) for n in (24, 48)]),
    ("CB2", "curved beam, out of plane", 0.498301636614788, 2.0, SHELL,
     [(f"{n} x {n // 12}", lambda n=n: cases.curved(n, 2)) for n in (24, 48)]),
    ("CB1", "the same", 0.088519352226485, 2.0, BRICK,
     [(f"{n} x {n // 6} x {n // 12}", lambda n=n: cases.curved_solid(n, 0)) for n in (24, 48)]),
    ("CB2", "the same", 0.498301636614788, 2.0, BRICK,
     [(f"{n} x {n // 6} x {n // 12}", lambda n=n: cases.curved_solid(n, 2)) for n in (24, 48)]),
    *((name, f"square plate, {what}", reference, 1.0, SHELL,
       squares(lambda n, clamped=clamped, point=point: cases.plate(n, clamped, point), (8, 16, 32)))
      for name, what, reference, clamped, point in (
          ("RP1", "clamped, pressed", 0.00126532, True, False), ("RP2", "supported, pressed", 0.004062, False, False),
          ("RP3", "clamped, point load", 0.005612, True, True),
          ("RP4", "supported, point load", 0.011601, False, True))),
    ("RH", "Raasch's hook", 5.02, 5.0, SHELL, [(f"{12 * n} x {n}", lambda n=n: cases.hook(n)) for n in (4, 8, 16)]),
    ("COOK", "Cook's membrane", 23.9642, 1.0, "quad4, enhanced", squares(cases.cook, (16, 32, 64))),
    ("LE1", "elliptic membrane, sigma_yy", 92.7, 2.0, "quad8",
     [(f"{n} x {3 * n // 2}", lambda n=n: cases.le1(n)) for n in (4, 8, 16)]),
    ("LE3", "hemisphere, ux", 0.185, 2.0, SHELL,
     [(f"3 x {n} x {n}", lambda n=n: cases.full_hemisphere(n)) for n in (8, 16, 32)]),
    ("LE3", "the same", 0.185, 2.0, NINE,
     [(f"3 x {n} x {n}", lambda n=n: cases.full_hemisphere(n, nine)) for n in (4, 8, 16)]),
    ("LE10", "thick plate, sigma_yy", -5.38, 2.0, "hex20",
     [(f"{n} x {4 * n // 3} x {m}", lambda n=n, m=m: cases.le10(n, m)) for n, m in ((6, 4), (9, 4), (12, 8))]),
]  # fmt: skip


def main() -> None:
    """Print the table, a row a mesh."""
    print("| | case | element | mesh | unknowns | value | reference | error % | asked % | seconds |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, what, reference, asked, element, meshes in ROWS:
        meshes[0][1]()  # kernels
        for k, (mesh, run) in enumerate(meshes):
            begin = time.perf_counter()
            value, solver = run()
            seconds = time.perf_counter() - begin
            unknowns = solver.assembly.system.n
            error = 100.0 * (value / reference - 1.0)
            head = (name, what, element) if k == 0 else ("", "", "")
            end = (f"{reference:.6g}", f"{error:+.2f}", f"{asked:g}" if k == len(meshes) - 1 else "")
            print(
                "|", " | ".join([*head, mesh, str(unknowns), f"{value:.6g}", *end, f"{seconds:.2f}"]), "|", flush=True
            )


if __name__ == "__main__":
    sys.exit(main())
