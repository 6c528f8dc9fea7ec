"""A run before its first step: which rows it has, its constants, the first state, and what the log says of all that."""

from __future__ import annotations

import numpy as np

from ..materials import constant_wave, sound_speed, state_rows
from ..neighbours import FAR
from . import local, reference, rest
from .contact import Contact, contact_of
from .facing import slip_rows
from .ghosts import LIMIT
from .particle import DRIVEN
from .problem import STEP_OPTIONS, Cures, Problem
from .smoothing import Shape, normaliser, shape_of, value_at
from .state import Numbers, Rows, State

UNEQUAL = 3.0  # times its own waves' speed, that a body is moved by a neighbour of another body
IMAGE = 0.25  # of h: a particle nearer to its image than this shortens the step no further


def refuse(p: Problem) -> None:
    """ValueError for what a solver refuses of a problem, without the cost of setting one up."""
    shape = shape_of(p.kernel, p.dimension)
    wave = numbers_of(p, contact_of(p, shape), shape, mirrors=False).wave
    local.classes(p, wave, xsph=p.cures.xsph > 0.0)
    rest.resting(p, wave)
    if any(b.lagrangian for b in p.bodies):
        reference.check(p)


def uniform_h(p: Problem) -> bool:
    """Whether all smoothing lengths are equal and stay so."""
    return bool(np.all(p.h == p.h[0])) and p.h_option == 0


def uniform_mass(p: Problem) -> bool:
    """Whether all masses are equal."""
    return bool(np.all(p.mass == p.mass[0]))


def is_mixed(p: Problem) -> bool:
    """Whether bodies of different density are each other's neighbours; the sums then suit that (see `pairs`)."""
    return p.axisymmetric or (len({b.density for b in p.bodies}) > 1 and not p.apart and not p.original)


def rows_of(p: Problem, contact: Contact, cures: Cures, *, local: bool) -> Rows:
    """The optional rows that a run has. cures: that apply, none where all bodies are total-Lagrangian; local: steps."""
    return Rows(
        state=max(state_rows(b.law) for b in p.bodies),
        contact=p.apart or bool(p.walls) or p.facets is not None,
        correction=cures.correction,
        artificial=cures.artificial_stress > 0.0,
        heat=any(b.alpha or b.beta for b in p.bodies),
        density_rate=any(b.density_diffusion for b in p.bodies),
        stress_rate=any(b.stress_diffusion for b in p.bodies),
        xsph=cures.xsph > 0.0,
        changing_h=p.h_option != 0,
        body_work=p.body_curve is not None,
        wave=not (p.original or all(constant_wave(b.law) for b in p.bodies)),
        contact_heat=contact.heats,
        slip=contact.friction is not None,
        normals=contact.normals is not None,
        wall_slip=contact.wall_slip,
        lagrangian=any(b.lagrangian for b in p.bodies),
        local=local,
        hoop=p.axisymmetric,
        driven=p.driven is not None,
        face_slip=slip_rows(p.dimension) if contact.rubs else 0,
        sleep=p.sleep > 0.0,
        bears=p.sleep > 0.0 and p.facets is not None,
        birth=p.birth is not None,
        interface=_unequal(p),
        relaxed=p.relaxation != 1.0,
        absent=p.birth is not None or any(plane.kind == LIMIT for plane in p.planes),
    )


def _unequal(p: Problem) -> bool:
    """Whether a body in kernel contact with another is moved by it much faster than by its own waves."""
    if len(p.bodies) < 2 or p.apart or p.original or any(b.lagrangian for b in p.bodies):
        return False
    density = np.array([b.density for b in p.bodies])
    modulus = density * np.array([sound_speed(b.law, b.density) for b in p.bodies]) ** 2
    mean = 0.5 * np.add.outer(modulus, modulus)
    return bool(np.any(mean > UNEQUAL**2 * modulus))  # over the density of the body in the column


def numbers_of(p: Problem, contact: Contact, shape: Shape, *, mirrors: bool) -> Numbers:
    """The constants of a run. mirrors: whether there are symmetry planes."""
    h = float(p.h[0])
    normal = normaliser(shape, p.dimension)
    times, values = p.body_curve or (np.zeros(2), np.zeros((2, 3)))
    spacing = float(np.median(p.sections ** (1.0 / p.dimension) / p.h))
    at_spacing = value_at(shape, spacing)  # zero of particles that do not reach each other
    wave = np.array([sound_speed(b.law, b.density, _first_energy(p, k)) for k, b in enumerate(p.bodies)])
    scale = normal / h ** (p.dimension + 2) if uniform_h(p) else normal
    return Numbers(
        dimension=p.dimension,
        inverse_h2=1.0 / (h * h),
        scale=scale,
        force_scale=scale * (float(p.mass[0]) if uniform_mass(p) else 1.0),
        normal=normal,
        viscous=np.array([(b.linear, b.quadratic, b.least, b.most) for b in p.bodies]),
        wave=np.where(contact.rigid, 0.0, wave),
        body=np.array(p.body_force if p.body_curve is None else values[0], dtype=float),
        body_times=np.asarray(times, dtype=float),
        body_values=np.asarray(values, dtype=float),
        h_option=p.h_option,
        relaxation=p.relaxation,
        pair_viscosity=np.array([(b.alpha, b.beta) for b in p.bodies]),
        density_diffusion=np.array([b.density_diffusion for b in p.bodies]),
        stress_diffusion=np.array([b.stress_diffusion for b in p.bodies]),
        held_limits=_held_limits(p),
        least_distance=IMAGE if mirrors else 0.0,
        wall=np.array([b.density if b.bearing else 0.0 for b in p.bodies]),
        kinematic_viscosity=np.array([getattr(b.law, "viscosity", 0.0) / b.density for b in p.bodies]),
        corrected=np.array([float(b.corrected) for b in p.bodies]),
        inverse_w=1.0 / at_spacing if at_spacing > 0.0 else 0.0,
        step_option=p.step_option,
        step_factor=p.step_factor,
        original=p.original,
        mixed=is_mixed(p),
    )


def _held_limits(p: Problem) -> bool:
    """Whether held particles limit the step: where their stress is felt by softer bodies, or nothing else is there."""
    if p.original or p.fixed is None:
        return True
    return bool(np.all(p.held)) or (len(p.bodies) > 1 and not p.apart)


def _first_energy(p: Problem, body: int) -> float:
    """Mean energy per unit mass of a body's particles at the start."""
    mine = p.body == body
    return float(p.energy[mine].mean()) if p.energy is not None and np.any(mine) else 0.0


def fill(s: State, p: Problem, numbers: Numbers, has: Rows, shape: Shape) -> None:
    """Put the first state into the rows, and the dummy out of reach."""
    n = s.n
    for name, values in (("x", p.x), ("x_half", p.x), ("x_start", p.x), ("u", p.v)):
        s.rows(name)[:, :n] = values.T[: s.d]
    for name, scalar in (("mass", p.mass), ("h", p.h), ("density", p.density), ("volume", p.sections)):
        s.rows(name)[0, :n] = scalar
    if p.energy is not None:
        s.rows("energy")[0, :n] = p.energy
    if p.stress is not None:
        rows = s.rows("stress")
        rows[:, :n] = p.stress.T[: len(rows)]
    s.id[:n] = np.arange(1, n + 1) if p.id is None else p.id
    s.material[:n] = p.body
    if p.fixed is not None:
        s.fixed[:n] = p.fixed @ np.array([1, 2, 4])
    if p.driven is not None:
        s.fixed[:n][p.driven] = DRIVEN | 7
    if has.changing_h:
        s.rows("h_start")[0, :n] = p.h * p.density ** (1.0 / p.dimension)
    if p.birth is not None:
        s.rows("birth")[0, :n] = p.birth
    if has.wave:
        s.rows("wave")[0, :n] = numbers.wave[p.body]
    if has.correction:  # the unit matrix, for particles that are not yet there
        s.rows("correction")[: s.d] = 1.0
    radius = shape.support * float(p.h.max())
    span = max(float(np.ptp(p.x, axis=0).max()), radius)
    s.place_dummy(float(np.abs(p.x).max()) + FAR * radius + span)


def _of_some(p: Problem) -> str:
    """The names of the bodies whose gradients are corrected, where not all are."""
    named = [b.name for b in p.bodies if b.corrected and not b.lagrangian]
    return "" if all(b.corrected for b in p.bodies) else f" of {', '.join(named)}"


def described(p: Problem, contact: Contact, cures: Cures, has: Rows, threads: int) -> str:
    """What the loops were built for, for the log."""
    laws = ", ".join(dict.fromkeys(type(b.law).__name__ for b in p.bodies))
    beyond = {
        "total-Lagrangian: " + ", ".join(b.name for b in p.bodies if b.lagrangian): has.lagrangian,
        "gradient correction" + _of_some(p): cures.correction,
        f"artificial stress {cures.artificial_stress:g}": has.artificial,
        "density diffusion": has.density_rate,
        "stress diffusion": has.stress_rate,
        f"XSPH {cures.xsph:g}": has.xsph,
        "pair viscosity": has.heat,
        "walls that bear their neighbours' stress": any(b.bearing for b in p.bodies),
        f"h option {p.h_option}": has.changing_h,
        f"dynamic relaxation {p.relaxation:g}": has.relaxed,
        f"{len(p.planes)} boundary plane(s)": bool(p.planes),
        "base acceleration by curve": has.body_work,
        "births": has.birth,
        f"sleep below {p.sleep:g} sqrt(g h)": has.sleep,
        "as the original program": p.original,
        f"{0 if p.driven is None else int(p.driven.sum())} particles driven by a structure": p.driven is not None,
    }
    return (
        f"{'axisymmetric' if p.axisymmetric else f'{p.dimension}D'}, {p.kernel} kernel, "
        f"{'one' if uniform_h(p) else 'variable'} h, "
        f"{'one' if uniform_mass(p) else 'variable'} mass, laws: {laws}, "
        f"contact: {contact.name(len(p.bodies))}, step: {STEP_OPTIONS[p.step_option]}, {threads} thread(s)"
        + "".join(f", {term}" for term, there in beyond.items() if there)
    )
