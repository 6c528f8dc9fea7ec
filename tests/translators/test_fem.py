"""Meshes as finite element models: what holds, loads and moves them, by which law, in which groups."""

from __future__ import annotations

import numpy as np
import pytest

from zrno.translators import InputError, load_settings
from zrno.translators.fem import to_fem
from zrno.translators.model import (
    Analysis,
    BodyLoad,
    Constraint,
    CoordinateSystem,
    Curve,
    ElementBlock,
    InitialVelocity,
    Material,
    Model,
    NodalLoad,
    NodeSet,
    Part,
    Section,
)


def plate() -> Model:
    """Four shells in two parts, a cube below them in a third; the first edge is held, the last one is a set."""
    x, y = np.meshgrid(np.arange(3.0), np.arange(3.0), indexing="ij")
    top = np.stack([x.ravel(), y.ravel(), np.ones(9)], axis=1)
    cube = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    quads = np.array([[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]])
    mesh = Model(title="plate", node_ids=np.arange(1, 14), xyz=np.concatenate([top, cube]))
    mesh.blocks = [
        ElementBlock("quad4", np.arange(1, 5), quads, np.array([1, 1, 2, 2]), "shell"),
        ElementBlock("hex8", np.array([1]), np.array([[9, 10, 11, 12, 0, 3, 4, 1]]), np.array([3]), "solid"),
        ElementBlock("line2", np.array([9]), np.array([[0, 1]]), np.array([0])),
        ElementBlock("point1", np.array([7]), np.array([[8]]), np.array([4]), "sph"),
    ]
    mesh.parts = {1: Part(1, "left", 5, section=2), 2: Part(2, "right", 6, section=2), 3: Part(3, "foot", 5)}
    mesh.materials = {
        5: Material(5, "steel", "elastic", 7.8, {"E": 200.0, "nu": 0.3}),
        6: Material(6, "soft", "von_mises", 7.8, {"E": 200.0, "nu": 0.3, "yield_stress": 1.0, "beta": 0.5}),
    }
    mesh.sections = {2: Section(2, "thin", "shell", {"thickness": 0.25})}
    mesh.node_sets = [NodeSet(3, "edge", np.array([6, 7, 8]))]
    mesh.constraints = [Constraint(np.array([0, 1, 2]), np.ones((3, 6), bool))]
    mesh.analysis = Analysis(end_time=2.0)
    return mesh


def settings(**given: object):  # type: ignore[no-untyped-def]
    return load_settings(overrides={"end_time": 2, **{key.replace("__", "."): value for key, value in given.items()}})


def test_groups_laws_and_sections() -> None:
    model, report = to_fem(plate(), settings())
    assert [(b.kind, b.family, b.part.tolist()) for b in model.blocks] == [
        ("quad4", "shell", [1, 1, 2, 2]), ("hex8", "solid", [3]),
    ]  # fmt: skip
    left, right, foot = model.parts.values()
    assert model.materials[left.material].law == model.materials[foot.material].law == "elastic"
    power = model.materials[right.material]
    assert (power.law, power.parameters["M"]) == ("von_mises_power", 0.5)  # PAK's bilinear law hardens isotropically
    sections = [model.sections[part.section] for part in (left, right, foot)]
    assert [s.kind for s in sections] == ["shell", "shell", "solid"]
    assert [s.native["IATYP"] for s in sections] == [0, 1, 0]
    assert [s.parameters for s in sections] == [{"thickness": 0.25}, {"thickness": 0.25}, {}]
    assert sections[1].native["NGAUSZ"] == 5
    assert {i.what: i.count for i in report.dropped} == {"line2 elements": 1, "particles": 1, "node sets": 1}
    assert not report.approximated


def test_what_is_held() -> None:
    model, _ = to_fem(plate(), settings(sets__edge__fixed="x z"))
    assert model.fixed[:3].all()
    assert model.fixed[6].tolist() == [True, False, True, False, False, False]
    assert model.fixed[3].tolist() == [False] * 6  # a shell's node, though the cube has it too
    assert model.fixed[9].tolist() == [False] * 3 + [True] * 3  # a solid's alone has no rotations
    flat = plate()
    flat.dimension = 2
    flat.blocks, flat.parts = [flat.blocks[0]], {1: flat.parts[1], 2: flat.parts[2]}
    flat.blocks[0].family, flat.sections = "plane", {}
    plane, _ = to_fem(flat, settings())
    assert plane.fixed[4].tolist() == [False, False, True, True, True, True]
    assert {(s.plane, s.parameters["thickness"]) for s in plane.sections.values()} == {("strain", 1.0)}


def test_motion_of_a_set_by_a_function() -> None:
    lift = {"sets.edge.displacement": [None, None, 50], "sets.edge.function": "lift",
            "functions.lift.points": [[0, 0], [1, 1], [2, 1]], "sets.edge.fixed": "y z"}  # fmt: skip
    model, _ = to_fem(plate(), load_settings(overrides={"end_time": 2, "fem.steps": 4, **lift}))
    (load,) = model.nodal_loads
    assert (load.kind, load.nodes.tolist(), set(load.dofs.tolist()), set(load.values.tolist())) == (
        "displacement", [6, 7, 8], {3}, {50.0},
    )  # fmt: skip
    assert model.curves[load.curve].points.tolist() == [[0, 0], [1, 1], [2, 1]]
    assert model.fixed[6].tolist() == [False, True, False, False, False, False]  # what moves is not held
    assert model.fem_control.periods == [(4, 0.5)]


@pytest.mark.parametrize(("steps", "points"), [(1, [[0, 1], [2, 1]]), (5, [[0, 0], [2, 1]])])
def test_a_load_without_a_function(steps: int, points: list) -> None:
    model, _ = to_fem(
        plate(), load_settings(overrides={"end_time": 2, "fem.steps": steps, "sets.edge.force": [0, 0, -3]})
    )
    (load,) = model.nodal_loads
    assert (load.kind, load.dofs[0], load.values[0]) == ("force", 3, -3.0)
    assert model.curves[load.curve].points.tolist() == points


def test_motions_become_displacements() -> None:
    mesh = plate()
    mesh.curves[4] = Curve(4, "speed", np.array([[0.0, 0.0], [2.0, 4.0]]))
    at = (np.array([6]), np.array([3]), np.array([1.0]))
    mesh.nodal_loads = [NodalLoad("velocity", *at), NodalLoad("velocity", *at, 4), NodalLoad("acceleration", *at, 4)]
    model, report = to_fem(mesh, settings())
    steady, growing, jerk = (model.curves[load.curve].points for load in model.nodal_loads)
    assert steady.tolist() == [[0.0, 0.0], [2.0, 2.0]]
    np.testing.assert_allclose(growing[:, 1], growing[:, 0] ** 2, atol=1e-12)  # the integral of 2 t, at every point
    assert jerk[-1, 1] == pytest.approx(8 / 3, rel=2e-3)  # twice integrated: t^3 / 3
    assert [load.kind for load in model.nodal_loads] == ["displacement"] * 3
    assert {i.what for i in report.approximated} == {"prescribed velocity", "prescribed acceleration"}


def test_what_a_deck_cannot_say() -> None:
    mesh = plate()
    turned = np.array([[0, 1, 0], [1, 0, 0], [0, 0, 1]], float)
    mesh.systems[9] = CoordinateSystem(9, "", "rectangular", np.zeros(3), turned)
    mesh.nodal_loads = [NodalLoad("force", np.array([6]), np.array([1]), np.array([1.0]), system=9)]
    mesh.constraints.append(Constraint(np.array([5]), np.ones((1, 6), bool), system=9))
    mesh.body_loads = [BodyLoad((0.0, 0.0, -9.8), parts=(1,))]
    mesh.initial_velocities = [InitialVelocity(np.array([5]), np.ones((1, 3)))]
    mesh.curves[4] = Curve(4, "nobody's", np.zeros((2, 2)))
    model, report = to_fem(mesh, settings())
    lost = {i.what: i.count for i in (*report.dropped, *report.approximated)}
    assert {
        "loads on nodes": 1,
        "constraints": 1,
        "body loads": 1,
        "initial velocities": 1,
        "curves": 1,
    }.items() <= lost.items()
    assert not model.fixed[5].any()
    assert len(to_fem(mesh, settings(fem__analysis="dynamic"))[0].initial_velocities) == 1


def test_laws_that_a_deck_has_not() -> None:
    mesh = plate()
    mesh.materials[6] = Material(6, "foam", "soil_foam", 1.0, {"G": 1.0, "K": 2.0})
    model, report = to_fem(mesh, settings())
    assert sorted(model.parts) == [1, 3]
    assert ("elements of part right", 2) in [(i.what, i.count) for i in report.dropped]
    assert len(model.xyz) == 10  # the nodes of what is dropped are gone
    mesh.materials[5] = mesh.materials[6]
    with pytest.raises(ValueError, match=r"no part is left: a \.dat deck has no law like soil_foam"):
        to_fem(mesh, settings())


def test_only_what_has_inertia_or_weight_needs_a_density() -> None:
    mesh = plate()
    mesh.materials[5].density = 0.0
    assert to_fem(mesh, settings())[0].materials[5].density == 0.0
    with pytest.raises(InputError, match=r"materials\.left\.density is missing"):
        to_fem(mesh, settings(fem__analysis="dynamic"))
    mesh.body_loads = [BodyLoad((0.0, 0.0, -9.8))]
    with pytest.raises(InputError, match=r"materials\.left\.density is missing"):
        to_fem(mesh, settings())


def test_settings_that_do_not_fit() -> None:
    with pytest.raises(InputError, match="the mesh has no such set of nodes"):
        to_fem(plate(), settings(sets__rim__fixed="all"))
    bare = plate()
    bare.sections = {}
    with pytest.raises(InputError, match="the shells of part left have no thickness"):
        to_fem(bare, settings())
    with pytest.raises(InputError, match="no such function"):
        settings(sets__edge__function="none")
    rods = plate()
    rods.blocks = [ElementBlock("line2", np.array([1]), np.array([[0, 6]]), np.array([1]), "truss")]
    with pytest.raises(InputError, match="the bars of part left have no cross-section"):
        to_fem(rods, settings())
    rods.blocks[0].family = "sph"
    with pytest.raises(ValueError, match="no elements that a"):
        to_fem(rods, settings())


def test_control_cards() -> None:
    given = {"fem.analysis": "dynamic", "fem.steps": 8, "fem.mass": "lumped", "fem.force_tolerance": 0.01,
             "fem.kinematics": "updated_lagrange", "fem.method": "line_search"}  # fmt: skip
    model, _ = to_fem(plate(), load_settings(overrides={"end_time": 2, **given}))
    control = model.fem_control
    assert (control.dynamic, control.mass, control.iteration, control.periods) == (1, 2, 4, [(8, 0.25)])
    assert (control.converge_on, control.tolerances[:2]) == ((1, 1, 0), (1e-6, 0.01))
    assert {s.native["IATYP"] for s in model.sections.values()} == {3}
    linear, _ = to_fem(
        plate(), settings(materials__right__law="elastic", materials__right__E=1, materials__right__nu=0)
    )
    assert linear.fem_control.iteration == 1
