"""Groups of elements with their state, and which class computes which."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..elements.directors import directors
from ..problem import Elements, Problem
from .bars import BarGroup
from .beams import BeamGroup
from .continuum import ContinuumGroup
from .group import Group
from .shells import ShellGroup
from .supports import PointGroup

_CLASSES: dict[str, Callable[[Elements, NDArray[np.float64]], Group]] = {
    "solid": ContinuumGroup,
    "plane": ContinuumGroup,
    "truss": BarGroup,
    "beam": BeamGroup,
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
        if e.family == "shell" and e.kind in ("tri3", "quad4", "quad9"):
            groups.append(ShellGroup(e, problem.x, normals[k]))
        elif e.family in _CLASSES:
            groups.append(_CLASSES[e.family](e, problem.x))
        else:
            raise ValueError(f"elements {e.kind} of the family {e.family!r} are not computed")
    return groups
