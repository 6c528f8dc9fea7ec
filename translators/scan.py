"""Numbers out of the bytes of large text blocks, exactly: the nearest double, as Python's float gives it.

Jitted, and imported only where a block is large enough to pay for it; small blocks and odd cells go through
`text.parse_real`. What a kernel cannot settle (text that is no number, more than 19 digits, numbers near the ends of
the range of doubles) it marks in `care` and leaves to its caller.

Decimals become doubles by the method of Lemire, "Number parsing at a gigabyte per second" (2021): the decimal
significand times a 128-bit power of five, rounded to even.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray

# numba fixes what it compiles for at its first compilation: the settings of the solvers' kernels must rule that too
from zrno.solvers.jit import exact_kernel

_U = np.uint64
_LEAST_POWER, _MOST_POWER = -342, 308
_BLANK, _COMMA, _PLUS, _MINUS, _POINT, _ZERO = (np.uint8(ord(c)) for c in " ,+-.0")
_TAB = np.uint8(9)
_SHORT = 15  # digits that a double holds


def _powers_of_five() -> NDArray[np.uint64]:
    """The leading 128 bits of 5^q, shape (651, 2): high and low words; reciprocals are rounded up."""
    rows = []
    for q in range(_LEAST_POWER, _MOST_POWER + 1):
        if q < 0:
            power = 5**-q
            z = (power - 1).bit_length()
            value = 2 ** (z + 127 if q >= -27 else 2 * z + 128) // power + 1
        else:
            value = 5**q
        shift = value.bit_length() - 128
        value = value >> shift if shift > 0 else value << -shift
        rows.append((value >> 64, value & (2**64 - 1)))
    return np.array(rows, np.uint64)


_FIVES = _powers_of_five()
_TENS = 10.0 ** np.arange(23)  # exact doubles


@exact_kernel
def _high_low(a, b):
    """The 128-bit product of two words: high, low."""
    mask, half = _U(0xFFFFFFFF), _U(32)
    a1, a0, b1, b0 = a >> half, a & mask, b >> half, b & mask
    low, first, second = a0 * b0, a1 * b0, a0 * b1
    middle = (low >> half) + (first & mask) + (second & mask)
    high = a1 * b1 + (first >> half) + (second >> half) + (middle >> half)
    return high, a * b


@intrinsic
def _word(typing, array, place):
    """Eight bytes of an array from a place on as one word, the first lowest: of any alignment, and unchecked."""

    def code(context, builder, signature, arguments):
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        word = builder.load(builder.bitcast(builder.gep(data, [arguments[1]]), ir.IntType(64).as_pointer()))
        word.align = 1
        return word

    return types.uint64(array, place), code


@intrinsic
def _byte(typing, array, place):
    """One byte of an array, unchecked: an index that may be negative costs a comparison."""

    def code(context, builder, signature, arguments):
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        return builder.load(builder.gep(data, [arguments[1]]))

    return types.uint8(array, place), code


@exact_kernel
def _digits(word):
    """The number that eight bytes are, and whether they are digits or digits behind blanks.

    A blank with the bit of 16 is the digit 0; a byte past 9 then overflows to 128 or has it. The digits are added up in
    pairs, fours and eights (Lemire, "Quickly parsing eight digits", 2018).
    """
    digits = (word | _U(0x1010101010101010)) ^ _U(0x3030303030303030)
    wrong = ((digits + _U(0x7676767676767676)) | digits | word) & _U(0x8080808080808080)
    blanks = ((word & _U(0x1010101010101010)) ^ _U(0x1010101010101010)) >> _U(4)
    blanks *= _U(255)  # bytes full of ones: good where they are the lowest, the first of the text
    good = (wrong | (digits & blanks) | (blanks & (blanks + _U(1)))) == _U(0)
    pairs = digits * _U(10) + (digits >> _U(8))
    low, high = pairs & _U(0x000000FF000000FF), (pairs >> _U(16)) & _U(0x000000FF000000FF)
    eight = (low * _U(0x000F424000000064) + high * _U(0x0000271000000001)) >> _U(32)
    return eight & _U(0xFFFFFFFF), good, blanks


@exact_kernel
def _leading_zeros(w):
    count = _U(0)
    for step in (32, 16, 8, 4, 2, 1):
        if w >> _U(64 - step) == _U(0):
            count += _U(step)
            w = w << _U(step)
    return count


@exact_kernel
def _double_bits(w, q):
    """Bits of the double nearest to w * 10^q (w > 0), and whether they could be found."""
    if q < _LEAST_POWER or q > _MOST_POWER:
        return _U(0), False
    lz = _leading_zeros(w)
    w = w << lz
    high, low = _high_low(w, _FIVES[q - _LEAST_POWER, 0])
    if high & _U(0x1FF) == _U(0x1FF):
        more, _ = _high_low(w, _FIVES[q - _LEAST_POWER, 1])
        low = low + more
        if more > low:
            high = high + _U(1)
    if low == _U(0xFFFFFFFFFFFFFFFF) and (q < -27 or q > 55):
        return _U(0), False
    top = high >> _U(63)
    shift = top + _U(9)
    mantissa = high >> shift
    exponent = ((217706 * q) >> 16) + 63 + np.int64(top) - np.int64(lz) + 1023
    if exponent <= 0 or exponent >= 2046:
        return _U(0), False
    if low <= _U(1) and q >= -4 and q <= 23 and mantissa & _U(3) == _U(1) and mantissa << shift == high:
        mantissa = mantissa & ~_U(1)  # halfway between two doubles: to the even one
    mantissa = (mantissa + (mantissa & _U(1))) >> _U(1)
    if mantissa >= _U(1) << _U(53):
        mantissa = _U(1) << _U(52)
        exponent += 1
    return (mantissa & ~(_U(1) << _U(52))) | (_U(exponent) << _U(52)), True


@exact_kernel
def _real(data, a, b, implied, reals, bits, i):
    """Parse data[a:b], trimmed and not empty, as a Fortran real into place i; False where it takes care."""
    negative = _byte(data, a) == _MINUS
    if negative or _byte(data, a) == _PLUS:
        a += 1
    w, digits, seen, scale, point = _U(0), 0, 0, 0, False
    while a < b:
        c = _byte(data, a)
        d = np.uint8(c - _ZERO)
        if d < 10 and b - a >= 8 and digits <= 11 and (digits > 0 or d > 0):
            eight, good, blanks = _digits(_word(data, a))
            if good and blanks == _U(0):
                seen, digits, scale = seen + 8, digits + 8, scale - 8 * point
                w = w * _U(100000000) + eight
                a += 8
                continue
        if d < 10:
            seen += 1
            if digits > 0 or d > 0:
                digits += 1
                if digits > 19:
                    return False
                w = w * _U(10) + _U(d)
            scale -= point
        elif c == _POINT and not point:
            point = True
        else:
            break
        a += 1
    if seen == 0:
        return False
    if not point:
        scale -= implied
    if a < b:
        c = _byte(data, a) | np.uint8(32)
        if c == np.uint8(101) or c == np.uint8(100) or c == np.uint8(113):  # e, d, q
            a += 1
        elif _byte(data, a) != _PLUS and _byte(data, a) != _MINUS:
            return False
        if a >= b:
            return False
        down = _byte(data, a) == _MINUS
        if down or _byte(data, a) == _PLUS:
            a += 1
        if a >= b or b - a > 4:
            return False
        power = 0
        while a < b:
            d = np.uint8(_byte(data, a) - _ZERO)
            if d > 9:
                return False
            power = power * 10 + d
            a += 1
        scale += -power if down else power
    if w == _U(0):
        reals[i] = 0.0
    elif w <= _U(9007199254740992) and -22 <= scale <= 22:  # two exact doubles: one rounding
        value = np.float64(np.int64(w))
        reals[i] = value * _TENS[scale] if scale >= 0 else value / _TENS[-scale]
    else:
        word, found = _double_bits(w, scale)
        if not found:
            return False
        bits[i] = word
    bits[i] |= _U(negative) << _U(63)
    return True


@exact_kernel
def _integer(data, a, b):
    """data[a:b], trimmed and not empty, as an integer, and whether it is one of at most 18 digits."""
    negative = _byte(data, a) == _MINUS
    if negative or _byte(data, a) == _PLUS:
        a += 1
    if a >= b or b - a > 18:
        return 0, False
    value = 0
    while a < b:
        d = np.uint8(_byte(data, a) - _ZERO)
        if d > 9:
            return 0, False
        value = value * 10 + np.int64(d)
        a += 1
    return (-value if negative else value), True


@exact_kernel
def _fixed(data, starts, ends, columns, ints, reals, bits, care):
    cared = 0
    for i in range(len(starts)):
        for f in range(len(columns)):
            a, b = starts[i] + columns[f, 0], starts[i] + columns[f, 1]
            if columns[f, 2] < 0 and b - a == 8 and b <= ends[i]:
                eight, good, _ = _digits(_word(data, a))
                if good:
                    ints[columns[f, 3], i] = np.int64(eight)
                    continue
            b = min(b, ends[i])
            while a < b and _byte(data, a) == _BLANK:
                a += 1
            while a < b and _byte(data, b - 1) == _BLANK:
                b -= 1
            slot = columns[f, 3]
            if a >= b:
                if columns[f, 2] < 0:
                    ints[slot, i] = 0
                else:
                    reals[slot, i] = 0.0
            elif columns[f, 2] < 0:
                value, good = _integer(data, a, b)
                ints[slot, i] = value
                if not good:
                    care[f, i] = True
                    cared += 1
            elif not _real(data, a, b, columns[f, 2], reals[slot], bits[slot], i):
                reals[slot, i] = 0.0
                care[f, i] = True
                cared += 1
    return cared


@exact_kernel
def _free(data, starts, ends, only_commas, values, bits, counts, care):
    cared, limit = 0, values.shape[1]
    for i in range(len(starts)):
        a, end, count = starts[i], ends[i], 0
        while True:
            while a < end and (_byte(data, a) == _BLANK or _byte(data, a) == _TAB):
                a += 1
            if a >= end:
                break
            b = a
            while (
                b < end
                and _byte(data, b) != _COMMA
                and (only_commas or (_byte(data, b) != _BLANK and _byte(data, b) != _TAB))
            ):
                b += 1
            last = b
            while last > a and (_byte(data, last - 1) == _BLANK or _byte(data, last - 1) == _TAB):
                last -= 1
            if count < limit:
                k, whole = a, 0  # most fields are short whole numbers
                while k < last <= a + _SHORT:
                    d = np.uint8(data[k] - _ZERO)
                    if d > 9:
                        break
                    whole = whole * 10 + np.int64(d)
                    k += 1
                if k == last:
                    values[i, count] = whole
                elif not _real(data, a, last, 0, values[i], bits[i], count):
                    values[i, count] = np.nan
                    care[i] = True
                    cared += 1
            count += 1
            a = b
            while a < end and (_byte(data, a) == _BLANK or _byte(data, a) == _TAB):
                a += 1
            if a < end and _byte(data, a) == _COMMA:
                a += 1
        counts[i] = count
        for k in range(count, limit):
            values[i, k] = 0.0
    return cared


@exact_kernel
def _zeros(data, starts, ends, zero):
    for i in range(len(starts)):
        zero[i] = True
        for a in range(starts[i], ends[i]):
            if data[a] > _ZERO:  # the other digits, and all letters
                zero[i] = False
                break


def fixed(
    data: NDArray[np.uint8], starts: NDArray[np.int64], ends: NDArray[np.int64], fields: list[tuple[int, int, int]]
) -> tuple[list[NDArray[Any]], NDArray[np.bool_] | None]:
    """Fields of fixed columns of many lines.

    starts, ends: (n,) first byte of each line and the byte past its last; fields: first column (from 0), column past
    the last, and the decimals that the format implies, or -1 for an integer. A blank field is 0. Returns an array (n,)
    a field (int64 or float64), and the cells that take care: (fields, n), or None.
    """
    n = len(starts)
    slots = [0, 0]
    columns = np.empty((len(fields), 4), np.int64)
    for row, (first, last, implied) in zip(columns, fields, strict=True):
        row[:] = first, last, implied, slots[implied >= 0]
        slots[implied >= 0] += 1
    ints, reals = np.empty((slots[0], n), np.int64), np.empty((slots[1], n))
    care = np.zeros((len(fields), n), np.bool_)
    cared = _fixed(data, starts, ends, columns, ints, reals, reals.view(np.uint64), care)
    values = [(ints if row[2] < 0 else reals)[row[3]] for row in columns]
    return values, care if cared else None


def free(
    data: NDArray[np.uint8],
    starts: NDArray[np.int64],
    ends: NDArray[np.int64],
    width: int,
    *,
    only_commas: bool = False,
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.bool_] | None]:
    """Numbers of many lines, separated by commas, blanks or both.

    only_commas: blanks do not separate. An empty field is 0. Returns the first `width` numbers of each line,
    (n, width), filled with 0 where a line has fewer; how many fields each line has (n,) (a last comma ends the last
    field); and the lines with text that takes care, where the value is NaN: (n,), or None.
    """
    n = len(starts)
    values = np.empty((n, width))
    counts = np.empty(n, np.int64)
    care = np.zeros(n, np.bool_)
    cared = _free(data, starts, ends, only_commas, values, values.view(np.uint64), counts, care)
    return values, counts, care if cared else None


def zeros(data: NDArray[np.uint8], starts: NDArray[np.int64], ends: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Which of many lines hold no digit but 0, and no letter: (n,)."""
    zero = np.empty(len(starts), np.bool_)
    _zeros(data, starts, ends, zero)
    return zero
