"""Coordinate systems (block 405) and functions (block 420)."""

from __future__ import annotations

import numpy as np

from zrno.translators.femap.cursor import Cursor
from zrno.translators.model import CoordinateSystem, Curve, Floats, Model

SYSTEM_KINDS = ("rectangular", "cylindrical", "spherical")


def read_systems(cursor: Cursor, model: Model) -> None:
    """Coordinate systems: number, base, kind, colour, layer; title; origin; rotations about x, y, z in degrees."""
    path = cursor.lines.faults.path
    unsure = nested = 0
    while not cursor.done:
        source = cursor.source
        number, base, kind = cursor.integers(3, "a coordinate system's number", 0)
        title = cursor.title()
        origin = np.array(cursor.numbers(3, "an origin")[:3])
        angles = np.array(cursor.numbers(3, "rotations")[:3])
        if kind not in range(len(SYSTEM_KINDS)):
            cursor.lines.fail(source.line - 1, "not the kind of a coordinate system", str(kind), "0, 1 or 2")
        if base != 0:
            nested += 1
        unsure += int(np.count_nonzero(angles) > 1)
        axes = rotation(angles)
        model.systems[number] = CoordinateSystem(number, title, SYSTEM_KINDS[kind], origin, axes, source)
    if nested:
        model.warnings.append(
            f"{path}: {nested} coordinate system(s) lie in another than the global one: taken as global"
        )
    if unsure:
        said = "turn about more than one axis: taken as about x, then y, then z, all fixed"
        model.warnings.append(f"{path}: {unsure} coordinate system(s) {said}")


def rotation(angles: Floats) -> Floats:
    """Axes (3, 3), a row each, after rotations about the fixed axes x, y, z in turn; angles (3,) in degrees."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(np.radians(angles)), np.sin(np.radians(angles))
    x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    axes: Floats = (z @ y @ x).T
    return axes


def angles_of(axes: Floats) -> Floats:
    """The angles (3,) in degrees whose `rotation` the axes are."""
    m = axes.T
    y = np.arctan2(-m[2, 0], np.hypot(m[0, 0], m[1, 0]))
    if np.hypot(m[0, 0], m[1, 0]) > 1e-12:
        x, z = np.arctan2(m[2, 1], m[2, 2]), np.arctan2(m[1, 0], m[0, 0])
    else:
        x, z = np.arctan2(-m[1, 2], m[1, 1]), 0.0
    return np.degrees([x, y, z])


def read_functions(cursor: Cursor, model: Model) -> None:
    """Functions: number, kind; title; lines of an index, x and y until -1."""
    while not cursor.done:
        source = cursor.source
        number, _ = cursor.integers(1, "a function's number", 1, 2)
        title = cursor.title()
        rows = cursor.records(1, "points")
        points = cursor.lines.table(rows, 3, "points", 3)[:, 1:].copy()
        model.curves[number] = Curve(number, title, points, source)
