"""Pictures: what is in them is measured in their pixels; what cannot be drawn is said in words."""

from __future__ import annotations

import importlib
import os
import stat
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from zrno.pipelines import egl, movie
from zrno.pipelines.errors import Missing, RunFailed
from zrno.pipelines.manifest import Manifest
from zrno.pipelines.render import render
from zrno.pipelines.series import ResultSeries
from zrno.pipelines.stage import scale_for
from zrno.pipelines.view import axes, extent
from zrno.solvers.frame import Cells, Frame
from zrno.translators.text import InputError

SIZE = (320, 180)


@pytest.fixture
def folder(tmp_path: Path, solver: Any, drive: Any) -> Path:
    if not egl.can_draw():
        pytest.skip(f"this machine has no EGL: {egl.INSTALL}")
    where = tmp_path / "results"
    drive(solver, [ResultSeries(where, {1: "a", 2: "b"}, interval=0.1)], 2)
    Manifest(where, inputs={}, options={}, threads=1, title="Two bodies", units="mm-ms-g")
    return where


def pixels(path: Path) -> NDArray[Any]:
    from matplotlib.image import imread

    return np.asarray(imread(path))[..., :3]


def scene(image: NDArray[Any]) -> tuple[int, int, int, int]:
    """Left, right, top, bottom of what is drawn left of and under the words."""
    height, width, _ = image.shape
    part = image[int(0.1 * height) :, : int(0.85 * width)].min(axis=2) < 0.9
    rows, columns = np.flatnonzero(part.any(axis=1)), np.flatnonzero(part.any(axis=0))
    return columns[0], columns[-1], rows[0] + int(0.1 * height), rows[-1]


def test_the_last_frame_fills_the_picture(folder: Path) -> None:
    files = render(folder, size=SIZE)
    assert files == [folder / "von_mises.png"]
    image = pixels(files[0])
    assert image.shape == (180, 320, 3)
    assert (image[0, 0] == 1).all()
    left, right, top, bottom = scene(image)
    assert right - left > 0.8 * 0.82 * 320 or bottom - top > 0.8 * 0.86 * 180
    assert left > 0
    bar = image[40:150, int(0.87 * 320) :].reshape(-1, 3)
    assert len(np.unique(bar.round(2), axis=0)) > 30  # the colour bar's hues


def test_a_flat_scene_is_looked_at_straight_and_fills_the_width(tmp_path: Path, folder: Path, drive: Any) -> None:
    from zrno.solvers.frame import Frame

    class Row:
        """Twelve discs in a row of length 12."""

        time, step, dt = 0.5, 5, 0.1

        def frame(self) -> Frame:
            x = np.arange(12.0)
            position = np.stack((x, np.zeros(12), np.zeros(12)), axis=1)
            particles = {"position": position, "material": np.ones(12, int), "radius": np.full(12, 0.5)}
            return Frame(self.time, self.step, {**particles, "von_mises": x, "velocity": position})

    drive(Row(), [ResultSeries(tmp_path / "row", {1: "a"}, interval=None)], 0)
    (file,) = render(tmp_path / "row", size=(480, 270), field="velocity_x")
    image = pixels(file)
    line = image[: int(0.8 * 270), :, :].min(axis=2) < 0.9
    line[: int(0.09 * 270)] = False
    rows, columns = np.flatnonzero(line.any(axis=1)), np.flatnonzero(line.any(axis=0))
    diameter = rows[-1] - rows[0] + 1
    length = columns[-1] - columns[0] + 1
    assert length > 0.9 * 480
    assert abs(length / 12 - diameter) <= 2  # the radius is true: twelve touching discs


def test_all_frames_as_pictures_with_one_camera(folder: Path) -> None:
    files = render(folder, output=folder / "pictures" / "v.png", field="velocity", time="all", view="y", size=SIZE)
    assert [f.name for f in files] == ["v_00000.png", "v_00001.png", "v_00002.png"]
    lefts = [scene(pixels(file))[0] for file in files]
    assert lefts[0] < lefts[2]  # the left body moves right, the camera does not follow


def test_a_time_means_the_nearest_frame(folder: Path) -> None:
    near = pixels(render(folder, time="0.11", view="y", size=SIZE)[0])
    exact = pixels(render(folder, time=0.1, view="y", size=SIZE)[0])
    last = pixels(render(folder, view="y", size=SIZE)[0])
    np.testing.assert_array_equal(near, exact)
    assert (near != last).any()


def test_what_is_not_there_is_named(folder: Path) -> None:
    with pytest.raises(ValueError, match=r"no field heat; there are: .*velocity_x.*von_mises"):
        render(folder, field="heat")
    with pytest.raises(ValueError, match=r"no frame at time 7; there are 3 from 0 to 0\.2"):
        render(folder, time=7)
    with pytest.raises(ValueError, match="time is first; expected last, all or a number"):
        render(folder, time="first")
    with pytest.raises(ValueError, match="no view up; there are: iso, x, y, z, -x"):
        render(folder, view="up")
    with pytest.raises(ValueError, match="neither a picture nor a film"):
        render(folder, output=folder / "a.gif")
    with pytest.raises(ValueError, match="a picture of 10 x 10 pixels"):
        render(folder, size=(10, 10))
    for listed in folder.glob("*.pvd"):
        listed.unlink()
    with pytest.raises(InputError, match="no frames in this folder"):
        render(folder)
    assert not list(folder.glob("*.png"))


def test_without_egl_the_line_that_installs_it_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(egl, "_PROBE", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    egl.can_draw.cache_clear()
    try:
        with pytest.raises(Missing, match="apt-get install -y --no-install-recommends libegl1 libgl1-mesa-dri"):
            render(folder)
    finally:
        egl.can_draw.cache_clear()


def test_a_film_through_vtk(folder: Path) -> None:
    (file,) = render(folder, output=folder / "film.ogv", size=SIZE)
    data = file.read_bytes()
    assert data.startswith(b"OggS")
    assert b"theora" in data[:100]
    assert len(data) > 3000


def fake_ffmpeg(folder: Path, monkeypatch: pytest.MonkeyPatch, body: str) -> None:
    """A program that stands for ffmpeg: notes what it is given."""
    program = folder / "ffmpeg"
    program.write_text(f"#!{sys.executable}\nimport sys\n{body}\n")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")


def test_a_film_through_ffmpeg_gets_every_pixel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    body = "data = sys.stdin.buffer.read(); open(sys.argv[-1], 'wb').write(' '.join(sys.argv[1:]).encode() + data)"
    fake_ffmpeg(tmp_path, monkeypatch, body)
    pictures = np.random.default_rng(1).integers(0, 256, (3, 4, 6, 3), dtype=np.uint8)
    movie.write(tmp_path / "film.mp4", iter(pictures), rate=25)
    written = (tmp_path / "film.mp4").read_bytes()
    assert written.endswith(pictures.tobytes())
    assert b"-pix_fmt rgb24 -s 6x4 -r 25 -i -" in written


def test_a_film_that_fails_says_why_and_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fake_ffmpeg(tmp_path, monkeypatch, "sys.exit('Unknown encoder libx264')")
    pictures = [np.zeros((200, 300, 3), np.uint8)] * 5
    with pytest.raises(RunFailed, match="ffmpeg failed: Unknown encoder libx264"):
        movie.write(tmp_path / "film.mp4", pictures, rate=25)
    assert [p.name for p in tmp_path.iterdir()] == ["ffmpeg"]


def test_without_ffmpeg_what_to_install_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(folder))
    monkeypatch.setattr(movie, "find_spec", lambda name: None)
    with pytest.raises(Missing, match=r"\.mp4 needs ffmpeg: apt-get install .*; -o FILE\.ogv needs neither"):
        render(folder, output=folder / "film.mp4")


def test_scales_have_round_ticks_that_hold_the_values() -> None:
    assert scale_for(0.0001, 0.0029, "").ticks == pytest.approx([0, 0.001, 0.002, 0.003])
    assert scale_for(0, 100, "").ticks == pytest.approx([0, 20, 40, 60, 80, 100])
    assert scale_for(-3, 4, "").limits == (-4, 4)  # about zero where both signs matter
    assert scale_for(-0.001, 4, "").ticks[-1] == pytest.approx(4)
    assert scale_for(0, 0, "").limits == (0, 1)
    assert scale_for(7800, 7800.0001, "").limits[0] == 0  # one value, but for round-off
    assert scale_for(np.inf, -np.inf, "").limits == (0, 1)
    for low, high in ((2.6, 2.8), (1e-30, 1e-29), (-5e9, -4e9), (990, 1010)):
        first, last = scale_for(low, high, "").limits
        slack = 1e-6 * (high - low)
        assert first <= low + slack
        assert last >= high - slack


def test_views_are_right_handed_and_named_by_where_the_camera_stands() -> None:
    spread = np.array([2.0, 1.0, 1.0])
    for view in ("iso", "x", "y", "z", "-x", "-y", "-z"):
        a = axes(view, spread)
        np.testing.assert_allclose(np.cross(a.right, a.up), a.towards, atol=1e-15)
    np.testing.assert_array_equal(axes("x", spread).towards, [1, 0, 0])
    np.testing.assert_array_equal(axes("y", spread).right, [1, 0, 0])
    np.testing.assert_array_equal(axes("iso", np.array([2.0, 1.0, 0.0])).towards, [0, 0, 1])
    box = extent(np.array([[0.0, 0, 0], [2, 1, 0]]), 0.5, axes("z", spread))
    np.testing.assert_allclose(box.size, [3, 2, 1])


def test_a_direction_is_a_view() -> None:
    spread = np.array([2.0, 1.0, 1.0])
    a = axes("1,-2,0.5", spread)
    np.testing.assert_allclose(a.towards, np.array([1, -2, 0.5]) / np.linalg.norm([1, -2, 0.5]))
    np.testing.assert_allclose(np.cross(a.right, a.up), a.towards, atol=1e-15)
    assert a.up[2] > 0.0
    np.testing.assert_allclose(axes("0,0,-3", spread).up, [0, 1, 0])
    for wrong in ("0,0,0", "1,2", "1,2,nan", "inf,0,0", "up", ""):
        with pytest.raises(ValueError, match=r"or a direction as 1,-2,0\.5"):
            axes(wrong, spread)


def test_beside_elements_particles_touch_and_do_not_pass(
    tmp_path: Path, folder: Path, solver: Any, drive: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A particle whose cell lies on a plate, seen from below and from above; what lacks the field is grey."""
    one = {name: values[:1] for name, values in solver.frame().particles.items()}
    one |= {"position": np.array([[0.0, 0.0, 0.5]]), "radius": np.array([np.cbrt(0.75 / np.pi)])}
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    nodes = {"position": corners, "displacement": np.zeros((4, 3)), "warmth": np.arange(4.0)}
    plate = Cells("quad4", np.array([[0, 1, 2, 3]]), {"material": np.array([3])})
    monkeypatch.setattr(solver, "frame", lambda: Frame(0.0, 0, one, nodes, [plate]))
    where = tmp_path / "on"
    drive(solver, [ResultSeries(where, {1: "a", 3: "plate"}, interval=1.0)], 0)
    Manifest(where, inputs={}, options={}, threads=1)
    below = pixels(render(where, field="warmth", view="-z", size=SIZE)[0])
    assert np.ptp(below[60:130, 105:175], axis=2).min() > 0.2  # the plate's colours hide it
    above = pixels(render(where, field="warmth", view="z", size=SIZE)[0])
    assert np.ptp(above[90:102, 132:146], axis=2).max() < 0.1  # the ball, grey


def test_colours_of_one_alone(folder: Path) -> None:
    """The scale is of what is coloured; what is not there cannot be."""
    files = render(folder, of="particles", size=SIZE)
    assert files == [folder / "von_mises_particles.png"]
    with pytest.raises(ValueError, match="no elements to colour; there are: particles"):
        render(folder, of="elements", size=SIZE)


def test_colours_end_where_they_are_told_to(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module = importlib.import_module("zrno.pipelines.render")
    ends: list[float] = []
    monkeypatch.setattr(module, "scale_for", lambda low, high, label: ends.append(high) or scale_for(low, high, label))
    for most in (None, 0.1, -9.0):  # below the least value it says nothing
        render(folder, field="velocity_x", size=SIZE, most=most)
    assert ends[1] == 0.1
    assert ends[0] == ends[2] > 0.1
