"""The contract of every small-strain material law, and its dispatch.

A law is a NamedTuple of its numbers. Jitted loops call the two functions below with it; `numba.extending.overload`
picks the body by the tuple's class, so a loop is compiled for the law that a scene uses and still cached on disk.

Stress: six components xx yy zz xy yz zx, tension positive. Strain increments: six tensor components (not doubled
shears) in the same order. state: (k, n) history variables, column i belongs to the point; None where a law has none.
"""

from __future__ import annotations

from typing import Any

from numba import types

from ..jit import FASTMATH

JIT_OPTIONS = {"fastmath": FASTMATH, "error_model": "numpy"}

PLASTIC_STRAIN = 0  # row of the equivalent plastic strain in the state of every law that has one


def is_law(numba_type: Any, law: type) -> bool:
    """Whether a numba type is the NamedTuple `law`."""
    return isinstance(numba_type, types.BaseNamedTuple) and numba_type.instance_class is law


def stress_update(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
):
    """New stress (6 components) and the energy that flow dissipates per unit volume of one strain increment.

    rho: density after the increment; e: energy per unit mass before it; dt: how long it takes. A law that does not ask
    for them does not pay for them. Updates state[:, i].
    """
    raise NotImplementedError("called from jitted code only; `point.drive` is for Python")


def rotate_state(law, w_xy, w_yz, w_zx, state, i):
    """Turn the tensors in state[:, i] by the spin increment (w_ij = (du_i/dx_j - du_j/dx_i)/2)."""
    raise NotImplementedError("called from jitted code only")


def sound_speed(law: Any, density: float) -> float:
    """Speed of longitudinal waves sqrt((lambda + 2 G)/rho)."""
    return float(((law.lame + 2.0 * law.shear) / density) ** 0.5)


def lame_constants(young: float, poisson: float) -> tuple[float, float]:
    """(lambda, G) of Young's modulus [pressure] and Poisson's ratio [-]; ValueError outside E > 0, -1 < nu < 0.5."""
    if not young > 0.0:
        raise ValueError(f"Young's modulus {young!r} must be positive")
    if not -1.0 < poisson < 0.5:
        raise ValueError(f"Poisson's ratio {poisson!r} must lie between -1 and 0.5")
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))
