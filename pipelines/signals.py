"""Numbers taken from a curve in time: its end, its peaks, how long a pulse lasts, when a front comes, how it swings."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Unmeasured(ValueError):
    """A run does not show what is asked of it: a pulse that never comes, an oscillation of less than a cycle."""


def last(time: Floats, value: Floats) -> float:
    """The value at the end."""
    return float(value[-1])


def highest(time: Floats, value: Floats) -> float:
    """The largest value."""
    return float(value.max())


def lowest(time: Floats, value: Floats) -> float:
    """The smallest value."""
    return float(value.min())


def mean(time: Floats, value: Floats) -> float:
    """The mean over time (trapezoids)."""
    if len(time) < 2:
        return float(value[0])
    return float(np.trapezoid(value, time) / (time[-1] - time[0]))


def arrival(time: Floats, value: Floats) -> float:
    """When the amount first passes half of its maximum, between samples by a straight line."""
    size, half = _halves(value)
    i = int(np.argmax(size > half))
    return _crossing(time, size - half, i - 1) if i else float(time[0])


def duration(time: Floats, value: Floats) -> float:
    """How long the amount is above half of its maximum: from the first passage up to the last one down."""
    size, half = _halves(value)
    i = len(size) - 1 - int(np.argmax(size[::-1] > half))
    if i == len(size) - 1:
        raise Unmeasured("the pulse is not over when the run ends")
    return _crossing(time, size - half, i) - arrival(time, value)


def plateau(time: Floats, value: Floats) -> float:
    """The median of the values whose amount is above half of the maximum: what a pulse levels at, without overshoot."""
    size, half = _halves(value)
    return float(np.median(value[size > half]))


def period(time: Floats, value: Floats) -> float:
    """Of an oscillation about its mean: the mean distance of its upward zero crossings, at least two."""
    swing = value - mean(time, value)
    up = np.flatnonzero((swing[:-1] < 0) & (swing[1:] >= 0))
    if len(up) < 2:
        raise Unmeasured("no whole cycle of an oscillation")
    return (_crossing(time, swing, int(up[-1])) - _crossing(time, swing, int(up[0]))) / (len(up) - 1)


def loss(time: Floats, value: Floats) -> float:
    """Of an oscillation about its mean: the share of the amplitude that is lost in a cycle, at least two peaks."""
    swing = value - mean(time, value)
    up = np.flatnonzero((swing[:-1] < 0) & (swing[1:] >= 0)) + 1
    if len(up) < 2:
        raise Unmeasured("no whole cycle of an oscillation")
    # from each crossing to the next: the last half cycle may be cut off, and then is no peak
    peaks = np.array([swing[a:b].max() for a, b in pairwise(up)])
    if len(peaks) < 2:
        raise Unmeasured("fewer than two peaks of an oscillation")
    slope = np.polyfit(np.arange(len(peaks)), np.log(np.maximum(peaks, 1e-300)), 1)[0]
    return float(1.0 - np.exp(slope))


def _halves(value: Floats) -> tuple[Floats, float]:
    """Amounts, and half of the largest."""
    size = np.abs(value)
    if not size.max() > 0.0:
        raise Unmeasured("nothing but zeros")
    return size, 0.5 * float(size.max())


def _crossing(time: Floats, value: Floats, i: int) -> float:
    """When the value passes zero between sample i and the next."""
    a, b = value[i], value[i + 1]
    return float(time[i] + (time[i + 1] - time[i]) * a / (a - b))


TAKES: dict[str, Callable[[Floats, Floats], float]] = {
    "last": last,
    "max": highest,
    "min": lowest,
    "mean": mean,
    "arrival": arrival,
    "duration": duration,
    "plateau": plateau,
    "period": period,
    "loss": loss,
}
