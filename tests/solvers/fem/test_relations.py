"""Linear relations between degrees of freedom (PAK's MPC), and Newton's method with its variants."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fem_meshes import bricks, group, held, loaded, moved, problem, ramp, solve

from zrno.solvers import fem
from zrno.solvers.errors import Diverged
from zrno.solvers.fem.libraries import Singular
from zrno.solvers.fem.linear import System
from zrno.solvers.materials import Elastic, von_mises


def _relation(node: int, dof: int, *terms: tuple[int, int, float]) -> fem.Relation:
    nodes, dofs, coefficients = zip(*terms, strict=True)
    return fem.Relation(node, dof, np.array(nodes), np.array(dofs), np.array(coefficients))


def _levers(**more: Any) -> fem.Problem:
    """Springs of 2, 3 and 1 along x at three nodes, with u1 = 2 u0 and, a chain, u2 = -u1; u1 is pulled by 5."""
    x = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]])
    springs = tuple(
        fem.Elements("point1", kind, np.array([[k]]), np.array([k + 1]), 1, None, value=np.eye(6)[:1] * value)
        for kind in ("spring", "mass")
        for k, value in enumerate((2.0, 3.0, 1.0) if kind == "spring" else (1.0, 1.0, 1.0))
    )
    relations = (_relation(2, 0, (1, 0, -1.0)), _relation(1, 0, (0, 0, 2.0)))
    return problem(x, springs, held(3, (slice(None), "yzabc")), relations=relations, **more)


def test_levers_and_a_chain_of_them() -> None:
    """k = 2 + 3 2^2 + 1 2^2 against a force of 2 x 5; the springs' energy is the load's work."""
    solver, _ = solve(_levers(nodal_loads=(loaded(1, 0, 5.0),)))
    np.testing.assert_allclose(solver.shape.u[:, 0], np.array([1.0, 2.0, -2.0]) * 10.0 / 18.0, rtol=1e-12)
    assert solver.energy_report()["balance_error"] < 1e-12


def test_levers_vibrate() -> None:
    """omega^2 = 18 / (1 + 4 + 4), by a mass of 1 at each node; a second motion beside it, as Lanczos needs one."""
    p = _levers(modes=1)
    free = p.fixed.copy()
    free[0, 1] = False
    across = tuple(
        fem.Elements("point1", kind, np.array([[0]]), np.array([9]), 1, None, value=np.eye(6)[1:2] * value)
        for kind, value in (("spring", 50.0), ("mass", 1.0))
    )
    both = problem(p.x, (*p.elements, *across), free, relations=p.relations, modes=1)
    _, seen = solve(both, lambda s: s.history()["frequency"])
    assert seen[0] * 2.0 * np.pi == pytest.approx(np.sqrt(18.0 / 9.0), rel=1e-9)


@pytest.mark.parametrize("geometry", ["small", "total"])
def test_two_halves_that_are_tied_are_one_body(geometry: str) -> None:
    """A bar of bricks that flows, cut in its middle and tied node by node: displacements of the bar in one piece."""
    law = von_mises(1000.0, 0.3, 1.0, 100.0)
    x, nodes, number = bricks(4, 2, 2, (4.0, 1.0, 1.0))
    cut = number[2].ravel()
    twin = np.arange(len(cut)) + len(x)
    second = nodes.copy()
    swap = dict(zip(cut.tolist(), twin.tolist(), strict=True))
    right = (x[nodes].mean(axis=1)[:, 0] > 2.0)[:, None]
    second = np.where(right, np.vectorize(lambda n: swap.get(n, n))(nodes), nodes)
    ties = tuple(_relation(b, d, (a, d, 1.0)) for a, b in swap.items() for d in range(3))

    def tip(x: np.ndarray, nodes: np.ndarray, relations: Any) -> np.ndarray:
        end = number[-1].ravel()
        p = problem(x, group("hex8", "solid", nodes, law, geometry=geometry), held(len(x), (number[0].ravel(), "xyz")),
                    nodal_loads=(loaded(end, 0, 1.2, 0), loaded(end, 1, 0.05, 0)), curves=(ramp(),), steps=((4, 0.25),),
                    relations=relations, iteration=fem.Iteration(force=1e-11))  # fmt: skip
        solver, _ = solve(p)
        assert float(solver.frame().cells[0].data["plastic_strain"].max()) > 1e-3
        return solver.shape.u[end, :3]

    one, tied = tip(x, nodes, ()), tip(np.vstack([x, x[cut]]), second, ties)
    np.testing.assert_allclose(tied, one, rtol=0.0, atol=1e-9 * np.abs(one).max())


def _string(**how: Any) -> tuple[int, float]:
    """Two bars of E A = 1000 and length 10 in a line, pulled across in the middle in one step: Newton's first answer is
    far too long. Iterations, and the way of the middle."""
    x = np.array([[-10.0, 0, 0], [0.0, 0.05, 0], [10.0, 0, 0]])
    bars = group("line2", "truss", np.array([[0, 1], [1, 2]]), Elastic.from_engineering(1000.0, 0.0),
                 section={"area": 1.0}, geometry="total")  # fmt: skip
    p = problem(x, bars, held(3, ([0, 2], "xyz"), ([1], "xz")), nodal_loads=(loaded(1, 1, 2.0, 0),), curves=(ramp(),),
                steps=((1, 1.0),), iteration=fem.Iteration(cuts=0, most=100, force=1e-10, **how))  # fmt: skip
    solver, _ = solve(p)
    return solver.iterations, moved(solver, 1, 1)


def test_line_search_comes_back_sooner_to_the_same_place() -> None:
    """Green's strain of the bars: 2 (E A / L0) e w / L0 L0 = P with e = (w^2 - w0^2) / (2 L0^2), its cubic solved.

    Without factors in each iteration Newton's first answer, 400 away, throws it further out, with forces of 1e20:
    what is round-off of those is no equilibrium.
    """
    square = 100.0 + 0.05**2
    w = np.roots([1000.0 / square**1.5, 0.0, -1000.0 * 0.05**2 / square**1.5, -2.0])
    exact = float(w[np.isreal(w)].real.max()) - 0.05
    assert _string(method="newton")[1] == pytest.approx(exact, rel=1e-9)
    plain, searched = _string(), _string(search=True)
    assert plain[1] == pytest.approx(exact, rel=1e-6)
    assert searched[1] == pytest.approx(exact, rel=1e-6)
    assert searched[0] < plain[0]


def test_modified_newton_needs_more_iterations_for_the_same_answer() -> None:
    """A bar that flows: the matrix of the step's start alone."""
    law = von_mises(1000.0, 0.3, 1.0, 300.0)
    x, nodes, number = bricks(2, 1, 1, (2.0, 1.0, 1.0))
    found = []
    for method in ("newton", "modified"):
        p = problem(x, group("hex8", "solid", nodes, law), held(len(x), (number[0].ravel(), "xyz")), curves=(ramp(),),
                    nodal_loads=(loaded(number[-1].ravel(), 0, 1.3, 0),), steps=((2, 0.5),),
                    iteration=fem.Iteration(method=method, most=200, force=1e-10))  # fmt: skip
        solver, _ = solve(p)
        found.append((solver.shape.u, solver.iterations))
    np.testing.assert_allclose(found[1][0], found[0][0], rtol=0.0, atol=1e-8 * np.abs(found[0][0]).max())
    assert found[1][1] > found[0][1]


@pytest.mark.parametrize("found", [True, False])
def test_where_a_linear_system_has_no_digits_left_the_forces_judge_its_answer(
    found: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the second iteration on, as flow that hardly resists has them; where there is no answer it is told."""
    exact, calls, solved = _string(method="newton"), [0], System.solve

    def few_digits(self: System, right: np.ndarray) -> np.ndarray:
        calls[0] += 1
        if calls[0] == 1:
            return solved(self, right)
        raise Singular(-1, "few digits", solved(self, right) if found else None)

    monkeypatch.setattr(System, "solve", few_digits)
    if found:
        assert _string(method="newton") == exact
    else:
        with pytest.raises(Diverged, match="few digits"):
            _string(method="newton")
