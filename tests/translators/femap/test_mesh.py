"""Nodes and elements: orders of nodes, families, forms that other programs write."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from zrno.translators.elements import TABLE
from zrno.translators.geometry import measures

# places among an element's 20 nodes of points in a unit cell, as FEMAP's manual draws them
_BOTTOM, _TOP = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], [(0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
_BRICK20 = [*_BOTTOM, *_TOP, (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1),
            (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]  # fmt: skip
_APEX = (1, 1, 2)
CELLS: dict[str, tuple[int, int, dict[int, tuple[float, ...]], float]] = {  # topology, type, places, size
    "line2": (0, 1, {0: (0, 0, 0), 1: (2, 0, 0)}, 0),
    "line3": (1, 1, {0: (0, 0, 0), 1: (2, 0, 0), 2: (1, 0, 0)}, 0),
    "tri3": (2, 17, {0: (0, 0, 0), 1: (2, 0, 0), 2: (0, 2, 0)}, 2),
    "tri6": (3, 18, {0: (0, 0, 0), 1: (2, 0, 0), 2: (0, 2, 0), 4: (1, 0, 0), 5: (1, 1, 0), 6: (0, 1, 0)}, 2),
    "quad4": (4, 17, dict(enumerate(_BOTTOM)), 4),
    "quad8": (5, 18, dict(enumerate([*_BOTTOM, (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0)])), 4),
    "tet4": (6, 25, {0: (0, 0, 0), 1: (2, 0, 0), 2: (0, 2, 0), 4: (0, 0, 2)}, 4 / 3),
    "wedge6": (7, 25, {0: (0, 0, 0), 1: (2, 0, 0), 2: (0, 2, 0), 4: (0, 0, 2), 5: (2, 0, 2), 6: (0, 2, 2)}, 4),
    "hex8": (8, 25, dict(enumerate([*_BOTTOM, *_TOP])), 8),
    "tet10": (10, 26, {0: (0, 0, 0), 1: (2, 0, 0), 2: (0, 2, 0), 4: (0, 0, 2), 8: (1, 0, 0), 9: (1, 1, 0),
                       10: (0, 1, 0), 12: (0, 0, 1), 13: (1, 0, 1), 14: (0, 1, 1)}, 4 / 3),
    "wedge15": (11, 26, {0: (0, 0, 0), 1: (2, 0, 0), 2: (0, 2, 0), 4: (0, 0, 2), 5: (2, 0, 2), 6: (0, 2, 2),
                         8: (1, 0, 0), 9: (1, 1, 0), 10: (0, 1, 0), 12: (0, 0, 1), 13: (2, 0, 1), 14: (0, 2, 1),
                         16: (1, 0, 2), 17: (1, 1, 2), 18: (0, 1, 2)}, 4),
    "hex20": (12, 26, dict(enumerate(_BRICK20)), 8),
    "pyramid5": (18, 25, dict(enumerate([*_BOTTOM, _APEX])), 8 / 3),
    "pyramid13": (19, 26, {**dict(enumerate([*_BOTTOM, _APEX])), 8: (1, 0, 0), 9: (2, 1, 0), 10: (1, 2, 0),
                           11: (0, 1, 0), 12: (0.5, 0.5, 1), 13: (1.5, 0.5, 1), 14: (1.5, 1.5, 1),
                           15: (0.5, 1.5, 1)}, 8 / 3),
}  # fmt: skip


def cell(neu, kind: str, packed: bool = False) -> str:
    topology, number, places, _ = CELLS[kind]
    where = range(len(places)) if packed else places
    text = neu.element(7, number, topology, {place: i for i, place in enumerate(where, 1)})
    return neu.nodes([tuple(map(float, p)) for p in places.values()]) + neu.block(404, *text)


def check(model, kind: str) -> None:
    (block,) = model.blocks
    element = TABLE[kind]
    x = model.xyz[block.nodes[0]]
    assert (block.kind, block.ids.tolist()) == (kind, [7])
    if element.mid_edges:
        for i, (a, b) in enumerate(element.shape.edges):
            assert np.array_equal(x[element.shape.corners + i], (x[a] + x[b]) / 2), (a, b)
    if element.dimension > 1:
        assert measures(block, model.xyz) == pytest.approx(CELLS[kind][3])


@pytest.mark.parametrize("kind", CELLS)
def test_orders_of_nodes(neu, load, kind: str) -> None:
    check(load(cell(neu, kind)), kind)


@pytest.mark.parametrize("kind", ["tri6", "tet4", "tet10", "wedge6", "wedge15"])
def test_nodes_without_gaps(neu, load, kind: str) -> None:
    """As EMSolution writes them."""
    check(load(cell(neu, kind, packed=True)), kind)


@pytest.mark.parametrize("kind", ["pyramid5", "pyramid13"])
def test_pyramids(neu, load, kind: str) -> None:
    model = load(cell(neu, kind))
    assert f"elements of topology {CELLS[kind][0]}, read as pyramids" in model.warnings[0]


def test_bricks_that_are_pyramids(neu, load) -> None:
    points = [tuple(map(float, p)) for p in [*_BOTTOM, _APEX]]
    for upper in ([5, 5, 5, 5], [5, 0, 0, 0]):
        model = load(neu.nodes(points) + neu.block(404, *neu.element(7, 25, 8, [1, 2, 3, 4, *upper])))
        check(model, "pyramid5")
        assert "1 bricks whose upper face is one node, read as pyramids" in model.warnings[0]
    model = load(neu.nodes(points) + neu.block(404, *neu.element(7, 25, 14, [1, 2, 3, 4, 5])))
    check(model, "pyramid5")


def test_missing_nodes_between_corners(neu, load) -> None:
    points = [tuple(map(float, p)) for p in _BRICK20]
    model = load(neu.nodes(points) + neu.block(404, *neu.element(7, 26, 12, [*range(1, 20), 0])))
    check(model, "hex8")
    assert "m.neu:31: 1 hex20 elements lack nodes between their corners: read without these" in model.warnings


FAMILIES = {
    (0, 1): ("line2", "truss", ""), (0, 2): ("line2", "beam", ""), (0, 37): ("line2", "beam", ""),
    (0, 6): ("line2", "spring", ""), (9, 27): ("point1", "mass", ""), (4, 13): ("quad4", "plane", "stress"),
    (4, 17): ("quad4", "shell", ""), (4, 19): ("quad4", "plane", "strain"),
    (4, 23): ("quad4", "plane", "axisymmetric"), (8, 25): ("hex8", "solid", ""),
}  # fmt: skip


@pytest.mark.parametrize(("topology", "number"), FAMILIES)
def test_families(neu, load, topology: int, number: int) -> None:
    kind, family, plane = FAMILIES[topology, number]
    count = TABLE[kind].nodes
    body = neu.block(402, f"3,110,2,{number},1,0,", "steel, thick", "0,0,0,0,", "0,", "3,", "0.5,0.25,0.125,")
    text = neu.nodes(neu.CUBE) + neu.block(404, *neu.element(1, number, topology, list(range(1, count + 1)), part=3))
    model = load(body + text)
    assert [(b.kind, b.family, b.part.tolist()) for b in model.blocks] == [(kind, family, [3])]
    section, part = model.sections[3], model.parts[3]
    assert (section.kind, section.plane, part.name, part.material) == (family, plane, "steel, thick", 2)
    assert part.dimension == TABLE[kind].dimension
    expected = {
        "truss": {"area": 0.5, "j": 0.25},
        "beam": {"area": 0.5, "izz": 0.25, "iyy": 0.125},
        "plane": {"thickness": 0.5},
        "shell": {"thickness": 0.5},
    }
    assert section.parameters == expected.get(family, {})
    assert model.warnings == []


def test_elements_that_are_not_read(neu, load) -> None:
    """Rigid elements with their lists of nodes stand between others."""
    rigid = [*neu.element(2, 29, 13, [1], flags="0," * 12 + "1,0,0,0,"), "2,0,1.,1,1,1,0,0,0,", "3,0,1.,1,1,1,0,0,0,",
             "-1,-1,-1.,-1,-1,-1,-1,-1,-1,"]  # fmt: skip
    spider = [*neu.element(3, 29, 15, [], flags="0," * 12 + "1,1,0,0,"), "4,0,1.,1,1,1,0,0,0,", "-1,-1,", "5,0,", "-1,"]
    contact = neu.element(4, 34, 16, [])
    last = neu.element(5, 25, 8, [1, 2, 3, 4, 5, 6, 7, 8])
    model = load(neu.nodes(neu.CUBE) + neu.block(404, *neu.BRICK, *rigid, *spider, *contact, *last))
    assert [(b.kind, b.ids.tolist()) for b in model.blocks] == [("hex8", [1, 5])]
    assert model.warnings == [
        "m.neu:26: 2 rigid elements are not read",
        "m.neu:47: 1 elements with node lists (topology 16) are not read",
        "m.neu: 1 properties of elements are not defined",
    ]


def test_many_rigid_elements(neu, load) -> None:
    """Lists of nodes in great number, among bricks."""
    text = list(neu.BRICK)
    for i in range(2, 1500, 2):
        text += [*neu.element(i, 29, 13, [1], flags="0," * 12 + "1,0,0,0,"), *["2,0,1.,1,1,1,0,0,0,"] * 30, "-1,"]
        text += neu.element(i + 1, 25, 8, [1, 2, 3, 4, 5, 6, 7, 8])
    model = load(neu.nodes(neu.CUBE) + neu.block(404, *text))
    assert model.blocks[0].ids.tolist() == list(range(1, 1500, 2))


def test_beams(neu, load) -> None:
    first = neu.element(1, 2, 0, [1, 2], orient="0.,1.,0.5,")
    second = neu.element(2, 5, 0, [2, 3], node=8)
    second[4], second[6] = "0.,0.,0.25,", "1," + "0," * 15
    model = load(neu.nodes(neu.CUBE) + neu.block(404, *first, *second))
    (block,) = model.blocks
    assert block.data["orientation"].tolist() == [[0.0, 1.0, 0.5], [0.0, 0.0, 0.0]]
    assert block.data["orientation_node"].tolist() == [-1, 7]
    assert model.warnings[:2] == [
        "m.neu:26: 1 offsets of elements are not carried",
        "m.neu:26: 1 releases of beam ends are not carried",
    ]


def test_angles(neu, load) -> None:
    plates = [*neu.element(1, 17, 4, [1, 2, 3, 4], orient="30.,0.,0.,", flag=1), *neu.element(2, 17, 4, [5, 6, 7, 8])]
    assert load(neu.nodes(neu.CUBE) + neu.block(404, *plates)).blocks[0].data["angle"].tolist() == [30.0, 0.0]


@pytest.mark.parametrize("separator", [",", " ", ", ", "\t"])
@pytest.mark.parametrize("ending", ["\n", "\r\n", " \n", "\n\n"])
def test_separators_and_line_ends(neu, load, separator: str, ending: str) -> None:
    body = neu.MESH.replace(",\n", "\n").replace(",", separator).replace("\n", ending)
    model = load("$COM a remark" + ending + body)
    assert model.xyz.tolist() == [list(map(float, p)) for p in neu.CUBE]
    assert measures(model.blocks[0], model.xyz) == pytest.approx(1.0)


def test_blocks_in_another_order_and_twice(neu, load) -> None:
    first, second = neu.nodes(neu.CUBE[:4]), neu.nodes([(0, 0, 0)] * 4 + neu.CUBE[4:])
    second = "\n".join(line for line in second.split("\n") if line[:2] not in ("1,", "2,", "3,", "4,"))
    model = load(neu.block(404, *neu.BRICK) + second + neu.block(999, "what", "-1,", "ever") + first)
    assert measures(model.blocks[0], model.xyz) == pytest.approx(1.0)
    assert model.node_ids.tolist() == [5, 6, 7, 8, 1, 2, 3, 4]
    assert "m.neu:24: 1 block(s) 999 are not read (not known here)" in model.warnings


def test_byte_order_mark_and_latin_titles(neu, tmp_path) -> None:
    from zrno.translators.femap import read

    text = neu.head().replace("<NULL>", "Träger") + neu.MESH
    (tmp_path / "a.neu").write_bytes(text.encode("latin-1"))
    (tmp_path / "b.neu").write_bytes(text.encode("utf-8-sig"))
    assert read(tmp_path / "a.neu").title == read(tmp_path / "b.neu").title == "Träger"


def test_numbers_are_exact(neu, load) -> None:
    """Coordinates are the nearest doubles, in small and in large files."""
    numbers = np.random.default_rng(1).integers(0, 2**62, 3000).view(np.float64)
    numbers = numbers[np.isfinite(numbers)]
    points = [(float(a), -float(a), float(a) / 3) for a in numbers]
    few = load(neu.nodes(points[:50]))
    many = load(neu.nodes(points * 4 if len(points) > 3000 else points * 3))
    assert few.xyz.tolist() == [list(p) for p in points[:50]]
    assert np.array_equal(many.xyz, np.array(points * (4 if len(points) > 3000 else 3)))


def test_version_numbers(neu, load) -> None:
    """10.3 is later than 9.31: its properties have counts of outline points."""
    first = ["1,110,1,25,1,0,", "a", "0,0,0,0,", "0,", "0,", "2,", "0.,0.,1,", "0.,1.,1,", "1,", "0.,0.,1,"]
    second = ["2,110,1,25,1,0,", "b", "0,0,0,0,", "10,", "1,1,1,1,1,1,1,1,", "2,2,", "0,", "0,", "0,"]
    body = neu.block(402, *first, *second)
    model = load(neu.MESH + body, "10.3")
    assert {n: part.name for n, part in model.parts.items()} == {1: "a", 2: "b"}
    assert model.sections[2].native["laminate"] == [1] * 8 + [2] * 2


def test_every_kind_in_one_file(neu, load) -> None:
    points, lines, number = [], [], 0
    for topology, kind, places, _ in CELLS.values():
        number += 1
        first = len(points)
        lines += neu.element(number, kind, topology, {place: first + i for i, place in enumerate(places, 1)})
        points += [tuple(map(float, p)) for p in places.values()]
    model = load(neu.nodes(points) + neu.block(404, *lines))
    assert model.element_counts() == dict.fromkeys(CELLS, 1)
    assert list(itertools.chain(*(block.ids.tolist() for block in model.blocks))) == list(range(1, number + 1))
