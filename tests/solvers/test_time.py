"""The time loop: when observers are called."""

from __future__ import annotations

import math
from typing import Any

from zrno.solvers.time import run


class Clock:
    """A solver that does nothing but to reach the times that it is told."""

    def __init__(self) -> None:
        self.time, self.step, self.least = 0.0, 0, math.inf

    def advance(self, until: float, max_steps: int, pause: float = math.inf) -> None:
        self.least = min(self.least, until - self.time)
        self.time = until
        self.step += 1


class Seen:
    """Keeps the times at which it was called."""

    exact = True

    def __init__(self, interval: float) -> None:
        self.interval: float | None = interval
        self.times: list[float] = []

    def start(self, solver: Any) -> None: ...

    def observe(self, solver: Any) -> None:
        self.times.append(solver.time)

    def finish(self, solver: Any) -> None: ...


def test_times_that_differ_by_round_off_are_one() -> None:
    """75 x 0.0002 is not 3 x 0.005 in floating point: a step from one to the other collapsed a run."""
    clock, often, seldom = Clock(), Seen(0.0002), Seen(0.005)
    run(clock, [often, seldom], 0.04)
    assert clock.least > 1e-5
    assert len(often.times) == 200
    assert len(seldom.times) == 8
    assert clock.time == 0.04
