"""The picture of particles (spheres) and elements: colour bar, title and time; drawn off screen."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.view import Axes, Extent, aim

_EDGES = 20_000  # elements up to which their edges are drawn

FINE = 2_000_000  # particles drawn in all up to which spheres are drawn twice as fine and averaged: smooth edges
_INK = "#222222"
_GREY = "#b8bcc4"  # of what does not have the field
_HEAD = 0.085  # height of the line with title and time, as a fraction of the picture
_BAR_RIGHT = 0.13  # width of the colour bar with its numbers, beside the scene
_BAR_BELOW = 0.17  # height of the colour bar with its numbers, below a scene that is wide
_MARGIN = 0.02


@dataclass(frozen=True, slots=True)
class Scale:
    """Colour scale. ticks: ascending values with a label each, the ends among them; cmap: a matplotlib name."""

    ticks: list[float]
    cmap: str
    label: str

    @property
    def limits(self) -> tuple[float, float]:
        """The values of the first and the last colour."""
        return self.ticks[0], self.ticks[-1]


def scale_for(low: float, high: float, label: str) -> Scale:
    """A scale with round ticks that holds low..high; about zero, with two hues, where both signs matter."""
    if not (math.isfinite(low) and math.isfinite(high)):
        low, high = 0.0, 1.0
    signed = low < 0 < high and min(-low, high) > 0.1 * max(-low, high)
    if signed:
        high = max(-low, high)
        low = -high
    elif low > 0 and low < 0.5 * high:
        low = 0.0
    spread = high - low
    if spread <= 1e-6 * max(abs(low), abs(high)):  # one value, but for round-off
        spread = abs(high) or 1.0
        low, high = (0.0, spread) if low >= 0 else (-spread, 0.0)
    raw = spread / 5
    power = 10.0 ** math.floor(math.log10(raw))
    step = power * next(f for f in (1, 2, 2.5, 5, 10) if f * power >= 0.999 * raw)
    first, last = math.floor(low / step + 1e-6), math.ceil(high / step - 1e-6)
    return Scale([i * step for i in range(first, last + 1)], "coolwarm" if signed else "viridis", label)


@dataclass(frozen=True, slots=True)
class Cloud:
    """Particles to draw. points: (n, 3); radius, values: (n,)."""

    points: NDArray[Any]
    radius: NDArray[Any]
    values: NDArray[Any]


class Stage:
    """Draws frames alike: one camera, one colour scale. size: pixels; flat: without light, for scenes in a plane."""

    def __init__(
        self, size: tuple[int, int], axes: Axes, box: Extent, scale: Scale, *, title: str, flat: bool, fine: bool
    ) -> None:
        import pyvista
        from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

        self._size = size
        self._scale = scale
        self._title = title
        aspect = size[0] / size[1]
        self._wide = bool(box.size[0] > 0.9 * aspect * box.size[1])
        self._finer = 2 if fine else 1
        self._plotter = pyvista.Plotter(off_screen=True, window_size=[self._finer * n for n in size], lighting="none")
        self._plotter.background_color = pyvista.Color("white")
        headlight = pyvista.Light(light_type="headlight")
        self._plotter.add_light(headlight)

        # Spheres in a fragment shader: exact outlines and depth from one triangle each; a million in seconds.
        self._mapper = vtkOpenGLSphereMapper()
        self._mapper.SetScaleArray("radius")
        self._mapper.SetScalarModeToUsePointFieldData()
        self._mapper.SelectColorArray("shown")
        self._table = pyvista.LookupTable(scale.cmap, n_values=1024, nan_color=_GREY)
        self._table.scalar_range = scale.limits
        self._light = (1.0, 0.0) if flat else (0.35, 0.75)
        self._mapper.SetLookupTable(self._table)
        self._mapper.SetScalarRange(*scale.limits)
        self._spheres = pyvista.Actor()
        self._spheres.SetMapper(self._mapper)
        self._spheres.prop.ambient, self._spheres.prop.diffuse = self._light
        self._surface: Any = None
        self._overlay: tuple[tuple[NDArray[np.intp], ...], NDArray[np.uint8]] | None = None  # what all pictures have
        right, bottom = (_MARGIN, _BAR_BELOW) if self._wide else (_BAR_RIGHT, _MARGIN)
        free = (_MARGIN, bottom + _MARGIN, 1 - right - _MARGIN, 1 - _HEAD - _MARGIN)
        aim(self._plotter.camera, axes, box, size, free)

    def draw(self, caption: str, cloud: Cloud | None = None, mesh: Any = None) -> NDArray[np.uint8]:
        """The picture, shape (height, width, 3).

        caption: the time; mesh: elements as pyvista has them, coloured by their array "shown" (of points or cells; grey
        where they have none).
        """
        if cloud is not None:
            self._show_cloud(cloud)
        if mesh is not None:
            self._show_mesh(mesh)
        self._plotter.render()
        image = np.asarray(self._plotter.screenshot(return_img=True))
        k = self._finer
        if k > 1:
            width, height = self._size
            parts = image.reshape(height, k, width, k, 3)
            total = np.full(parts[:, 0, :, 0].shape, k * k // 2, np.uint16)
            for i, j in np.ndindex(k, k):
                total += parts[:, i, :, j]
            image = (total // (k * k)).astype(np.uint8)
        return self._annotated(image, caption)

    def _show_cloud(self, cloud: Cloud) -> None:
        import pyvista

        data = pyvista.PolyData(np.asarray(cloud.points, np.float32))
        data.point_data["radius"] = np.asarray(cloud.radius, np.float32)
        data.point_data["shown"] = np.asarray(cloud.values, np.float32)
        self._mapper.SetInputData(data)
        if self._spheres not in self._plotter.renderer.actors.values():
            self._plotter.renderer.add_actor(self._spheres)

    def _show_mesh(self, mesh: Any) -> None:
        if self._surface is not None:
            self._plotter.remove_actor(self._surface, render=False)
        coloured = "shown" in mesh.point_data or "shown" in mesh.cell_data
        surface = mesh.extract_surface(nonlinear_subdivision=1, algorithm="dataset_surface")
        self._surface = self._plotter.add_mesh(
            surface,
            scalars="shown" if coloured else None,
            cmap=self._table,
            clim=self._scale.limits,
            color=None if coloured else _GREY,
            show_scalar_bar=False,
            show_edges=mesh.n_cells <= _EDGES,
            edge_color=_INK,
            edge_opacity=0.35,
            line_width=1.5 * self._finer,
            ambient=self._light[0],
            diffuse=self._light[1],
            smooth_shading=False,
            interpolate_before_map=True,
            render_lines_as_tubes=False,
            reset_camera=False,
            render=False,
            copy_mesh=False,
        )

    def close(self) -> None:
        """Free the window."""
        self._plotter.close()

    def _annotated(self, image: NDArray[np.uint8], caption: str) -> NDArray[np.uint8]:
        """The image with title, time and colour bar."""
        if self._overlay is None:
            self._overlay = _inked(self._figure(self._lettered))
        out = image.copy()
        for where, ink in (self._overlay, _inked(self._figure(lambda figure: self._timed(figure, caption)))):
            share = ink[:, 3:].astype(np.uint16)
            out[where] = (out[where] * (255 - share) + ink[:, :3] * share + 127) // 255
        return out

    def _figure(self, draw: Callable[[Any], None]) -> Any:
        """A canvas of the picture's size with something drawn on it."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        dpi = 100.0
        width, height = self._size
        figure = Figure(figsize=(width / dpi, height / dpi), dpi=dpi, facecolor="none")
        canvas: Any = FigureCanvasAgg(figure)
        draw(figure)
        canvas.draw()
        return canvas

    @property
    def _letter(self) -> float:
        """Size of letters, in points of 1/72 inch at 100 dots an inch."""
        width, height = self._size
        return 0.72 * max(11.0, min(height / 34, width / 52))

    def _timed(self, figure: Any, caption: str) -> None:
        figure.text(0.975, 1 - _HEAD / 2, caption, fontsize=1.15 * self._letter, color=_INK, va="center", ha="right")

    def _lettered(self, figure: Any) -> None:
        """What all pictures have: title and colour bar."""
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        letter = self._letter
        figure.text(0.025, 1 - _HEAD / 2, self._title, fontsize=1.15 * letter, color=_INK, va="center")
        mappable = ScalarMappable(Normalize(*self._scale.limits), self._scale.cmap)
        place = (0.25, 0.115, 0.5, 0.028) if self._wide else (1 - _BAR_RIGHT + 0.03, 0.14, 0.018, 0.64)
        orientation = "horizontal" if self._wide else "vertical"
        bar = figure.colorbar(mappable, cax=figure.add_axes(place), orientation=orientation, ticks=self._scale.ticks)
        bar.ax.tick_params(labelsize=letter, colors=_INK, width=0.8)
        bar.ax.ticklabel_format(axis="x" if self._wide else "y", useMathText=True)
        bar.outline.set_linewidth(0.6)
        if self._wide:
            bar.set_label(self._scale.label, fontsize=letter, color=_INK)
        else:
            figure.text(0.975, 0.86, self._scale.label, fontsize=letter, color=_INK, ha="right", va="center")


def _inked(canvas: Any) -> tuple[tuple[NDArray[np.intp], ...], NDArray[np.uint8]]:
    """The pixels of a canvas that are not clear: where they are, and their colours and opacity (n, 4)."""
    drawn = np.asarray(canvas.buffer_rgba())
    where = np.nonzero(drawn[..., 3])
    return where, drawn[where]
