"""Rows of a table brought together, eight at a time: what a pair loop reads of its neighbours.

A neighbour's numbers stand in one or two cache lines (a row of a table), not in as many arrays as there are numbers:
eight rows are loaded whole and transposed in registers. Picking single numbers out of arrays took twice as long, on
AMD's Zen, where gathers are microcoded, and where the arrays do not fit into the caches.
"""

from __future__ import annotations

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.errors import RequireLiteralValue
from numba.extending import intrinsic
from numpy.typing import NDArray

LANES = 8  # rows brought at once, and columns of a cache line
ROOM = 128  # entries of a buffer's columns: most particles have fewer neighbours

# transposing: blocks of four lanes, of two, single ones
_SWAPS = (
    (4, (0, 1, 2, 3, 8, 9, 10, 11), (4, 5, 6, 7, 12, 13, 14, 15)),
    (2, (0, 1, 8, 9, 4, 5, 12, 13), (2, 3, 10, 11, 6, 7, 14, 15)),
    (1, (0, 8, 2, 10, 4, 12, 6, 14), (1, 9, 3, 11, 5, 13, 7, 15)),
)


def table(rows: int) -> NDArray[np.float64]:
    """(rows, LANES) zeros, each row a cache line."""
    raw = np.zeros((rows + 1) * LANES)
    at = -raw.ctypes.data // 8 % LANES
    return raw[at : at + rows * LANES].reshape(rows, LANES)


def buffers(threads: int) -> NDArray[np.float64]:
    """(threads, 2, LANES, ROOM): two buffers for each thread, in whole cache lines.

    Where vectors lay across two lines, loops took 10 to 15 % longer.
    """
    return table(threads * 2 * ROOM).reshape(threads, 2, LANES, ROOM)


@intrinsic(prefer_literal=True)
def gather(typing_context, table, numbers, begin, buffer, at, columns):
    """buffer[c, at + lane] = table[numbers[begin + lane], c], for the lanes and for c < columns, a literal.

    table: (m, 8), buffer: (8, ROOM), C-contiguous float64; numbers: uint32.
    """
    if not isinstance(columns, types.IntegerLiteral):
        raise RequireLiteralValue("the number of columns must be a literal")
    wanted = columns.literal_value

    def generate(context, builder, signature, arguments):
        word, index = ir.IntType(64), ir.IntType(32)
        vector = ir.VectorType(ir.DoubleType(), LANES)
        parts = [context.make_array(signature.args[k])(context, builder, arguments[k]) for k in (0, 1, 3)]
        lanes = []
        for lane in range(LANES):
            number = builder.load(builder.gep(parts[1].data, [builder.add(arguments[2], ir.Constant(word, lane))]))
            pointer = builder.gep(parts[0].data, [builder.mul(builder.zext(number, word), ir.Constant(word, LANES))])
            lanes.append(builder.load(builder.bitcast(pointer, vector.as_pointer()), align=8))
        for far, low, high in _SWAPS:
            masks = [ir.Constant(ir.VectorType(index, LANES), mask) for mask in (low, high)]
            swapped = list(lanes)
            for k in range(LANES):
                if not k & far:
                    for other, mask in zip((k, k + far), masks, strict=True):
                        swapped[other] = builder.shuffle_vector(lanes[k], lanes[k + far], mask)
            lanes = swapped
        for c in range(wanted):
            place = builder.add(arguments[4], ir.Constant(word, c * ROOM))
            pointer = builder.gep(parts[2].data, [place])
            builder.store(lanes[c], builder.bitcast(pointer, vector.as_pointer()), align=8)
        return context.get_dummy_value()

    word = types.int64
    return types.void(table, numbers, word, buffer, word, columns), generate
