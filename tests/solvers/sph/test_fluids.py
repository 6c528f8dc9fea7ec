"""Fluids: their own viscosity, in the flow and in the time step."""

from __future__ import annotations

import numpy as np
from sph_scenes import finished, lattice, one_body, periodic

from zrno.solvers.materials import Tait, fluid
from zrno.solvers.sph import Cures


def shear_wave(viscosity: float, n: int = 16, until: float = 4.0) -> tuple[float, int]:
    """Amplitude of v_x = sin(2 pi y) after a while in a periodic box of side 1, and the steps that it took."""
    spacing = 1.0 / n
    x = lattice((n, n), (0.0, 0.0), spacing)
    v = np.zeros_like(x)
    v[:, 0] = 1e-3 * np.sin(2.0 * np.pi * x[:, 1])
    problem = one_body(
        x, v, spacing=spacing, law=fluid(Tait(1.0, 1.0 / 7.0, 7.0), viscosity=viscosity), planes=periodic(1.0, 1.0),
        body={"linear": 1e-9, "quadratic": 1e-9}, cures=Cures(correction=True), step_option=1,
    )  # fmt: skip
    solver = finished(problem, until)
    p = solver.frame().particles
    wave = np.sin(2.0 * np.pi * p["position"][:, 1])
    return float(2.0 * np.mean(p["velocity"][:, 0] * wave) / 1e-3), solver.step


def rate_error(viscosity: float, n: int, until: float) -> tuple[float, int]:
    """Relative error of the wave's rate of decay, nu k^2 (Lamb 1932), and the steps."""
    amplitude, steps = shear_wave(viscosity, n, until)
    return float(-np.log(amplitude) / (viscosity * (2.0 * np.pi) ** 2 * until) - 1.0), steps


def test_a_shear_wave_dies_out_by_the_fluids_viscosity() -> None:
    """Two smoothed derivatives damp a wave of 16 particles 7 % too slowly; the error falls with the square of h."""
    coarse, _ = rate_error(0.005, 16, 4.0)
    fine, _ = rate_error(0.005, 32, 4.0)
    assert abs(fine) < 0.02
    assert abs(coarse) > 3.5 * abs(fine)


def test_a_viscous_fluid_takes_steps_that_its_viscosity_allows() -> None:
    """h^2/(8 nu) is here an eighth of the acoustic step; without that limit the run takes nine steps."""
    error, steps = rate_error(0.1, 16, 0.5)
    assert steps > 60
    assert abs(error) < 0.08
