"""Temperatures: what they make material grow by. Elements that do not expand and runs without them pay nothing.

A structure begins at its materials' reference temperatures, without strain. A node whose temperature is not given stays
at the reference.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .groups.continuum import ContinuumGroup
from .groups.group import Group
from .problem import Problem

Floats = NDArray[np.float64]


def has_heat(problem: Problem) -> bool:
    """Whether temperatures are given to something that expands by them."""
    return bool(problem.temperatures) and any(e.expansion for e in problem.elements)


class Heat:
    """Temperatures of a problem's nodes, brought to the groups that expand. ValueError where one cannot."""

    def __init__(self, problem: Problem, groups: Sequence[Group]) -> None:
        self._problem = problem
        self._groups = [group for group in groups if group.elements.expansion]
        for group in self._groups:
            if not isinstance(group, ContinuumGroup):
                e = group.elements
                raise ValueError(f"{e.kind} {e.family} elements that expand with temperature are not computed, "
                                 "and none that are born or die")  # fmt: skip

    def at(self, time: float) -> None:
        """The groups' temperatures at the end of a step are those at a time."""
        given = np.full(len(self._problem.x), np.nan)
        for said in self._problem.temperatures:
            factor = 1.0 if said.curve is None else self._problem.curves[said.curve](time)
            given[said.nodes] = factor * said.values
        for group in self._groups:
            assert isinstance(group, ContinuumGroup)
            group.warm(np.where(np.isnan(given), group.elements.reference, given))
