"""What is wrong in a file, with its place; collected, so that all of it is said at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

MAX_FAULTS = 20


@dataclass(frozen=True, slots=True, order=True)
class Fault:
    """One thing wrong in a file. line, column: from 1; text: the offending text; expected: what should stand there."""

    path: str
    line: int
    column: int
    message: str
    text: str = ""
    expected: str = ""

    def __str__(self) -> str:
        said = f"{self.path}:{self.line}:{self.column}: error: {self.message}"
        said += f" ({self.text})" if self.text else ""
        return said + (f"; expected {self.expected}" if self.expected else "")


class InputError(Exception):
    """A file that cannot be used. Its text is one line a fault."""

    def __init__(self, faults: Sequence[Fault]) -> None:
        self.faults = list(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))


@dataclass(slots=True)
class Faults:
    """Collects the faults of one file, so that a reader can go on after the first."""

    path: str
    found: list[Fault] = field(default_factory=list)

    def add(self, line: int, column: int, message: str, text: str = "", expected: str = "") -> None:
        """Note a fault; raises InputError at the twentieth."""
        self.found.append(Fault(self.path, line, column, message, text, expected))
        if len(self.found) >= MAX_FAULTS:
            self.stop()

    def add_at(self, place: tuple[int, int], message: str, text: str = "", expected: str = "") -> None:
        """Note a fault at (line, column)."""
        self.add(*place, message, text, expected)

    def stop(self) -> None:
        """Raise InputError when there are faults."""
        if self.found:
            raise InputError(sorted(set(self.found)))
