"""The scene's `coupling` section: how grain and structure meet; `--set coupling.KEY=VALUE` for a bare pair of decks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from zrno.pipelines.sections import Friction, Positive, Section, section_of_options


class Coupling(Section):
    """How grain and structure meet, where it is not as the particle deck says.

    surface: the wetted elements: all, or numbers of groups of elements; contact: None as the deck says; tolerance: of
    the force in a period, relative: each period is iterated to it (strong coupling), once without; most: iterations;
    rigid: the structure does not deform, it moves as its prescribed and held nodes do, and nothing is solved;
    relaxation: the share of the grain's force that the structure gets in the next period, the rest in those after it;
    None: 1 with inertia, 0.2 without, where all at once makes it jump.
    """

    surface: str | int | list[str | int] = "all"
    contact: Literal["kernel", "potential", "pinball", "face"] | None = None
    friction: Friction | None = None
    tolerance: Positive | None = None
    most: Annotated[int, Field(ge=2, le=200)] = 30
    rigid: bool = False
    relaxation: Annotated[float, Field(gt=0, le=1)] | None = None


def of_options(options: Mapping[str, Any]) -> Coupling:
    """The section that the keys `coupling.*` of `--set` make. Raises InputError."""
    return section_of_options(Coupling, "coupling", options)
