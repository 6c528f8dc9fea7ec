"""Every format is read back by VTK's own reader: points, arrays, types, the cell and the time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from zrno.pipelines.vtk import Format, write_points

COUNT = 300_001  # more than one chunk of rows and no multiple of it


def cloud(count: int) -> tuple[NDArray[Any], dict[str, NDArray[Any]]]:
    random = np.random.default_rng(7)
    arrays = {
        "id": np.arange(1, count + 1),
        "pressure": random.random(count) - 0.5,
        "stress": random.random((count, 6)),
        "velocity": random.random((3, count)).T,  # not contiguous, as a solver may hand it out
    }
    return random.random((count, 3)), arrays


def read(path: Path) -> Any:
    import vtkmodules.vtkIOHDF
    import vtkmodules.vtkIOLegacy
    import vtkmodules.vtkIOXML

    reader = {
        ".vtp": vtkmodules.vtkIOXML.vtkXMLPolyDataReader,
        ".vtk": vtkmodules.vtkIOLegacy.vtkPolyDataReader,
        ".vtkhdf": vtkmodules.vtkIOHDF.vtkHDFReader,
    }[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def array(attributes: Any, name: str) -> NDArray[Any]:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    found = attributes.GetArray(name)
    assert found is not None, name
    return np.asarray(vtk_to_numpy(found))


@pytest.mark.parametrize("format", ["vtp", "vtk", "vtkhdf"])
@pytest.mark.parametrize("count", [COUNT, 1, 0])
def test_single_precision_round_trip(tmp_path: Path, format: Format, count: int) -> None:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    points, arrays = cloud(count)
    path = tmp_path / f"cloud.{format}"
    write_points(path, points, arrays, 0.1 + 0.2, format=format)
    mesh = read(path)
    assert mesh.GetNumberOfPoints() == count
    assert array(mesh.GetFieldData(), "TimeValue")[0] == 0.1 + 0.2
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    if count:
        np.testing.assert_array_equal(vtk_to_numpy(mesh.GetPoints().GetData()), points.astype(np.float32))
        for name, values in arrays.items():
            got = array(mesh.GetPointData(), name)
            assert got.dtype == (np.int32 if name == "id" else np.float32)
            np.testing.assert_array_equal(got, values.astype(got.dtype))
        assert mesh.GetNumberOfVerts() == 1
        assert mesh.GetCell(0).GetNumberOfPoints() == count
        assert mesh.GetCell(0).GetPointId(count - 1) == count - 1


@pytest.mark.parametrize("format", ["vtp", "vtk", "vtkhdf"])
def test_double_precision_and_long_numbers_are_exact(tmp_path: Path, format: Format) -> None:
    points, arrays = cloud(1000)
    arrays["id"] = arrays["id"] + 2**40
    path = tmp_path / f"cloud.{format}"
    write_points(path, points, arrays, 1e-9, format=format, precision="double")
    mesh = read(path)
    for name, values in arrays.items():
        np.testing.assert_array_equal(array(mesh.GetPointData(), name), values)


def test_a_failed_frame_leaves_the_old_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    points, arrays = cloud(10)
    path = tmp_path / "cloud.vtp"
    write_points(path, points, arrays, 1.0)
    before = path.read_bytes()

    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.pwrite", full)
    with pytest.raises(OSError, match="No space"):
        write_points(path, points, arrays, 2.0)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_wrong_shapes_are_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"mass has the shape \(3,\), expected \(2,\)"):
        write_points(tmp_path / "a.vtp", np.zeros((2, 3)), {"mass": np.zeros(3)}, 0.0)
    with pytest.raises(ValueError, match=r"points have the shape \(2, 2\)"):
        write_points(tmp_path / "a.vtp", np.zeros((2, 2)), {}, 0.0)
    assert not list(tmp_path.iterdir())
