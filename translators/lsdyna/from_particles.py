"""A particle deck as a mesh: each particle a node and an *ELEMENT_SPH, each material a part."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from zrno.translators.lsdyna.assemble import held
from zrno.translators.model import (
    Analysis,
    BodyLoad,
    ElementBlock,
    InitialVelocity,
    Model,
    Part,
    Section,
)
from zrno.translators.report import Report


def mesh_of(model: Model, report: Report) -> Model:
    """The model itself where it has no particles; else one with nodes and elements in place of them."""
    particles = model.particles
    if particles is None:
        return model
    count = len(particles)
    ids = np.arange(1, count + 1)
    owned = np.maximum(np.bincount(particles.material, minlength=max(model.materials, default=0) + 1), 1)
    total = np.zeros(len(owned))
    for number, material in model.materials.items():
        total[number] = material.mass
    mass = particles.mass if particles.mass is not None else (total / owned)[particles.material]
    translation = held(particles.bc)
    new = replace(
        model,
        format="mcm",
        node_ids=ids,
        xyz=particles.x,
        blocks=[ElementBlock("point1", ids, np.arange(count)[:, None], particles.material, "sph", {"mass": mass})],
        parts={n: Part(n, m.name, material=n, section=n, dimension=0) for n, m in model.materials.items()},
        sections={n: Section(n, m.name, "sph", {"h": m.h} if m.h else {}) for n, m in model.materials.items()},
        fixed=np.concatenate([translation, np.zeros_like(translation)], axis=1) if translation.any() else None,
        initial_velocities=list(model.initial_velocities),
        body_loads=list(model.body_loads),
        particles=None,
        particle_control=None,
    )
    if particles.velocity is not None and particles.velocity.any():
        moving = np.flatnonzero(particles.velocity.any(axis=1))
        new.initial_velocities.append(InitialVelocity(moving, particles.velocity[moving]))
    for name, values in (("smoothing lengths", particles.h), ("densities", particles.rho), ("energies", particles.e)):
        report.drop(f"particles' {name}", 0 if values is None else count, "a keyword deck has one for each part")
    control = model.particle_control
    if control is not None:
        new.analysis = Analysis(
            "explicit", control.end_time or None, control.initial_step or None, control.step_factor or None,
            control.output_interval or None,
        )  # fmt: skip
        if control.base_acceleration is not None:
            new.body_loads.append(BodyLoad(control.base_acceleration))
        report.drop("contact of a particle deck", int(bool(control.contact)), "no contact is written")
        report.drop("symmetry planes", len(control.planes or ()), "not written to a keyword deck")
    report.drop("viscosities", sum(m.viscosity_linear is not None or m.viscosity_quadratic is not None
                                   for m in model.materials.values()), "not written to a keyword deck")  # fmt: skip
    return new
