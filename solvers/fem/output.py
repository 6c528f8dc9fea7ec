"""What a finite element run shows: nodal and element arrays, sums, energies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..frame import Arrays, Cells, Frame
from ..materials import Elastic, Orthotropic
from .arc import PathFollowing
from .groups.timed import TimedGroup, has_life
from .problem import SMALL, Problem
from .procedures import Vibrations

if TYPE_CHECKING:
    from .solver import Solver

Floats = NDArray[np.float64]


def is_linear(problem: Problem) -> bool:
    """Whether one factorisation answers all steps: linear laws, small displacements, loads that do not follow."""
    return (
        all(isinstance(e.law, Elastic | Orthotropic | None) and e.geometry == SMALL for e in problem.elements)
        and not any(load.follows for load in problem.face_loads)
        and not any(m.incremental for m in problem.motions)
        and not any(has_life(e) for e in problem.elements)
        and not problem.stops
    )


def von_mises(stress: Floats) -> Floats:
    """Of stresses (..., 6)."""
    xx, yy, zz, xy, yz, zx = np.moveaxis(stress, -1, 0)
    square = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + zx**2)
    out: Floats = np.sqrt(square)
    return out


def frame(solver: Solver) -> Frame:
    """Nodes and elements of a solver, in the order of the deck."""
    p, a = solver.given, solver.assembly
    n = len(p.x)
    u = solver.shape.u[:n]
    nodes: Arrays = {
        "position": p.x + u[:, :3],
        "id": p.node_ids,
        "displacement": u[:, :3],
        "reaction": solver.reaction[:n, :3],
        "stress": _nodal_stress(solver)[:n],
    }
    if any(g.dofs.max(initial=0) > 2 for g in a.groups):
        nodes["rotation"] = u[:, 3:]
        nodes["moment"] = solver.reaction[:n, 3:]
    velocity = solver.procedure.velocity(solver)
    if velocity is not None:
        nodes["velocity"] = velocity[:n, :3]
    nodes["von_mises"] = von_mises(nodes["stress"])
    blocks = []
    timed = any(has_life(e) for e in p.elements)
    for e, group in zip(p.elements, a.groups, strict=True):
        data: Arrays = dict(group.output())
        count = len(e.ids)
        data |= {"id": e.ids, "material": np.full(count, e.material), "von_mises": von_mises(data["stress"])}
        thickness = np.zeros(count) if e.thickness is None else np.asarray(e.thickness, dtype=float)
        data["thickness"] = thickness if thickness.ndim == 1 else thickness.mean(axis=1)
        data.setdefault("plastic_strain", np.zeros(count))
        if timed:
            data.setdefault("alive", np.ones(count))
        blocks.append(Cells(e.kind, e.nodes, data))
    return Frame(time=solver.time, step=solver.step, particles={}, nodes=nodes, cells=blocks)


def _nodal_stress(solver: Solver) -> Floats:
    """Stresses at nodes: extrapolated from the integration points, averaged by the elements' volume."""
    n = solver.n
    total, weight = np.zeros((n, 6)), np.zeros(n)
    for group in solver.assembly.groups:
        stress, volume = group.at_nodes()
        share = np.repeat(volume[:, None], group.elements.nodes.shape[1], axis=1)
        weight += np.bincount(group.elements.nodes.ravel(), share.ravel(), minlength=n)
        for c in range(6):
            total[:, c] += np.bincount(group.elements.nodes.ravel(), (stress[:, :, c] * share).ravel(), minlength=n)
    return total / np.maximum(weight, 1e-300)[:, None]


def history(solver: Solver, energies: dict[str, float]) -> dict[str, float]:
    """One row: energies, sums of loads and reactions, the largest displacement."""
    loads, reactions = solver.external_forces[:, :3].sum(axis=0), solver.reaction[:, :3].sum(axis=0)
    row = {"time": solver.time, "dt": solver.dt, **energies}
    momentum = solver.procedure.momentum(solver)
    row |= dict(zip(("momentum_x", "momentum_y", "momentum_z"), momentum.tolist(), strict=True))
    stops = solver.assembly.stops
    pushed = np.zeros(3) if stops is None else stops.force(solver.shape.u)
    row |= dict(zip(("contact_force_x", "contact_force_y", "contact_force_z"), pushed.tolist(), strict=True))
    row["active"] = float(
        sum(len(g.elements.ids) for g in solver.assembly.groups if not isinstance(g, TimedGroup) or g.living)
    )
    for k, axis in enumerate("xyz"):
        row[f"load_{axis}"], row[f"reaction_{axis}"] = float(loads[k]), float(reactions[k])
    size = np.linalg.norm(solver.shape.u[:, :3], axis=1)
    row["max_displacement"] = float(size.max(initial=0.0))
    if isinstance(solver.procedure, PathFollowing):
        row["load_factor"] = solver.procedure.factor
    if isinstance(solver.procedure, Vibrations):
        row["frequency"] = solver.procedure.frequency
    row["iterations"] = float(solver.iterations)
    row["step"] = float(solver.step)
    return row


LEAST = 1e-6  # strain: the elastic energy of less is round-off


def energy_report(solver: Solver, energies: dict[str, float], start: float) -> dict[str, float]:
    """Energies at the start and now; how far their balance is out, over the largest of them."""
    made = energies["kinetic"] + energies["internal"] - energies["external_work"] - start
    largest = max(start, *(abs(v) for v in energies.values()), 0.5 * LEAST**2 * solver.assembly.stiffness) or 1.0
    return {"initial": start, "final": energies["kinetic"] + energies["internal"], **energies,
            "balance_error": abs(made) / largest}  # fmt: skip
