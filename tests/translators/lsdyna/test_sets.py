"""Sets: every layout, and that wide ranges and rings of sets cost nothing."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable

import pytest

from zrno.translators.model import Model
from zrno.translators.text import InputError

Read = Callable[..., Model]

NODES = "*NODE\n" + "".join(f"{i},{i}.0\n" for i in range(1, 21))
SHELLS = "*ELEMENT_SHELL\n1,1,1,2,3,4\n2,1,2,3,4,5\n5,2,6,7,8,9\n"
BOX = "*DEFINE_BOX\n1,2.5,5.5,-1,1,-1,1\n"


def node_set(model: Model, number: int = 1) -> list[int]:
    """Numbers of a node set's members."""
    return next(model.node_ids[s.nodes].tolist() for s in model.node_sets if s.id == number)


@pytest.mark.parametrize(
    ("text", "members"),
    [
        ("*SET_NODE_LIST\n1\n3,1,2\n5\n", [3, 1, 2, 5]),
        ("*SET_NODE\n         1       0.0       0.0       0.0       0.0MECH\n         3         4\n", [3, 4]),
        ("*SET_NODE_LIST_TITLE\na name\n1\n7\n", [7]),
        ("*SET_NODE_COLUMN\n1\n4,1.,2.\n5\n", [4, 5]),
        ("*SET_NODE_LIST_GENERATE\n1\n2,4,18,99\n", [2, 3, 4, 18, 19, 20]),
        ("*SET_NODE_LIST_GENERATE_INCREMENT\n1\n2,11,4\n1,999999999,9\n", [1, 2, 6, 10, 19]),
        ("*SET_NODE_GENERAL\n1\nNODE,1,2,9\nDNODE,2\n", [1, 9]),
        ("*SET_NODE_GENERAL\n1\nALL\nDPART,1\nDBOX,1\n", [*range(6, 21)]),
        ("*SET_NODE_GENERAL\n1\nPART,2\n", [6, 7, 8, 9]),
        ("*SET_NODE_GENERAL\n1\nBOX,1\n", [3, 4, 5]),
        ("*SET_NODE_GENERAL\n1\nSET_SHELL,8\n*SET_SHELL\n8\n5\n", [6, 7, 8, 9]),
        ("*SET_NODE_COLLECT\n1\n3\n*SET_NODE_COLLECT\n1\n8,3\n", [3, 8]),
        ("*SET_NODE_ADD\n1\n2,3\n*SET_NODE\n2\n4\n*SET_NODE\n3\n9,4\n", [4, 9]),
        ("*SET_NODE_INTERSECT\n1\n2,3\n*SET_NODE\n2\n4,5\n*SET_NODE\n3\n9,4\n", [4]),
        ("*SET_NODE_ADD_ADVANCED\n1\n2,1,8,2\n*SET_NODE\n2\n20\n*SET_SHELL\n8\n5\n", [20, 6, 7, 8, 9]),
        ("*SET_NODE_LIST_SMOOTH\n1\n2,3\n", [2, 3]),
    ],
)
def test_node_sets(deck: Read, text: str, members: list[int]) -> None:
    assert node_set(deck(NODES + SHELLS + BOX + text)) == members


@pytest.mark.parametrize(
    ("text", "members"),
    [
        ("*SET_SHELL_LIST\n1\n5,2\n", [5, 2]),
        ("*SET_SHELL_LIST_GENERATE\n1\n1,1000000000\n", [1, 2, 5]),
        ("*SET_SHELL_GENERAL\n1\nPART,1\nELEM,5\nDELEM,1\n", [2, 5]),
        ("*SET_SHELL_GENERAL_COLLECT\n1\nALL\n", [1, 2, 5]),
    ],
)
def test_element_sets(deck: Read, text: str, members: list[int]) -> None:
    (one,) = deck(NODES + SHELLS + text).element_sets
    assert (one.family, one.elements.tolist()) == ("shell", members)


def test_part_and_segment_sets(deck: Read) -> None:
    model = deck(
        NODES
        + SHELLS
        + "*SET_PART_LIST_GENERATE\n1\n1,9\n*SET_PART\n2\n7\n*SET_SEGMENT_TITLE\ntop\n3\n1,2,3,4\n1,2,3\n"
        "*SET_SEGMENT_GENERAL\n4\nSEG,5,6,7,7\n*SET_BEAM\n5\n1\n*SET_TSHELL\n6\n2\n*SET_DISCRETE\n7\n3\n*SET_SOLID\n8\n4\n"
    )
    assert [s.parts.tolist() for s in model.part_sets] == [[1, 2], [7]]
    assert [(s.name, s.segments.tolist()) for s in model.segment_sets] == [
        ("top", [[0, 1, 2, 3], [0, 1, 2, 2]]), ("", [[4, 5, 6, 6]]),
    ]  # fmt: skip
    assert [(s.family, s.elements.tolist()) for s in model.element_sets] == [
        ("beam", [1]), ("tshell", [2]), ("spring", [3]), ("solid", [4]),
    ]  # fmt: skip


def test_what_is_not_there_is_left_out_and_said(deck: Read) -> None:
    model = deck(NODES + "*SET_NODE\n1\n3,99\n*SET_SEGMENT\n2\n1,2,3,99\n")
    assert node_set(model) == [3]
    said = " ".join(model.warnings)
    assert "1 nodes of node set 1 are not in the deck" in said
    assert "1 segments of segment set 2 have nodes that are not in the deck" in said


def test_options_that_are_not_read_are_said(deck: Read) -> None:
    model = deck(NODES + "*SET_NODE_GENERAL\n1\nVOL,3\nNODE,2\n*SET_NODE\n1\n4\n")
    said = " ".join(model.warnings)
    assert "1 rows of the option VOL are not read" in said
    assert "node set 1 stands twice: the later one counts" in said
    assert node_set(model) == [4]


@pytest.mark.parametrize(
    "text",
    [
        "*SET_NODE_ADD\n1\n1\n",
        "*SET_NODE_ADD\n1\n2\n*SET_NODE_INTERSECT\n2\n1\n",
        "*SET_NODE_GENERAL\n1\nSET,1\n",
    ],
)
def test_a_set_made_of_itself(deck: Read, text: str) -> None:
    with pytest.raises(InputError, match="the set is made of itself"):
        deck(NODES + text)


def test_a_chain_of_sets_may_be_long(deck: Read) -> None:
    chain = "".join(f"*SET_NODE_ADD\n{i}\n{i + 1}\n" for i in range(1, 200)) + "*SET_NODE\n200\n7\n"
    assert node_set(deck(NODES + chain)) == [7]
    endless = "".join(f"*SET_NODE_ADD\n{i}\n{i + 1}\n" for i in range(1, 3000))
    with pytest.raises(InputError):
        deck(NODES + endless)


def test_huge_ranges_need_no_memory(deck: Read) -> None:
    wide, stepped = "1,999999999999\n" * 500, "1,999999999999,3\n" * 500
    text = f"*SET_NODE_LIST_GENERATE\n1\n{wide}*SET_NODE_LIST_GENERATE_INCREMENT\n2\n{stepped}"
    tracemalloc.start()
    model = deck(NODES + text)
    piece = deck(text)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert node_set(model) == list(range(1, 21))
    assert "2 sets are ranges of too many numbers" in " ".join(piece.warnings)
    assert peak < 20_000_000
