"""What observers see of a solver: whatever has these can be written, plotted and resumed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from zrno.solvers.frame import Frame


class Solver(Protocol):
    """The part of a solver that observers use. time, dt: in the deck's units; step: steps done since time zero."""

    @property
    def time(self) -> float: ...

    @property
    def step(self) -> int: ...

    @property
    def dt(self) -> float: ...

    def frame(self) -> Frame:
        """The state in the deck's order."""

    def history(self) -> Mapping[str, float]:
        """One row of history.csv by column."""

    def checkpoint(self) -> Mapping[str, Any]:
        """All that a resumed run needs: arrays, numbers, strings by name."""

    def energy_report(self) -> Mapping[str, float]:
        """Energies, and `balance_error`: what was made or lost since the start, relative to the largest so far."""
