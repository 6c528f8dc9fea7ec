"""Ctrl-C between steps: a run that is interrupted leaves every file and the state whole."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any


class Interrupt:
    """Observer, the last one: raises KeyboardInterrupt where all others have done their part, if Ctrl-C was pressed.

    Anywhere else it could fall between two series of a frame, into the sorting of particles, or while other threads
    still compute: the checkpoint that follows would not be of any step.

    raised: whether it has; the state is whole then.
    """

    interval: float | None = None
    exact = False

    def __init__(self) -> None:
        self.asked = False
        self.raised = False

    def start(self, solver: Any) -> None:
        """An interrupt that came before the first step."""
        self.observe(solver)

    def observe(self, solver: Any) -> None:
        """Raise what was held back."""
        if self.asked:
            self.raised = True
            raise KeyboardInterrupt

    def finish(self, solver: Any) -> None:
        """A run at its end is done, whatever was asked in its last moments."""


@contextmanager
def held_back() -> Iterator[Interrupt]:
    """While the block runs, the first Ctrl-C waits for the observer; a second one ends the block at once.

    A handler that is not Python's own, or a thread that may not set one, is left as it is.
    """
    interrupt = Interrupt()

    def hold(number: int, frame: FrameType | None) -> None:
        interrupt.asked = True
        signal.signal(signal.SIGINT, signal.default_int_handler)

    ours = False
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        try:
            signal.signal(signal.SIGINT, hold)
            ours = True
        except ValueError:  # not the main thread
            pass
    try:
        yield interrupt
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)
