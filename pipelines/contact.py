"""How the bodies of a particle run meet: from the deck and the scene's `sph` section to the solver's terms."""

from __future__ import annotations

import dataclasses
from typing import Any

from zrno.pipelines.method import Sph
from zrno.pipelines.sections import Friction
from zrno.solvers.contact.friction import Coulomb, Drag
from zrno.solvers.contact.plane import Wall
from zrno.solvers.contact.potential import matching_strength
from zrno.solvers.materials import sound_speed
from zrno.solvers.sph import Body
from zrno.translators.model import ParticleControl

EXPONENT = 4.0  # of the contact potential, where the deck gives none


def law_of_contact(control: ParticleControl, method: Sph) -> str:
    """kernel, potential or pinball: what the scene says, or else the deck."""
    if method.contact.law != "deck":
        return method.contact.law
    return "potential" if control.contact == 1 else "kernel"


def with_strengths(bodies: list[Body], law: str) -> list[Body]:
    """Bodies whose contact potential is as stiff as they are, where the deck says nothing."""
    if law != "potential" or any(body.strength for body in bodies):
        return bodies
    return [
        dataclasses.replace(
            body, strength=matching_strength(sound_speed(body.law, body.density), body.density), exponent=EXPONENT
        )
        for body in bodies
    ]


def options(control: ParticleControl, method: Sph, bodies: int) -> dict[str, Any]:
    """The fields of a problem that say how its bodies meet each other and walls."""
    law, contact = law_of_contact(control, method), method.contact
    return {
        "potential": law == "potential",
        "pinball": contact.pinball if law == "pinball" else None,
        "contact_damping": contact.damping,
        "contact_by_normals": contact.by_normals,
        "friction": _friction(control, method) if law != "kernel" and bodies > 1 else None,
        "walls": tuple(Wall(w.position, w.normal, _coulomb(w.friction)) for w in method.walls),
    }


def unused(control: ParticleControl, method: Sph) -> str:
    """A warning of friction that a deck gives and its contact cannot have; empty where there is none."""
    if law_of_contact(control, method) != "kernel" or _friction(control, method) is None:
        return ""
    return "the friction of card 7 does nothing: with kernel contact (contact 0) bodies stick; contact 1 repels"


def friction_of(control: ParticleControl, friction: Friction | None) -> Coulomb | None:
    """Of facets: what the scene says, or else card 7 of the deck."""
    if friction is not None:
        return _coulomb(friction)
    if control.friction is None:
        return None
    return Coulomb(control.friction[0], min(control.friction))


def _coulomb(friction: Friction | None) -> Coulomb | None:
    return None if friction is None else Coulomb(friction.static, friction.kinetic)


def _friction(control: ParticleControl, method: Sph) -> Coulomb | Drag | None:
    if method.contact.friction is not None:
        return _coulomb(method.contact.friction)
    if control.fluid_friction is not None:
        return Drag(control.fluid_friction)
    if control.friction is not None:
        static, kinetic = control.friction
        return Coulomb(static, min(static, kinetic))
    return None
