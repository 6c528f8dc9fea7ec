from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.elements import TABLE
from zrno.translators.geometry import measures
from zrno.translators.model import Model
from zrno.translators.pak import read, write
from zrno.translators.pak.elements import COLLAPSED, uncollapsed
from zrno.translators.text import InputError

Faults = Callable[..., list[str]]
Deck = Callable[..., str]
Mesh = Callable[..., Model]

HEX = """\
two cubes
    2    0
   12    1    1    1
 0 0 0 1 1 1       0    0    {free}
    0   -1   -1
    0              0    0
    1    2       1.0
    1   15    1    0    0     0.001
{nodes}    1    1    3
    1    1       7.8
     200.0
       0.3
    3    2    0    1
    2    2    2    0       0.0    0    0                            -1
{elements}    1    2
    1    2
       0.0       1.0
      99.0       1.0
{loads}STOP
"""
NODES = "".join(
    f"{n:5} {' 0' * 6}  {x:10.1f}{y:10.1f}{z:10.1f}    0    0\n"
    for n, (x, y, z) in enumerate([(x, y, z) for z in (0, 1, 2) for y in (0, 1) for x in (0, 1)], 1)
)
ELEMENTS = """\
    1    1    0    0    0    0
    5    6    8    7    1    2    4    3

    2    0    0    0    0    0
    9   10   12   11    5    6    8    7

"""
LOADS = "    0    0    0    0         0    0    0    0    0\n"


@pytest.fixture
def deck(tmp_path: Path) -> Callable[..., Path]:
    """deck((old, new), ..., nodes=..., elements=..., loads=..., free=0): a small deck's file."""

    def make(*replace: tuple[str, str], nodes: str = NODES, elements: str = ELEMENTS, loads: str = LOADS,
             free: int = 0) -> Path:  # fmt: skip
        text = HEX.format(nodes=nodes, elements=elements, loads=loads, free=free)
        for old, new in replace:
            assert text.count(old) >= 1, old
            text = text.replace(old, new, 1)
        (tmp_path / "a.dat").write_text(text)
        return tmp_path / "a.dat"

    return make


def test_a_deck(deck) -> None:
    m = read(deck())
    assert (m.title, m.format, m.dimension, m.element_counts()) == ("two cubes", "pak", 3, {"hex8": 2})
    assert (m.analysis.kind, m.analysis.end_time, m.fem_control.periods) == ("static", 2.0, [(2, 1.0)])
    assert m.fem_control.suppressed == (0, 0, 0, 1, 1, 1)
    block = m.blocks[0]
    assert block.nodes[0].tolist() == [0, 1, 3, 2, 4, 5, 7, 6]
    assert measures(block, m.xyz) == pytest.approx([1.0, 1.0])
    assert (m.parts[1].material, m.parts[1].section, m.sections[1].kind) == (1, 1, "solid")
    assert (m.materials[1].parameters, m.materials[1].density) == ({"E": 200.0, "nu": 0.3}, 7.8)
    assert not m.fixed.any()
    assert m.warnings == []


def test_headings_are_comments_wherever_they_stand(deck, same) -> None:
    plain = read(deck())
    path = deck()
    lines = path.read_text().splitlines()
    noisy = "C /1/ heading\n" + "".join(f"{line}\nC-----\nc more\nC* and more\nC\n" for line in lines)
    path.write_text(noisy.replace("\n", "\r\n"))
    assert same(read(path), plain)


@pytest.mark.parametrize("free", [0, 1])
def test_generated_nodes(deck, same, free: int) -> None:
    plain = read(deck(free=free))
    lines = NODES.splitlines(keepends=True)
    first, last = lines[0][:50] + "    4    0\n", lines[8]
    columns = lines[1][:50] + "    4    0\n", lines[9]
    rest = [lines[n] for n in (2, 3, 6, 7, 10, 11)]
    generated = read(deck(nodes=first + last + "".join(columns) + "".join(rest), free=free))
    assert "2 nodes are generated" in generated.warnings[0]
    order = np.argsort(generated.node_ids)
    assert np.array_equal(generated.node_ids[order], plain.node_ids)
    assert np.array_equal(generated.xyz[order], plain.xyz)


def test_a_chain_of_generated_nodes(deck) -> None:
    nodes = "".join(
        f"{n:5} {' 0' * 6}  {x:10.1f}{0.0:10.1f}{0.0:10.1f}{k:5}    0\n"
        for n, x, k in ((1, 0, 2), (5, 8, 1), (8, 2, 0))
    ) + "".join(f"{n:5} {' 0' * 6}  {n:10.1f}{1.0:10.1f}{0.0:10.1f}\n" for n in (2, 4, 9, 10, 11, 12))
    m = read(deck(nodes=nodes, elements=ELEMENTS, free=1))
    at = dict(zip(m.node_ids.tolist(), m.xyz[:, 0].tolist(), strict=True))
    assert [at[n] for n in (1, 3, 5, 6, 7, 8)] == [0.0, 4.0, 8.0, 6.0, 4.0, 2.0]


def test_generated_elements_and_loads(deck, same, tmp_path: Path) -> None:
    nodes = "".join(f"{n:5} {' 0' * 6}  {n % 2:10.1f}{n % 4 // 2:10.1f}{n // 4:10.1f}\n" for n in range(0)) or "".join(
        f"{4 * k + c + 1:5} {' 0' * 6}  {c % 2:10.1f}{c // 2:10.1f}{k:10.1f}\n" for k in range(6) for c in range(4)
    )
    cards = [f"{k + 1:5}    1    0    0    0{4 if k == 0 else 0:5}\n" + "".join(f"{4 * k + n:5}" for n in
             (5, 6, 8, 7, 1, 2, 4, 3)) + "\n\n" for k in (0, 4)]  # fmt: skip
    loads = (
        "    3    0    2    0         0    0    2    0    0\n"
        "    1    3    1       2.5    4       0.0\n    9    3    1       2.5    0       0.0\n"
        "    1    0       1.0       1.0       1.0       1.0   20\n    1    2    4    3\n"
        "    1    0       1.0       1.0       1.0       1.0    0\n   21   22   24   23\n"
        "    4    1    1       1.0    4\n    8    1    1       1.0    0\n"
    )
    counts = (("   12    1    1    1", "   24    1    1    1"), ("    3    2    0    1", "    3    5    0    1"))
    m = read(deck(*counts, nodes=nodes, elements="".join(cards), loads=loads))
    assert m.blocks[0].ids.tolist() == [1, 2, 3, 4, 5]
    assert measures(m.blocks[0], m.xyz) == pytest.approx([1.0] * 5)
    force, displacement = m.nodal_loads
    assert (force.nodes.tolist(), force.values.tolist()) == ([0, 4, 8], [2.5] * 3)
    assert displacement.nodes.tolist() == [3, 7]
    assert m.face_loads[0].faces.tolist() == [[0, 1, 3, 2], [20, 21, 23, 22]]
    write(m, tmp_path / "b.dat")
    assert same(read(tmp_path / "b.dat"), m)


def test_polar_coordinates(deck) -> None:
    line = NODES.splitlines(keepends=True)[3]
    polar = f"    4p{line[6:20]}{1.0:10.1f}{90.0:10.1f}{0.5:10.1f}    0    0\n"
    m = read(deck(nodes=NODES.replace(line, polar)))
    assert m.xyz[3] == pytest.approx([0.0, 1.0, 0.5])
    assert "1 nodes in polar coordinates" in m.warnings[0]


def test_zero_repeats_the_last_element_s_options(deck) -> None:
    elements = ELEMENTS.replace("    1    1    0    0    0    0", "    1    1    1    2    1    0").replace(
        "    2    0    0    0    0    0", "    2    0    0   -1    0    0"
    )
    m = read(deck(elements=elements))
    assert (m.sections[1].native["IPRCO"], m.sections[1].native["IPGS"]) == (1, 1)
    assert m.blocks[0].data["ISNA"].tolist() == [2, 0]


@pytest.mark.parametrize("kind", COLLAPSED)
def test_collapsed_hexahedra_of_any_pattern(kind: str) -> None:
    pattern = np.array(COLLAPSED[kind])
    quarter = np.array([1, 2, 3, 0, 5, 6, 7, 4])  # turns about two axes make all patterns
    tip = np.array([4, 5, 1, 0, 7, 6, 2, 3])
    seen = {tuple(pattern.tolist())}
    while True:
        more = seen | {tuple(np.array(p)[t].tolist()) for p in seen for t in (quarter, tip)}
        if more == seen:
            break
        seen = more
    found, left = uncollapsed(np.array(sorted(seen)))
    assert not len(left)
    assert list(found) == [kind]
    rows, nodes = found[kind]
    assert len(rows) == len(seen) >= 6
    assert (np.sort(nodes, axis=1) == np.arange(TABLE[kind].nodes)).all()


def test_collapsed_hexahedra_become_what_they_are(deck, tmp_path: Path) -> None:
    wedge = "    5    6    7    7    1    2    3    3"
    m = read(deck(("    5    6    8    7    1    2    4    3", wedge)))
    assert m.element_counts() == {"hex8": 1, "wedge6": 1}
    assert sorted(float(v) for b in m.blocks for v in measures(b, m.xyz)) == pytest.approx([0.5, 1.0])
    write(m, tmp_path / "b.dat")
    assert read(tmp_path / "b.dat").element_counts() == m.element_counts()
    assert "    5    6    7    7    1    2    3    3\n" in (tmp_path / "b.dat").read_text()


def test_hexahedra_that_are_inside_out_are_turned(deck) -> None:
    m = read(deck(("    5    6    8    7    1    2    4    3", "    1    2    4    3    5    6    8    7")))
    assert m.blocks[0].nodes[0].tolist() == [0, 1, 3, 2, 4, 5, 7, 6]
    assert "1 hex8 of group 1 are inside out" in m.warnings[0]


def test_some_mid_side_nodes_are_kept(deck, tmp_path: Path) -> None:
    elements = ELEMENTS.replace("\n\n", f"\n{'':50}   11\n", 1)
    m = read(deck(elements=elements))
    assert "1 hexahedra have some mid-side nodes alone" in m.warnings[0]
    odd = next(block for block in m.blocks if "nodes_9_21" in block.data)
    assert odd.data["nodes_9_21"][0, 10] == 10
    write(m, tmp_path / "b.dat")
    assert f"{'':50}   11" in [line.rstrip() for line in (tmp_path / "b.dat").read_text().splitlines()]


@pytest.mark.parametrize("kind", ["wedge15", "pyramid13", "tet10"])
def test_mid_side_nodes_of_unsure_order_are_put_by_geometry(deck, tmp_path: Path, mesh: Mesh, kind: str) -> None:
    source = mesh(kind)
    netip = {"wedge15": 31, "pyramid13": 32, "tet10": 33}[kind]
    corners = TABLE[kind].shape.corners
    upper = {"wedge15": [3, 4, 5, 0, 1, 2]}.get(kind, list(range(corners)))
    middles = np.random.default_rng(3).permutation(np.arange(corners, TABLE[kind].nodes)).tolist()
    nodes = "".join(f"{n:5} {' 0' * 6}  {x:10.3f}{y:10.3f}{z:10.3f}\n" for n, (x, y, z) in enumerate(source.xyz, 1))
    element = "    1    1\n" + "".join(f"{n + 1:5}" for n in upper) + "\n" + "".join(f"{n + 1:5}" for n in middles)
    m = read(deck(("   12    1", f"{len(source.xyz):5}    1"), ("    3    2    0    1", f"{netip:5}    1    0    1"),
                  nodes=nodes, elements=element + "\n"))  # fmt: skip
    assert m.blocks[0].kind == kind
    assert m.blocks[0].nodes[0].tolist() == list(range(TABLE[kind].nodes))


def test_coordinates_near_the_largest_double(deck) -> None:
    first = NODES.splitlines(keepends=True)[0]
    m = read(deck((first, f"{first[:20]}  -1.7E308  -1.7E308  -1.7E308{first[50:]}")))
    assert m.xyz[0].tolist() == [-1.7e308] * 3
    read(deck((first, f"{first[:20]}  -1.7E308   1.7E308  -1.7E308    1\n")
              , (NODES.splitlines(keepends=True)[2], ""), (NODES.splitlines(keepends=True)[1], "")))  # fmt: skip


def test_cards_out_of_step_are_faults(deck) -> None:
    """Nodes where the next element's card should be look like generation."""
    element = ELEMENTS[: ELEMENTS.index("    2    0")]
    with pytest.raises(InputError, match=r"a\.dat:\d+:\d+: error: "):
        read(deck(("    3    2    0    1", "    3   80    0    1"), elements=element + "\n" + element * 90))


def test_models_kept_as_they_are(deck, tmp_path: Path) -> None:
    old = "    1    1    3\n    1    1       7.8\n     200.0\n       0.3\n    3    2    0    1"
    cards = {
        3: "    1\n       0.0     200.0\n    2\n       0.0       0.3\n      10.0       0.2\n    1\n"
        "       0.0      1E-5\n"
        "      20.0\n",
        8: "       1.0       2.0\n       3.0\n",
        9: "       1.0       0.3       0.0    0    1\n       1.0       0.2       0.1       5.0       1.0    0\n    1\n"
           "       1.0       2.0\n",
        20: "    1\n     200.0       0.3\n       1.0       2.0\n       1.0       1.0\n       5.0\n",
    }  # fmt: skip
    for number, own in cards.items():
        new = f"{number:5}    1    3\n{number:5}    1       7.8\n{own}    3    2    1{number:5}"
        m = read(deck((old, new)))
        assert (m.materials[1].law, m.materials[1].native["cards"]) == ("", own.splitlines())
        write(m, tmp_path / "b.dat")
        assert own in (tmp_path / "b.dat").read_text()


def test_expansion_by_temperature(deck, tmp_path: Path) -> None:
    """Tables of constants are the law thermo_elastic; its own cards are written back, or new ones where it changed."""
    old = "    1    1    3\n    1    1       7.8\n     200.0\n       0.3\n    3    2    0    1"
    own = (
        "    1\n       0.0     200.0\n    2\n       0.0       0.3\n      10.0       0.3\n    1\n       0.0      1E-5\n"
        "      20.0\n"
    )
    loads = "    0    0    0    0         0    2    0    0    0\n    1    1      50.0    0\n    2    1      60.0    0\n"
    m = read(deck((old, f"    3    1    3\n    3    1       7.8\n{own}    3    2    1    3"), loads=loads))
    wanted = {"E": 200.0, "nu": 0.3, "expansion": 1e-5, "reference_temperature": 20.0}
    assert (m.materials[1].law, m.materials[1].parameters) == ("thermo_elastic", wanted)
    warm = m.nodal_loads[0]
    assert (warm.kind, warm.nodes.tolist(), warm.values.tolist()) == ("temperature", [0, 1], [50.0, 60.0])
    write(m, tmp_path / "b.dat")
    assert own in (tmp_path / "b.dat").read_text()
    m.materials[1].parameters["expansion"] = 2e-5
    write(m, tmp_path / "c.dat")
    again = read(tmp_path / "c.dat")
    assert (again.materials[1].law, again.materials[1].parameters) == ("thermo_elastic", wanted | {"expansion": 2e-5})
    assert again.nodal_loads[0].values.tolist() == [50.0, 60.0]


@pytest.mark.parametrize("count", ["-1", "0", "99999"])
def test_tables_of_temperature_with_hostile_counts(deck, count: str) -> None:
    old = "    1    1    3\n    1    1       7.8\n     200.0\n       0.3\n    3    2    0    1"
    own = f"{count:>5}\n       0.0     200.0\n    1\n       0.0       0.3\n    1\n       0.0      1E-5\n      20.0\n"
    with pytest.raises(InputError, match="number of points"):
        read(deck((old, f"    3    1    3\n    3    1       7.8\n{own}    3    2    1    3")))


def test_a_table_of_stress_and_strain(deck, tmp_path: Path, same) -> None:
    old = "    1    1    3\n    1    1       7.8\n     200.0\n       0.3\n    3    2    0    1"
    points = "     0.005       1.0\n      0.02       1.5\n      0.03       1.6\n"
    new = f"    5    1    3\n    5    1       7.8\n    2    1\n     200.0       0.3\n{points}    3    2    1    5"
    m = read(deck((old, new)))
    assert m.materials[1].tables["hardening"] == pytest.approx(np.array([(0, 1.0), (0.0125, 1.5), (0.022, 1.6)]))
    assert "as if it were elastic" in m.warnings[0]
    write(m, tmp_path / "b.dat")
    assert same(read(tmp_path / "b.dat"), m)


def test_a_point_that_is_missing_scales(deck) -> None:
    loads = "    0    0    1    0         0    0    1    0    0\n    1    0       100       100       100       100\n" \
            "    1    2    4    3\n    3    1    1        25    0\n"  # fmt: skip
    m = read(deck(loads=loads))
    assert m.face_loads[0].values.tolist() == [[1.0]]  # F10.2
    assert m.nodal_loads[0].values.tolist() == [0.25]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("    2    0\n", "    1    0\n", "a.dat:2:5: error: free input format is not read (1)"),
        ("   12    1    1", "    0    1    1", "a.dat:3:5: error: no nodes (0); expected the number of nodes in"),
        ("    1    1\n 0 0", "    1    1    2\n 0 0", "a.dat:3:25: error: substructures are not read (2)"),
        ("    1    1\n 0 0", "    1    1    1    3\n 0 0", "a.dat:3:30: error: rigid bodies are not read (3)"),
        ("    3  0", "    4  0", "a.dat:12:1: error: this node stands twice (4)"),
        ("    3  0", "   13  0", "a.dat:11:4: error: node number out of range (13); expected 1 to 12"),
        ("    3  0", "    3  2", "a.dat:11:8: error: no such code (2); expected 0 free, 1 held or -1 dependent"),
        ("    1    1    3\n", "   99    1    3\n", "a.dat:21:4: error: this material model is not read (99)"),
        ("    1    1       7.8", "    2    1       7.8", "a.dat:22:5: error: the material is of another model (2)"),
        ("    3    2    0    1\n", "    7    2    0    1\n", "a.dat:25:5: error: this element type is not read (7)"),
        ("    3    2    0    1\n", "    3    2    0    5\n", "a.dat:25:20: error: no material of this model (5)"),
        ("    5    6    8    7", "    5    6    8   77", "a.dat:28:19: error: no such node (77)"),
        ("    5    6    8    7    1    2    4    3\n", "    5    6    8    7    1    2    4\n",
         "a.dat:28:1: error: too short for an element's nodes"),
        ("    2    0    0    0    0    0\n", "    3    0    0    0    0    0\n",
         "a.dat:30:5: error: element number out of order (3); expected 2"),
        ("    2    0    0    0    0    0\n", "    2    7    0    0    0    0\n",
         "a.dat:25:20: error: an element's material 7 is not among those of this model (1)"),
        ("      99.0       1.0", "      -9.0       1.0", "a.dat:36:7: error: time goes back (-9.0)"),
        ("STOP", "STAP", "a.dat:38:1: error: the deck does not end here (STAP); expected STOP"),
        ("    1    2       1.0", "    1    0       1.0", "a.dat:7:10: error: no steps (0)"),
    ],
)  # fmt: skip
def test_faults(deck, old: str, new: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        read(deck((old, new)))
    assert any(said in line for line in str(caught.value).splitlines()), str(caught.value)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("   12    1    1    1", "99999    1    1    1"),
        ("   12    1    1    1", "   12    199999    1"),
        ("   12    1    1    1", "   12    1    199999"),
        ("   12    1    1    1", "   1299999    1    1"),
        ("    3    2    0    1", "    399999    0    1"),
        ("    1    2\n    1    2\n", "99999    2\n    1    2\n"),
        ("    1    2\n    1    2\n", "    1    2\n    199999\n"),
        (LOADS, LOADS.replace("    0", "99999", 1)),
        ("    1    1    3\n", "    199999    3\n"),
        ("0.0    0    0     ", "0.09999999999     "),
        ("2    2    2    0  ", "2    2    299999  "),
    ],
)
def test_hostile_counts_are_faults(deck, old: str, new: str) -> None:
    import resource

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        read(deck((old, new)))
    except InputError as error:
        assert ":1: error: " in str(error) or "expected" in str(error)  # noqa: PT017
    else:
        assert new[2] == "0"  # MSLOJ and IORT of a group without layers ask for nothing
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 64_000


def test_a_generation_of_millions_is_refused(faults: Faults) -> None:
    text = HEX.format(nodes=f"{1:10} {' 0' * 6}  {'':45}    1\n{10**8:10}\n", elements="", loads=LOADS, free=0)
    wide = text.replace("    2    0\n   12", f"    2    1\n{10**8:10}", 1)
    assert "100000000 items of 2 cards" in faults(read, wide, "a.dat")[0]


def test_files_that_are_no_decks(faults: Faults, shared: Path) -> None:
    assert "binary" in faults(read, b"\0\1", "a.dat")[0]
    assert "empty" in faults(read, b" \n", "a.dat")[0]
    other = faults(read, (shared / "samples/pakf-dat/KANAL.dat").read_bytes(), "a.dat")
    assert other == ["a.dat:8:1: error: a deck of PAK-F or PAK-KTM (fluid, transport), which is not read (C NP,NGET); "
                     "expected a deck of PAKS"]  # fmt: skip
    plain = b"".join(line for line in (shared / "samples/pakf-dat/KANAL.dat").read_bytes().splitlines(True)
                     if not line.startswith(b"C"))  # fmt: skip
    assert "PAK-F" in faults(read, plain, "a.dat")[0]


def test_kipkupa(shared: Path) -> None:
    m = read(shared / "samples/pak-dat/kipkupa.dat")
    assert (len(m.xyz), m.element_counts(), m.sections[1].native["NETIP"]) == (324, {"quad4": 289}, 84)
    assert m.blocks[0].data["thickness"].tolist() == [2.01] * 289
    assert m.fixed[17].tolist() == [True, True, True, True, False, True]
    assert m.curves[2].points.tolist() == [[0.0, 1.0], [500.0, 1.0], [500.0, 0.0], [40000.0, 0.0]]
    lifted = m.nodal_loads[0]
    assert (lifted.kind, len(lifted.nodes), set(lifted.dofs.tolist()), set(lifted.values.tolist())) == (
        "displacement", 18, {3}, {0.1},
    )  # fmt: skip
    assert lifted.native == {"incremental": True}  # 0.1 a step, added up
    assert m.analysis.end_time == 1200.0
