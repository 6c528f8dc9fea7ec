"""Elements: their layouts, shapes and orders; what is wrong with them and where."""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations

import numpy as np
import pytest

from zrno.translators.elements import TABLE
from zrno.translators.geometry import measures
from zrno.translators.lsdyna.shapes import eight_nodes, split_solids
from zrno.translators.model import ElementBlock, Floats, Ints, Model
from zrno.translators.text import InputError

Read = Callable[..., Model]

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)


def signed_volume(kind: str, nodes: Ints, xyz: Floats) -> float:
    """Volume by the divergence theorem over the faces, positive where these look outward."""
    total = 0.0
    for face in TABLE[kind].shape.faces:
        around = xyz[nodes[list(face)]]
        middle = around.mean(axis=0)
        for a, b in zip(around, np.roll(around, -1, axis=0), strict=True):
            total += float(np.dot(middle, np.cross(a, b))) / 6.0
    return total


def nodes_text(xyz: Floats) -> str:
    return "*NODE\n" + "".join(f"{i:8d}{x:16.8f}{y:16.8f}{z:16.8f}\n" for i, (x, y, z) in enumerate(xyz, 1))


DEGENERATE = [
    ("tet4", [1, 2, 4, 5, 5, 5, 5, 5], 1 / 6),  # n4 .. n8 the same
    ("tet4", [1, 2, 4, 5, 0, 0, 0, 0], 1 / 6),
    ("tet4", [1, 2, 4, 4, 5, 5, 5, 5], 1 / 6),  # as a collapsed hexahedron
    ("pyramid5", [1, 2, 3, 4, 5, 5, 5, 5], 1 / 3),
    ("wedge6", [1, 2, 3, 4, 5, 5, 8, 8], 1 / 2),  # n5 = n6, n7 = n8
    ("wedge6", [1, 2, 4, 4, 5, 6, 8, 8], 1 / 2),  # n3 = n4, n7 = n8
    ("hex8", [1, 2, 3, 4, 5, 6, 7, 8], 1.0),
]


@pytest.mark.parametrize(("kind", "row", "volume"), DEGENERATE)
def test_degenerate_solids_are_what_they_are(deck: Read, kind: str, row: list[int], volume: float) -> None:
    text = nodes_text(CORNERS) + "*ELEMENT_SOLID\n" + "".join(f"{i:8d}" for i in (3, 1, *row)) + "\n"
    (block,) = deck(text).blocks
    assert (block.kind, block.ids.tolist(), block.family) == (kind, [3], "solid")
    assert signed_volume(kind, block.nodes[0], CORNERS) == pytest.approx(volume)


def test_every_edge_that_collapses_leaves_a_wedge_or_a_pyramid_turned_right() -> None:
    """Six corners and a positive volume of all pairs of opposite edges of a face."""
    count = 0
    for first, second in permutations(TABLE["hex8"].shape.edges, 2):
        if set(first) & set(second):
            continue
        row = np.arange(1, 9)
        row[first[1]], row[second[1]] = row[first[0]], row[second[0]]
        for kind, _, nodes in split_solids(row[None]):
            if kind != "wedge6":
                continue
            count += 1
            shape = CORNERS.copy()
            shape[[first[1], second[1]]] = shape[[first[0], second[0]]]
            assert signed_volume(kind, nodes[0] - 1, shape) == pytest.approx(0.5)
    assert count == 24  # two pairs of opposite edges of each face, in either order


@pytest.mark.parametrize("kind", ["hex8", "tet4", "pyramid5", "wedge6"])
@pytest.mark.parametrize("thick", [False, True])
def test_eight_places_and_back(kind: str, thick: bool) -> None:
    nodes = np.arange(11, 11 + TABLE[kind].nodes)
    ((found, _, back),) = split_solids(nodes[list(eight_nodes(kind, thick=thick))][None])
    assert found == kind
    assert back[0].tolist() == nodes.tolist()


def test_many_solids_are_split_as_few_are(deck: Read) -> None:
    rows = [row for _, row, _ in DEGENERATE if 0 not in row]
    many = 60_000
    nodes = np.array(rows)[np.arange(many) % len(rows)]
    found = {kind: (which, part) for kind, which, part in split_solids(nodes)}
    few = {kind: (which, part) for kind, which, part in split_solids(nodes[: len(rows)])}
    assert found.keys() == few.keys()
    for kind, (which, part) in few.items():
        assert which is not None
        assert found[kind][0][: len(which)].tolist() == which.tolist()  # type: ignore[index]
        assert found[kind][1][: len(which)].tolist() == part.tolist()
    assert sum(len(which) for which, _ in found.values()) == many  # type: ignore[arg-type,misc]


def test_solids_of_one_line_two_lines_and_ten_nodes(deck: Read) -> None:
    xyz = np.concatenate([CORNERS, CORNERS[[0, 1, 3, 4]] * 2, np.zeros((6, 3))])
    xyz[12:] = [(xyz[8 + a] + xyz[8 + b]) / 2 for a, b in TABLE["tet10"].shape.edges]
    text = nodes_text(xyz) + (
        "*ELEMENT_SOLID (ten nodes format)\n       1       1\n$ nodes\n"
        "       1       2       3       4       5       6       7       8       0       0\n"
        "       2       1       1       2       3       4       5       6       7       8\n"
        "       3       1                        \n"
        "       9      10      11      12      13      14      15      16      17      18\n"
    )
    model = deck(text)
    assert {b.kind: b.ids.tolist() for b in model.blocks} == {"hex8": [1, 2], "tet10": [3]}
    ten = next(b for b in model.blocks if b.kind == "tet10")
    assert measures(ten, model.xyz).tolist() == pytest.approx([8 / 6])


def edge_middles(order: list[int]) -> Floats:
    """A cube of twenty nodes: corners, and the middles of VTK's edges in some order."""
    middles = np.array([CORNERS[list(edge)].mean(axis=0) for edge in TABLE["hex20"].shape.edges])
    return np.concatenate([CORNERS, middles[order]])


@pytest.mark.parametrize("vtk", [False, True])
def test_solids_of_twenty_nodes_have_their_middles_where_they_belong(deck: Read, vtk: bool) -> None:
    """LS-DYNA: bottom, vertical, top edges. A deck in VTK's order is told by the places of its nodes."""
    order = list(range(12)) if vtk else [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7]
    rows = "".join(f"{i:8d}" for i in range(1, 11)) + "\n" + "".join(f"{i:8d}" for i in range(11, 21)) + "\n"
    model = deck(nodes_text(edge_middles(order)) + "*ELEMENT_SOLID_H20\n       1       1\n" + rows)
    (block,) = model.blocks
    assert block.kind == "hex20"
    assert measures(block, model.xyz).tolist() == pytest.approx([1.0])
    for i, edge in enumerate(TABLE["hex20"].shape.edges):
        assert np.allclose(model.xyz[block.nodes[0, 8 + i]], CORNERS[list(edge)].mean(axis=0))
    assert any("not in LS-DYNA's order" in w for w in model.warnings) == vtk


def test_options_of_solids(deck: Read) -> None:
    one = "       1       1       1       2       3       4       5       6       7       8\n"
    model = deck(nodes_text(CORNERS) + "*ELEMENT_SOLID_ORTHO\n" + one + f"{1.0:16.1f}{0.0:16.1f}{0.0:16.1f}\n"
                 f"{0.0:16.1f}{1.0:16.1f}\n")  # fmt: skip
    assert model.blocks[0].data["axis_a"].tolist() == [[1.0, 0.0, 0.0]]
    assert model.blocks[0].data["axis_d"].tolist() == [[0.0, 1.0, 0.0]]
    assert deck(nodes_text(CORNERS) + "*ELEMENT_SOLID_DOF\n" + one + "\n").element_counts() == {"hex8": 1}


def test_shells(deck: Read) -> None:
    flat = np.concatenate([CORNERS[:4], [[0.5, 0, 0], [1, 0.5, 0], [0.5, 1, 0], [0, 0.5, 0], [0.5, 0.5, 0]]])
    model = deck(
        nodes_text(flat) + "*ELEMENT_SHELL\n1,1,1,2,3,4\n2,1,1,2,3,3\n3,1,1,2,4\n4,1,1,2,3,4,5,6,7,8\n"
        "5,1,1,2,3,3,5,6,9,9\n*ELEMENT_SHELL_THICKNESS\n6,1,1,2,3,4\n.1,.2,.3,.4,30.\n7,1,1,2,3,4,5,6,7,8\n.5,.5,.5,.5\n"
        ".5,.5,.5,.5\n*ELEMENT_SHELL_BETA_OFFSET\n8,1,1,2,3,4\n,,,,15.\n.25\n*ELEMENT_SHELL_OFFSET\n9,1,1,2,3,3\n\n"
    )
    blocks = {int(i): b for b in model.blocks for i in b.ids}
    assert [blocks[i].kind for i in range(1, 10)] == [
        "quad4", "tri3", "tri3", "quad8", "tri6", "quad4", "quad8", "quad4", "tri3",
    ]  # fmt: skip
    assert measures(blocks[5], model.xyz).tolist() == pytest.approx([0.5])
    assert blocks[6].data["thickness"].tolist() == [[0.1, 0.2, 0.3, 0.4]]
    assert blocks[6].data["angle"].tolist() == [30.0]
    assert blocks[8].data["angle"].tolist() == [15.0]
    assert blocks[8].data["offset"].tolist() == [0.25]
    assert {b.family for b in model.blocks} == {"shell"}


def test_thick_shells_beams_springs_masses(deck: Read) -> None:
    model = deck(
        nodes_text(CORNERS) + "*ELEMENT_TSHELL\n1,1,1,2,3,4,5,6,7,8\n2,1,1,2,3,3,5,6,7,7\n"
        "*ELEMENT_BEAM\n1,2,1,2,3\n2,2,2,3\n*ELEMENT_BEAM_ORIENTATION\n3,2,1,5\n1.,0.,0.\n"
        "*ELEMENT_BEAM_THICKNESS_OFFSET\n4,2,1,5,,1,2,0,4,1\n.5,.5,1.,1.,0.\n0.,0.,.1,0.,0.,.2\n"
        "*ELEMENT_DISCRETE\n1,3,1,2,0,2.5\n2,3,4,0\n*ELEMENT_MASS\n1,8,0.25\n2,7,.5,2\n"
    )
    found = {(b.family, b.kind, tuple(sorted(b.data))): b for b in model.blocks}
    assert found["tshell", "hex8", ()].ids.tolist() == [1]
    assert signed_volume("wedge6", found["tshell", "wedge6", ()].nodes[0], CORNERS) == pytest.approx(0.5)
    assert found["beam", "line2", ("orientation_node",)].data["orientation_node"].tolist() == [2, -1]
    assert found["beam", "line2", ("orientation",)].data["orientation"].tolist() == [[1.0, 0.0, 0.0]]
    (special,) = (b for b in model.blocks if "releases" in b.data)
    assert special.data["releases"].tolist() == [[1, 2, 0, 4, 1]]
    assert special.data["section_values"].tolist() == [[0.5, 0.5, 1.0, 1.0, 0.0]]
    assert special.data["offsets"].tolist() == [[0, 0, 0.1, 0, 0, 0.2]]
    assert found["spring", "line2", ("scale",)].data["scale"].tolist() == [2.5]
    assert found["spring", "point1", ("scale",)].nodes.tolist() == [[3]]
    mass = found["mass", "point1", ("mass",)]
    assert (mass.nodes.ravel().tolist(), mass.data["mass"].tolist(), mass.part.tolist()) == (
        [7, 6],
        [0.25, 0.5],
        [0, 2],
    )


def test_particles(deck: Read) -> None:
    model = deck(
        nodes_text(CORNERS) + "*ELEMENT_SPH\n       1       1            0.25\n       2       1            -2.0\n"
        "       3       1             0.5       6\n*ELEMENT_SPH_VOLUME\n7,1,1.5\n"
        "*ELEMENT_DISCRETE_SPHERE\n       8       2             1.0             0.5            0.25\n"
    )
    sph = [b for b in model.blocks if b.family == "sph"]
    mass = {int(i): m for b in sph if "mass" in b.data for i, m in zip(b.ids, b.data["mass"], strict=True)}
    volume = {int(i): v for b in sph if "volume" in b.data for i, v in zip(b.ids, b.data["volume"], strict=True)}
    assert mass == {1: 0.25, 2: 0.0, 3: 0.5, 4: 0.5, 5: 0.5, 6: 0.5}
    assert volume == {1: 0.0, 2: 2.0, 3: 0.0, 4: 0.0, 5: 0.0, 6: 0.0, 7: 1.5}
    (sphere,) = (b for b in model.blocks if b.family == "sphere")
    assert {k: v.tolist() for k, v in sphere.data.items()} == {"mass": [1.0], "inertia": [0.5], "radius": [0.25]}
    assert (model.element_counts(), model.particle_count()) == ({}, 8)


def test_spheres_in_fields_of_ten(deck: Read) -> None:
    row = "".join(f"{v:>10}" for v in (8, 2, 1.0, 0.5, 0.25)) + "\n"
    (block,) = deck(nodes_text(CORNERS) + "*ELEMENT_DISCRETE_SPHERE\n" + row).blocks
    assert (block.ids.tolist(), block.part.tolist(), block.data["radius"].tolist()) == ([8], [2], [0.25])


def test_plane_sections_make_a_plane_problem(deck: Read) -> None:
    text = nodes_text(CORNERS[:4]) + "*ELEMENT_SHELL\n1,1,1,2,3,4\n*PART\nplate\n1,1,1\n*SECTION_SHELL\n1,13\n0.5\n"
    model = deck(text)
    assert (model.dimension, model.blocks[0].family, model.sections[1].plane) == (2, "plane", "strain")
    assert deck(text.replace("1,13", "1,16")).dimension == 3


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("*ELEMENT_SHELL\n1,1,1,2,3,9\n", ":11:11:", "element 1 has a node that is not there (9)"),
        ("*ELEMENT_SHELL\n1,1,1,2,3,4\n1,1,1,2,3,4\n", ":12:1:", "a shell element's number stands twice (1)"),
        ("*ELEMENT_SHELL\n1,1,1,2\n", ":11:1:", "an element has no number for one of its nodes (element 1)"),
        ("*ELEMENT_SOLID\n       1       1\n       2       1\n", ":11:1:", "an element without nodes (1       1)"),
        ("*ELEMENT_SOLID\n       1       1\n", ":11:1:", "an element without nodes"),
        ("*ELEMENT_SOLID_H20\n       1       1\n       1\n", ":12:1:", "the keyword ends inside an element"),
        ("*ELEMENT_BEAM_ORIENTATION\n1,1,1,2\n", ":11:1:", "the keyword ends inside an element"),
        ("*ELEMENT_SPH\n1,1,1.,8\n2,1,1.,8\n", ":10:1:", "ranges of nodes overlap"),
        ("*ELEMENT_SPH\n9,1,1.\n", ":11:1:", "element 9 has a node that is not there (9)"),
    ],
)
def test_faults_have_their_place(deck: Read, cube: str, text: str, place: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        deck(cube + text)
    assert f"deck.k{place} error: {message}" in str(caught.value)


def test_a_shell_and_a_solid_may_have_the_same_number(deck: Read, cube: str) -> None:
    model = deck(cube + "*ELEMENT_SHELL\n1,1,1,2,3,4\n*ELEMENT_SOLID\n1,1,1,2,3,4,5,6,7,8\n")
    assert model.element_counts() == {"quad4": 1, "hex8": 1}


def test_a_piece_of_a_deck_is_known_as_one(deck: Read) -> None:
    model = deck("*ELEMENT_SOLID\n1,1,1,2,3,4,5,6,7,8\n*ELEMENT_SHELL\n1,1,1,2,3,4\n")
    assert model.element_counts() == {"hex8": 1, "quad4": 1}
    assert all((block.nodes == -1).all() for block in model.blocks)
    assert model.incomplete == ["2 elements point at nodes that are not in the file"]


def test_a_deck_that_is_looked_at_may_lack_nodes(deck: Read, cube: str) -> None:
    model = deck(cube + "*ELEMENT_SHELL\n1,1,1,2,3,9\n2,1,1,2,3,4\n", partial=True)
    assert model.blocks[0].nodes.tolist() == [[0, 1, 2, -1], [0, 1, 2, 3]]
    assert model.incomplete == ["1 element points at nodes that are not in the file"]


def test_many_nodes_of_scattered_numbers(deck: Read) -> None:
    model = deck("*NODE\n99999999,0\n5,1\n7000000,2\n*ELEMENT_SHELL\n1,1,5,7000000,99999999,99999999\n")
    assert model.blocks[0].nodes.tolist() == [[1, 2, 0]]


def test_jitted_places_are_as_plain_ones() -> None:
    from zrno.translators.lsdyna.kernels import to_places

    table = np.array([-1, 0, 1, 2, -1], np.int32)
    nodes = np.array([[1, 2, 3], [3, 9, 0], [1, 1, -4]])
    assert to_places(nodes, table) == 2
    assert nodes.tolist() == [[0, 1, 2], [2, -10, -1], [0, 0, -1]]


def test_blocks_of_several_keywords_are_joined(deck: Read, cube: str) -> None:
    text = "".join(f"*ELEMENT_SHELL\n{i},{i},1,2,3,4\n" for i in range(1, 6))
    (block,) = deck(cube + text).blocks
    assert isinstance(block, ElementBlock)
    assert (block.ids.tolist(), block.part.tolist()) == ([1, 2, 3, 4, 5], [1, 2, 3, 4, 5])
