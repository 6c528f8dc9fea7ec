"""The time loop: brings a solver to its end and calls the observers. It knows none of them by name."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any, Protocol

PAUSE = 0.2  # seconds between returns to Python, for progress and interrupts
SAME = 1e-12  # relative: times no farther apart are one, 75 x 0.0002 and 3 x 0.005 for example


class Steppable(Protocol):
    """What the loop needs of a solver."""

    @property
    def time(self) -> float: ...

    @property
    def step(self) -> int: ...

    def advance(self, until: float, max_steps: int, pause: float = math.inf) -> None:
        """Take up to max_steps steps towards `until`, which is met; come back once `pause` is passed."""


class Observer(Protocol):
    """Output, history, checkpoint, progress. interval: simulated time between calls; None: some times a second.

    exact: whether it is called at the multiples of its interval, to which steps are trimmed, or at the first step after
    them.
    """

    interval: float | None
    exact: bool

    def start(self, solver: Any) -> None:
        """Before the first step."""

    def observe(self, solver: Any) -> None:
        """At a multiple of the interval."""

    def finish(self, solver: Any) -> None:
        """After the last step of a run that came to its end."""


def next_time(now: float, interval: float) -> float:
    """The first multiple of the interval that is later than now, by more than round-off."""
    return (math.floor(now / interval + 1e-6) + 1) * interval


def run(solver: Steppable, observers: Sequence[Observer], until: float) -> None:
    """Bring a solver to the time `until`, calling each observer at the multiples of its interval or right after.

    What an observer or the solver raises (a diverged run, an interrupt) goes through; between two returns the loop does
    at most about PAUSE seconds of work.
    """
    for observer in observers:
        observer.start(solver)
    due = {id(o): next_time(solver.time, o.interval) for o in observers if o.interval}
    exact = {id(o) for o in observers if o.exact}
    steps = 1
    while solver.time < until:
        target = min([until, *(t for o, t in due.items() if o in exact)])
        target = until if until - target <= SAME * until else target  # a step from one to the other would be none
        pause = min([math.inf, *(t for o, t in due.items() if o not in exact)])
        before, started = solver.step, time.perf_counter()
        solver.advance(target, steps, pause)
        seconds = time.perf_counter() - started
        if solver.step == before and solver.time < target:
            raise RuntimeError("the solver makes no progress")
        if solver.step - before == steps:  # it was cut short: find how many steps fill the pause
            steps = max(1, min(2 * steps, int(steps * PAUSE / max(seconds, 1e-6))))
        for observer in observers:
            if observer.interval is None:
                observer.observe(solver)
            elif solver.time >= due[id(observer)] * (1.0 - SAME):
                observer.observe(solver)
                due[id(observer)] = next_time(solver.time, observer.interval)
    for observer in observers:
        observer.finish(solver)
