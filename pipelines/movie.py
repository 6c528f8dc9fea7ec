"""Pictures one after the other into a film: .mp4 through ffmpeg, .ogv through VTK, which needs nothing more."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.errors import Missing, RunFailed
from zrno.pipelines.replacing import replacing

SUFFIXES = (".mp4", ".ogv")


def require(path: Path) -> None:
    """Raise Missing where a film of this suffix cannot be made here; to be called before pictures are drawn."""
    if path.suffix == ".mp4":
        _ffmpeg()


def write(path: Path, pictures: Iterable[NDArray[np.uint8]], *, rate: int) -> None:
    """Write a film, whole or not at all. pictures: shape (height, width, 3) each, all alike; rate: pictures a second.

    Raises Missing where .mp4 is asked for and there is no ffmpeg, RunFailed where it fails.
    """
    with replacing(path) as temporary:
        (_mp4 if path.suffix == ".mp4" else _ogv)(temporary, pictures, rate)


def _ffmpeg() -> str:
    """The program: on the path, or the one that the package imageio-ffmpeg brings."""
    found = shutil.which("ffmpeg")
    if found is None and find_spec("imageio_ffmpeg"):
        found = str(import_module("imageio_ffmpeg").get_ffmpeg_exe())
    if found is None:
        raise Missing(
            ".mp4 needs ffmpeg: apt-get install -y --no-install-recommends ffmpeg, or pip install imageio-ffmpeg; "
            "-o FILE.ogv needs neither"
        )
    return found


def _mp4(path: Path, pictures: Iterable[NDArray[np.uint8]], rate: int) -> None:
    program = _ffmpeg()
    process: subprocess.Popen[bytes] | None = None
    try:
        for picture in pictures:
            if process is None:
                height, width, _ = picture.shape
                command = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
                command += ["-s", f"{width}x{height}", "-r", str(rate), "-i", "-"]
                # Players want 4:2:0, and with it even sides.
                command += [
                    "-vf",
                    "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
                    "-c:v",
                    "libx264",
                    "-pix_fmt",
                    "yuv420p",
                ]
                command += ["-crf", "18", "-movflags", "+faststart", "-f", "mp4", str(path)]
                process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
            assert process.stdin is not None
            process.stdin.write(picture.tobytes())
    except BrokenPipeError:
        pass  # ffmpeg ended before its time; it says why below
    except BaseException:
        if process is not None:
            process.kill()
            process.communicate()
        raise
    if process is not None:
        _, said = process.communicate()
        if process.returncode:
            raise RunFailed(f"ffmpeg failed: {said.decode(errors='replace').strip()}")


def _ogv(path: Path, pictures: Iterable[NDArray[np.uint8]], rate: int) -> None:
    import pyvista
    from vtkmodules.vtkIOOggTheora import vtkOggTheoraWriter

    writer: Any = vtkOggTheoraWriter()
    writer.SetFileName(str(path))
    writer.SetRate(rate)
    writer.SetQuality(2)
    for i, picture in enumerate(pictures):
        height, width, _ = picture.shape
        image = pyvista.ImageData(dimensions=(width, height, 1))
        image.point_data.active_scalars_name = None
        image.point_data["rgb"] = picture[::-1].reshape(-1, 3)
        image.point_data.active_scalars_name = "rgb"
        writer.SetInputData(image)
        if i == 0:
            writer.Start()
        writer.Write()
    writer.End()
