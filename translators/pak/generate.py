"""PAK's generation of cards: a card with a step KORC stands also for those up to the next card's number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zrno.translators.text import Block, Cards, Ints, Layout

_FREE = 100_000  # generated items that any deck may ask for
_BYTES_EACH = 20  # of the file, for each further one


@dataclass(frozen=True, slots=True)
class Series:
    """The items that cards make. blocks: of the cards; card: (n,) each item's card; place: (n,) 0 for the card itself,
    else how manieth after it; step: (n,) KORC of its card; last: (n,) the card that ends its run."""

    blocks: list[Block]
    card: Ints
    place: Ints
    step: Ints
    last: Ints

    @property
    def generated(self) -> bool:
        """Whether there is more than the cards."""
        return bool(self.place.any())

    def take(self, values: NDArray[np.generic]) -> NDArray[np.generic]:
        """A field's values for all items: a generated one has its card's."""
        return values[self.card] if self.generated else values

    def numbers(self, values: Ints, *, by: Ints | int | None = None) -> Ints:
        """Numbers that grow by the step (or `by`) in a run; 0 stays 0. values: (cards,) or (cards, k)."""
        if not self.generated:
            return values
        own = values[self.card]
        grown = self.place * (self.step if by is None else by)
        return np.where(own == 0, 0, own + grown.reshape(-1, *[1] * (own.ndim - 1)))


def read_series(
    cards: Cards, layouts: Sequence[Layout], count: int, what: str, *, key: tuple[int, str], size: int
) -> Series:
    """The next cards that make `count` items. layouts: of the cards of one item, the first of them with KORC.

    key: (card, field) whose number grows by KORC in a run; size: bytes of the file, by which generation is bounded.
    Raises InputError where the file ends, or a run cannot be.
    """
    gaps = np.empty(0, np.int64)
    korc = cards.probe(layouts[0].only("KORC"), count, len(layouts))["KORC"]
    if korc.any():
        gaps = _gaps(cards, layouts, key, korc)
    if not len(gaps):
        blocks = cards.blocks(layouts, count, what)
        cards.faults.stop()
        plain = np.arange(count)
        return Series(blocks, plain, np.zeros(count, np.int64), np.zeros(count, np.int64), plain)
    made = np.arange(1, len(gaps) + 1) + np.concatenate(([0], np.cumsum(np.maximum(gaps[:-1], 0))))
    used = int(np.searchsorted(made, count)) + 1  # cards
    if used > len(gaps):
        cards.blocks(layouts, len(gaps) + 1, what)
    if count - used > _FREE + size // _BYTES_EACH:
        cards.faults.add(cards.next_line, 1, f"{count} items of {used} cards", expected="a sensible number of them")
        cards.faults.stop()
    blocks = cards.blocks(layouts, used, what)
    cards.faults.stop()
    korc = blocks[0]["KORC"]
    first, second = blocks[key[0]][key[1]][:-1], blocks[key[0]][key[1]][1:]
    run = korc[:-1] != 0
    bad = run & (((second - first) % np.where(run, korc[:-1], 1) != 0) | (gaps[: used - 1] < 0))
    for i in np.flatnonzero(bad).tolist():
        blocks[0].fault(i, "KORC", f"from {first[i]} by this step to the next card's {second[i]} is no whole number")
    if korc[-1] != 0:
        blocks[0].fault(used - 1, "KORC", "no card follows that this one could lead up to", "0")
    elif int(made[used - 1]) != count:
        blocks[0].fault(used - 1, "KORC", f"the cards make {int(made[used - 1])} items", f"{count} in all")
    cards.faults.stop()
    each = np.concatenate((gaps[: used - 1], [0])) + 1
    card = np.repeat(np.arange(used), each)
    place = np.arange(count) - np.repeat(np.cumsum(each) - each, each)
    return Series(blocks, card, place, korc[card], np.minimum(card + 1, used - 1))


def _gaps(cards: Cards, layouts: Sequence[Layout], key: tuple[int, str], korc: Ints) -> Ints:
    """How many items stand between each of the next cards and the one after it; as far as can be told."""
    name = key[1]
    number = cards.probe(layouts[key[0]].only(name), len(korc), len(layouts), key[0])[name]
    short = min(len(korc), len(number))
    korc, number = korc[:short], number[:short]
    run = korc != 0
    span = np.append(np.diff(number), 0)
    gaps = np.where(run, span // np.where(run, korc, 1) - 1, 0)
    return np.clip(gaps, -1, 10**12 // max(short, 1))
