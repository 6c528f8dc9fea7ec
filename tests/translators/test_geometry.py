from __future__ import annotations

import numpy as np
import pytest

from zrno.translators.elements import TABLE
from zrno.translators.geometry import edge_lengths, measures, simplices
from zrno.translators.model import ElementBlock

# corners of a unit element of each shape, in VTK's order, and its measure
UNIT = {
    "tri": ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], 0.5),
    "quad": ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], 1.0),
    "tet": ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], 1 / 6),
    "pyramid": ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)], 1 / 3),
    "wedge": ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)], 0.5),
    "hex": ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], 1.0),
}
SOLID = [name for name, element in TABLE.items() if element.dimension >= 2]


def straight(name: str) -> tuple[np.ndarray, float]:
    """Nodes of a straight element and its measure."""
    element = TABLE[name]
    corners, measure = UNIT[name.rstrip("0123456789")]
    xyz = np.array(corners, float)
    points = [xyz]
    if element.mid_edges:
        points.append(np.array([(xyz[a] + xyz[b]) / 2 for a, b in element.shape.edges]))
    if element.mid_faces:
        faces = element.shape.faces or ((0, 1, 2, 3),)
        points.append(np.array([xyz[list(face)].mean(axis=0) for face in faces if len(face) == 4]))
    if name == "hex27":
        points.append(xyz.mean(axis=0)[None])
    return np.concatenate(points), measure


def block(name: str) -> ElementBlock:
    return ElementBlock(name, np.array([1]), np.arange(TABLE[name].nodes)[None], np.array([1]))


def affine(points: np.ndarray, dimension: int) -> tuple[np.ndarray, float]:
    """A sheared, moved copy, and the factor on its measure."""
    matrix = np.array([[2.0, 0.3, 0.1], [0.2, 1.5, -0.4], [0.0, 0.1, 0.8]])
    matrix[2, :2] = 0 if dimension == 2 else matrix[2, :2]
    factor = np.linalg.det(matrix) if dimension == 3 else np.linalg.det(matrix[:2, :2])
    return points @ matrix.T + [1e3, -7.0, 5.0], factor


def simplex_measure(corners: np.ndarray) -> float:
    edges = corners[:, 1:] - corners[:, :1]
    if edges.shape[1] == 2:
        return float(np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum() / 2)
    return float(np.abs(np.linalg.det(edges)).sum() / 6)


@pytest.mark.parametrize("name", SOLID)
def test_measures_of_straight_elements(name: str) -> None:
    points, measure = straight(name)
    moved, factor = affine(points, TABLE[name].dimension)
    assert measures(block(name), points) == pytest.approx(measure, rel=1e-13)
    assert measures(block(name), moved) == pytest.approx(measure * factor, rel=1e-11)
    assert measures(block(name), points[:, [1, 0, 2]]) == pytest.approx(measure, rel=1e-13)  # the mirror image


@pytest.mark.parametrize("name", SOLID)
def test_simplices_fill_an_element(name: str) -> None:
    points, factor = affine(straight(name)[0], TABLE[name].dimension)
    total = sum(simplex_measure(corners) for corners in simplices(block(name), points))
    assert total == pytest.approx(straight(name)[1] * factor, rel=1e-11)


def test_the_measure_of_a_curved_element_is_its_own() -> None:
    """A triangle with one parabolic side, of height 2/3 s over the chord: area of the segment 2/3 chord x sagitta."""
    points, _ = straight("tri6")
    points[3] = (0.5, -0.1, 0.0)
    assert measures(block("tri6"), points) == pytest.approx(0.5 + 2 / 3 * 0.1, rel=1e-13)


def test_the_volume_of_a_curved_prism_is_its_own() -> None:
    points, _ = straight("wedge15")
    points[6] = (0.5, -0.1, 0.0)
    points[9] = (0.5, -0.1, 1.0)
    assert measures(block("wedge15"), points) == pytest.approx(0.5 + 2 / 3 * 0.1, rel=1e-13)


def test_a_surface_in_space_has_an_area() -> None:
    points = np.array([(0, 0, 0), (1, 0, 1), (1, 1, 1), (0, 1, 0)], float)
    assert measures(block("quad4"), points) == pytest.approx(np.sqrt(2), rel=1e-13)


def test_edges_are_those_of_the_corners() -> None:
    assert edge_lengths(block("hex27"), straight("hex27")[0]) == pytest.approx(np.ones(12))
