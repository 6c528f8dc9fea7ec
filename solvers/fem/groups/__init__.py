"""Groups of elements with their state, and which class computes which."""

from __future__ import annotations

from ..elements.directors import directors
from ..problem import Problem
from .bars import BarGroup
from .continuum import ContinuumGroup
from .group import Group
from .shells import ShellGroup


def make_groups(problem: Problem) -> list[Group]:
    """The groups of a problem. ValueError for a family that is not computed."""
    shells = [k for k, e in enumerate(problem.elements) if e.family == "shell"]
    corners = [problem.elements[k].nodes[:, :4] for k in shells]
    normals = dict(zip(shells, directors(problem.x, corners, problem.fixed), strict=True)) if shells else {}
    groups: list[Group] = []
    for k, e in enumerate(problem.elements):
        if e.family in ("solid", "plane"):
            groups.append(ContinuumGroup(e, problem.x))
        elif e.family == "truss":
            groups.append(BarGroup(e, problem.x))
        elif e.family == "shell" and e.kind == "quad4":
            groups.append(ShellGroup(e, problem.x, normals[k]))
        else:
            raise ValueError(f"elements {e.kind} of the family {e.family!r} are not computed")
    return groups
