"""The project's jit decorator: one place owns numba's options, its cache and the processor features.

Import numba's names from here, so that the settings below are in force before the first compilation.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numba
from numba.core import event

# A NaN must stay a NaN, so that the step that made it can be named: no nnan, no ninf.
FASTMATH = {"reassoc", "contract", "nsz"}


def _processor_features() -> str | None:
    """Features for pair loops, where LLVM's own choice of them is slow; measured on block20k.

    Intel with AVX-512: without the preference for 256-bit vectors, 8-18 % faster. AMD Zen: gathers are microcoded, and
    loading lanes one by one is 25 % faster.
    """
    features = llvm.get_host_cpu_features()
    if llvm.get_host_cpu_name().startswith("znver"):
        return str(features.flatten()) + ",+prefer-no-gather"
    if features.get("avx512f", False):
        return str(features.flatten()) + ",-prefer-256-bit"
    return None


def _source_digest() -> str:
    """A hash over all solver sources: numba's cache does not notice when a function that it inlined has changed."""
    root = Path(__file__).parent
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(root.rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_directory() -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "zrno" / "kernels" / _source_digest()


def _forget_old_kernels(current: Path, days: float = 30.0) -> None:
    """Drop cache folders of other versions that nothing has used for a month."""
    limit = time.time() - days * 86400.0
    for other in current.parent.iterdir():
        if other != current and other.stat().st_mtime < limit:
            shutil.rmtree(other, ignore_errors=True)


def _configure() -> None:
    if "NUMBA_CPU_FEATURES" not in os.environ and (features := _processor_features()):
        numba.config.CPU_FEATURES = features
    if "NUMBA_CACHE_DIR" not in os.environ:
        try:
            directory = _cache_directory()
            directory.mkdir(parents=True, exist_ok=True)
            os.utime(directory)
            _forget_old_kernels(directory)
        except OSError:
            return  # a home that cannot be written: numba falls back to its own choice
        numba.config.CACHE_DIR = str(directory)


_configure()

Function = Callable[..., Any]


def kernel(function: Function) -> Any:
    """Compile a function of arrays and scalars, cached on disk; NaN is kept, division by zero gives inf."""
    return numba.njit(cache=True, fastmath=FASTMATH, error_model="numpy", nogil=True)(function)


def inlined_kernel(function: Function) -> Any:
    """As `kernel`, compiled into its callers: for loops over arrays that are called in few places.

    Around a call that stays one, numba counts references to all arrays that are used after it: 1.3 microseconds a call
    in a step of particles, with two atomic operations for each of 70 arrays.
    """
    return numba.njit(cache=True, fastmath=FASTMATH, error_model="numpy", nogil=True, forceinline=True)(function)


def exact_kernel(function: Function) -> Any:
    """As `kernel`, with every operation rounded as IEEE 754 says and none exchanged."""
    return numba.njit(cache=True, error_model="numpy", nogil=True)(function)


class _CompileClock(event.Listener):  # type: ignore[misc]  # numba is untyped here (pyproject.toml)
    """Adds up the seconds that the outermost compilations take."""

    def __init__(self) -> None:
        self.seconds = 0.0
        self._depth = 0
        self._since = 0.0

    def on_start(self, event: Any) -> None:
        if self._depth == 0:
            self._since = time.perf_counter()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        self._depth -= 1
        if self._depth == 0:
            self.seconds += time.perf_counter() - self._since


_clock = _CompileClock()
event.register("numba:compile", _clock)


def compile_seconds() -> float:
    """Seconds that this process has spent compiling kernels."""
    return _clock.seconds
