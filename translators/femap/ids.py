"""Numbers of nodes or elements, and where each stands."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from zrno.translators.model import Ints


class Places:
    """Finds the places of numbers in an array that has each once; ids: (n,)."""

    def __init__(self, ids: Ints) -> None:
        self.ids = ids
        self._plain = len(ids) > 0 and bool((np.diff(ids) > 0).all())  # as most files are: no order is needed
        self._order = np.arange(0) if self._plain else np.argsort(ids, kind="stable")
        self._sorted = ids if self._plain else ids[self._order]
        self._run = self._plain and int(ids[-1]) - int(ids[0]) == len(ids) - 1

    def twice(self) -> int | None:
        """The place of a number that stood before; None where all differ."""
        same = np.flatnonzero(self._sorted[1:] == self._sorted[:-1])
        return None if not len(same) else int(self._order[same[0] + 1])

    def of(self, wanted: Ints) -> tuple[Ints, NDArray[np.bool_]]:
        """Places, of any shape like `wanted`, and whether the number is there; the place is 0 where it is not."""
        if not len(self.ids):
            return np.zeros(wanted.shape, np.int64), np.zeros(wanted.shape, bool)
        if self._run:
            place = wanted - self.ids[0]
            there = (place >= 0) & (place < len(self.ids))
            return (place if there.all() else np.where(there, place, 0)), there
        place = np.minimum(np.searchsorted(self._sorted, wanted), len(self.ids) - 1)
        there = self._sorted[place] == wanted
        place = np.where(there, place, 0)
        return (place if self._plain else self._order[place]), there


def by_value(keys: Ints) -> Iterator[tuple[int, Ints]]:
    """The distinct values of an array (n,), in the order in which they first stand there, and the places of each."""
    values, first, inverse, counts = np.unique(keys, return_index=True, return_inverse=True, return_counts=True)
    places = np.split(np.argsort(inverse, kind="stable"), np.cumsum(counts)[:-1])
    for i in np.argsort(first, kind="stable").tolist():
        yield int(values[i]), places[i]
