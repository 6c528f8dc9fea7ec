"""Histories of a result folder against time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.load import Result, load
from zrno.pipelines.quantities import quantity, unknown
from zrno.pipelines.replacing import replacing
from zrno.translators.text import Fault, InputError

_PANELS = {  # a quantity that stands for several columns: heading, columns
    "energy": ("energy", ("kinetic", "internal", "dissipated", "external_work")),
    "momentum": ("momentum", ("momentum_x", "momentum_y", "momentum_z")),
    "contact_force": ("contact force", ("contact_force_x", "contact_force_y", "contact_force_z")),
    "structure_force": ("force on the structure", ("structure_force_x", "structure_force_y", "structure_force_z")),
}
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")  # Okabe and Ito: told apart by colour-blind eyes, too
_FORMATS = (".png", ".pdf", ".svg")


def plot(directory: Path | str, *, output: Path | str | None = None, quantities: Sequence[str] | None = None) -> Path:
    """Draw histories, one panel a quantity; returns the file written.

    output: FILE.png, .pdf or .svg; without it history.png in the folder. quantities: columns of history.csv, or energy,
    momentum, contact_force and structure_force for their parts together (by default those of them that are there).
    Raises InputError or ValueError for what is not there.
    """
    result = load(directory)
    history = result.history
    if not len(history.get("time", ())):
        raise InputError([Fault(str(directory), 1, 1, "no history in this folder", expected="history.csv with rows")])
    target = Path(output) if output is not None else result.directory / "history.png"
    if target.suffix not in _FORMATS:
        raise ValueError(f"{target} is not a plot: give {', '.join(_FORMATS)}")
    there = [name for name, (_, columns) in _PANELS.items() if any(column in history for column in columns)]
    panels = [_panel(name, history) for name in quantities or there or _PANELS]
    target.parent.mkdir(parents=True, exist_ok=True)
    _draw(target, panels, result)
    return target


def _panel(name: str, history: Mapping[str, NDArray[Any]]) -> tuple[str, list[str]]:
    """Heading and columns of a panel."""
    if name in history:
        return quantity(name).label, [name]
    heading, columns = _PANELS.get(name, ("", ()))
    found = [column for column in columns if column in history]
    if not found:
        raise ValueError(unknown("quantity", name, [*_PANELS, *history]))
    return heading, found


def _draw(
    target: Path,
    panels: Sequence[tuple[str, Sequence[str]]],
    result: Result,
) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    history = result.history
    figure = Figure(figsize=(8, 0.7 + 2.3 * len(panels)), layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(result.title)
    axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axis, (heading, columns) in zip(axes, panels, strict=True):
        for i, column in enumerate(columns):  # the first on top: of momenta and forces the others are often zero
            style = {"color": COLOURS[i], "linewidth": 1.4, "zorder": 3 - 0.1 * i}
            axis.plot(history["time"], history[column], label=quantity(column).label, **style)
        axis.set_ylabel(_labelled(heading, columns[0], result))
        axis.grid(color="#dddddd", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.ticklabel_format(axis="y", useMathText=True, scilimits=(-3, 4))
        axis.spines[["top", "right"]].set_visible(False)
        if len(columns) > 1:
            axis.legend(frameon=False, fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    axes[-1].set_xlabel(_labelled("time", "time", result))
    axes[-1].set_xlim(*_limits(history["time"]))
    with replacing(target) as temporary:
        figure.savefig(temporary, dpi=150)


def _labelled(heading: str, column: str, result: Result) -> str:
    unit = quantity(
        column, result.units, 3 if result.axisymmetric else result.dimension
    ).unit or result.history_units.get(column, "")
    return f"{heading} [{unit}]" if unit else heading


def _limits(time: NDArray[Any]) -> tuple[float, float]:
    first, last = float(np.min(time)), float(np.max(time))
    return (first, last) if last > first else (first, first + 1.0)
