"""Shells of three and four nodes: patch tests, rigid motions, the matrix as a derivative, published benchmarks."""

from __future__ import annotations

import math

import fem_cases as cases
import numpy as np
import pytest
from fem_meshes import group, held, loaded, moved, problem, quads, ramp, shell, solve

from zrno.solvers import fem
from zrno.solvers.fem.assembly import Assembly
from zrno.solvers.fem.elements import mitc4
from zrno.solvers.fem.shape import Shape
from zrno.solvers.materials import Elastic

STEEL = Elastic.from_engineering(2.1e5, 0.3)
NODES = np.arange(4)[None]


def _warped(amount: float = 0.2) -> np.ndarray:
    return np.array([[0, 0, 0], [1.1, 0.1, 0], [1.2, 0.9, amount], [-0.1, 1.0, 0]], dtype=float)


def _five() -> tuple[np.ndarray, np.ndarray]:
    """MacNeal & Harder's patch of five quadrilaterals."""
    x = np.array([(0, 0), (0.24, 0), (0.24, 0.12), (0, 0.12), (0.04, 0.02), (0.18, 0.03), (0.16, 0.08), (0.08, 0.08)])
    nodes = np.array([(4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)])
    return np.column_stack([x, np.zeros(8)]), nodes


def _triangles(nodes: np.ndarray) -> np.ndarray:
    """Each quadrilateral cut in two."""
    return np.concatenate([nodes[:, [0, 1, 2]], nodes[:, [0, 2, 3]]])


def _triangle_shell(nodes: np.ndarray, thickness: float, law: Elastic = STEEL, **more: object) -> fem.Elements:
    return group("tri3", "shell", nodes, law, thickness=np.full(len(nodes), thickness), **more)


@pytest.mark.parametrize("modes", [0, 4, "triangles"])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("what", ["membrane", "bending"])
def test_patch(what: str, turned: bool, modes: int | str) -> None:
    x, nodes = _five()
    u = np.zeros((8, 6))
    if what == "membrane":
        u[:, 0] = 1e-3 * (x[:, 0] + 0.5 * x[:, 1])
        u[:, 1] = 1e-3 * (x[:, 1] + 0.5 * x[:, 0])
    else:
        u[:, 2] = 1e-3 * 0.5 * (x[:, 0] ** 2 + x[:, 0] * x[:, 1] + x[:, 1] ** 2)
        u[:, 3] = 1e-3 * (x[:, 1] + 0.5 * x[:, 0])
        u[:, 4] = -1e-3 * (x[:, 0] + 0.5 * x[:, 1])
    if turned:
        axis = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0]
        axis *= np.linalg.det(axis)
        x = x @ axis.T
        u = np.column_stack([u[:, :3] @ axis.T, u[:, 3:] @ axis.T])
    motion = fem.Motion(np.repeat(np.arange(4), 6), np.tile(np.arange(6), 4), u[:4].ravel())
    elements = (
        shell(nodes, 0.001, STEEL, modes=modes) if isinstance(modes, int) else _triangle_shell(_triangles(nodes), 0.001)
    )
    solver, _ = solve(problem(x, elements, held(8), motions=(motion,)))
    np.testing.assert_allclose(solver.shape.u[4:, :3], u[4:, :3], atol=1e-10 * np.abs(u[:, :3]).max())


@pytest.mark.parametrize("modes", [0, 4])
def test_six_rigid_motions_and_no_other_mode(modes: int) -> None:
    a = Assembly(problem(_warped(), shell(NODES, 0.1, STEEL, modes=modes), held(4)))
    zero = Shape(np.zeros((4, 6)))
    a.evaluate(zero, zero, 0.0)
    values = np.linalg.eigvalsh(a.system.full().toarray())
    assert (np.abs(values[:6]) < 1e-12 * values[-1]).all()
    assert values[6] > 1e-7 * values[-1]


def test_assumed_membrane_strains_of_a_flat_element_are_the_displacements() -> None:
    """Ko, Lee & Bathe 2017: in the plane the element is the compatible one."""
    rng = np.random.default_rng(2)
    x = _warped(0.0)
    u = rng.standard_normal((4, 3))
    u[:, 2] = 0.0
    metric, rows = np.empty(9), np.empty((9, 6, 4))
    work = (np.empty((5, 3)), np.empty((3, 4)), np.empty(3))
    mitc4.tied_strains(x, np.tile([0.0, 0.0, 0.05], (4, 1)), metric, rows, work)
    tied = np.einsum("pci,ic->p", rows[:5, :3], u)
    weights = np.empty((3, 5))
    for r, s in rng.uniform(-1, 1, (5, 2)):
        assert mitc4.tied_weights(x, r, s, weights)
        by = np.stack([mitc4.CORNER_R * (1 + mitc4.CORNER_S * s), mitc4.CORNER_S * (1 + mitc4.CORNER_R * r)]) / 4
        base, moved_base = by @ x, by @ u
        exact = [base[0] @ moved_base[0], base[1] @ moved_base[1],
                 0.5 * (base[0] @ moved_base[1] + base[1] @ moved_base[0])]  # fmt: skip
        np.testing.assert_allclose(weights @ tied, exact, atol=1e-13)


@pytest.mark.parametrize("modes", [0, 4, "triangle"])
def test_the_matrix_is_the_derivative_of_the_forces(modes: int | str) -> None:
    """Finite rotations: but for half the moments' skew part, which vanishes where nodes are in balance."""
    rng = np.random.default_rng(1)
    soft = Elastic.from_engineering(1e3, 0.3)
    n = 4 if isinstance(modes, int) else 3
    elements = (
        shell(NODES, 0.3, soft, geometry="total", modes=modes)
        if isinstance(modes, int)
        else _triangle_shell(np.arange(3)[None], 0.3, soft, geometry="total")
    )
    a = Assembly(problem(_warped()[:n], elements, held(n)))
    start = Shape(np.zeros((n, 6)), a.still)
    shape = start.moved(0.1 * rng.standard_normal((n, 6)))

    def forces(at: Shape) -> np.ndarray:
        for _ in range(8 if modes else 1):  # parameters of the element find their balance
            out, _ = a.evaluate(at, start, 0.0)
        return out.ravel()

    forces(shape)
    matrix = a.system.full().toarray()
    numeric = np.empty_like(matrix)
    for k in range(6 * n):
        step = np.zeros((n, 6))
        step[k // 6, k % 6] = 1e-6
        numeric[:, k] = (forces(shape.moved(step)) - forces(shape.moved(-step))) / 2e-6
    symmetric = 0.5 * (numeric + numeric.T)
    np.testing.assert_allclose(matrix, symmetric, atol=5e-6 * np.abs(matrix).max())


def test_turning_a_shell_leaves_no_stress() -> None:
    a = Assembly(problem(_warped(), shell(NODES, 0.1, STEEL, geometry="total"), held(4)))
    start = Shape(np.zeros((4, 6)), a.still)
    angle = 2.0
    turn = start.moved(np.tile([0, 0, 0, angle, 0, 0], (4, 1)))
    c, s = math.cos(angle), math.sin(angle)
    turn.u[:, :3] = _warped() @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]).T - _warped()
    forces, _ = a.evaluate(turn, start, 0.0)
    assert np.abs(forces).max() < 1e-10 * 2.1e5 * 0.1


# value / reference of shells.md's tables; M1 without, M3 with enhanced strains


@pytest.mark.parametrize(("modes", "share"), [(0, 0.9891), (4, 0.9978)])
def test_scordelis_lo_roof(modes: int, share: float) -> None:
    assert cases.roof(16, modes)[0] / 0.3024 == pytest.approx(share, abs=0.003)


@pytest.mark.parametrize(("modes", "share"), [(0, 0.9281), (4, 0.9315)])
def test_pinched_cylinder(modes: int, share: float) -> None:
    assert cases.cylinder(16, modes)[0] / 1.8248e-5 == pytest.approx(share, abs=0.003)


@pytest.mark.parametrize(("modes", "share"), [(0, 0.9900), (4, 0.9925)])
def test_pinched_hemisphere(modes: int, share: float) -> None:
    assert cases.hemisphere(16, modes)[0] / 0.0940 == pytest.approx(share, abs=0.003)


@pytest.mark.parametrize(
    ("thickness", "dof", "reference", "shares"),
    [(0.32, 1, 5.424e-3, (0.9961, 0.9977)), (0.32, 2, 1.754e-3, (0.9746, 0.9952)),
     (0.0032, 1, 5.256e-3, (0.9941, 0.9975)), (0.0032, 2, 1.294e-3, (0.9939, 0.9958))],
)  # fmt: skip
def test_twisted_beam(thickness: float, dof: int, reference: float, shares: tuple[float, float]) -> None:
    """Warped elements: the membrane field is for them. In the plane of the tip's width, and across."""
    for modes, share in zip((0, 4), shares, strict=True):
        assert cases.twisted(24, thickness, dof, modes)[0] / reference == pytest.approx(share, abs=0.003)


def test_a_thin_plate_does_not_lock() -> None:
    """Clamped, under pressure, thickness over length 1e-4: Timoshenko's 0.00126532 q a^4 / D."""
    assert cases.plate(16, True, False, h=1e-4)[0] / 0.00126532 == pytest.approx(1.0, abs=0.002)


def test_a_folded_tube_twists_as_bredt_says() -> None:
    """Corners keep two directors each: averaged across the fold the tube would be 2 % off."""
    n, m = 24, 4
    ring = np.array([(k / m, 0) for k in range(m)] + [(1, k / m) for k in range(m)] + [(1 - k / m, 1) for k in range(m)]
                    + [(0, 1 - k / m) for k in range(m)]) - 0.5  # fmt: skip
    x = np.concatenate([np.column_stack([np.full(4 * m, 10 * i / n), ring]) for i in range(n + 1)])
    number = np.arange(len(x)).reshape(n + 1, 4 * m)
    nodes = np.stack([number[:-1], number[1:], np.roll(number[1:], -1, 1), np.roll(number[:-1], -1, 1)], -1)
    t = 0.02
    angle = 1e-3
    turn = fem.Motion(np.repeat(number[-1], 2), np.tile([1, 2], 4 * m),
                      angle * np.column_stack([-x[number[-1], 2], x[number[-1], 1]]).ravel())  # fmt: skip
    solver, _ = solve(
        problem(x, shell(nodes.reshape(-1, 4), t, STEEL), held(len(x), (number[0], "xyz")), motions=(turn,))
    )
    r = solver.reaction[number[-1], :3]
    moment = float((x[number[-1], 1] * r[:, 2] - x[number[-1], 2] * r[:, 1]).sum())
    bredt = STEEL.shear * 4 * 1.0**2 * t / 4.0 * angle / 10.0
    assert moment / bredt == pytest.approx(1.0, abs=0.02)


def test_triangles_converge_on_the_pinched_cylinder_and_do_not_lock() -> None:
    """Constant membrane strains converge slower than the quadrilateral's; bending at thickness 1e-3 is as good."""
    shares = []
    for n in (8, 16):
        x, nodes, number, fixed = cases.cylinder_mesh(n)
        elements = _triangle_shell(_triangles(nodes), 3.0, Elastic.from_engineering(3e6, 0.3))
        solver, _ = solve(problem(x, elements, fixed, nodal_loads=(loaded(number[0, -1], 2, -0.25),)))
        shares.append(-moved(solver, number[0, -1], 2) / 1.8248e-5)
    assert shares == pytest.approx([0.7052, 0.8982], abs=0.005)
    x, nodes, number = quads(16, 16, lambda r, s: np.stack([0.5 * r, 0.5 * s, 0 * r], -1))
    fixed = held(len(x), (slice(None), "c"), (number[0], "xb"), (number[:, 0], "ya"),
                 (np.concatenate([number[-1], number[:, -1]]), "xyzab"))  # fmt: skip
    triangles = _triangles(nodes)
    faces = fem.FaceLoad("tri3", triangles, np.full(triangles.shape, 1.0))
    solver, _ = solve(problem(x, _triangle_shell(triangles, 1e-3), fixed, face_loads=(faces,)))
    stiffness = 2.1e5 * 1e-9 / (12 * (1 - 0.09))
    assert -moved(solver, number[0, 0], 2) * stiffness / 0.00126532 == pytest.approx(1.0, abs=0.003)


# large displacements (Sze, Liu & Lo 2004)


def test_a_strip_rolls_up_to_a_circle() -> None:
    x, nodes, number = quads(16, 1, lambda r, s: np.stack([12 * r, s, 0 * r], -1))
    elements = shell(nodes, 0.1, Elastic.from_engineering(1.2e6, 0.0), geometry="total")
    moment = loaded(number[-1], 4, -50 * np.pi / 3, 0)
    p = problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(moment,), curves=(ramp(),),
                steps=((10, 0.1),))  # fmt: skip
    tip = number[-1, 0]
    solver, seen = solve(p, lambda s: (-moved(s, tip, 0), moved(s, tip, 2)))
    assert seen[4] == pytest.approx((12.0, 7.639), rel=0.01)  # half a turn
    assert seen[9] == pytest.approx((12.0, 0.0), abs=0.35)  # a whole one; 16 elements are 2.8 % off
    assert solver.energy_report()["balance_error"] < 1e-3


def test_a_cantilever_under_shear_follows_szes_curve(shared) -> None:  # type: ignore[no-untyped-def]
    x, nodes, number = quads(16, 1, lambda r, s: np.stack([10 * r, s, 0 * r], -1))
    elements = shell(nodes, 0.1, Elastic.from_engineering(1.2e6, 0.0), geometry="total")
    p = problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(loaded(number[-1], 2, 4.0, 0),),
                curves=(ramp(),), steps=((10, 0.1),))  # fmt: skip
    tip = number[-1, 0]
    _, seen = solve(p, lambda s: (-moved(s, tip, 0), moved(s, tip, 2)))
    rows = np.loadtxt(shared / "reference/fem/sze31_cantilever_shear.csv", delimiter=",", comments="#", skiprows=2)
    for (u, w), load in zip(seen, np.arange(1, 11) / 10, strict=True):
        row = rows[np.isclose(rows[:, 0], load)][0]
        assert u == pytest.approx(row[1], rel=0.01)
        assert w == pytest.approx(row[2], rel=0.01)


def test_a_load_at_once_takes_few_iterations() -> None:
    """A thin strip bent by a quarter of its length in one step: with factors of the last iteration it does not end."""
    x, nodes, number = quads(8, 1, lambda r, s: np.stack([4 * r, s, 0 * r], -1))
    elements = shell(nodes, 0.1, Elastic.from_engineering(2.1e5, 0.0), geometry="total")
    pull = loaded(number[-1], 2, 1.0)
    solver, _ = solve(problem(x, elements, held(len(x), (number[0], "xyzabc")), nodal_loads=(pull,)))
    assert moved(solver, number[-1, 0], 2) == pytest.approx(1.1177, rel=1e-4)
    assert solver.iterations <= 10


def test_a_hinged_roof_snaps_through(shared) -> None:  # type: ignore[no-untyped-def]
    x, nodes, number = quads(8, 8, lambda r, s: np.stack([2540 * np.sin(0.1 * r), 254 * s, 2540 * np.cos(0.1 * r)], -1))
    fixed = held(len(x), (number[0], "xbc"), (number[:, 0], "yac"), (number[-1], "xyz"))
    elements = shell(nodes, 12.7, Elastic.from_engineering(3102.75, 0.3), geometry="total")
    top = int(number[0, 0])
    p = problem(x, elements, fixed, nodal_loads=(loaded(top, 2, -750.0),), steps=((28, 1 / 28),),
                path=fem.Path(top, 2, -1.0, controlled=True))  # fmt: skip
    solver, seen = solve(p, lambda s: (-moved(s, top, 2), s.history()["load_factor"]))
    rows = np.loadtxt(shared / "reference/fem/sze38_hinged_roof_h12p7.csv", delimiter=",", comments="#", skiprows=2)
    rows = rows[rows[:, 1] < 28]
    path = np.array([(0.0, 0.0), *seen])
    from scipy.interpolate import CubicSpline

    found = CubicSpline(*path.T)(rows[:, 1])
    assert np.abs(found - rows[:, 0]).max() < 0.02  # of the largest load; it falls from 0.74 to 0.17 between
    assert solver.energy_report()["balance_error"] < 1e-3


def test_what_is_wrong_with_an_element_is_said() -> None:
    x = _warped(0.0)
    with pytest.raises(ArithmeticError, match="thickness"):
        Assembly(problem(x, shell(NODES, 0.0), held(4)))
    x[2] = [0.2, 0.2, 0.0]  # not convex
    a = Assembly(problem(x, shell(NODES, 0.1), held(4)))
    zero = Shape(np.zeros((4, 6)))
    with pytest.raises(ArithmeticError, match="convex"):
        a.evaluate(zero, zero, 0.0)
