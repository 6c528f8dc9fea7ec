"""A block on a plate, the original programs' own run (reference/coupled): as they do it, and with real forces."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines import load, run

CENTRE = 60  # node 61


def computed(shared: Path, output: Path, **options: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The plate's centre period by period (40,); lowest place and mean speed of the block, (41,) each."""
    decks = [shared / "reference/coupled" / f"cplate.{kind}" for kind in ("mcm", "dat")]
    run(decks, output=output, options=options)
    found = load(output)
    assert len(found.times) == 41
    centre = np.array([found.arrays("elements", k)["displacement"][CENTRE, 2] for k in range(1, 41)])
    block = [found.arrays("particles", k) for k in range(41)]
    return (
        centre,
        np.array([p["position"][:, 2].min() for p in block]),
        np.array([p["velocity"][:, 2].mean() for p in block]),
    )


@pytest.mark.slow
def test_the_originals_curve_is_met_as_the_original_does_it(shared: Path, tmp_path: Path) -> None:
    """With its misplaced forces, a plate without inertia and the time it loses; its block goes through the plate."""
    wanted = np.loadtxt(shared / "reference/coupled/cplate_center.csv", delimiter=",", skiprows=1)[:, 1]
    centre, lowest, speed = computed(shared, tmp_path / "original", compat="original")
    assert centre[0] == wanted[0] == 0.0
    assert np.abs(centre - wanted).max() < 0.025 * np.abs(wanted).max()
    assert centre[1:19] == pytest.approx(wanted[1:19], rel=0.02)  # over six decades, up to the first turn
    assert lowest[-1] < -4.0
    assert speed[-1] == pytest.approx(-19.9, abs=0.05)


@pytest.mark.slow
def test_with_real_forces_the_block_bounces(shared: Path, tmp_path: Path) -> None:
    """f is W(r)/W(h), four times the original's, to the fourth power; forces are masses times accelerations.

    The block's sums stay plain, as the original's: with the gradient correction it keeps more of it as its own ringing
    and leaves at 16.8.
    """
    centre, lowest, speed = computed(shared, tmp_path / "real", **{"sph.correction": False})
    assert lowest.min() > 0.4
    assert speed[-1] == pytest.approx(19.3, abs=0.2)
    assert centre.min() == pytest.approx(-0.217, abs=0.005)
    assert np.abs(centre[-8:]).max() < 0.006  # the plate swings on when the block has left
