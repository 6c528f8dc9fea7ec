"""Elements in VTK's files: XML `.vtu` (default), legacy `.vtk`, `.vtkhdf`; one file a frame, whole or not at all.

Source: VTK file formats, docs.vtk.org/en/latest/vtk_file_formats (XML appended raw; legacy 3.0; VTKHDF 2.0).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines import vtk
from zrno.pipelines.replacing import replacing

Format = Literal["vtu", "vtk", "vtkhdf"]
Array = NDArray[Any]
SUFFIX: dict[str, Format] = {"vtp": "vtu", "vtk": "vtk", "vtkhdf": "vtkhdf"}  # of the elements, by the particles'


def write_cells(
    path: Path | str,
    points: Array,
    blocks: Sequence[tuple[int, Array]],
    point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array],
    time: float,
    *,
    format: Format = "vtu",
    precision: vtk.Precision = "single",
) -> None:
    """Write elements with their arrays.

    points: (n, 3); blocks: VTK's cell type and nodes (e, k) of each kind; point_data: (n, ...) by name; cell_data: (all
    elements in the order of the blocks, ...). Raises ValueError where an array has another number of rows.
    """
    count = sum(len(nodes) for _, nodes in blocks)
    for rows, arrays in ((len(points), point_data), (count, cell_data)):
        for name, values in arrays.items():
            if values.ndim not in (1, 2) or len(values) != rows:
                raise ValueError(f"{name} has the shape {values.shape}, expected ({rows},) or ({rows}, k)")
    widths = np.concatenate([np.full(len(nodes), nodes.shape[1]) for _, nodes in blocks])
    mesh = {
        "connectivity": np.concatenate([np.asarray(nodes).ravel() for _, nodes in blocks]),
        "offsets": np.cumsum(widths),
        "types": np.concatenate([np.full(len(nodes), kind, np.uint8) for kind, nodes in blocks]),
    }
    with replacing(path) as temporary:
        _WRITERS[format](temporary, points, mesh, point_data, cell_data, float(time), precision)


def _types(arrays: Mapping[str, Array], precision: vtk.Precision) -> dict[str, str]:
    real = "f4" if precision == "single" else "f8"
    return {name: real if v.dtype.kind == "f" else vtk.integer_type(v) for name, v in arrays.items()}


def _write_vtu(
    path: Path, points: Array, mesh: Mapping[str, Array], point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array], time: float, precision: vtk.Precision,
) -> None:  # fmt: skip
    data: list[bytes | tuple[Array, str]] = []
    offset = 0

    def declared(name: str, values: Array, dtype: str) -> str:
        nonlocal offset
        size = values.size * np.dtype(dtype).itemsize
        width = values.shape[1] if values.ndim == 2 else 1
        data.extend((np.array(size, "<u8").tobytes(), (values, f"<{dtype}")))
        text = (
            f'<DataArray type="{vtk.XML_TYPES[dtype]}" Name={quoteattr(name)} NumberOfComponents="{width}" '
            f'format="appended" offset="{offset}"/>\n'
        )
        offset += 8 + size
        return text

    def all_of(arrays: Mapping[str, Array]) -> str:
        types = _types(arrays, precision)
        return "".join(declared(name, values, types[name]) for name, values in arrays.items())

    real = "f4" if precision == "single" else "f8"
    index = vtk.integer_type(mesh["connectivity"])
    header = (
        '<?xml version="1.0"?>\n'
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
        "<UnstructuredGrid>\n"
        f'<FieldData>\n<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{time!r}'
        "</DataArray>\n</FieldData>\n"
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(mesh["types"])}">\n'
        f"<Points>\n{declared('Points', points, real)}</Points>\n"
        f"<Cells>\n{declared('connectivity', mesh['connectivity'], index)}"
        f"{declared('offsets', mesh['offsets'], vtk.integer_type(mesh['offsets']))}"
        f"{declared('types', mesh['types'], 'u1')}</Cells>\n"
        f"<PointData>\n{all_of(point_data)}</PointData>\n<CellData>\n{all_of(cell_data)}</CellData>\n"
        '</Piece>\n</UnstructuredGrid>\n<AppendedData encoding="raw">\n_'
    )
    vtk.write_pieces(path, [header.encode(), *data, b"\n</AppendedData>\n</VTKFile>\n"])


def _write_legacy(
    path: Path, points: Array, mesh: Mapping[str, Array], point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array], time: float, precision: vtk.Precision,
) -> None:  # fmt: skip
    real = "f4" if precision == "single" else "f8"
    count = len(mesh["types"])
    ends = mesh["offsets"]
    widths = np.diff(ends, prepend=0)
    cells = np.insert(mesh["connectivity"], ends - widths, widths)
    pieces: list[bytes | tuple[Array, str]] = [
        b"# vtk DataFile Version 3.0\nzrno\nBINARY\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\n",
        b"TimeValue 1 1 double\n",
        (np.array([time]), ">f8"),
        f"\nPOINTS {len(points)} {vtk.LEGACY_TYPES[real]}\n".encode(),
        (points, f">{real}"),
        f"\nCELLS {count} {len(cells)}\n".encode(),
        (cells, ">i4"),
        f"\nCELL_TYPES {count}\n".encode(),
        (mesh["types"], ">i4"),
    ]
    for place, rows, arrays in (("POINT_DATA", len(points), point_data), ("CELL_DATA", count, cell_data)):
        types = _types(arrays, precision)
        pieces.append(f"\n{place} {rows}\nFIELD FieldData {len(arrays)}".encode())
        for name, values in arrays.items():
            width = values.shape[1] if values.ndim == 2 else 1
            said = f"\n{name.replace(' ', '_')} {width} {rows} {vtk.LEGACY_TYPES[types[name]]}\n"
            pieces += [said.encode(), (values, f">{types[name]}")]
    vtk.write_pieces(path, [*pieces, b"\n"])


def _write_hdf(
    path: Path, points: Array, mesh: Mapping[str, Array], point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array], time: float, precision: vtk.Precision,
) -> None:  # fmt: skip
    import h5py

    real = "f4" if precision == "single" else "f8"
    with h5py.File(path, "w") as file:  # not libver="latest": VTK's reader does not open that
        root = file.create_group("VTKHDF", track_order=True)
        root.attrs["Version"] = np.array([2, 0])
        root.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", len("UnstructuredGrid")))
        root.create_dataset("NumberOfPoints", data=np.array([len(points)]))
        root.create_dataset("NumberOfCells", data=np.array([len(mesh["types"])]))
        root.create_dataset("NumberOfConnectivityIds", data=np.array([len(mesh["connectivity"])]))
        root.create_dataset("Points", data=points, dtype=real)
        root.create_dataset("Connectivity", data=mesh["connectivity"], dtype="i8")
        root.create_dataset("Offsets", data=np.insert(mesh["offsets"], 0, 0), dtype="i8")
        root.create_dataset("Types", data=mesh["types"])
        for place, arrays in (("PointData", point_data), ("CellData", cell_data)):
            group, types = root.create_group(place), _types(arrays, precision)
            for name, values in arrays.items():
                group.create_dataset(name, data=values, dtype=types[name])
        root.create_group("FieldData").create_dataset("TimeValue", data=np.array([time]))


_WRITERS: dict[str, Any] = {"vtu": _write_vtu, "vtk": _write_legacy, "vtkhdf": _write_hdf}
