from __future__ import annotations

import math
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zrno.translators import read
from zrno.translators.real_text import real_text, real_texts
from zrno.translators.text import Cards, InputError, Layout, parse_real

DOUBLES = st.floats(allow_nan=False, allow_infinity=False)
MODERATE = st.floats(-1e300, 1e300)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1.0D+00", 1.0),
        ("1.5-3", 1.5e-3),
        ("", 0.0),
        ("  ", 0.0),
        ("-.5", -0.5),
        ("3.", 3.0),
        ("2E3", 2000.0),
        ("1d2", 100.0),
    ],
)
def test_fortran_reals(text: str, value: float) -> None:
    assert parse_real(text) == value


@pytest.mark.parametrize("text", ["abc", "1.0.0", "1 2", "nan", "inf", "1_0", "0x1", "E5", "--1"])
def test_what_is_no_real(text: str) -> None:
    assert parse_real(text) is None


def test_implied_decimals() -> None:
    assert parse_real("1000", implied=5) == 0.01
    assert parse_real("1000.", implied=5) == 1000.0
    assert parse_real("1E3", implied=5) == 1e-2


def test_a_layout_is_a_fortran_format() -> None:
    layout = Layout("2i5,e10.5,a3", "a b c d")
    assert [(f.start, f.end, f.kind, f.implied) for f in layout.fields.values()] == [
        (0, 5, "i", 0), (5, 10, "i", 0), (10, 20, "e", 5), (20, 23, "a", 0),
    ]  # fmt: skip


def test_a_block_of_every_spelling_is_exact() -> None:
    texts = ["1.5-3", "0.1", "", "1.0D+00", "-7", "1.7976931348623157E308"[:20], "0.30000000000000004", "5e-324"]
    data = "".join(f"{i:8d}{text:>20}\r\n" for i, text in enumerate(texts)).encode()
    block = Cards("x", data, comments=b"*").block(Layout("i8,e20.0", "number value"), len(texts), "card")
    assert block["value"].tolist() == [parse_real(text) for text in texts]
    assert block["number"].tolist() == list(range(len(texts)))


def test_comments_are_skipped_and_lines_are_counted() -> None:
    cards = Cards("x", b"* one\n    1\n\n$ two\n    2", comments=b"*$")
    read = [cards.card(Layout("i5", "n"), "card") for _ in range(3)]
    assert [(card["n"], card.line) for card in read] == [(1, 2), (0, 3), (2, 5)]
    assert cards.left == 0


def test_a_fault_names_its_place() -> None:
    cards = Cards("x", b"$\n    1  1x2\n", comments=b"$")
    cards.card(Layout("i5,e5.0", "a b"), "card")
    with pytest.raises(InputError) as caught:
        cards.faults.stop()
    assert str(caught.value) == "x:2:8: error: b is not a number (1x2); expected a number in columns 6-10"


@pytest.mark.parametrize("text", ["1.0E999", "-1E400"])
def test_an_overflow_is_a_fault(text: str) -> None:
    cards = Cards("x", text.encode(), comments=b"$")
    cards.card(Layout("e10.0", "a"), "card")
    with pytest.raises(InputError, match="not a finite number"):
        cards.faults.stop()


def test_no_more_than_twenty_faults() -> None:
    cards = Cards("x", b"    a\n" * 50, comments=b"$")
    with pytest.raises(InputError) as caught:
        cards.block(Layout("i5", "n"), 50, "card")
    assert len(caught.value.faults) == 20


def test_an_increasing_run_ends_where_numbers_do() -> None:
    layout = Layout("i8", "n")
    cards = Cards("x", b"       1\n       3\n      40\n      40\n      50\n", comments=b"$")
    assert cards.increasing_run(layout.fields["n"]) == 3
    assert Cards("x", b"       1\n     2.0\n", comments=b"$").increasing_run(layout.fields["n"]) == 1
    assert Cards("x", b"        \n       2\n", comments=b"$").increasing_run(layout.fields["n"]) == 0


@given(DOUBLES)
def test_a_number_fits_24_columns_exactly(value: float) -> None:
    text, exact = real_text(value, 24)
    assert exact
    assert len(text) <= 24
    assert parse_real(text) == value
    assert math.copysign(1, float(text)) == math.copysign(1, value) if value == 0 else True


@given(MODERATE, st.sampled_from([10, 20]))
def test_a_number_in_a_field_is_exact_or_close(value: float, width: int) -> None:
    text, exact = real_text(value, width)
    back = parse_real(text)
    assert back is not None
    assert len(text) <= width
    assert (back == value) == exact
    digits = {10: 3, 20: 13}[width]
    assert exact or abs(back - value) <= 10.0**-digits * abs(value)


@given(DOUBLES, st.integers(4, 20), st.booleans(), st.sampled_from(["e", "f", "g"]))
def test_what_stood_in_a_field_fits_it_again(value: float, width: int, point: bool, style: str) -> None:
    for digits in range(15, -1, -1):
        text = f"{value:{'#' if point else ''}.{digits}{style}}"
        if len(text) <= width and math.isfinite(float(text)):
            again, exact = real_text(float(text), width)
            assert exact
            assert parse_real(again) == float(text)
            return


def test_a_number_that_no_text_comes_near_is_refused() -> None:
    with pytest.raises(ValueError, match="does not fit 10 columns"):
        real_text(1.79765e308, 10, implied=5)  # rounded to what fits, it overflows


@given(MODERATE)
def test_a_field_with_implied_decimals_always_has_a_point(value: float) -> None:
    text, _ = real_text(value, 10, implied=5)
    assert "." in text


def test_arrays_of_texts_count_what_is_not_exact() -> None:
    texts, inexact = real_texts(np.array([0.1, 1e-5, 1 / 3, -0.001234567890123456]), 10)
    assert inexact == 2
    assert [len(text) <= 10 for text in texts] == [True] * 4
    assert float(texts[2]) == pytest.approx(1 / 3, rel=1e-7)


@pytest.mark.parametrize("line", [b"\n", b"1\n", b"1,2\n"])
@pytest.mark.parametrize("suffix", [".k", ".dat", ".mcm", ".neu"])
def test_files_of_nothing_but_short_lines(tmp_path: Path, suffix: str, line: bytes) -> None:
    """The indices of their lines took 40 to 200 bytes a line: 245 MB for 6 MB of blank ones."""
    head = {".k": b"*KEYWORD\n*NODE\n", ".neu": b"   -1\n   100\n<NULL>\n4.41,\n   -1\n   -1\n   403\n"}.get(
        suffix, b"a\n"
    )
    path = tmp_path / f"short{suffix}"
    path.write_bytes(head + line * (6_000_000 // len(line)))
    with pytest.raises(InputError):  # the modules that it loads are not the file's memory
        read(tmp_path / f"missing{suffix}")
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match="characters on average"):
            read(path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < (64 << 20) + 10 * path.stat().st_size
