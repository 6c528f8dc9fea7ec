"""The structure of the matrix: columns of each row in order, also at a hub."""

from __future__ import annotations

import numpy as np

from zrno.solvers.fem.structure import _sort


def test_numbers_are_sorted_within_their_range_alone() -> None:
    rng = np.random.default_rng(3)
    for count in (0, 1, 2, 3, 5, 14, 40, 41, 1000, 20_000):
        numbers = rng.permutation(count + 10).astype(np.int32)
        expected = numbers.copy()
        expected[4 : 4 + count].sort()
        _sort(numbers, 4, 4 + count)
        assert np.array_equal(numbers, expected)
