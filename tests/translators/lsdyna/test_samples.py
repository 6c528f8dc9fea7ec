"""Decks of other programs and people: counts as the list of samples has them, and what is in the tricky ones."""

from __future__ import annotations

import shutil
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.geometry import measures
from zrno.translators.lsdyna import read
from zrno.translators.text import InputError

# File: nodes, elements by family; each file by itself. Includes are followed: `bolt_a/mainboltaexpl.k` and
# `bolt_a/includes.k` have the mesh of `bolted_connection_a.k`, which the list of samples counts there alone.
COUNTS: dict[str, tuple[int, dict[str, int]]] = {
    "birdball.k": (1281, {"solid": 816, "shell": 100}),
    "bird.k": (5185, {"shell": 960, "sph": 4160}),
    "bracket.k": (1972, {"shell": 1865}),
    "ex13_thick_shell.k": (324, {"tshell": 192}),
    "airfilled_sphere_reduced.k": (2, {"shell": 2}),
    "dynakw_thick.k": (2, {"shell": 2}),
    "dynakw_sets.k": (0, {}),
    "dynakw_parameter_test.k": (0, {}),
    "dynakw_joint_revolute.k": (10, {"shell": 3}),
    "plate_shatter_reduced.k": (3, {"shell": 3}),
    "expand_test/bird_B.k": (0, {"beam": 4}),
    "expand_test/control_cards.k": (0, {}),
    "expand_test/fol/mesh.k": (1781, {"solid": 729, "shell": 99}),
    "multiline_comment.k": (0, {}),
    "isph.k": (0, {}),
    "elementary_transform.k": (24, {"solid": 5}),
    "taylor_bar_mesh.k": (1122, {"solid": 768}),
    "beer_can_mesh.k": (3437, {"shell": 3320}),
    "ball_plate.k": (1940, {"solid": 1512, "shell": 256}),
    "frf_solid.k": (440, {"solid": 252}),
    "bolt_a/mainboltaexpl.k": (1946, {"solid": 784, "shell": 556, "beam": 1}),
    "bolt_a/includes.k": (1946, {"solid": 784, "shell": 556, "beam": 1}),
    "bolt_a/bolted_connection_a.k": (1946, {"solid": 784, "shell": 556, "beam": 1}),
    "bolt_a/control_explicit.k": (0, {}),
    "bolt_a/submodels/loading/prescribed_motion.k": (0, {}),
    "bolt_a/submodels/material_props.k": (0, {}),
    "mlp6_nodes.dyn": (1331, {}),
    "mlp6_elems.dyn": (0, {"solid": 1000}),
    "weldform_2el.k": (5, {"solid": 2}),
    "weldform_cyl_hex.k": (6479, {"solid": 5760}),
    "topalovic_kupa1.k": (802, {"sph": 802}),
    "gen/long_y.k": (12, {"solid": 2}),
    "gen/i10_y.k": (12, {"solid": 2}),
}


@pytest.fixture
def folder(shared: Path) -> Path:
    """Where the decks are."""
    return shared / "samples" / "lsdyna"


def test_every_sample_is_tested(folder: Path) -> None:
    assert {str(p.relative_to(folder)) for p in folder.rglob("*") if p.suffix in (".k", ".dyn")} == set(COUNTS)


@pytest.mark.parametrize("name", COUNTS)
def test_counts(folder: Path, name: str) -> None:
    model = read(folder / name, partial=True, allow_outside=name.endswith("prescribed_motion.k"))
    found: Counter[str] = Counter()
    for block in model.blocks:
        found[block.family] += len(block.ids)
    assert (len(model.xyz), dict(found)) == COUNTS[name]


@pytest.mark.parametrize("name", ["gen/long_y.k", "gen/i10_y.k"])
def test_two_cubes_in_other_columns(folder: Path, name: str) -> None:
    model = read(folder / name)
    first = 1 if "long" in name else 1_000_000_001
    assert model.node_ids.tolist() == list(range(first, first + 12))
    assert model.xyz.max(axis=0).tolist() == [2.0, 1.0, 1.0]
    assert measures(model.blocks[0], model.xyz).tolist() == pytest.approx([1.0, 1.0])
    assert model.materials[1].parameters == {"E": 2.1e5, "nu": 0.3}
    assert model.materials[1].density == 7.85e-9
    assert {p.name for p in model.parts.values()} == {"cube"}


def test_two_line_solids_of_a_bar(folder: Path) -> None:
    model = read(folder / "taylor_bar_mesh.k")
    volume = measures(model.blocks[0], model.xyz)
    assert (volume > 0).all()
    assert volume.sum() == pytest.approx(np.pi * 4.0**2 / 4 * 30.0, rel=0.01)  # a quarter of a cylinder, in chords


def test_tetrahedra_that_are_written_as_hexahedra(folder: Path) -> None:
    model = read(folder / "weldform_2el.k")
    assert model.element_counts() == {"tet4": 2}
    assert (measures(model.blocks[0], model.xyz) > 0).all()


def test_the_deck_of_the_dissertation(folder: Path) -> None:
    model = read(folder / "topalovic_kupa1.k")
    assert model.analysis.end_time == 1000.0
    assert {p.id: (p.name, p.material, p.section) for p in model.parts.values()} == {
        1: ("SphNode kupa", 2, 1), 2: ("SphNode ploca", 1, 2),
    }  # fmt: skip
    cap = model.materials[2]
    assert cap.law == "cap"
    assert cap.parameters["K"] == 30.620001
    assert model.curves[1].points.tolist() == [[0.0, 0.00981], [100.0, 0.00981], [10000.0, 0.00981]]
    assert model.body_loads[0].acceleration == (0.0, 0.0, -1.0)
    (held,) = model.constraints
    assert (len(held.nodes), held.dofs.all()) == (324, True)
    (sph,) = model.blocks
    assert {n: set(sph.data["mass"][sph.part == n].tolist()) for n in (1, 2)} == {1: {0.817085}, 2: {0.934256}}


def test_a_tree_of_includes_with_parameters(folder: Path) -> None:
    model = read(folder / "bolt_a/mainboltaexpl.k", partial=True)
    assert [Path(path).name for path in model.includes] == [
        "includes.k", "bolted_connection_a.k", "control_explicit.k", "prescribed_motion.k", "material_props.k",
        "material_props.k",
    ]  # fmt: skip
    assert model.analysis.end_time == 5.0
    assert model.analysis.output_interval == 5.0 / 100.0
    # the curve of pre-force: scales are parameters, one of them an expression of another
    assert model.curves[100].points.tolist() == [[0.0, 0.0], [1.0, 28.8]]
    assert model.curves[11].points.tolist() == [[0.0, 0.0], [2.5, 0.0], [5.0, 5.0], [5.0 * 1.01, 5.0]]
    assert model.curves[1001].points.tolist() == [[0.0, 0.0], [0.25, 1.0], [2.5, 15.0], [5.0 * 1.01, 15.0]]
    assert model.materials[1].parameters == {"E": 210000.0, "nu": 0.3}
    (lost,) = model.incomplete
    assert lost.endswith("bolt_a/mainboltaexpl.k:89: the file missing_geometry.k that is included here is not there")
    with pytest.raises(InputError) as caught:
        read(folder / "bolt_a/mainboltaexpl.k")
    assert ":89:1: error: there is no such file to include (missing_geometry.k)" in str(caught.value)


def test_the_same_tree_with_what_it_lacks(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder / "bolt_a", tmp_path / "bolt", copy_function=shutil.copyfile)
    for path in [tmp_path / "bolt", *(tmp_path / "bolt").rglob("*")]:
        path.chmod(0o755)
    (tmp_path / "bolt/missing_geometry.k").write_text("*SET_NODE_LIST\n2\n1\n")
    model = read(tmp_path / "bolt/mainboltaexpl.k")
    assert not model.incomplete
    assert [load.kind for load in model.nodal_loads] == ["displacement", "velocity"]
    assert model.nodal_loads[1].values.tolist() == [10.0]


def test_an_include_without_a_path_to_it(folder: Path) -> None:
    with pytest.raises(InputError) as caught:
        read(folder / "expand_test/bird_B.k")
    assert "control_cards.k:38:1: error: there is no such file to include (mesh.k)" in str(caught.value)


def test_all_layouts_of_sets(folder: Path, tmp_path: Path) -> None:
    shutil.copyfile(folder / "dynakw_sets.k", tmp_path / "sets.k")
    nodes = "".join(f"{i},0.\n" for i in range(1, 2001))
    shells = "".join(f"{i},{6 if i < 9 else 7},1,2,3,4\n" for i in range(1, 800))
    solids = "".join(f"{i},10,1,2,3,4,5,6,7,8\n" for i in range(1, 2001))
    main = f"*DEFINE_BOX\n7,-1,1,-1,1,-1,1\n*NODE\n{nodes}*ELEMENT_SHELL\n{shells}*ELEMENT_SOLID\n{solids}"
    (tmp_path / "main.k").write_text(main + "*INCLUDE\nsets.k\n")
    model = read(tmp_path / "main.k")
    sets = {s.id: model.node_ids[s.nodes].tolist() for s in model.node_sets}
    assert sets[1] == [*range(101, 112)]
    assert sets[3] == [1282, 1283, 1284, 1285]
    assert sets[4] == [301, 302]
    assert sets[5] == [
        n for a, b in ((1, 100), (201, 300), (401, 500), (601, 700), (801, 900)) for n in range(a, b + 1)
    ]
    assert sets[6] == [*range(1, 1000, 2), *range(1000, 2001, 5)]
    assert sets[7] == [*range(1, 2001)]  # its last row is ALL
    assert sets[9] == [21, 22, 23]
    own = {s.id: (s.family, s.elements.tolist()) for s in model.element_sets}
    assert own[11] == ("shell", [*range(501, 511)])
    assert own[16] == ("shell", [*range(10, 201, 10)])
    assert own[18] == ("shell", [*range(11, 19)])  # the set 13
    assert own[24] == ("solid", [*range(1, 1000, 2), *range(1000, 2001, 5)])
    assert own[27] == ("solid", own[23][1])
    assert {s.family for s in model.element_sets} == {"shell", "solid"}
    assert len(own) == 15


def test_reals_that_abut(folder: Path) -> None:
    steel = read(folder / "elementary_transform.k").materials[1]
    assert (steel.density, steel.parameters["failure_strain"]) == (7.8e-9, 1e21)
    isph = read(folder / "isph.k")
    assert isph.materials[6].density == 1e-9
    assert isph.sections[4].parameters == {"h_factor": 1.0, "h_min": 1.0, "h_max": 1.0, "h": 12.0}
    assert [(load.native["rigid_part"], load.kind) for load in isph.nodal_loads] == [(7, "velocity"), (7, "velocity")]


def test_exponents_without_a_letter(folder: Path) -> None:
    model = read(folder / "airfilled_sphere_reduced.k", partial=True)
    assert [m.density for m in model.materials.values()] == [1.13e-4, 7e-4]
    assert model.materials[2].parameters["E"] == 3e7


def test_smoothed_particles_of_a_bird(folder: Path) -> None:
    model = read(folder / "bird.k")
    (sph,) = (b for b in model.blocks if b.family == "sph")
    assert np.all(sph.data["mass"] == 9.9999997e-05)
    assert len(model.node_sets[0].nodes) == 4160
    (flying,) = model.initial_velocities
    assert flying.velocity[0].tolist() == [0.0, 0.0, 100.0]
    rows = model.node_ids[flying.nodes]
    assert flying.velocity[rows == 1].tolist() == [[2.585, -114.4, 0.0]]
    assert model.contacts[0].a == ("node set", 101)
    assert model.contacts[0].b == ("part set", 1)


def test_titles_and_comments_between_cards(folder: Path) -> None:
    assert [c.kind for c in read(folder / "multiline_comment.k").contacts] == [
        "AUTOMATIC_SINGLE_SURFACE", "AUTOMATIC_SURFACE_TO_SURFACE",
    ]  # fmt: skip
    assert read(folder / "multiline_comment.k").contacts[1].static == 0.2
    model = read(folder / "plate_shatter_reduced.k", partial=True)
    assert [p.name for p in model.parts.values()] == ["plate", "plate-tip", "wall"]
    assert [c.a for c in model.contacts] == [("part set", 1)]
