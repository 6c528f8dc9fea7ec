"""The cap model at a point: hydrostatic, uniaxial strain and triaxial compression of McCormick Ranch sand.

    python cap_point.py [FOLDER]

prints the differences from the references and draws cap_point.png. Stresses in ksi, compression positive here.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from zrno.solvers.materials import CapHardening, cap
from zrno.solvers.materials.point import Path as Answer
from zrno.solvers.materials.point import Point, drive

BULK, SHEAR, ALPHA, GAMMA, BETA, RATIO = 66.7, 40.0, 0.25, 0.18, 0.67, 2.5
LIMIT, DECAY, FIRST = 0.066, 0.67, 0.189  # W, D, X0
SAND = cap(BULK, SHEAR, ALPHA, gamma=GAMMA, decay=BETA, ratio=RATIO, hardening=CapHardening(LIMIT, DECAY, FIRST))
LATERAL = (False, True, True, False, False, False)


def pressed(strain: float, steps: int, *, sides: bool) -> np.ndarray:
    """(steps, 6) increments of a compression along x, and along y and z with `sides`."""
    increments = np.zeros((steps, 6))
    increments[:, : 3 if sides else 1] = -strain / steps
    return increments


def hydrostatic(strain: float = 0.12, steps: int = 400) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Volume strain, pressure, and the exact volume strain of that pressure: p/K + W (1 - exp(-D (3 p - X0)))."""
    path = drive(SAND, pressed(strain / 3.0, steps, sides=True))
    pressure = -path.stress[:, 0]
    compaction = LIMIT * (1.0 - np.exp(-DECAY * np.maximum(0.0, 3.0 * pressure - FIRST)))
    return -path.strain[:, :3].sum(axis=1), pressure, pressure / BULK + compaction


def uniaxial(strain: float = 0.05, steps: int = 1000) -> Answer:
    """Sides held."""
    return drive(SAND, pressed(strain, steps, sides=False))


def triaxial(confining: float, strain: float = 0.3, steps: int = 600) -> Answer:
    """Pressed on all sides first, then along x while the lateral stress stays."""
    point = Point(SAND)
    squeeze = np.full((50, 6), 0.0)
    squeeze[:, :3] = -1e-9
    stress = np.zeros((50, 6))
    stress[:, :3] = -confining * np.arange(1, 51)[:, None] / 50.0
    point.hold(squeeze, (True, True, True, False, False, False), stress)
    return point.hold(pressed(strain, steps, sides=False), LATERAL, np.tile(stress[-1], (steps, 1)))


def strength(confining: float) -> float:
    """Axial less lateral stress q where the path I = 3 confining + q meets q / sqrt(3) = alpha - gamma exp(-beta I)."""
    low, high = 0.0, 10.0 * ALPHA
    for _ in range(100):
        middle = 0.5 * (low + high)
        below = middle / np.sqrt(3.0) < ALPHA - GAMMA * np.exp(-BETA * (3.0 * confining + middle))
        low, high = (middle, high) if below else (low, middle)
    return low


def reference() -> np.ndarray:
    """Rows of axial strain, axial and lateral stress, plastic volume strain."""
    return np.genfromtxt(Path(__file__).parent / "reference/uniaxial.csv", delimiter=",", skip_header=3)


def differences() -> dict[str, float]:
    """The largest relative difference of each test from its reference."""
    volume, _, exact = hydrostatic()
    table = reference()
    table = table[table[:, 0] >= 0.01]
    path = uniaxial()
    at = np.rint(table[:, 0] / 0.05 * 1000).astype(int) - 1
    found = {"hydrostatic, volume strain": float(np.abs(volume / exact - 1.0).max())}
    for name, component, column in (("axial", 0, 1), ("lateral", 1, 2)):
        found[f"uniaxial strain, {name} stress"] = float(
            np.abs(-path.stress[at, component] / table[:, column] - 1.0).max()
        )
    for confining in (0.1, 0.3, 1.0):
        last = triaxial(confining).stress[-1]
        found[f"triaxial at {confining:g} ksi, strength"] = float(abs((last[1] - last[0]) / strength(confining) - 1.0))
    return found


def draw(file: Path) -> None:
    """The three tests with their references."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.8, 4.2), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    volume, pressure, exact = hydrostatic()
    left.plot(100 * volume, pressure, label="law")
    left.plot(100 * exact[::25], pressure[::25], "o", mfc="none", color="black", label="closed form")
    left.set(title="hydrostatic", xlabel="volume strain [%]", ylabel="pressure [ksi]")
    path, table = uniaxial(), reference()
    for name, component, column in (("axial", 0, 1), ("lateral", 1, 2)):
        middle.plot(-100 * path.strain[:, 0], -path.stress[:, component], label=f"law, {name}")
        middle.plot(100 * table[:, 0], table[:, column], "o", mfc="none", color="black")
    middle.set(title="uniaxial strain (circles: rate equations)", xlabel="axial strain [%]", ylabel="stress [ksi]")
    for confining in (0.1, 0.3, 1.0):
        test = triaxial(confining)
        start = test.strain[0, 0]
        (line,) = right.plot(
            -100 * (test.strain[:, 0] - start), test.stress[:, 1] - test.stress[:, 0], label=f"at {confining:g} ksi"
        )
        right.axhline(strength(confining), color=line.get_color(), linestyle="--", linewidth=1)
    right.set(title="triaxial (dashed: envelope)", xlabel="axial strain [%]", ylabel="axial less lateral stress [ksi]")
    for axes in (left, middle, right):
        axes.legend()
        axes.grid(alpha=0.3)
    figure.savefig(file, dpi=100)


if __name__ == "__main__":
    for test, difference in differences().items():
        print(f"{test:34} {difference:.2e}")
    draw(Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "cap_point.png")
