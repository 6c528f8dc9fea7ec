"""Fixtures that every test folder shares."""

from __future__ import annotations

from pathlib import Path

import pytest

SHARED = Path(__file__).resolve().parents[2] / "shared"
PLATE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 3 "edge"
2 7 "plate"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 2 0 0
3 2 1 0
4 0 1 0
$EndNodes
$Elements
2
1 1 2 3 1 1 2
2 3 2 7 1 1 2 3 4
$EndElements
"""


@pytest.fixture(scope="session")
def shared() -> Path:
    """The read-only reference data that stands beside the repository (../shared); skips where it is missing."""
    if not SHARED.is_dir():
        pytest.skip("the reference data (../shared, beside the repository) is not on this machine")
    return SHARED


@pytest.fixture
def plate_msh() -> str:
    """A gmsh mesh of one quadrilateral, 2 by 1: the part `plate`, number 7, and a named edge."""
    return PLATE
