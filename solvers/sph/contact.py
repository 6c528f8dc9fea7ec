"""What a problem's contact amounts to: the law, friction and walls for the loops, and what they need of the state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..contact import pinball, potential
from ..contact.friction import DASHPOT, STICK, Coulomb, Drag
from ..materials import sound_speed
from .problem import Problem
from .slip import CoulombPairs, DragPairs
from .smoothing import Shape
from .state import Arrays, Floats
from .surface import Surface
from .walls import Walls


@dataclass(frozen=True, slots=True)
class Contact:
    """Arguments of the loops, None for what the problem has not.

    rigid: (bodies,) whether all of a body's particles are fixed: where bodies are apart, it is a wall, and its waves do
    not limit the step.
    """

    law: Any
    friction: Any
    damping: float | None
    walls: Walls | None
    rigid: Any
    normals: bool | None
    by_normals: bool | None
    surface: Surface | None

    def name(self, bodies: int) -> str:
        """What it is, for the log."""
        law = type(self.law).__name__ if self.law is not None else "kernel" if bodies > 1 else "none"
        damped = "" if self.damping is None else f" with damping {self.damping:g}"
        rubbed = {None: "", DragPairs: ", fluid friction", CoulombPairs: ", friction"}
        walls = 0 if self.walls is None else len(self.walls.static)
        said = law.lower() + damped + rubbed[None if self.friction is None else type(self.friction)]
        if self.surface is not None:
            said += f", {len(self.surface.facets.corners)} facets" + (" with friction" if self.rubs else "")
        return said + (f", {walls} wall(s)" + (" with friction" if self.wall_slip else "") if walls else "")

    @property
    def heats(self) -> bool:
        """Whether contact takes energy that is counted."""
        return self.friction is not None or self.damping is not None or self.wall_slip > 0 or self.rubs

    @property
    def wall_slip(self) -> int:
        """Walls whose slip is remembered: all, or none where none has friction."""
        return len(self.walls.static) if self.walls is not None and np.any(self.walls.static > 0.0) else 0

    @property
    def rubs(self) -> bool:
        """Whether there are facets with friction."""
        return self.surface is not None and self.surface.facets.friction is not None

    def pairs(self, radius: float, h: Floats | None, support: float) -> tuple[float, Floats | None]:
        """Search radius and lengths of the list of other bodies, from those of the smoothing kernel.

        Balls that touch are nearer than smoothing lengths; normals need the kernel's support.
        """
        part = self.law.reach / support if self.law is not None and self.normals is None else 1.0
        return radius * part, None if h is None else h * part


def contact_of(problem: Problem, shape: Shape) -> Contact:
    """All of a problem's contact."""
    bodies = problem.bodies
    wave = np.array([sound_speed(b.law, b.density) for b in bodies])
    density = np.array([b.density for b in bodies])
    rigid = _rigid(problem) & (problem.apart and not problem.original)
    law: Any = None
    if problem.pinball is not None:
        shear = np.array([float(getattr(b.law, "shear", 0.0)) for b in bodies])
        modulus = np.where(shear > 0.0, shear, density * wave**2)
        kind = pinball.PinballImpact if problem.pinball_as_printed else pinball.Pinball
        law = kind(1.0, problem.pinball, modulus, 3 - problem.dimension)
    elif problem.potential:
        strength, exponent = [b.strength for b in bodies], [b.exponent for b in bodies]
        law = potential.potential(shape, problem.dimension, strength, exponent, original=problem.original)
    friction = _friction(problem, *(np.where(rigid, np.inf, density * wave**power) for power in (2, 1)))
    return Contact(
        law=law,
        friction=friction,
        damping=problem.contact_damping or None,
        walls=_walls(problem, wave) if problem.walls else None,
        rigid=rigid,
        normals=True if problem.contact_by_normals or friction is not None else None,
        by_normals=True if problem.contact_by_normals else None,
        surface=None
        if problem.facets is None
        else Surface(problem.facets, problem.dimension, wave**2, _radius(problem), watched=problem.sleep > 0.0),
    )


def _rigid(problem: Problem) -> Any:
    """(bodies,) whether a body has no particle that may move."""
    return np.bincount(problem.body, weights=~problem.held, minlength=len(problem.bodies)) == 0


def _friction(problem: Problem, modulus: Floats, impedance: Floats) -> Any:
    """Friction of each pair of bodies; the softer of two says how stiff the tangential spring is."""
    shape = (len(problem.bodies),) * 2
    if isinstance(problem.friction, Drag):
        return DragPairs(np.full(shape, problem.friction.coefficient))
    if problem.friction is None and not problem.friction_between:
        return None
    common = problem.friction or Coulomb(0.0, 0.0)
    static, kinetic = np.full(shape, common.static), np.full(shape, common.kinetic)
    for a, b, pair in problem.friction_between:
        static[a, b] = static[b, a] = pair.static
        kinetic[a, b] = kinetic[b, a] = pair.kinetic
    softer = [np.minimum.outer(values, values) for values in (modulus, impedance)]
    stick, dashpot = (np.where(np.isfinite(s), s, 0.0) * f for s, f in zip(softer, (STICK, DASHPOT), strict=True))
    with np.errstate(invalid="ignore"):
        wave = softer[0] / softer[1]
    wave = np.where(np.isfinite(wave), wave, np.max(wave, initial=0.0, where=np.isfinite(wave)))
    return CoulombPairs(static, kinetic, np.maximum(stick, 1e-300), dashpot, wave)


def _walls(problem: Problem, wave: Floats) -> Walls:
    normals = np.array([w.normal for w in problem.walls], dtype=float)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    none = Coulomb(0.0, 0.0)
    return Walls(
        np.array([w.position for w in problem.walls], dtype=float),
        normals,
        np.array([(w.friction or none).static for w in problem.walls]),
        np.array([(w.friction or none).kinetic for w in problem.walls]),
        wave**2,
        _radius(problem),
    )


def _radius(problem: Problem) -> Floats:
    """(bodies,) half the spacing of a particle, in units of its h."""
    spacing = problem.sections ** (1.0 / problem.dimension) / problem.h
    mine = [spacing[problem.body == b] for b in range(len(problem.bodies))]
    return np.array([0.5 * float(np.median(own)) if len(own) else 0.5 for own in mine])


def culprit(arrays: Arrays, dimension: int, live: int) -> tuple[int, str] | None:
    """The particle whose contact made the step collapse, and why; None where no two bodies are that near."""
    first, count = arrays.c_first[:live], arrays.c_count[:live]
    i = np.repeat(np.arange(live), count)
    if not len(i):
        return None
    j = arrays.c_rows[np.repeat(first - np.concatenate(([0], np.cumsum(count)[:-1])), count) + np.arange(len(i))]
    x = [axis for axis in (arrays.x, arrays.y, arrays.z)[: max(2, dimension)] if axis is not None]
    distance = sum((axis[i] - axis[j]) ** 2 for axis in x)
    k = int(np.argmin(distance))
    nearest = math.sqrt(float(distance[k]))
    a, b = int(arrays.id[i[k]]), int(arrays.id[j[k]])
    if nearest > 0.05 * arrays.h[i[k]]:
        return None
    return a, (
        f"particles {a} and {b} of two bodies are only {nearest:.3g} apart: they coincide from the start, or the "
        "contact is too weak to keep the bodies apart"
    )
