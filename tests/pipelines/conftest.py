"""A solver that is no solver: particles on known paths, enough to write, plot, render and resume."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.drafts import drafts
from zrno.pipelines.scene import Scene
from zrno.solvers.frame import Frame


class FakeSolver:
    """Two bodies of a lattice that fly at each other; every number follows from the step."""

    end_time = 1.0

    def __init__(self, count: int = 20, dt: float = 0.1) -> None:
        self.step = 0
        self.dt = dt
        side = max(1, round(count ** (1 / 3)))
        grid = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)[:count].astype(float)
        self.start = np.concatenate((grid, grid + np.array([side + 1.0, 0, 0])))
        self.material = np.repeat([1, 2], len(grid))

    @property
    def time(self) -> float:
        return self.step * self.dt

    def advance(self, steps: int = 1) -> None:
        self.step += steps

    def frame(self) -> Frame:
        n = len(self.start)
        velocity = np.zeros((n, 3))
        velocity[:, 0] = np.where(self.material == 1, 0.5, -0.5)
        moved = velocity * self.time
        size = np.linalg.norm(self.start, axis=1)
        particles: dict[str, Any] = {
            "id": np.arange(1, n + 1),
            "material": self.material,
            "position": self.start + moved,
            "velocity": velocity,
            "density": np.full(n, 2.7),
            "mass": np.full(n, 2.7),
            "radius": np.full(n, 0.5),
            "pressure": np.sin(size) * self.time,
            "stress": np.outer(size * self.time, np.arange(1.0, 7.0)),
            "von_mises": size * self.time,
            "plastic_strain": np.zeros(n),
            "displacement": moved,
        }
        return Frame(self.time, self.step, particles)

    def history(self) -> dict[str, float]:
        row = {"time": self.time, "dt": self.dt, "kinetic": 1.0 / 3.0 + self.step, "internal": 0.1 * self.step}
        row |= {"dissipated": 0.0, "external_work": 0.0}
        for axis in "xyz":
            row |= {f"momentum_{axis}": 0.1, f"contact_force_{axis}": float(self.step)}
        return row | {"active": float(len(self.start)), "neighbours": 57.0}

    def checkpoint(self) -> dict[str, Any]:
        return {"step": self.step, "position": self.frame().particles["position"], "law": "none"}

    def restore(self, state: dict[str, Any]) -> None:
        self.step = int(state["step"])


@pytest.fixture
def solver() -> FakeSolver:
    return FakeSolver()


@pytest.fixture
def drive() -> Any:
    """drive(solver, observers, steps): start them, call them after each step, finish them unless told not to."""

    def run(solver: FakeSolver, observers: list[Any], steps: int, *, finish: bool = True) -> None:
        for observer in observers:
            observer.start(solver)
        for _ in range(steps):
            solver.advance()
            for observer in observers:
                observer.observe(solver)
        for observer in observers if finish else []:
            observer.finish(solver)

    return run


@pytest.fixture
def make_decks() -> Any:
    """make_decks(scene, folder): every deck that a scene makes, in its place; what `convert` returns of each."""

    def make(scene: Scene, folder: Path) -> list[dict[str, Any]]:
        with drafts(scene, folder, publishing=True) as made:
            for draft in made:
                draft.publish()
        return [draft.result for draft in made]

    return make
