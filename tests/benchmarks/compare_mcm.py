"""How far results lie from MCM's, at equal times: the original followed, then one improvement after another.

    python tests/benchmarks/compare_mcm.py ../shared/reference/mcm

RMS over the particles at the saved outputs, the largest of them: positions in per cent of h, velocities of the impact
speed, von Mises stress of its largest value. MCM's positions at a label t are those of t - dt, its velocities those of
half a step before.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np

from zrno.pipelines.build import particle_problem
from zrno.pipelines.method import Sph
from zrno.solvers.sph import Problem, Solver, setup
from zrno.solvers.sph import solver as solver_module
from zrno.translators import read


class ProperStart(Solver):
    """The original program, but for its first half step."""

    def _start_as_original(self, first: float) -> None:
        pass


class OneDensity(Solver):
    """The sums of the original program where densities differ."""

    def __init__(self, problem: Problem) -> None:
        with patch.object(setup, "is_mixed", lambda _: False):
            super().__init__(problem)


def states(solver: Solver, times: list[float], steps: list[float]) -> list[dict[str, np.ndarray]]:
    """Positions and stresses at the times, velocities half a step before, each between two steps of the solver."""
    clock = solver_module.step.TIME
    last = solver_module.step.LAST
    out, before = [], None
    for time, dt in zip(times, steps, strict=True):
        while True:
            s = solver._state
            order = np.argsort(s.id[: solver.n])
            now = {
                "time": float(solver._progress[clock]),
                "half": float(solver._progress[clock] - 0.5 * solver._progress[last]),
                "x": s.rows("x")[:, : solver.n][:, order].T,
                "v": s.rows("u")[:, : solver.n][:, order].T,
                "vm": solver.frame().particles["von_mises"],
            }
            if before is not None and now["time"] >= time and now["half"] >= time - 0.5 * dt:
                break
            before = {k: np.array(v) for k, v in now.items()}
            solver.advance(1e300, 1)

        def between(name: str, clock: str, at: float, a: dict = before, b: dict = now) -> np.ndarray:  # type: ignore[type-arg]
            f = (at - a[clock]) / (b[clock] - a[clock])
            return (1.0 - f) * a[name] + f * b[name]

        out.append(
            {
                "x": between("x", "time", time),
                "v": between("v", "half", time - 0.5 * dt),
                "vm": between("vm", "time", time),
            }
        )
    return out


def row(problem: Problem, kind: type[Solver], reference: dict[str, np.ndarray]) -> tuple[float, float, float]:
    """The largest RMS differences over the outputs after the first."""
    labels, dts = reference["times"][1:], reference["dt"][1:]
    found = states(kind(problem), [float(t - d) for t, d in zip(labels, dts, strict=True)], list(map(float, dts)))
    worst = np.zeros(3)
    for k, state in enumerate(found, start=1):
        for q, (name, scale) in enumerate(
            (("x", problem.h.min()), ("v", np.abs(problem.v).max()), ("vm", reference[f"vm{k}"].max()))
        ):
            difference = (state[name] - reference[f"{name}{k}"]).reshape(len(problem.x), -1)
            worst[q] = max(worst[q], 100.0 * float(np.sqrt(np.mean(np.sum(difference**2, axis=1)))) / scale)
    return tuple(worst.tolist())


def main(folder: Path) -> None:
    """Print the table."""
    print(f"{'deck':10} {'':34} {'x % of h':>10} {'v %':>10} {'von Mises %':>12}")
    for name in ("block20k", "kupa1f", "newhop3f"):
        deck = folder / f"{name}.mcm"
        reference = dict(np.load(deck.with_suffix(".npz")))
        plain = Sph(correction=False)
        for said, kind, original, weak, method in (
            ("compat=original", Solver, True, False, plain),
            ("proper start", ProperStart, True, False, plain),
            ("  and full rotation", OneDensity, False, True, plain),
            ("  and sums for two densities", Solver, False, True, plain),
            ("  and the whole contact", Solver, False, False, plain),
            ("  and gradient correction: default", Solver, False, False, Sph()),
        ):
            problem = particle_problem(read(deck), str(deck), original=original, method=method)
            if weak:  # with one h and n the original's divisor makes f four times smaller
                bodies = tuple(replace(b, strength=b.strength * 0.25**b.exponent) for b in problem.bodies)
                problem = replace(problem, bodies=bodies)
            x, v, vm = row(problem, kind, reference)
            print(f"{name:10} {said:36} {x:10.2g} {v:10.2g} {vm:12.2g}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
