"""Series: what is listed is there and readable, at any moment; resumed runs leave the frames of unbroken ones."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.series import ResultSeries, Series, read_list, series_name, slug

MATERIALS = {1: "Aluminium 6061", 2: "šljiva / zrno", 3: "structure"}


def contents(directory: Path) -> dict[str, bytes]:
    return {str(p.relative_to(directory)): p.read_bytes() for p in directory.rglob("*") if p.is_file()}


def test_one_series_a_material_that_has_particles_and_one_of_all(tmp_path: Path, solver: Any, drive: Any) -> None:
    import pyvista

    drive(solver, [ResultSeries(tmp_path, MATERIALS, interval=0.1)], 3)
    names = sorted(p.stem for p in tmp_path.glob("*.pvd"))
    assert names == ["mat01_aluminium-6061", "mat02_sljiva-zrno", "particles"]
    sizes = {}
    for name in names:
        reader = pyvista.get_reader(tmp_path / f"{name}.pvd")
        assert reader.time_values == [0.0, 0.1, 0.2, 3 * 0.1]
        reader.set_active_time_value(0.2)
        sizes[name] = reader.read()[0].n_points
    assert sizes == {"mat01_aluminium-6061": 20, "mat02_sljiva-zrno": 20, "particles": 40}
    second = pyvista.read(tmp_path / "vtk" / "mat02_sljiva-zrno_00003.vtp")
    np.testing.assert_array_equal(second["id"], np.arange(21, 41))
    np.testing.assert_allclose(second["velocity"][:, 0], -0.5)


@pytest.mark.parametrize("scattered", [False, True])
def test_particles_of_a_material_may_be_anywhere(tmp_path: Path, solver: Any, drive: Any, scattered: bool) -> None:
    import pyvista

    if scattered:
        solver.material = solver.material[::-1].copy()
        solver.material[3] = 1
    drive(solver, [ResultSeries(tmp_path, MATERIALS, interval=0.1)], 0)
    ids = pyvista.read(tmp_path / "vtk" / "mat01_aluminium-6061_00000.vtp")["id"]
    np.testing.assert_array_equal(ids, 1 + np.flatnonzero(solver.material == 1))


@pytest.mark.parametrize("format", ["vtp", "vtk", "vtkhdf"])
def test_a_resumed_run_leaves_the_files_of_an_unbroken_one(
    tmp_path: Path, solver: Any, drive: Any, format: Any
) -> None:
    drive(solver, [ResultSeries(tmp_path / "whole", MATERIALS, interval=0.1, format=format)], 6)
    broken, again = type(solver)(), type(solver)()
    drive(broken, [ResultSeries(tmp_path / "broken", MATERIALS, interval=0.1, format=format)], 4, finish=False)
    (tmp_path / "broken" / "vtk" / ".4711.particles_00005.vtp").write_bytes(b"half a frame")
    again.step = 2  # the checkpoint's: frames 3 and 4 are made again, frame 2 is not
    drive(again, [ResultSeries(tmp_path / "broken", MATERIALS, interval=0.1, format=format, resume=True)], 4)
    whole, resumed = contents(tmp_path / "whole"), contents(tmp_path / "broken")
    assert whole.keys() == resumed.keys()
    if format != "vtkhdf":  # HDF5 notes times of its own
        assert whole == resumed


def test_a_resume_between_two_frames_adds_none(tmp_path: Path, solver: Any) -> None:
    series = ResultSeries(tmp_path, MATERIALS, interval=0.3)
    series.start(solver)
    solver.step = 2
    ResultSeries(tmp_path, MATERIALS, interval=0.3, resume=True).start(solver)
    assert Series(tmp_path, "particles").times == [0.0]


def test_a_new_run_in_an_old_folder_begins_anew(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [ResultSeries(tmp_path, MATERIALS, interval=0.1)], 5)
    drive(type(solver)(), [ResultSeries(tmp_path, MATERIALS, interval=0.1)], 1)
    assert Series(tmp_path, "particles").times == [0.0, 0.1]
    assert len(list((tmp_path / "vtk").iterdir())) == 3 * 2


def test_slugs_are_safe_file_names() -> None:
    assert slug("../..//etc/Čelik №5\n") == "etc-celik-no5"
    assert slug("x" * 99) == "x" * 40
    assert series_name(7, "***") == "mat07"
    assert series_name(123, "a b") == "mat123_a-b"


def test_a_list_that_is_none_is_named(tmp_path: Path) -> None:
    (tmp_path / "a.pvd").write_text("<VTKFile><Collection><DataSet")
    with pytest.raises(ValueError, match=r"a\.pvd is not a list of frames"):
        read_list(tmp_path / "a.pvd")


WRITER = """
import sys
import numpy as np
from zrno.pipelines.series import Series
from zrno.solvers.frame import Frame

series = Series(sys.argv[1], "particles")
step = 0
while True:
    n = 20_000
    series.write(Frame(float(step), step, {"position": np.full((n, 3), step), "id": np.arange(n)}))
    step += 1
"""


def test_a_killed_run_leaves_a_readable_series(tmp_path: Path) -> None:
    import pyvista

    child = subprocess.Popen([sys.executable, "-c", WRITER, str(tmp_path)])
    try:
        listed = tmp_path / "particles.pvd"
        deadline = time.monotonic() + 60
        while not listed.exists() or len(read_list(listed)) < 20:  # read while it is being written, too
            assert child.poll() is None
            assert time.monotonic() < deadline
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
    reader = pyvista.get_reader(listed)
    assert len(reader.time_values) >= 20
    for value in reader.time_values:
        reader.set_active_time_value(value)
        mesh = reader.read()[0]
        assert mesh.n_points == 20_000
        assert (mesh.points == value).all()
