"""From a particle deck's model to the solver's problem: names and numbers change hands, nothing is computed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines import births, contact
from zrno.pipelines.laws import initial_energy, law_of, soil_of
from zrno.pipelines.method import Sph
from zrno.solvers.errors import Unsupported
from zrno.solvers.materials import Law, family
from zrno.solvers.sph import Body, Cures, Plane, Problem, defaults
from zrno.solvers.sph.rings import AXIS
from zrno.translators.model import Eos, Material, Model, ParticleControl
from zrno.translators.text import Fault, InputError
from zrno.translators.yaml_marks import Place

# boundary code of the deck -> fixed x, y, z
_FIXED = np.array(
    [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1), (1, 1, 1)], dtype=bool
)  # fmt: skip

STEP_FACTOR = 0.8
QUADRATIC, LINEAR = 1.5, 0.06  # artificial viscosity where the deck leaves it blank
HELD = 7  # boundary code of particles that do not move
XSPH = 0.1  # the original program's factor
LEAST_DENSITY, MOST_DENSITY = 1e-10, 1e10
SINKS = (
    "the gradient correction weakens what keeps grain out of a wall of particles (sph.bearing), and grain may sink "
    "through it: leave sph.correction off"
)


def particle_problem(
    model: Model,
    path: str,
    *,
    places: Mapping[str, Place] | None = None,
    original: bool = False,
    method: Sph | None = None,
) -> Problem:
    """The problem that a particle deck poses.

    path, places: see `refusals`; original: as the original program does; method: the numerics beyond the deck.

    Raises InputError for what the deck asks and this solver does not do.
    """
    wrong, missing = refusals(model, path, places, method)
    if wrong or missing:
        raise InputError(sorted(wrong + missing))
    control, particles = model.particle_control, model.particles
    assert control is not None
    assert particles is not None
    numbers = sorted(model.materials)
    chosen = Sph(cures="none") if original else method or Sph()
    n = len(particles)
    body = np.searchsorted(numbers, particles.material)
    moving = np.bincount(body, particles.bc != HELD, minlength=len(numbers)) > 0.0
    bodies = [
        _body(model, model.materials[number], control.contact_laws[k] if control.contact else (0.0, 0.0), chosen)
        for k, number in enumerate(numbers)
    ]
    bodies, cures = _with_correction(bodies, moving, control, chosen)
    bodies = contact.with_strengths(bodies, contact.law_of_contact(control, chosen))
    for warning in (contact.unused(control, chosen), births.unused(control)):
        if warning and warning not in model.warnings:
            model.warnings.append(warning)
    sinks = any(b.bearing for b in bodies) and any(family(b.law) == "grain" and b.corrected for b in bodies)
    if sinks and cures.correction and SINKS not in model.warnings:
        model.warnings.append(SINKS)
    owned = np.bincount(body, minlength=len(numbers))
    per_material = [model.materials[i] for i in numbers]

    def of_material(values: list[float]) -> Any:
        return np.array(values, dtype=float)[body]

    energies = [initial_energy(_eos(model, m), m.density) for m in per_material]
    masses = [m.mass / max(1, count) for m, count in zip(per_material, owned, strict=True)]
    mass = of_material(masses) if particles.mass is None else particles.mass
    if particles.mass is None and control.axisymmetric:  # rings of equal section
        radius = np.maximum(particles.x[:, 0], 0.0)
        mean = np.bincount(body, radius, minlength=len(numbers)) / np.maximum(owned, 1)
        mass = mass * radius / np.maximum(mean, 1e-300)[body]
    return Problem(
        title=model.title,
        dimension=control.dimension,
        axisymmetric=control.axisymmetric,
        x=particles.x,
        v=np.zeros((n, 3)) if particles.velocity is None else particles.velocity,
        mass=mass,
        h=of_material([m.h for m in per_material]) if particles.h is None else particles.h,
        density=of_material([m.density for m in per_material]) if particles.rho is None else particles.rho,
        energy=of_material(energies) if particles.e is None and any(energies) else particles.e,
        body=body,
        bodies=tuple(bodies),
        fixed=_FIXED[particles.bc],
        end_time=control.end_time,
        step_option=control.step_option,
        step_factor=control.step_factor or STEP_FACTOR,
        first_step=control.initial_step,
        body_force=control.base_acceleration or (0.0, 0.0, 0.0),
        original=original,
        body_curve=_curve(chosen),
        kernel=chosen.kernel,
        h_option=control.h_option,
        relaxation=control.dynamic_relaxation if 0.1 < control.dynamic_relaxation < 1.0 else 1.0,
        planes=_planes(control),
        traced=tuple(control.history_particles),
        transducers=_transducers(control, numbers),
        cures=cures,
        local_steps=None if chosen.local_steps == "auto" else chosen.local_steps,
        sleep=chosen.sleep,
        birth=births.times(control, particles),
        **contact.options(control, chosen, len(bodies)),
    )


def _curve(method: Sph) -> tuple[Any, Any] | None:
    if method.acceleration is None:
        return None
    table = np.array(method.acceleration)
    return table[:, 0], table[:, 1:]


def _planes(control: ParticleControl) -> tuple[Plane, ...]:
    """The deck's planes xmin, xmax, ymin, ..., as far as its dimension goes."""
    given = enumerate((control.planes or [])[: 2 * control.dimension])
    planes = tuple(Plane(k // 2, 1 if k % 2 else -1, kind, position) for k, (kind, position) in given if kind)
    planes += births.end(control)
    return (AXIS, *planes) if control.axisymmetric and AXIS not in planes else planes


def _transducers(control: ParticleControl, numbers: list[int]) -> tuple[tuple[float, float, float, int], ...]:
    """Places with all three coordinates, and the index of the material that each listens to."""
    found = []
    for *place, material in control.transducers:
        x, y, z = (*place, 0.0, 0.0)[:3]
        found.append((x, y, z, numbers.index(int(material))))
    return tuple(found)


def _with_correction(
    bodies: list[Body], moving: NDArray[np.bool_], control: ParticleControl, method: Sph
) -> tuple[list[Body], Cures]:
    """The cures, and which bodies the gradient correction applies to. moving: (bodies,) not all particles are held."""
    said = True if control.discretisation and method.correction is None else method.correction
    by_material = said is None and method.cures == "auto"
    if by_material:
        chosen = [defaults.correction(b.law) and bool(moves) for b, moves in zip(bodies, moving, strict=True)]
        bodies = [replace(b, corrected=yes) for b, yes in zip(bodies, chosen, strict=True)]
        said = any(yes and not b.lagrangian for b, yes in zip(bodies, chosen, strict=True))
    cures = Cures(
        correction=bool(said),
        artificial_stress=method.artificial_stress,
        xsph=(XSPH if control.velocity_option else 0.0) if method.xsph is None else method.xsph,
    )
    return bodies, cures


def _body(model: Model, material: Material, repulsion: tuple[float, float], method: Sph) -> Body:
    def given(value: float | None, default: float) -> float:
        return value if value else default

    law = _law(model, material, method)
    automatic = method.cures == "auto"
    density, stress, pair = method.density_diffusion, method.stress_diffusion, method.pair_viscosity
    return Body(
        number=material.id,
        name=material.name,
        law=law,
        density=material.density,
        linear=given(material.viscosity_linear, LINEAR),
        quadratic=given(material.viscosity_quadratic, QUADRATIC),
        least=given(material.rho_min, defaults.least_density(law, material.density) or LEAST_DENSITY),
        most=given(material.rho_max, MOST_DENSITY),
        strength=repulsion[0],
        exponent=repulsion[1],
        lagrangian=_stays_whole(material, method),
        hourglass=method.hourglass,
        alpha=pair.alpha if pair else 0.0,
        beta=pair.beta if pair else 0.0,
        bearing=_name(material) in method.bearing,
        density_diffusion=(defaults.density_diffusion(law) if automatic else 0.0) if density is None else density,
        stress_diffusion=(defaults.stress_diffusion(law) if automatic else 0.0) if stress is None else stress,
    )


def _stays_whole(material: Material, method: Sph) -> bool:
    """Whether a material's body is total-Lagrangian."""
    named = method.total_lagrangian
    return named if isinstance(named, bool) else _name(material) in named


def _law(model: Model, material: Material, method: Sph) -> Law:
    said = method.laws.get(_name(material))
    if said is not None:
        return soil_of(material, said, automatic=method.cures == "auto")
    return law_of(material, _eos(model, material), model.curves)


def _name(material: Material) -> str:
    return material.name.removeprefix("part ")


def _eos(model: Model, material: Material) -> Eos | None:
    return None if material.eos is None else model.equations_of_state.get(material.eos)


def refusals(
    model: Model, path: str, places: Mapping[str, Place] | None = None, method: Sph | None = None
) -> tuple[list[Fault], list[Fault]]:
    """What is wrong with a particle deck that its reader cannot know, and what this solver does not do yet.

    path: of the deck. method: the scene's. places: where a control field (`h_option`) or a material (`material 1`) was
    said, if not in it.
    """
    if model.particle_control is None or model.particles is None:
        return [Fault(path, 1, 1, "not a particle deck", model.format, "a .mcm deck")], []
    wrong: list[Fault] = []
    missing: list[Fault] = []
    in_deck = {field: Place(path, *at) for field, at in model.particle_control.places.items()}
    where = {**in_deck, **(places or {})}
    for field, message, said in _not_yet(model.particle_control):
        at = where.get(field, Place(path, 1, 1))
        missing.append(Fault(at.path, at.line, at.column, f"{message} is not computed yet", said, "a deck without it"))
    wrong += _probes_of_nothing(model, path)
    at = where.get("birth_death", Place(path, 1, 1))
    for message, said, expected in births.faults(model.particle_control, model.particles):
        wrong.append(Fault(at.path, at.line, at.column, message, said, expected))
    method = method or Sph()
    wrong += _wrong_names(model, path, method)
    for number, material in sorted(model.materials.items()):
        at = where.get(f"material {number}", Place(path, material.source.line if material.source else 1, 1))
        try:
            _law(model, material, method)
        except Unsupported as error:
            missing.append(Fault(at.path, at.line, at.column, f"material {number}: {error}", "", "a deck without it"))
        except ValueError as error:
            wrong.append(Fault(at.path, at.line, at.column, f"material {number}: {error}", "", "constants of the law"))
    return wrong, missing


def _wrong_names(model: Model, path: str, method: Sph) -> list[Fault]:
    """Materials that the scene names and that there are not, and walls that are not held."""
    assert model.particles is not None
    names = [_name(material) for material in model.materials.values()]
    faults = []
    for key, given in (("laws", list(method.laws)), ("bearing", method.bearing)):
        for name in given:
            if name not in names:
                faults.append(Fault(path, 1, 1, f"sph.{key}: no such material", name, ", ".join(names)))
    for number, material in model.materials.items():
        free = int(np.count_nonzero(model.particles.bc[model.particles.material == number] != HELD))
        if _name(material) in method.bearing and free:
            said = f"{free} free particles of {_name(material)}"
            faults.append(Fault(path, 1, 1, "sph.bearing: a wall moves", said, "bc: xyz of the material"))
    return faults


def _probes_of_nothing(model: Model, path: str) -> list[Fault]:
    """History particles and transducers that name a particle or a material that there is not."""
    control, particles = model.particle_control, model.particles
    assert control is not None
    assert particles is not None
    n = len(particles)
    lost = [i for i in control.history_particles if not 1 <= i <= n]
    faults = [Fault(path, 1, 1, "no such history particle", str(i), f"a number from 1 to {n}") for i in lost]
    known = ", ".join(map(str, sorted(model.materials)))
    for *_, material in control.transducers:
        if int(material) not in model.materials:
            faults.append(Fault(path, 1, 1, "a transducer of no material", str(int(material)), f"one of {known}"))
    return faults


def _not_yet(c: ParticleControl) -> list[tuple[str, str, str]]:
    """What the control cards ask for and this solver does not do yet: field, what it is, what was said."""
    asked = [
        (c.kernel not in (0, 1), "kernel", "a kernel by another number than 1", f"kernel {c.kernel}"),
    ]  # fmt: skip
    return [(field, what, said) for wanted, field, what, said in asked if wanted]
