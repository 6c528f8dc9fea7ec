"""Which runs of a study are worth their time: the efficient front, the order of convergence, the cheapest good one."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from zrno.pipelines.balance import LIMIT

Row = dict[str, Any]


def rank(rows: Sequence[Row], tolerance: float) -> dict[str, Any]:
    """{rows, front, order_of_convergence, recommended}; every row learns whether it is on the front or recommended.

    front: names of the runs that no other beats in both time and error, cheapest first; recommended: the cheapest row
    within the tolerance, None where there is none. A run whose energy balance does not hold is neither.
    """
    measured = sorted((row for row in rows if _sound(row)), key=lambda row: (row["wall_seconds"], row["error"]))
    front: list[Row] = []
    for row in measured:
        if not front or row["error"] < front[-1]["error"]:
            front.append(row)
    best = next((row for row in front if row["error"] <= tolerance), None)
    for row in rows:
        row["front"] = any(row is other for other in front)
        row["recommended"] = row is best
    order = order_of_convergence(rows)
    return {
        "rows": list(rows),
        "front": [row["run"] for row in front],
        "order_of_convergence": order,
        "recommended": best,
    }


def resolution(rows: Sequence[Row]) -> str | None:
    """The option whose refinement is to lower the error: a spacing that varies, else a step; None where none does."""
    keys = rows[0]["options"] if rows else {}
    for words in (("spacing",), ("step_factor", "initial_step")):
        for key in keys:
            values = [row["options"][key] for row in rows]
            numbers = all(isinstance(v, (int, float)) and v > 0 for v in values)
            if key.rpartition(".")[2] in words and numbers and len(set(values)) > 1:
                return str(key)
    return None


def order_of_convergence(rows: Sequence[Row]) -> float | None:
    """Slope of log error over log `resolution` by least squares: one for all groups of rows that share all else.

    None where nothing is refined, or too few errors are there.
    """
    key = resolution(rows)
    if key is None:
        return None
    groups: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        if row["error"]:
            others = repr([(k, v) for k, v in row["options"].items() if k != key])
            groups.setdefault(others, []).append((math.log(row["options"][key]), math.log(row["error"])))
    x, y = (
        np.concatenate([[p[i] - float(np.mean([q[i] for q in points])) for p in points] for points in groups.values()])
        if groups
        else np.empty(0)
        for i in (0, 1)
    )
    return float(x @ y / (x @ x)) if np.any(np.abs(x) > 1e-12) else None


def label(options: Mapping[str, Any]) -> str:
    """The options of a run, for a person."""
    return ", ".join(f"{key} {plain(value)}" for key, value in options.items())


def plain(value: Any) -> str:
    """A value of an option, for a person: floats in four digits."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _sound(row: Row) -> bool:
    """Whether a row has an error that can be trusted, and a time."""
    timed = row["wall_seconds"] is not None and math.isfinite(row["wall_seconds"])
    return row["error"] is not None and timed and not (row["balance_error"] or 0.0) > LIMIT
