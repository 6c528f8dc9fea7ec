"""Numbers taken from the particles or nodes of a frame: extents, radii, fronts, fields. Pure functions of arrays.

A particle is the cell of its volume: extents, fronts and radii reach half a cell, (mass / density)^(1/dimension) / 2,
beyond its centre. To add a measure: a function here, whose keyword parameters are keys of the scene's
`study.quantity`, and its line in `MEASURES`.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.quantities import field as field_of
from zrno.pipelines.signals import Unmeasured

Floats = NDArray[np.float64]
_AXES = "xyz"
_LINK = 1.5  # particles of a heap touch: so many cells apart at most, the diagonal of a square lattice among them
BINS = 20


@dataclass(frozen=True, slots=True)
class Cloud:
    """The particles of one frame. arrays: as `load(...).arrays()` gives them; dimension: 1, 2 or 3; axisymmetric: x is
    the distance from the axis, of rings."""

    arrays: Mapping[str, NDArray[Any]]
    dimension: int = 3
    axisymmetric: bool = False

    def of(self, material: int | None) -> Cloud:
        """Those of one material, all for None. Raises ValueError where it has none."""
        if material is None:
            return self
        rows = self.arrays["material"] == material
        if not rows.any():
            present = ", ".join(map(str, np.unique(self.arrays["material"])))
            raise ValueError(f"no material {material}; there are: {present}")
        return self.only(rows)

    def only(self, rows: NDArray[np.bool_]) -> Cloud:
        """Some of the particles."""
        return Cloud({name: values[rows] for name, values in self.arrays.items()}, self.dimension, self.axisymmetric)

    @property
    def x(self) -> Floats:
        """Positions, shape (n, 3)."""
        return np.asarray(self.arrays["position"], float)

    @property
    def mass(self) -> Floats:
        """Shape (n,)."""
        return np.asarray(self.arrays["mass"], float)

    @property
    def half(self) -> Floats:
        """Half of each particle's cell, a length, shape (n,)."""
        density = np.maximum(np.asarray(self.arrays["density"], float), 1e-300)
        volume = self.mass / density
        if self.axisymmetric:
            volume = volume / (2.0 * math.pi * np.maximum(self.x[:, 0], 1e-300))
        return np.asarray(0.5 * volume ** (1.0 / self.dimension))

    def field(self, name: str) -> Floats:
        """A field or component (`stress_xx`), shape (n,). Raises ValueError for a name that is not there."""
        return np.asarray(field_of(self.arrays, name), float)


def length(now: Cloud, *, axis: str) -> float:
    """Extent along an axis."""
    return front(now, axis=axis) - back(now, axis=axis)


def front(now: Cloud, *, axis: str, fraction: float = 1.0, heap: bool = False) -> float:
    """The coordinate that `fraction` of the mass has not passed; heap: of the main heap alone, without stray grains."""
    now = main_heap(now) if heap else now
    return _holds(now.x[:, _AXES.index(axis)] + now.half, now.mass, fraction)


def back(now: Cloud, *, axis: str, fraction: float = 1.0, heap: bool = False) -> float:
    """As front, at the other end."""
    now = main_heap(now) if heap else now
    return -_holds(-now.x[:, _AXES.index(axis)] + now.half, now.mass, fraction)


def radius(
    now: Cloud, *, axis: str, about: Sequence[float] = (0.0, 0.0, 0.0), fraction: float = 1.0, heap: bool = False
) -> float:
    """About an axis through a point: the radius that holds `fraction` of the mass."""
    now = main_heap(now) if heap else now
    return _holds(_distance(now, axis, about) + now.half, now.mass, fraction)


def toe(
    now: Cloud,
    *,
    axis: str,
    depth: float,
    window: float,
    about: Sequence[float] | None = None,
    sector: float = 360.0,
    heap: bool = False,
) -> float:
    """How far a heap reaches that is still `depth` deep: its volume over a window of this length, by the floor there.

    The last grains lie one particle thick, and a front by them moves with the spacing; this does not. Along an axis, in
    the plane; with `about`, a point: the distance from the axis through it, of a heap that spreads over a sector
    [degrees]. Raises ValueError where it is nowhere so deep.
    """
    now = main_heap(now) if heap else now
    volume = now.mass / np.maximum(np.asarray(now.arrays["density"], float), 1e-300)
    x = now.x[:, _AXES.index(axis)] if about is None else _distance(now, axis, about)
    # the volume up to a place: each cell is a ramp, whose slope begins and ends with it
    ends = np.concatenate([x - now.half, x + now.half])
    slope = np.tile(volume / (2.0 * now.half), 2) * np.repeat([1.0, -1.0], len(x))
    order = np.argsort(ends, kind="stable")
    ends, slope = ends[order], np.cumsum(slope[order])
    upto = np.concatenate([[0.0], np.cumsum(slope[:-1] * np.diff(ends))])
    at = np.arange(0.5 * window if about is not None else ends[0], ends[-1] + window, 0.01 * window)
    breadth = 1.0 if about is None else np.radians(sector) * at
    held = np.interp(at + 0.5 * window, ends, upto) - np.interp(at - 0.5 * window, ends, upto)
    deep = np.flatnonzero(held / (window * breadth) >= depth)
    if not len(deep):
        raise ValueError(f"the heap is nowhere {depth:g} deep")
    return float(at[deep[-1]])


def inner_radius(now: Cloud, *, axis: str, about: Sequence[float] = (0.0, 0.0, 0.0)) -> float:
    """About an axis through a point: where the material begins."""
    return float(max(0.0, (_distance(now, axis, about) - now.half).min()))


def centre(now: Cloud, *, axis: str) -> float:
    """Coordinate of the centre of mass."""
    return float(np.average(now.x[:, _AXES.index(axis)], weights=now.mass))


def speed(now: Cloud, *, axis: str) -> float:
    """Velocity of the centre of mass along an axis."""
    return float(np.average(now.field(f"velocity_{axis}"), weights=now.mass))


def mass(now: Cloud, *, axis: str, above: float = -math.inf, below: float = math.inf) -> float:
    """Mass of the particles whose coordinate along an axis is between two bounds."""
    where = now.x[:, _AXES.index(axis)]
    return float(now.mass[(where >= above) & (where <= below)].sum())


def mean(now: Cloud, *, field: str) -> float:
    """Of a field, by mass."""
    return float(np.average(now.field(field), weights=now.mass))


def highest(now: Cloud, *, field: str) -> float:
    """The largest value of a field."""
    return float(now.field(field).max())


def lowest(now: Cloud, *, field: str) -> float:
    """The smallest value of a field."""
    return float(now.field(field).min())


def restitution(now: Cloud, start: Cloud, *, axis: str, material: int, against: int | None = None) -> float:
    """Speed after to speed before the rebound of a body's centre of mass, off another body or a wall (None)."""

    def closing(cloud: Cloud) -> float:
        other = speed(cloud.of(against), axis=axis) if against is not None else 0.0
        return speed(cloud.of(material), axis=axis) - other

    before = closing(start)
    if before == 0.0:
        raise Unmeasured("the bodies do not move against each other at the start")
    return -closing(now) / before


def profile(now: Cloud, *, axis: str, field: str, bins: int = BINS) -> tuple[Floats, Floats]:
    """A field along an axis: means by mass, of coordinate and field, in slices of equal width that hold particles."""
    x, mass, values = now.x[:, _AXES.index(axis)], now.mass, now.field(field)
    low, high = float(x.min()), float(x.max())
    # a row of a lattice belongs to one slice, not by its round-off to two
    where = np.clip(((x - low) / max(high - low, 1e-300) * bins + 1e-9).astype(int), 0, bins - 1)
    weight = np.bincount(where, mass, bins)
    held = weight > 0
    return (np.bincount(where, mass * x, bins)[held] / weight[held],
            np.bincount(where, mass * values, bins)[held] / weight[held])  # fmt: skip


def clusters(now: Cloud, *, link: float = _LINK) -> float:
    """How many pieces there are: chains of neighbours not farther than `link` cells."""
    return float(_heaps(now, link).max() + 1)


def at(now: Cloud, *, point: Sequence[float], field: str) -> float:
    """A field at the particle or node that began nearest to a point."""
    return float(now.field(field)[nearest(now.x - _moved(now), point)])


def total(now: Cloud, *, field: str, axis: str, place: float) -> float:
    """A field, summed over the particles or nodes that began at a coordinate, as reactions of a plane."""
    return float(now.field(field)[in_plane(now.x - _moved(now), axis, place)].sum())


def nearest(x: Floats, point: Sequence[float]) -> int:
    """Which of the points (n, 3) is nearest to a point."""
    return int(np.argmin(((x - np.asarray(point, float)) ** 2).sum(axis=1)))


def in_plane(x: Floats, axis: str, place: float) -> NDArray[np.int64]:
    """Which of the points (n, 3) have a coordinate, to 1e-6 of their extent. Raises ValueError where none has."""
    values = x[:, _AXES.index(axis)]
    found = np.flatnonzero(np.abs(values - place) <= 1e-6 * float(np.ptp(x, axis=0).max()))
    if not len(found):
        raise ValueError(f"nothing began at {axis} = {place:g}")
    return found


def _moved(now: Cloud) -> Floats:
    """How far each has moved, shape (n, 3); 0 where a frame does not say."""
    return np.asarray(now.arrays.get("displacement", 0.0), float)


def main_heap(now: Cloud) -> Cloud:
    """The particles that hang together with most of the mass: chains of neighbours not farther than _LINK cells."""
    heap = _heaps(now, _LINK)
    return now.only(heap == np.argmax(np.bincount(heap, now.mass)))


def _heaps(now: Cloud, link: float) -> NDArray[np.int64]:
    """Of each particle the number of its heap, from 0 on. link: of neighbours, in cells."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    n = len(now.mass)
    pairs = cKDTree(now.x).query_pairs(link * 2.0 * float(np.median(now.half)), output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], np.int64)


def _distance(now: Cloud, axis: str, about: Sequence[float]) -> Floats:
    """From an axis through a point, shape (n,)."""
    across = [i for i in range(3) if i != _AXES.index(axis)]
    return np.asarray(np.linalg.norm(now.x[:, across] - np.asarray(about, float)[across], axis=1))


def _holds(values: Floats, mass: Floats, fraction: float) -> float:
    """The value that particles of `fraction` of the mass do not pass."""
    order = np.argsort(values)
    share = np.cumsum(mass[order]) / mass.sum()
    return float(values[order[min(int(np.searchsorted(share, fraction - 1e-12)), len(order) - 1)]])


MEASURES: dict[str, Callable[..., Any]] = {
    "length": length,
    "front": front,
    "back": back,
    "radius": radius,
    "toe": toe,
    "inner_radius": inner_radius,
    "clusters": clusters,
    "centre": centre,
    "speed": speed,
    "mass": mass,
    "mean": mean,
    "max": highest,
    "min": lowest,
    "restitution": restitution,
    "profile": profile,
    "at": at,
    "total": total,
}


def parameters(measure: str) -> dict[str, bool]:
    """The keys that a measure takes, and whether each must be given; `material` selects particles for all of them."""
    signature = inspect.signature(MEASURES[measure]).parameters.values()
    own = {p.name: p.default is p.empty for p in signature if p.kind is p.KEYWORD_ONLY}
    return {"material": False} | own


def evaluate(measure: str, now: Cloud, start: Cloud, given: Mapping[str, Any]) -> Any:
    """A measure of a frame: a number, of `profile` a curve. start: the first frame; given: `parameters` by name.

    Raises ValueError for a field or material that is not there, Unmeasured for what this run does not show.
    """
    function = MEASURES[measure]
    if measure == "restitution":
        return function(now, start, **given)
    rest = dict(given)
    return function(now.of(rest.pop("material", None)), **rest)
