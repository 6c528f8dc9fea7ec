"""Coupling of a structure (finite elements) with particles that touch it."""

from .solver import Coupled, Exchange

__all__ = ["Coupled", "Exchange"]
