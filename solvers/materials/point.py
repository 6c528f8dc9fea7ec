"""A law at one point, driven along a path of strain or of stress: how a law is verified before it enters a solver."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from ..jit import kernel
from . import Law
from .law import rotate_state, state_rows, stress_update
from .rotation import spin_rotation

Floats = NDArray[np.float64]


class Path(NamedTuple):
    """What a law answers after each of m increments.

    stress: (m, 6) [pressure]; state: (m, rows); dissipated: (m,) energy per volume of each increment; strain: (m, 6)
    in sum; density: (m,); energy: (m,) per unit mass.
    """

    stress: Floats
    state: Floats
    dissipated: Floats
    strain: Floats
    density: Floats
    energy: Floats


@kernel
def _drive(law, strain, spin, dt, stress, state, bulk, stresses, states, dissipated, densities, energies):
    """bulk: density and energy. The energy grows by the mean of old and new stress over the mean density."""
    xx, yy, zz, xy, yz, zx = stress[0], stress[1], stress[2], stress[3], stress[4], stress[5]
    rho, energy = bulk[0], bulk[1]
    for k in range(len(strain)):
        e = strain[k]
        w = spin[k]
        old = rho
        half = 0.5 * (e[0] + e[1] + e[2])
        rho *= (1.0 - half) / (1.0 + half)  # exp(-tr e) to the third order
        work = xx * e[0] + yy * e[1] + zz * e[2] + 2.0 * (xy * e[3] + yz * e[4] + zx * e[5])
        xx, yy, zz, xy, yz, zx = spin_rotation(w[0], w[1], w[2], xx, yy, zz, xy, yz, zx)
        rotate_state(law, w[0], w[1], w[2], state, 0)
        xx, yy, zz, xy, yz, zx, heat = stress_update(
            law, e[0], e[1], e[2], e[3], e[4], e[5], xx, yy, zz, xy, yz, zx, rho, energy, dt, state, 0
        )
        work += xx * e[0] + yy * e[1] + zz * e[2] + 2.0 * (xy * e[3] + yz * e[4] + zx * e[5])
        energy += work / (rho + old)
        stresses[k, 0] = xx
        stresses[k, 1] = yy
        stresses[k, 2] = zz
        stresses[k, 3] = xy
        stresses[k, 4] = yz
        stresses[k, 5] = zx
        states[k] = state[:, 0]
        dissipated[k] = heat
        densities[k] = rho
        energies[k] = energy


class Point:
    """A law with its stress, state, density and energy at one point; `move` takes it along a path."""

    def __init__(
        self, law: Law, *, stress: Floats | None = None, density: float = 1.0, energy: float = 0.0, dt: float = 1.0
    ) -> None:
        self.law = law
        self.dt = dt
        self.strain = np.zeros(6)
        self.stress = np.zeros(6) if stress is None else np.array(stress, dtype=float)
        self.state = np.zeros((max(1, state_rows(law)), 1))
        self.bulk = np.array([density, energy])

    def move(self, strain: Floats, spin: Floats | None = None) -> Path:
        """Along increments of strain (m, 6) and of spin (m, 3) xy yz zx."""
        path = self._answer(strain, spin, self.state)
        if len(strain):
            self.stress = path.stress[-1].copy()
            self.bulk = np.array([path.density[-1], path.energy[-1]])
            self.strain = path.strain[-1].copy()
        return path

    def _answer(self, strain: Floats, spin: Floats | None, state: Floats) -> Path:
        m = len(strain)
        strain = np.ascontiguousarray(strain, dtype=float)
        spin = np.zeros((m, 3)) if spin is None else np.ascontiguousarray(spin, dtype=float)
        stress, states, heat, rho, e = (
            np.empty((m, 6)), np.empty((m, len(state))), np.empty(m), np.empty(m), np.empty(m)
        )  # fmt: skip
        _drive(self.law, strain, spin, self.dt, self.stress, state, self.bulk, stress, states, heat, rho, e)
        return Path(stress, states[:, : state_rows(self.law)], heat, self.strain + np.cumsum(strain, axis=0), rho, e)

    def hold(self, strain: Floats, held: NDArray[np.bool_] | tuple[bool, ...], stress: Floats) -> Path:
        """As `move`, but the components of `held` (6,) take the strain that brings them to `stress` (m, 6).

        So a triaxial test is driven: the axial strain given, the lateral stress held. RuntimeError where no strain
        does.
        """
        held = np.asarray(held, dtype=bool)
        free = np.zeros(6)
        pieces = []
        scale = self._stiffness()
        for increment, wanted in zip(strain, stress, strict=True):

            def miss(x: Floats, increment: Floats = increment, wanted: Floats = wanted) -> Floats:
                tried = np.where(held, 0.0, increment)
                tried[held] = x
                answer = self._answer(tried[None], None, self.state.copy()).stress[0]
                off: Floats = (answer[held] - wanted[held]) / scale
                return off

            found = root(miss, free[held], method="hybr", options={"xtol": 1e-13})
            if not np.abs(miss(found.x)).max() < 1e-11:
                raise RuntimeError(f"no strain brings the stress to {wanted[held]}: {found.message}")
            free = np.where(held, 0.0, increment)
            free[held] = found.x
            pieces.append(self.move(free[None]))
        return Path(*(np.concatenate(columns) for columns in zip(*pieces, strict=True)))

    def _stiffness(self) -> float:
        """The greatest answer to a small strain, pressed or pulled [pressure]; 1 where there is none."""
        small = 1e-9
        answers = [
            self._answer(size * row[None], None, self.state.copy()).stress[0] - self.stress
            for size in (small, -small)
            for row in np.eye(6)
        ]
        return float(np.abs(answers).max()) / small or 1.0


def drive(
    law: Law,
    strain: Floats,
    *,
    spin: Floats | None = None,
    stress: Floats | None = None,
    density: float = 1.0,
    energy: float = 0.0,
    dt: float = 1.0,
) -> Path:
    """A law along a path.

    strain: increments (m, 6), tensor components xx yy zz xy yz zx; spin: increments (m, 3) xy yz zx; stress: the first
    one (6,); density, energy (per unit mass): the first ones; dt: of each increment.
    """
    return Point(law, stress=stress, density=density, energy=energy, dt=dt).move(strain, spin)
