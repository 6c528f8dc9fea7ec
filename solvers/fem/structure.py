"""The sparse matrix's structure, found once and filled at each iteration.

Rows and columns are the free degrees of freedom, numbered node by node. Of a symmetric matrix only the upper triangle
is kept, row by row (CSR), each row beginning with its diagonal. Everything is by nodes: a pair of an element's nodes
has one number, where the second node's columns begin in the first one's rows, from the first one's first equation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


def dot(a: Floats, b: Floats) -> float:
    """Without BLAS, whose second thread waits in a loop for 20 ms after each product, as long as a solution takes."""
    return float(np.einsum("i,i->", a, b))


@dataclass(slots=True)
class Structure:
    """equation: (n, 6) number of each degree of freedom, -1 where it is not free; first: (n,) of each node's;
    count: equations; starts: (count + 1,), columns: (nnz,) CSR; neighbours: the nodes of each node's columns,
    (starts, nodes, offset); symmetric: upper triangle only.
    """

    equation: NDArray[np.int32]
    first: NDArray[np.int32]
    count: int
    starts: NDArray[np.int32]
    columns: NDArray[np.int32]
    neighbours: tuple[Ints, NDArray[np.int32], NDArray[np.int32]]
    symmetric: bool

    def offsets(self, nodes: Ints) -> NDArray[np.int32]:
        """(e, k, k): where the columns of an element's second node begin in the rows of its first; -1: not kept."""
        offsets = np.empty((*nodes.shape, nodes.shape[1]), np.int32)
        _offsets(nodes, *self.neighbours, self.symmetric, offsets)
        return offsets


def equations(free: NDArray[np.bool_]) -> tuple[NDArray[np.int32], NDArray[np.int32], int]:
    """Numbers of the free degrees of freedom (n, 6), the first of each node (n,), and how many there are."""
    number = np.cumsum(free.ravel()) - 1
    equation = np.where(free.ravel(), number, -1).reshape(free.shape).astype(np.int32)
    per_node = free.sum(axis=1)
    first = (np.cumsum(per_node) - per_node).astype(np.int32)
    return equation, first, int(per_node.sum())


def build(free: NDArray[np.bool_], elements: list[Ints], *, symmetric: bool = True) -> Structure:
    """The structure of a mesh. free: (n, 6); elements: nodes (e, k) of each group.

    Raises ValueError where a 32-bit number does not suffice.
    """
    equation, first, count = equations(free)
    n = len(free)
    degree = np.zeros(n + 1, np.int64)
    for nodes in elements:
        degree[1:] += np.bincount(nodes.ravel(), minlength=n)
    begin = np.cumsum(degree)
    members = np.empty((int(begin[-1]), 2), np.int32)
    place = begin[:-1].copy()
    for group, nodes in enumerate(elements):
        _attach(nodes, group, place, members)
    widest = max([nodes.shape[1] for nodes in elements], default=1)
    table = np.full((sum(len(nodes) for nodes in elements), widest), -1, np.int32)
    rows = np.cumsum([0, *(len(nodes) for nodes in elements)])
    for group, nodes in enumerate(elements):
        table[rows[group] : rows[group + 1], : nodes.shape[1]] = nodes
    members[:, 1] += rows[members[:, 0]].astype(np.int32)
    per_node = free.sum(axis=1).astype(np.int32)
    found = np.empty(n + 1, np.int64)
    _count_neighbours(begin, members, table, symmetric, found)
    near_starts = np.cumsum(found)
    near = np.empty(int(near_starts[-1]), np.int32)
    _list_neighbours(begin, members, table, symmetric, near_starts, near)
    offset = np.empty(len(near), np.int32)
    sizes = np.empty(count + 1, np.int64)
    _sizes(near_starts, near, per_node, first, symmetric, offset, sizes)
    starts = np.cumsum(sizes)
    if starts[-1] >= 2**31:
        raise ValueError(f"the stiffness matrix has {starts[-1]} entries, more than 32-bit numbers count")
    columns = np.empty(int(starts[-1]), np.int32)
    _columns(near_starts, near, per_node, first, symmetric, starts, columns)
    return Structure(equation, first, count, starts.astype(np.int32), columns, (near_starts, near, offset), symmetric)


@kernel
def _attach(nodes, group, place, members):
    for e in range(nodes.shape[0]):
        for k in range(nodes.shape[1]):
            at = place[nodes[e, k]]
            members[at, 0] = group
            members[at, 1] = e
            place[nodes[e, k]] = at + 1


@kernel
def _count_neighbours(begin, members, table, symmetric, found):
    n = len(begin) - 1
    seen = np.full(n, -1, np.int32)
    found[0] = 0
    for a in range(n):
        number = 0
        for m in range(begin[a], begin[a + 1]):
            e = members[m, 1]
            for k in range(table.shape[1]):
                b = table[e, k]
                if b >= 0 and seen[b] != a and (b >= a or not symmetric):
                    seen[b] = a
                    number += 1
        found[a + 1] = number


@kernel
def _sort(numbers, begin, end):
    """numbers[begin:end] in place, by Shell's sort (1959): numpy's would take two seconds to compile.

    Mostly a few; at a hub, where thousands of elements meet, insertion alone would be quadratic.
    """
    gap = 1
    while gap < (end - begin) // 3:
        gap = 3 * gap + 1
    while gap > 0:
        for k in range(begin + gap, end):
            number = numbers[k]
            at = k
            while at >= begin + gap and numbers[at - gap] > number:
                numbers[at] = numbers[at - gap]
                at -= gap
            numbers[at] = number
        gap //= 3


@kernel
def _list_neighbours(begin, members, table, symmetric, starts, near):
    n = len(begin) - 1
    seen = np.full(n, -1, np.int32)
    for a in range(n):
        at = starts[a]
        for m in range(begin[a], begin[a + 1]):
            e = members[m, 1]
            for k in range(table.shape[1]):
                b = table[e, k]
                if b >= 0 and seen[b] != a and (b >= a or not symmetric):
                    seen[b] = a
                    near[at] = b
                    at += 1
        _sort(near, starts[a], at)


@kernel
def _sizes(starts, near, per_node, first, symmetric, offset, sizes):
    sizes[0] = 0
    for a in range(len(per_node)):
        width = 0
        for m in range(starts[a], starts[a + 1]):
            offset[m] = width
            width += per_node[near[m]]
        for i in range(per_node[a]):
            sizes[first[a] + i + 1] = width - i if symmetric else width


@kernel
def _columns(near_starts, near, per_node, first, symmetric, starts, columns):
    for a in range(len(per_node)):
        for i in range(per_node[a]):
            row = first[a] + i
            at = starts[row]
            for m in range(near_starts[a], near_starts[a + 1]):
                b = near[m]
                for j in range(per_node[b]):
                    if symmetric and first[b] + j < row:
                        continue
                    columns[at] = first[b] + j
                    at += 1


@kernel
def _offsets(nodes, starts, near, offset, symmetric, offsets):
    for e in range(nodes.shape[0]):
        for k in range(nodes.shape[1]):
            a = nodes[e, k]
            for l in range(nodes.shape[1]):
                b = nodes[e, l]
                if symmetric and b < a:
                    offsets[e, k, l] = -1
                    continue
                low, high = starts[a], starts[a + 1] - 1
                while low < high:
                    middle = (low + high) // 2
                    if near[middle] < b:
                        low = middle + 1
                    else:
                        high = middle
                offsets[e, k, l] = offset[low]


@kernel
def scatter(matrix, nodes, offsets, dofs, equation, first, starts, symmetric, values):
    """Add element matrices (e, c, c, k, k) to the values (nnz,). dofs: (c,) what the components are of 0..5."""
    parts = len(dofs)
    corners = nodes.shape[1]
    for e in range(nodes.shape[0]):
        for k in range(corners):
            a = nodes[e, k]
            for i in range(parts):
                row = equation[a, dofs[i]]
                if row < 0:
                    continue
                base = starts[row] - ((row - first[a]) if symmetric else 0)
                for l in range(corners):
                    offset = offsets[e, k, l]
                    if offset < 0:
                        continue
                    b = nodes[e, l]
                    at = base + offset - first[b]
                    for j in range(parts):
                        column = equation[b, dofs[j]]
                        if column >= 0 and (column >= row or not symmetric):
                            values[at + column] += matrix[e, i, j, k, l]


@kernel
def scatter_forces(forces, nodes, dofs, total):
    """Add element forces (e, c, k) to the nodes' (n, 6)."""
    for e in range(nodes.shape[0]):
        for i in range(len(dofs)):
            for k in range(nodes.shape[1]):
                total[nodes[e, k], dofs[i]] += forces[e, i, k]


@kernel
def product_of_elements(matrix, nodes, dofs, u, total):
    """Add element matrices times a displacement (n, 6) to forces (n, 6); elements where it is zero are passed over."""
    parts, corners = len(dofs), nodes.shape[1]
    for e in range(nodes.shape[0]):
        moved = False
        for k in range(corners):
            for i in range(parts):
                if u[nodes[e, k], dofs[i]] != 0.0:
                    moved = True
        if not moved:
            continue
        for i in range(parts):
            for j in range(parts):
                for k in range(corners):
                    part = 0.0
                    for l in range(corners):
                        part += matrix[e, i, j, k, l] * u[nodes[e, l], dofs[j]]
                    total[nodes[e, k], dofs[i]] += part


@kernel
def product_of_triangle(starts, columns, values, x, out):
    """A symmetric matrix, of which the upper triangle is stored, times a vector (n,)."""
    out[:] = 0.0
    for i in range(len(x)):
        own, total = x[i], 0.0
        for m in range(starts[i], starts[i + 1]):
            j = columns[m]
            total += values[m] * x[j]
            if j != i:
                out[j] += values[m] * own
        out[i] += total
