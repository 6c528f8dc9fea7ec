"""The jitted number parser against Python's float, to the last bit."""

from __future__ import annotations

import random
import struct

import numpy as np
import pytest
from numpy.typing import NDArray

from zrno.translators import scan
from zrno.translators.text import line_spans, parse_real


def texts(count: int, seed: int) -> list[str]:
    """Numbers as decks and adversaries write them."""
    rng = random.Random(seed)

    def one() -> str:
        kind = rng.random()
        if kind < 0.25:
            return repr(struct.unpack("d", struct.pack("Q", rng.getrandbits(64)))[0])
        if kind < 0.5:
            return repr(rng.uniform(-1000.0, 1000.0))
        if kind < 0.65:
            return f"{rng.uniform(-1, 1):.{rng.randint(0, 12)}E}"
        if kind < 0.8:
            return f"{rng.getrandbits(62)}e{rng.randint(-340, 300)}"
        # halfway between two doubles, where rounding to even decides
        return f"{rng.getrandbits(53) * 2 + 1}e{rng.randint(-25, 25)}"

    return [text for text in (one() for _ in range(count)) if "n" not in text]


def spans(words: list[str]) -> tuple[NDArray[np.uint8], NDArray[np.int64], NDArray[np.int64]]:
    data = "\n".join(words).encode()
    return np.frombuffer(data, np.uint8), *line_spans(data)


def check_exact(words: list[str]) -> None:
    (values,), care = scan.fixed(*spans(words), [(0, 64, 0)])
    expected = np.array([float(word) for word in words])
    sure = np.ones(len(words), bool) if care is None else ~care[0]
    assert sure.mean() > 0.99
    np.testing.assert_array_equal(values[sure].view(np.uint64), expected[sure].view(np.uint64))


def test_nearest_double() -> None:
    check_exact(texts(50_000, seed=1))


@pytest.mark.slow
def test_nearest_double_of_a_million() -> None:
    check_exact(texts(1_000_000, seed=2))


@pytest.mark.parametrize(
    "word",
    ["0", "-0.0", "1.", ".5", "+3", "1.5D+03", "8.9-3", "1+2", "17.80000E-9", "9007199254740993", "1e22", "1e23",
     "123456789012345678", "2.2250738585072014e-308", "4.35", "0.1", "1e-5", "5e-324", "1e400", "abc", "1.2.3", "1e",
     "--1", "1e5x", "0x10", "nan", "inf", "1_000", "12345678901234567890123", "e5", ".", "+", "1 2"],
)  # fmt: skip
def test_agrees_with_the_careful_parser(word: str) -> None:
    (values,), care = scan.fixed(*spans([word]), [(0, 64, 0)])
    careful = parse_real(word)
    if care is None:
        assert careful is not None
        assert struct.pack("d", values[0]) == struct.pack("d", careful)
    else:  # what the kernel leaves to its caller is no number, or lies near the ends of the range
        assert careful is None or careful in (0.0, np.inf) or not 1e-300 < abs(careful) < 1e300 or len(word) > 19


def test_columns_are_cut_and_blanks_are_zero() -> None:
    data = b"  12 -1.5   7\n   3\r\n\n9999999999999999999  1\n"
    bytes_, starts, ends = np.frombuffer(data, np.uint8), *line_spans(data)
    (number, real, implied), care = scan.fixed(bytes_, starts, ends, [(0, 4, -1), (4, 10, 0), (10, 13, 2)])
    assert number.tolist() == [12, 3, 0, 9999]
    assert real.tolist() == [-1.5, 0.0, 0.0, 999999.0]
    assert implied.tolist() == [0.07, 0.0, 0.0, 9.99]
    assert care is None
    _, care = scan.fixed(bytes_, starts, ends, [(0, 19, -1)])
    assert care is not None
    assert care[0].tolist() == [True, False, False, True]


def test_free_fields() -> None:
    lines = ["1, 2.5 ,3,", "4 5   6 7", ",,8", "", "9,x,1e3", "\t10\t11"]
    values, counts, care = scan.free(*spans(lines), 3)
    assert counts.tolist() == [3, 4, 3, 0, 3, 2]
    np.testing.assert_array_equal(
        values, [[1, 2.5, 3], [4, 5, 6], [0, 0, 8], [0, 0, 0], [9, np.nan, 1000], [10, 11, 0]]
    )
    assert care is not None
    assert care.tolist() == [False, False, False, False, True, False]
    values, counts, care = scan.free(*spans(["1 2, 3", " 4 ,5"]), 2, only_commas=True)
    assert counts.tolist() == [2, 2]
    assert care is not None
    assert care.tolist() == [True, False]
    assert values[1].tolist() == [4, 5]


def test_lines_of_zeros() -> None:
    lines = ["0,0, 0,", "0 1", "", " \t0.0", "0,a", "00009"]
    assert scan.zeros(*spans(lines)).tolist() == [True, False, True, True, False, False]


def test_line_spans() -> None:
    data = b"a\r\n\r\nbc\n\n" * 2 + b"end"
    starts, ends = line_spans(data)
    assert [data[a:b] for a, b in zip(starts, ends, strict=True)] == [b"a", b"", b"bc", b""] * 2 + [b"end"]
    assert [a.tolist() for a in line_spans(b"\n")] == [[0], [0]]
