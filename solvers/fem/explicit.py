"""Explicit dynamics by central differences with a lumped mass: no equations, steps below the stable one."""

from __future__ import annotations

import math

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from numpy.typing import NDArray

from .assembly import Assembly, Mechanism
from .problem import Dynamics
from .shape import Shape

Floats = NDArray[np.float64]
SAFETY = 0.9  # of the stable step


class Stepper:
    """Velocities (n, 6) half a step before the shape, and accelerations at it."""

    def __init__(self, assembly: Assembly, how: Dynamics, start: Shape, velocity: Floats | None) -> None:
        self.assembly = assembly
        self.how = how
        self.diagonal, _ = assembly.mass(lumped=True)
        loose = assembly.free & ~(self.diagonal > 0.0)
        if loose.any():
            node, dof = np.argwhere(loose)[0].tolist()
            raise Mechanism(node, dof, "explicit dynamics needs a mass, and there is none")
        self.velocity = np.zeros((assembly.n, 6)) if velocity is None else np.where(assembly.active, velocity, 0.0)
        self.acceleration = np.zeros((assembly.n, 6))
        self.stable = self._stable(start)
        self.half = 0.0  # how far the velocity lags behind the shape

    def _stable(self, start: Shape) -> float:
        """2 / omega of the fastest vibration."""
        a, s = self.assembly, self.assembly.structure
        if not s.count:
            return math.inf
        scale = 1.0 / np.sqrt(self.diagonal.ravel()[a.where])
        upper = sp.csr_matrix((a.stiffness_values(start), s.columns, s.starts), shape=(s.count,) * 2)
        upper = sp.diags(scale) @ upper @ sp.diags(scale)
        full = upper + sp.triu(upper, 1).T
        if s.count < 3:
            largest = float(np.linalg.eigvalsh(full.toarray())[-1])
        else:
            first = np.random.default_rng(0).standard_normal(s.count)
            largest = float(spl.eigsh(full, 1, which="LA", tol=1e-3, v0=first, return_eigenvectors=False)[0])
        damping = 0.5 * (self.how.stiffness_damping * math.sqrt(largest) + self.how.mass_damping / math.sqrt(largest))
        return 2.0 / math.sqrt(largest) * (math.sqrt(1.0 + damping**2) - damping)

    def parts(self, length: float) -> int:
        """How many stable steps a step takes."""
        return max(1, math.ceil(length / (SAFETY * self.stable)))

    def change(self, forces: Floats, dt: float) -> Floats:
        """The next change (n, 6) of displacement, from loads less stresses now."""
        a = self.assembly
        left = forces - self.how.mass_damping * self.diagonal * self.velocity
        self.acceleration = np.where(a.free, left / np.maximum(self.diagonal, 1e-300), 0.0)
        self.velocity = self.velocity + (0.5 * dt + self.half) * self.acceleration
        self.half = 0.5 * dt
        moved: Floats = np.where(a.free, dt * self.velocity, 0.0)
        return moved

    def at_shape(self, forces: Floats) -> Floats:
        """Velocity at the shape's own time."""
        a = self.assembly
        acceleration = np.where(a.free, forces / np.maximum(self.diagonal, 1e-300), 0.0)
        out: Floats = self.velocity + self.half * acceleration
        return out

    def kinetic(self, forces: Floats) -> float:
        """Kinetic energy by the velocities half a step before and after: with it central differences keep a linear
        structure's energy to the bit, at any stable step."""
        after = 2.0 * self.at_shape(forces) - self.velocity
        return 0.5 * float((self.diagonal * self.velocity * after).sum())
