"""Bundles: a kernel sees the fields of a named tuple of arrays that it is given by its address."""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from zrno.solvers.bundle import bundle
from zrno.solvers.jit import kernel


@bundle
class Fields(NamedTuple):
    """Of every kind."""

    row: Any
    absent: Any
    count: int
    numbers: Any
    factor: float
    single: Any
    yes: bool
    no: bool
    last: Any


@kernel
def weigh(row, fields):
    total = 0.0
    for i in range(fields.numbers.shape[0]):
        total += row[fields.numbers[i]] * fields.factor
    return total


@kernel
def all_of(absent, fields):
    """A sum of all, and a change of an array."""
    total = weigh(fields.row, fields) + fields.count
    for i in range(fields.single.shape[0]):
        for j in range(fields.single.shape[1]):
            total += fields.single[i, j]
    if absent is not None:
        total += fields.absent[0]
    if fields.yes:
        total += 1000.0
    if fields.no:
        total += 1e6
    fields.last[1, 2] = total
    return total


def fields(absent: Any = None) -> Fields:
    return Fields(
        row=np.arange(10.0)[::2], absent=absent, count=100, numbers=np.array([1, 4], np.uint32), factor=0.5,
        single=np.full((2, 3), 0.25, np.float32), yes=True, no=False, last=np.zeros((4, 5))[1:, 1:],
    )  # fmt: skip


@pytest.mark.parametrize("absent", [None, np.array([7.0])])
def test_a_kernel_sees_every_kind_of_field(absent: Any) -> None:
    given = fields(absent)
    expected = (2.0 + 8.0) * 0.5 + 100 + 1.5 + 1000.0 + (0.0 if absent is None else 7.0)
    assert all_of(given.absent, given) == expected
    assert given.last[1, 2] == expected
    given.row[1] = 20.0  # the arrays are the caller's own
    assert all_of(given.absent, given) == expected + 9.0


def test_another_instance_has_its_own_arrays() -> None:
    """Also where the first one has gone and its memory is used again."""
    found = []
    for count in range(50):
        given = fields()._replace(count=count, row=np.full(5, float(count)))
        found.append(all_of(None, given) - 1001.5)
        del given
    assert found == [2.0 * count for count in range(50)]


def test_what_a_bundle_cannot_hold_is_named() -> None:
    with pytest.raises(TypeError, match=r"Fields\.factor is complex128: a bundle does not hold that"):
        all_of(None, fields()._replace(factor=1j))


def test_the_same_fields_in_another_order_are_another_type() -> None:
    """The type is what its name says: field types alone would find the wrong places."""

    class Turned(NamedTuple):
        low: float
        high: float

    class Straight(NamedTuple):
        high: float
        low: float

    Straight.__name__, Straight.__qualname__ = Turned.__name__, Turned.__qualname__
    high = numba.njit(lambda given: given.high)
    assert high(bundle(Turned)(1.0, 2.0)) == 2.0
    assert high(bundle(Straight)(2.0, 1.0)) == 2.0
