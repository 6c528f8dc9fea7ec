from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from zrno.translators import read
from zrno.translators.model import ElementBlock, Model, Part
from zrno.translators.particles import copy_nodes, default_spacing, fill


def rectangles(*boxes: tuple[float, float, float, float]) -> Model:
    """A flat mesh of one quad4 a rectangle (x0, y0, x1, y1), each a part."""
    xyz = [(x, y, 0.0) for x0, y0, x1, y1 in boxes for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    count = len(boxes)
    block = ElementBlock("quad4", np.arange(count) + 1, np.arange(4 * count).reshape(-1, 4), np.arange(count) + 1)
    parts = {i: Part(i, f"part{i}", dimension=2) for i in range(1, count + 1)}
    return Model(dimension=2, xyz=np.array(xyz), blocks=[block], parts=parts)


def tetrahedra() -> Model:
    """A cube of two parts that meet on its diagonal plane: two wedges."""
    xyz = np.array([(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
    nodes = np.array([(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)])
    return Model(
        xyz=xyz,
        blocks=[ElementBlock("wedge6", np.array([1, 2]), nodes, np.array([1, 2]))],
        parts={1: Part(1, "below"), 2: Part(2, "above")},
    )


def test_a_rectangle_is_a_whole_number_of_cells() -> None:
    filling = fill(rectangles((-3, -0.5, 0, 0.5)), 0.0333)  # 1/30 in three digits
    assert len(filling.x) == 90 * 30
    assert filling.x[0] == pytest.approx([-3 + 1 / 60, -0.5 + 1 / 60, 0], rel=1e-14)
    assert filling.spacing[1] == pytest.approx(1 / 30, rel=1e-12)
    assert filling.volume.sum() == pytest.approx(3.0, rel=1e-12)
    assert np.ptp(filling.volume) == 0


def test_the_spacing_differs_by_direction_where_it_must() -> None:
    filling = fill(rectangles((0, 0, 1, 0.5)), 0.3)
    assert np.unique(filling.x[:, 0]) == pytest.approx([1 / 6, 1 / 2, 5 / 6])
    assert np.unique(filling.x[:, 1]) == pytest.approx([1 / 8, 3 / 8])
    assert filling.spacing[1] == pytest.approx(math.sqrt(0.25 / 3))


def test_touching_bodies_are_one_spacing_apart() -> None:
    filling = fill(rectangles((-1, 0, 0, 1), (0, 0, 1, 1)), 0.1)
    left, right = (filling.x[filling.part == part] for part in (1, 2))
    assert right[:, 0].min() - left[:, 0].max() == pytest.approx(0.1, rel=1e-12)


def test_coordinates_fit_a_decks_columns() -> None:
    filling = fill(rectangles((-1 / 3, -math.pi, 1 / 7, 0.1)), 0.01)
    assert max(len(repr(value)) for value in filling.x.ravel().tolist()) <= 20


def test_parts_that_share_a_face_share_no_particle() -> None:
    model = tetrahedra()
    filling = fill(model, 0.125)  # lattice points lie on the plane x = y between the parts
    assert len(np.unique(filling.x, axis=0)) == len(filling.x) == 8**3
    below, above = (filling.x[filling.part == part] for part in (1, 2))
    assert (below[:, 0] >= below[:, 1]).all()
    assert (above[:, 0] < above[:, 1]).all()
    assert filling.volumes == pytest.approx({1: 0.5, 2: 0.5}, rel=1e-12)
    for part in (1, 2):
        assert math.fsum(filling.volume[filling.part == part]) == pytest.approx(0.5, rel=1e-12)


def test_a_sphere(tmp_path: Path) -> None:
    (tmp_path / "s.geo").write_text('SetFactory("OpenCASCADE"); Sphere(1) = {1, 2, 3, 1}; Mesh.MeshSizeMax = 0.3;\n')
    model = read(tmp_path / "s.geo")
    filling = fill(model, 0.05)
    radius = np.linalg.norm(filling.x - [1, 2, 3], axis=1)
    assert radius.max() <= 1
    cell = filling.spacing[1] ** 3
    assert len(filling.x) * cell == pytest.approx(filling.volumes[1], rel=0.01)
    # every lattice point well inside is there
    assert (radius < 0.9).sum() == pytest.approx(4 / 3 * np.pi * 0.9**3 / cell, rel=0.02)


def test_curved_elements_are_filled_to_their_bulge(tmp_path: Path) -> None:
    (tmp_path / "c.geo").write_text(
        'SetFactory("OpenCASCADE"); Disk(1) = {0, 0, 0, 1}; Mesh.MeshSizeMax = 0.4; Mesh.ElementOrder = 2;\n'
    )
    filling = fill(read(tmp_path / "c.geo"), 0.02)
    assert filling.volumes[1] == pytest.approx(np.pi, rel=2e-3)
    assert len(filling.x) * 0.02**2 == pytest.approx(np.pi, rel=0.01)
    assert np.linalg.norm(filling.x, axis=1).max() < 1.0


@pytest.mark.parametrize("name", ["gen_slab_22a_o2", "gen_slab_41a"])
def test_hexahedra_of_both_orders_fill_alike(shared: Path, name: str) -> None:
    filling = fill(read(shared / "samples/msh" / f"{name}.msh"), 0.1)
    assert len(filling.x) == 20 * 10 * 10
    assert math.fsum(filling.volume) == pytest.approx(2.0, rel=1e-12)


def test_chosen_parts_and_the_default_spacing() -> None:
    model = rectangles((0, 0, 1, 1), (2, 0, 4, 2))
    assert default_spacing(model, [2]) == 2.0
    assert set(fill(model, 0.5, parts=[2]).part.tolist()) == {2}
    with pytest.raises(ValueError, match="no part 7 with elements; it has: 1 part1, 2 part2"):
        fill(model, 0.5, parts=[7])


def test_what_cannot_be_filled() -> None:
    model = rectangles((0, 0, 1, 1))
    for spacing in (0.0, -1.0, float("nan")):
        with pytest.raises(ValueError, match="expected a positive length"):
            fill(model, spacing)
    model.xyz[2, 2] = 0.5
    model.dimension = 3
    with pytest.raises(ValueError, match="part part1 is made of quad4"):
        fill(model, 0.1)
    with pytest.raises(ValueError, match="no part to make particles of"):
        fill(Model(), 0.1)


def test_nodes_carry_their_elements_volume() -> None:
    model = tetrahedra()
    nodes = copy_nodes(model)
    assert len(nodes.x) == 8
    assert {part: math.fsum(nodes.volume[nodes.part == part]) for part in (1, 2)} == pytest.approx({1: 0.5, 2: 0.5})
    assert (nodes.part == 2).sum() == 2  # the shared nodes are the first part's
    alone = copy_nodes(model, [2])
    assert len(alone.x) == 6
    assert alone.volume == pytest.approx(np.full(6, 0.5 / 6))


def test_a_part_without_nodes_of_its_own() -> None:
    model = rectangles((0, 0, 1, 1), (0, 0, 1, 1))
    model.blocks[0].nodes[1] = model.blocks[0].nodes[0]
    with pytest.raises(ValueError, match="part part2: all its nodes belong to earlier parts"):
        copy_nodes(model)
