"""Threads: one compiled function runs on all of them at once, and they meet at barriers.

A parallel region of numba costs seconds to compile for loops with many arrays, and each phase of a step would need one.
Here each thread runs the whole loop over its own range of particles without the interpreter's lock; between the phases
of a step they wait for each other at a barrier of two atomic numbers, which costs about a microsecond. One writer an
item and no sums across threads: results do not depend on their number. numba's own thread pool (and its OpenMP) is
never started.
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

from .jit import kernel

_SPINS = 4000  # looks at the barrier before the processor is offered to others

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
    """Wait until all threads are here. sync: (3,) int64, zero before the first use: arrivals, generation, tickets."""
    if threads == 1:
        return
    generation = _fetch_add(sync, 1, 0)
    if _fetch_add(sync, 0, 1) == threads - 1:
        _fetch_add(sync, 0, -threads)
        _fetch_add(sync, 1, 1)
        return
    spins = 0
    while _fetch_add(sync, 1, 0) == generation:
        spins += 1
        if spins > _SPINS:
            _offer_processor()


@kernel
def claim(sync, taken):
    """The next piece of work that no thread has begun, or a number beyond the last when there is none left.

    Pieces are handed out as they are asked for, so that a thread that is held up does not hold up the others. taken:
    tickets of the phases before, their pieces and one more for each thread: every thread asks once in vain.
    """
    return _fetch_add(sync, 2, 1) - taken


def available() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def run(function: Callable[..., Any], threads: int, *arguments: Any) -> list[Any]:
    """Call function(thread, threads, sync, *arguments) on all threads at once; the results in the order of the threads.

    function: a compiled kernel that releases the interpreter's lock and raises nothing.
    """
    global _pool, _pool_size
    sync = np.zeros(3, np.int64)
    if threads == 1:
        return [function(0, 1, sync, *arguments)]
    if _pool is None or _pool_size < threads - 1:
        _pool, _pool_size = ThreadPoolExecutor(threads - 1, thread_name_prefix="zrno"), threads - 1
    others = [_pool.submit(function, thread, threads, sync, *arguments) for thread in range(1, threads)]
    first = function(0, threads, sync, *arguments)
    return [first, *(other.result() for other in others)]


@kernel
def share(n, thread, threads):
    """The contiguous range of n items that belongs to a thread."""
    return n * thread // threads, n * (thread + 1) // threads
