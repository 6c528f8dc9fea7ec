"""Particle arrays and history columns as a person reads them: labels, units, components, magnitudes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.units import SYSTEMS
from zrno.solvers.frame import Frame

_LABELS = {
    "id": "particle number",
    "von_mises": "von Mises stress",
    "dt": "time step",
    "kinetic": "kinetic energy",
    "internal": "internal energy",
    "dissipated": "dissipated energy",
    "active": "active particles",
}
_AXES = {3: ("x", "y", "z"), 6: ("xx", "yy", "zz", "xy", "yz", "zx")}


@dataclass(frozen=True, slots=True)
class Quantity:
    """label: words for a person; unit: "" where there is none or the system is not known."""

    label: str
    unit: str

    def __str__(self) -> str:
        return f"{self.label} [{self.unit}]" if self.unit else self.label


def quantity(name: str, system: str | None = None, dimension: int = 3) -> Quantity:
    """Label and unit of an array, a component of one (`velocity_x`) or a column.

    system: a consistent system of units ("mm-ms-g"), None when it is not known; dimension: of the run. A name that is
    not known labels itself.
    """
    units = SYSTEMS[system].labels(dimension) if system in SYSTEMS else {}
    base, _, axis = name.rpartition("_")
    component = axis in (*_AXES[3], *_AXES[6])
    label = _LABELS.get(name, name.replace("_", " "))
    unit = units.get(name) or (units.get(base, "") if component else "")
    for plain, printed in (("^2", "²"), ("^3", "³"), ("us", "µs")):
        unit = unit.replace(plain, printed)
    return Quantity(label, unit)


def field_names(arrays: Mapping[str, NDArray[Any]]) -> list[str]:
    """What `field` accepts of a frame: arrays, and components of those that have them (`velocity_x`, `stress_xx`)."""
    names = []
    for name, values in arrays.items():
        names.append(name)
        names += [f"{name}_{axis}" for axis in _AXES.get(values.shape[1], ())] if values.ndim == 2 else []
    return names


def shown_names(frame: Frame) -> list[str]:
    """What pictures of a frame may show: fields of its particles, its nodes and its elements."""
    names = [*field_names(frame.particles), *field_names(frame.nodes)]
    for cells in frame.cells:
        names += field_names(cells.data)
    return list(dict.fromkeys(names))


def field(arrays: Mapping[str, NDArray[Any]], name: str) -> NDArray[Any]:
    """An array, a component of one, or the magnitude of a vector or tensor (Frobenius); shape (n,).

    Raises ValueError with the names there are when the frame has no such field.
    """
    values = arrays.get(name)
    if values is None:
        base, _, axis = name.rpartition("_")
        parent = arrays.get(base)
        axes = _AXES.get(parent.shape[1], ()) if parent is not None and parent.ndim == 2 else ()
        if parent is None or axis not in axes:
            raise ValueError(unknown("field", name, field_names(arrays)))
        values = parent[:, axes.index(axis)]
    if values.ndim == 1:
        return values
    weights = np.array([1, 1, 1, 2, 2, 2]) if values.shape[1] == 6 else np.ones(values.shape[1])
    return np.asarray(np.sqrt((values.astype(float) ** 2) @ weights))


def unknown(what: str, name: str, names: Iterable[str]) -> str:
    """The message for a name that is not there."""
    return f"no {what} {name}; there are: {', '.join(names)}"
