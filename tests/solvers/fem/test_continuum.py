"""Solids and plane elements: patch tests, rigid motions, locking, orders of convergence."""

from __future__ import annotations

import numpy as np
import pytest
from fem_meshes import bricks, group, held, loaded, moved, plane, problem, quads, solve

from zrno.solvers import fem
from zrno.solvers.fem.assembly import Assembly
from zrno.solvers.fem.elements import shapes
from zrno.solvers.fem.shape import Shape
from zrno.solvers.materials import Elastic
from zrno.translators.elements import TABLE

STEEL = Elastic.from_engineering(2.1e5, 0.3)
SOLIDS = ["tet4", "tet10", "pyramid5", "pyramid13", "wedge6", "wedge15", "hex8", "hex20", "hex27"]
PLANES = ["tri3", "tri6", "quad4", "quad8", "quad9"]


def _one(kind: str, seed: int = 1) -> np.ndarray:
    """Nodes of one element whose corners are out of place; nodes between them on straight lines."""
    corners = TABLE[kind].shape.corners
    low = next(k for k in shapes.NODES if TABLE[k].shape is TABLE[kind].shape and TABLE[k].nodes == corners)
    place = np.array(shapes.NODES[low], dtype=float)
    place = place + 0.12 * np.random.default_rng(seed).standard_normal(place.shape)
    values, _ = shapes.functions(low, np.array(shapes.NODES[kind], dtype=float))
    out = values @ place
    return out if out.shape[1] == 3 else plane(out)


@pytest.mark.parametrize(("kind", "modes"), [*((k, 0) for k in SOLIDS + PLANES), ("hex8", 12), ("quad4", 4)])
def test_patch(kind: str, modes: int) -> None:
    """A linear displacement of all nodes gives its constant stress everywhere, and forces in balance."""
    x = _one(kind)
    flat = kind in PLANES
    nodes = np.arange(len(x))[None]
    elements = group(kind, "plane" if flat else "solid", nodes, STEEL, modes=modes, plane="strain" if flat else "")
    a = Assembly(problem(x, elements, held(len(x))))
    gradient = 1e-3 * np.random.default_rng(5).standard_normal((3, 3))
    if flat:
        gradient[2] = gradient[:, 2] = 0.0
    u = np.zeros((len(x), 6))
    u[:, :3] = x @ gradient.T
    zero = Shape(np.zeros_like(u))
    a.evaluate(zero, zero, 0.0)
    forces, _ = a.evaluate(Shape(u), zero, 0.0)
    a.commit()
    strain = 0.5 * (gradient + gradient.T)
    expected = STEEL.lame * np.trace(strain) * np.eye(3) + 2 * STEEL.shear * strain
    found = a.groups[0].stress  # type: ignore[attr-defined]
    six = expected[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    np.testing.assert_allclose(found, np.broadcast_to(six, found.shape), rtol=1e-10, atol=1e-10 * np.abs(six).max())
    np.testing.assert_allclose(forces[:, :3].sum(axis=0), 0.0, atol=1e-10 * np.abs(forces).max())


@pytest.mark.parametrize(("kind", "modes"), [("hex8", 0), ("hex8", 12), ("hex20", 0), ("tet10", 0), ("wedge6", 0)])
def test_no_stiffness_against_rigid_motions_and_no_other_mode(kind: str, modes: int) -> None:
    x = _one(kind, 2)
    a = Assembly(problem(x, group(kind, "solid", np.arange(len(x))[None], STEEL, modes=modes), held(len(x))))
    zero = Shape(np.zeros((len(x), 6)))
    a.evaluate(zero, zero, 0.0)
    values = np.linalg.eigvalsh(a.system.full().toarray())
    assert (np.abs(values[:6]) < 1e-10 * values[-1]).all()
    assert values[6] > 1e-4 * values[-1]


def test_distorted_bricks_pass_the_patch_test() -> None:
    """Seven bricks, one inside: the inner nodes find the linear field by themselves (MacNeal & Harder 1985)."""
    low = [(0.249, 0.342, 0.192), (0.826, 0.288, 0.288), (0.850, 0.649, 0.263), (0.273, 0.750, 0.230)]
    inner = np.array([*low, (0.320, 0.186, 0.643), (0.677, 0.305, 0.683), (0.788, 0.693, 0.644), (0.165, 0.745, 0.702)])
    outer = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], float)
    x = np.concatenate([outer, inner])
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    nodes = np.array([tuple(range(8, 16))] + [(*(8 + k for k in f), *f) for f in faces])
    gradient = 1e-3 * np.array([[2.0, 1.0, 0.5], [1.0, 2.0, 1.0], [0.5, 1.0, 2.0]])
    target = x @ gradient.T
    motion = fem.Motion(np.repeat(np.arange(8), 3), np.tile([0, 1, 2], 8), target[:8].ravel())
    for modes, mean in ((0, False), (9, False), (12, False), (0, True)):
        elements = group("hex8", "solid", nodes, STEEL, modes=modes, mean=mean)
        solver, _ = solve(problem(x, elements, held(16), motions=(motion,)))
        np.testing.assert_allclose(solver.shape.u[8:, :3], target[8:], rtol=1e-10)
        assert solver.energy_report()["balance_error"] < 1e-10


@pytest.mark.parametrize("stressed", ["stress", "strain"])
def test_plane_stress_and_plane_strain_in_tension(stressed: str) -> None:
    x, nodes, number = quads(3, 2, lambda r, s: np.stack([2 * r, s, 0 * r], -1))
    fixed = held(len(x), (number[0], "x"), (number[0, 0], "y"))
    pull = loaded(number[-1], 0, 0.0)
    share = np.array([0.25, 0.5, 0.25]) * 30.0
    pull = fem.NodalLoad(pull.nodes, pull.dofs, share)
    elements = group("quad4", "plane", nodes, STEEL, plane=stressed, thickness=np.full(len(nodes), 1.0))
    solver, _ = solve(problem(x, elements, fixed, nodal_loads=(pull,)))
    young = 2.1e5 if stressed == "stress" else 2.1e5 / (1 - 0.3**2)
    assert moved(solver, number[-1, 0], 0) == pytest.approx(30.0 * 2.0 / young, rel=1e-10)
    lateral = 0.3 if stressed == "stress" else 0.3 / 0.7
    assert moved(solver, number[-1, -1], 1) == pytest.approx(-lateral * 30.0 / young, rel=1e-10)
    of_plane = solver.assembly.groups[0].stress[:, 2]  # type: ignore[attr-defined]
    np.testing.assert_allclose(of_plane, 0.0 if stressed == "stress" else 0.3 * 30.0, atol=1e-9)


def test_a_thick_cylinder_has_lames_stresses() -> None:
    """Axisymmetric, plane strain along the axis; pressure at the bore."""
    inner, outer, pressure = 1.0, 2.0, 10.0
    x, nodes, number = quads(40, 1, lambda r, s: np.stack([inner + r * (outer - inner), 0.05 * s, 0 * r], -1))
    edge = fem.FaceLoad("line2", np.array([[number[0, 1], number[0, 0]]]), np.full((1, 2), pressure),
                        thickness=np.ones(1), plane="axisymmetric")  # fmt: skip
    elements = group("quad4", "plane", nodes, STEEL, plane="axisymmetric", modes=0)
    solver, _ = solve(problem(x, elements, held(len(x), (slice(None), "y")), face_loads=(edge,)))
    a = pressure * inner**2 / (outer**2 - inner**2)
    exact = (1 + 0.3) / 2.1e5 * (a * (1 - 0.6) * inner + a * outer**2 / inner)
    assert moved(solver, number[0, 0], 0) == pytest.approx(exact, rel=2e-4)


@pytest.mark.parametrize(
    ("kind", "modes", "least"), [("quad4", 0, 1.9), ("quad4", 4, 1.9), ("quad8", 0, 2.9), ("quad9", 0, 2.9)]
)
def test_order_of_convergence_in_the_plane(kind: str, modes: int, least: float) -> None:
    """The thick cylinder's quarter: displacement in L2 against Lame's."""
    errors = []
    for n in (4, 8):
        errors.append(_lame_error(kind, modes, n))
    assert np.log2(errors[0] / errors[1]) > least


def _lame_error(kind: str, modes: int, n: int) -> float:
    """Displacements given at the whole border of a quarter ring; the error is inside."""
    step = 1 if kind == "quad4" else 2
    m = n * step
    r, s = np.meshgrid(np.linspace(0, 1, m + 1), np.linspace(0, 1, m + 1), indexing="ij")
    radius, angle = 1 + r.ravel(), 0.5 * np.pi * s.ravel()
    x = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius], -1)
    number = np.arange(len(x)).reshape(m + 1, m + 1)
    lo = slice(None, -1, step), slice(step, None, step), slice(step // 2, None, step)
    at = {-1: lo[0], 1: lo[1], 0: lo[2]}
    places = [(int(a), int(b)) for a, b in shapes.NODES[kind]]
    nodes = np.stack([number[at[a], at[b]] for a, b in places], axis=-1).reshape(-1, len(places))
    exact = (1 + 0.3) / 2.1e5 * (0.4 * radius + 4.0 / radius)
    u = np.stack([exact * np.cos(angle), exact * np.sin(angle), 0 * exact], -1)
    border = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    motion = fem.Motion(np.repeat(border, 2), np.tile([0, 1], len(border)), u[border, :2].ravel())
    used = np.unique(nodes)
    loose = held(len(x), (np.setdiff1d(np.arange(len(x)), used), "xy"))
    motion = fem.Motion(*(a[np.isin(motion.nodes, used)] for a in (motion.nodes, motion.dofs, motion.values)))
    solver, _ = solve(problem(x, group(kind, "plane", nodes, STEEL, plane="strain", modes=modes), loose,
                              motions=(motion,)))  # fmt: skip
    t = shapes.table(kind, (4, 4))
    corners = x[nodes]
    jacobian = np.einsum("gnd,eni->egid", t.slopes, corners[:, :, :2])
    weight = np.linalg.det(jacobian) * t.weights
    found = np.einsum("gn,eni->egi", t.values, solver.shape.u[nodes][:, :, :2])
    at_points = np.einsum("gn,eni->egi", t.values, corners)
    there, turn = np.hypot(at_points[..., 0], at_points[..., 1]), np.arctan2(at_points[..., 1], at_points[..., 0])
    wanted = ((1 + 0.3) / 2.1e5 * (0.4 * there + 4.0 / there))[..., None] * np.stack([np.cos(turn), np.sin(turn)], -1)
    return float(np.sqrt((((found - wanted) ** 2).sum(axis=-1) * weight).sum()))


def test_order_of_convergence_of_bricks() -> None:
    """A cube with given border, under the body force of a known field."""
    errors = [_cube_error(n) for n in (4, 8)]
    assert np.log2(errors[0] / errors[1]) > 1.9


def _harmonic(p: np.ndarray) -> np.ndarray:
    """A displacement that is harmonic and free of divergence: no body force is needed."""
    x, y, z = np.moveaxis(p, -1, 0)
    return np.stack([np.exp(y) * np.sin(z), np.exp(z) * np.sin(x), np.exp(x) * np.sin(y)], -1)


def _cube_error(n: int) -> float:
    x, nodes, number = bricks(n, n, n)
    inside = number[1:-1, 1:-1, 1:-1].ravel()
    border = np.setdiff1d(number.ravel(), inside)
    u = _harmonic(x)
    motion = fem.Motion(np.repeat(border, 3), np.tile([0, 1, 2], len(border)), u[border].ravel())
    solver, _ = solve(problem(x, group("hex8", "solid", nodes, STEEL), held(len(x)), motions=(motion,)))
    t = shapes.table("hex8", (3, 3, 3))
    found = np.einsum("gn,eni->egi", t.values, solver.shape.u[nodes][:, :, :3])
    p = np.einsum("gn,eni->egi", t.values, x[nodes])
    wanted = _harmonic(p)
    return float(np.sqrt((((found - wanted) ** 2).sum(axis=-1) * t.weights).sum() / n**3))


def test_enhanced_bricks_bend_and_do_not_lock_where_nothing_is_compressible() -> None:
    x, nodes, number = bricks(10, 1, 1, (10, 1, 1))
    tips = {}
    for nu in (0.3, 0.4999):
        for modes in (0, 12):
            elements = group("hex8", "solid", nodes, Elastic.from_engineering(1e3, nu), modes=modes)
            p = problem(x, elements, held(len(x), (number[0], "xyz")), nodal_loads=(loaded(number[-1], 2, -1.0),))
            tips[nu, modes] = moved(solve(p)[0], number[-1, 0, 0], 2)
    slender = -1.0 * 10**3 / (3 * 1e3 / 12)
    assert tips[0.3, 12] == pytest.approx(slender, rel=0.03)
    assert tips[0.4999, 12] == pytest.approx(slender, rel=0.05)
    assert abs(tips[0.4999, 0]) < 0.1 * abs(slender)
    assert abs(tips[0.3, 0]) < 0.75 * abs(slender)


def test_large_rotation_leaves_no_stress() -> None:
    """Total Lagrangian: exactly; updated, in steps: its increments see none either."""
    x, nodes, _ = bricks(1, 1, 1)
    x = x + 0.1 * np.random.default_rng(0).standard_normal(x.shape)
    for geometry, most in (("total", 1e-12), ("updated", 1e-12)):
        a = Assembly(problem(x, group("hex8", "solid", nodes, STEEL, geometry=geometry), held(8)))
        before = Shape(np.zeros((8, 6)))
        for angle in np.linspace(0, 1.2, 13)[1:]:
            c, s = np.cos(angle), np.sin(angle)
            turned = x @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T
            shape = Shape(np.column_stack([turned - x, np.zeros((8, 3))]))
            a.evaluate(shape, before, 0.0)
            a.commit()
            before = shape
        stress = np.abs(a.groups[0].stress).max()  # type: ignore[attr-defined]
        assert stress < most * 2.1e5 * 100


@pytest.mark.parametrize("modes", [0, 9, 12])
def test_the_matrix_is_the_derivative_of_the_forces(modes: int) -> None:
    """Total Lagrangian; that of the updated one leaves out how the midpoint moves."""
    x, nodes, _ = bricks(1, 1, 1)
    rng = np.random.default_rng(4)
    a = Assembly(problem(x, group("hex8", "solid", nodes, STEEL, geometry="total", modes=modes), held(8)))
    zero = Shape(np.zeros((8, 6)))
    u = np.zeros((8, 6))
    u[:, :3] = 0.1 * rng.standard_normal((8, 3))

    def forces(v: np.ndarray) -> np.ndarray:
        for _ in range(8 if modes else 1):  # the enhanced strains find their balance
            out, _ = a.evaluate(Shape(v), zero, 0.0)
        return out[:, :3].ravel()

    forces(u)
    matrix = a.system.full().toarray()
    numeric = np.empty_like(matrix)
    for k in range(24):
        step = np.zeros((8, 6))
        step[k // 3, k % 3] = 1e-6
        numeric[:, k] = (forces(u + step) - forces(u - step)) / 2e-6
    np.testing.assert_allclose(matrix, numeric, atol=1e-6 * np.abs(matrix).max())


def test_an_element_without_volume_is_named() -> None:
    x, nodes, _ = bricks(2, 1, 1)
    x[nodes[1, 4:]] = x[nodes[1, :4]]
    with pytest.raises(ArithmeticError) as caught:
        Assembly(problem(x, group("hex8", "solid", nodes, STEEL), held(len(x))))
    assert caught.value.element == 2  # type: ignore[attr-defined]
