"""Card 7's birth and death (dialect 2019-10), where the deck's format leaves the meaning open: what this program takes
it for.

The particles of the range are to come: each goes straight on with its initial velocity, and is born where it passes the
plane of birth. A particle that passes the plane of death leaves the run, as beyond a limit plane. A plane goes through
the point of its card; its orientation is the axis across it, 1 to 3 for x to z, negative where particles pass it
downwards.
"""

from __future__ import annotations

import numpy as np

from zrno.solvers.sph import Plane
from zrno.solvers.sph.ghosts import LIMIT
from zrno.solvers.sph.problem import Floats
from zrno.translators.model import ParticleControl, Particles

BIRTH, DEATH, BOTH = 1, 2, 3  # of the card


def _to_come(c: ParticleControl) -> bool:
    return c.birth_death in (BIRTH, BOTH) and c.birth_range is not None and c.birth_plane is not None


def _across(plane: tuple[float, float, float, int]) -> tuple[int, int, float]:
    """Axis 0..2, the direction in which particles pass it, and the coordinate."""
    axis = abs(plane[3]) - 1
    return axis, 1 if plane[3] > 0 else -1, plane[axis]


def times(c: ParticleControl, particles: Particles) -> Floats | None:
    """(n,) when each particle is born, zero of those that are there from the start; None where all are."""
    if not _to_come(c):
        return None
    assert c.birth_range is not None
    assert c.birth_plane is not None
    axis, direction, position = _across(c.birth_plane)
    some = slice(max(0, c.birth_range[0] - 1), c.birth_range[1])
    found = np.zeros(len(particles))
    way = (position - particles.x[some, axis]) * direction
    speed = np.zeros(len(way)) if particles.velocity is None else particles.velocity[some, axis] * direction
    with np.errstate(divide="ignore", invalid="ignore"):
        found[some] = np.where(way > 0.0, np.where(speed > 0.0, way / speed, np.inf), 0.0)
    return found if np.any(found) else None


def end(c: ParticleControl) -> tuple[Plane, ...]:
    """The plane of death as a limit of the problem."""
    if c.birth_death < DEATH or c.death_plane is None:
        return ()
    axis, direction, position = _across(c.death_plane)
    return (Plane(axis, direction, LIMIT, position),)


def faults(c: ParticleControl, particles: Particles) -> list[tuple[str, str, str]]:
    """What is wrong with the cards: message, what was said, what was expected."""
    found = []
    asked = [("birth", c.birth_plane, c.birth_death in (BIRTH, BOTH)), ("death", c.death_plane, c.birth_death >= DEATH)]
    for name, plane, wanted in asked:
        if wanted and plane is not None and not 1 <= abs(plane[3]) <= c.dimension:
            message = f"no such orientation of the plane of {name}: an axis, negative where it is passed downwards"
            found.append((message, str(plane[3]), " or ".join(f"+-{k + 1}" for k in range(c.dimension))))
    if found or not _to_come(c):
        return found
    assert c.birth_range is not None
    if c.birth_range[1] > len(particles):
        found.append(("no such particles to be born", str(c.birth_range[1]), f"numbers up to {len(particles)}"))
    born = times(c, particles)
    if born is None:
        return found
    if np.any(np.isinf(born)):
        first = int(np.argmax(np.isinf(born))) + 1
        message = "particles that are to be born never get to the plane of birth"
        found.append((message, f"{int(np.isinf(born).sum())} of them, the first {first}", "a velocity towards it"))
    if np.all(born > 0.0):
        found.append(("all particles are to be born", f"{len(born)} of {len(born)}", "one that is there at the start"))
    return found


def unused(c: ParticleControl) -> str | None:
    """A warning of a range without a plane; None where there is none."""
    if c.birth_death in (BIRTH, BOTH) and c.birth_range is not None and c.birth_range[1] and c.birth_plane is None:
        return (
            f"birth of particles {c.birth_range[0]} to {c.birth_range[1]} without a plane of birth "
            "(card 7 plane_particle): they are there from the start"
        )
    return None
