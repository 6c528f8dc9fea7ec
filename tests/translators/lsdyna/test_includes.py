"""Includes: where files are sought, what they may not do, and what *INCLUDE_TRANSFORM changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.lsdyna import read
from zrno.translators.model import Model
from zrno.translators.text import InputError

Read = Callable[..., Model]
NODE = "*NODE\n       1             1.0             2.0             3.0       1\n"


@pytest.mark.parametrize(
    ("main", "name"),
    [
        ("*INCLUDE\npart.k\n", "part.k"),
        ("*INCLUDE\npa +\nrt.k\n", "part.k"),
        ("*INCLUDE\nsub\\part.k\n", "sub/part.k"),
        ("*INCLUDE_PATH\nsub\n*INCLUDE\npart.k\n", "sub/part.k"),
        ("*INCLUDE_PATH_RELATIVE\nsub\n*INCLUDE\npart.k\n", "sub/part.k"),
    ],
)
def test_files_are_found(deck: Read, main: str, name: str) -> None:
    model = deck("*KEYWORD\n" + main + "*END\n", files={name: NODE})
    assert model.xyz.tolist() == [[1.0, 2.0, 3.0]]
    assert [path.replace("\\", "/").endswith(name) for path in model.includes] == [True]


def test_files_within_files_are_sought_beside_them_first(deck: Read) -> None:
    files = {"sub/a.k": "*INCLUDE\nb.k\n", "sub/b.k": NODE, "b.k": "*TITLE\nthe wrong one\n"}
    model = deck("*INCLUDE\nsub/a.k\n", files=files)
    assert len(model.xyz) == 1
    assert not model.title
    assert [Path(path).name for path in model.includes] == ["a.k", "b.k"]


def test_an_included_file_without_keywords(deck: Read) -> None:
    model = deck("*KEYWORD\n*INCLUDE\nnone.k\n" + NODE, files={"none.k": "hello\n$ a comment\n"})
    assert len(model.xyz) == 1
    assert any("text before the first keyword is not read" in warning for warning in model.warnings)


def test_end_ends_its_own_file_alone(deck: Read) -> None:
    model = deck("*INCLUDE\na.k\n*TITLE\nmain\n", files={"a.k": NODE + "*END\n*TITLE\nnever\n"})
    assert model.title == "main"


def test_an_included_file_may_say_nothing(deck: Read) -> None:
    model = deck("*INCLUDE\na.k\n*TITLE\nmain\n", files={"a.k": "$ nothing\nnot even this\n"})
    assert model.title == "main"
    assert "a.k:2: text before the first keyword is not read" in model.warnings[0]


def test_a_missing_file_is_a_fault_of_the_line_that_names_it(deck: Read, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        deck("*INCLUDE\na.k\n", files={"a.k": "$ first\n*INCLUDE\n$ none\nlost.k\n"})
    assert str(caught.value).startswith(f"{tmp_path}/a.k:4:1: error: there is no such file to include (lost.k)")
    model = deck("*INCLUDE\na.k\n", partial=True)
    assert model.incomplete == [f"{tmp_path}/a.k:4: the file lost.k that is included here is not there"]


def test_faults_name_the_included_file(deck: Read, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        deck("*INCLUDE\nsub/a.k\n", files={"sub/a.k": "*NODE\n1,x\n"})
    assert str(caught.value).startswith(f"{tmp_path}/sub/a.k:2:3: error: xyz is not a number (x)")


def test_a_file_that_includes_itself(deck: Read) -> None:
    for files in ({"a.k": "*INCLUDE\na.k\n"}, {"a.k": "*INCLUDE\nb.k\n", "b.k": "*INCLUDE\n./a.k\n"}):
        with pytest.raises(InputError, match="the file includes itself"):
            deck("*INCLUDE\na.k\n", files=files)


def test_includes_that_double_are_bounded(deck: Read) -> None:
    files = {f"f{i}.k": f"*INCLUDE\nf{i + 1}.k\nf{i + 1}.k\n" for i in range(25)} | {"f25.k": "*TITLE\nend\n"}
    with pytest.raises(InputError, match="too many files are included"):
        deck("*INCLUDE\nf0.k\n", files=files)


@pytest.mark.parametrize("name", ["../out.k", "sub/../../out.k", "{parent}/out.k", "link.k"])
def test_files_outside_are_refused_unless_allowed(tmp_path: Path, name: str) -> None:
    (tmp_path / "out.k").write_text(NODE)
    folder = tmp_path / "deck"
    (folder / "sub").mkdir(parents=True)
    (folder / "link.k").symlink_to(tmp_path / "out.k")
    (folder / "main.k").write_text(f"*INCLUDE\n{name.format(parent=tmp_path)}\n")
    with pytest.raises(InputError, match="outside the folder of the deck"):
        read(folder / "main.k")
    assert len(read(folder / "main.k", allow_outside=True).xyz) == 1


def test_a_file_may_step_back_within_the_decks_folder(deck: Read) -> None:
    model = deck("*INCLUDE\nsub/a.k\n", files={"sub/a.k": "*INCLUDE\n../b.k\n", "b.k": NODE})
    assert len(model.xyz) == 1


PART = """\
*NODE
1,0,0,0
2,1,0,0
3,1,1,0
4,0,1,0
*ELEMENT_SHELL
1,1,1,2,3,4
*PART
p
1,1,1
*SECTION_SHELL
1,2
2.0
*MAT_ELASTIC
1,7.85,210.,.3
*SET_NODE_LIST
1
1,2
*DEFINE_CURVE
1
0,1
*BOUNDARY_SPC_SET
1,0,1
*LOAD_NODE_SET
1,1,1,2.5
*INITIAL_VELOCITY
1
1.,2.,3.
"""


def test_offsets_move_numbers(deck: Read) -> None:
    main = "*INCLUDE_TRANSFORM\np.k\n100,200,300,400,500,600,700\n800\n*INCLUDE\np.k\n"
    model = deck(main, files={"p.k": PART})
    assert model.node_ids.tolist() == [101, 102, 103, 104, 1, 2, 3, 4]
    assert model.blocks[0].ids.tolist() == [201, 1]
    assert model.blocks[0].nodes.tolist() == [[0, 1, 2, 3], [4, 5, 6, 7]]
    assert (sorted(model.parts), sorted(model.sections), sorted(model.materials)) == ([1, 301], [1, 801], [1, 401])
    part = model.parts[301]
    assert (part.section, part.material) == (801, 401)
    assert {s.id: s.nodes.tolist() for s in model.node_sets} == {501: [0, 1], 1: [4, 5]}
    assert sorted(model.curves) == [1, 601]
    assert [(c.set, c.nodes.tolist()) for c in model.constraints] == [(501, [0, 1]), (1, [4, 5])]
    assert [(load.set, load.curve) for load in model.nodal_loads] == [(501, 601), (1, 1)]


def test_factors_change_units(deck: Read) -> None:
    """kg, m, s to t, mm, s: masses / 1000, lengths x 1000; a stress of 1 Pa is 1e-6 MPa."""
    main = "*INCLUDE_TRANSFORM\np.k\n\n\n0.001,1.0,1000.0\n"
    model = deck(main, files={"p.k": PART})
    assert model.xyz.max() == 1000.0
    assert model.sections[1].parameters == {"thickness": 2000.0}
    assert model.materials[1].density == pytest.approx(7.85e-12)
    assert model.materials[1].parameters == {"E": pytest.approx(210e-6), "nu": 0.3}
    assert model.initial_velocities[0].velocity[0].tolist() == [1000.0, 2000.0, 3000.0]


PLACE = "*INCLUDE_TRANSFORM\np.k\n\n\n\n9\n*DEFINE_TRANSFORMATION\n9\n"


@pytest.mark.parametrize(
    ("rows", "third"),
    [
        ("TRANSL,1,2,3\n", [2, 3, 3]),
        ("SCALE,2,3,4\n", [2, 3, 0]),
        ("ROTATE,0,0,1,0,0,0,90\n", [-1, 1, 0]),
        ("ROTATE,0,0,2,1,0,0,-90\n", [2, 0, 0]),
        ("POINT,5,0,0,0\nPOINT,6,0,0,3\nROTATE,5,6,90\n", [-1, 1, 0]),
        ("MIRROR,0.5,0,0,1,0,0\n", [0, 1, 0]),
        ("   TRANSL       1.0       0.0       0.0\n    SCALE       2.0       2.0       2.0\n", [4, 2, 0]),
        ("SCALE,2,2,2\nTRANSL,1,0,0\n", [3, 2, 0]),
    ],
)
def test_transformations_place_nodes(deck: Read, rows: str, third: list[float]) -> None:
    model = deck(PLACE + rows, files={"p.k": PART})
    assert np.allclose(model.xyz[2], third, atol=1e-15)
    swapped = "SCALE" in rows and "TRANSL" in rows
    assert any("applied from top to bottom" in warning for warning in model.warnings) == swapped


def test_the_innermost_transformation_comes_first(deck: Read) -> None:
    outer = "*DEFINE_TRANSFORMATION\n1\nSCALE,2,2,2\n*INCLUDE_TRANSFORM\ninner.k\n\n\n\n1\n"
    inner = "*DEFINE_TRANSFORMATION\n2\nTRANSL,1,0,0\n*INCLUDE_TRANSFORM\np.k\n\n\n\n2\n"
    model = deck(outer, files={"inner.k": inner, "p.k": PART})
    assert model.xyz[0].tolist() == [2.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("POS6N,1,2,3,4,5,6\n", "this row of a transformation is not read"),
        ("ROTATE,0,0,0,0,0,0,90\n", "the axis of the rotation has no length"),
        ("ROTATE,1,2,90\n", "its points are not there"),
        ("MIRROR,0,0,0\n", "the mirror's normal has no length"),
    ],
)
def test_transformations_that_cannot_be(deck: Read, rows: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        deck(PLACE + rows, files={"p.k": PART})


def test_a_transformation_that_is_not_there(deck: Read) -> None:
    with pytest.raises(InputError, match="a transformation that is not there"):
        deck("*INCLUDE_TRANSFORM\np.k\n\n\n\n9\n", files={"p.k": PART})
