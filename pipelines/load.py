"""Read a result folder back: times, histories, arrays and pyvista meshes; files are opened when asked for."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.history import FILE as HISTORY
from zrno.pipelines.history import read_history
from zrno.pipelines.manifest import FILE as MANIFEST
from zrno.pipelines.manifest import read_manifest
from zrno.pipelines.quantities import unknown
from zrno.pipelines.series import read_list
from zrno.translators.text import Fault, InputError


def load(directory: Path | str) -> Result:
    """A result folder, of a finished, running or killed run. Raises InputError where it is none."""
    where = Path(directory)
    if not where.is_dir() or not any((where / name).exists() for name in (MANIFEST, HISTORY, "particles.pvd")):
        message = "not a result folder" if where.exists() else "no such folder"
        expected = f"a folder with {MANIFEST}, {HISTORY} or particles.pvd, as run writes it"
        raise InputError([Fault(str(where), 1, 1, message, expected=expected)])
    return Result(where)


class Result:
    """What a run left. Series: "particles" and one a material ("mat01_steel"); index: of a frame, -1 the last."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """run.json; empty where there is none."""
        path = self.directory / MANIFEST
        return read_manifest(path) if path.exists() else {}

    @property
    def title(self) -> str:
        """The title of the scene or deck."""
        return str(self.manifest.get("title") or "")

    @property
    def units(self) -> str | None:
        """The consistent system of units ("mm-ms-g"), None where the run did not say."""
        return self.manifest.get("units")

    @property
    def dimension(self) -> int:
        """1, 2 (plane strain) or 3; 3 where the run did not say."""
        return int(self.manifest.get("dimension") or 3)

    @property
    def axisymmetric(self) -> bool:
        """Whether x is the distance from the axis; masses, energies and forces are then those of whole rings."""
        return bool(self.manifest.get("axisymmetric"))

    @cached_property
    def _history(self) -> tuple[dict[str, NDArray[Any]], dict[str, str]]:
        path = self.directory / HISTORY
        return read_history(path) if path.exists() else ({}, {})

    @property
    def history(self) -> dict[str, NDArray[Any]]:
        """Columns of history.csv by name, shape (rows,)."""
        return self._history[0]

    @property
    def history_units(self) -> dict[str, str]:
        """Units of the history's columns, where they are known."""
        return self._history[1]

    @cached_property
    def _frames(self) -> dict[str, list[tuple[float, str]]]:
        return {path.stem: read_list(path) for path in sorted(self.directory.glob("*.pvd"))}

    @property
    def series(self) -> list[str]:
        """Names of the series, sorted."""
        return list(self._frames)

    @property
    def times(self) -> NDArray[np.float64]:
        """Times of the frames, shape (frames,): those that every series has (a killed run may lack one in some)."""
        count = min((len(frames) for frames in self._frames.values()), default=0)
        frames = next(iter(self._frames.values()), [])
        return np.array([time for time, _ in frames[:count]], float)

    def mesh(self, name: str = "particles", index: int = -1) -> Any:
        """A frame as a pyvista mesh. Raises ValueError for a series, IndexError for a frame that is not there."""
        import pyvista

        if name not in self._frames:
            raise ValueError(unknown("series", name, self.series))
        count = len(self.times)
        if not -count <= index < count:
            raise IndexError(f"no frame {index}; there are {count}")
        return pyvista.read(self.directory / self._frames[name][index % count][1])

    @property
    def whole(self) -> list[str]:
        """The series of all that there is: "particles", "elements" or both."""
        return [name for name in ("elements", "particles") if name in self._frames]

    def arrays(self, name: str | None = None, index: int = -1) -> dict[str, NDArray[Any]]:
        """The point arrays of a frame by name, `position` (n, 3) with them: of particles where there are any, else of
        nodes."""
        mesh = self.mesh(name or (self.whole or ["particles"])[-1], index)
        return {"position": np.asarray(mesh.points)} | {
            key: np.asarray(mesh.point_data[key]) for key in mesh.point_data
        }
