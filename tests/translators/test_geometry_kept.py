"""Geometry through every format: volume, area and mass of each part are the same in source and target."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from zrno.translators import load_settings, read, to_particles, write
from zrno.translators.elements import TABLE
from zrno.translators.fem import to_fem
from zrno.translators.geometry import measures
from zrno.translators.model import Model

GEO = """\
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 2, 1, 1};
Cylinder(2) = {2, 0.5, 0.5, 1.5, 0, 0, 0.4};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Physical Volume("box", 1) = {1};
Physical Volume("rod", 2) = {2};
Mesh.MeshSizeMax = 0.35;
Mesh.ElementOrder = %d;
"""


def by_part(model: Model) -> dict[str, float]:
    """Volume of each part by its name."""
    found: dict[str, float] = defaultdict(float)
    for block in model.blocks:
        if TABLE[block.kind].dimension == 3:
            size = measures(block, model.xyz)
            assert (size > 0).all()
            for part in np.unique(block.part).tolist():
                found[model.parts[part].name] += float(size[block.part == part].sum())
    return dict(found)


@pytest.fixture(scope="module", params=[1, 2])
def mesh(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Model:
    """A box and a rod that touch, of first or second order."""
    path = tmp_path_factory.mktemp("mesh") / "bodies.geo"
    path.write_text(GEO % request.param)
    return read(path)


@pytest.mark.parametrize("suffix", [".msh", ".k", ".neu", ".vtu"])
def test_volume_of_each_part(tmp_path: Path, mesh: Model, suffix: str) -> None:
    target = tmp_path / f"bodies{suffix}"
    write(mesh, target)
    again = read(target)
    expected = by_part(mesh)
    if suffix == ".vtu":  # which has no names
        assert list(by_part(again).values()) == pytest.approx([sum(expected.values())], rel=1e-9)
    else:
        assert by_part(again) == pytest.approx(expected, rel=1e-9)


def test_mass_of_each_part_as_particles(tmp_path: Path, mesh: Model) -> None:
    settings = load_settings(overrides={"materials.*.density": 3, "materials.*.E": 1, "materials.*.nu": 0})
    model, _ = to_particles(mesh, settings, spacing=0.2)
    write(model, tmp_path / "bodies.mcm")
    again = read(tmp_path / "bodies.mcm")
    particles = again.particles
    assert particles.mass is not None  # ten columns hold a mass to nine digits only
    masses = {m.name: float(particles.mass[particles.material == m.id].sum()) for m in again.materials.values()}
    assert masses == pytest.approx({name: 3 * volume for name, volume in by_part(mesh).items()}, rel=1e-9)


def test_volume_of_each_part_as_finite_elements(tmp_path: Path, mesh: Model) -> None:
    """Names are not in a .dat deck."""
    settings = load_settings(overrides={"materials.*.density": 3, "materials.*.E": 1, "materials.*.nu": 0})
    write(to_fem(mesh, settings)[0], tmp_path / "bodies.dat")
    again = read(tmp_path / "bodies.dat")
    found = sorted(
        sum(float(measures(b, again.xyz)[b.part == part].sum()) for b in again.blocks) for part in again.parts
    )
    assert found == pytest.approx(sorted(by_part(mesh).values()), rel=1e-9)
