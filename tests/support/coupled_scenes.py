"""A block of particles and a plate that several tests bring together. Units: mm, ms, g, N, MPa."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from fem_meshes import held, plane, quads, shell
from sph_scenes import lattice

from zrno.solvers import fem, sph
from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.coupling import Coupled, Exchange
from zrno.solvers.materials import Elastic
from zrno.solvers.sph.problem import Body
from zrno.solvers.sph.surface import Facets

SOFT = Elastic.from_engineering(50.0, 0.3)
HARD = Elastic.from_engineering(5.0e3, 0.3)
STEEL = Elastic.from_engineering(7.0e4, 0.33)
SPACING, ELEMENTS, SIDE, THICKNESS = 2.0, 8, 16.0, 1.0
DENSITY = 2.0e-3  # of both


def plate(*, clamped: bool = True, period: float = 0.02, steps: int = 50, **changes: Any) -> fem.Problem:
    """A square plate in z = 0, clamped or free."""
    x, nodes, number = quads(ELEMENTS, ELEMENTS, lambda r, s: plane(SIDE * np.column_stack([r, s])))
    rim = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    fixed = held(len(x), (rim, "xyzabc")) if clamped else np.zeros((len(x), 6), bool)
    given: dict[str, Any] = {"steps": ((steps, period),), "dynamics": fem.Dynamics()}
    elements = shell(nodes, THICKNESS, STEEL, density=DENSITY)
    return fem.Problem("plate", 3, x, np.arange(1, len(x) + 1), (elements,), fixed, **given | changes)


def block(
    structure: fem.Problem,
    *,
    speed: float = 1.0,
    gap: float = 0.0,
    side: int = 4,
    law: Any = SOFT,
    **changes: Any,
) -> sph.Problem:
    """A block above the middle of a plate (gap: from its mid-surface), moving down, and the plate's nodes behind it."""
    low = 0.5 * (SIDE - side * SPACING)
    x = lattice((side, side, side), (low, low, gap), SPACING)
    n, m = len(x), len(structure.x)
    mass = np.full(n + m, DENSITY * SPACING**3)
    v = np.zeros((n + m, 3))
    v[:n, 2] = -speed
    strength = 50.0 / DENSITY**2
    given: dict[str, Any] = {
        "dimension": 3, "x": np.concatenate([x, structure.x]), "v": v, "mass": mass, "h": np.full(n + m, 1.3 * SPACING),
        "density": np.full(n + m, DENSITY), "body": np.repeat([0, 1], [n, m]), "end_time": structure.end_time,
        "bodies": (Body(1, "block", law, DENSITY, strength=strength, exponent=2.0),
                   Body(2, "plate", STEEL, DENSITY, strength=0.0, exponent=2.0)),
        "potential": True, "driven": np.arange(n + m) >= n, "fixed": np.zeros((n + m, 3), bool),
    }  # fmt: skip
    return sph.Problem(**given | changes)


def facing(structure: fem.Problem, *, friction: Coulomb | None = None, **changes: Any) -> sph.Problem:
    """The same block, and the plate's elements as facets."""
    whole = block(structure, **changes)
    quads = structure.elements[0].nodes
    corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    count = len(corners)
    facets = Facets(structure.x, corners, np.full(count, 0.5 * THICKNESS), np.zeros(count, bool), friction)
    n = int(np.count_nonzero(whole.body == 0))
    return dataclasses.replace(
        whole, x=whole.x[:n], v=whole.v[:n], mass=whole.mass[:n], h=whole.h[:n], density=whole.density[:n],
        body=whole.body[:n], bodies=whole.bodies[:1], potential=False, driven=None, fixed=None, facets=facets,
    )  # fmt: skip


def layer(structure: fem.Problem, ratio: float, *, stiffness: float, gravity: float) -> sph.Problem:
    """One grain over each element, that touches the plate and no other: `ratio` of the plate's mass.

    stiffness: of a grain's contact [N/mm].
    """
    whole = facing(structure, gap=0.5 * THICKNESS, side=ELEMENTS)
    x = whole.x[whole.x[:, 2] < whole.x[:, 2].min() + 0.5 * SPACING]
    n, density = len(x), DENSITY * ratio * THICKNESS / SPACING
    law = Elastic.from_engineering(stiffness / (0.5 * SPACING) * (1.0 + 0.3) * (1.0 - 0.6) / (1.0 - 0.3), 0.3)
    body = dataclasses.replace(whole.bodies[0], law=law, density=density)
    return dataclasses.replace(
        whole, x=x, v=np.zeros((n, 3)), mass=np.full(n, density * SPACING**3), h=np.full(n, 0.4 * SPACING),
        density=np.full(n, density), body=np.zeros(n, np.int64), bodies=(body,), body_force=(0.0, 0.0, -gravity),
        contact_damping=0.3,
    )  # fmt: skip


def drop(structure: fem.Problem, particles: sph.Problem, *, threads: int = 1, **exchange: Any) -> Coupled:
    """Both, coupled at all nodes of the structure."""
    given = {"nodes": np.arange(len(structure.x))} | exchange
    return Coupled(fem.Solver(structure), sph.Solver(particles, threads=threads), Exchange(**given))


def momentum(coupled: Coupled) -> np.ndarray:
    """(3,) of both, with the impulse on its way, less what supports gave."""
    row = coupled.history()
    own = np.array([row[f"momentum_{axis}"] for axis in "xyz"])
    total: np.ndarray = own + coupled.pending.sum(axis=0) - coupled.structure.support_impulse
    return total
