"""Groups of elements with their state, and which class computes which."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..elements.directors import directors
from ..problem import SMALL, Elements, Problem
from .bars import BarGroup
from .beams import BeamGroup
from .continuum import ContinuumGroup
from .group import Group
from .shells import ShellGroup
from .supports import PointGroup
from .timed import Maker, TimedGroup, has_life
from .turning_beams import TurningBeamGroup

Floats = NDArray[np.float64]

_CLASSES: dict[str, Callable[[Elements, Floats], Group]] = {
    "solid": ContinuumGroup,
    "plane": ContinuumGroup,
    "truss": BarGroup,
    "beam": lambda e, x: BeamGroup(e, x) if e.geometry == SMALL else TurningBeamGroup(e, x),
    "spring": PointGroup,
    "mass": PointGroup,
}


def make_groups(problem: Problem) -> list[Group]:
    """The groups of a problem. ValueError for what is not computed."""
    shells = [k for k, e in enumerate(problem.elements) if e.family == "shell"]
    corners = [problem.elements[k].nodes for k in shells]
    normals = dict(zip(shells, directors(problem.x, corners, problem.fixed), strict=True)) if shells else {}
    groups: list[Group] = []
    for k, e in enumerate(problem.elements):
        make = _maker(e, normals.get(k))
        group: Group = TimedGroup(e, problem.x, make) if has_life(e) else make(problem.x, None)
        groups.append(group)
    return groups


def _maker(elements: Elements, directors: Floats | None) -> Maker:
    """Makes the group of some elements at places of the nodes, and with turned directors."""
    e = elements
    if directors is not None and e.kind in ("tri3", "quad4", "quad9"):
        return lambda x, turn: ShellGroup(
            e, x, directors if turn is None else np.einsum("ekij,ekj->eki", turn[e.nodes], directors)
        )
    if e.family == "beam" and e.geometry != SMALL and has_life(e):
        raise ValueError("beams that are born or die are computed with small displacements only")
    if e.family not in _CLASSES:
        raise ValueError(f"elements {e.kind} of the family {e.family!r} are not computed")
    return lambda x, _: _CLASSES[e.family](e, x)
