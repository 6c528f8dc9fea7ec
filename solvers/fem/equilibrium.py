"""Equilibrium of one step: Newton's method with its variants, and steps that are cut where it does not converge."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .assembly import Assembly, Mechanism
from .groups.group import Bad
from .problem import Iteration
from .shape import Shape
from .structure import dot

Floats = NDArray[np.float64]
SEARCHED = 0.8  # line search is done where the work along the step stays above this share
SLACK = 1e-12  # of the largest forces on the way: less is round-off
LEAST = 1e-6  # of the same: what the forces at the end are taken to be at least, as where a structure only turns
GUESSED = 8  # iterations from a guess; one that takes more was none
FAST = 0.1  # an iteration that leaves less of the residual than this needs no new factors


class NotConverged(ArithmeticError):
    """A step without equilibrium. worst: (node index, dof) where most is missing, or None."""

    def __init__(self, cause: str, worst: tuple[int, int] | None = None) -> None:
        super().__init__(cause)
        self.cause = cause
        self.worst = worst


@dataclass(frozen=True, slots=True)
class Scale:
    """Of a step like this: the largest force on the way; the energy of its first iteration without a guess."""

    force: float = 0.0
    energy: float = 0.0


@dataclass(slots=True)
class Trace:
    """How a step's iterations went: residual forces over the loads, by iteration."""

    residuals: list[float] = field(default_factory=list)
    factorisations: int = 0
    scale: Scale = Scale()


@dataclass(frozen=True, slots=True)
class Target:
    """What a step goes to.

    change: (n, 6) prescribed change of displacement; external: forces (n, 6) at a shape; inertia: forces (n, 6) that
    grow with the change since the step's start, or None, their matrix (values of the structure), and the share that the
    stresses' forces and stiffness have.
    """

    change: Floats
    external: Callable[[Shape], Floats]
    inertia: Callable[[Shape], Floats] | None = None
    inertia_matrix: Floats | None = None
    share: float = 1.0


def equilibrium(
    assembly: Assembly, start: Shape, target: Target, dt: float, how: Iteration, *, definite: bool = True,
    keep: bool = False, guess: Floats | None = None, scale: Scale = Scale(),
) -> tuple[Shape, Floats, Trace]:  # fmt: skip
    """The shape in equilibrium, the internal forces (n, 6) and how the iterations went. Raises NotConverged.

    keep: the factors that there are hold, of a linear structure and an equal step; guess: (n, 6) a change to begin
    with, prescribed motion included, in place of the answer to the stiffness at the start; scale: of a step like this.
    After a guess the energy asked for is a share of what `scale` tells.
    """
    trace = Trace()
    turns = start.turn is not None  # old factors of a thin shell that turns stretch it: they lead away
    shape = start if guess is None else start.moved(guess)
    moved = target.change if guess is None and target.change.any() else None
    stale = not keep if guess is None else turns or not assembly.system.factored  # the factors are to be made anew
    loads = target.external(shape)
    stiff = stale or moved is not None or (keep and assembly.heat is not None)  # enhanced strains grow through it
    internal, of_motion = _evaluate(assembly, shape, start, dt, stiff=stiff, moved=moved)
    residual = _residual(assembly, target, shape, loads, internal, of_motion)
    largest = max(scale.force, _size(loads), _size(of_motion), _size(internal), _size(residual))  # inertia too
    most = largest / LEAST  # what a wild answer makes of it does not count
    if guess is not None:
        stale = stale or _share(residual, loads, internal, largest) > FAST
    first_energy, before = 0.0, math.inf
    lost: Mechanism | None = None
    for iteration in range(how.most if guess is None else min(how.most, GUESSED)):
        if stale:
            if not stiff:
                internal, _ = _evaluate(assembly, shape, start, dt, stiff=True, moved=None)
                residual = _residual(assembly, target, shape, loads, internal, None)
            definite = _factor(assembly, target, definite=definite)
            trace.factorisations += 1
        stiff = False
        try:
            answer, lost = assembly.solve(residual), None
        except Mechanism as error:
            if error.answer is None or (iteration == 0 and guess is None):
                raise
            answer, lost = error.answer, error  # flow hardly resists: the forces will tell what the step is worth
        step = assembly.expand(answer)
        if iteration == 0 and moved is not None:
            step = step + target.change
        along = dot(residual, assembly.gather(step)) if iteration else 0.0
        trial = shape.moved(step)
        loads = target.external(trial)
        internal, _ = _evaluate(assembly, trial, start, dt, stiff=False, moved=None)
        left = _residual(assembly, target, trial, loads, internal, None)
        if how.search and iteration:
            trial, loads, internal, left = _searched(
                assembly, target, shape, start, step, dt, left, along, (trial, loads, internal)
            )
        largest = max(largest, min(max(_size(loads), _size(internal)), most))
        energy = abs(dot(residual, assembly.gather(step)))
        if iteration == 0:
            first_energy = max(energy, _energy(loads, step), scale.energy if guess is not None else 0.0)
        trace.scale = Scale(largest, first_energy)
        shape, residual = trial, left
        size = _share(residual, loads, internal, largest)
        trace.residuals.append(size)
        if not math.isfinite(size):
            raise NotConverged("the forces are not finite")
        round_off = float(np.abs(residual).max(initial=0.0)) <= SLACK * largest
        if round_off or _converged(how, size, energy, first_energy, step, shape, start):
            return shape, internal, trace
        slow = size > FAST * before
        always = how.method == "newton" or (how.method == "adaptive" and turns)
        near = guess is not None and size <= FAST**2  # the matrix is that of the guess, which was good
        stale = not keep and ((always and not near) or (how.method != "modified" and slow))
        before = size
    if lost is not None:
        raise lost
    worst = divmod(int(assembly.where[int(np.argmax(np.abs(residual)))]), 6) if assembly.transform is None else None
    count, last = len(trace.residuals), trace.residuals[-1]
    raise NotConverged(f"no equilibrium after {count} iterations: the residual force is {last:.1e} of the loads", worst)


def _share(residual: Floats, loads: Floats, internal: Floats, largest: float) -> float:
    """The residual force over the forces now; these are taken to be LEAST of the largest on the way at least."""
    scale = max(_size(loads), _size(internal), LEAST * largest)
    return float(np.abs(residual).max(initial=0.0)) / scale if scale else 0.0


def _evaluate(
    assembly: Assembly, shape: Shape, start: Shape, dt: float, *, stiff: bool, moved: Floats | None
) -> tuple[Floats, Floats]:
    try:
        return assembly.evaluate(shape, start, dt, stiff=stiff, moved=moved)
    except Bad as error:
        raise NotConverged(f"element {error.element}: {error.cause}") from error


def _factor(assembly: Assembly, target: Target, *, definite: bool) -> bool:
    """Factor; past a limit point the matrix is no longer definite. Returns whether it was."""
    try:
        assembly.factor(extra=target.inertia_matrix, scale=target.share, definite=definite)
    except Mechanism:
        if not definite or not assembly.structure.symmetric:
            raise
        assembly.factor(definite=False)
        return False
    return definite


def _residual(
    assembly: Assembly, target: Target, shape: Shape, loads: Floats, internal: Floats, of_motion: Floats | None
) -> Floats:
    out = loads - target.share * internal
    if target.inertia is not None:
        out = out - target.inertia(shape)
    if of_motion is not None:
        out = out - target.share * of_motion
    return assembly.gather(out)


def _searched(
    assembly: Assembly, target: Target, shape: Shape, start: Shape, step: Floats, dt: float, left: Floats, along: float,
    found: tuple[Shape, Floats, Floats],
) -> tuple[Shape, Floats, Floats, Floats]:  # fmt: skip
    """Where the work along the step vanishes, by a few secants (Crisfield 1991, 9.2)."""
    trial, loads, internal = found
    direction = assembly.gather(step)
    share, before, g0 = 1.0, 0.0, along
    for _ in range(4):
        g = dot(left, direction)
        if abs(g) <= SEARCHED * abs(along) or g0 == g:
            break
        share, before = min(max(share - g * (share - before) / (g - g0), 0.1), 2.0), share
        g0 = g
        trial = shape.moved(share * step)
        loads = target.external(trial)
        internal, _ = _evaluate(assembly, trial, start, dt, stiff=False, moved=None)
        left = _residual(assembly, target, trial, loads, internal, None)
    return trial, loads, internal, left


def _converged(
    how: Iteration, size: float, energy: float, first_energy: float, step: Floats, shape: Shape, start: Shape
) -> bool:
    if how.energy and energy > how.energy * first_energy:
        return False
    if how.displacement:
        moved = float(np.abs(shape.u - start.u).max())
        if float(np.abs(step).max()) > how.displacement * moved:
            return False
    return not how.force or size <= how.force


def _size(forces: Floats) -> float:
    return float(np.abs(forces).max(initial=0.0))


def _energy(forces: Floats, step: Floats) -> float:
    return abs(float((forces * step).sum()))
