"""The contract of every small-strain material law, and its dispatch.

A law is a NamedTuple of its numbers; nested parts (an equation of state, a hardening curve) are NamedTuples in it.
Jitted loops call the functions below with it: `numba.extending.overload` picks the body that `law_body` registered for
the tuple's class, so a loop is compiled for the law that a scene uses and is still cached on disk. Called from Python
they run the same body without compiling it.

Stress: six components xx yy zz xy yz zx, tension positive. Strain increments: six tensor components (not doubled
shears) in the same order. state: (k, n) history variables, column i belongs to the point, all zero in the virgin
material; None where a law has none.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

from numba import types
from numba.extending import overload

from ..jit import FASTMATH

JIT_OPTIONS = {"fastmath": FASTMATH, "error_model": "numpy"}

PLASTIC_STRAIN = 0  # row of the equivalent plastic strain in the state of every law that has one
GAP = 1  # row of the volume strain by which grain has opened, in the state of a law that remembers it
OPEN = 0.3  # the widest gap: what grain in a layer loses of a kernel's sum until its neighbours are out of sight

Function = Callable[..., Any]
_BODIES: dict[str, dict[type, Function]] = {}


def dispatched(function: Function) -> Any:
    """A function whose body depends on the class of its first argument; its own body is for the classes without one."""
    bodies = _BODIES.setdefault(function.__qualname__, {})

    @functools.wraps(function)
    def call(law, *rest):
        return bodies.get(type(law), function)(law, *rest)

    @functools.wraps(function)
    def choose(law, *rest):
        return bodies.get(law.instance_class, function) if isinstance(law, types.BaseNamedTuple) else None

    overload(call, jit_options=JIT_OPTIONS)(choose)
    return call


def law_body(function: Any, *laws: type) -> Callable[[Function], Function]:
    """Register a body of a dispatched function for laws of these classes; its arguments have the function's names."""

    def register(body: Function) -> Function:
        for law in laws:
            _BODIES[function.__qualname__][law] = body
        return body

    return register


@dispatched
def stress_update(
    law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i
):
    """New stress (6 components) and the energy that flow dissipates per unit volume of one strain increment.

    rho: density after the increment; e: energy per unit mass before it; dt: how long it takes. A law that does not ask
    for them does not pay for them. Updates state[:, i].
    """
    raise NotImplementedError("no law of that class")


@dispatched
def rotate_state(law, w_xy, w_yz, w_zx, state, i):
    """Turn the tensors in state[:, i] by the spin increment (w_ij = (du_i/dx_j - du_j/dx_i)/2), where there are any."""


@dispatched
def wave_speed(law, rho, e, state, i):
    """Speed of longitudinal waves now: sqrt((lambda + 2 G)/rho), but for laws with an equation of state.

    rho: density; e: energy per unit mass. See `constant_wave`.
    """
    return math.sqrt((law.lame + 2.0 * law.shear) / rho)


@dispatched
def bulk_modulus(law):
    """Pressure per volume strain of a law whose pressure and density go together; 0 of all others."""
    return 0.0


@dispatched
def state_rows(law):
    """History variables that a law keeps at a point."""
    return 0


@dispatched
def constant_wave(law):
    """Whether c sqrt(rho) is constant. Else `wave_speed` depends on the energy too, and is to be asked at each step."""
    return True


def sound_speed(law: Any, density: float, energy: float = 0.0) -> float:
    """Speed of longitudinal waves in the virgin material. energy: per unit mass."""
    return float(wave_speed(law, density, energy, None, 0))


def lame_constants(young: float, poisson: float) -> tuple[float, float]:
    """(lambda, G) of Young's modulus [pressure] and Poisson's ratio [-]; ValueError outside E > 0, -1 < nu < 0.5."""
    if not young > 0.0:
        raise ValueError(f"Young's modulus {young!r} must be positive")
    if not -1.0 < poisson < 0.5:
        raise ValueError(f"Poisson's ratio {poisson!r} must lie between -1 and 0.5")
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))
