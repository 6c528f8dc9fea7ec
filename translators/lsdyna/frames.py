"""What *INCLUDE_TRANSFORM does to all that its file defines: numbers moved, units scaled, nodes placed elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from zrno.translators.lsdyna.expressions import BadExpression
from zrno.translators.text import Ints

# What each offset of the card is added to.
KINDS = ("node", "element", "part", "material", "set", "curve", "define", "other")
_LARGEST = 2**62
_LARGEST_FACTOR = 1e20  # of units: no power that a dimension has overflows


@dataclass(frozen=True, slots=True)
class Frame:
    """offsets: by kind; mass, time, length: factors of units; transformations: numbers, the innermost include's
    first."""

    offsets: dict[str, int] = field(default_factory=dict)
    mass: float = 1.0
    time: float = 1.0
    length: float = 1.0
    transformations: tuple[int, ...] = ()

    def moved(self, number: int, kind: str) -> int:
        """A number with its kind's offset; 0 means none and stays."""
        offset = self.offsets.get(kind, 0)
        if not (number and offset):
            return number
        # a negative number is a positive one with a meaning, e.g. a curve's
        return number + offset if number > 0 else number - offset

    def moved_all(self, numbers: Ints, kind: str) -> Ints:
        """The same of an array."""
        offset = self.offsets.get(kind, 0)
        return numbers + offset * np.sign(numbers) if offset else numbers

    def inside(self, offsets: dict[str, int], mass: float, time: float, length: float, tranid: int) -> Frame:
        """The frame of a file that a file in this one includes."""
        added = {kind: self.offsets.get(kind, 0) + offsets.get(kind, 0) for kind in KINDS}
        if any(abs(number) > _LARGEST for number in added.values()):
            raise BadExpression("the offsets of nested includes are too large")
        factors = (self.mass * mass, self.time * time, self.length * length)
        if not all(1 / _LARGEST_FACTOR < factor < _LARGEST_FACTOR for factor in factors):
            raise BadExpression("the factors of units are too large or too small")
        return replace(
            self,
            offsets={kind: number for kind, number in added.items() if number},
            mass=factors[0],
            time=factors[1],
            length=factors[2],
            transformations=((tranid,) if tranid else ()) + self.transformations,
        )

    def scale(self, mass: int = 0, length: int = 0, time: int = 0) -> float:
        """The factor of a quantity of these dimensions: scale(mass=1, length=-3) is a density's."""
        return float(self.mass**mass * self.length**length * self.time**time)

    @property
    def scales(self) -> bool:
        """Whether units change."""
        return (self.mass, self.time, self.length) != (1.0, 1.0, 1.0)

    @property
    def plain(self) -> bool:
        """Whether nothing changes."""
        return not (self.offsets or self.transformations or self.scales)
