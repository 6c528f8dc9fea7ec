"""Meshes through meshio: every format that it reads, and .vtu as a target."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from zrno.translators.elements import BY_MESHIO, TABLE
from zrno.translators.model import ElementBlock, Model, Part
from zrno.translators.report import Report
from zrno.translators.text import Fault, InputError, read_bytes

_PART_DATA = ("part", "gmsh:physical", "medit:ref", "CellEntityIds", "cell_tags")


def read(path: Path | str) -> Model:
    """Read what meshio reads. A cell array of part numbers ("part", "medit:ref") makes the parts, else there is one."""
    read_bytes(path)
    import meshio

    try:
        mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio's readers raise anything, and exit where no format fits
        said = str(error) or type(error).__name__
        raise InputError(
            [Fault(str(path), 1, 1, f"meshio cannot read the file: {said}", expected="a known mesh")]
        ) from error
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    if not np.isfinite(points).all():
        raise InputError([Fault(str(path), 1, 1, "a node's coordinate is not finite", expected="finite coordinates")])
    model = Model(title=Path(path).stem, format="meshio", version=Path(path).suffix[1:], xyz=points)
    model.node_ids = np.arange(1, len(points) + 1)
    tags = next((mesh.cell_data[name] for name in _PART_DATA if name in mesh.cell_data), None)
    top = max((BY_MESHIO[cells.type].dimension for cells in mesh.cells if cells.type in BY_MESHIO), default=0)
    first = 1
    for i, cells in enumerate(mesh.cells):
        element = BY_MESHIO.get(cells.type)
        if element is None:
            model.warnings.append(f"{path}: {len(cells.data)} cells of type {cells.type} are left out")
            continue
        count = len(cells.data)
        part = np.zeros(count, np.int64)
        if element.dimension == top:
            part = np.ones(count, np.int64) if tags is None else np.asarray(tags[i]).astype(np.int64).ravel()
        ids = np.arange(first, first + count)
        model.blocks.append(ElementBlock(element.name, ids, np.asarray(cells.data, np.int64), part))
        first += count
        for number in np.unique(part[part != 0]).tolist():
            model.parts.setdefault(number, Part(number, dimension=top))
    flat = bool(len(points)) and bool((points[:, 2] == points[0, 2]).all())
    model.dimension = top if top in (1, 2) and flat else 3
    return model


def write(model: Model, path: Path | str) -> Report:
    """Write nodes, elements and their part numbers, or the particles of a model without elements, as .vtu."""
    import meshio

    report = Report()
    cells: list[tuple[str, Any]]
    if model.blocks:
        points = model.xyz
        cells = [(TABLE[block.kind].meshio, block.nodes) for block in model.blocks]
        cell_data = {"part": [block.part for block in model.blocks], "id": [block.ids for block in model.blocks]}
        report.drop("particles", 0 if model.particles is None else len(model.particles), "elements are written")
    elif model.particles is not None:
        points = model.particles.x
        cells = [("vertex", np.arange(len(points))[:, None])]
        cell_data = {"material": [model.particles.material], "id": [np.arange(1, len(points) + 1)]}
    else:
        raise ValueError("the model has neither elements nor particles to write")
    report.drop("node sets", len(model.node_sets), ".vtu has none")
    target = Path(path)
    temporary = target.with_name(f".{target.stem}.part{target.suffix}")
    try:
        meshio.Mesh(points, cells, cell_data=cell_data).write(temporary)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)
    return report
