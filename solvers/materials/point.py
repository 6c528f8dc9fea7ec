"""A law at one point, driven along a path of strain: how a law is verified before it enters a solver."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..jit import kernel
from . import Law, state_rows
from .law import rotate_state, stress_update
from .rotation import spin_rotation

Floats = NDArray[np.float64]


@kernel
def _drive(law, strain, spin, stress, state, stresses, states, dissipated):
    xx, yy, zz, xy, yz, zx = stress[0], stress[1], stress[2], stress[3], stress[4], stress[5]
    for k in range(len(strain)):
        e = strain[k]
        w = spin[k]
        xx, yy, zz, xy, yz, zx = spin_rotation(w[0], w[1], w[2], xx, yy, zz, xy, yz, zx)
        rotate_state(law, w[0], w[1], w[2], state, 0)
        xx, yy, zz, xy, yz, zx, work = stress_update(
            law, e[0], e[1], e[2], e[3], e[4], e[5], xx, yy, zz, xy, yz, zx, 0.0, 0.0, 0.0, state, 0
        )
        stresses[k, 0] = xx
        stresses[k, 1] = yy
        stresses[k, 2] = zz
        stresses[k, 3] = xy
        stresses[k, 4] = yz
        stresses[k, 5] = zx
        states[k] = state[:, 0]
        dissipated[k] = work


def drive(
    law: Law, strain: Floats, *, spin: Floats | None = None, stress: Floats | None = None
) -> tuple[Floats, Floats, Floats]:
    """Stresses, states and dissipated energies along a path.

    strain: increments (m, 6), tensor components xx yy zz xy yz zx; spin: increments (m, 3) xy yz zx; stress: the first
    one (6,). Returns (m, 6) [pressure], (m, rows of the law's state), (m,) energy per volume of each increment.
    """
    m = len(strain)
    state = np.zeros((max(1, state_rows(law)), 1))
    out: tuple[Any, ...] = (np.empty((m, 6)), np.empty((m, len(state))), np.empty(m))
    _drive(
        law,
        np.ascontiguousarray(strain, dtype=float),
        np.zeros((m, 3)) if spin is None else np.ascontiguousarray(spin, dtype=float),
        np.zeros(6) if stress is None else np.asarray(stress, dtype=float),
        state,
        *out,
    )
    return out[0], out[1][:, : state_rows(law)], out[2]
