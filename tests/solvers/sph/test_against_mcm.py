"""The original program's own results, to round-off where the original is followed.

Limits as the reference allows: positions 0.01 % of h, velocities 0.1 % of the impact speed, von
Mises 0.1 % of its largest value. What is reached is two orders better, so the limits here are a tenth of those.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines.build import particle_problem
from zrno.solvers.sph import Solver
from zrno.translators import read


@pytest.mark.parametrize("name", ["block20k", "kupa1f", "newhop3f"])
def test_results_lie_on_those_of_mcm(shared: Path, name: str) -> None:
    deck = shared / "reference/mcm" / f"{name}.mcm"
    reference = np.load(deck.with_suffix(".npz"))
    problem = particle_problem(read(deck), str(deck), original=True)
    solver = Solver(problem)
    h, speed = problem.h.min(), np.abs(problem.v).max()

    def rms(difference: np.ndarray) -> float:
        return float(np.sqrt(np.mean(np.sum(difference.reshape(len(problem.x), -1) ** 2, axis=1))))

    for k, label in enumerate(reference["times"]):
        if label > 0.0:
            solver.advance(float(label) * (1.0 - 1e-6), 10**9)
        assert solver.step == reference["steps"][k] - 1  # it counts the step to come
        assert solver.time == pytest.approx(label, rel=1e-6)
        assert solver.dt == pytest.approx(reference["dt"][k], rel=1e-5)
        got = solver.frame().particles
        assert rms(got["position"] - reference[f"x{k}"]) < 1e-5 * h
        assert rms(got["velocity"] - reference[f"v{k}"]) < 1e-4 * speed
        assert rms(got["density"] - reference[f"rho{k}"]) < 1e-5 * problem.density.max()
        if k:
            largest = reference[f"vm{k}"].max()
            assert rms(got["von_mises"] - reference[f"vm{k}"]) < 1e-4 * largest
            assert rms(got["pressure"] - reference[f"p{k}"]) < 1e-4 * np.abs(reference[f"p{k}"]).max()


def test_a_fluid_between_symmetry_planes_lies_on_that_of_mcm(shared: Path) -> None:
    """Murnaghan's water settles under its weight: within 0.1 % of the largest pressure.

    Not to round-off: its steps are 1e-4 shorter at times, for a reason that its source pages do not tell.
    """
    deck = shared / "reference/mcm/water2d.mcm"
    reference = np.load(deck.with_suffix(".npz"))
    problem = particle_problem(read(deck), str(deck), original=True)
    solver = Solver(problem)
    for k, label in enumerate(reference["times"][1:], start=1):
        solver.advance(float(label) * (1.0 - 1e-6), 10**9)
        assert solver.step == reference["steps"][k] - 1
        got = solver.frame().particles
        assert np.abs(got["position"] - reference[f"x{k}"]).max() < 2e-4 * problem.h[0]
        assert np.abs(got["pressure"] - reference[f"p{k}"]).max() < 1e-3 * reference[f"p{k}"].max()
