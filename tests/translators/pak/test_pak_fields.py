"""A deck of every card that is read, built from the layouts: each field in turn replaced, lines cut, bytes changed."""

from __future__ import annotations

import contextlib
import resource
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from zrno.translators.card_text import CardText
from zrno.translators.pak import cards, laws, read, write
from zrno.translators.report import Report
from zrno.translators.text import Field, InputError, Layout

Row = tuple[Layout, dict[str, Any]]
CUBE = [(x, y, z) for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
HEX = dict(zip((f"n{k}" for k in range(1, 9)), (5, 6, 8, 7, 1, 2, 4, 3), strict=True))
QUAD = dict(zip((f"n{k}" for k in range(1, 5)), (1, 2, 4, 3), strict=True))


def rows(wide: bool) -> Iterator[Row]:
    """The cards of the deck: layout and values."""
    yield cards.FORMATS, {"INDFOR": 2, "IND56": wide}
    yield cards.basics(wide), {"NP": 8, "NGELEM": 4, "NMATM": 4, "NPER": 2, "JPS": 1}
    yield cards.SWITCHES, {"NDIN": 1, "ICVEL": 1}
    yield cards.OUTPUT, {"NBLPR": 1, "NBLGR": -1}
    yield cards.STEP_BLOCK, {"NBL": 1, "first": 1, "increment": 1, "last": 9}
    yield cards.SOLVER, {"NMODS": 1, "TOLG": 0.5}
    yield cards.IMPERFECTION, {"MODE": 1, "NODE": 1, "DOF": 1, "SCIM": 0.5}
    for number in (1, 2):
        yield cards.PERIOD, {"I": number, "NKDT": 5, "DTDT": 0.25}
    yield cards.DYNAMICS, {"IMASS": 1}
    yield cards.INTEGRATION, {"MDVI": 2, "PIP": 0.5, "DIP": 0.25}
    yield cards.ITERATION, {"METOD": 61, "MAXIT": 9, "KONVE": 1, "TOLE": 0.001}
    yield cards.LOADING, {"ITEOPT": 1, "KPNOD": 1, "KPDIR": 1, "DTUK": 0.5}
    for number, (x, y, z) in enumerate(CUBE, 1):
        yield cards.node(wide), {"N": number, "x": x, "y": y, "z": z, "ux": -1 if number == 8 else 0, "LJ": number == 1}
    yield cards.RELATIONS, {"MMP": 1, "NEZAV": 2}
    yield cards.COEFFICIENTS, {"IRB": 1, "c1": 0.5, "c2": 0.25}
    yield cards.relation(wide), {"IRB": 1, "node_0": 8, "dof_0": 1, "node_1": 7, "dof_1": 1, "node_2": 6, "dof_2": 2}
    yield cards.INITIAL, {"IPUU": 1, "IPUV": 1, "IPUA": 1}
    for number in (1, 2, 3):
        yield cards.INITIAL_VALUES, {"N": number, "v1": 1.0, "v5": 2.0}
    for model in (1, 2, 6, 7):
        yield cards.MODEL, {"MODEL": model, "materials": 1, "points": 3}
    yield cards.MATERIAL, {"MOD": 1, "MAT": 1, "GUST": 7.5}
    yield laws.FIXED[1].cards[0], {"E": 200.0}
    yield laws.FIXED[1].cards[1], {"nu": 0.25}
    yield cards.MATERIAL, {"MOD": 2, "MAT": 1, "GUST": 7.5}
    for layout in laws.FIXED[2].cards:
        yield layout, dict.fromkeys(list(layout.fields)[:3], 0.5)
    yield cards.MATERIAL, {"MOD": 6, "MAT": 1, "GUST": 7.5}
    yield laws._COUNT, {"NTFUN": 1}
    yield laws._ELASTIC, {"E": 200.0, "nu": 0.25}
    yield laws._YIELD, {"TAUY": 0.5, "CY": 0.25}
    yield laws._POWER, {"AN": 1.0, "EM": 1.0}
    yield cards.MATERIAL, {"MOD": 7, "MAT": 1, "GUST": 7.5}
    for layout, values in zip(laws.FIXED[7].cards, ({"E": 2.0, "nu": 0.25}, {"A": 1.0}, {"W": 0.5}), strict=True):
        yield layout, values
    yield cards.group(wide), {"NETIP": 3, "NE": 1, "IATYP": 0, "NMODM": 2, "INDBTH": 1}
    yield cards.SOLID_GROUP, {"NGAUSX": 2, "NGAUSY": 2, "NGAUSZ": 2, "MSET": 1}
    yield cards.MATERIAL_AXES, {"CP1X": 1.0, "CP2Y": 1.0}
    yield cards.LAYERS, {"NSLOJ": 2}
    for _ in range(2):
        yield cards.LAYER, {"MATSL": 1, "DSLOJ": 0.5}
    yield cards.solid(wide), {"NN": 1, "NMAT": 1, "IPGS": 1, "BTH": 0.5}
    yield cards.nodes(wide, 1, 8), HEX
    yield cards.nodes(wide, 9, 21), {}
    yield cards.group(wide), {"NETIP": 84, "NE": 1, "IATYP": 1, "NMODM": 6}
    yield cards.SHELL_GROUP, {"NGAUSX": 2, "NGAUSY": 2, "NGAUSZ": 5}
    yield cards.flat(wide), {"NN": 1, "NMAT": 1, "THI": 0.5}
    yield cards.nodes(wide, 1, 9), QUAD
    yield cards.group(wide), {"NETIP": 1, "NE": 1, "IATYP": 0, "NMODM": 1}
    yield cards.truss(wide), {"NN": 1, "NMAT": 1, "APR": 0.5}
    yield cards.nodes(wide, 1, 2), {"n1": 1, "n2": 2}
    yield cards.group(wide), {"NETIP": 6, "NE": 1, "IATYP": 0, "NMODM": 1}
    yield cards.BEAM_GROUP, {"NTIP": 1}
    yield cards.BEAM_SECTION, {"POVR": 1.0, "YI": 1.0, "ZI": 1.0, "TK": 1.0}
    yield cards.beam(wide), {"NN": 1, "n1": 1, "n2": 2, "NMAT": 1, "CTR3": 5.0}
    yield cards.FUNCTIONS, {"NTABFT": 1, "MAXTFT": 2}
    yield cards.FUNCTION, {"IBR": 1, "IMAX": 2}
    for t in (0.0, 10.0):
        yield cards.POINT, {"t": t, "f": 1.0}
    yield cards.loads(wide), {"NCF": 1, "NPP2": 1, "NPP3": 1, "NTEMP": 1, "NZADP": -1, "INDZS": 1}
    yield cards.force(wide), {"N": 1, "IP": 1, "NC": 1, "FAK": 0.5}
    yield cards.LINE_LOAD, {"NFUN": 1, "v1": 1.0, "v2": 2.0, "THICV": 0.5}
    yield cards.LINE_NODES, {"n1": 1, "n2": 2}
    yield cards.FACE_LOAD, {"NFUN": 1, "v1": 1.0, "v2": 1.0, "v3": 1.0, "v4": 1.0}
    yield cards.nodes(wide, 1, 9), QUAD
    yield cards.TEMPERATURE, {"N": 1, "NC": 1, "FAK": 20.0}
    yield cards.displacement(wide), {"N": 3, "IP": 1, "NC": 1, "FAK": 0.5}
    yield cards.BODY, {"NVFUB": 1, "gz": -9.5}


LAYOUTS = {wide: [layout for layout, _ in rows(wide)] for wide in (False, True)}


@cache
def lines(wide: bool) -> tuple[str, ...]:
    """The deck's lines: the title, the cards, STOP."""
    text = CardText(Report(), pointed=True)
    return ("every card", *(text.line(layout, values, "") for layout, values in rows(wide)), "STOP")


def replaced(wide: bool, card: int, word: str) -> Iterator[tuple[str, Field, str]]:
    """The deck with a word in each numeric field of a card in turn; the field, and as much of the word as it holds."""
    for where in LAYOUTS[wide][card].fields.values():
        if where.kind != "a":
            deck = list(lines(wide))
            line, width = deck[card + 1].ljust(where.end), where.end - where.start
            deck[card + 1] = line[: where.start] + word[:width].rjust(width) + line[where.end :]
            yield "\n".join(deck) + "\n", where, word[:width]


# the cards of a deck with wide numbers only where they differ from the others
CASES = [
    pytest.param(wide, card, id=f"{'wide' if wide else 'narrow'}:{card + 2}")
    for wide, layouts in LAYOUTS.items()
    for card, layout in enumerate(layouts)
    if not wide or layout is not LAYOUTS[False][card]
]


@pytest.mark.parametrize("wide", [False, True])
def test_the_deck_is_sound_as_it_is(tmp_path: Path, strict: ModuleType, same: Callable, wide: bool) -> None:
    path = tmp_path / "a.dat"
    path.write_text("\n".join(lines(wide)) + "\n")
    model = read(path)
    strict.read(path)
    report = write(model, tmp_path / "b.dat")
    strict.read(tmp_path / "b.dat")
    assert not report
    assert same(read(tmp_path / "b.dat"), model)
    assert model.element_counts() == {"hex8": 1, "quad4": 1, "line2": 2}
    assert (model.sections[1].native["axes"], model.node_data["LJ"].tolist()) == ((1.0, 0, 0, 0, 1.0, 0), [1] + [0] * 7)
    assert model.blocks[0].data["birth"].tolist() == [0.5]
    assert len(model.equations) == 1
    assert [load.kind for load in model.nodal_loads] == [
        "displacement", "acceleration", "force", "temperature", "displacement",
    ]  # fmt: skip


@pytest.mark.parametrize(("wide", "card"), CASES)
def test_letters_in_a_number_are_one_fault_at_their_place(
    faults: Callable[..., list[str]], wide: bool, card: int
) -> None:
    for text, where, cut in replaced(wide, card, "oops"):
        said = faults(read, text, "a.dat")
        assert len(said) == 1, (where.name, said)
        assert said[0].startswith(f"a.dat:{card + 2}:{where.end - len(cut) + 1}: error: "), (where.name, said)
        assert f"({cut})" in said[0], (where.name, said)


@pytest.mark.parametrize(("wide", "card"), CASES)
def test_any_number_is_read_or_a_fault(tmp_path: Path, wide: bool, card: int) -> None:
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for number in ("-9", "9" * 10):
        for text, _, _ in replaced(wide, card, number):
            (tmp_path / "a.dat").write_text(text)
            with contextlib.suppress(InputError):
                read(tmp_path / "a.dat")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 64_000  # kB


@pytest.mark.parametrize("wide", [False, True])
def test_cut_decks_say_where_they_end(faults: Callable[..., list[str]], wide: bool) -> None:
    deck = lines(wide)
    for keep in range(1, len(deck)):
        said = faults(read, "\n".join(deck[:keep]) + "\n", "a.dat")
        assert f"a.dat:{keep + 1}:1: error: the file ends here; expected" in said[-1], (keep, said)


def test_changed_bytes_never_break_the_reader(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    whole = {wide: "\n".join(lines(wide)).encode() for wide in (False, True)}
    for trial in range(300):
        deck = bytearray(whole[bool(trial % 2)])
        for _ in range(int(rng.integers(1, 6))):
            at, what = int(rng.integers(len(deck))), int(rng.integers(4))
            if what == 0:
                deck[at] = int(rng.integers(1, 256))
            elif what == 1:
                del deck[at : at + int(rng.integers(1, 40))]
            elif what == 2:
                deck[at:at] = deck[at : at + int(rng.integers(1, 200))]
            else:
                deck[at] = ord(rng.choice(list("0123456789-+.E \n")))
        (tmp_path / "a.dat").write_bytes(bytes(deck))
        with contextlib.suppress(InputError):
            read(tmp_path / "a.dat")
