"""From a mesh and settings to a particle model: what `zrno convert` does between reading and writing an .mcm deck."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from zrno.translators import held
from zrno.translators.law_maps import as_known
from zrno.translators.materials import NEED_EQUATION, equation_of_state, materials_of, settings_of
from zrno.translators.mcm.cards import LAWS as MCM_LAWS
from zrno.translators.model import PARTICLE_FAMILIES, Eos, Material, Model, Part, Particles
from zrno.translators.particle_control import particle_control
from zrno.translators.particles import Filling, chosen_parts, copy_nodes, fill, on_shells, own_particles
from zrno.translators.real_text import real_text
from zrno.translators.report import Report
from zrno.translators.sections import thickness_of
from zrno.translators.settings import Settings

_NEAREST_DISTANCE = 2
_NONE_WHERE_0 = ("failure_strain",)
_KNOWN = {name: law.parameters for name, law in MCM_LAWS.items()}


def to_particles(
    model: Model,
    settings: Settings,
    particles: str | None = None,
    spacing: float | None = None,
    parts: Sequence[int | str] | None = None,
) -> tuple[Model, Report]:
    """Make a particle model of a mesh.

    particles: "solids" fills volumes (and the areas of a flat mesh) by a lattice, "shells" covers areas, "nodes" takes
    the nodes; None: the particles that the mesh has itself, else as "solids". spacing: of the lattice, by default the
    mesh's median edge length. parts: names or numbers; by default all that can become particles. Each part becomes a
    material of the deck, numbered from 1 in the mesh's order; what the mesh says of materials, constraints, initial
    velocities, gravity and times is taken over, the settings overrule it.
    Raises InputError for settings that the mesh cannot take, ValueError for a mesh that cannot become particles.
    """
    report = Report()
    asked = None if parts is None else [part_number(model, part) for part in parts]
    chosen = _parts(model, asked, particles)
    materials = materials_of(model, chosen, settings, report)
    chosen = _with_laws(model, chosen, materials, report)
    filling = _filled(model, settings, particles, spacing, chosen)
    dimension = 2 if model.dimension == 2 else 3
    if settings["dimension"] not in (None, dimension):
        settings.fault(("dimension",), "the mesh has another dimension", settings["dimension"], str(dimension))
        settings.stop()
    if settings["axisymmetric"]:
        filling = _turned(filling, dimension, settings)
    target = Model(title=_title(model.title), format="mcm", version="2", dimension=dimension)
    numbers = {part: number for number, part in enumerate(chosen, 1)}
    material = np.array(chosen).argsort().argsort()  # of each part its place among the sorted ones
    place = np.searchsorted(np.sort(chosen), filling.part)
    owner = np.empty(len(chosen), np.int64)
    owner[material] = np.arange(1, len(chosen) + 1)
    number = owner[place]
    entries = [settings_of(settings, model, part)[1] for part in chosen]
    bc, velocity = held.of_particles(model, filling, chosen, entries, report)
    _equations_of_state(model, target, chosen, materials, settings)
    target.particles = Particles(filling.x, number, bc, velocity if velocity.any() else None)
    mass = _masses(filling, np.array([materials[part].density for part in chosen])[number - 1])
    h = np.zeros(len(chosen))
    for part, k in numbers.items():
        own = mass[number == k]
        h[k - 1] = _smoothing_length(model, part, filling, settings)
        entry = entries[k - 1] or {}
        target.materials[k] = _material(model.parts[part], k, materials[part], own, h[k - 1], settings, entry)
        target.materials[k].eos = k if k in target.equations_of_state else None
    uneven = any(np.ptp(mass[number == k]) > 1e-9 * mass[number == k].max() for k in numbers.values())
    if uneven or any(not _fits(material.mass) for material in target.materials.values()):
        target.particles.mass = mass
    target.particle_control = particle_control(model, target, settings, dimension, report)
    _report_lost(model, chosen, filling, report)
    report.notes.append(f"{len(filling.x)} particles in {len(chosen)} part(s)")
    if particles != "nodes" and settings["step_option"] == _NEAREST_DISTANCE and len(chosen) > 1:
        report.notes.append("step_option 2 takes the nearest particles of all bodies: touching bodies shorten the step")
    return target, report


def part_number(model: Model, asked: int | str) -> int:
    """The number of a part by its name or number; ValueError with what there is."""
    for number, part in model.parts.items():
        if asked == number or str(asked) in (part.name, str(number)):
            return number
    known = ", ".join(f"{number} {part.name}".strip() for number, part in model.parts.items())
    raise ValueError(f"the mesh has no part {asked}; it has: {known or 'none'}")


def _parts(model: Model, asked: list[int] | None, particles: str | None) -> list[int]:
    """The parts asked for; by default those that are particles already, where there are such, else all."""
    if asked is None and particles is None:
        own = {int(p) for b in model.blocks if b.family in PARTICLE_FAMILIES for p in np.unique(b.part)}
        asked = [part for part in model.parts if part in own] or None
    return chosen_parts(model, asked)


def _with_laws(model: Model, chosen: list[int], materials: dict[int, Material], report: Report) -> list[int]:
    """The parts whose law the deck has, or one near it, which then stands in `materials`; the others are dropped."""
    kept = []
    for part in chosen:
        own = materials[part]
        eos = equation_of(model, part, own)
        nearest = as_known(own, _KNOWN, model.curves, eos, report)
        name = model.parts[part].name or str(part)
        if nearest is None:
            count = sum(int((block.part == part).sum()) for block in model.blocks)
            report.drop(f"elements of part {name}", count, f"an .mcm deck has no law like {own.law or 'its material'}")
            continue
        materials[part] = nearest
        kept.append(part)
    if not kept:
        laws = ", ".join(sorted({materials[part].law or "none known" for part in chosen}))
        raise ValueError(f"no part is left: an .mcm deck has no law like {laws}; settings `materials` can give one")
    return kept


def equation_of(model: Model, part: int, material: Material) -> Eos | None:
    """The equation of state of a part: its own, or its material's."""
    number = model.parts[part].eos or material.eos
    return None if number is None else model.equations_of_state.get(number)


def _filled(
    model: Model, settings: Settings, particles: str | None, spacing: float | None, parts: list[int]
) -> Filling:
    own = [any(b.family in PARTICLE_FAMILIES and (b.part == part).any() for b in model.blocks) for part in parts]
    if all(own):
        return own_particles(model, parts)
    if any(own):
        mine = ", ".join(model.parts[p].name or str(p) for p, has in zip(parts, own, strict=True) if has)
        raise ValueError(
            f"parts that are particles already ({mine}) together with meshed ones; expected one or the other"
        )
    if particles == "nodes":
        thickness = {part: thickness_of(model, part, settings) for part in parts} if _in_space(model, parts) else None
        return copy_nodes(model, parts, thickness)
    if particles == "shells" and model.dimension != 2:
        return on_shells(
            model, spacing, parts=parts, thickness={part: thickness_of(model, part, settings) for part in parts}
        )
    if particles not in (None, "solids", "shells"):
        raise ValueError(f"particles of {particles}; expected solids, shells or nodes")
    return fill(model, spacing, parts=parts)


def _in_space(model: Model, parts: list[int]) -> bool:
    """Whether some of the parts are shells in space."""
    areas = [b for b in model.blocks if b.kind.startswith(("tri", "quad")) and np.isin(b.part, parts).any()]
    return model.dimension == 3 and bool(areas)


def _turned(filling: Filling, dimension: int, settings: Settings) -> Filling:
    """The particles of a flat mesh as rings round x = 0, with their volumes."""
    if dimension != 2 or not np.all(filling.x[:, 0] > 0.0):
        least = filling.x[:, 0].min()
        said = "a mesh in space" if dimension != 2 else f"the mesh has particles at x = {least:g}"
        settings.fault(("axisymmetric",), "x is the radius of a flat mesh", said, "a flat mesh where x is above 0")
        settings.stop()
    return replace(filling, volume=filling.volume * (2.0 * math.pi * filling.x[:, 0]))


def _masses(filling: Filling, density: Any) -> Any:
    """Mass of each particle: the mesh's own, else its volume's, else that of a cube of the spacing."""
    spacing = np.array([filling.spacing[part] for part in filling.part.tolist()]) if filling.mass is not None else None
    mass = filling.volume * density
    if spacing is not None and filling.mass is not None:
        mass = np.where(np.isnan(filling.mass), np.where(np.isnan(mass), density * spacing**3, mass), filling.mass)
    return mass


def _fits(mass: float) -> bool:
    """Whether the deck's ten columns hold a part's mass to 1e-9; else its particles' masses are written, in twenty."""
    return abs(float(real_text(mass, 10)[0]) - mass) <= 1e-9 * mass


def _smoothing_length(model: Model, part: int, filling: Filling, settings: Settings) -> float:
    """What the settings say, else the part's section, else the settings' default; a length that the deck holds."""
    section = model.sections.get(model.parts[part].section or 0)
    own = {} if section is None else section.parameters
    factor = settings["h_factor"]
    entry = settings_of(settings, model, part)[1]
    given = entry is not None and entry["h_factor"] is not None
    h = (entry["h_factor"] if entry is not None and given else factor) * filling.spacing[part]
    if not given and not settings.gives("h_factor"):
        h = own.get("h") or own.get("h_factor", factor) * filling.spacing[part]
    return float(real_text(h, 10)[0])


def _equations_of_state(
    model: Model, target: Model, chosen: list[int], materials: dict[int, Material], settings: Settings
) -> None:
    """The equation of state of each part's material that needs one, by the material's number in the deck."""
    for number, part in enumerate(chosen, 1):
        found = equation_of_state(settings, model, part, materials[part])
        if found is not None and materials[part].law in NEED_EQUATION:
            name = found.name or model.parts[part].name
            target.equations_of_state[number] = replace(found, id=number, name=name)
    settings.stop()


def _material(
    part: Part, number: int, own: Material, mass: Any, h: float, settings: Settings, entry: Mapping[str, Any]
) -> Material:
    viscosity = settings["viscosity"]
    return Material(
        number,
        part.name or f"part {part.id}",
        law=own.law,
        density=own.density,
        parameters={key: value for key, value in own.parameters.items() if value or key not in _NONE_WHERE_0},
        mass=float(f"{float(mass.sum()):.14g}"),  # 8.1, not the round-off of its quadrature
        h=h,
        viscosity_quadratic=entry.get("quadratic") or viscosity["quadratic"] or own.viscosity_quadratic,
        viscosity_linear=entry.get("linear") or viscosity["linear"] or own.viscosity_linear,
        rho_min=entry.get("rho_min") or own.rho_min,
        rho_max=entry.get("rho_max") or own.rho_max,
        tables=dict(own.tables),
    )


def _report_lost(model: Model, chosen: list[int], filling: Filling, report: Report) -> None:
    """What of the mesh is not in the particle model."""
    left = [part for number, part in model.parts.items() if number not in chosen]
    report.drop("parts", len(left), "not asked for: " + ", ".join(part.name or str(part.id) for part in left[:20]))
    for block in model.blocks:
        lower = int((~np.isin(block.part, [part.id for part in model.parts.values()])).sum())
        report.drop(f"{block.kind} elements", lower, "of lower dimension than the parts: no particles are made of them")
    top = {part.name for part in model.parts.values() if part.name}
    sets = [nodes.name or str(nodes.id) for nodes in model.node_sets if nodes.name not in top]
    report.drop("node sets", len(sets), "an .mcm deck has none: " + ", ".join(sets[:20]))
    count: Callable[[Any], int] = len
    for what, items in (
        ("element sets", model.element_sets),
        ("part sets", model.part_sets),
        ("segment sets", model.segment_sets),
        ("linear relations", model.equations),
        ("loads on nodes", model.nodal_loads),
        ("loads on faces", model.face_loads),
        ("contacts", model.contacts),
    ):
        report.drop(what, count(items), "an .mcm deck has none")


def _title(title: str) -> str:
    """A title without commas: one build of the original program reads its first line as a list."""
    return title.replace(",", ";")
