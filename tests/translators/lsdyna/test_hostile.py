"""Files that are cut, changed, or meant to do harm: faults with places, no other exception, no hang, no memory."""

from __future__ import annotations

import random
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.lsdyna import read, write
from zrno.translators.model import Model
from zrno.translators.text import InputError

Read = Callable[..., Model]

TOKENS = (
    b",", b"&x", b"-&E", b"<1/0>", b"<9**9**9>", b"1e999", b"-1", b"9" * 25, b"*", b"$", b"\n", b"\r", b"\0", b"*END\n",
    b"1.5-3", b"0", b"nan", b"inf", b"*INCLUDE\ndeck.k\n", b"*SET_NODE_GENERAL\n", b"_TITLE", b"+", b"%", b"-", b".",
    b"9999999999", b"*KEYWORD LONG=Y\n", b"*KEYWORD I10=Y\n", b"  ", b"\t", b"\xff", b"*ELEMENT_SOLID\n", b"*NODE\n",
    b"*DEFINE_TRANSFORMATION\n", b"4611686018427387905", b"*INCLUDE_TRANSFORM\ndeck.k\n", b"*PARAMETER\nR x 1\n",
)  # fmt: skip


def changed(text: bytes, rng: random.Random) -> bytes:
    """A deck with pieces cut, doubled, moved, overwritten."""
    deck = bytearray(text)
    if rng.random() < 0.15:
        del deck[rng.randrange(len(deck)) :]
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        if not deck:
            break
        place = rng.randrange(len(deck))
        match rng.randrange(5):
            case 0:
                deck[place : place + rng.choice((0, 1, 3, 8))] = rng.choice(TOKENS)
            case 1:
                deck[place] = rng.randrange(256)
            case 2:
                del deck[place : place + rng.randrange(1, 100)]
            case 3:
                other = rng.randrange(len(deck))
                deck[place:place] = deck[other : other + rng.randrange(200)]
            case _:
                lines = bytes(deck).split(b"\n")
                a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
                lines[a], lines[b] = lines[b], lines[a]
                deck = bytearray(b"\n".join(lines))
    return bytes(deck)


def read_or_fault(path: Path, **options: bool) -> Model | None:
    """The model, or None where it is refused by faults that have places."""
    try:
        return read(path, **options)
    except InputError as error:
        faults = error.faults
    assert 1 <= len(faults) <= 20
    assert all(fault.line >= 1 and fault.column >= 1 and fault.message for fault in faults)
    return None


def broken(text: bytes, folder: Path, seed: int, count: int) -> int:
    """How many of `count` changed decks are still read; each that is must be writable, and readable again."""
    rng = random.Random(seed)
    sound = 0
    for _ in range(count):
        (folder / "deck.k").write_bytes(changed(text, rng))
        model = read_or_fault(folder / "deck.k", partial=rng.random() < 0.3)
        if model is None or model.incomplete:
            continue
        sound += 1
        assert not model.xyz.size or np.isfinite(model.xyz).all()
        try:
            write(model, folder / "again.k")
        except ValueError as error:  # what no deck can hold
            if "more than ten digits" not in str(error):
                raise
            continue
        read(folder / "again.k", partial=True)
    return sound


def test_changed_decks(everything: str, tmp_path: Path) -> None:
    assert broken(everything.encode(), tmp_path, 1, 250) > 10


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_many_changed_decks(everything: str, tmp_path: Path, seed: int) -> None:
    assert broken(everything.encode(), tmp_path, 100 + seed, 1000) > 50


@pytest.mark.parametrize("size", range(0, 4000, 97))
def test_decks_that_are_cut(everything: str, tmp_path: Path, size: int) -> None:
    (tmp_path / "deck.k").write_bytes(everything.encode()[:size] or b" ")
    read_or_fault(tmp_path / "deck.k")


def test_line_ends_of_windows(deck: Read, everything: str) -> None:
    model = deck(everything.encode().replace(b"\n", b"\r\n"))
    plain = deck(everything)
    assert np.array_equal(model.xyz, plain.xyz)
    assert [m.parameters for m in model.materials.values()] == [m.parameters for m in plain.materials.values()]
    assert [p.name for p in model.parts.values()] == [p.name for p in plain.parts.values()]


@pytest.mark.parametrize(
    "text",
    [
        "*NODE\n" + "1," * 100_000 + "\n",
        "*NODE\n" + "9" * 1_000_000 + "\n",
        "*" * 100_000 + "\n",
        "*NODE\n" * 20_000,
        "*PARAMETER_EXPRESSION\nR        a  " + "(" * 100_000 + "\n",
        "*PARAMETER_EXPRESSION\n" + "R        a  1+\n" + "            1+\n" * 20_000,
        "*SET_NODE_GENERAL\n1\n" + "ALL\n" * 20_000,
        "*PART\n" + "\n" * 50_000,
        "*INCLUDE\n" + "x" * 100_000 + "\n",
        "*INCLUDE\n" + "x +\n" * 20_000,
        "*INCLUDE\n" + "\0" * 10 + "\n",
        "*DEFINE_CURVE\n1\n" + "0,0\n" * 20_000,
        "*ELEMENT_SPH\n" + "".join(f"{i},1,1.,999999999\n" for i in range(1, 2000)),
        "*MAT_" + "_".join(["A"] * 20_000) + "\n1,2\n",
        "*ELEMENT_SHELL_THICKNESS\n" + "\n" * 20_000,
        "$\n\n" * 20_000 + "*NODE\n" + "$\n\n" * 20_000,
    ],
    ids=range(16),
)
def test_decks_that_are_meant_to_do_harm(tmp_path: Path, text: str) -> None:
    (tmp_path / "deck.k").write_text(text)
    tracemalloc.start()
    read_or_fault(tmp_path / "deck.k")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 64_000_000 + 10 * len(text)


def test_the_first_twenty_faults_are_said(deck: Read) -> None:
    with pytest.raises(InputError) as caught:
        deck("*NODE\n" + "x,y\n" * 100)
    assert len(caught.value.faults) == 20


def test_a_folder_and_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read(tmp_path / "none.k")
    with pytest.raises(InputError, match="directory"):
        read(tmp_path)
