"""How far a run has come, on a terminal."""

from __future__ import annotations

from typing import Any


class Progress:
    """Observer: a bar with the simulated time, the steps and the time left. show: False makes it silent."""

    interval: float | None = None
    exact = False

    def __init__(self, end: float, *, show: bool) -> None:
        self._end = end
        self._show = show
        self._bar: Any = None
        self._task: Any = None

    def start(self, solver: Any) -> None:
        """Show the bar."""
        if not self._show:
            return
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.percentage:>3.0f} %"),
            TimeRemainingColumn(),
            console=Console(stderr=True),
        )
        self._task = self._bar.add_task("", total=self._end)
        self._bar.start()
        self.observe(solver)

    def observe(self, solver: Any) -> None:
        """Move the bar on."""
        if self._bar is not None:
            text = f"t = {solver.time:.4g} of {self._end:g}, step {solver.step}"
            self._bar.update(self._task, completed=solver.time, description=text)

    def finish(self, solver: Any) -> None:
        """Leave the bar as it is."""
        if self._bar is not None:
            self.observe(solver)
            self._bar.stop()
            self._bar = None
