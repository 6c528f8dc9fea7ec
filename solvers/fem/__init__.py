"""Finite elements: implicit statics and dynamics of solids, plane problems, shells and bars."""

from .assembly import Mechanism
from .groups.group import Bad
from .problem import (
    SMALL,
    TOTAL,
    UPDATED,
    BodyLoad,
    Curve,
    Dynamics,
    Elements,
    FaceLoad,
    Iteration,
    Motion,
    NodalLoad,
    Path,
    Problem,
    Relation,
    Stop,
    Temperature,
)
from .solver import Solver

__all__ = [
    "SMALL",
    "TOTAL",
    "UPDATED",
    "Bad",
    "BodyLoad",
    "Curve",
    "Dynamics",
    "Elements",
    "FaceLoad",
    "Iteration",
    "Mechanism",
    "Motion",
    "NodalLoad",
    "Path",
    "Problem",
    "Relation",
    "Solver",
    "Stop",
    "Temperature",
]
