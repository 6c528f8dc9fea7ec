"""Elements that come and go: strain-free at birth, no force after death, against closed forms of two bars."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fem_meshes import bricks, group, held, loaded, moved, problem, quads, shell, solve

from zrno.pipelines.build_fem import structure_problem
from zrno.solvers import fem
from zrno.solvers.errors import Diverged
from zrno.solvers.fem import output
from zrno.solvers.materials import Elastic
from zrno.translators import read
from zrno.translators.text import InputError

BAR = Elastic.from_engineering(100.0, 0.0)
STEADY = fem.Curve(np.array([0.0, 10.0]), np.array([0.0, 10.0]))


def _bars(geometry: str = "small", force: float = 1.0, steps: int = 4, **life: float) -> fem.Problem:
    """Two bars side by side, length 10, area 2, E 100; the second with a life; pulled at the end by force x time."""
    x = np.array([[0.0, 0, 0], [10.0, 0, 0]])
    nodes = np.array([[0, 1]])
    always = group("line2", "truss", nodes, BAR, section={"area": 2.0}, geometry=geometry)
    own = {name: np.full(1, value) for name, value in life.items()}
    second = group("line2", "truss", nodes, BAR, section={"area": 2.0}, geometry=geometry, **own)
    return problem(x, (always, second), held(2, ([0], "xyz"), ([1], "yz")), curves=(STEADY,),
                   nodal_loads=(loaded(1, 0, force, 0),), steps=((steps, 1.0),))  # fmt: skip


def test_two_bars() -> None:
    """Born at 1, dead at 3: k = 20, so u = 1/20, then half as much a step, then all on the first bar again."""

    def see(s: fem.Solver) -> tuple[float, float, float]:
        return moved(s, 1, 0), *(float(c.data["stress"][0, 0]) for c in output.frame(s).cells)

    solver, seen = solve(_bars(birth=1.0, death=3.0), see)
    expected = [(1 / 20, 0.5, 0.0), (1.5 / 20, 0.75, 0.25), (2 / 20, 1.0, 0.5), (4 / 20, 2.0, 0.0)]
    np.testing.assert_allclose(seen, expected, atol=1e-12)
    shown = output.frame(solver)
    assert [c.data["alive"].tolist() for c in shown.cells] == [[1.0], [0.0]]
    assert solver.history()["active"] == 1.0
    np.testing.assert_allclose(solver.reaction[0, 0], -4.0, atol=1e-12)
    assert solver.energy_report()["balance_error"] < 1e-12
    # at death the second bar holds 0.5^2/(2 E) V = 0.025; the first one's pull lags by 1 on the way of 0.1: 0.05
    assert solver.energies()["dissipated"] == pytest.approx(0.025 + 0.05, rel=1e-9)


def test_a_bar_born_at_large_strain_has_its_length_then() -> None:
    """Total Lagrangian: Green's strain of the first from 10, of the second from the length at its birth."""
    p = _bars("total", 60.0, 3, birth=1.0)
    _, seen = solve(p, lambda s: moved(s, 1, 0))
    for time, u in zip((1.0, 2.0, 3.0), seen, strict=True):
        pull = 0.0
        for start in (10.0, 10.0 + seen[0])[: 1 if time == 1.0 else 2]:
            stretch = (10.0 + u) / start
            pull += 100.0 * 0.5 * (stretch**2 - 1.0) * stretch * 2.0
        assert pull == pytest.approx(60.0 * time, rel=1e-5)
    assert seen[0] > 2.0


@pytest.mark.parametrize("geometry", ["small", "total"])
def test_a_restart_knows_what_lives(geometry: str) -> None:
    p = _bars(geometry, 20.0, 4, birth=1.0, death=3.0)
    whole = fem.Solver(p)
    for k in range(4):
        if k == 2:
            kept = {name: np.array(value) for name, value in whole.checkpoint().items()}
        whole.advance(np.inf, 1)
    again = fem.Solver(p)
    again.restore(kept)
    for _ in range(2):
        again.advance(np.inf, 1)
    np.testing.assert_array_equal(again.shape.u, whole.shape.u)


def test_a_layer_is_built_on_a_loaded_column() -> None:
    """Self-weight: the first metre settles alone; the second, born later, weighs on it and is strain-free itself.

    nu 0, E 100, weight 1 a volume: 1/(2 E) by its own weight, then 1/E by the second's.
    """
    x, nodes, number = bricks(1, 1, 2)
    x = x * [1.0, 1.0, 2.0]
    parts = tuple(
        group("hex8", "solid", nodes[k : k + 1], BAR, density=1.0, birth=np.full(1, float(k))) for k in (0, 1)
    )
    fixed = held(len(x), (slice(None), "xy"), (number[:, :, 0], "z"))
    weight = fem.BodyLoad(np.array([0.0, 0.0, -1.0]))
    solver, seen = solve(
        problem(x, parts, fixed, body_loads=(weight,), steps=((2, 1.0),)),
        lambda s: (moved(s, number[0, 0, 1], 2), moved(s, number[0, 0, 2], 2)),
    )
    np.testing.assert_allclose(seen[0], (-0.5 / 100, 0.0), atol=1e-12)  # the upper node waits where it is
    np.testing.assert_allclose(seen[1], (-1.5 / 100, -(1.0 + 0.5) / 100), atol=1e-12)
    stress = [float(c.data["stress"][0, 2]) for c in output.frame(solver).cells]
    assert stress == pytest.approx([-1.5, -0.5])


def test_a_shell_born_on_a_bent_one_is_free_of_stress() -> None:
    """A strip that has turned by a large angle; a second one of the same nodes is born on it and does nothing."""
    x, nodes, number = quads(8, 1, lambda r, s: np.stack([10 * r, s, 0 * r], -1))
    law = Elastic.from_engineering(1.2e6, 0.0)
    plain = shell(nodes, 0.1, law, geometry="total")
    born = shell(nodes, 0.1, law, geometry="total", birth=np.full(len(nodes), 1.0))
    steady = fem.Curve(np.array([0.0, 1.0, 9.0]), np.array([0.0, 1.0, 1.0]))
    p = problem(x, (plain, born), held(len(x), (number[0], "xyzabc")), nodal_loads=(loaded(number[-1], 2, 4.0, 0),),
                curves=(steady,), steps=((2, 1.0),))  # fmt: skip
    solver, seen = solve(p, lambda s: moved(s, number[-1, 0], 2))
    assert seen[0] > 6.0
    assert seen[1] == pytest.approx(seen[0], rel=1e-6)
    first, second = (np.abs(c.data["stress"]).max() for c in output.frame(solver).cells)
    assert second < 1e-5 * first


def test_a_load_where_nothing_is_yet_is_an_error_with_its_place() -> None:
    x = np.array([[0.0, 0, 0], [10.0, 0, 0], [20.0, 0, 0]])
    bars = tuple(
        group("line2", "truss", np.array([[k, k + 1]]), BAR, section={"area": 2.0}, birth=np.full(1, 2.0 * k))
        for k in (0, 1)
    )
    p = problem(x, bars, held(3, ([0], "xyz"), ([1, 2], "yz")), nodal_loads=(loaded(2, 0, 1.0),), steps=((2, 1.0),))
    solver = fem.Solver(p)
    with pytest.raises(Diverged, match="no element is there yet or any more at node 3 along ux"):
        solver.advance(np.inf, 1)


def test_lives_of_a_deck(shared: Path, tmp_path: Path) -> None:
    """PAK's truss (E 2.1e5, area 2, length 10) with a second one beside it, BTH 1 and DTH 3 in columns 31-50."""
    text = (shared / "reference/pak/truss.dat").read_text()
    deck = tmp_path / "lives.dat"
    changes = (
        ("    1    1  1.000000\nC /9/", "    1    4  1.000000\nC /9/"),
        (
            "    1    1    0    1    0    0    0\n    1    1    1  2.000000    0\n    1    2\n",
            "    1    2    0    1    1    1    0\n    1    1    1  2.000000    0       0.0       0.0\n    1    2\n"
            "    2    1    1  2.000000    0       1.0       3.0\n    1    2\n",
        ),
        ("1000.00000  1.000000", "1000.00000    1000.0"),
        ("  0.000000  1.000000\n", "       0.0       0.0\n"),
    )
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    deck.write_text(text)
    _, seen = solve(structure_problem(read(deck), str(deck)), lambda s: moved(s, 1, 0))
    unit = 100.0 * 10.0 / (2.1e5 * 2.0)
    np.testing.assert_allclose(np.array(seen) / unit, [1.0, 1.5, 2.0, 4.0], rtol=1e-6)
    deck.write_text(text.replace(" 0 0 0 1 1 1       0    0    0", " 0 0 0 1 1 1       0    1    0")
                    .replace("    1    4  1.000000\n", "    1    4  1.000000\n    3    1\n"))  # fmt: skip
    with pytest.raises(InputError, match="birth and death of line2 elements in motion"):
        structure_problem(read(deck), str(deck))
