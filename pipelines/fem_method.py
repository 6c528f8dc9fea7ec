"""The scene's `fem` section: what a finite element run does beyond its deck; `--set fem.KEY=VALUE` for a bare deck."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator

from zrno.pipelines.sections import NotNegative, Positive, Section, section_of_options, wrong

Count = Annotated[int, Field(ge=1)]


class PathOfLoading(Section):
    """Loads that are found, all growing together: in each step a node moves by `first` (controlled), or the structure
    by the length of arc that this makes. node: its number in the deck; the sign of `first` is the way to go."""

    node: int
    direction: Literal["ux", "uy", "uz", "rx", "ry", "rz"]
    first: float
    controlled: bool = False


class Stop(Section):
    """A rigid smooth plane that nodes cannot pass: a point of it, its normal towards them; stiffness: in multiples of
    the structure's own at each node."""

    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    stiffness: Positive = 3.0

    @field_validator("normal")
    @classmethod
    def _not_zero(cls, value: tuple[float, float, float]) -> tuple[float, float, float]:
        if not any(value):
            raise wrong("has no direction", "a normal that is not 0")
        return value


class Overstress(Section):
    """Visco-plasticity by overstress, in place of an elastic material's law, whose E and nu are the deck's.

    f = J + alpha I1 - k - hardening kappa, I1 positive in tension; d kappa/dt = rate <f/k>^power. flow: alpha of the
    flow, None as alpha.
    """

    law: Literal["perzyna"]
    k: Positive
    alpha: NotNegative = 0.0
    flow: NotNegative | None = None
    rate: Positive
    power: Positive = 1.0
    hardening: NotNegative = 0.0


class Fem(Section):
    """How a structure is computed, where it is not as the deck says.

    solver: of the linear systems (auto: the best that is installed); enhanced: incompatible modes of hexahedra,
    quadrilaterals and four-node shells; dilatation: the mean of an element, against locking in plastic flow; geometry:
    of all groups; iteration: newton factors in each iteration, adaptive where the last one was slow or shells turn far,
    modified once a step; search: line search; tolerance: residual force over the largest force; most: iterations of a
    step; cuts: how often a step is halved; steps: number of equal steps to the deck's end; listing: whether
    displacements, reactions and stresses of each step are also written as text, `listing.lst`; integration: of motion
    in time, alpha of hht's; stops: planes that nodes cannot pass; laws: by the number of the deck's material, for what
    a deck has no card; shear_factor: of shells, 5/6 unless it is said; a large one, 1000, makes shells that do not
    shear.
    """

    solver: Literal["auto", "pardiso", "cholmod", "scipy", "multigrid"] = "auto"
    enhanced: Literal["deck", "all", "none"] = "deck"
    dilatation: Literal["auto", "mean", "plain"] = "auto"
    geometry: Literal["deck", "small", "total", "updated"] = "deck"
    iteration: Literal["adaptive", "newton", "modified"] = "adaptive"
    search: bool | None = None
    tolerance: Positive | None = None
    most: Count | None = None
    cuts: Annotated[int, Field(ge=0, le=30)] = 8
    steps: Count | None = None
    listing: bool = False
    shear_factor: Positive | None = None
    path: PathOfLoading | None = None
    integration: Literal["deck", "newmark", "hht", "central"] = "deck"
    alpha: Annotated[float, Field(ge=-1 / 3, le=0)] = -0.05
    stops: list[Stop] = Field(default_factory=list)
    laws: dict[int, Overstress] = Field(default_factory=dict)


def of_options(options: Mapping[str, Any]) -> Fem:
    """The section that the keys `fem.*` of `--set` make. Raises InputError."""
    return section_of_options(Fem, "fem", options)
