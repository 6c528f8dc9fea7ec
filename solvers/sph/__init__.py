"""Smoothed particle hydrodynamics for solids."""

from . import measures
from .ghosts import Plane
from .problem import Body, Cures, Problem
from .setup import refuse
from .solver import Solver

__all__ = ["Body", "Cures", "Plane", "Problem", "Solver", "measures", "refuse"]
