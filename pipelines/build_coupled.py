"""From a pair of decks to a coupled problem: the structure's wetted nodes become particles of the particle problem."""

from __future__ import annotations

import copy
import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from zrno.pipelines import contact
from zrno.pipelines.build import HELD, particle_problem
from zrno.pipelines.build_fem import structure_problem
from zrno.pipelines.coupling_method import Coupling
from zrno.pipelines.fem_method import Fem
from zrno.pipelines.method import Sph
from zrno.pipelines.wetted import Wetted, wetted
from zrno.solvers import fem, sph
from zrno.solvers.coupling import Exchange
from zrno.solvers.materials import Elastic
from zrno.solvers.sph.surface import Facets
from zrno.translators.model import Material, Model
from zrno.translators.text import Fault, InputError
from zrno.translators.yaml_marks import Place

STRUCTURE = "structure"  # the name of its material where the particle deck has none


def coupled_problem(
    grain: Model,
    steel: Model,
    paths: tuple[str, str],
    how: Coupling,
    *,
    places: Mapping[str, Place] | None = None,
    original: bool = False,
    of_particles: Sph | None = None,
    of_structure: Fem | None = None,
) -> tuple[sph.Problem, fem.Problem, Exchange]:
    """The problems of a pair and what they exchange. paths: of the particle deck and of the structure's.

    Raises InputError for what the decks ask and is not done, ValueError for what does not go together.
    """
    structure = structure_problem(steel, paths[1], of_structure)
    if original and structure.dynamics is not None:
        structure = dataclasses.replace(structure, dynamics=None)  # its coupled shells have none: solvers/coupling
    if how.rigid or _all_given(structure):
        structure = dataclasses.replace(structure, rigid=True)
    surface = wetted(steel, _parts(steel, how, paths[1]))
    nodes = np.arange(len(steel.xyz)) if original or _all_nodes(grain, steel) else surface.nodes
    overrun = grain.velocity_overrun
    if overrun and overrun != len(steel.xyz):
        message = f"velocity cards of {overrun} nodes behind the particles, and the structure has {len(steel.xyz)}"
        raise InputError([Fault(paths[0], 1, 1, message, str(overrun), str(len(steel.xyz)))])
    control = grain.particle_control
    assert control is not None
    if control.dimension != steel.dimension:
        message = f"particles in {control.dimension} dimensions and a structure in {steel.dimension}"
        raise InputError([Fault(paths[0], 1, 1, message, str(control.dimension), str(steel.dimension))])
    assert grain.particles is not None
    offset = int(grain.particles.material.max())
    if how.contact == "face" and not original:
        particles = _facing(grain, paths[0], surface, how, of_particles or Sph(), places)
        exchange = _exchange(how, structure, surface.nodes, offset)
        spacing = float(np.median(particles.sections ** (1.0 / particles.dimension)))
        reach = 0.5 * spacing if particles.dimension == 2 else spacing / math.sqrt(math.pi)
        return particles, structure, dataclasses.replace(exchange, area=surface.area, reach=reach)
    chosen = _method(of_particles or Sph(), how)
    law = contact.law_of_contact(control, chosen)
    whole = _with_nodes(grain, steel, nodes, offset + 1)
    if law == "kernel" and not original:
        _as_grain(whole, surface, nodes)
    problem = particle_problem(whole, paths[0], places=places, original=original, method=chosen)
    count = grain.particle_count()
    driven = np.arange(len(problem.x)) >= count
    bodies = list(problem.bodies)
    if law == "kernel" and not original:  # a wall that bears what leans on it
        bodies[-1] = dataclasses.replace(
            bodies[-1], bearing=True, law=Elastic(0.0, 0.0), linear=0.0, quadratic=0.0, stress_diffusion=0.0
        )
    if law == "potential" and not any(strength for strength, _ in control.contact_laws):
        bodies[-1] = dataclasses.replace(bodies[-1], strength=0.0, exponent=bodies[0].exponent)
    if whole.warnings != grain.warnings:
        grain.warnings[:] = whole.warnings
    exchange = _exchange(how, structure, nodes, offset, original=original)
    return dataclasses.replace(problem, driven=driven, bodies=tuple(bodies)), structure, exchange


def _all_given(structure: fem.Problem) -> bool:
    """Whether the motion of every node of an element is prescribed or held: then nothing needs to be solved."""
    given = structure.fixed[:, :3].copy()
    for motion in structure.motions:
        along = motion.dofs < 3
        given[motion.nodes[along], motion.dofs[along]] = True
    used = np.unique(np.concatenate([e.nodes.ravel() for e in structure.elements]))
    return bool(given[used, : structure.dimension].all())


SLOWLY = 0.2  # the share of the grain's force that a structure without inertia gets in a period


def _exchange(how: Coupling, structure: fem.Problem, nodes: Any, offset: int, *, original: bool = False) -> Exchange:
    return Exchange(
        nodes=nodes,
        tolerance=how.tolerance or 0.0,
        most=how.most,
        relaxation=how.relaxation or (SLOWLY if structure.dynamics is None else 1.0),
        original=original,
        offset=offset,
    )


def _facing(
    grain: Model, path: str, surface: Wetted, how: Coupling, method: Sph, places: Mapping[str, Place] | None
) -> sph.Problem:
    """The particles and the structure's facets. A material of the structure's in their deck does nothing."""
    assert grain.particles is not None
    assert grain.particle_control is not None
    own = np.unique(grain.particles.material).tolist()
    alone = dataclasses.replace(grain, materials={number: grain.materials[number] for number in own})
    problem = particle_problem(alone, path, places=places, method=method)
    facets = Facets(
        surface.x,
        surface.facets,
        surface.half,
        surface.closed,
        contact.friction_of(grain.particle_control, how.friction),
    )
    return dataclasses.replace(problem, facets=facets)


def _method(method: Sph, how: Coupling) -> Sph:
    """The particles' method with what the coupling says of contact."""
    own: dict[str, Any] = {}
    if how.contact is not None:
        own["law"] = how.contact
    if how.friction is not None:
        own["friction"] = how.friction
    return method.model_copy(update={"contact": method.contact.model_copy(update=own)}) if own else method


def _parts(steel: Model, how: Coupling, path: str) -> list[int] | None:
    if how.surface == "all":
        return None
    wanted = how.surface if isinstance(how.surface, list) else [how.surface]
    names = {part.name.removeprefix("part "): number for number, part in steel.parts.items() if part.name}
    known = {str(number): number for number in steel.parts} | names
    faults = [
        Fault(path, 1, 1, "coupling.surface: no such part or group", str(name), ", ".join(known) or "all")
        for name in wanted
        if str(name) not in known
    ]
    if faults:
        raise InputError(faults)
    return [known[str(name)] for name in wanted]


def _all_nodes(grain: Model, steel: Model) -> bool:
    """Whether the particle deck has a material for the structure, whose mass is then that of all nodes."""
    assert grain.particles is not None
    return max(grain.materials) > max(grain.particles.material) and all(
        block.family == "shell" for block in steel.blocks
    )


def _with_nodes(grain: Model, steel: Model, nodes: Any, number: int) -> Model:
    """The particle deck with the structure's nodes behind its particles, as the original programs see it."""
    own = grain.particles
    assert own is not None
    whole = dataclasses.replace(grain, warnings=list(grain.warnings), materials=dict(grain.materials))
    if number not in whole.materials:
        whole.materials[number] = _material_of(steel, grain, number, len(nodes))
    m = len(nodes)

    def longer(values: Any, more: Any) -> Any:
        return None if values is None else np.concatenate([values, np.full((m, *values.shape[1:]), more)])

    material = whole.materials[number]
    whole.particles = dataclasses.replace(
        own,
        x=np.concatenate([own.x, steel.xyz[nodes]]),
        material=np.concatenate([own.material, np.full(m, number)]),
        bc=np.concatenate([own.bc, np.full(m, HELD)]),
        velocity=longer(own.velocity, 0.0),
        mass=longer(own.mass, material.mass / m),
        h=longer(own.h, material.h),
        rho=longer(own.rho, material.density),
        e=longer(own.e, 0.0),
    )
    control = copy.copy(grain.particle_control)
    assert control is not None
    if control.contact and len(control.contact_laws) < number:
        control.contact_laws = [*control.contact_laws, (0.0, 0.0)]
    whole.particle_control = control
    return whole


def _material_of(steel: Model, grain: Model, number: int, nodes: int) -> Material:
    """A material for nodes where the particle deck has none: they weigh what the grain's particles do."""
    own = grain.particles
    assert own is not None
    first = grain.materials[int(own.material[0])]
    share = (
        float(own.mass.mean()) if own.mass is not None else first.mass / max(int((own.material == first.id).sum()), 1)
    )
    h = first.h if own.h is None else float(own.h.mean())
    elastic = next(m for m in steel.materials.values())
    return dataclasses.replace(
        elastic, id=number, name=STRUCTURE, law="elastic", density=first.density, mass=share * nodes, h=h,
        parameters={name: elastic.parameters.get(name, value) for name, value in (("E", 1.0), ("nu", 0.3))},
        native={}, tables={}, curves={}, eos=None, source=None,
    )  # fmt: skip


def _as_grain(whole: Model, surface: Wetted, nodes: Any) -> None:
    """With kernel contact nodes are a layer of grain: its density, and the mass of their area as thick as a grain."""
    own, control = whole.particles, whole.particle_control
    assert own is not None
    assert control is not None
    free = own.bc != HELD
    density = np.array([whole.materials[int(k)].density for k in own.material])
    if own.mass is None:
        owned = np.bincount(own.material)
        own.mass = np.array([whole.materials[int(k)].mass / owned[k] for k in own.material])
    first = density[free] if own.rho is None else own.rho[free]
    thickness = float(np.median((own.mass[free] / first) ** (1.0 / control.dimension)))
    rest = float(np.median(density[free]))
    area = np.zeros(len(whole.particles.x) if whole.particles is not None else 0)
    area[len(own.x) - len(nodes) + np.searchsorted(nodes, surface.nodes)] = surface.area
    mine = np.arange(len(own.x)) >= len(own.x) - len(nodes)
    own.mass = np.where(mine, rest * thickness * np.maximum(area, 1e-3 * surface.area.max()), own.mass)
    number = int(own.material[-1])
    whole.materials[number] = dataclasses.replace(whole.materials[number], density=rest)
    if own.rho is not None:
        own.rho = np.where(mine, rest, own.rho)
