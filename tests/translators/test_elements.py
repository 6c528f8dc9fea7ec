from __future__ import annotations

import numpy as np
import pytest

from zrno.translators.elements import BY_GMSH, BY_MESHIO, TABLE


@pytest.mark.parametrize("element", TABLE.values(), ids=lambda e: e.name)
def test_node_counts_follow_from_the_shape(element) -> None:
    shape = element.shape
    quads = sum(len(face) == 4 for face in shape.faces) if shape.dimension == 3 else int(shape.corners == 4)
    count = shape.corners + element.mid_edges * len(shape.edges) + element.mid_faces * quads
    count += element.name == "hex27"  # its centre
    assert element.nodes == count
    assert sorted(element.from_gmsh) in ([], list(range(count)))


def test_numbers_are_unique() -> None:
    assert len(BY_GMSH) == len(BY_MESHIO) == len({e.vtk for e in TABLE.values()}) == len(TABLE)


@pytest.mark.parametrize("element", [e for e in TABLE.values() if e.dimension > 0], ids=lambda e: e.name)
def test_numbers_and_orders_are_gmshs(element) -> None:
    """gmsh's own reference nodes, put into our order, have mid-edge nodes where the table says."""
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        _, dimension, _, count, coordinates, corners = gmsh.model.mesh.getElementProperties(element.gmsh)
    finally:
        gmsh.finalize()
    assert (dimension, count, corners) == (element.dimension, element.nodes, element.shape.corners)
    points = np.zeros((count, 3))
    points[:, :dimension] = np.reshape(coordinates, (count, dimension))
    if element.from_gmsh:
        points = points[list(element.from_gmsh)]
    if element.mid_edges:
        for i, (a, b) in enumerate(element.shape.edges):
            assert points[corners + i] == pytest.approx((points[a] + points[b]) / 2), (a, b)
    for face in range(len(element.shape.faces) or 1):
        cycle, centre = element.face_cycle(face)
        if centre is not None:
            assert points[centre] == pytest.approx(points[list(cycle)].mean(axis=0))


@pytest.mark.parametrize("element", TABLE.values(), ids=lambda e: e.name)
def test_numbers_are_vtks(element) -> None:
    from vtkmodules.vtkCommonDataModel import vtkCellTypes, vtkGenericCell

    cell = vtkGenericCell()
    cell.SetCellType(element.vtk)
    assert cell.GetNumberOfPoints() == element.nodes, vtkCellTypes.GetClassNameFromTypeId(element.vtk)
    assert cell.GetCellDimension() == element.dimension
    assert cell.GetNumberOfFaces() == len(element.shape.faces)
    if element.dimension < 2:
        return
    for i in range(element.nodes):
        cell.GetPointIds().SetId(i, i)

    def points_of(part) -> tuple[int, ...]:
        return tuple(part.GetPointId(k) for k in range(part.GetNumberOfPoints()))

    corners = element.shape.corners
    ours = {
        (*sorted(pair), *([corners + i] if element.mid_edges else [])) for i, pair in enumerate(element.shape.edges)
    }
    vtks = [points_of(cell.GetEdge(i)) for i in range(cell.GetNumberOfEdges())]
    assert {(*sorted(edge[:2]), *edge[2:]) for edge in vtks} == ours
    faces = {frozenset(points_of(cell.GetFace(i))) for i in range(cell.GetNumberOfFaces())}
    cycles = [element.face_cycle(face) for face in range(len(element.shape.faces))]
    assert faces == {frozenset(cycle) | ({centre} - {None}) for cycle, centre in cycles}
