"""Structures in motion: integrators against their own theory, vibrations and waves against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fem_meshes import group, held, loaded, moved, problem, quads, shell, solve

from zrno.solvers import fem
from zrno.solvers.fem.assembly import Mechanism
from zrno.solvers.materials import Elastic

STEEL = Elastic.from_engineering(2.1e5, 0.3)
BETAS = (1.875104068711961, 4.694091132974175, 7.854757438237613, 10.995540734875467, 14.13716839104647)


def _oscillator(how: fem.Dynamics, steps: int, per_period: int, *, start: bool = True, **more: object) -> fem.Problem:
    """A mass on a spring: omega = 1."""
    x = np.zeros((1, 3))
    node = np.zeros((1, 1), dtype=int)
    one = np.array([[1.0, 0, 0, 0, 0, 0]])
    elements = (
        fem.Elements("point1", "spring", node, np.array([1]), 1, None, value=one),
        fem.Elements("point1", "mass", node, np.array([2]), 1, None, value=one),
    )
    first = np.array([[1.0, 0, 0, 0, 0, 0]]) if start else None
    return problem(x, elements, held(1), dynamics=how, displacement=first,
                   steps=((steps, 2 * math.pi / per_period),), **more)  # fmt: skip


def _period(values: np.ndarray, dt: float) -> float:
    """Mean time between crossings of zero, doubled."""
    t = dt * np.arange(len(values))
    k = np.flatnonzero(values[:-1] * values[1:] < 0)
    crossing = t[k] + dt * values[k] / (values[k] - values[k + 1])
    return float(2 * np.diff(crossing).mean())


def test_newmarks_period_and_energy() -> None:
    dt = 2 * math.pi / 20
    solver, seen = solve(_oscillator(fem.Dynamics(), 2000, 20), lambda s: moved(s, 0, 0))
    longer = _period(np.array([1.0, *seen]), dt) / (2 * math.pi) - 1
    assert longer == pytest.approx(dt**2 / 12, rel=0.03)
    assert solver.energy_report()["balance_error"] < 1e-10


@pytest.mark.parametrize("alpha", [-0.05, -0.3])
def test_hht_damps_what_steps_do_not_resolve_and_little_else(alpha: float) -> None:
    _, slow = solve(_oscillator(fem.Dynamics("hht", alpha=alpha), 200, 100), lambda s: moved(s, 0, 0))
    assert max(slow[-100:]) > 0.98
    fast = fem.Dynamics("hht", alpha=alpha)
    _, seen = solve(_oscillator(fast, 120, 1e-3), lambda s: moved(s, 0, 0))
    ratios = [abs(seen[2 * n - 1] / seen[n - 1]) / 2 for n in (30, 60)]  # a double root: n rho^n
    radius = (ratios[1] / ratios[0]) ** (1 / 30)
    assert radius == pytest.approx((1 + alpha) / (1 - alpha), rel=0.02)


def test_wilsons_theta_is_of_second_order() -> None:
    errors = []
    for per in (20, 40):
        _, seen = solve(_oscillator(fem.Dynamics("wilson"), per, per), lambda s: moved(s, 0, 0))
        errors.append(abs(seen[-1] - 1.0))
    assert errors[0] / errors[1] > 3.0


def test_central_differences_and_their_limit() -> None:
    dt = 2 * math.pi / 20
    solver, seen = solve(_oscillator(fem.Dynamics("central"), 400, 20), lambda s: moved(s, 0, 0))
    assert _period(np.array([1.0, *seen]), dt) / (2 * math.pi) - 1 == pytest.approx(-(dt**2) / 24, rel=0.05)
    assert solver.procedure.stepper.stable == pytest.approx(2.0, rel=1e-3)  # type: ignore[attr-defined]
    coarse, _ = solve(_oscillator(fem.Dynamics("central"), 10, 1))  # a step of one period takes several
    assert coarse.procedure.stepper.parts(2 * math.pi) == 4  # type: ignore[attr-defined]
    assert coarse.energies()["kinetic"] <= 0.5 + 1e-6


def test_a_load_at_once_doubles_the_deflection() -> None:
    load = fem.NodalLoad(np.array([0]), np.array([0]), np.array([1.0]))
    _, seen = solve(_oscillator(fem.Dynamics(), 100, 100, start=False, nodal_loads=(load,)), lambda s: moved(s, 0, 0))
    assert max(seen) == pytest.approx(2.0, rel=1e-3)


def test_damping_takes_the_energy_that_it_says() -> None:
    zeta = 0.05
    how = fem.Dynamics(mass_damping=zeta, stiffness_damping=zeta)  # zeta = (a + b) / 2 at omega = 1
    solver, seen = solve(_oscillator(how, 100, 100), lambda s: moved(s, 0, 0))
    assert seen[-1] == pytest.approx(math.exp(-2 * math.pi * zeta), rel=5e-3)
    report = solver.energy_report()
    assert report["dissipated"] == pytest.approx(0.5 * (1 - math.exp(-4 * math.pi * zeta)), rel=5e-3)
    assert report["balance_error"] < 1e-3


def test_vibrations_of_a_beam() -> None:
    n, length, inertia, area = 20, 1.0, 1e-8, 1e-4
    x = np.column_stack([np.linspace(0, length, n + 1), np.zeros((n + 1, 2))])
    nodes = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    section = {"area": area, "iyy": inertia, "izz": inertia, "j": 2 * inertia}
    elements = fem.Elements("line2", "beam", nodes, np.arange(1, n + 1), 1, STEEL, density=7.8e-9, section=section)
    fixed = held(n + 1, (0, "xyzabc"), (slice(None), "yc"))  # bending in one plane
    _, seen = solve(problem(x, elements, fixed, modes=5), lambda s: s.history()["frequency"])
    omega = np.array(BETAS) ** 2 * math.sqrt(2.1e5 * inertia / (7.8e-9 * area * length**4))
    bending = np.array(seen) * 2 * math.pi
    np.testing.assert_allclose(bending[:3], omega[:3], rtol=2e-4)


def test_vibrations_of_a_bar_of_trusses() -> None:
    n = 40
    x = np.column_stack([np.linspace(0, 1, n + 1), np.zeros((n + 1, 2))])
    nodes = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    elements = fem.Elements("line2", "truss", nodes, np.arange(1, n + 1), 1, STEEL, density=1.0, section={"area": 1.0})
    fixed = held(n + 1, (0, "x"), (slice(None), "yz"))
    _, seen = solve(problem(x, elements, fixed, modes=3), lambda s: s.history()["frequency"])
    c = math.sqrt(2.1e5)
    np.testing.assert_allclose(seen, (2 * np.arange(1, 4) - 1) * c / 4, rtol=2e-3)


@pytest.mark.parametrize(("edge", "reference"), [("z", 19.7392088), ("xyzabc", 35.985)])
def test_vibrations_of_a_plate(edge: str, reference: float) -> None:
    x, nodes, number = quads(16, 16, lambda r, s: np.stack([r, s, 0 * r], -1))
    h = 0.01
    border = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    fixed = held(len(x), (border, edge), (slice(None), "xyc"))
    elements = shell(nodes, h, STEEL, density=1.0)
    _, seen = solve(problem(x, elements, fixed, modes=1), lambda s: s.history()["frequency"])
    stiffness = 2.1e5 * h**3 / (12 * (1 - 0.09))
    assert 2 * math.pi * seen[0] / math.sqrt(stiffness / h) == pytest.approx(reference, rel=0.015)


def test_a_free_body_has_six_vibrations_of_no_frequency(shared) -> None:  # type: ignore[no-untyped-def]
    """NAFEMS FV52: simply supported in z at its lower edges only, three rigid motions; then 45.897 Hz."""
    from fem_meshes import bricks

    x, nodes, number = bricks(8, 8, 2, (10, 10, 1))
    border = np.unique(np.concatenate([number[0, :, 0], number[-1, :, 0], number[:, 0, 0], number[:, -1, 0]]))
    elements = group("hex8", "solid", nodes, Elastic.from_engineering(200e9, 0.3), density=8000.0, modes=12)
    _, seen = solve(problem(x, elements, held(len(x), (border, "z")), modes=4), lambda s: s.history()["frequency"])
    assert max(seen[:3]) < 0.01 * seen[3]
    assert seen[3] == pytest.approx(45.897, rel=0.03)


def test_a_wave_runs_along_a_bar_and_doubles_at_its_end() -> None:
    n, length = 100, 1.0
    x = np.column_stack([np.linspace(0, length, n + 1), np.zeros((n + 1, 2))])
    nodes = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    law = Elastic.from_engineering(1.0, 0.0)
    elements = fem.Elements("line2", "truss", nodes, np.arange(1, n + 1), 1, law, density=1.0, section={"area": 1.0})
    p = problem(x, elements, held(n + 1, (n, "x"), (slice(None), "yz")), nodal_loads=(loaded(0, 0, -1.0),),
                dynamics=fem.Dynamics("central"), steps=((75, 0.02),))  # fmt: skip
    _, seen = solve(p, lambda s: s.assembly.groups[0].stress.copy())  # type: ignore[attr-defined]
    half, later = seen[24], seen[74]  # t = 0.5, 1.5: the front is at the middle, and back there from the wall
    assert half[:40].mean() == pytest.approx(1.0, rel=0.02)
    assert np.abs(half[60:]).max() < 0.05
    assert later[60:].mean() == pytest.approx(2.0, rel=0.02)
    assert later[:40].mean() == pytest.approx(1.0, rel=0.05)


def test_a_prescribed_motion_carries_its_inertia() -> None:
    """A free mass pushed by its own node: the reaction is m a."""
    from fem_meshes import bricks

    x, nodes, number = bricks(1, 1, 1)
    curve = fem.Curve(np.linspace(0, 1, 201), 0.5 * np.linspace(0, 1, 201) ** 2)
    every = np.arange(8)
    motion = fem.Motion(every, np.zeros(8, int), np.ones(8), 0)
    elements = group("hex8", "solid", nodes, STEEL, density=3.0)
    p = problem(x, elements, held(8, (every, "yz")), motions=(motion,), curves=(curve,), dynamics=fem.Dynamics(),
                steps=((100, 0.01),))  # fmt: skip
    _, seen = solve(p, lambda s: s.reaction[:, 0].sum())
    assert np.mean(seen[-20:]) == pytest.approx(3.0, rel=1e-2)
    assert number.size == 8


def test_explicit_dynamics_needs_mass() -> None:
    x = np.array([[0.0, 0, 0], [1, 0, 0]])
    elements = fem.Elements("line2", "truss", np.array([[0, 1]]), np.array([1]), 1, STEEL, section={"area": 1.0})
    with pytest.raises(Mechanism, match="mass"):
        fem.Solver(problem(x, elements, held(2, (0, "xyz"), (1, "yz")), dynamics=fem.Dynamics("central")))
