"""Closed-form solutions: one a file, to measure runs against. Parameters in one consistent system of units.

A solution is a frozen dataclass of its parameters. `SCALARS` names the methods that give a number, `CURVES` those that
give values at abscissae (times or coordinates), shape (n,) -> (n,); the first of all is what the solution is asked for
when nobody says which.
"""

from __future__ import annotations

from typing import Any

from .bar_wave import BarWave
from .column_collapse import ColumnCollapse
from .hugoniot import Hugoniot
from .hydrostatic import Hydrostatic
from .oscillating_plate import OscillatingPlate
from .taylor_bar import TaylorBar
from .verney_shell import VerneyShell

SOLUTIONS: dict[str, Any] = {
    "bar_wave": BarWave,
    "column_collapse": ColumnCollapse,
    "hugoniot": Hugoniot,
    "hydrostatic": Hydrostatic,
    "oscillating_plate": OscillatingPlate,
    "taylor_bar": TaylorBar,
    "verney_shell": VerneyShell,
}

__all__ = [
    "SOLUTIONS",
    "BarWave",
    "ColumnCollapse",
    "Hugoniot",
    "Hydrostatic",
    "OscillatingPlate",
    "TaylorBar",
    "VerneyShell",
]
