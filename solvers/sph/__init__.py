"""Smoothed particle hydrodynamics for solids."""

from .ghosts import Plane
from .ledger import Ledger, total
from .problem import Body, Cures, Problem
from .setup import refuse
from .solver import Solver

__all__ = ["Body", "Cures", "Ledger", "Plane", "Problem", "Solver", "refuse", "total"]
