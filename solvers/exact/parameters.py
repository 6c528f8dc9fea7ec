"""Checks of the parameters of a solution."""

from __future__ import annotations

import math
from typing import Any


def positive(solution: Any, *names: str) -> None:
    """Raise ValueError unless these parameters are finite and above zero."""
    for name in names:
        value = getattr(solution, name)
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} is {value:g}; expected more than 0")


def chosen(solution: Any, name: str, words: tuple[str, ...]) -> None:
    """Raise ValueError unless this parameter is one of the words."""
    if getattr(solution, name) not in words:
        raise ValueError(f"{name} is {getattr(solution, name)}; expected one of {', '.join(words)}")


def poisson_ratio(solution: Any) -> None:
    """Raise ValueError unless `poisson` is one of a stable solid, 0.5 not included."""
    if not -1.0 < solution.poisson < 0.5:
        raise ValueError(f"poisson is {solution.poisson:g}; expected more than -1 and less than 0.5")
