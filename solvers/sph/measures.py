"""What a state amounts to: the arrays of a frame, energies, the force between bodies."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..materials import PLASTIC_STRAIN
from . import across
from .ledger import STORED, total
from .particle import DRIVEN
from .problem import Problem
from .rings import TURN
from .smoothing import Shape
from .state import Arrays, Floats, Numbers, State


def particles(p: Problem, s: State, velocity: Floats, live: int) -> dict[str, Floats | NDArray[np.int64]]:
    """The arrays of a frame, of the first `live` particles in the order of the deck; not of a structure's nodes.

    velocity: (d, n) at the time of the positions.
    """
    n = live
    order = np.argsort(s.id[:n], kind="stable")
    order = order[s.fixed[order] & DRIVEN == 0]
    count = len(order)

    def vectors(rows: Floats) -> Floats:
        full = np.zeros((count, 3))
        full[:, : s.d] = rows[:, order].T
        return full

    stress = np.zeros((count, 6))
    rows = s.rows("stress")[:, :n]
    stress[:, : len(rows)] = rows[:, order].T
    xx, yy, zz, xy, yz, zx = stress.T
    shear = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + zx**2)
    x = s.rows("x")[:, :n]
    volume = s.rows("mass")[0, :n] / s.rows("density")[0, :n]
    if p.axisymmetric:
        volume /= TURN * x[0]
    radius = {1: 0.5 * volume, 2: np.sqrt(volume / math.pi), 3: np.cbrt(0.75 * volume / math.pi)}[p.dimension]
    plastic = s.rows("state")[PLASTIC_STRAIN, :n][order] if len(s.rows("state")) else np.zeros(count)
    numbers = np.array([b.number for b in p.bodies])
    return {
        "id": s.id[:n][order],
        "material": numbers[s.material[:n][order]],
        "position": vectors(x),
        "velocity": vectors(velocity),
        "density": s.rows("density")[0, :n][order],
        "mass": s.rows("mass")[0, :n][order],
        "radius": radius[order],
        "pressure": -(xx + yy + zz) / 3.0,
        "stress": stress,
        "von_mises": np.sqrt(shear),
        "plastic_strain": plastic,
        "displacement": vectors(x - s.rows("x_start")[:, :n]),
    }


def energies(p: Problem, s: State, velocity: Floats, live: int, given: float = 0.0) -> dict[str, float]:
    """Kinetic, internal (with the dissipated), dissipated, external work, stored by contact and artificial stress,
    what friction and dashpots of the contact and what dynamic relaxation took, of the first `live` particles; absent:
    the total of the others.
    given: work of what drives particles, which have no weight.
    """
    there = _energies(p, s, velocity, 0, live)
    there["external_work"] += given
    return there | {"absent": total(_energies(p, s, velocity, live, s.n)) if live < s.n else 0.0}


def _energies(p: Problem, s: State, velocity: Floats, i0: int, i1: int) -> dict[str, float]:
    """Of the particles i0..i1."""
    mass = s.rows("mass")[0, i0:i1]
    free = np.where(s.fixed[i0:i1] & DRIVEN, 0.0, mass)
    moved = s.rows("x")[:, i0:i1] - s.rows("x_start")[:, i0:i1]

    def sum_of(name: str) -> float:
        return float(np.sum(s.rows(name)[:, i0:i1]))

    heat = sum_of("contact_heat")
    external = float(np.sum(free * (np.array(p.body_force[: s.d]) @ moved)))
    if len(s.rows("body_work")):
        external = float(np.sum(s.rows("body_work")[0, i0:i1][free > 0.0]))
    return {
        "kinetic": 0.5 * float(np.sum(free * np.sum(velocity[:, i0:i1] ** 2, axis=0))),
        "internal": float(np.sum(mass * s.rows("energy")[0, i0:i1])),
        "dissipated": float(np.sum(mass * s.rows("dissipated")[0, i0:i1])),
        "external_work": external,
        "contact_energy": -sum_of("contact_work") - heat if len(s.rows("contact_work")) else 0.0,
        "artificial_energy": -sum_of("artificial_work"),
        "contact_dissipated": heat,
        "relaxation_dissipated": sum_of("relaxed"),
    }


def row(
    p: Problem,
    s: State,
    velocity: Floats,
    energies: dict[str, float],
    force: Floats,
    live: int,
    clock: dict[str, float],
) -> dict[str, float]:
    """A row of the history. velocity: (d, n); force: of `contact_force`; clock: time, dt and step."""
    n = live
    stored = {name: energies[name] for name in STORED}
    fixed = {name: value for name, value in energies.items() if name not in STORED and name != "absent"}
    momentum = np.zeros(3)
    moving = s.fixed[:n] & DRIVEN == 0
    momentum[: s.d] = (velocity[:, :n] * s.rows("mass")[0, :n])[:, moving].sum(axis=1)
    if p.axisymmetric:
        momentum[0] = 0.0  # of a ring
    plastic = s.rows("state")[PLASTIC_STRAIN, :n] if len(s.rows("state")) else np.zeros(1)
    return {
        "time": clock["time"],
        "dt": clock["dt"],
        **fixed,
        **dict(zip(("momentum_x", "momentum_y", "momentum_z"), momentum.tolist(), strict=True)),
        **dict(zip(("contact_force_x", "contact_force_y", "contact_force_z"), force.tolist(), strict=True)),
        "active": float(np.count_nonzero(moving)),
        **stored,
        "max_plastic_strain": float(plastic.max()),
        "step": clock["step"],
        "absent_energy": energies["absent"],
    }


def contact_force(
    p: Problem, s: State, arrays: Arrays, shape: Shape, numbers: Numbers, rows_apart: bool | None, live: int
) -> Floats:
    """Force [3] of all other bodies on the first one."""
    force = np.zeros(3)
    contact = s.rows("c")[:, :live]
    if len(contact):
        first = s.material[:live] == 0
        force[: s.d] = (contact * s.rows("mass")[0, :live] * first).sum(axis=1)
    if len(p.bodies) > 1 and not p.apart:
        across.interface_force(
            0, live, arrays.first, arrays.count, arrays.rows, shape, arrays.x, arrays.y, arrays.z, arrays.s,
            arrays.volume if numbers.mixed else arrays.mass, arrays.h, -(p.dimension + 2.0), numbers.normal,
            arrays.material, 0, rows_apart, force,
        )  # fmt: skip
    if p.axisymmetric:  # of whole rings; across the axis it is none
        force *= (0.0, TURN, 0.0)
    return force
