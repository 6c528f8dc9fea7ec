"""What a translation could not say in its target: approximated and dropped items, counted."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Item:
    """what: the thing, in a word or two; count: how many; where: what became of it, or the place it was lost."""

    what: str
    count: int
    where: str


@dataclass(slots=True)
class Report:
    """Items that the target says only nearly, items that it cannot say, and remarks that are no loss."""

    approximated: list[Item] = field(default_factory=list)
    dropped: list[Item] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def approximate(self, what: str, count: int, where: str) -> None:
        """Note `count` approximated items; none if it is 0."""
        if count:
            self.approximated.append(Item(what, int(count), where))

    def drop(self, what: str, count: int, where: str) -> None:
        """Note `count` dropped items; none if it is 0."""
        if count:
            self.dropped.append(Item(what, int(count), where))

    def extend(self, other: Report) -> None:
        """Take over the items of another report."""
        self.approximated += other.approximated
        self.dropped += other.dropped
        self.notes += other.notes

    def __bool__(self) -> bool:
        """Whether something was lost: what `--strict` makes an error."""
        return bool(self.approximated or self.dropped)

    def as_dict(self) -> dict[str, list[dict[str, Any]]]:
        """The keys `approximated` and `dropped` of `zrno convert --json`."""
        return {
            "approximated": [asdict(item) for item in self.approximated],
            "dropped": [asdict(item) for item in self.dropped],
        }
