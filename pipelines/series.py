"""Series of frames that a visualiser opens at any moment: numbered files and the `.pvd` that lists them with times."""

from __future__ import annotations

import math
import os
import re
import unicodedata
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.observing import Solver
from zrno.pipelines.replacing import remove_left_overs
from zrno.pipelines.vtk import Format, Precision, write_points
from zrno.pipelines.vtk_cells import SUFFIX, write_cells
from zrno.solvers.frame import Frame
from zrno.translators.elements import TABLE
from zrno.translators.text import write_atomically

FOLDER = "vtk"
Rows = slice | NDArray[Any]


class Series:
    """Frames `vtk/<name>_00000.vtp` .. and `<name>.pvd` of one result folder; goes on where an earlier run stopped.

    of_cells: of elements (`.vtu` in place of `.vtp`), else of particles.

    The list is replaced after the frame stands and before a frame is deleted: it never names a file that is not there.
    """

    def __init__(
        self,
        directory: Path | str,
        name: str,
        *,
        format: Format = "vtp",
        precision: Precision = "single",
        of_cells: bool = False,
    ) -> None:
        self.directory = Path(directory)
        self.name = name
        self.format = format
        self.of_cells = of_cells
        self.precision = precision
        self._frames = read_list(self.path) if self.path.exists() else []

    @property
    def path(self) -> Path:
        """The `.pvd` file."""
        return self.directory / f"{self.name}.pvd"

    @property
    def times(self) -> list[float]:
        """Times of the frames, ascending."""
        return [time for time, _ in self._frames]

    def write(self, frame: Frame, rows: Rows = slice(None), *, twin: Series | None = None) -> None:
        """Append a frame. rows: the particles that belong to this series (a slice, mask or indices), or elements.

        twin: a series that has just written the same frame: its file is linked rather than written again.
        """
        suffix = SUFFIX[self.format] if self.of_cells else self.format
        file = f"{FOLDER}/{self.name}_{len(self._frames):05d}.{suffix}"
        (self.directory / FOLDER).mkdir(parents=True, exist_ok=True)
        if twin is not None and _linked(self.directory / twin._frames[-1][1], self.directory / file):
            pass
        elif self.of_cells:
            self._write_cells(self.directory / file, frame, rows)
        else:
            arrays = {name: values[rows] for name, values in frame.particles.items()}
            points = arrays.pop("position")
            write_points(self.directory / file, points, arrays, frame.time, format=self.format,
                         precision=self.precision)  # fmt: skip
        self._frames.append((frame.time, file))
        self._write_list()

    def _write_cells(self, path: Path, frame: Frame, rows: Rows) -> None:
        """The elements of some rows, and the nodes that they have."""
        counts = [len(cells.nodes) for cells in frame.cells]
        mine = np.zeros(sum(counts), bool)
        mine[rows] = True
        parts = np.split(mine, np.cumsum(counts)[:-1])
        chosen = [(c, p) for c, p in zip(frame.cells, parts, strict=True) if p.any()]
        used = np.zeros(len(frame.nodes["position"]), bool)
        for cells, part in chosen:
            used[cells.nodes[part]] = True
        number = np.cumsum(used) - 1
        names = [n for n in frame.cells[0].data if all(n in cells.data for cells, _ in chosen)]
        data = {name: np.concatenate([cells.data[name][part] for cells, part in chosen]) for name in names}
        nodes = {name: values[used] for name, values in frame.nodes.items()}
        points = nodes.pop("position")
        blocks = [(TABLE[cells.kind].vtk, number[cells.nodes[part]]) for cells, part in chosen]
        write_cells(path, points, blocks, nodes, data, frame.time, format=SUFFIX[self.format],
                    precision=self.precision)  # fmt: skip

    def truncate(self, time: float) -> None:
        """Drop the frames later than a time: a resumed run writes them again."""
        dropped = [file for t, file in self._frames if t > time]
        if not dropped:
            return
        self._frames = [(t, file) for t, file in self._frames if t <= time]
        if self._frames:
            self._write_list()
        else:
            self.path.unlink()
        for file in dropped:
            (self.directory / file).unlink(missing_ok=True)

    def _write_list(self) -> None:
        lines = [f'<DataSet timestep="{time!r}" part="0" file="{file}"/>\n' for time, file in self._frames]
        text = (
            '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n<Collection>\n'
            f"{''.join(lines)}</Collection>\n</VTKFile>\n"
        )
        write_atomically(self.path, [text.encode()])


def _linked(source: Path, target: Path) -> bool:
    """Whether a second name could be given to a file, in place of what has it; some disks know no such thing."""
    try:
        target.unlink(missing_ok=True)
        os.link(source, target)
    except OSError:
        return False
    return True


def read_list(path: Path) -> list[tuple[float, str]]:
    """Time and file (relative to the list) of each frame of a `.pvd`. Raises ValueError when it is not one."""
    try:
        items = ElementTree.parse(path).iter("DataSet")
        return [(float(item.attrib["timestep"]), item.attrib["file"]) for item in items]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise ValueError(f"{path} is not a list of frames (.pvd): {error}") from error


def slug(text: str) -> str:
    """A material's name as part of a file name: ASCII letters, digits and dashes, at most 40."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9]+", "-", plain).strip("-")[:40].strip("-").lower()


def series_name(material: int, name: str) -> str:
    """`mat01_aluminium`; `mat01` where the name has no letter that a file may carry."""
    said = slug(name)
    return f"mat{material:02d}_{said}" if said else f"mat{material:02d}"


class ResultSeries:
    """Observer: a series for each material, and `particles` or `elements` of all; all have the same times.

    materials: name by material number, of all materials of the deck; interval: simulated time between frames, None for
    each of a solver's steps that `wanted` has (all without it); resume: go on with the frames up to the solver's time,
    else begin anew.
    """

    exact = True

    def __init__(
        self,
        directory: Path | str,
        materials: Mapping[int, str],
        *,
        interval: float | None,
        format: Format = "vtp",
        precision: Precision = "single",
        resume: bool = False,
        wanted: Callable[[int], bool] | None = None,
    ) -> None:
        self.interval = interval
        self._wanted = wanted
        self._materials = materials
        self._resume = resume
        self._directory = Path(directory)
        self._options: dict[str, Any] = {"format": format, "precision": precision}
        self._series: list[tuple[Series, Rows]] = []
        self._counts: dict[bool, int] = {}

    def start(self, solver: Solver) -> None:
        """The first frame; after a resume only where there is none, so that times are those of an unbroken run."""
        remove_left_overs(self._directory / FOLDER)
        frame = solver.frame()
        of: dict[bool, Any] = {}
        if frame.particles:
            of[False] = frame.particles["material"]
        if frame.cells:
            of[True] = np.concatenate([cells.data["material"] for cells in frame.cells])
        self._counts = {cells: len(material) for cells, material in of.items()}
        self._series = [
            (Series(self._directory, name, of_cells=cells, **self._options), rows)
            for cells, material in of.items()
            for name, rows in _rows_of(material, self._materials, "elements" if cells else "particles").items()
        ]
        for series, _ in self._series:
            series.truncate(solver.time if self._resume else -math.inf)
        if not all(series.times for series, _ in self._series):
            self._write(frame)

    def observe(self, solver: Solver) -> None:
        """A frame, unless this time has one."""
        if self._wanted is not None and not self._wanted(solver.step):
            return
        if any(solver.time not in series.times[-1:] for series, _ in self._series):
            self._write(solver.frame())

    def finish(self, solver: Solver) -> None:
        """The last frame, wherever the run ended."""
        if any(solver.time not in series.times[-1:] for series, _ in self._series):
            self._write(solver.frame())

    def _write(self, frame: Frame) -> None:
        written: dict[tuple[bool, int], Series] = {}
        for series, rows in self._series:
            if frame.time in series.times[-1:]:
                continue
            whole = series.of_cells, self._counts[series.of_cells]
            alone = isinstance(rows, slice) and rows in (slice(None), slice(0, whole[1]))
            series.write(frame, rows, twin=written.get(whole) if alone else None)
            if alone:
                written[whole] = series


def _rows_of(material: NDArray[Any], names: Mapping[int, str], together: str) -> dict[str, Rows]:
    """The particles or elements of each series. material: number of each, shape (n,); together: the name of all."""
    rows: dict[str, Rows] = {}
    for number, name in sorted(names.items()):
        found = np.flatnonzero(material == number)
        if len(found):
            block = int(found[-1]) - int(found[0]) + 1 == len(found)
            rows[series_name(number, name)] = slice(int(found[0]), int(found[-1]) + 1) if block else found
    rows[together] = slice(None)
    return rows
