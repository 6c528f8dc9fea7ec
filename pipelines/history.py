"""history.csv: one row of sums a call, readable at any moment, cut at the checkpoint when a run is resumed."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.observing import Solver
from zrno.translators.text import write_atomically

FILE = "history.csv"
COLUMNS = (
    "time", "dt", "kinetic", "internal", "dissipated", "external_work", "momentum_x", "momentum_y", "momentum_z",
    "contact_force_x", "contact_force_y", "contact_force_z", "active",
)  # fmt: skip


class History:
    """Observer: the fixed columns, then what the solver adds; the second row has the units where they are known.

    interval: simulated time between rows, None for some a second; units: unit by column; resume: keep the rows up to
    the solver's time, else begin anew. Numbers are written so that they read back exactly; a column that the solver
    does not give is nan.
    """

    exact = False

    def __init__(
        self,
        directory: Path | str,
        *,
        interval: float | None = None,
        units: Mapping[str, str] | None = None,
        resume: bool = False,
    ) -> None:
        self.interval = interval
        self._path = Path(directory) / FILE
        self._units = units or {}
        self._resume = resume
        self._columns: list[str] = []
        self._last = math.nan
        self._out: TextIO | None = None

    def start(self, solver: Solver) -> None:
        """The header and the first row; after a resume the rows that hold, and no new one."""
        row = solver.history()
        self._columns = [*COLUMNS, *(name for name in row if name not in COLUMNS)]
        header = [",".join(self._columns), ",".join(self._units.get(name, "") for name in self._columns)]
        kept = _rows_until(self._path, solver.time) if self._resume else []
        self._path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(self._path, [("\n".join([*header, *kept]) + "\n").encode()])
        self._out = self._path.open("a", encoding="utf-8")
        if kept:
            self._last = _time_of(kept[-1])
        else:
            self.observe(solver)

    def observe(self, solver: Solver) -> None:
        """A row, unless this time has one."""
        if solver.time == self._last or self._out is None:
            return
        row = {"time": solver.time, "dt": solver.dt, **solver.history()}
        self._out.write(",".join(repr(float(row.get(name, math.nan))) for name in self._columns) + "\n")
        self._out.flush()
        self._last = solver.time

    def finish(self, solver: Solver) -> None:
        """The last row."""
        self.observe(solver)
        self.close()

    def close(self) -> None:
        """Close the file, also of a run that was broken off."""
        if self._out is not None:
            self._out.close()
            self._out = None


def read_history(path: Path | str) -> tuple[dict[str, NDArray[Any]], dict[str, str]]:
    """Columns of a history.csv, shape (rows,), and their units. Raises ValueError when it is not one."""
    lines = _whole_lines(Path(path))
    if len(lines) < 2:
        raise ValueError(f"{path} is not a history: it has no header")
    names, units = next(csv.reader(lines[:1])), next(csv.reader(lines[1:2] if lines[1] else [","]))
    try:
        table = np.loadtxt(lines[2:], delimiter=",", ndmin=2) if len(lines) > 2 else np.empty((0, len(names)))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error
    if table.shape[1] != len(names):
        raise ValueError(f"{path}: rows have {table.shape[1]} numbers, the header has {len(names)} names")
    return dict(zip(names, table.T.copy(), strict=True)), {n: u for n, u in zip(names, units, strict=False) if u}


def _whole_lines(path: Path) -> list[str]:
    """The lines of a file that end; a killed run may leave half a line."""
    return path.read_text(encoding="utf-8").split("\n")[:-1]


def _time_of(row: str) -> float:
    return float(row.partition(",")[0])


def _rows_until(path: Path, time: float) -> list[str]:
    if not path.exists():
        return []
    return [row for row in _whole_lines(path)[2:] if _time_of(row) <= time]
