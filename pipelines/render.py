"""Pictures of a result folder: one frame, all frames as numbered files, or a film."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines import egl, movie
from zrno.pipelines.load import Result, load
from zrno.pipelines.quantities import field as field_of
from zrno.pipelines.quantities import field_names, quantity, unknown
from zrno.pipelines.replacing import replacing
from zrno.pipelines.stage import FINE, Cloud, Stage, scale_for
from zrno.pipelines.view import LEAST_PIXELS, MOST_PIXELS, Extent, axes, extent, is_flat
from zrno.translators.text import Fault, InputError

_RATE = 25  # pictures a second
_TOUCHING = {1: 1.0, 2: math.sqrt(math.pi) / 2.0, 3: math.cbrt(math.pi / 6.0)}  # half a cell's edge over its radius


def render(
    directory: Path | str,
    *,
    output: Path | str | None = None,
    field: str = "von_mises",
    time: float | str = "last",
    view: str = "iso",
    size: tuple[int, int] = (1280, 720),
    of: str | None = None,
    most: float | None = None,
) -> list[Path]:
    """Draw the particles and elements of a result folder, coloured by a field; returns the files written.

    output: FILE.png (numbered where time is "all"), FILE.mp4 or FILE.ogv (a film of all frames); without it FIELD.png
    in the folder. Particles are spheres of their volume; beside elements they are balls of half their spacing, as
    contact sees them: they touch what they lie on. field: an array (of particles, nodes or elements), a component of
    one (`velocity_x`), or the magnitude of a vector. time: "last", "all", or a simulated time, of which the nearest
    frame is drawn. view: iso (a flat scene is looked at straight), x, y, z, -x, -y, -z, or a direction from the scene
    towards the camera ("1,-2,0.5"). size: width and height in pixels. of: particles or elements,
    where the other's values of the same field shall not stretch the scale; the other is grey. most: where the colours
    end, for a field with a few peaks. Camera and colours are the same for all frames.

    Raises InputError or ValueError for what is not there, Missing where EGL or ffmpeg is not installed.
    """
    result = load(directory)
    if not result.whole or not len(result.times):
        expected = "particles.pvd or elements.pvd"
        raise InputError([Fault(str(directory), 1, 1, "no frames in this folder", expected=expected)])
    if of is not None and of not in result.whole:
        raise ValueError(f"no {of} to colour; there are: {', '.join(result.whole)}")
    chosen = _frames(result.times, time)
    target = Path(output) if output is not None else result.directory / _name(field, time, view, of)
    if target.suffix not in (".png", *movie.SUFFIXES):
        raise ValueError(f"{target} is neither a picture nor a film: give .png, {' or '.join(movie.SUFFIXES)}")
    if min(size) < LEAST_PIXELS or max(size) > MOST_PIXELS:
        limits = f"{LEAST_PIXELS} to {MOST_PIXELS}"
        raise ValueError(f"a picture of {size[0]} x {size[1]} pixels cannot be drawn: give {limits} a side")
    film = target.suffix in movie.SUFFIXES
    if film:
        movie.require(target)
    egl.require()
    target.parent.mkdir(parents=True, exist_ok=True)
    frames = range(len(result.times)) if film else chosen
    pictures = _pictures(result, frames, field, view, size, of, most)
    if film:
        movie.write(target, pictures, rate=_RATE)
        return [target]
    files = [target.with_stem(f"{target.stem}_{i:05d}") for i in frames] if time == "all" else [target]
    for file, picture in zip(files, pictures, strict=True):
        _save(file, picture)
    return files


def _name(field: str, time: float | str, view: str, of: str | None) -> str:
    when = "" if time in ("last", "all") else f"_t{float(time):g}"
    return f"{field}{'_' + of if of else ''}{'' if view == 'iso' else '_' + view}{when}.png"


def _frames(times: NDArray[np.float64], time: float | str) -> Sequence[int]:
    """Indices of the frames that a time means."""
    if time == "last":
        return [len(times) - 1]
    if time == "all":
        return range(len(times))
    try:
        wanted = float(time)
    except ValueError:
        raise ValueError(f"time is {time}; expected last, all or a number") from None
    slack = 1e-6 * max(abs(times[0]), abs(times[-1]))
    if not times[0] - slack <= wanted <= times[-1] + slack:
        raise ValueError(f"no frame at time {wanted:g}; there are {len(times)} from {times[0]:g} to {times[-1]:g}")
    return [int(np.argmin(np.abs(times - wanted)))]


@dataclass(frozen=True, slots=True)
class _Shown:
    """What a frame shows. values: of the field, of all that has it; points, reach: of all, for the camera."""

    cloud: Cloud | None
    mesh: Any
    values: NDArray[Any]
    points: NDArray[Any]
    reach: float


def _shown(result: Result, index: int, field: str, of: str | None) -> _Shown:
    """A frame with its field: of particles, of nodes or of elements; what does not have it, or is not `of`, is grey.

    Raises ValueError where nothing has it.
    """
    cloud, mesh = None, None
    values, points, names, reach = [], [], [], 0.0
    for name in result.whole:
        data = result.mesh(name, index)
        points.append(np.asarray(data.points))
        kinds = [data.point_data, data.cell_data] if name == "elements" else [data.point_data]
        if of not in (None, name):
            kinds = []
        found = None
        for arrays in kinds:
            of_kind = {key: np.asarray(arrays[key]) for key in arrays}
            try:
                found = field_of(of_kind, field)
            except ValueError:
                names += field_names(of_kind)
                continue
            values.append(found)
            if name == "elements":
                arrays["shown"] = np.asarray(found, np.float32)
            break
        if name == "elements":
            mesh = data
        else:
            radius = np.asarray(data.point_data["radius"])
            if "elements" in result.whole:
                radius = radius * _TOUCHING[result.dimension]
            reach = float(radius.max(initial=0.0))
            cloud = Cloud(points[-1], radius, np.full(len(radius), np.nan) if found is None else found)
    if not values:
        raise ValueError(unknown("field", field, dict.fromkeys(names)))
    return _Shown(cloud, mesh, np.concatenate(values), np.concatenate(points), reach)


def _pictures(
    result: Result,
    frames: Sequence[int],
    field: str,
    view: str,
    size: tuple[int, int],
    of: str | None,
    end: float | None,
) -> Iterator[NDArray[np.uint8]]:
    """Each frame's picture; the first pass over the frames finds the camera and the colours that fit all."""
    first = _shown(result, frames[0], field, of)
    spread = np.ptp(first.points, axis=0).astype(float)
    along = axes(view, spread)
    box = Extent(np.full(3, np.inf), np.full(3, -np.inf))
    least, most, count = np.inf, -np.inf, 0
    for i in frames:
        shown = first if i == frames[0] else _shown(result, i, field, of)
        finite = shown.values[np.isfinite(shown.values)]
        if len(finite):
            least, most = min(least, float(finite.min())), max(most, float(finite.max()))
        seen = extent(shown.points, shown.reach, along)
        box = Extent(np.minimum(box.low, seen.low), np.maximum(box.high, seen.high))
        count = max(count, len(shown.points))
    label = quantity(field, result.units, 3 if result.axisymmetric else result.dimension)
    when = quantity("time", result.units).unit
    scale = scale_for(least, most if end is None or end <= least else end, str(label))
    stage = Stage(size, along, box, scale, title=result.title, flat=is_flat(spread), fine=count * len(frames) <= FINE)
    try:
        for i in frames:
            shown = _shown(result, i, field, of)
            caption = f"t = {result.times[i]:.4g} {when}".rstrip()
            yield stage.draw(caption, shown.cloud, shown.mesh)
    finally:
        stage.close()


def _save(path: Path, picture: NDArray[Any]) -> None:
    from matplotlib.image import imsave

    with replacing(path) as temporary:
        imsave(temporary, picture)
