"""The picture of a study: error against wall seconds, the efficient front, the tolerance, every run by its options."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle, pairwise
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np

from zrno.pipelines.plot import COLOURS
from zrno.pipelines.ranking import plain
from zrno.pipelines.replacing import replacing

_MANY = 30  # runs, above which those beside the front have no label
_GREY = "#8a8a8a"
_LABEL = 56  # characters of the axis' label in a line
# Where a label may stand beside its point, in points; the first place that is free is taken.
_PLACES = [
    (7, 5, "left"), (7, -12, "left"), (-7, 5, "right"), (-7, -12, "right"), (0, 12, "center"), (0, -19, "center"),
    (14, 16, "left"), (14, -24, "left"), (-14, 16, "right"), (-14, -24, "right"),
]  # fmt: skip


def draw(target: Path, result: Mapping[str, Any]) -> Path:
    """Draw a study's result (`study.study`); returns the file."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    rows = [row for row in result["rows"] if row["error"] is not None and row["wall_seconds"] is not None]
    figure = Figure(figsize=(8, 5.6), layout="constrained")
    FigureCanvasAgg(figure)
    axis = figure.add_subplot()
    axis.set_title(result["title"] or "Speed against error", fontsize="large")
    axis.set_xlabel("wall time [s], compiling apart")
    axis.set_ylabel(fill(f"relative error of {result['quantity']}", _LABEL))
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(color="#dddddd", linewidth=0.6, which="major")
    axis.grid(color="#eeeeee", linewidth=0.4, which="minor")
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)
    axis.axhspan(1e-300, result["tolerance"], color=COLOURS[2], alpha=0.08, linewidth=0)
    axis.axhline(result["tolerance"], color=COLOURS[2], linewidth=1.2, linestyle="--",
                 label=f"tolerance {result['tolerance']:g}")  # fmt: skip
    _points(axis, rows)
    beside = [row for row in result["peers"] if row["error"] is not None]
    _peers(axis, beside)
    _limits(axis, [*rows, *beside], result["tolerance"])
    _plain_ticks(axis)
    names = ", ".join(key.rpartition(".")[2].replace("_", " ") for key in result["rows"][0]["options"])
    axis.annotate(f"labels: {names}", (0.99, 0.98), xycoords="axes fraction", ha="right", va="top", fontsize="small",
                  color=_GREY)  # fmt: skip
    failed = len(result["rows"]) - len(rows)
    if failed:
        said = f"{failed} run{'s' * (failed > 1)} without an error: see study.csv"
        axis.annotate(said, (0.01, 0.01), xycoords="axes fraction", fontsize="small", color=_GREY)
    figure.legend(loc="outside lower center", ncols=4, frameon=False, fontsize="small")
    figure.draw_without_rendering()  # the layout, which labels are placed by
    shown = rows if len(rows) <= _MANY else [row for row in rows if row["front"]]
    _labels(figure, axis, rows, shown)
    with replacing(target) as temporary:
        figure.savefig(temporary, dpi=150)
    return target


def _points(axis: Any, rows: Sequence[Mapping[str, Any]]) -> None:
    """The runs: those beside the front hollow, the front joined by steps, the recommended one ringed."""
    beside = [row for row in rows if not row["front"]]
    front = sorted((row for row in rows if row["front"]), key=lambda row: row["wall_seconds"])
    if beside:
        axis.plot(*_xy(beside), "o", color=_GREY, markerfacecolor="white", markersize=6, label="dearer, no better")
    if front:
        axis.plot(*_xy(front), "-o", color=COLOURS[0], linewidth=1.6, markersize=7, zorder=4, label="efficient front")
    best = [row for row in rows if row["recommended"]]
    if best:
        axis.plot(*_xy(best), "o", color=COLOURS[1], markerfacecolor="none", markersize=14, markeredgewidth=2,
                  linestyle="none", zorder=5, label="recommended")  # fmt: skip


def _peers(axis: Any, rows: Sequence[Mapping[str, Any]]) -> None:
    """Another program's runs: a broken line a type of elements."""
    names = list(dict.fromkeys((row["program"], row["element"]) for row in rows))
    for (program, element), marker in zip(names, cycle("s^vDP"), strict=False):
        own = [row for row in rows if (row["program"], row["element"]) == (program, element)]
        axis.plot(*_xy(own), linestyle=":", marker=marker, color=COLOURS[3], linewidth=1.0, markersize=5, zorder=3,
                  label=f"{program} {element}")  # fmt: skip


def _xy(rows: Sequence[Mapping[str, Any]]) -> tuple[list[float], list[float]]:
    return [row["wall_seconds"] for row in rows], [max(row["error"], 1e-16) for row in rows]


def _limits(axis: Any, rows: Sequence[Mapping[str, Any]], tolerance: float) -> None:
    """All points and the tolerance, with room for labels."""
    x, y = _xy(rows)
    y.append(tolerance)
    if x:
        axis.set_xlim(min(x) / 1.5, max(x) * 1.8)
    axis.set_ylim(min(y) / 1.7, max(y) * 1.7)


def _plain_ticks(axis: Any) -> None:
    """0.2, 0.5, 1, 2: powers of ten alone would leave a short axis without a number."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for one, (low, high) in ((axis.xaxis, axis.get_xlim()), (axis.yaxis, axis.get_ylim())):
        one.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high / low < 300 else (1.0,)))
        one.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        one.set_minor_formatter(NullFormatter())


def _labels(figure: Any, axis: Any, rows: Sequence[Mapping[str, Any]], shown: Sequence[Mapping[str, Any]]) -> None:
    """A label a run, where it covers neither a point, nor the front, nor another label; else there is none."""
    from matplotlib.transforms import Bbox

    renderer = figure.canvas.get_renderer()
    points = [axis.transData.transform(point) for point in zip(*_xy(rows), strict=True)]
    taken = [Bbox.from_bounds(x - 7, y - 7, 14, 14) for x, y in points]
    front = [point for point, row in sorted(zip(points, rows, strict=True), key=lambda p: p[0][0]) if row["front"]]
    for a, b in pairwise(front):  # the line, too, as a chain of small boxes
        along = np.linspace(a, b, 2 + int(np.hypot(*(b - a)) / 5))
        taken += [Bbox.from_bounds(x - 2, y - 2, 4, 4) for x, y in along]
    varied = rows[0]["options"] if rows else {}
    for row in sorted(shown, key=lambda row: not row["front"]):
        words = [plain(row["options"][key]) for key in varied]
        (x,), (y,) = _xy([row])
        colour = COLOURS[0] if row["front"] else _GREY
        for dx, dy, side in _PLACES:
            note = axis.annotate(", ".join(words), (x, y), (dx, dy), textcoords="offset points", ha=side,
                                 fontsize=8, color=colour, zorder=6)  # fmt: skip
            box = note.get_window_extent(renderer)
            inside = axis.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1 and axis.bbox.y0 <= box.y0
            if inside and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            note.remove()
