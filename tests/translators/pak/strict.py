"""A strictly positional reader of PAK decks, written from the tables of the format alone; it shares nothing with the
package that it checks.

It reads as Fortran does: fields by their columns, blanks are zero, a real without a point is scaled by the decimals of
its format. A point is demanded in every real that is not blank. It knows no generation of cards.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

REAL = re.compile(r"[+-]?(\d+\.\d*|\.\d+)([ED][+-]?\d+|[+-]\d+)?$")
CORNER_SIGNS = np.array(
    [(1, 1, 1), (-1, 1, 1), (-1, -1, 1), (1, -1, 1), (1, 1, -1), (-1, 1, -1), (-1, -1, -1), (1, -1, -1)]
)
GAUSS = np.array([(r, s, t) for r in (-1, 1) for s in (-1, 1) for t in (-1, 1)]) / np.sqrt(3)


@dataclass
class Deck:
    """What a deck says."""

    xyz: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    codes: dict[int, tuple[int, ...]] = field(default_factory=dict)
    groups: list[tuple[int, int, int]] = field(default_factory=list)  # NETIP, IATYP, model
    elements: list[dict[int, list[int]]] = field(default_factory=list)  # of each group: number -> nodes
    materials: list[tuple[int, int]] = field(default_factory=list)
    functions: dict[int, list[tuple[float, float]]] = field(default_factory=dict)
    loads: dict[str, int] = field(default_factory=dict)
    displacements: list[tuple[int, int, int, float]] = field(default_factory=list)
    end: float = 0.0


class Reader:
    """Cards of a deck in order. points: whether each real must have its point."""

    def __init__(self, path: Path, *, points: bool = True) -> None:
        lines = path.read_bytes().decode("ascii").replace("\r\n", "\n").split("\n")
        self.lines = [line for line in lines if (line + "  ")[:2] not in ("C ", "c ", "C*", "C-")]
        self.next = 0
        self.points = points

    def text(self) -> str:
        self.next += 1
        assert len(self.lines[self.next - 1]) <= 250
        return self.lines[self.next - 1]

    def card(self, *widths: str) -> list[float]:
        """Fields such as "i5", "f10.2" and "x3" of the next card."""
        line, at, values = self.text(), 0, []
        for item in widths:
            kind, width = item[0], int(item[1:].split(".")[0])
            word, at = line[at : at + width].strip(), at + width
            if kind == "i":
                values.append(int(word or 0))
            elif kind == "f":
                if self.points and word:
                    assert REAL.match(word), (self.next, line)
                fixed = re.sub(r"(?<=[\d.])([+-]\d+)$", r"E\1", word.upper().replace("D", "E"))
                scale = 0 if "." in word else int(item.split(".")[1])
                values.append(float(fixed or 0) / 10**scale)
        if self.points:
            assert not line[at:].strip(), (self.next, line)
        return values


def read(path: Path, *, points: bool = True) -> Deck:
    """Consume a deck up to STOP; assertions fail where it is not one."""
    r, deck = Reader(path, points=points), Deck()
    r.text()
    form, wide = map(int, r.card("i5", "i5", *["i5"] * 4)[:2])
    assert form in (0, 2)
    n = "i10" if wide else "i5"
    np_, ngelem, nmatm, nper = map(int, r.card(n, *["i5"] * 9)[:4])
    switches = r.card(*["i2"] * 6, "x3", "i5", "i5", "i5", "x38", *["i2"] * 6)
    off, (dynamic, eigen, free) = switches[:6], map(int, switches[6:9])
    output = r.card(*["i5"] * 11)
    for count in output[1:3]:
        for _ in range(max(int(count), 0)):
            r.card(*["i5"] * 5)
    modes = int(r.card("i5", "x10", "i5", "i5", "f10.0", "f10.0", "i5", "i5")[1])
    for _ in range(modes):
        r.card("i5", "i5", "i5", "f10.3")
    for _ in range(max(nper, 1)):
        _, steps, length = r.card("i5", "i5", "f10.0")
        deck.end += steps * length
    if dynamic:
        r.card("i5", "i5", "i5")
        if not eigen:
            r.card("i5", *["f10.0"] * 5)
    if eigen > 0:
        r.card("i5", "i5")
    if r.card(*["i5"] * 5, *["f10.0"] * 4, "i5")[0] >= 60:
        r.card(*["i5"] * 3, *["f10.0"] * 5)
    x = "f15.0" if wide else "f10.0"
    for _ in range(np_):
        number, *rest = r.card(n, "x1", *["i2"] * 6, "x2", x, x, x, "i5", "i5")
        assert rest[9] == 0
        assert 1 <= number <= (np_ if not free else 10**10)
        assert number not in deck.xyz
        deck.codes[int(number)] = tuple(map(int, rest[:6]))
        deck.xyz[int(number)] = (rest[6], rest[7], rest[8])
    slaves = sum(code < 0 and not off[k] for codes in deck.codes.values() for k, code in enumerate(codes))
    if slaves:
        sets, terms = map(int, r.card("i5", "i5"))
        for _ in range(sets):
            r.card("i5", *["f10.0"] * 6)
        for _ in range(slaves):
            which, *pairs = r.card("i5", *[n, "i5"] * 7)
            pairs = pairs[: 2 * terms + 2]
            assert 1 <= which <= sets
            assert all(node in deck.xyz for node in pairs[::2])
            assert deck.codes[int(pairs[0])][int(pairs[1]) - 1] == -1
    if dynamic and not eigen:
        for count in r.card(*["i5"] * 6)[:3]:
            for _ in range(int(count)):
                assert r.card("i5", "i5", *["f10.2"] * 6)[0] in deck.xyz
    heads = [tuple(map(int, r.card("i5", "i5", "i5")[:2])) for _ in range(max(nmatm, 1))]
    for law, count in heads:
        for _ in range(count):
            _material(r, deck, law)
    for _ in range(max(ngelem, 1)):
        _group(r, deck, n, bool(free), heads)
    for _ in range(int(r.card("i5", "i5")[0])):
        number, points_ = map(int, r.card("i5", "i5"))
        deck.functions[number] = [tuple(r.card("f10.0", "f10.0")) for _ in range(points_)]
    _loads(r, deck, n)
    assert r.text().strip() == "STOP"
    return deck


def _material(r: Reader, deck: Deck, law: int) -> None:
    model, number = map(int, r.card("i5", "i5", "f10.0", *(["x45"]))[:2])
    assert model == law
    deck.materials.append((model, number))
    seven = ["f10.0"] * 7
    cards = {1: 2, 2: 3, 7: 3, 41: 3, 49: 3, 42: 2}.get(law)
    if cards:
        first = (*["f10.0"] * 6, "i5") if law == 7 else tuple(seven)
        for k in range(cards):
            r.card(*(first if k == 0 else seven))
        return
    if law in (5, 6):
        count = int(r.card("i5", "i5")[0])
        r.card(*seven)
        for _ in range(1 if count == 1 else count + (law == 5)):
            r.card(*seven)
        if law == 6:
            r.card(*seven)
        return
    if law == 3:
        for _ in range(3):
            for _ in range(int(r.card("i5", "i5")[0])):
                r.card("f10.0", "f10.0")
        r.card(*seven)
        return
    for _ in range({8: 2, 10: 5, 28: 3, 44: 2, 56: 3, 61: 2, 9: 2}[law]):
        r.text()


def _group(r: Reader, deck: Deck, n: str, free: bool, heads: list[tuple[int, ...]]) -> None:
    netip, count, analysis, law = map(int, r.card("i5", n, *["i5"] * 6, *["f10.0"] * 3)[:4])
    own = dict(heads)
    assert law in own
    deck.groups.append((netip, analysis, law))
    if netip in (3, 31, 32, 33):
        sets = int(r.card(*["i5"] * 4, "f10.0", "i5", "i5", "x25", "i5")[3])
        if law in (2, 4, 10):
            r.card(*["f10.0"] * 6)
    elif netip in (2, 21, 8, 81, 84):
        sets = int(r.card(*["i5"] * 4, "f10.3", "i5", *["f10.3"] * 3, "i5")[3])  # of planes the fourth too: after IETYP
    else:
        sets = 0
        if netip == 6:
            r.card(*["i5"] * 4, *["f10.0"] * 5, "i5")
            r.card(*["f10.3"] * 7, "i1", "i1")
    for _ in range(sets):
        for _ in range(int(r.card("i5")[0])):
            r.card("i5", "f10.0", "f10.0")
    elements: dict[int, list[int]] = {}
    for k in range(1, count + 1):
        if netip == 6:
            number, a, b, material, *_ = r.card(n, n, n, "i5", "x5", "i5", "x5", *["f10.2"] * 5)
            nodes = [a, b]
        elif netip == 1:
            number, material, _, area, *_ = r.card(n, "i5", "i5", "f10.3", "i5", "f10.0", "f10.0")
            assert area > 0
            nodes = r.card(n, n)
        elif netip in (3, 31, 32, 33):
            number, material, *_ = r.card(n, *["i5"] * 5, "x10", "f10.0", "f10.0")
            corners, most = {3: (8, 21), 31: (6, 15), 32: (5, 13), 33: (4, 10)}[netip]
            nodes = r.card(*[n] * corners) + r.card(*[n] * (most - corners))
        else:
            number, material, *rest = r.card(n, *["i5"] * 4, "f10.0", "i5", "f10.0", "f10.0", *["f5.3"] * 3)
            assert rest[3] > 0
            nodes = r.card(*[n] * (9 if netip in (2, 8, 84) else 6))
        assert 0 <= material <= own[law]
        assert number == k or free
        assert all(node == 0 or node in deck.xyz for node in nodes)
        assert number not in elements
        elements[int(number)] = [int(node) for node in nodes]
    deck.elements.append(elements)


def _loads(r: Reader, deck: Deck, n: str) -> None:
    gap = "x10" if n == "i10" else "x5"
    counts = [int(v) for v in r.card(n, n, n, n, gap, n, n, n, n, n)]
    names = ("NCF", "NPP2", "NPP3", "NPGR", "NPLJ", "NTEMP", "NZADP", "INDZS", "ICERNE")
    deck.loads = dict(zip(names, counts, strict=True))
    assert deck.loads["NPGR"] == deck.loads["NPLJ"] == 0
    for _ in range(deck.loads["NCF"]):
        node, dof, function, *_ = r.card(n, "i5", "i5", "f10.0", "i5", "f10.0")
        assert node in deck.xyz and 1 <= dof <= 6 and function in deck.functions  # noqa: PT018
    for _ in range(deck.loads["NPP2"]):
        assert r.card("i5", "i5", "i5", *["f10.2"] * 3, "i5")[1] in deck.functions
        assert set(r.card("i5", "i5", "i5")) - {0.0} <= set(deck.xyz)
    for _ in range(deck.loads["NPP3"]):
        function, direction, *_ = r.card("i5", "i5", *["f10.2"] * 4, "i5")
        assert function in deck.functions and 0 <= direction <= 3  # noqa: PT018
        assert set(r.card(*[n] * 9)) - {0.0} <= set(deck.xyz)
    for _ in range(max(deck.loads["NTEMP"], 0)):
        assert r.card("i5", "i5", "f10.0", "i5")[0] in deck.xyz
    for _ in range(abs(deck.loads["NZADP"])):
        node, dof, function, factor, _ = r.card(n, "i5", "i5", "f10.2", "i5")
        assert function in deck.functions
        deck.displacements.append((int(node), int(dof), int(function), factor))
    for _ in range(deck.loads["INDZS"]):
        assert r.card("i5", *["f10.0"] * 3)[0] in deck.functions


def jacobians(deck: Deck, group: int) -> np.ndarray:
    """Jacobians of a group's hexahedra at 2 x 2 x 2 points by PAK's own order of corners: (n, 8)."""
    nodes = np.array([nodes[:8] for nodes in deck.elements[group].values()])
    points = np.array([[deck.xyz[node] for node in row] for row in nodes.tolist()])
    found = []
    for at in GAUSS:
        terms = 1 + CORNER_SIGNS * at
        slopes = [CORNER_SIGNS[:, k] * np.prod(np.delete(terms, k, axis=1), axis=1) / 8 for k in range(3)]
        found.append(np.linalg.det(np.stack([np.einsum("i,nix->nx", s, points) for s in slopes], axis=1)))
    return np.array(found).T


def tetrahedra(deck: Deck, group: int) -> np.ndarray:
    """Six times the volume of a group's tetrahedra."""
    points = np.array([[deck.xyz[node] for node in nodes[:4]] for nodes in deck.elements[group].values()])
    return np.linalg.det(points[:, 1:] - points[:, :1])
