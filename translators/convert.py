"""From a mesh and settings to a particle model: what `zrno convert` does between reading and writing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from zrno.translators.model import Material, Model, Part, ParticleControl, Particles
from zrno.translators.particles import Filling, chosen_parts, copy_nodes, fill
from zrno.translators.real_text import real_text
from zrno.translators.report import Report
from zrno.translators.settings import BOUNDARY_CODES, Settings

FRAMES, ROWS = 20, 200  # of output and history where the settings give no interval
_NEAREST_DISTANCE = 2


def to_particles(
    model: Model,
    settings: Settings,
    particles: str = "solids",
    spacing: float | None = None,
    parts: Sequence[int | str] | None = None,
) -> tuple[Model, Report]:
    """Make a particle model of a mesh.

    particles: "solids" fills volumes (and the areas of a flat mesh) by a lattice, "shells" the areas of a flat mesh
    alone, "nodes" takes the nodes. spacing: of the lattice, by default the mesh's median edge length. parts: names or
    numbers; by default all. Each part becomes a material of the deck, numbered from 1 in the mesh's order.
    Raises InputError for settings that the mesh cannot take, ValueError for a mesh that cannot become particles.
    """
    chosen = chosen_parts(model, None if parts is None else [_part_number(model, part) for part in parts])
    data = _materials_of(model, chosen, settings)
    report = Report()
    filling = _filled(model, particles, spacing, chosen)
    dimension = 2 if model.dimension == 2 else 3
    if settings["dimension"] not in (None, dimension):
        settings.fault(("dimension",), "the mesh has another dimension", settings["dimension"], str(dimension))
        settings.stop()
    target = Model(title=_title(model.title), format="mcm", version="2", dimension=dimension)
    numbers = {part: number for number, part in enumerate(chosen, 1)}
    count = len(filling.x)
    place = np.zeros(max(chosen) + 1, np.int64)
    place[list(numbers)] = list(numbers.values())
    material = place[filling.part]
    velocity = np.array([data[part]["velocity"] for part in chosen])[material - 1]
    bc = np.array([BOUNDARY_CODES[data[part]["bc"]] for part in chosen])[material - 1]
    target.particles = Particles(filling.x, material, bc, velocity if velocity.any() else None)
    for part, number in numbers.items():
        target.materials[number] = _material(model.parts[part], number, filling, data[part], settings)
    if particles == "nodes":
        density = np.array([data[part]["density"] for part in chosen])[material - 1]
        target.particles.mass = filling.volume * density
    target.particle_control = _control(target, settings, dimension)
    _report_lost(model, chosen, particles, report)
    report.notes.append(f"{count} particles in {len(chosen)} part(s)")
    if not settings.gives("end_time"):
        report.notes.append(f"end_time is not set: {settings['end_time']:g}")
    if particles != "nodes" and settings["step_option"] == _NEAREST_DISTANCE and len(chosen) > 1:
        report.notes.append("step_option 2 takes the nearest particles of all bodies: touching bodies shorten the step")
    return target, report


def _filled(model: Model, particles: str, spacing: float | None, parts: list[int]) -> Filling:
    if particles == "nodes":
        return copy_nodes(model, parts)
    if particles == "shells" and model.dimension != 2:
        raise ValueError("particles of shells: the mesh is not flat (constant z); expected areas in a plane")
    if particles not in ("solids", "shells"):
        raise ValueError(f"particles of {particles}; expected solids, shells or nodes")
    return fill(model, spacing, parts=parts)


def _part_number(model: Model, asked: int | str) -> int:
    for number, part in model.parts.items():
        if asked == number or str(asked) in (part.name, str(number)):
            return number
    known = ", ".join(f"{number} {part.name}".strip() for number, part in model.parts.items())
    raise ValueError(f"the mesh has no part {asked}; it has: {known or 'none'}")


def _materials_of(model: Model, chosen: list[int], settings: Settings) -> dict[int, dict[str, Any]]:
    """The settings of each part's material, by name or number; all mismatches are faults of the settings."""
    names = {key for number, part in model.parts.items() for key in (part.name, str(number)) if key}
    for group in ("materials", "contact_laws"):
        for name in settings[group]:
            if name not in names:
                expected = "one of " + ", ".join(sorted(names))
                settings.fault((group, name), f"{group} of a part that the mesh does not have", name, expected)
    data: dict[int, dict[str, Any]] = {}
    for number in chosen:
        part = model.parts[number]
        found = settings["materials"].get(part.name) or settings["materials"].get(str(number))
        if found is None:
            name = part.name or str(number)
            settings.fault(
                ("materials",), "a part has no material", name, f"materials: {{{name}: {{law: elastic, ...}}}}"
            )
        else:
            data[number] = found
    settings.stop()
    return data


def _material(part: Part, number: int, filling: Filling, data: dict[str, Any], settings: Settings) -> Material:
    names = ["E", "nu"]
    if data["law"] == "von_mises":
        names += ["yield_stress", "tangent_modulus", "beta"]
        names += ["failure_strain"] if data["failure_strain"] is not None else []
    density = float(data["density"])
    return Material(
        number,
        part.name or f"part {part.id}",
        law=str(data["law"]),
        density=density,
        parameters={name: float(data[name]) for name in names},
        mass=float(f"{density * filling.volumes[part.id]:.14g}"),  # 8.1, not the round-off of its quadrature
        h=float(
            real_text(settings["h_factor"] * filling.spacing[part.id], 10)[0]
        ),  # a choice: one the deck holds exactly
        viscosity_quadratic=settings["viscosity"]["quadratic"] or None,
        viscosity_linear=settings["viscosity"]["linear"] or None,
    )


def _control(target: Model, settings: Settings, dimension: int) -> ParticleControl:
    end = settings["end_time"]
    output, history = settings["output_interval"], settings["history_interval"]
    friction = settings["friction"]
    laws = {name: (law["strength"], law["exponent"]) for name, law in settings["contact_laws"].items()}
    control = ParticleControl(
        dimension=dimension,
        end_time=end,
        step_factor=settings["step_factor"],
        initial_step=settings["initial_step"],
        output_interval=end / FRAMES if output is None else output,
        history_interval=end / ROWS if history is None else history,
        contact=int(settings["contact"] == "potential"),
        step_option=settings["step_option"],
        velocity_option=int(settings["xsph"]),
        h_option=settings["h_option"],
        max_neighbours=400,  # the original stops where a count jumps past its table
        friction=None if friction["static"] is None else (friction["static"], friction["kinetic"]),
        base_acceleration=settings["gravity"] if any(settings["gravity"]) else None,
    )
    if control.friction is not None:
        control.dialect = "2019-10"
    if control.contact:
        for material in target.materials.values():
            law = laws.get(material.name) or laws.get(material.name.removeprefix("part "))
            if law is None:
                expected = f"contact_laws: {{{material.name}: {{strength: K, exponent: n}}}}"
                settings.fault(("contact",), "a part has no contact law", material.name, expected)
            else:
                control.contact_laws.append(law)
        settings.stop()
    return control


def _report_lost(model: Model, chosen: list[int], particles: str, report: Report) -> None:
    """What of the mesh is not in the particle model."""
    left = [part for number, part in model.parts.items() if number not in chosen]
    report.drop("parts", len(left), "not asked for: " + ", ".join(part.name or str(part.id) for part in left))
    for block in model.blocks:
        lower = int((~np.isin(block.part, [part.id for part in model.parts.values()])).sum())
        report.drop(f"{block.kind} elements", lower, "of lower dimension than the parts: no particles are made of them")
    top = {part.name for part in model.parts.values() if part.name}
    sets = [nodes.name or str(nodes.id) for nodes in model.node_sets if nodes.name not in top]
    report.drop("node sets", len(sets), "an .mcm deck has none: " + ", ".join(sets))


def _title(title: str) -> str:
    """A title without commas: one build of the original program reads its first line as a list."""
    return title.replace(",", ";")
