"""What can go wrong in a run, in terms of a user: the step, the item, the likely cause."""

from __future__ import annotations


class Diverged(RuntimeError):
    """A run that cannot go on.

    step: steps done; item: particle or element number of the deck (0: none); cause: a sentence.
    """

    def __init__(self, step: int, item: int, cause: str) -> None:
        self.step = step
        self.item = item
        self.cause = cause
        where = f" at particle {item}" if item else ""
        super().__init__(f"step {step}{where}: {cause}")


class Unsupported(ValueError):
    """A feature that the deck asks for and this version of the solver does not have."""
