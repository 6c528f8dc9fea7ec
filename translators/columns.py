"""Whole columns of numbers into fixed-width text at once: what writing a million cards in seconds takes.

A column of text is an array of bytes, shape (n, width). `real_text` says single numbers with more care; here a number
is written to at most 15 digits.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zrno.translators.real_text import real_text
from zrno.translators.text import parse_real

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Text = NDArray[np.uint8]

_BLANK, _MINUS, _POINT, _ZERO, _E = (np.uint8(ord(letter)) for letter in " -.0E")
_MOST_DIGITS = 15
_SMALLEST, _LARGEST = 1e-290, 1e290  # outside each number is written by itself
_TENS = 10.0 ** np.arange(_MOST_DIGITS + 1)
_CLOSE = 4e-16  # relative: what is nearer is the same double but for its last bit


def integers(values: Ints, width: int) -> Text:
    """Integers, right-justified; raises ValueError where one does not fit."""
    if len(values) and (values == values[0]).all():
        word = str(int(values[0])).rjust(width).encode()
        if len(word) > width:
            raise ValueError(f"a number does not fit {width} columns")
        return np.broadcast_to(np.frombuffer(word, np.uint8), (len(values), width))
    text = np.full((width, len(values)), _ZERO)
    left = np.abs(values)
    for column in range(width - 1, -1, -1):
        if not left.any():
            break
        shorter = left // 10
        text[column] = left - 10 * shorter + _ZERO
        left = shorter
    leading = np.ones(len(values), bool)
    first = np.zeros(len(values), np.int64)
    for column in range(width - 1):
        leading &= text[column] == _ZERO
        if not leading.any():
            break
        text[column, leading] = _BLANK
        first += leading
    negative = np.flatnonzero(values < 0)
    if left.any() or (first[negative] == 0).any():
        raise ValueError(f"a number does not fit {width} columns")
    text[first[negative] - 1, negative] = _MINUS
    return text.T


def reals(values: Floats, width: int) -> tuple[Text, Floats]:
    """Reals with a decimal point, right-justified, and the numbers that the text says.

    The shortest decimals that are the number, else the closest that fit. Raises ValueError where nothing fits.
    """
    text = np.full((len(values), width), _BLANK)
    said = np.zeros(len(values))
    size = np.abs(values)
    negative = np.signbit(values) & (size > 0)
    small = (size > 0) & (size < 0.01)
    plain = ~small & (size < 10.0 ** min(width - 3, _MOST_DIGITS - 1))
    odd = ~plain & ((size > 0) & ((size < _SMALLEST) | (size > _LARGEST)))
    rest = np.flatnonzero(~plain & ~odd)
    rows = np.flatnonzero(plain)
    _decimals(text, said, rows, size, negative, width)
    if len(rest):  # 0.0025 is nicer than 2.5E-3, where it is as exact
        _decimals(text, said, rest[small[rest]], size, negative, width)
        powers = rest[said[rest] != size[rest]]
        _powers(text, said, powers, size, negative, width)
        _as_it_will_be_again(text, said, powers[small[powers]], size, negative, width)
    _alone(text, said, np.flatnonzero(odd), size, negative, width)
    return text, np.where(negative, -said, said)


def same(said: Floats, values: Floats) -> NDArray[np.bool_]:
    """Which of the numbers that a text says are the numbers meant."""
    return np.abs(said - values) <= _CLOSE * np.abs(values)


def _decimals(text: Text, said: Floats, rows: Ints, size: Floats, negative: NDArray[np.bool_], width: int) -> None:
    """Write numbers as 12.5: with as few decimals as are exact, at most as many as fit."""
    whole = np.floor(np.log10(np.maximum(size[rows], 1))).astype(np.int64) + 1
    room = np.minimum(width - 1 - negative[rows] - whole, _MOST_DIGITS - whole * (size[rows] >= 1))
    scaled = np.rint(size[rows] * _TENS[room])
    said[rows] = scaled / _TENS[room]
    digits, decimals = _trimmed(scaled.astype(np.int64), room)
    for count in np.flatnonzero(np.bincount(decimals)).tolist():
        these = decimals == count
        _put(text, rows[these], digits[these], count, negative, width)


def _as_it_will_be_again(
    text: Text, said: Floats, rows: Ints, size: Floats, negative: NDArray[np.bool_], width: int
) -> None:
    """Small numbers that a power rounded: as 0.0025 where the rounded number is that, which is how it is written when
    the text is read and written again."""
    powered, rounded = text[rows], said[rows]
    target = size.copy()
    target[rows] = rounded
    _decimals(text, said, rows, target, negative, width)
    other = said[rows] != rounded
    text[rows[other]], said[rows[other]] = powered[other], rounded[other]


def _trimmed(digits: Ints, decimals: Ints) -> tuple[Ints, Ints]:
    """Digits and decimals without the zeros at their end."""
    for step in (8, 4, 2, 1):
        shorter, zeros = np.divmod(digits, 10**step)
        there = (zeros == 0) & (decimals >= step)
        digits, decimals = np.where(there, shorter, digits), decimals - step * there
    return digits, decimals


def _put(
    text: Text, rows: Ints, scaled: Ints, decimals: int, negative: NDArray[np.bool_], width: int, end: int | None = None
) -> None:
    """Write scaled / 10^decimals into rows of a text, up to a column; 12 becomes 12.0 where that fits."""
    if not len(rows):
        return
    end = width if end is None else end
    if decimals == 0 and end == width:
        fits = scaled < 10.0 ** (width - 2 - negative[rows])
        _put(text, rows[fits], scaled[fits] * 10, 1, negative, width)
        rows, scaled = rows[~fits], scaled[~fits]
        if not len(rows):
            return
    digits = integers(scaled, end - 1).copy()
    if decimals:
        tail = digits[:, end - 1 - decimals :]
        tail[tail == _BLANK] = _ZERO
    first = end - 1 - decimals - 1
    if first >= 0:  # a zero before the point, where there is room for it
        bare = digits[:, first] == _BLANK
        digits[bare & ((first > 0) | ~negative[rows]), first] = _ZERO
    block = np.full((len(rows), end), _BLANK)
    block[:, : end - 1 - decimals] = digits[:, : end - 1 - decimals]
    block[:, end - 1 - decimals] = _POINT
    block[:, end - decimals :] = digits[:, end - 1 - decimals :]
    minus = np.flatnonzero(negative[rows])
    block[minus, np.argmax(block[minus] != _BLANK, axis=1) - 1] = _MINUS
    text[rows, :end] = block


def _powers(text: Text, said: Floats, rows: Ints, size: Floats, negative: NDArray[np.bool_], width: int) -> None:
    """Write numbers as 1.25E-7."""
    if not len(rows):
        return
    power = np.floor(np.log10(size[rows])).astype(np.int64)
    for e in np.unique(power).tolist():
        of_power = rows[power == e]
        tail = f"E{e}".encode()
        for minus in (False, True):
            some = of_power[negative[of_power] == minus]
            room = min(width - len(tail) - 2 - minus, _MOST_DIGITS - 1)
            if not len(some):
                continue
            if room < 0:
                raise ValueError(f"{size[some[0]]!r} does not fit {width} columns")
            scaled = np.rint(_times(size[some], room - e))
            over = scaled >= 10.0 ** (room + 1)
            _alone(text, said, some[over], size, negative, width)  # rounded up to the next power of ten
            some, scaled = some[~over], scaled[~over]
            digits, decimals = _trimmed(scaled.astype(np.int64), np.full(len(some), room))
            for count in np.flatnonzero(np.bincount(decimals)).tolist():
                these = decimals == count
                _put(text, some[these], digits[these], count, negative, width, width - len(tail))
            text[some, width - len(tail) :] = np.frombuffer(tail, np.uint8)
            said[some] = _times(scaled, e - room)


def _alone(text: Text, said: Floats, rows: Ints, size: Floats, negative: NDArray[np.bool_], width: int) -> None:
    """Write numbers one by one."""
    for row in rows.tolist():
        word, _ = real_text(float(size[row]), width - int(negative[row]), implied=1)
        text[row] = np.frombuffer((("-" if negative[row] else "") + word).rjust(width).encode(), np.uint8)
        said[row] = parse_real(word)


def _times(values: Floats, power: int) -> Floats:
    """Values times a power of ten: a division where that is the exact one."""
    return np.asarray(values * 10.0**power if power >= 0 else values / 10.0**-power)
