"""Jitted loops over large meshes: solids that repeat a node, and node numbers to places."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zrno.solvers.jit import exact_kernel
from zrno.translators.lsdyna.bulk import in_threads
from zrno.translators.text import Ints

_ROWS_AT_A_TIME = 100_000


@exact_kernel
def _repeated(nodes, edges, odd):
    for i in range(len(nodes)):
        found = False
        for k in range(len(edges)):
            found |= nodes[i, edges[k, 0]] == nodes[i, edges[k, 1]]
        odd[i] = found


@exact_kernel
def _to_places(nodes, table):
    missing = 0
    last = len(table) - 1
    for i in range(nodes.shape[0]):
        lacks = False
        for k in range(nodes.shape[1]):
            number = nodes[i, k]
            place = table[number] if 0 <= number < last else -1
            nodes[i, k] = place if place >= 0 else -1 - max(number, 0)
            lacks |= place < 0
        missing += lacks
    return missing


def repeated(nodes: Ints, edges: Ints) -> NDArray[np.bool_]:
    """Which rows of nodes, (n, k), have the same number at both ends of one of the edges, (m, 2)."""
    odd = np.empty(len(nodes), np.bool_)

    def some(start: int) -> None:
        part = slice(start, start + _ROWS_AT_A_TIME)
        _repeated(nodes[part], edges, odd[part])

    in_threads(some, range(0, len(nodes), _ROWS_AT_A_TIME))
    return odd


def to_places(nodes: Ints, table: NDArray[np.int32]) -> int:
    """Replace numbers by `table[number]`, in the array itself; where that is -1 or past the table (whose last entry is
    none), by -1 minus the number. Returns how many rows have such."""

    def some(start: int) -> int:
        return int(_to_places(nodes[start : start + _ROWS_AT_A_TIME], table))

    return sum(in_threads(some, range(0, len(nodes), _ROWS_AT_A_TIME)))
