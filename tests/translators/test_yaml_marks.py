"""YAML with places: plain values, places of keys and values, overrides, and text that is none or means harm."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from zrno.translators.text import InputError
from zrno.translators.yaml_marks import MOST_BYTES, Place, load

Faults = Callable[..., list[str]]


def read(path: Path) -> None:
    """Read and raise what was found."""
    load(path).stop()


def test_values_keys_and_their_places(tmp_path: Path) -> None:
    path = tmp_path / "s.yaml"
    path.write_text("a: 1e-3\nb:\n  - &x {c: yes}\n  - *x\n")
    document = load(path)
    assert document.data == {"a": 1e-3, "b": [{"c": True}, {"c": True}]}
    assert document.values["a",] == Place(str(path), 1, 4, "1e-3")
    assert document.keys["b", 1, "c"] == Place(str(path), 3, 9, "c")
    assert document.place(("b", 0, "d", "e"), key=True) == document.values["b", 0] == Place(str(path), 3, 5)


def test_an_override_brings_its_own_place(tmp_path: Path) -> None:
    path = tmp_path / "s.yaml"
    path.write_text("a: {b: 1}\nc: 3\n")
    document = load(path)
    key, value = Place("--set", 1, 1, "a.d.e"), Place("--set", 1, 7, "5")
    document.override(("a", "d", "e"), 5, value, key)
    assert document.data == {"a": {"b": 1, "d": {"e": 5}}, "c": 3}
    assert (document.place(("a", "d", "e"), key=True), document.place(("a", "d", "f"))) == (key, value)
    assert document.place(("a",)).path == str(path)
    with pytest.raises(InputError, match=r"--set:1:7: error: there is no c\.d \(5\)"):
        document.override(("c", "d"), 5, value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a: 1\na: 2\n", "s.yaml:2:1: error: the key stands twice (a)"),
        ("a: &a {b: *a}\n", "s.yaml:1:4: error: a.b contains itself"),
        ("? [a]\n: 1\n", "s.yaml:1:3: error: a key is a list or a mapping"),
        ("a: 2024-13-01\n", "s.yaml:1:4: error: not a value of the kind timestamp (2024-13-01)"),
        ("a: !!int ''\n", "s.yaml:1:4: error: not a value of the kind int"),
        ("a: !!bool x\n", "s.yaml:1:4: error: not a value of the kind bool (x)"),
        ("a: " + "7" * 5000, "s.yaml:1:4: error: not a value of the kind int"),
        ("a: !nonsense x\n", "s.yaml:1:4: error: not YAML: could not determine a constructor"),
        ("a: *b\n", "s.yaml:1:4: error: not YAML: found undefined alias"),
        ("a: \x00\n", "s.yaml:1:1: error: not YAML: special characters are not allowed"),
        (b"a: 1\nb: \xff\n", "s.yaml:2:1: error: not YAML"),
        ("[" * 5000, "s.yaml:1:1: error: nested too deeply"),
        ("a: 1\n---\nb: 2\n", "s.yaml:2:1: error: not YAML: but found another document"),
        ("#" * (MOST_BYTES + 1), "s.yaml:1:1: error: 1048577 bytes are too many"),
    ],
)
def test_what_is_wrong_has_its_place(faults: Faults, text: str | bytes, said: str) -> None:
    (line,) = faults(read, text, name="s.yaml")
    assert line.startswith(said), line


def test_aliases_that_multiply_end_soon(faults: Faults) -> None:
    words = "\n".join(f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}'] * 10)}]" for i in range(12))
    started = time.perf_counter()
    assert "more than 50000 values" in faults(read, f"a0: &a0 x\n{words}\n", name="s.yaml")[0]
    assert time.perf_counter() - started < 5.0


def test_twenty_faults_are_enough(faults: Faults) -> None:
    assert len(faults(read, "a: 1\n" * 10_000, name="s.yaml")) == 20
