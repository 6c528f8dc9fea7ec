"""The contract of every contact law between two particles of different bodies, and its dispatch.

A law is a NamedTuple of its numbers with a field `reach`: the distance at which it begins, in units of the pair's mean
smoothing length. Jitted loops call `repulsion` with it; `numba.extending.overload` picks the body by the tuple's class.
It knows two points and what they weigh, and no solver: nodes of a structure that touch grains are such points as well.
"""

from __future__ import annotations

from typing import Any

from numba import types

from ..jit import FASTMATH

JIT_OPTIONS = {"fastmath": FASTMATH, "error_model": "numpy"}
TINY = 1e-30  # keeps quotients of coincident points finite


def is_law(numba_type: Any, law: type) -> bool:
    """Whether a numba type is the NamedTuple `law`."""
    return isinstance(numba_type, types.BaseNamedTuple) and numba_type.instance_class is law


def repulsion(law, shape, r2, h_i, h_j, mass_i, mass_j, density_i, density_j, body_i, body_j, approach, dt):
    """(push, stiffness) of a pair: F_i = push (x_i - x_j), F_j = -F_i, push >= 0; stiffness -dF/dr, for the time step.

    r2: squared distance; shape: the smoothing kernel (`sph.smoothing`); body: indices into the law's rows; approach:
    -(v_i - v_j).(x_i - x_j), positive where they come nearer; dt: the last step, 0 before the first.
    """
    raise NotImplementedError("called from jitted code only; `pair` is for Python")
