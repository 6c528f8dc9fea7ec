"""Failure by plastic strain, of any law that has one and keeps its pressure elastic.

Where the plastic strain reaches the limit the material is rubble: no shear, no tension (MCM model 3 and LS-DYNA erode
or release it alike). The mean stress that it would have without the gap goes on being counted, so that a crack closes
where it opened. What the stress held is dissipated at once.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .invariants import second_invariant
from .law import PLASTIC_STRAIN, law_body, rotate_state, state_rows, stress_update, wave_speed


class Failing(NamedTuple):
    """law: until then; limit: the plastic strain; row: of the mean stress without the gap, the last of the state."""

    law: Any
    limit: float
    row: int


def failing(law: Any, limit: float) -> Failing:
    """`law` until its plastic strain reaches `limit`."""
    if not limit > 0.0:
        raise ValueError(f"failure strain {limit!r} must be positive")
    return Failing(law, limit, state_rows(law))


@law_body(stress_update, Failing)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    bulk = law.law.lame + 2.0 / 3.0 * law.law.shear
    if state[PLASTIC_STRAIN, i] >= law.limit:
        mean = state[law.row, i] + bulk * (de_xx + de_yy + de_zz)
        state[law.row, i] = mean
        mean = min(0.0, mean)
        return mean, mean, mean, 0.0, 0.0, 0.0, 0.0
    s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, work = stress_update(
        law.law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
    )
    if state[PLASTIC_STRAIN, i] >= law.limit:
        mean = (s_xx + s_yy + s_zz) / 3.0
        state[law.row, i] = mean
        held = second_invariant(s_xx - mean, s_yy - mean, s_zz - mean, s_xy, s_yz, s_zx) / (2.0 * law.law.shear)
        work += held + max(0.0, mean) ** 2 / (2.0 * bulk)
        mean = min(0.0, mean)
        return mean, mean, mean, 0.0, 0.0, 0.0, work
    return s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, work


@law_body(rotate_state, Failing)
def _rotate(law, w_xy, w_yz, w_zx, state, i):
    rotate_state(law.law, w_xy, w_yz, w_zx, state, i)


@law_body(wave_speed, Failing)
def _wave(law, rho, e, state, i):
    return wave_speed(law.law, rho, e, state, i)


@law_body(state_rows, Failing)
def _rows(law):
    return law.row + 1
