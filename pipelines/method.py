"""The scene's `sph` section: what a particle run does beyond its deck; `--set sph.KEY=VALUE` for a bare deck."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from zrno.pipelines.sections import Friction, NotNegative, Positive, Section, section_of_options

Part = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=0, lt=90, allow_inf_nan=False)]
Row = Annotated[list[float], Field(min_length=4, max_length=4)]


class PairViscosity(Section):
    """Monaghan's viscosity between pairs: linear and quadratic coefficients [-]."""

    alpha: NotNegative = 0.0
    beta: NotNegative = 0.0


class Contact(Section):
    """How bodies meet, where it is not as the deck says.

    law: potential (the deck's strengths, or such as suit the bodies) or pinball, of stiffness `pinball`; damping: part
    of critical; by_normals: forces along the normals of the contact, for grain that slides on particles.
    """

    law: Literal["deck", "kernel", "potential", "pinball"] = "deck"
    pinball: Positive = 20.0
    damping: Part = 0.0
    by_normals: bool = False
    friction: Friction | None = None


class Wall(Section):
    """A rigid plane that particles cannot pass: a point of it, its normal towards them, its friction."""

    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    friction: Friction | None = None


class Soil(Section):
    """A law that the deck has no card for. c: cohesion [pressure]; phi, psi: angles [degrees]; E and nu are the deck's.

    match: in which test the cone of Drucker and Prager is as strong as Mohr and Coulomb's hexagon; gaps: whether
    grain that was pulled apart must close again before it bears, None: by `cures`, where it has no cohesion. tension:
    the greatest mean tension [pressure], None: the cone's own, which without a friction angle has no end.
    """

    law: Literal["drucker_prager_soil", "mohr_coulomb"]
    c: NotNegative = 0.0
    phi: Angle
    psi: Angle = 0.0
    match: Literal["compression", "extension", "plane_strain"] = "compression"
    gaps: bool | None = None
    tension: NotNegative | None = None


class Sph(Section):
    """Numerics of smoothed particles; None is what the deck says, or by material where `cures` is auto.

    total_lagrangian: all bodies, or those of these names, move with the neighbours of their start; hourglass: what
    holds their hourglass modes, a share of Young's modulus. acceleration: rows of time and base acceleration in x, y,
    z, linear between them, in place of the deck's. laws: by the name of the deck's material, in place of the elastic
    one there. bearing: names of materials whose particles, all held, bear the stress of what leans on them.
    local_steps: stiff bodies take several steps within one of the others; auto: where that goes and is worth while.
    sleep: what moves slower than this part of sqrt(g h) for a time is held, and not computed, until it is pushed.
    """

    kernel: Literal["cubic", "quintic", "lucy", "gaussian", "wendland_c2", "wendland_c4"] = "cubic"
    cures: Literal["auto", "none"] = "auto"
    correction: bool | None = None
    artificial_stress: Part = 0.0
    density_diffusion: Part | None = None
    stress_diffusion: Part | None = None
    xsph: Part | None = None
    pair_viscosity: PairViscosity | None = None
    total_lagrangian: bool | list[str] = False
    hourglass: Part = 0.8
    contact: Contact = Field(default_factory=Contact)
    walls: list[Wall] = Field(default_factory=list)
    acceleration: Annotated[list[Row], Field(min_length=2)] | None = None
    laws: dict[str, Soil] = Field(default_factory=dict)
    bearing: list[str] = Field(default_factory=list)
    local_steps: bool | Literal["auto"] = "auto"
    sleep: Part = 0.0


def of_options(options: Mapping[str, Any]) -> Sph:
    """The section that the keys `sph.*` of `--set` make. Raises InputError."""
    return section_of_options(Sph, "sph", options)
