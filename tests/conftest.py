"""Fixtures that every test folder shares."""

from __future__ import annotations

from pathlib import Path

import pytest

SHARED = Path(__file__).resolve().parents[2] / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """The read-only reference data that stands beside the repository (../shared); skips where it is missing."""
    if not SHARED.is_dir():
        pytest.skip("the reference data (../shared, beside the repository) is not on this machine")
    return SHARED
