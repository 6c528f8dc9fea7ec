"""Implicit dynamics: Newmark 1959, its alpha form (Hilber, Hughes & Taylor 1977) and Wilson's theta (1968).

Inertia and damping join the forces of a step's equilibrium: residual = loads - stresses - M a - C v, a and v from the
step's displacement. Rayleigh's damping is C = mass_damping M + stiffness_damping K0, K0 of the first shape.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import linear
from .assembly import Assembly
from .equilibrium import Target
from .libraries import Singular
from .problem import Dynamics
from .shape import Shape

Floats = NDArray[np.float64]


class Integrator:
    """Velocities and accelerations (n, 6) of a structure, and what they ask of a step."""

    def __init__(self, assembly: Assembly, how: Dynamics, start: Shape, velocity: Floats | None) -> None:
        self.how = how
        self.assembly = assembly
        n = assembly.n
        self.velocity = np.zeros((n, 6)) if velocity is None else np.where(assembly.active, velocity, 0.0)
        self.acceleration = np.zeros((n, 6))
        self.diagonal, self._mass_values = assembly.mass(lumped=how.lumped)
        self._mass = assembly.full_matrix("mass") if not how.lumped else None
        self._rigidity = None
        self._rigidity_values: Floats | None = None
        if how.stiffness_damping:
            self._rigidity = assembly.full_matrix("stiffness", start)
            self._rigidity_values = assembly.stiffness_values(start, stops=False)  # planes have no damping
        self.alpha = how.alpha if how.method == "hht" else 0.0
        self.beta, self.gamma = how.beta, how.gamma
        if how.method == "hht":
            self.beta, self.gamma = 0.25 * (1.0 - self.alpha) ** 2, 0.5 - self.alpha
        if how.method == "wilson":
            self.beta, self.gamma = 1.0 / 6.0, 0.5
        self.theta = how.theta if how.method == "wilson" else 1.0
        self._mass_system: linear.System | None = None
        self.last = np.zeros((n, 6))  # loads - stresses - damping at the last state, for the alpha form

    def inertia(self, acceleration: Floats) -> Floats:
        """M a (n, 6)."""
        if self._mass is None:
            return self.diagonal * acceleration
        return _product(self._mass, acceleration)

    def damping(self, velocity: Floats) -> Floats:
        """C v (n, 6)."""
        out = np.zeros_like(velocity)
        if self.how.mass_damping:
            out += self.how.mass_damping * self.inertia(velocity)
        if self._rigidity is not None:
            out += self.how.stiffness_damping * _product(self._rigidity, velocity)
        return out

    def begin(self, forces: Floats) -> None:
        """Accelerations of the first state. forces: (n, 6) loads less stresses."""
        left = forces - self.damping(self.velocity)
        self.last = left.copy()
        self.acceleration = self._accelerated(left)

    def jump(self, change: Floats) -> Floats:
        """Loads (n, 6) change at once: so do the accelerations. Returns the change of the forces of inertia."""
        self.last = self.last + change
        acceleration = self._accelerated(change)
        self.acceleration = self.acceleration + acceleration
        return self.inertia(acceleration)

    def _accelerated(self, forces: Floats) -> Floats:
        """M^-1 forces, zero where nothing moves; zero if parts of the structure have no mass: they start at rest."""
        a = self.assembly
        if self._mass_values is None:
            out: Floats = np.where(a.free & (self.diagonal > 0.0), forces / np.maximum(self.diagonal, 1e-300), 0.0)
            return out
        found = np.zeros(6 * a.n)
        if self._mass_values.any():
            try:
                if self._mass_system is None:
                    s = a.structure
                    system = linear.System(
                        s.starts, s.columns, kind="definite", method=a.problem.solver, threads=a.threads
                    )
                    system.values[:] = self._mass_values
                    system.factor()
                    self._mass_system = system
                found[a.where] = self._mass_system.solve(forces.ravel()[a.where])
            except Singular:
                pass
        return found.reshape(a.n, 6)

    def of_change(self, change: Floats, dt: float) -> tuple[Floats, Floats]:
        """Velocity and acceleration at the end of a step that moves by `change` (n, 6)."""
        acceleration = (change - dt * self.velocity) / (self.beta * dt * dt)
        acceleration -= (0.5 / self.beta - 1.0) * self.acceleration
        velocity = self.velocity + dt * ((1.0 - self.gamma) * self.acceleration + self.gamma * acceleration)
        return velocity, acceleration

    def target(self, start: Shape, change: Floats, external: Any, dt: float) -> Target:
        """What a step's equilibrium is. external: loads at a shape."""
        now = 1.0 + self.alpha

        def inertia(shape: Shape) -> Floats:
            velocity, acceleration = self.of_change(shape.u - start.u, dt)
            out = self.inertia(acceleration) + now * self.damping(velocity)
            return out + self.alpha * self.last if self.alpha else out

        def loads(shape: Shape) -> Floats:
            out: Floats = now * external(shape)
            return out

        mass = self._mass_values if self._mass_values is not None else self.assembly.diagonal_values(self.diagonal)
        by_velocity = now * self.gamma / (self.beta * dt)
        matrix = (1.0 / (self.beta * dt * dt) + self.how.mass_damping * by_velocity) * mass
        if self._rigidity_values is not None:
            matrix = matrix + self.how.stiffness_damping * by_velocity * self._rigidity_values
        return Target(change, loads, inertia, matrix, now)

    def finish(self, change: Floats, forces: Floats, dt: float) -> None:
        """Take over the end of a step. change: (n, 6) of it; forces: loads less stresses there."""
        self.velocity, self.acceleration = self.of_change(change, dt)
        self.last = forces - self.damping(self.velocity)

    def interpolated(self, change: Floats, dt: float) -> Floats:
        """Wilson: the change at dt of a step that was taken to theta dt; velocity and acceleration go there."""
        _, beyond = self.of_change(change, self.theta * dt)
        end = self.acceleration + (beyond - self.acceleration) / self.theta
        moved = dt * self.velocity + dt * dt / 6.0 * (end + 2.0 * self.acceleration)
        self.velocity = self.velocity + 0.5 * dt * (end + self.acceleration)
        self.acceleration = end
        return moved

    def kinetic(self) -> float:
        """Kinetic energy."""
        return 0.5 * float((self.velocity * self.inertia(self.velocity)).sum())

    def momentum(self) -> Floats:
        """Linear momentum (3,)."""
        out: Floats = self.inertia(self.velocity)[:, :3].sum(axis=0)
        return out


def _product(matrix: Any, values: Floats) -> Floats:
    out: Floats = (matrix @ values.ravel()).reshape(values.shape)
    return out
