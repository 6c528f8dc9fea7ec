"""The scene's `fem` section: what a finite element run does beyond its deck; `--set fem.KEY=VALUE` for a bare deck."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from zrno.pipelines.sections import Positive, Section, section_of_options

Count = Annotated[int, Field(ge=1)]


class PathOfLoading(Section):
    """Loads that are found, all growing together: in each step a node moves by `first` (controlled), or the structure
    by the length of arc that this makes. node: its number in the deck; the sign of `first` is the way to go."""

    node: int
    direction: Literal["ux", "uy", "uz", "rx", "ry", "rz"]
    first: float
    controlled: bool = False


class Fem(Section):
    """How a structure is computed, where it is not as the deck says.

    solver: of the linear systems (auto: the best that is installed); enhanced: incompatible modes of hexahedra,
    quadrilaterals and four-node shells; dilatation: the mean of an element, against locking in plastic flow; geometry:
    of all groups; iteration: newton factors in each iteration, adaptive where the last one was slow or shells turn far,
    modified once a step; search: line search; tolerance: residual force over the largest force; most: iterations of a
    step; cuts: how often a step is halved; steps: number of equal steps to the deck's end; listing: whether
    displacements, reactions and stresses of each step are also written as text, `listing.lst`; shear_factor: of shells,
    5/6 unless it is said; a large one, 1000, makes shells that do not shear.
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


def of_options(options: Mapping[str, Any]) -> Fem:
    """The section that the keys `fem.*` of `--set` make. Raises InputError."""
    return section_of_options(Fem, "fem", options)
