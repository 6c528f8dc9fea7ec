"""What a mesh does to its nodes, as particles take it: boundary codes, initial velocities, gravity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.formula import Formula
from zrno.translators.model import Curve, Floats, Ints, Model
from zrno.translators.particles import Filling
from zrno.translators.report import Report
from zrno.translators.setting_types import BOUNDARY_CODES

_CODE_OF_MASK = np.array([0, 1, 2, 4, 3, 6, 5, 7])  # bits x y z -> boundary code


def fixed_dofs(model: Model, report: Report | None = None) -> NDArray[np.bool_]:
    """Degrees of freedom held at each node, (n, 6): by the node cards and by constraints together."""
    fixed = np.zeros((len(model.xyz), 6), bool) if model.fixed is None else model.fixed.copy()
    local = timed = 0
    for constraint in model.constraints:
        timed += constraint.birth is not None or constraint.death is not None
        if not is_global(model, constraint.system):
            local += len(constraint.nodes)
            continue
        np.logical_or.at(fixed, constraint.nodes, constraint.dofs)
    if report is not None:
        report.approximate("constraints", timed, "with a birth or a death: held all the time")
        report.drop("constraints", local, "in a local system that is not along the global axes")
    return fixed


def is_global(model: Model, system: int) -> bool:
    """Whether a local system is along the global axes."""
    found = model.systems.get(system)
    return system == 0 or (
        found is not None and found.kind == "rectangular" and bool(np.allclose(found.axes, np.eye(3), atol=1e-12))
    )


def initial_velocity(model: Model) -> Floats:
    """Velocity of each node at the start, (n, 3)."""
    velocity = np.zeros((len(model.xyz), 3))
    for initial in model.initial_velocities:
        velocity[initial.nodes] = initial.velocity
    return velocity


def of_particles(
    model: Model, filling: Filling, parts: Sequence[int], entries: Sequence[Any], report: Report
) -> tuple[Ints, Floats]:
    """Boundary codes (n,) and velocities (n, 3) of particles.

    A particle that is a node has the node's; one of a lattice those of the node of its part that is nearest. entries:
    the settings' of each part, which overrule them.
    """
    fixed, velocity = fixed_dofs(model, report), initial_velocity(model)
    code = _CODE_OF_MASK[fixed[:, :3] @ np.array([1, 2, 4])]
    bc, v = np.zeros(len(filling.x), np.int64), np.zeros((len(filling.x), 3))
    near = 0
    for part, entry in zip(parts, entries, strict=True):
        mine = np.flatnonzero(filling.part == part)
        if code.any() or velocity.any():
            nodes = filling.node[mine]
            if (nodes < 0).any():
                nodes = _nearest(model, part, filling.x[mine])
                near += int((code[nodes] > 0).sum())
            bc[mine], v[mine] = code[nodes], velocity[nodes]
        if entry is not None and entry["bc"]:
            where = entry["bc_where"]
            held = mine if where is None else mine[values_at(where, filling.x[mine], "bc_where")]
            bc[held] = BOUNDARY_CODES[entry["bc"]]
        if entry is not None and any(entry["velocity"]):
            for axis, component in enumerate(entry["velocity"]):
                v[mine, axis] = values_at(component, filling.x[mine], "velocity")
    report.approximate("constraints", near, "particles held, since the node nearest to them is")
    turning = [i for i in model.initial_velocities if i.rotation is not None and i.rotation.any()]
    report.drop("initial rotations", len(turning), "particles have none")
    if model.dimension == 2:
        report.approximate("boundary codes", int(np.isin(bc, (3, 5, 6)).sum()), "z is no direction of a plane deck")
        bc = np.array([0, 1, 2, 0, 4, 2, 1, 7])[bc]
        v[:, 2] = 0.0
    return bc, v


def values_at(said: float | Formula, x: Floats, key: str) -> Any:
    """Of a number, or of a formula at places x (n, 3). ValueError where it is no number there."""
    if not isinstance(said, Formula):
        return said
    try:
        return said.at(x)
    except ValueError as error:
        raise ValueError(f"{key}: {error}") from None


def _nearest(model: Model, part: int, x: Floats) -> Ints:
    from scipy.spatial import cKDTree

    nodes = np.unique(np.concatenate([b.nodes[b.part == part].ravel() for b in model.blocks]))
    return np.asarray(nodes[cKDTree(model.xyz[nodes]).query(x)[1]])


def gravity(model: Model, end: float, report: Report) -> tuple[float, float, float]:
    """The acceleration of all material by the body loads; of a curve the mean over the run."""
    total = np.zeros(3)
    for load in model.body_loads:
        curve = None if load.curve is None else model.curves.get(load.curve)
        factor, changes = (1.0, False) if curve is None else _mean(curve, end)
        total += factor * np.array(load.acceleration)
        report.approximate("body loads", int(changes), "that change in time: their mean, which an .mcm deck holds")
        report.approximate("body loads", int(load.parts is not None), "on some parts: on all particles")
    x, y, z = (float(value) for value in total)
    return x, y, z


def _mean(curve: Curve, end: float) -> tuple[float, bool]:
    """Mean of a curve from 0 to `end`, and whether it changes there."""
    t, f = curve.points.T
    inside = np.unique(np.concatenate([[0.0, end], t[(t > 0) & (t < end)]]))
    values = np.interp(inside, t, f)
    if np.ptp(values) <= 1e-12 * np.abs(values).max(initial=0.0):
        return float(values[0]), False
    return float(np.trapezoid(values, inside) / end), True
