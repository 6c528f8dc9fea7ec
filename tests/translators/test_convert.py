from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.translators import InputError, load_settings, read, to_particles, write
from zrno.translators.model import Model

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


def test_a_part_without_a_material(mesh: Model) -> None:
    with pytest.raises(InputError, match=r"a part has no material \(left\)"):
        to_particles(mesh, load_settings())


def test_shells_in_space_are_refused(tmp_path: Path) -> None:
    (tmp_path / "s.geo").write_text('SetFactory("OpenCASCADE"); Sphere(1) = {0, 0, 0, 1}; Mesh.MeshSizeMax = 0.5;\n')
    mesh = read(tmp_path / "s.geo")
    settings = load_settings(overrides={"materials.1.density": 1, "materials.1.E": 1, "materials.1.nu": 0})
    with pytest.raises(ValueError, match="not flat"):
        to_particles(mesh, settings, "shells")
    with pytest.raises(ValueError, match="expected solids, shells or nodes"):
        to_particles(mesh, settings, "spheres")
