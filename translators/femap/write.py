"""Writer of FEMAP neutral files, version 4.41: blocks that all versions of FEMAP and FemCon read."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from zrno.translators.femap.tables import SYSTEM_KINDS, angles_of
from zrno.translators.femap.text_out import block, line, title
from zrno.translators.femap.write_conditions import Conditions
from zrno.translators.femap.write_loads import Loads
from zrno.translators.femap.write_materials import Materials
from zrno.translators.femap.write_mesh import Mesh
from zrno.translators.lost import report_lost
from zrno.translators.model import Model
from zrno.translators.report import Report
from zrno.translators.text import write_atomically

_OF_TIME, _OF_STRESS = 1, 4  # kinds of functions
_NOWHERE = "a FEMAP neutral file has no place for it"
_SAID = {"title", "format", "version", "dimension", "node_ids", "xyz", "blocks", "parts", "sections", "materials",
         "curves", "systems", "node_sets", "element_sets", "fixed", "constraints", "equations", "nodal_loads",
         "face_loads", "body_loads", "includes", "warnings"}  # fmt: skip
_LOAD = {"kind", "nodes", "dofs", "values", "faces", "direction", "curve", "id", "name", "set", "system", "birth",
         "death", "source"}  # fmt: skip


def write(model: Model, path: Path | str) -> Report:
    """Write a model; the file appears whole or not at all.

    Returns what the file cannot say. Raises ValueError for a model that is no mesh.
    """
    if not len(model.xyz):
        raise ValueError("the model has no nodes to write")
    if not np.isfinite(model.xyz).all():
        raise ValueError("a node's coordinate is not finite")
    report = Report()
    write_atomically(path, _chunks(model, report))
    return report


def _chunks(model: Model, report: Report) -> Iterator[bytes]:
    """The file, in pieces; the report is complete after the last."""
    mesh = Mesh(model, report)
    materials = Materials(model, report)
    conditions = Conditions(model, mesh, report)
    yield from block(100, [title(model.title, report) + "4.41,\n"])
    yield from block(405, _systems(model, report))
    yield from block(420, _functions(materials, report))
    yield from block(401, materials.lines())
    yield from block(402, mesh.properties())
    yield from block(403, mesh.nodes())
    yield from block(404, mesh.elements())
    yield from block(408, conditions.group_lines())
    yield from block(406, conditions.constraint_lines())
    yield from block(407, Loads(model, mesh, report).lines())
    _report_rest(model, report)


def _systems(model: Model, report: Report) -> Iterator[str]:
    for number, system in model.systems.items():
        kind = SYSTEM_KINDS.index(system.kind)
        yield line((number, 0, kind, 60, 1)) + title(system.name, report)
        yield line(map(float, system.origin)) + line(map(float, angles_of(system.axes)))


def _functions(materials: Materials, report: Report) -> Iterator[str]:
    for number, curve in materials.curves.items():
        kind = _OF_STRESS if number in materials.of_stress else _OF_TIME
        yield line((number, kind)) + title(curve.name, report)
        yield "".join([line((i, x, y)) for i, (x, y) in enumerate(curve.points.tolist(), 1)]) + "-1,0.,0.,\n"


def _report_rest(model: Model, report: Report) -> None:
    """Fields of the model that are not written."""
    own = {"native"} if model.format == "femap" else set()
    report_lost([model], _SAID, "", _NOWHERE, report)
    report_lost(model.parts.values(), {"id", "name", "material", "dimension", "section", "source"} | own, "part",
                _NOWHERE, report)  # fmt: skip
    report_lost(model.sections.values(), {"id", "name", "kind", "parameters", "plane", "source"} | own, "section",
                _NOWHERE, report)  # fmt: skip
    said = {"id", "name", "law", "density", "parameters", "source", "tables", "curves"} | own
    report_lost(model.materials.values(), said, "material", _NOWHERE, report)
    said = {"nodes", "dofs", "id", "name", "set", "system", "source"}
    report_lost(model.constraints, said, "constraint", _NOWHERE, report)
    report_lost(model.nodal_loads, _LOAD, "load", _NOWHERE, report)
    report_lost(model.face_loads, _LOAD, "load", _NOWHERE, report)
