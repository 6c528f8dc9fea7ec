"""Pictures of a result folder: one frame, all frames as numbered files, or a film."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines import egl, movie
from zrno.pipelines.load import Result, load
from zrno.pipelines.quantities import field as field_of
from zrno.pipelines.quantities import quantity
from zrno.pipelines.replacing import replacing
from zrno.pipelines.stage import FINE, Stage, scale_for
from zrno.pipelines.view import LEAST_PIXELS, MOST_PIXELS, Extent, axes, extent, is_flat
from zrno.translators.text import Fault, InputError

SERIES = "particles"
_RATE = 25  # pictures a second


def render(
    directory: Path | str,
    *,
    output: Path | str | None = None,
    field: str = "von_mises",
    time: float | str = "last",
    view: str = "iso",
    size: tuple[int, int] = (1280, 720),
) -> list[Path]:
    """Draw the particles of a result folder, coloured by a field; returns the files written.

    output: FILE.png (numbered where time is "all"), FILE.mp4 or FILE.ogv (a film of all frames); without it FIELD.png
    in the folder. field: an array, a component of one (`velocity_x`), or the magnitude of a vector. time: "last",
    "all", or a simulated time, of which the nearest frame is drawn. view: iso (a flat scene is looked at straight), x,
    y, z, -x, -y, -z. size: width and height in pixels. Camera and colours are the same for all frames.

    Raises InputError or ValueError for what is not there, Missing where EGL or ffmpeg is not installed.
    """
    result = load(directory)
    if SERIES not in result.series or not len(result.times):
        raise InputError([Fault(str(directory), 1, 1, "no frames in this folder", expected=f"{SERIES}.pvd")])
    chosen = _frames(result.times, time)
    target = Path(output) if output is not None else result.directory / _name(field, time, view)
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
    pictures = _pictures(result, frames, field, view, size)
    if film:
        movie.write(target, pictures, rate=_RATE)
        return [target]
    files = [target.with_stem(f"{target.stem}_{i:05d}") for i in frames] if time == "all" else [target]
    for file, picture in zip(files, pictures, strict=True):
        _save(file, picture)
    return files


def _name(field: str, time: float | str, view: str) -> str:
    when = "" if time in ("last", "all") else f"_t{float(time):g}"
    return f"{field}{'' if view == 'iso' else '_' + view}{when}.png"


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


def _pictures(
    result: Result, frames: Sequence[int], field: str, view: str, size: tuple[int, int]
) -> Iterator[NDArray[np.uint8]]:
    """Each frame's picture; the first pass over the frames finds the camera and the colours that fit all."""
    first = result.arrays(SERIES, frames[0])["position"]
    spread = np.ptp(first, axis=0).astype(float)
    along = axes(view, spread)
    box = Extent(np.full(3, np.inf), np.full(3, -np.inf))
    least, most, count = np.inf, -np.inf, 0
    for i in frames:
        arrays = result.arrays(SERIES, i)
        values = field_of(arrays, field)
        finite = values[np.isfinite(values)]
        if len(finite):
            least, most = min(least, float(finite.min())), max(most, float(finite.max()))
        seen = extent(arrays["position"], float(arrays["radius"].max()), along)
        box = Extent(np.minimum(box.low, seen.low), np.maximum(box.high, seen.high))
        count = max(count, len(values))
    shown = quantity(field, result.units, result.dimension)
    when = quantity("time", result.units).unit
    scale = scale_for(least, most, str(shown))
    stage = Stage(size, along, box, scale, title=result.title, flat=is_flat(spread), fine=count * len(frames) <= FINE)
    try:
        for i in frames:
            arrays = result.arrays(SERIES, i)
            caption = f"t = {result.times[i]:.4g} {when}".rstrip()
            yield stage.draw(arrays["position"], arrays["radius"], field_of(arrays, field), caption)
    finally:
        stage.close()


def _save(path: Path, picture: NDArray[Any]) -> None:
    from matplotlib.image import imsave

    with replacing(path) as temporary:
        imsave(temporary, picture)
