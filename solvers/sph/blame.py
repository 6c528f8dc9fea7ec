"""Why a run cannot go on: the step, the particle, the likely cause."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..errors import Diverged
from .contact import culprit
from .ledger import Ledger
from .problem import Problem
from .state import State

CREATED = 3.0  # so many times the energy put in cannot come out of a stable run


def energy_made(s: State, step: int, ledger: Ledger, now: dict[str, float]) -> Diverged | None:
    """An unstable step makes energy out of nothing, long before a number overflows. now: energies."""
    given = ledger.start["kinetic"] + abs(ledger.start["internal"]) + ledger.work
    made = ledger.made(now)
    if given == 0.0 or made <= CREATED * given:  # a stress at rest stores what nobody put in
        return None
    kinetic = s.rows("mass")[0, : s.n] * np.sum(s.rows("u")[:, : s.n] ** 2, axis=0)
    return Diverged(
        step,
        int(s.id[np.argmax(kinetic)]),
        f"the run has made {made / given:.3g} times the energy that was put in, most of it here: "
        "the step factor may be too large or the material is stretched apart",
    )


def broken(s: State, step: int, i: int) -> Diverged:
    """Particle i ran away in this step."""
    return Diverged(
        step,
        int(s.id[i]),
        "it moved further than its smoothing length in one step, or its velocity is not a number: the step factor "
        "may be too large, two particles coincide, or the material is stretched apart",
    )


def torn(s: State, step: int, i: int) -> Diverged:
    """Particle i of a total-Lagrangian body is turned inside out or stretched apart."""
    f = np.eye(s.d) + s.rows("deformation")[:, i].reshape(s.d, s.d)
    return Diverged(
        step,
        int(s.id[i]),
        f"its volume is {np.linalg.det(f):.3g} and its greatest stretch {np.linalg.norm(f, 2):.3g} times that of "
        "the start: a total-Lagrangian body must stay whole, or the step factor is too large",
    )


def collapsed(p: Problem, s: State, arrays: Any, live: int, step: int, dt: float) -> Diverged:
    """The time step has become so small that the run gets nowhere."""
    cause = "the time step collapsed"
    item = 0
    if p.apart and (found := culprit(arrays, p.dimension, live)):
        item, why = found
        cause += f": {why}"
    elif p.step_option == 2:
        nearest = s.rows("nearest")[0, :live]
        i = int(np.argmin(nearest))
        item = int(s.id[i])
        cause += (
            f" to {dt:.3g}: its nearest neighbour is only {math.sqrt(nearest[i]):.3g} away "
            "(two particles coincide or clump)"
        )
    return Diverged(step, item, cause)
