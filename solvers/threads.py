"""Threads: one compiled function runs on all of them at once, and they meet at barriers.

A parallel region of numba costs seconds to compile for loops with many arrays, and each phase of a step would need one.
Here each thread runs the whole loop over its own range of particles without the interpreter's lock; between the phases
of a step they wait for each other at a barrier of two atomic numbers, which costs about a microsecond. One writer an
item and no sums across threads: results do not depend on their number. numba's own thread pool (and its OpenMP) is
never started.

What a thread has written is in its own processor's cache: to read what another wrote costs ten times as much. So each
thread begins with the pieces of its own range, the same in all phases, and takes those of others only to help them out.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

from .jit import kernel

_SPINS = 4000  # looks at the barrier before the processor is offered to others
_LINE = 8  # numbers of a cache line: what different threads write must not share one
_ARRIVALS, _GENERATION, _TICKETS = 0, _LINE, 2 * _LINE  # places in `sync`; tickets: a line for each thread

_pool: ThreadPoolExecutor | None = None
_pool_size = 0


@intrinsic
def _fetch_add(typing_context, array, index, value):
    """array[index] += value as one indivisible operation; returns the old value. array: int64."""

    def generate(context, builder, signature, arguments):
        array_type = signature.args[0]
        data = context.make_array(array_type)(context, builder, arguments[0])
        pointer = cgutils.get_item_pointer(context, builder, array_type, data, [arguments[1]])
        return builder.atomic_rmw("add", pointer, arguments[2], "seq_cst")

    return types.int64(array, types.intp, types.int64), generate


@intrinsic
def _look(typing_context, array, index):
    """array[index] now, whoever wrote it. array: int64. Unlike an addition of 0 it leaves the line with its writer."""

    def generate(context, builder, signature, arguments):
        array_type = signature.args[0]
        data = context.make_array(array_type)(context, builder, arguments[0])
        pointer = cgutils.get_item_pointer(context, builder, array_type, data, [arguments[1]])
        return builder.load_atomic(pointer, "seq_cst", 8)

    return types.int64(array, types.intp), generate


@intrinsic
def _offer_processor(typing_context):
    """sched_yield of the C library."""

    def generate(context, builder, signature, arguments):
        yield_type = ir.FunctionType(ir.IntType(32), [])
        function = cgutils.get_or_insert_function(builder.module, yield_type, "sched_yield")
        builder.call(function, [])
        return context.get_dummy_value()

    return types.void(), generate


@kernel
def barrier(sync, threads):
    """Wait until all threads are here. sync: see `meeting`. All pieces of work may be claimed anew after it."""
    generation = _look(sync, _GENERATION)
    if _fetch_add(sync, _ARRIVALS, 1) == threads - 1:
        sync[_ARRIVALS] = 0
        for thread in range(threads):
            sync[_TICKETS + thread * _LINE] = 0
        _fetch_add(sync, _GENERATION, 1)
        return
    spins = 0
    while _look(sync, _GENERATION) == generation:
        spins += 1
        if spins > _SPINS:
            _offer_processor()


@kernel
def share(n, thread, threads):
    """The contiguous range of n items that belongs to a thread."""
    return n * thread // threads, n * (thread + 1) // threads


@kernel
def claim(sync, thread, threads, pieces):
    """The next piece of work that no thread has begun, of its own share first; `pieces` when there is none left.

    Pieces are handed out as they are asked for, so that a thread that is held up does not hold up the others. Between
    two loops over pieces there is to be a barrier.
    """
    for k in range(threads):
        owner = (thread + k) % threads
        begin, end = share(pieces, owner, threads)
        piece = begin + _fetch_add(sync, _TICKETS + owner * _LINE, 1)
        if piece < end:
            return piece
    return pieces


def meeting(threads: int) -> NDArray[np.int64]:
    """What the threads of one call share: arrivals at the barrier, its generation, the pieces claimed of each share."""
    return np.zeros(_TICKETS + threads * _LINE, np.int64)


def available() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def run(function: Callable[..., Any], threads: int, *arguments: Any) -> list[Any]:
    """Call function(thread, threads, sync, *arguments) on all threads at once; the results in the order of the threads.

    function: a compiled kernel that releases the interpreter's lock and raises nothing.
    """
    global _pool, _pool_size
    sync = meeting(threads)
    if threads == 1:
        return [function(0, 1, sync, *arguments)]
    if _pool is None or _pool_size < threads - 1:
        _pool, _pool_size = ThreadPoolExecutor(threads - 1, thread_name_prefix="zrno"), threads - 1
    others = [_pool.submit(function, thread, threads, sync, *arguments) for thread in range(1, threads)]
    first = function(0, threads, sync, *arguments)
    return [first, *(other.result() for other in others)]
