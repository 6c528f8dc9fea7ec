"""How fields are cut: standard, long and ten-column ids, suffixes, commas, numbers, comments, what ends a file."""

from __future__ import annotations

import random
from collections.abc import Callable

import numpy as np
import pytest

from zrno.translators.model import Model
from zrno.translators.text import InputError

Read = Callable[..., Model]


def test_standard_columns_abut(deck: Read) -> None:
    model = deck("*NODE\n       1-2.193931007E+01 2.907068825E+01-2.193931007E+01       3       7\n")
    assert model.node_ids.tolist() == [1]
    assert model.xyz.tolist() == [[-21.93931007, 29.07068825, -21.93931007]]
    assert model.fixed is not None
    assert model.fixed.tolist() == [[False, False, True, True, True, True]]


def test_numbers_of_fortran(deck: Read) -> None:
    model = deck(
        "*MAT_ELASTIC\n        2.7.80000E-9   1.5D+3     8.9-3\n"
        "*NODE\n      1.         2.1E+05           1.5-3            .5D1\n"
    )
    material = model.materials[2]
    assert (material.density, material.parameters) == (7.8e-9, {"E": 1500.0, "nu": 8.9e-3})
    assert model.xyz.tolist() == [[2.1e5, 1.5e-3, 5.0]]


@pytest.mark.parametrize("keyword", ["*KEYWORD LONG=Y\n*NODE\n", "*NODE +\n", "*NODE+\n", "*keyword long=s\n*node\n"])
def test_long_format(deck: Read, keyword: str) -> None:
    line = f"{12345678901:20d}{1.2345678901234567e-3:20.13e}{-2.5:20.13e}{0.1:20.13e}{7:20d}{0:20d}\n"
    model = deck(keyword + line)
    assert model.node_ids.tolist() == [12345678901]
    assert model.xyz.tolist() == [[1.2345678901235e-3, -2.5, 0.1]]
    assert model.fixed is not None
    assert model.fixed[0, :3].all()


def test_long_nodes_of_two_lines_each(deck: Read) -> None:
    rows = "".join(f"{i:20d}{i + 0.5:20.6f}{0.0:20.6f}{1.0:20.6f}\n{i:20d}{0:20d}\n" for i in (1, 2))
    model = deck("*KEYWORD LONG=Y\n*NODE\n" + rows)
    assert model.xyz.tolist() == [[1.5, 0.0, 1.0], [2.5, 0.0, 1.0]]
    assert model.fixed is not None
    assert model.fixed[:, :2].tolist() == [[True, False], [False, True]]


@pytest.mark.parametrize("keyword", ["*KEYWORD I10=Y\n*NODE\n", "*NODE %\n"])
def test_ten_column_ids(deck: Read, keyword: str) -> None:
    line = f"{1000000001:10d}{1.25:16.8f}{-2.5:16.8f}{0.1:16.8f}{7:10d}{0:10d}\n"
    model = deck(keyword + line)
    assert model.node_ids.tolist() == [1000000001]
    assert model.xyz.tolist() == [[1.25, -2.5, 0.1]]


def test_suffixes_return_to_the_decks_own_format(deck: Read) -> None:
    text = "*KEYWORD LONG=Y\r\n*NODE -\r\n       1             1.0             2.0             3.0\r\n*NODE %\r\n" \
        "         2             4.0             5.0             6.0\r\n*NODE\r\n" \
        f"{3:20d}{7.0:20.1f}{8.0:20.1f}{9.0:20.1f}\r\n*END\r\n*NODE\r\nnonsense\r\n"  # fmt: skip
    model = deck(text)
    assert model.node_ids.tolist() == [1, 2, 3]
    assert model.xyz.ravel().tolist() == [1, 2, 3, 4, 5, 6, 7, 8, 9]


def test_commas(deck: Read) -> None:
    model = deck("*NODE\n1,0.5,,-2.5e1,7\n$ 2,a comment, with commas\n2, 1 ,2,3\n*ELEMENT_SHELL\n5,1,1,2,2\n")
    assert model.xyz.tolist() == [[0.5, 0.0, -25.0], [1.0, 2.0, 3.0]]
    assert model.blocks[0].ids.tolist() == [5]


def test_large_tables_are_as_small_ones(deck: Read) -> None:
    """The jitted way of large tables, with rows of commas, parameters and odd numbers among the plain ones."""
    rng = random.Random(1)
    lines, places = [], []
    for i in range(1, 26_001):
        x = [rng.uniform(-100, 100), rng.uniform(-1, 1) * 10.0 ** rng.randint(-12, 12), float(rng.randint(-9, 9))]
        texts = [repr(v) if len(repr(v)) <= 16 else f"{v:.9e}" for v in x]
        if i % 10 == 0:
            lines.append(f"{i},{texts[0]},{texts[1]},{texts[2]}")
        elif i % 1001 == 0:
            lines.append(f"{i:8d}{'&half':>16}{texts[1]:>16}{texts[2]:>16}")
            texts[0] = "0.5"
        elif i % 1003 == 0:
            lines.append(f"{i:7d}.{texts[0]:>16}{texts[1]:>16}{'1.5D-3':>16}")
            texts[2] = "1.5e-3"
        else:
            lines.append(f"{i:8d}{texts[0]:>16}{texts[1]:>16}{texts[2]:>16}")
        if i % 5000 == 0:
            lines += ["$ a comment, here", "   ", ""]
        places.append([float(t) for t in texts])
    model = deck("*PARAMETER\nR     half       0.5\n*NODE\n" + "\n".join(lines) + "\n*END\n")
    assert model.node_ids.tolist() == list(range(1, 26_001))
    assert np.array_equal(model.xyz, np.array(places))


@pytest.mark.slow
def test_coordinates_are_the_nearest_doubles(deck: Read) -> None:
    rng = random.Random(2)
    texts = []
    for _ in range(1_000_000):
        digits, exponent = rng.randint(1, 9), rng.randint(-99, 99)
        text = f"{rng.choice(' -')}{rng.randint(0, 9)}.{rng.randrange(10**digits):0{digits}d}"
        texts.append(text + (f"E{exponent:+03d}" if rng.random() < 0.7 else ""))
    texts += ["0.0"] * (-len(texts) % 3)
    rows = [f"{i + 1:8d}{a:>16}{b:>16}{c:>16}" for i, (a, b, c) in enumerate(zip(*[iter(texts)] * 3, strict=True))]
    model = deck("*NODE\n" + "\n".join(rows) + "\n")
    assert model.xyz.ravel().tolist() == [float(text) for text in texts]


def test_rows_that_slip_out_of_their_columns_are_understood_and_said(deck: Read) -> None:
    model = deck("*KEYWORD LONG=Y\n*NODE\n" + "\n".join(
        f"{i:20d}{i * 1.5:.15e}{-2.5:.15e}{0.1:.15e}{0:20d}{0:20d}" for i in (1, 2)))  # fmt: skip
    assert model.xyz.tolist() == [[1.5, -2.5, 0.1], [3.0, -2.5, 0.1]]
    assert "2 rows have texts across the borders of their columns" in model.warnings[0]


def test_a_row_of_blanks_between_numbers(deck: Read) -> None:
    assert deck("*NODE\n1 2.5 -3. 1e3\n").xyz.tolist() == [[2.5, -3.0, 1000.0]]


def test_a_parameter_that_is_not_defined_moves_nothing(deck: Read) -> None:
    model = deck("*NODE\n       1                             &x\n", partial=True)
    assert model.xyz.tolist() == [[0.0, 0.0, 0.0]]
    assert model.warnings == ["parameter &x is not defined in the file"]


def test_what_stands_before_and_between_keywords(deck: Read, cube: str) -> None:
    model = deck("a letter\n*KEYWORD\n*COMMENT\nany text, *NODE too\n" + cube + "*COMMENT\nmore\n*TITLE\n Grüße, all\n")
    assert len(model.xyz) == 8
    assert model.title == "Grüße, all"
    assert model.warnings == [f"{_path(model)}:1: text before the first keyword is not read"]


def _path(model: Model) -> str:
    return model.warnings[0].partition(":")[0]


def test_latin_1_and_a_byte_order_mark(deck: Read) -> None:
    assert deck(b"\xef\xbb\xbf*TITLE\nGr\xfc\xdfe\n").title == "Grüße"


def test_what_is_no_deck(deck: Read) -> None:
    for text, message in (
        (b"Dear reader,\nthis is no deck.\n", "no keyword in the file"),
        (b"*NODE\n\0\0\0", "a binary file"),
        (b" \n", "the file is empty"),
    ):
        with pytest.raises(InputError, match=message):
            deck(text)


def test_unknown_keywords_are_counted_once(deck: Read) -> None:
    model = deck("*AIRBAG_NONE\n1\n*AIRBAG_NONE\n2\n*ELEMENT_SEATBELT\n1,1,1,2\n")
    said = [warning.partition(": ")[2] for warning in model.warnings]
    assert said == [
        "*AIRBAG_NONE: not read (2), kept for .k alone", "*ELEMENT_SEATBELT: not read (1), kept for .k alone",
    ]  # fmt: skip


def test_cases_are_warned_of(deck: Read) -> None:
    assert "*CASE" in deck("*CASE_BEGIN_1\n*CASE_END_1\n").warnings[0]


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("*NODE\n       1             0.0             l.0\n", ":2:38:", "xyz is not a number (l.0)"),
        ("*NODE\n     1.5             0.0\n", ":2:6:", "nid is not an integer (1.5)"),
        ("*NODE\n1,0,1e400\n", ":2:5:", "xyz is not a number (1e400)"),
        ("*NODE\n      -1\n", ":2:7:", "a node's number is not positive (-1)"),
        ("*NODE\n1,0,0,0,9\n", ":2:1:", "tc is no constraint code (9)"),
        ("*NODE\n1,0\n2,0\n1,1\n", ":4:1:", "a node number stands twice (1)"),
    ],
)
def test_faults_have_their_place(deck: Read, text: str, place: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        deck(text)
    assert place in str(caught.value)
    assert message in str(caught.value)
