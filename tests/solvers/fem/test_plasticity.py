"""Plastic flow in elements: Newton's rate, closed forms of plates, cylinders and footings, another program's beam."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fem_meshes import bricks, group, held, loaded, moved, problem, quads, ramp, shell, solve

from zrno.solvers import fem
from zrno.solvers import materials as laws
from zrno.solvers.fem.assembly import Assembly
from zrno.solvers.fem.equilibrium import Target, equilibrium
from zrno.solvers.fem.shape import Shape
from zrno.solvers.materials.drucker_prager import cone

Floats = np.ndarray


def _motion(nodes: Any, dof: int, value: float) -> fem.Motion:
    nodes = np.atleast_1d(nodes).ravel()
    return fem.Motion(nodes, np.full(len(nodes), dof), np.full(len(nodes), value), 0)


SAND = laws.cap(66.7, 40.0, 0.25, gamma=0.18, decay=0.67, ratio=2.5, hardening=laws.CapHardening(0.066, 0.67, 0.189))
FLOWING = {
    "von Mises": (laws.von_mises(210.0, 0.3, 0.25, 2.0, 0.5), (-0.02, 0.01)),
    "Drucker-Prager": (laws.drucker_prager_soil(100.0, 0.3, 0.5, 25.0, 5.0), (-0.04, 0.02)),
    "cap": (SAND, (-0.02, 0.01)),
}


@pytest.mark.parametrize("name", FLOWING)
def test_newtons_method_is_quadratic(name: str) -> None:
    """A block pressed and sheared at its top in one step, so that most of it flows: digits double in each iteration."""
    law, (press, shear) = FLOWING[name]
    x, nodes, number = bricks(3, 2, 2)
    top = number[-1].ravel()
    motions = tuple(_motion(top, dof, 1.0) for dof in (0, 1, 2))
    p = problem(x, group("hex8", "solid", nodes, law), held(len(x), (number[0], "xyz")), motions=motions)
    change = np.zeros((len(x), 6))
    change[top, :2] = press, shear
    how = fem.Iteration(force=1e-13, most=30)
    a = Assembly(p)
    start = Shape(np.zeros((len(x), 6)))
    _, _, trace = equilibrium(a, start, Target(change, lambda s: np.zeros((len(x), 6))), 1.0, how)
    assert (a.groups[0]._history[0] > 0.0).mean() > 0.5  # type: ignore[attr-defined]
    r = np.log([value for value in trace.residuals if value > 1e-13])
    print(name, trace.residuals)
    slope = (r[-1] - r[-2]) / (r[-2] - r[-3])
    assert slope > 1.7
