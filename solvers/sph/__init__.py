"""Smoothed particle hydrodynamics for solids."""

from .problem import Body, Problem
from .solver import Solver

__all__ = ["Body", "Problem", "Solver"]
