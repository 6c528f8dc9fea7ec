"""Contact laws between bodies and with walls: one law a file, on numbers; the loops are the solvers'."""

from __future__ import annotations

from .friction import Coulomb, Drag
from .law import repulsion
from .pinball import Pinball, PinballImpact
from .plane import Wall
from .potential import Potential, matching_strength

__all__ = ["Coulomb", "Drag", "Pinball", "PinballImpact", "Potential", "Wall", "matching_strength", "repulsion"]
