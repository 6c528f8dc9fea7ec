"""Which class computes a group of elements."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .bars import BarGroup
from .continuum_group import ContinuumGroup
from .group import Group
from .problem import Elements

_CLASSES: dict[str, Callable[[Elements, NDArray[np.float64]], Group]] = {
    "solid": ContinuumGroup,
    "plane": ContinuumGroup,
    "truss": BarGroup,
}


def make_group(elements: Elements, x: NDArray[np.float64]) -> Group:
    """The group of some elements of a structure with nodes at x (n, 3). ValueError for a family that is not computed."""
    if elements.family not in _CLASSES:
        raise ValueError(f"elements of the family {elements.family!r} are not computed")
    return _CLASSES[elements.family](elements, x)
