from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.translators import InputError, load_settings, read, to_particles, write
from zrno.translators.model import (
    Analysis,
    BodyLoad,
    Constraint,
    Curve,
    ElementBlock,
    InitialVelocity,
    Material,
    Model,
    Part,
    Section,
)
from zrno.translators.settings import Settings

GEO = """\
SetFactory("OpenCASCADE");
Rectangle(1) = {-3, -0.5, 0, 3, 1};
Rectangle(2) = {0, -0.5, 0, 3, 1};
Physical Surface("left", 1) = {1};
Physical Surface("right", 2) = {2};
Physical Curve("face", 1) = {2};
Mesh.MeshSizeMax = 0.5;
"""
MATERIALS = {
    "materials.left.law": "von_mises", "materials.left.density": 2.7, "materials.left.E": 1.656,
    "materials.left.nu": 0.33, "materials.left.yield_stress": 0.0029, "materials.left.velocity": [0.01, 0, 0],
    "materials.right.density": 2.7, "materials.right.E": 1.656, "materials.right.nu": 0.33, "materials.right.bc": "xyz",
}  # fmt: skip


@pytest.fixture
def mesh(tmp_path: Path) -> Model:
    (tmp_path / "two.geo").write_text(GEO)
    return read(tmp_path / "two.geo")


def test_two_bodies(tmp_path: Path, mesh: Model, same) -> None:
    settings = load_settings(overrides={**MATERIALS, "end_time": 40, "gravity": [0, -1, 0], "xsph": True})
    model, report = to_particles(mesh, settings, spacing=0.1)
    assert len(model.particles) == 2 * 300
    assert np.unique(model.particles.material).tolist() == [1, 2]
    left, right = model.materials.values()
    assert (left.name, left.law, left.mass, left.h) == ("left", "von_mises", 8.1, 0.12)
    assert left.parameters == {"E": 1.656, "nu": 0.33, "yield_stress": 0.0029, "tangent_modulus": 0.0, "beta": 1.0}
    assert right.parameters == {"E": 1.656, "nu": 0.33}
    assert model.particles.bc.tolist() == [0] * 300 + [7] * 300
    assert model.particles.velocity[:, 0].tolist() == [0.01] * 300 + [0.0] * 300
    control = model.particle_control
    assert (control.dimension, control.end_time, control.output_interval, control.history_interval) == (2, 40, 2, 0.2)
    assert (control.velocity_option, control.base_acceleration, control.contact) == (1, (0.0, -1.0, 0.0), 0)
    assert {item.what: item.count for item in report.dropped} == {"line2 elements": 2, "node sets": 1}
    assert not write(model, tmp_path / "two.mcm")
    assert same(read(tmp_path / "two.mcm"), model)


def test_a_flat_mesh_turns_round_its_axis(tmp_path: Path, mesh: Model) -> None:
    """Particles are rings: the right square, 0..3 by 1, is a cylinder."""
    settings = load_settings(overrides={**MATERIALS, "axisymmetric": True})
    model, _ = to_particles(mesh, settings, spacing=0.1, parts=["right"])
    x, mass = model.particles.x, model.particles.mass
    assert np.allclose(mass, 2.7 * 0.01 * 2.0 * np.pi * x[:, 0], rtol=1e-12)
    assert model.materials[1].mass == pytest.approx(2.7 * np.pi * 9.0, rel=1e-12)
    write(model, tmp_path / "turned.mcm")
    again = read(tmp_path / "turned.mcm")
    assert again.particle_control.axisymmetric
    assert again.particle_control.dimension == again.dimension == 2
    assert "axisymmetric" in again.warnings[0]
    with pytest.raises(InputError, match="x is the radius"):
        to_particles(mesh, settings, spacing=0.1)


def test_one_part_by_name(mesh: Model) -> None:
    model, report = to_particles(mesh, load_settings(overrides=MATERIALS), spacing=0.1, parts=["right"])
    assert (len(model.particles), model.materials[1].name) == (300, "right")
    assert report.dropped[0].what == "parts"
    with pytest.raises(ValueError, match="the mesh has no part up; it has: 1 left, 2 right"):
        to_particles(mesh, load_settings(overrides=MATERIALS), parts=["up"])


def test_nodes_as_particles(mesh: Model) -> None:
    model, _ = to_particles(mesh, load_settings(overrides=MATERIALS), "nodes")
    assert len(model.particles) == len({tuple(x) for x in mesh.xyz.tolist()}) + 3  # the touching edges have nodes each
    assert model.particles.mass[model.particles.material == 1].sum() == pytest.approx(8.1, rel=1e-12)


def test_contact_and_friction(tmp_path: Path, mesh: Model) -> None:
    overrides = {
        **MATERIALS, "contact": "potential", "contact_laws.left.strength": 5, "contact_laws.right.strength": 6,
        "contact_laws.right.exponent": 2, "friction.static": 0.5, "friction.kinetic": 0.4,
    }  # fmt: skip
    model, _ = to_particles(mesh, load_settings(overrides=overrides), spacing=0.1)
    write(model, tmp_path / "a.mcm")
    control = read(tmp_path / "a.mcm").particle_control
    assert control.contact_laws == [(5.0, 4.0), (6.0, 2.0)]
    assert (control.dialect, control.friction) == ("2019-10", (0.5, 0.4))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"contact_laws.wrong.strength": 1}, "a part that the mesh does not have (wrong)"),
        ({"dimension": 3}, "the mesh has another dimension (3); expected 2"),
        ({"contact": "potential"}, "a part has no contact law (left)"),
    ],
)  # fmt: skip
def test_settings_that_do_not_fit_the_mesh(mesh: Model, change: dict, said: str) -> None:
    with pytest.raises(InputError) as caught:
        to_particles(mesh, load_settings(overrides={**MATERIALS, **change}))
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"right.density": None}, "materials.right.density is missing (right)"),
        ({"left.yield_stress": None}, "materials.left.yield_stress is missing"),
        ({"left.yield_stress": 0}, "materials.left.yield_stress is not positive (0)"),
        ({"left.beta": 2}, "materials.left.beta is too large (2); expected 0 to 1"),
        ({"left.tangent_modulus": 2}, "materials.left.tangent_modulus is too large (2); expected less than E"),
        ({"right.law": "cap"}, "materials.right.K is missing (right); expected a value of K"),
    ],
)
def test_materials_that_are_not_whole(mesh: Model, change: dict, said: str) -> None:
    overrides = {**MATERIALS, **{f"materials.{key}": value for key, value in change.items()}}
    with pytest.raises(InputError) as caught:
        to_particles(mesh, load_settings(overrides=overrides))
    assert said in str(caught.value)


def test_one_material_for_all_parts_that_have_none(mesh: Model) -> None:
    steel = {"density": 7.8, "E": 200, "nu": 0.3}
    given = {f"materials.*.{key}": value for key, value in steel.items()}
    given |= {"materials.left.density": 1, "materials.left.E": 100, "materials.left.nu": 0.1}
    given |= {"contact": "potential", "contact_laws.*.strength": 3}
    model, _ = to_particles(mesh, load_settings(overrides=given))
    left, right = model.materials.values()
    assert (left.name, left.density, left.parameters["E"]) == ("left", 1, 100)
    assert (right.name, right.density, right.parameters["E"]) == ("right", 7.8, 200)
    assert model.particle_control.contact_laws == [(3.0, 4.0)] * 2


def test_a_part_without_a_material(mesh: Model) -> None:
    with pytest.raises(InputError, match=r"a part has no material \(left\)"):
        to_particles(mesh, load_settings())


def test_what_a_law_does_not_take_is_said(mesh: Model) -> None:
    settings = load_settings(overrides={**MATERIALS, "materials.right.yield_stress": 1})
    _, report = to_particles(mesh, settings)
    assert "materials.right: the law elastic does not take yield_stress" in report.notes


def shell(settings: dict | None = None) -> tuple[Model, Settings]:
    """A square shell of 2 x 1 in space: three quads, of which one is halved into triangles; density 4."""
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1.5, 0, 0], [2, 0, 0], [0, 0, 1], [1, 0, 1], [1.5, 0, 1], [2, 0, 1]], float)
    quads = ElementBlock("quad4", np.array([1, 2]), np.array([[0, 1, 5, 4], [1, 2, 6, 5]]), np.ones(2, int), "shell")
    halves = ElementBlock("tri3", np.array([3, 4]), np.array([[2, 3, 7], [2, 7, 6]]), np.ones(2, int), "shell")
    mesh = Model(title="plate", node_ids=np.arange(1, 9), xyz=xyz, blocks=[quads, halves], parts={1: Part(1, "plate")})
    material = {"materials.plate.density": 4, "materials.plate.E": 1, "materials.plate.nu": 0}
    return mesh, load_settings(overrides=material | (settings or {}))


def test_shells_in_space() -> None:
    mesh, settings = shell({"materials.plate.thickness": 0.5})
    model, _ = to_particles(mesh, settings, "shells", 0.25)
    assert len(model.particles) == 16 + 8 + 2 * 25  # a triangle's longest side is cut into five
    assert model.materials[1].mass == pytest.approx(2 * 0.5 * 4, rel=1e-13)
    mass, x = model.particles.mass, model.particles.x
    np.testing.assert_allclose(mass @ x / mass.sum(), [1.0, 0.0, 0.5], atol=1e-13)
    nodes, _ = to_particles(mesh, settings, "nodes")
    assert (len(nodes.particles), nodes.materials[1].mass) == (8, 4.0)


def test_shells_without_thickness() -> None:
    with pytest.raises(InputError, match="the shells of part plate have no thickness"):
        to_particles(*shell(), "shells")
    mesh, settings = shell()
    with pytest.raises(ValueError, match="--particles shells covers shells in space"):
        to_particles(mesh, settings)
    with pytest.raises(ValueError, match="expected solids, shells or nodes"):
        to_particles(mesh, settings, "spheres")
    mesh.sections[7] = Section(7, kind="shell", parameters={"thickness_1": 0.1, "thickness_2": 0.3})
    mesh.parts[1].section = 7
    model, _ = to_particles(mesh, settings, "shells")
    assert model.materials[1].mass == pytest.approx(2 * 0.2 * 4, rel=1e-13)


def loose() -> Model:
    """Ten smoothed particles in two parts, of which the second is held; gravity, a velocity, times."""
    nodes = np.arange(10)
    block = ElementBlock("point1", nodes + 1, nodes[:, None], np.repeat([3, 1], 5), "sph")
    block.data["mass"] = np.repeat([0.5, 0.25], 5)
    mesh = Model(title="heap", node_ids=nodes + 1, xyz=np.stack([0.2 * nodes, 0 * nodes, 0 * nodes], 1), blocks=[block])
    mesh.parts = {3: Part(3, "sand", material=1, section=1), 1: Part(1, "floor", material=2)}
    mesh.materials[1] = Material(1, "sand", "cap", 2.0, {"K": 3.0, "G": 1.0, "alpha": 0.1, "D": 7.0, "W": 0.2})
    mesh.materials[2] = Material(2, "steel", "von_mises", 8.0, {"E": 200.0, "nu": 0.3}, curves={"hardening": 5})
    mesh.curves[5] = Curve(5, "", np.array([[0, 1.0], [0.1, 3.0], [0.2, 5.0]]))
    mesh.curves[6] = Curve(6, "", np.array([[0, 0.5], [100, 0.5]]))
    mesh.sections[1] = Section(1, kind="sph", parameters={"h": 0.3})
    mesh.constraints.append(Constraint(nodes[5:], np.tile([True, False, True, True, False, False], (5, 1))))
    mesh.initial_velocities.append(InitialVelocity(nodes[:1], np.array([[0.0, 0.0, -2.0]])))
    mesh.body_loads.append(BodyLoad((0.0, 0.0, -9.0), curve=6))
    mesh.analysis = Analysis(end_time=8.0, step_factor=0.5, output_interval=0.25)
    return mesh


def test_particles_of_the_mesh_keep_what_it_says(tmp_path: Path) -> None:
    model, report = to_particles(loose(), load_settings())
    assert model.particles.material.tolist() == [1] * 5 + [2] * 5
    assert model.particles.bc.tolist() == [0] * 5 + [6] * 5
    assert model.particles.velocity[:, 2].tolist() == [-2.0] + [0.0] * 9
    sand, floor = model.materials.values()
    assert (sand.law, sand.mass, sand.h, sand.parameters["alpha"]) == ("cap", 2.5, 0.3, 0.1)
    assert (floor.law, floor.mass, floor.h) == ("von_mises", 1.25, 0.24)
    # a straight table of slope 20 is bilinear hardening exactly
    assert floor.parameters["yield_stress"] == 1.0
    assert floor.parameters["tangent_modulus"] == pytest.approx(200 * 20 / 220, rel=1e-14)
    control = model.particle_control
    assert (control.end_time, control.step_factor, control.output_interval) == (8.0, 0.5, 0.25)
    assert control.base_acceleration == (0.0, 0.0, -4.5)
    assert not report


def test_settings_overrule_the_mesh() -> None:
    settings = {
        "end_time": 3, "gravity": [1, 0, 0], "h_factor": 2, "materials.sand.alpha": 7, "materials.floor.bc": "y",
        "materials.floor.law": "elastic", "materials.floor.E": 5, "materials.floor.nu": 0.25,
    }  # fmt: skip
    model, _ = to_particles(loose(), load_settings(overrides=settings))
    assert model.materials[1].parameters["alpha"] == 7.0
    assert (model.materials[2].law, model.materials[2].density) == ("elastic", 8.0)
    assert model.particles.bc.tolist() == [0] * 5 + [2] * 5
    assert (model.particle_control.end_time, model.particle_control.base_acceleration) == (3.0, (1.0, 0.0, 0.0))
    assert model.materials[1].h == pytest.approx(0.4)


def test_a_law_that_the_deck_has_not_is_a_named_drop() -> None:
    mesh = loose()
    mesh.materials[1].law = "soil_foam"
    mesh.materials[1].parameters = {"G": 1.0, "K": 2.0}
    model, report = to_particles(mesh, load_settings())
    assert [m.name for m in model.materials.values()] == ["floor"]
    assert [(i.what, i.count) for i in report.dropped] == [("elements of part sand", 5), ("parts", 1)]
    mesh.materials[2] = mesh.materials[1]
    with pytest.raises(ValueError, match=r"no part is left: an \.mcm deck has no law like soil_foam"):
        to_particles(mesh, load_settings())
