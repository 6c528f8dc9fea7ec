"""What a study measures against, and the error: relative, of numbers and of curves."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.load import Result
from zrno.pipelines.measures import Cloud, evaluate
from zrno.pipelines.quantities import unknown
from zrno.pipelines.signals import TAKES, Unmeasured
from zrno.pipelines.study_scene import Quantity, Study
from zrno.translators.text import Fault, InputError, read_bytes
from zrno.translators.yaml_marks import did_you_mean

Floats = NDArray[np.float64]
Curve = tuple[Floats, Floats]
_SLACK = 1e-6  # of the reference's range: a run that ends that much before it still has all of it


@dataclass(frozen=True, slots=True)
class Reference:
    """A number, or a curve: by its points (abscissae, values), or as a function of the run's own abscissae."""

    number: float | None = None
    points: Curve | None = None
    function: Callable[[Floats], Floats] | None = None


def reference(study: Study, folder: Path) -> Reference:
    """The reference of a study. folder: of the scene. Raises InputError for its file, ValueError for its solution.

    A file has names of columns in its first row, units in a second one that is no numbers, if it likes, and `#` before
    comments. A curve needs the columns `time` (of a profile: its axis) and the quantity's name; a number that name
    alone, and one row.
    """
    if study.analytic is not None:
        asked = getattr(study.analytic.solution(), study.analytic.result)
        return Reference(function=asked) if study.quantity.abscissa else Reference(number=_finite(asked))
    if isinstance(study.reference, float):
        return Reference(number=study.reference)
    assert study.reference is not None
    path, abscissa = folder / study.reference, study.quantity.abscissa
    wanted = [*([abscissa] if abscissa else []), study.quantity.name]
    columns = [np.array(values) for values in read_columns(path, wanted)]
    if abscissa is None:
        if len(columns[0]) != 1:
            fault = Fault(str(path), 1, 1, f"{len(columns[0])} values of a number", study.quantity.name, "one row")
            raise InputError([fault])
        return Reference(number=float(columns[0][0]))
    order = np.argsort(columns[0], kind="stable")
    return Reference(points=(columns[0][order], columns[1][order]))


def read_columns(path: Path, wanted: list[str]) -> list[list[float]]:
    """Columns of a file of comma separated values, by name. Raises InputError."""
    try:
        lines = read_bytes(path).decode().splitlines()
    except UnicodeDecodeError as error:
        raise InputError([Fault(str(path), 1, 1, "not a table", expected="a text file in UTF-8")]) from error
    numbered = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    try:
        table = list(csv.reader((line for _, line in numbered), skipinitialspace=True))
    except csv.Error as error:
        raise InputError(
            [Fault(str(path), 1, 1, f"not a table: {error}", expected="comma separated values")]
        ) from error
    names = [name.strip() for name in table[0]] if table else []
    faults = [
        Fault(str(path), numbered[0][0] if numbered else 1, 1, f"no column {name}", ",".join(names)[:60],
              did_you_mean(name, names) if names else "a row of names, then rows of numbers")
        for name in wanted if name not in names
    ]  # fmt: skip
    if faults:
        raise InputError(faults)
    at = [names.index(name) for name in wanted]
    found: list[list[float]] = [[] for _ in wanted]
    for k, (row, (line, _)) in enumerate(zip(table[1:], numbered[1:], strict=False)):
        values = [_number(row[i]) if i < len(row) else math.nan for i in at]
        if all(map(math.isfinite, values)):
            for column, value in zip(found, values, strict=True):
                column.append(value)
        elif k > 0:  # the first row may hold units
            faults.append(Fault(str(path), line, 1, "not a row of numbers", ",".join(row)[:60], ", ".join(wanted)))
    if not faults and not found[0]:
        faults.append(Fault(str(path), 1, 1, "no rows", expected="a row of names, then rows of numbers"))
    if faults:
        raise InputError(faults[:20])
    return found


def _finite(asked: Callable[[], float]) -> float:
    """A result of a closed-form solution. Raises ValueError where floating point cannot hold it."""
    try:
        number = asked()
    except ArithmeticError as error:
        raise ValueError(f"the solution is no finite number: {error}") from error
    if not math.isfinite(number):
        raise ValueError("the solution is no finite number")
    return number


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def measure(result: Result, quantity: Quantity) -> float | Curve:
    """The quantity of a run that is done.

    Raises ValueError for a column, field or material that is not there, Unmeasured for what this run does not show.
    """
    if quantity.measure is not None and quantity.when != "all":
        found: float | Curve = _of_frame(result, quantity, _frame_at(result, quantity.when))
        return found
    if quantity.measure is not None:
        count = len(result.times)
        curve = result.times, np.array([_of_frame(result, quantity, i) for i in range(count)], float)
    else:
        history = result.history
        if quantity.column not in history:
            raise ValueError(unknown("column", str(quantity.column), history))
        curve = history["time"], history[quantity.column]
    if not len(curve[0]):
        raise Unmeasured("the run wrote nothing to measure")
    if quantity.take is not None:
        return TAKES[quantity.take](*curve)
    if quantity.when == "all":
        return curve
    return float(curve[1][-1]) if quantity.when == "last" else float(_at(np.array([quantity.when]), curve)[0])


def _frame_at(result: Result, when: float | str) -> int:
    """The frame of a time: the nearest, which may not be farther off than half of the frames' distance."""
    times = result.times
    if when == "last":
        return -1
    nearest = int(np.argmin(np.abs(times - float(when))))
    if abs(times[nearest] - float(when)) > 0.51 * float(np.max(np.diff(times), initial=0.0)):
        raise Unmeasured(f"no frame near t = {float(when):g}")
    return nearest


def _of_frame(result: Result, quantity: Quantity, index: int) -> Any:
    assert quantity.measure is not None
    start = 0 if quantity.measure == "restitution" else index
    clouds = [
        Cloud(result.arrays(index=i), result.dimension, result.axisymmetric) for i in dict.fromkeys((index, start))
    ]
    return evaluate(quantity.measure, clouds[0], clouds[-1], quantity.given)


def error(measured: float | Curve, against: Reference, norm: str = "l2") -> float:
    """Relative error: of numbers |m - r| / |r|; of curves the norm of m - r over that of r.

    Curves are compared at the reference's points, a function's at the run's own. l2: the root of the integral of
    squares (trapezoids); max: the largest amount. Against a reference of zeros the error is absolute. Raises Unmeasured
    where the run does not reach all of the reference's points.
    """
    if not isinstance(measured, tuple):
        assert against.number is not None
        return abs(measured - against.number) / (abs(against.number) or 1.0)
    if against.function is not None:
        x, m = measured
        r = against.function(x)
    else:
        assert against.points is not None
        x, r = against.points
        m = _at(x, measured)

    def size(values: Floats) -> float:
        if norm == "max":
            return float(np.abs(values).max())
        return math.sqrt(float(np.trapezoid(values**2, x))) if len(x) > 1 else abs(float(values[0]))

    return size(m - r) / (size(r) or 1.0)


def _at(x: Floats, curve: Curve) -> Floats:
    """A curve at abscissae, by straight lines between its points, which do not go on beyond its ends."""
    own, values = curve
    slack = _SLACK * max(float(np.ptp(x)), float(np.ptp(own)), abs(float(own[-1])))
    if x.min() < own.min() - slack or x.max() > own.max() + slack:
        raise Unmeasured(f"the run covers {own.min():g} to {own.max():g}, the reference {x.min():g} to {x.max():g}")
    order = np.argsort(own, kind="stable")
    return np.asarray(np.interp(x, own[order], values[order]), float)
