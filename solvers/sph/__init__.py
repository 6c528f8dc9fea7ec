"""Smoothed particle hydrodynamics for solids."""
