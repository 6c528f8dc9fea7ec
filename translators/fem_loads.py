"""Loads and motions of a mesh as a finite element deck takes them: global, each with a function of time."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from zrno.translators import held
from zrno.translators.elements import TABLE, Element
from zrno.translators.model import BodyLoad, Curve, FaceLoad, Floats, Ints, Model, NodalLoad
from zrno.translators.report import Report
from zrno.translators.settings import Settings

_PIECES = 16  # straight pieces that an interval of a velocity that changes becomes, as a displacement


def node_set(model: Model, settings: Settings, name: str) -> Ints:
    """The nodes of a set by its name or number; InputError, placed in the settings, where there is none."""
    for nodes in model.node_sets:
        if name in (nodes.name, str(nodes.id)):
            return nodes.nodes
    known = ", ".join((nodes.name or str(nodes.id)) for nodes in model.node_sets[:20]) or "none"
    settings.fault(("sets", name), "the mesh has no such set of nodes", name, f"one of: {known}")
    settings.stop()
    raise AssertionError("stopped above")


def of_settings(model: Model, settings: Settings) -> None:
    """Gravity; forces, displacements and pressure that the settings give to sets of nodes; functions that they name."""
    numbers = {}
    for name, entry in settings["functions"].items():
        numbers[name] = max(model.curves, default=0) + 1
        model.curves[numbers[name]] = Curve(numbers[name], name, np.array(entry["points"], float))
    if any(settings["gravity"]):
        model.body_loads.append(BodyLoad(tuple(settings["gravity"]), None))
    for name, entry in settings["sets"].items():
        curve = None if entry["function"] is None else numbers[entry["function"]]
        for kind in ("displacement", "force"):
            vector = entry[kind] or (None, None, None)
            for axis, value in enumerate(vector):
                if value is None or (kind == "force" and value == 0.0):
                    continue
                nodes = node_set(model, settings, name)
                dofs, values = np.full(len(nodes), axis + 1), np.full(len(nodes), float(value))
                model.nodal_loads.append(NodalLoad(kind, nodes, dofs, values, curve, name=name))
        if entry["temperature"] is not None:
            nodes = node_set(model, settings, name)
            values = np.broadcast_to(held.values_at(entry["temperature"], model.xyz[nodes], "temperature"), len(nodes))
            dofs = np.zeros(len(nodes), np.int64)
            model.nodal_loads.append(NodalLoad("temperature", nodes, dofs, values.astype(float), curve, name=name))
        if entry["pressure"] or any(entry["traction"]):
            _face_loads(model, settings, name, entry, curve)


def _face_loads(model: Model, settings: Settings, name: str, entry: Any, curve: int | None) -> None:
    """Pressure and traction of a set on the faces that lie in it."""
    found = faces_in(model, node_set(model, settings, name))
    if not found:
        message = "no face of an element has all its nodes in this set"
        settings.fault(("sets", name), message, name, "a surface of solids, shells, or an edge in the plane")
        settings.stop()
    for faces in found:
        values = np.full((len(faces), 1), 1.0)
        if entry["pressure"]:
            model.face_loads.append(FaceLoad(faces, entry["pressure"] * values, 0, curve, name=name))
        for axis, part in enumerate(entry["traction"]):
            if part:
                model.face_loads.append(FaceLoad(faces, part * values, axis + 1, curve, name=name))


def faces_in(model: Model, nodes: Ints) -> list[Ints]:
    """Faces (f, k) with all nodes in a set, each outwards: of solids those of one element alone, shells, plane edges.

    Pressure acts against the right-hand normal, so into solids, and against the normal of shells.
    """
    mine = np.zeros(len(model.xyz), bool)
    mine[nodes] = True
    by_size: dict[int, list[Ints]] = {}
    for block in model.blocks:
        element = TABLE[block.kind]
        if element.dimension == 2 and model.dimension == 2:
            corner_faces: Any = element.shape.edges
        else:
            corner_faces = [element.face_cycle(k)[0] for k in range(max(1, len(element.shape.faces)))]
        for cycle in corner_faces:
            order = list(cycle) if model.dimension == 2 else _corners_first(cycle, element)
            faces = block.nodes[:, order]
            faces = faces[mine[faces].all(axis=1)]
            if len(faces):
                by_size.setdefault(len(order), []).append(faces)
    found = []
    for pieces in by_size.values():
        faces = np.concatenate(pieces)
        _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        alone = faces[np.sort(first[count == 1])]
        if len(alone):
            found.append(alone)
    return found


def _corners_first(cycle: tuple[int, ...], element: Element) -> list[int]:
    """A face's border nodes in turn as corners, then mid-sides."""
    return list(cycle) if not element.mid_edges else [*cycle[::2], *cycle[1::2]]


def as_the_deck_says(model: Model, settings: Settings, report: Report) -> None:
    """Motions as displacements, local loads dropped, a function of time for each load, and moved nodes free."""
    end = settings["end_time"]
    loads, local = [], 0
    for load in model.nodal_loads:
        if not held.is_global(model, load.system):
            local += len(load.nodes)
            continue
        if load.birth or (load.death is not None and load.death < end):
            report.approximate(
                "loads on nodes", len(load.nodes), "act all the time: a .dat deck's have no birth or death"
            )
        loads.append(_as_displacement(model, load, end, report))
    report.drop("loads on nodes", local, "in a local system that is not along the global axes")
    model.nodal_loads = loads
    for body in model.body_loads:
        report.approximate("body loads", int(body.parts is not None), "on some parts: on all of the structure")
    model.body_loads = [replace(body, parts=None) for body in model.body_loads]
    if settings["fem"]["analysis"] != "dynamic":
        report.drop("initial velocities", len(model.initial_velocities), "the analysis is not dynamic")
        model.initial_velocities = []
    every: list[Any] = [*model.nodal_loads, *model.face_loads, *model.body_loads]
    free = [loaded for loaded in every if loaded.curve not in model.curves]
    if free:
        constant = _without_function(model, settings)
        for loaded in free:
            loaded.curve = constant
    used = {loaded.curve for loaded in every}
    report.drop("curves", len(model.curves) - len(used), "no load uses them")
    model.curves = {number: curve for number, curve in model.curves.items() if number in used}
    assert model.fixed is not None
    for load in model.nodal_loads:
        if load.kind == "displacement":
            model.fixed[load.nodes, load.dofs - 1] = False


def _without_function(model: Model, settings: Settings) -> int:
    """The number of the function of loads that have none: a ramp to 1 at the end where the load is taken in steps."""
    end = settings["end_time"]
    steps = settings["fem"]["steps"] > 1 and settings["fem"]["analysis"] == "static"
    points = [[0.0, 0.0 if steps else 1.0], [end, 1.0]]
    number = max(model.curves, default=0) + 1
    model.curves[number] = Curve(number, "ramp" if steps else "constant", np.array(points))
    return number


def _as_displacement(model: Model, load: NodalLoad, end: float, report: Report) -> NodalLoad:
    """A prescribed velocity or acceleration as the displacement that it makes."""
    times = {"velocity": 1, "acceleration": 2}.get(load.kind, 0)
    if not times:
        return load
    old = model.curves.get(-1 if load.curve is None else load.curve)
    points = np.array([[0.0, 1.0], [end, 1.0]]) if old is None else _within(old.points, end)
    exact = times == 1 and np.ptp(points[:, 1]) == 0
    for _ in range(times):
        points = _integral(points)
    number = max(model.curves, default=0) + 1
    model.curves[number] = Curve(number, f"{load.kind} integrated", points)
    report.approximate(
        f"prescribed {load.kind}", 0 if exact else len(load.nodes), "as a displacement of straight pieces in time"
    )
    return replace(load, kind="displacement", curve=number)


def _within(points: Floats, end: float) -> Floats:
    """A curve from 0 to the end, constant beyond its points."""
    t, f = points.T
    inside = (t > 0) & (t < end)
    return np.column_stack(
        [
            np.concatenate([[0.0], t[inside], [end]]),
            np.concatenate([[np.interp(0, t, f)], f[inside], [np.interp(end, t, f)]]),
        ]
    )


def _integral(points: Floats) -> Floats:
    """The integral of a piecewise linear curve, exact at the points of a finer one."""
    t, f = points.T
    if np.ptp(f) > 0:
        cuts = np.linspace(0.0, 1.0, _PIECES, endpoint=False)
        fine = np.unique(np.append((t[:-1, None] + np.diff(t)[:, None] * cuts).ravel(), t[-1]))
        t, f = fine, np.interp(fine, t, f)
    area = np.concatenate([[0.0], np.cumsum(np.diff(t) * (f[1:] + f[:-1]) / 2)])
    return np.column_stack([t, area])
