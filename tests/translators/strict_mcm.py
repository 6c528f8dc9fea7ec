"""A strictly positional reader of .mcm decks of version 2, from the tables of the format alone; it shares nothing with
the package that it checks. Each real that is not blank must have its point, each card its place, and none may be left.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

REAL = re.compile(r"[+-]?(\d+\.\d*|\.\d+)([ED][+-]?\d+|[+-]\d+)?$")
EOS_CARDS = {1: 2, 4: 1, 13: 1, 28: 1, 41: 1}


@dataclass
class Deck:
    """What a deck says."""

    dimension: int = 3
    x: list[tuple[float, ...]] = field(default_factory=list)
    bc: list[int] = field(default_factory=list)
    material: list[int] = field(default_factory=list)
    mass: dict[int, float] = field(default_factory=dict)
    particle_mass: list[float] = field(default_factory=list)


class Cards:
    """The lines that are no comments, in order."""

    def __init__(self, path: Path) -> None:
        self.lines = [line for line in path.read_bytes().decode("ascii").split("\n") if line[:1] not in ("*", "$")]
        assert self.lines.pop() == ""
        self.next = 0

    def card(self, *widths: str) -> list[float]:
        """Fields such as "i5" and "e10" of the next card."""
        line, at, values = self.lines[self.next], 0, []
        assert len(line) <= 88
        self.next += 1
        for item in widths:
            word, at = line[at : at + int(item[1:])].strip(), at + int(item[1:])
            if item[0] == "i":
                values.append(int(word or 0))
            elif item[0] == "e":
                assert not word or REAL.match(word), (self.next, word)
                values.append(float(re.sub(r"(?<=[\d.])([+-]\d+)$", r"e\1", word.replace("D", "E") or "0")))
        return values


def read(path: Path) -> Deck:
    """Every card of a deck; AssertionError where it is not as the format says."""
    c, deck = Cards(path), Deck()
    assert c.lines[0][78:80].strip() == "2"
    c.next = 1
    dimension, _, materials, count, room, *_ = map(int, c.card("i5", "i5", *["i10"] * 5))
    assert dimension in (1, 2, 3, 4)
    dimension = 2 if dimension == 4 else dimension  # axisymmetric
    deck.dimension = dimension
    assert room >= count
    c.card(*["e10"] * 4)
    _, _, _, followed, transducers, *_ = map(int, c.card("e10", "i5", "e10", "i10", "i5", "i10", "i5", "i5"))
    _, velocities, mass, h, rho = map(int, c.card(*["i5"] * 5))
    contact, _, _, planes, _, *base = map(int, c.card(*["i5"] * 8))
    c.card("i5", "i5", "i5")
    card_7 = c.lines[c.next]
    options = [0, 0, 0]
    if "." in card_7[:20]:
        c.card("e10", "e10")
    else:
        options = [int(v) for v in c.card("i5", "i5", "i5")]
        if options[1]:
            c.card(*["e10"] * (2 if options[1] == 1 else 1))
    for number in range(1, materials + 1):
        n, model, _, eos, *_ = c.card("i5", "i5", "e10", "i5", "i5", "e10", "i5", "e10", "e10")
        assert n == number
        assert model in (1, 3, 4, 9, 10)
        assert (eos > 0) == (model in (9, 10))
        deck.mass[number] = c.card(*["e10"] * 4)[0]
        c.next += 1  # the title
        for _ in range(6):
            c.card(*["e10"] * 8)
        if eos:
            c.next += 1
            for _ in range(EOS_CARDS[int(eos)]):
                c.card(*["e10"] * 8)
    for number in range(1, count + 1):
        n, bc, *x, own = c.card("i8", "i5", *["e20"] * dimension, "i7")
        assert n == number
        assert 0 <= bc <= 7
        assert 1 <= own <= materials
        deck.x.append(tuple(x))
        deck.bc.append(int(bc))
        deck.material.append(int(own))
    if mass or h or rho:
        for number in range(1, count + 1):
            n, m, *_ = c.card("i8", *["e20"] * 3, "e12")
            assert n == number
            deck.particle_mass.append(m)
    for _ in range(-(-followed // 10)):
        c.card(*["i8"] * 10)
    for _ in range(transducers):
        c.card(*["e10"] * dimension, "i5")
    last = 0
    while velocities and last < count:
        n = int(c.card("i8", "e10", "e10", "e10")[0])
        assert n > last
        assert last or n == 1
        last = n
    if planes:
        c.card(*["i10"] * 6)
        c.card(*["e10"] * 6)
    if contact:
        assert c.card("i5", "i5")[0] == -1
        for _ in range(materials):
            c.card("e10", "e10")
    if any(base):
        c.card(*["e20"] * 3)
    if options[0]:
        c.card("i10", "i10")
        for _ in range((options[2] > 0) + (options[0] >= 2)):
            c.card("e20", "e20", "e20", "i5")
    assert c.next == len(c.lines), c.lines[c.next]
    return deck
