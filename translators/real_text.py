"""Numbers into fixed-width fields: the shortest text that reads back as the same double."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray


def real_text(value: float, width: int, *, implied: int = 0) -> tuple[str, bool]:
    """The shortest readable text of a number that fits a field and reads back as the same double.

    Returns the text and whether it is exact: where no exact text fits, the closest that does. It has a decimal point
    unless only digits fit (never so where the format implies decimals). Raises ValueError when nothing fits.
    """
    shortest = repr(float(value))
    if "e" not in shortest and len(shortest) <= width:
        return shortest, True
    sign, digits, exponent = _decimal(shortest)
    for text in _spellings(sign, digits, exponent, implied):
        if len(text) <= width:
            return text, True
    for count in range(min(len(digits), width), 0, -1):
        rounded = f"{value:.{count - 1}e}"
        if not math.isfinite(float(rounded)):  # rounded up past the largest double
            continue
        if any(len(text) <= width for text in _spellings(*_decimal(rounded), implied)):
            # as that number itself is written: a deck that is read and written again is the same
            return real_text(float(rounded), width, implied=implied)[0], False
    raise ValueError(f"{value!r} does not fit {width} columns")


def _decimal(text: str) -> tuple[str, str, int]:
    """Sign, significant digits d1 d2 .. and exponent e of a decimal number: 0.d1d2.. x 10^e."""
    sign, text = ("-", text[1:]) if text.startswith("-") else ("", text)
    mantissa, _, power = text.partition("e")
    whole, _, fraction = mantissa.partition(".")
    digits = (whole + fraction).lstrip("0")
    exponent = len(whole) + int(power or 0) - (len(whole + fraction) - len(digits))
    return sign, digits.rstrip("0") or "0", exponent


def _spellings(sign: str, digits: str, exponent: int, implied: int) -> Iterator[str]:
    """Ways to write 0.digits x 10^exponent in Fortran, the most readable first."""
    count = len(digits)
    if -8 <= exponent <= 0:
        yield f"{sign}0.{'0' * -exponent}{digits}"
        yield f"{sign}.{'0' * -exponent}{digits}"
    elif 0 < exponent < count:
        yield f"{sign}{digits[:exponent]}.{digits[exponent:]}"
    elif count <= exponent <= 18:
        yield f"{sign}{digits.ljust(exponent, '0')}."
    yield f"{sign}{digits[0]}.{digits[1:]}E{exponent - 1}"
    for letter in ("E", ""):  # a point elsewhere may save a digit of the exponent, a bare sign its letter
        for point in (1, 0, count):
            power = exponent - point
            yield f"{sign}{digits[:point]}.{digits[point:]}{letter}{power if letter else f'{power:+d}'}"
    if implied == 0:
        if count <= exponent <= 18:
            yield sign + digits.ljust(exponent, "0")
        yield f"{sign}{digits}E{exponent - count}"
        yield f"{sign}{digits}{exponent - count:+d}"


def real_texts(values: NDArray[np.float64], width: int) -> tuple[list[str], int]:
    """`real_text` of an array, shape (n,), and how many of them are not exact."""
    texts = [repr(value) for value in values.tolist()]
    inexact = 0
    long = [i for i, text in enumerate(texts) if len(text) > width or "e" in text]
    for i in long:
        texts[i], exact = real_text(values[i], width)
        inexact += not exact
    return texts, inexact
