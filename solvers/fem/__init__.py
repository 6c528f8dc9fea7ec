"""Finite elements: implicit statics and dynamics of solids, plane problems, shells and bars."""

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
)
from .solver import Solver

__all__ = [
    "SMALL",
    "TOTAL",
    "UPDATED",
    "BodyLoad",
    "Curve",
    "Dynamics",
    "Elements",
    "FaceLoad",
    "Iteration",
    "Motion",
    "NodalLoad",
    "Path",
    "Problem",
    "Relation",
    "Solver",
]
