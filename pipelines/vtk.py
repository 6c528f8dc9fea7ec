"""Point clouds in VTK's files: XML `.vtp` (default), legacy `.vtk`, `.vtkhdf`; one file a frame, whole or not at all.

The cloud is one poly-vertex cell, so that ParaView shows the points as they are opened, and the time stands in the
field data as `TimeValue`. Written by hand: VTK's own writers take four times as long.
Source: VTK file formats, docs.vtk.org/en/latest/vtk_file_formats (XML appended raw; legacy 3.0; VTKHDF 2.0).
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import starmap
from pathlib import Path
from typing import Any, Literal
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.replacing import replacing

Format = Literal["vtp", "vtk", "vtkhdf"]
Precision = Literal["single", "double"]
Array = NDArray[Any]

_ROWS = 1 << 17  # rows converted and written at a time, by two threads: neither numpy nor the file holds the GIL
XML_TYPES = {"u1": "UInt8", "f4": "Float32", "f8": "Float64", "i4": "Int32", "i8": "Int64"}
LEGACY_TYPES = {"u1": "unsigned_char", "f4": "float", "f8": "double", "i4": "int", "i8": "vtktypeint64"}


def write_points(
    path: Path | str,
    points: Array,
    arrays: Mapping[str, Array],
    time: float,
    *,
    format: Format = "vtp",
    precision: Precision = "single",
) -> None:
    """Write a cloud of points and their arrays.

    points: (n, 3); arrays: (n,) or (n, k) by name; time: simulated time, in the units of the points' deck.
    precision: of real numbers; integers take 4 bytes where they fit and 8 elsewhere. Raises ValueError where an
    array's rows are not as many as the points, OSError where the file cannot be written.
    """
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points have the shape {points.shape}, expected (n, 3)")
    for name, values in arrays.items():
        if values.ndim not in (1, 2) or len(values) != len(points):
            raise ValueError(f"{name} has the shape {values.shape}, expected ({len(points)},) or ({len(points)}, k)")
    real = "f4" if precision == "single" else "f8"
    types = {name: real if values.dtype.kind == "f" else integer_type(values) for name, values in arrays.items()}
    with replacing(path) as temporary:
        _WRITERS[format](temporary, points, arrays, {"": real, **types}, float(time))


def integer_type(values: Array) -> str:
    """What whole numbers take in a file: i4 where they fit, else i8."""
    limits = np.iinfo(np.int32)
    small = not len(values) or (limits.min <= int(values.min()) and int(values.max()) <= limits.max)
    return "i4" if small else "i8"


def _components(values: Array) -> int:
    return values.shape[1] if values.ndim == 2 else 1


def write_pieces(path: Path, pieces: Sequence[bytes | tuple[Array, str]]) -> None:
    """Write texts and arrays (each with the type it takes in the file) one after the other."""
    tasks: list[tuple[Array | bytes, str, int]] = []
    offset = 0
    for piece in pieces:
        if isinstance(piece, bytes):
            tasks.append((piece, "", offset))
            offset += len(piece)
            continue
        values, dtype = piece
        row = _components(values) * np.dtype(dtype).itemsize
        for start in range(0, len(values), _ROWS):
            tasks.append((values[start : start + _ROWS], dtype, offset + start * row))
        offset += len(values) * row

    with path.open("wb", buffering=0) as out:
        file = out.fileno()

        def put(data: Array | bytes, dtype: str, at: int) -> None:
            left = (
                memoryview(data)
                if isinstance(data, bytes)
                else data.astype(dtype, order="C").reshape(-1).view("u1").data
            )
            while left:
                written = os.pwrite(file, left, at)
                left, at = left[written:], at + written

        if len(tasks) <= 2 * len(pieces):  # a small frame: threads cost more than they save
            list(starmap(put, tasks))
        else:
            with ThreadPoolExecutor(2) as pool:
                list(pool.map(lambda task: put(*task), tasks))


def _write_vtp(path: Path, points: Array, arrays: Mapping[str, Array], types: Mapping[str, str], time: float) -> None:
    count = len(points)
    index = "i4" if count < 2**31 else "i8"
    data: list[bytes | tuple[Array, str]] = []
    offset = 0

    def declared(name: str, values: Array, dtype: str) -> str:
        nonlocal offset
        size = values.size * np.dtype(dtype).itemsize
        text = (
            f'<DataArray type="{XML_TYPES[dtype]}" Name={quoteattr(name)} '
            f'NumberOfComponents="{_components(values)}" format="appended" offset="{offset}"/>\n'
        )
        data.extend((np.array(size, "<u8").tobytes(), (values, f"<{dtype}")))
        offset += 8 + size
        return text

    header = (
        '<?xml version="1.0"?>\n'
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n<PolyData>\n'
        f'<FieldData>\n<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{time!r}'
        "</DataArray>\n</FieldData>\n"
        f'<Piece NumberOfPoints="{count}" NumberOfVerts="1" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">\n'
        f"<Points>\n{declared('Points', points, types[''])}</Points>\n"
        f"<Verts>\n{declared('connectivity', np.arange(count, dtype=index), index)}"
        f"{declared('offsets', np.array([count]), index)}</Verts>\n"
        f"<PointData>\n{''.join(declared(name, values, types[name]) for name, values in arrays.items())}</PointData>\n"
        '</Piece>\n</PolyData>\n<AppendedData encoding="raw">\n_'
    )
    write_pieces(path, [header.encode(), *data, b"\n</AppendedData>\n</VTKFile>\n"])


def _write_legacy(
    path: Path, points: Array, arrays: Mapping[str, Array], types: Mapping[str, str], time: float
) -> None:
    count = len(points)
    cell = np.arange(-1, count, dtype=np.int32)
    cell[0] = count
    pieces: list[bytes | tuple[Array, str]] = [
        b"# vtk DataFile Version 3.0\nzrno\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\nTimeValue 1 1 double\n",
        (np.array([time]), ">f8"),
        f"\nPOINTS {count} {LEGACY_TYPES[types['']]}\n".encode(),
        (points, f">{types['']}"),
        f"\nVERTICES 1 {count + 1}\n".encode(),
        (cell, ">i4"),
        f"\nPOINT_DATA {count}\nFIELD FieldData {len(arrays)}".encode(),
    ]
    for name, values in arrays.items():
        said = f"\n{name.replace(' ', '_')} {_components(values)} {count} {LEGACY_TYPES[types[name]]}\n"
        pieces += [said.encode(), (values, f">{types[name]}")]
    write_pieces(path, [*pieces, b"\n"])


def _write_hdf(path: Path, points: Array, arrays: Mapping[str, Array], types: Mapping[str, str], time: float) -> None:
    import h5py

    count = len(points)
    with h5py.File(path, "w") as file:  # not libver="latest": VTK's reader does not open that
        root = file.create_group("VTKHDF", track_order=True)
        root.attrs["Version"] = np.array([2, 0])
        root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", len("PolyData")))
        root.create_dataset("NumberOfPoints", data=np.array([count]))
        root.create_dataset("Points", data=points, dtype=types[""])
        for kind in ("Vertices", "Lines", "Polygons", "Strips"):
            cells = 1 if kind == "Vertices" else 0
            group = root.create_group(kind)
            group.create_dataset("NumberOfCells", data=np.array([cells]))
            group.create_dataset("NumberOfConnectivityIds", data=np.array([cells * count]))
            group.create_dataset("Offsets", data=np.array([0, count][: cells + 1]))
            group.create_dataset("Connectivity", data=np.arange(cells * count))
        point_data = root.create_group("PointData")
        for name, values in arrays.items():
            point_data.create_dataset(name, data=values, dtype=types[name])
        root.create_group("FieldData").create_dataset("TimeValue", data=np.array([time]))


_WRITERS: dict[str, Callable[[Path, Array, Mapping[str, Array], Mapping[str, str], float], None]] = {
    "vtp": _write_vtp,
    "vtk": _write_legacy,
    "vtkhdf": _write_hdf,
}
