"""From a particle deck's model to the solver's problem: names and numbers change hands, nothing is computed."""

from __future__ import annotations

from typing import Any

import numpy as np

from zrno.solvers.materials import Elastic, Law, von_mises
from zrno.solvers.sph import Body, Problem
from zrno.translators.model import Material, Model
from zrno.translators.text import Fault, InputError

# boundary code of the deck -> fixed x, y, z
_FIXED = np.array(
    [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1), (1, 1, 1)], dtype=bool
)  # fmt: skip

STEP_FACTOR = 0.8
QUADRATIC, LINEAR = 1.5, 0.06  # artificial viscosity where the deck leaves it blank
LEAST_DENSITY, MOST_DENSITY = 1e-10, 1e10


def particle_problem(model: Model, path: str, *, original: bool = False) -> Problem:
    """The problem that a particle deck poses. path: of the deck, for messages; original: as the original program does.

    Raises InputError for what the deck asks and this solver does not do.
    """
    control, particles = model.particle_control, model.particles
    if control is None or particles is None:
        raise InputError([Fault(path, 1, 1, "not a particle deck", model.format, "a .mcm deck")])
    faults = [Fault(path, 1, 1, what, said, "a deck without it") for what, said in _not_yet(model)]
    bodies = []
    numbers = sorted(model.materials)
    for k, number in enumerate(numbers):
        material = model.materials[number]
        try:
            strength = control.contact_laws[k] if control.contact else (0.0, 0.0)
            bodies.append(_body(material, strength))
        except ValueError as error:
            line = material.source.line if material.source else 1
            faults.append(Fault(path, line, 1, f"material {number}: {error}", "", "a law that can be computed"))
    if faults:
        raise InputError(faults)

    n = len(particles)
    body = np.searchsorted(numbers, particles.material)
    owned = np.bincount(body, minlength=len(numbers))
    per_material = [model.materials[i] for i in numbers]

    def of_material(values: list[float]) -> Any:
        return np.array(values, dtype=float)[body]

    masses = [m.mass / max(1, count) for m, count in zip(per_material, owned, strict=True)]
    return Problem(
        title=model.title,
        dimension=control.dimension,
        x=particles.x,
        v=np.zeros((n, 3)) if particles.velocity is None else particles.velocity,
        mass=of_material(masses) if particles.mass is None else particles.mass,
        h=of_material([m.h for m in per_material]) if particles.h is None else particles.h,
        density=of_material([m.density for m in per_material]) if particles.rho is None else particles.rho,
        energy=particles.e,
        body=body,
        bodies=tuple(bodies),
        fixed=_FIXED[particles.bc],
        end_time=control.end_time,
        step_option=control.step_option,
        step_factor=control.step_factor or STEP_FACTOR,
        first_step=control.initial_step,
        potential=control.contact == 1,
        body_force=control.base_acceleration or (0.0, 0.0, 0.0),
        original=original,
    )


def _body(material: Material, contact: tuple[float, float]) -> Body:
    def given(value: float | None, default: float) -> float:
        return value if value else default

    return Body(
        number=material.id,
        name=material.name,
        law=_law(material),
        density=material.density,
        linear=given(material.viscosity_linear, LINEAR),
        quadratic=given(material.viscosity_quadratic, QUADRATIC),
        least=given(material.rho_min, LEAST_DENSITY),
        most=given(material.rho_max, MOST_DENSITY),
        strength=contact[0],
        exponent=contact[1],
    )


def _law(material: Material) -> Law:
    p = material.parameters
    match material.law:
        case "elastic":
            return Elastic.from_engineering(p["E"], p["nu"])
        case "von_mises":
            if "failure_strain" in p:
                raise ValueError("failure by plastic strain is not computed yet; switch it off in the deck")
            return von_mises(p["E"], p["nu"], p["yield_stress"], p.get("tangent_modulus", 0.0), p.get("beta", 0.0))
    raise ValueError(f"the law {material.law} is not computed yet; elastic and von_mises are")


def _not_yet(model: Model) -> list[tuple[str, str]]:
    """What a deck asks for and this solver does not do yet, with the field that asks."""
    c = model.particle_control
    assert c is not None
    asked = [
        (c.discretisation != 0, "the corrected discretisation is not computed yet", f"disctype {c.discretisation}"),
        (c.kernel not in (0, 1), "only the cubic spline is computed yet", f"kernel {c.kernel}"),
        (c.h_option != 0, "a smoothing length that changes is not computed yet", f"h_opt {c.h_option}"),
        (c.velocity_option != 0, "XSPH is not computed yet", f"veloc_opt {c.velocity_option}"),
        (bool(c.planes), "boundary planes are not computed yet", "symmetry 1"),
        (
            0.1 < c.dynamic_relaxation < 1.0,
            "dynamic relaxation is not computed yet",
            f"drelax {c.dynamic_relaxation:g}",
        ),
        (c.friction is not None, "contact friction is not computed yet", f"friction {c.friction}"),
        (c.fluid_friction is not None, "fluid friction is not computed yet", f"friction {c.fluid_friction}"),
    ]
    return [(what, said) for wanted, what, said in asked if wanted]
