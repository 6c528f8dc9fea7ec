"""Where the camera stands: named directions, and the scale that fills a part of the picture with the points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
_UP = {"x": (0, 0, 1), "y": (0, 0, 1), "z": (0, 1, 0), "iso": (0, 0, 1)}
_TOWARDS_CAMERA = {"x": (1, 0, 0), "y": (0, -1, 0), "z": (0, 0, 1), "iso": (0.9, -1.25, 0.75)}
LEAST_PIXELS, MOST_PIXELS = 64, 8192  # of a side of a picture
VIEWS = ("iso", "x", "y", "z", "-x", "-y", "-z")


@dataclass(frozen=True, slots=True)
class Axes:
    """right, up and towards: unit vectors of the picture, towards pointing at the camera."""

    right: Vector
    up: Vector
    towards: Vector


@dataclass(slots=True)
class Extent:
    """Box of the points in the picture's axes: low and high, shape (3,) each (right, up, towards)."""

    low: Vector
    high: Vector

    @property
    def size(self) -> Vector:
        """Edges of the box."""
        return self.high - self.low


def is_flat(spread: Vector) -> bool:
    """Whether points lie in a plane z = const, as those of a 2D deck. spread: their extent along x, y, z."""
    return bool(spread[2] <= 1e-6 * spread.max())


def _direction(view: str) -> list[float]:
    """The numbers of a view that is a direction, from the scene towards the camera; none where it is not one."""
    try:
        found = [float(part) for part in view.split(",")]
    except ValueError:
        return []
    size = math.hypot(*found)
    return found if len(found) == 3 and 0.0 < size < math.inf else []


def is_view(view: str) -> bool:
    """Whether it is a name or a direction (three numbers with commas, from the scene towards the camera)."""
    return view in VIEWS or bool(_direction(view))


def axes(view: str, spread: Vector) -> Axes:
    """The axes of a view: x (seen from +x), y (from -y, so that x runs right), z (from +z), -x .., iso, or a direction.

    spread: extent of the points along x, y, z; iso of a flat scene looks straight at it. Raises ValueError for a view
    that is not one.
    """
    if not is_view(view):
        raise ValueError(f"no view {view}; there are: {', '.join(VIEWS)}, or a direction as 1,-2,0.5")
    if view == "iso" and is_flat(spread):
        view = "z"
    name = view.removeprefix("-")
    if view in VIEWS:
        towards, up = np.array(_TOWARDS_CAMERA[name], float) * (-1 if view.startswith("-") else 1), _UP[name]
    else:
        towards, up = np.array(_direction(view)), (0, 0, 1)
        if np.hypot(*towards[:2]) < 1e-6 * abs(towards[2]):
            up = _UP["z"]
    towards /= np.linalg.norm(towards)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return Axes(right, np.cross(towards, right), towards)


def extent(points: NDArray[Any], radius: float, along: Axes) -> Extent:
    """The box of spheres. points: (n, 3); radius: the largest."""
    seen = np.asarray(points, float) @ np.stack((along.right, along.up, along.towards), axis=1)
    return Extent(seen.min(axis=0) - radius, seen.max(axis=0) + radius)


def aim(camera: Any, along: Axes, box: Extent, size: tuple[int, int], free: tuple[float, float, float, float]) -> None:
    """Point a parallel camera so that the box fills the free part of the picture.

    size: pixels; free: left, bottom, right, top of the free part as fractions of the picture.
    """
    left, bottom, right, top = free
    aspect = size[0] / size[1]
    width, height, depth = np.maximum(box.size, 1e-12 * max(1.0, float(np.abs(box.high).max())))
    picture = max(height / (top - bottom), width / ((right - left) * aspect))  # height of the picture in the scene
    centre = (box.low + box.high) / 2
    offset = np.array([(0.5 - (left + right) / 2) * picture * aspect, (0.5 - (bottom + top) / 2) * picture, 0.0])
    focus = np.stack((along.right, along.up, along.towards)).T @ (centre + offset)
    distance = float(max(picture, depth)) * 2
    camera.SetParallelProjection(True)
    camera.SetFocalPoint(*focus)
    camera.SetPosition(*(focus + distance * along.towards))
    camera.SetViewUp(*along.up)
    camera.SetParallelScale(picture / 2)
    camera.SetClippingRange(distance - depth, distance + depth)
