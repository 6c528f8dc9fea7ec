"""Published linear benchmarks of solids, plane problems and plates; `fem_cases` has them. tests/benchmarks/table_fem.py
prints them all on finer and finer meshes."""

from __future__ import annotations

import fem_cases as cases
import pytest


@pytest.mark.parametrize(("n", "within"), [(16, 0.005), (32, 0.002)])
def test_cooks_membrane(n: int, within: float) -> None:
    assert cases.cook(n)[0] == pytest.approx(23.9642, rel=within)


def test_le1_an_elliptic_membrane() -> None:
    assert cases.le1(8)[0] == pytest.approx(92.7, rel=0.02)


def test_le10_a_thick_plate() -> None:
    assert cases.le10(6)[0] == pytest.approx(-5.38, rel=0.03)


@pytest.mark.parametrize(("axis", "reference"), [(0, 3.0e-5), (1, 0.1081), (2, 0.4321)])
def test_a_straight_cantilever_of_six_bricks(axis: int, reference: float) -> None:
    """MacNeal & Harder's regular mesh: extension, in-plane and out-of-plane shear."""
    assert cases.straight_beam((6, 1, 1), axis)[0] == pytest.approx(reference, rel=0.02)


@pytest.mark.parametrize(
    ("clamped", "point", "alpha"),
    [(True, False, 0.00126532), (False, False, 0.004062), (True, True, 0.005612), (False, True, 0.011601)],
)
def test_a_square_plate(clamped: bool, point: bool, alpha: float) -> None:
    assert cases.plate(24, clamped, point)[0] == pytest.approx(alpha, rel=0.01)


@pytest.mark.parametrize(("axis", "reference", "within"), [(0, 0.088519, 0.02), (2, 0.498302, 0.04)])
def test_a_curved_beam(axis: int, reference: float, within: float) -> None:
    assert cases.curved(24, axis)[0] == pytest.approx(reference, rel=within)


def test_the_raasch_hook() -> None:
    assert cases.hook(8)[0] == pytest.approx(5.02, rel=0.03)
