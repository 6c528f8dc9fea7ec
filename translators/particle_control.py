"""What rules a particle run: the control cards of an .mcm deck by the settings."""

from __future__ import annotations

from typing import Any

from zrno.translators import held
from zrno.translators.materials import ANY
from zrno.translators.model import Material, Model, ParticleControl
from zrno.translators.report import Report
from zrno.translators.settings import Settings

FRAMES, ROWS = 20, 200  # of output and history where the settings give no interval


def particle_control(
    model: Model, target: Model, settings: Settings, dimension: int, report: Report
) -> ParticleControl:
    """The control cards of a particle deck: what the settings say, else what the mesh does."""
    analysis = model.analysis

    def said(key: str, own: float | None) -> Any:
        return settings[key] if settings.gives(key) or own is None else own

    end = said("end_time", analysis.end_time)
    if not settings.gives("end_time") and analysis.end_time is None:
        report.notes.append(f"end_time is not set: {end:g}")
    output, history = said("output_interval", analysis.output_interval), settings["history_interval"]
    friction, birth = settings["friction"], settings["birth_death"]
    laws = {name: (law["strength"], law["exponent"]) for name, law in settings["contact_laws"].items()}
    gravity = settings["gravity"] if settings.gives("gravity") else held.gravity(model, end, report)
    control = ParticleControl(
        dimension=dimension,
        axisymmetric=settings["axisymmetric"],
        end_time=end,
        step_factor=said("step_factor", analysis.step_factor),
        initial_step=said("initial_step", analysis.initial_step),
        output_interval=end / FRAMES if output is None else output,
        history_interval=end / ROWS if history is None else history,
        contact=int(settings["contact"] == "potential"),
        step_option=settings["step_option"],
        velocity_option=int(settings["xsph"]),
        h_option=settings["h_option"],
        max_neighbours=settings["max_neighbours"],
        discretisation=settings["discretisation"],
        dynamic_relaxation=settings["dynamic_relaxation"],
        history_particles=settings["history_particles"],
        transducers=_transducers(target, settings, dimension),
        planes=_planes(settings, dimension),
        fluid_friction=friction["fluid"],
        birth_death=birth["option"],
        plane_particle=int(birth["birth_plane"] is not None),
        birth_range=birth["particles"],
        birth_plane=birth["birth_plane"],
        death_plane=birth["death_plane"],
        friction=None if friction["static"] is None else (friction["static"], friction["kinetic"]),
        base_acceleration=gravity if any(gravity) else None,
    )
    if control.friction is not None or control.fluid_friction is not None or control.birth_death:
        control.dialect = "2019-10"
    structure = settings["structure"]
    if control.contact:
        for material in target.materials.values():
            law = laws.get(material.name) or laws.get(material.name.removeprefix("part ")) or laws.get(ANY)
            if law is None:
                expected = f"contact_laws: {{{material.name}: {{strength: K, exponent: n}}}}"
                settings.fault(("contact",), "a part has no contact law", material.name, expected)
            else:
                control.contact_laws.append(law)
        if structure["nodes"]:
            control.contact_laws.append((structure["strength"], structure["exponent"]))
        settings.stop()
    if structure["nodes"]:
        _add_structure(target, structure)
    return control


def _add_structure(target: Model, said: Any) -> None:
    """The material of a structure's nodes, which the original programs take for particles behind the deck's own."""
    first = target.materials[1]
    number, particles = len(target.materials) + 1, target.particles
    assert particles is not None
    each = first.mass / max(int((particles.material == 1).sum()), 1)
    target.materials[number] = Material(
        number,
        name="structure",
        law="elastic",
        density=said["density"],
        parameters={"E": said["E"], "nu": said["nu"]},
        mass=each * said["nodes"] if said["mass"] is None else said["mass"],
        h=first.h if said["h"] is None else said["h"],
    )
    target.velocity_overrun = said["nodes"]


def _transducers(target: Model, settings: Settings, dimension: int) -> list[tuple[float, ...]]:
    """Places and materials of the transducers, in as many directions as the deck has; checks the histories too."""
    count, materials = len(target.particles or ()), len(target.materials)
    for number in settings["history_particles"]:
        if number > count:
            settings.fault(("history_particles",), "no such particle", number, f"1 to {count}")
    found: list[tuple[float, ...]] = []
    for *x, material in settings["transducers"]:
        if not 1 <= material <= materials:
            settings.fault(("transducers",), "no such material", material, f"1 to {materials}")
        found.append((*x[:dimension], material))
    settings.stop()
    return found


def _planes(settings: Settings, dimension: int) -> list[tuple[int, float]] | None:
    """Codes and coordinates of the boundary planes; None where there are none."""
    planes = settings["planes"]
    if not any(planes.values()):
        return None
    for axis in "xyz"[:dimension]:
        low, high = (planes[f"{axis}{end}"] or (0, 0.0) for end in ("min", "max"))
        if (low[0] == 2) != (high[0] == 2):
            lone = f"{axis}max" if high[0] == 2 else f"{axis}min"
            settings.fault(("planes", lone), "periodic on one side alone", lone, "periodic planes on both sides")
        elif low[0] and high[0] and low[1] >= high[1]:
            expected = f"above {axis}min = {low[1]:g}"
            settings.fault(("planes", f"{axis}max"), f"the plane {axis}max is not above {axis}min", high[1], expected)
    if dimension == 2 and (planes["zmin"] or planes["zmax"]):
        settings.fault(("planes",), "planes of z in a flat mesh", "z", "planes of x and y")
    settings.stop()
    return [plane or (0, 0.0) for plane in planes.values()]
