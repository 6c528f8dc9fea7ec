"""Measures of frames, against bodies whose measures are known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from zrno.pipelines.measures import MEASURES, Cloud, evaluate, parameters
from zrno.pipelines.signals import Unmeasured

SPACING = 0.5


def cloud(x: Any, *, dimension: int = 3, material: Any = 1, velocity: Any = (0.0, 0.0, 0.0), **fields: Any) -> Cloud:
    """Particles at positions, each a cell of SPACING, of density 2."""
    x = np.asarray(x, float)
    n = len(x)
    arrays = {
        "position": x,
        "mass": np.full(n, 2.0 * SPACING**dimension),
        "density": np.full(n, 2.0),
        "material": np.broadcast_to(material, n).copy(),
        "velocity": np.broadcast_to(np.asarray(velocity, float), (n, 3)).copy(),
        **fields,
    }
    return Cloud(arrays, dimension)


def block(*sides: int) -> np.ndarray:
    """A block of cells with one corner at the origin, shape (n, 3)."""
    grid = np.stack(np.meshgrid(*[np.arange(n) for n in (*sides, 1, 1, 1)[:3]], indexing="ij"), -1).reshape(-1, 3)
    x = (grid + 0.5) * SPACING
    x[:, len(sides) :] = 0.0
    return np.asarray(x)


def of(measure: str, now: Cloud, start: Cloud | None = None, **given: Any) -> Any:
    return evaluate(measure, now, start or now, given)


@pytest.mark.parametrize("sides", [(6,), (6, 4), (6, 4, 2)])
def test_extents_of_a_block(sides: tuple[int, ...]) -> None:
    now = cloud(block(*sides) - 1.0, dimension=len(sides))
    for axis, n in zip("xyz", sides, strict=False):
        assert of("length", now, axis=axis) == pytest.approx(n * SPACING)
        assert of("back", now, axis=axis) == pytest.approx(-1.0)
        assert of("front", now, axis=axis) == pytest.approx(n * SPACING - 1.0)
        assert of("centre", now, axis=axis) == pytest.approx(0.5 * n * SPACING - 1.0)


def test_a_front_holds_a_share_of_the_mass() -> None:
    now = cloud(block(100, 2), dimension=2)
    assert of("front", now, axis="x", fraction=0.9) == pytest.approx(90 * SPACING)
    assert of("back", now, axis="x", fraction=0.9) == pytest.approx(10 * SPACING)


def test_a_toe_is_where_the_heap_becomes_shallow() -> None:
    """A layer of one cell under steps of three: however long the layer is, the toe at a depth of two stays."""
    for long in (30, 60):
        now = cloud(np.concatenate([block(long, 1), np.array([0.0, SPACING, 0.0]) + block(20, 2)]), dimension=2)
        assert of("toe", now, axis="x", depth=1.0, window=1.0) == pytest.approx(20 * SPACING, abs=0.02)
        assert of("toe", now, axis="x", depth=0.25, window=1.0) == pytest.approx(long * SPACING, abs=0.02)
    with pytest.raises(ValueError, match="nowhere 2 deep"):
        of("toe", now, axis="x", depth=2.0, window=1.0)


def test_a_round_toe_counts_the_volume_by_the_floor_of_its_sector() -> None:
    x = block(40, 40, 2)
    quarter = cloud(x[np.hypot(x[:, 0], x[:, 1]) < 20.0])
    given = {"axis": "z", "about": [0, 0, 0], "window": 1.0}
    assert of("toe", quarter, depth=0.5, sector=90.0, **given) == pytest.approx(20.0, abs=0.25)
    with pytest.raises(ValueError, match="nowhere"):
        of("toe", quarter, depth=0.5, **given)  # over the whole circle it is a quarter as deep


def test_a_stray_grain_is_no_part_of_the_heap() -> None:
    x = np.concatenate([block(6, 4), [[50.0, 60.0, 0.0]]])
    now = cloud(x, dimension=2)
    assert of("front", now, axis="x") == pytest.approx(50.0 + SPACING / 2)
    assert of("front", now, axis="x", heap=True) == pytest.approx(6 * SPACING)
    assert of("radius", now, axis="z", about=(0, 0, 0), heap=True) == pytest.approx(np.hypot(2.75, 1.75) + SPACING / 2)


def test_clusters_are_counted_with_the_strays() -> None:
    x = np.concatenate((block(4, 3), block(2, 2) + np.array([9 * SPACING, 0.0, 0.0]), [[0.0, 9.0, 0.0]]))
    now = cloud(x, dimension=2)
    assert of("clusters", now) == 3
    assert of("clusters", now, link=7.0) == 2  # over the gap of six cells
    assert of("clusters", cloud(block(4, 3)[::2] * 1.6, dimension=2), link=1.5) > 1


def test_radii_of_a_ring() -> None:
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.concatenate([r * np.stack([np.cos(angle), 0 * angle, np.sin(angle)], 1) for r in (4.0, 4.5, 5.0)])
    now = cloud(ring + np.array([1.0, 7.0, 2.0]))
    about = {"axis": "y", "about": (1.0, -3.0, 2.0)}
    assert of("inner_radius", now, **about) == pytest.approx(4.0 - SPACING / 2)
    assert of("radius", now, **about) == pytest.approx(5.0 + SPACING / 2)
    assert of("radius", now, fraction=0.5, **about) == pytest.approx(4.5 + SPACING / 2)


def test_one_material_alone() -> None:
    x = np.concatenate([block(4, 4), block(2, 2) + np.array([10.0, 0, 0])])
    now = cloud(x, dimension=2, material=np.repeat([1, 7], [16, 4]), pressure=np.repeat([3.0, 5.0], [16, 4]))
    assert of("length", now, axis="x", material=7) == pytest.approx(2 * SPACING)
    assert of("mean", now, field="pressure", material=1) == 3.0
    assert of("mean", now, field="pressure") == pytest.approx(0.8 * 3 + 0.2 * 5)
    assert (of("max", now, field="pressure"), of("min", now, field="pressure")) == (5.0, 3.0)
    with pytest.raises(ValueError, match="no material 3; there are: 1, 7"):
        of("length", now, axis="x", material=3)
    with pytest.raises(ValueError, match="no field heat"):
        of("mean", now, field="heat")


def test_restitution_off_a_wall_and_off_a_body() -> None:
    two = np.array([[0.0, 0, 0], [1.0, 0, 0]])
    start = cloud(two, material=[1, 2], velocity=[[3.0, 0, 0], [-1.0, 0, 0]])
    end = cloud(two, material=[1, 2], velocity=[[-1.5, 0, 0], [0.5, 0, 0]])
    assert of("speed", end, axis="x") == -0.5
    assert of("restitution", end, start, axis="x", material=1) == 0.5
    assert of("restitution", end, start, axis="x", material=1, against=2) == 0.5
    with pytest.raises(Unmeasured, match="do not move"):
        of("restitution", end, start, axis="y", material=1)


def test_a_profile_keeps_a_linear_field() -> None:
    x = block(3, 40)
    now = cloud(x, dimension=2, pressure=7.0 - 2.0 * x[:, 1])
    for bins in (7, 40):
        y, pressure = of("profile", now, axis="y", field="pressure", bins=bins)
        assert len(y) == bins
        assert pressure == pytest.approx(7.0 - 2.0 * y)


def test_parameters_are_those_of_the_functions() -> None:
    assert parameters("length") == {"material": False, "axis": True}
    assert parameters("restitution") == {"material": True, "axis": True, "against": False}
    assert all(parameters(name)["material"] in (True, False) for name in MEASURES)


def test_the_mass_between_two_heights_is_that_of_the_layers_there() -> None:
    now = cloud(block(2, 3, 6))
    layer = 2 * 3 * 2.0 * SPACING**3
    assert of("mass", now, axis="z") == pytest.approx(6 * layer)
    assert of("mass", now, axis="z", above=SPACING) == pytest.approx(5 * layer)
    assert of("mass", now, axis="z", above=SPACING, below=4 * SPACING) == pytest.approx(3 * layer)
