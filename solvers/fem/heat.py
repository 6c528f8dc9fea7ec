"""Temperatures: what they make material grow by. Elements that do not expand and runs without them pay nothing.

A structure begins at its materials' reference temperatures, without strain. A node whose temperature is not given stays
at the reference; one in the middle of a shell has what its neighbours have. Through a shell and over a section the
temperature is one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .elements.shapes import functions
from .groups.bars import BarGroup
from .groups.beams import BeamGroup
from .groups.continuum import ContinuumGroup
from .groups.group import Group
from .groups.shells import ShellGroup
from .problem import Problem

Floats = NDArray[np.float64]


def has_heat(problem: Problem) -> bool:
    """Whether temperatures are given to something that expands by them."""
    return bool(problem.temperatures) and any(e.expansion for e in problem.elements)


class Heat:
    """Temperatures of a problem's nodes, brought to the groups that expand. ValueError where one cannot."""

    def __init__(self, problem: Problem, groups: Sequence[Group]) -> None:
        self._problem = problem
        self._groups: list[ContinuumGroup | ShellGroup | BarGroup | BeamGroup] = []
        for group in groups:
            if not group.elements.expansion:
                continue
            if not isinstance(group, ContinuumGroup | ShellGroup | BarGroup | BeamGroup):
                raise ValueError(f"{group.elements.kind} elements that expand with temperature and are born or die "
                                 "are not computed")  # fmt: skip
            self._groups.append(group)
        self._middles = [g.nodes for g in self._groups if isinstance(g, ShellGroup) and g.nodes.shape[1] == 9]

    def at(self, time: float) -> None:
        """The groups' temperatures at the end of a step are those at a time."""
        given = np.full(len(self._problem.x), np.nan)
        for said in self._problem.temperatures:
            factor = 1.0 if said.curve is None else self._problem.curves[said.curve](time)
            given[said.nodes] = factor * said.values
        for nodes in self._middles:
            own = given[nodes[:, :8]] @ functions("quad8", np.zeros((1, 2)))[0][0]
            given[nodes[:, 8]] = np.where(np.isnan(given[nodes[:, 8]]), own, given[nodes[:, 8]])
        for group in self._groups:
            group.warm(np.where(np.isnan(given), group.elements.reference, given))
