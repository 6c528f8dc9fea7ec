"""Broken files: every fault has its place, and nothing but faults comes out."""

from __future__ import annotations

import random
import time
import tracemalloc
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.femap import read, write
from zrno.translators.femap.lines import Lines
from zrno.translators.model import ElementBlock, Model, NodeSet, Part
from zrno.translators.text import InputError


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("2,0,0,1,46,0,0,0,0,0,0,1.0,0.0,0.0,", "2,0,0,1,46,0,0,0,0,0,0,1.0,zero,0.0,",
         "m.neu:9:28: error: not a number (zero); expected a number"),
        ("2,0,0,1,46,0,0,0,0,0,0,1.0,0.0,0.0,", "2,0,0,1,46,0,0,0,0,0,0,1.0,0.0,",
         "m.neu:9:1: error: 13 numbers in a line of nodes (2,0,0,1,46,0,0,0,0,0,0,1.0,0.0,); expected at least 14"),
        ("2,0,0,1", "2.5,0,0,1", "m.neu:9:1: error: not a node's number (2.5); expected a node's number"),
        ("2,0,0,1", "0,0,0,1", "m.neu:9:1: error: not a node's number (0)"),
        ("2,0,0,1", "1,0,0,1", "m.neu:9:1: error: a node's number stands twice (1)"),
        ("1.0,1.0,1.0,", "1.0,1e999,1.0,", "m.neu:14:28: error: not a number (1e999)"),
        ("1,2,3,4,5,6,7,8,0,0,", "1,2,3,4,5,6,7,9,0,0,",
         "m.neu:20:1: error: element 1 has a node that is not there (9)"),
        ("1,2,3,4,5,6,7,8,0,0,", "1,2,3,4,5,6,7,0,0,0,",
         "m.neu:20:1: error: element 1 has a node that is not there (0)"),
        ("1,2,3,4,5,6,7,8,0,0,", "1,2,3,4,5,6,7,x,0,0,", "m.neu:20:15: error: not a number (x)"),
        ("1,2,3,4,5,6,7,8,0,0,", "1,2,3,4,5,6,7,8.5,0,0,", "m.neu:20:15: error: not a node's number (8.5)"),
        ("1,124,1,25,8,1,0,0,", "-1,124,1,25,8,1,0,0,", "m.neu:19:1: error: not an element's number (-1); expected"),
        ("1,124,1,25,8,1,0,0,", "1,124,1,25,",
         "m.neu:19:1: error: 4 numbers in a line of an element (1,124,1,25,); expected at least 5"),
        ("0.,0.,0.,\n0.,0.,0.,\n", "0.,0.,0.,\n", "m.neu:25:4: error: the block ends inside an element"),
        ("   403", "   x", "m.neu:7:1: error: not the number of a block (x); expected 100, 401, 403, ..."),
        ("   -1\n   -1\n   404", "   -1\n   404", "m.neu:16:1: error: block 403 does not end"),
        ("4.41,", "four,", "m.neu:4:1: error: not a version (four); expected 4.41 or the like"),
        ("0.,0.,0.,\n", "0.,0.,0.," + " " * 9000 + "1\n", "error: a line of 9010 characters; expected at most 255"),
    ],
)  # fmt: skip
def test_faults(neu, faults, old: str, new: str, said: str) -> None:
    text = neu.head() + neu.MESH
    assert old in text
    assert said in "\n".join(faults(read, text.replace(old, new, 1), name="m.neu"))


def test_files_that_are_cut(neu, faults) -> None:
    text = neu.head() + neu.MESH
    assert faults(read, text[: text.rindex("   -1")], name="m.neu") == [
        "m.neu:26:1: error: the file ends inside block 404; expected a line -1"
    ]
    assert "the block ends inside an element" in faults(read, text[: text.rindex("   -1") - 40], name="m.neu")[0]
    assert faults(read, "   -1\n", name="m.neu") == [
        "m.neu:2:1: error: not the number of a block; expected 100, 401, 403, ..."
    ]
    assert "not the start of a block" in faults(read, "hello\n", name="m.neu")[0]
    assert faults(read, neu.head(), name="m.neu") == ["m.neu:6:1: error: a mesh without nodes; expected block 403"]


def test_faults_of_several_blocks(neu, faults) -> None:
    """One fault does not hide another; no more than twenty."""
    text = neu.head() + neu.MESH.replace("1.0,1.0,0.0", "1.0,a,0.0") + neu.block(402, "1,b,1,25,1,0,", "t")
    text += neu.block(406, "1,", "t", "1,120,1,1,1,1,0,0,c,", "-1,-1,")
    assert [line.split(" (")[1] for line in faults(read, text, name="m.neu")] == [
        "a); expected a number",
        "b); expected a number",
        "c); expected a number",
    ]
    many = neu.head() + neu.nodes([(0.0, 0.0, 0.0)] * 50).replace("0.0,0.0,0.0", "0.0,x,0.0")
    assert len(faults(read, many, name="m.neu")) == 20


@pytest.mark.parametrize(
    ("block", "said"),
    [
        (["402", "1,110,1,25,1,0,", "t", "0,0,0,0,", "999999999,", "1,"], "999999999 layers where 1 lines follow"),
        (["402", "1,110,1,25,1,0,", "t", "0,0,0,0,", "1e30,"], "not a count of layers (1e30)"),
        (["402", "1,110,1,25,1,0,", "t", "0,0,0,0,", "-5,"], "not a count of layers (-5)"),
        (["402", "1,110,1,25,1,0,", "t", "0,0,0,0,", "0,", "400,", "1.,"], "values: 400 values"),
        (["402", "1,110,1,25,1,0,", "t", "0,0,0,0,", "0,", "0,", "1,110,1,25,1,0,", "t", "0,0,0,0,", "0,", "0,"],
         "a property's number stands twice (1)"),
        (["401", "1,110,0,1,0,", "t", "1.,1.,"], "2 numbers in a line of a material's values"),
        (["601", "1,-601,55,0,0,1,0,", "t", "10,", "0,"], "flags: 10 values"),
        (["601", "1,-601,55,0,0,1,0,", "t", "1,", "0,", "1,", "1e300,"],
         "integers that are not whole numbers (1e300,)"),
        (["406", "1,", "t", "1,120,1,1,1,1,0,0,0,"], "a list of held nodes does not end"),
        (["406", "1,", "t", "-1,-1,-1,0,", "1,120,1,", "3,", "1,1,1.,"], "block 406 ends inside a relation's terms"),
        (["406", "1,", "t", "-1,-1,-1,0,", "1,120,1,", "1,", "1,7,1.,", "-1,"], "not a degree of freedom (7)"),
        (["407", "1,", "t", "0,0.,0,0,0,"], "block 407 ends here"),
        (["420", "1,1,", "f", "1,0.,0.,"], "a list of points does not end"),
        (["405", "1,0,7,60,1,", "t", "0.,0.,0.,", "0.,0.,0.,"], "not the kind of a coordinate system (7)"),
    ],
)  # fmt: skip
def test_faults_of_records(neu, faults, block: list[str], said: str) -> None:
    assert said in faults(read, neu.head() + neu.MESH + neu.block(*block), name="m.neu")[0]


def whole(neu) -> bytes:
    """A file with every kind of block, of both generations."""
    clip = ["0,0,0,", "0,0,0,0,0.,0.,", "0,0,", *(["0,0,", "0.,0.,0.,", "0.,0.,0.,"] * 6)]
    values = ["0.,0.,0.,0.,0.,0.,0.,0.,0.,0.,"] * 20
    rigid = [*neu.element(2, 29, 13, [1], flags="0," * 12 + "1,0,0,0,"), "2,0,1.,1,1,1,0,0,0,", "-1,"]
    options = ["0,0.,0,1,0,", *["0.,0.,1.,"] * 4, *["0.,0.,0.,"] * 3, *["0,0,0,"] * 2, *["0.,0.,0.,"] * 9]
    old = ["1,1,10,1,0,0,", "0.,0.,", *["1,2.,"] * 6, "0.,0,0,0,", "0,0,", "0,0,0,", "0.,0.,0.,", "-1,-1,-1,-1,-1,"]
    new = ["1,42,10,1,0,0,0,", "1,0,0,", "1.,0.,0.,0.,0.,", "0,0,", "0,0,0,", "0,0,0,", "0.,0.,0.,", "-1,-1,-1,-1,-1,"]
    temperatures = ["1,10,1,5.,0.,0,", "-1,-1,", "-1,-1,"]
    return "".join([
        neu.head("10.0"), neu.nodes(neu.CUBE), neu.block(404, *neu.BRICK, *rigid),
        neu.block(402, "1,110,1,25,1,0,", "t", "0,0,0,0,", "2,", "1,1,", "3,", "1.,2.,3.,", "0,", "0,"),
        neu.block(601, "1,-601,55,0,0,1,0,", "steel", "10,", "0," * 10, "25,", "0," * 25, "200,", *values, "50,",
                  *["0," * 10] * 5, "70,", *["0," * 10] * 7),
        neu.block(405, "1,0,0,60,1,", "s", "0.,0.,0.,", "0.,0.,0.,"),
        neu.block(420, "1,1,", "f", "1,0.,1.,", "-1,0.,0.,"),
        neu.block(406, "1,", "c", "1,120,1,1,1,1,0,0,0,", "-1,-1,", "1,120,1,", "1,", "1,1,1.,", "-1,-1,-1,"),
        neu.block(506, "1,", "c", "1,120,1,1,1,1,0,0,0,0,", *["-1,-1,"] * 4, "-1,-1,", "-1,0,0,"),
        neu.block(407, "1,", "l", *options, *old, *temperatures), neu.block(507, "1,", "l", *options, *new, "-1,-1,",
                                                                           *temperatures),
        neu.block(408, "3,1,0,", "g", *clip, "133,", "17,", "1,3,1,1,", "-1,-1,", "-1,", "28,", "7,", "4,",
                  "-1,", "-1,"),
        neu.block(451, "1,1,1,", "v", "1,2.,"),
    ]).encode()  # fmt: skip


def test_the_whole_file(neu, tmp_path: Path) -> None:
    (tmp_path / "m.neu").write_bytes(whole(neu))
    model = read(tmp_path / "m.neu")
    assert len(model.constraints) == 2
    assert len(model.nodal_loads) == 2 + 1
    assert len(model.face_loads) == len(model.node_sets) == len(model.equations) == len(model.systems) == 1
    assert len(model.body_loads) == 2


WORDS = [b"-1", b"-1\n", b"\n   -1\n", b"0", b"9" * 18, b"9" * 30, b"nan", b"1e400", b"1.5", b"\0", b"\xff", b"\n",
         b",", b" ", b"   -1\n   -1\n   403\n", b"\r", b"<NULL>", b"$COM", b"2", b"-"]  # fmt: skip


def test_broken_files(neu, tmp_path: Path) -> None:
    """Cut and changed files give a model or faults, and a model can be written."""
    good = whole(neu)
    numbers = random.Random(1)
    broken = [good[:end] for end in range(0, len(good), 197)]
    for _ in range(350):
        data = bytearray(good)
        for _ in range(numbers.choice((1, 1, 3))):
            at = numbers.randrange(len(data))
            data[at : at + numbers.choice((0, 1, 8))] = numbers.choice(WORDS)
        broken.append(bytes(data))
    lines = good.split(b"\n")
    for _ in range(150):
        some = list(lines)
        first = numbers.randrange(len(some))
        if numbers.random() < 0.5:
            del some[first : first + numbers.choice((1, 2, 7))]
        else:
            some.insert(numbers.randrange(len(some)), some[first])
        broken.append(b"\n".join(some))
    for data in broken:
        (tmp_path / "m.neu").write_bytes(data)
        with suppress(InputError):
            write(read(tmp_path / "m.neu"), tmp_path / "o.neu")


@pytest.mark.parametrize("kind", ["lists", "relations", "blocks", "minus"])
def test_time_and_memory_are_bounded(neu, tmp_path: Path, kind: str) -> None:
    """Long files of one odd thing: neither quadratic nor far beyond the file's size."""
    n = 2000
    bodies = {
        "lists": neu.block(
            404, *[f"{line}" for i in range(n) for line in neu.element(i + 1, 29, 13, [], flags="0,1,1,1")]
        ),
        "relations": neu.block(406, "1,", "t", "-1,", *["1,1,1,\n1,\n1,1,1.,"] * n, "-1,"),
        "blocks": neu.block(999, "x") * n,
        "minus": neu.block(407, "1,", "t", *["-1"] * n),
    }
    text = (neu.head() + neu.MESH + bodies[kind]).encode()
    (tmp_path / "m.neu").write_bytes(text)
    tracemalloc.start()
    start = time.perf_counter()
    with suppress(InputError):
        read(tmp_path / "m.neu")
    assert time.perf_counter() - start < 5.0
    assert tracemalloc.get_traced_memory()[1] < 64e6 + 10 * len(text)
    tracemalloc.stop()


def test_many_groups_of_one_node(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Arrays for lists of one member made a file of 60,000 such groups take 11 s."""
    count = 300
    model = Model(title="sets", node_ids=np.arange(1, count + 1), xyz=np.random.default_rng(3).random((count, 3)))
    model.parts[1] = Part(1, "plate", 1)
    model.blocks = [ElementBlock("quad4", np.array([1]), np.array([[0, 1, 2, 3]]), np.array([1]), "shell")]
    model.node_sets = [NodeSet(k + 1, f"set {k}", np.array([k])) for k in range(count)]
    write(model, tmp_path / "sets.neu")
    calls = []
    whole = Lines.table
    monkeypatch.setattr(Lines, "table", lambda self, *words, **more: calls.append(1) or whole(self, *words, **more))
    again = read(tmp_path / "sets.neu")
    assert [(s.name, s.nodes.tolist()) for s in again.node_sets] == [(f"set {k}", [k]) for k in range(count)]
    assert len(calls) < 30
