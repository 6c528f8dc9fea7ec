"""What a state amounts to: the arrays of a frame, and energies."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..materials import PLASTIC_STRAIN
from .particle import DRIVEN
from .problem import Problem
from .rings import TURN
from .state import Floats, State


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


def energies(p: Problem, s: State, velocity: Floats, given: float) -> dict[str, float]:
    """Kinetic, internal (with the dissipated), dissipated, external work, stored by contact and artificial stress, and
    what friction and dashpots of the contact took. given: work of what drives particles, which have no weight.
    """
    n = s.n
    mass = np.where(s.fixed[:n] & DRIVEN, 0.0, s.rows("mass")[0, :n])
    moved = s.rows("x")[:, :n] - s.rows("x_start")[:, :n]
    contact, artificial, body = s.rows("contact_work"), s.rows("artificial_work"), s.rows("body_work")
    heat = float(np.sum(s.rows("contact_heat")[:, :n]))
    external = float(np.sum(mass * (np.array(p.body_force[: s.d]) @ moved)))
    return {
        "kinetic": 0.5 * float(np.sum(mass * np.sum(velocity**2, axis=0))),
        "internal": float(np.sum(s.rows("mass")[0, :n] * s.rows("energy")[0, :n])),
        "dissipated": float(np.sum(s.rows("mass")[0, :n] * s.rows("dissipated")[0, :n])),
        "external_work": given + (float(np.sum(body[0, :n][mass > 0.0])) if len(body) else external),
        "contact_energy": -float(np.sum(contact[0, :n])) - heat if len(contact) else 0.0,
        "artificial_energy": -float(np.sum(artificial[0, :n])) if len(artificial) else 0.0,
        "contact_dissipated": heat,
    }


def total(energies: dict[str, float]) -> float:
    """What stays constant."""
    stored = energies["contact_energy"] + energies["contact_dissipated"] + energies["artificial_energy"]
    return energies["kinetic"] + energies["internal"] + stored - energies["external_work"]


def report(start: dict[str, float], now: dict[str, float]) -> dict[str, float]:
    """Energies at the start and now.

    balance_error is relative to the largest of kinetic, internal and external work.
    """
    scale = max(start["kinetic"], now["kinetic"], abs(now["internal"]), abs(now["external_work"]), 1e-300)
    return {
        "initial": start["kinetic"] + start["internal"],
        "final": total(now) + now["external_work"],
        "kinetic": now["kinetic"],
        "internal": now["internal"],
        "external_work": now["external_work"],
        "dissipated": now["dissipated"],
        "balance_error": abs(total(now) - total(start)) / scale,
    }
