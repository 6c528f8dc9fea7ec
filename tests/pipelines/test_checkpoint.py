"""Checkpoints come back exactly; damage is found wherever it is; the last two are kept."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.checkpoint import Checkpointer, load_latest, save
from zrno.translators.text import InputError

STATE: dict[str, Any] = {
    "position": np.random.default_rng(3).random((500, 3)),
    "cells": np.arange(7, dtype=np.uint32),
    "alive": np.array([True, False]),
    "none": np.empty((0, 3)),
    "scalar": np.array(0.1),
    "time": 0.1 + 0.2,
    "step": 2**53 + 1,
    "odd": float("nan"),
    "law": "von Mises, µ",
    "deck": "x" * 100_000,
    "flag": True,
}


def names(directory: Path) -> list[str]:
    return sorted(p.name for p in directory.iterdir())


def test_a_state_comes_back_exactly(tmp_path: Path) -> None:
    save(tmp_path / "checkpoint_5.h5", STATE)
    got = load_latest(tmp_path)
    assert got is not None
    assert got.keys() == STATE.keys()
    for name, value in STATE.items():
        if isinstance(value, np.ndarray):
            assert got[name].dtype == value.dtype
            assert got[name].shape == value.shape
            assert got[name].tobytes() == value.tobytes()
        elif name != "odd":
            assert type(got[name]) is type(value)
            assert got[name] == value
    assert np.isnan(got["odd"])


def test_there_may_be_none(tmp_path: Path) -> None:
    assert load_latest(tmp_path) is None
    assert load_latest(tmp_path / "missing") is None


def test_damage_anywhere_is_found_and_the_one_before_taken(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    small = {"x": np.arange(40.0), "step": 9}
    save(tmp_path / "checkpoint_9.h5", small)
    newest = tmp_path / "checkpoint_10.h5"
    save(newest, {**small, "step": 10})
    sound = newest.read_bytes()
    data = sound.index(np.arange(40.0).tobytes())
    damaged = [sound[: len(sound) // 2], b"", b"\0" * 4096]
    damaged += [sound[:at] + bytes([sound[at] ^ 4]) + sound[at + 1 :] for at in (data, data + 150, data + 319)]
    for bad in damaged:
        newest.write_bytes(bad)
        caplog.clear()
        with caplog.at_level(logging.WARNING):
            got = load_latest(tmp_path)
        assert got is not None
        assert got["step"] == 9
        assert "checkpoint_10.h5 is damaged and passed over" in caplog.text
    newest.write_bytes(sound)
    got = load_latest(tmp_path)
    assert got is not None
    assert got["step"] == 10


def test_other_inputs_are_named(tmp_path: Path) -> None:
    save(tmp_path / "checkpoint_1.h5", {"step": 1}, {"old/place/a.mcm": "aa", "b.mcm": "bb"})
    assert load_latest(tmp_path, {"a.mcm": "aa", "b.mcm": "bb"}) is not None
    with pytest.raises(InputError, match=r"^new/a\.mcm:1:1: error: not the input that checkpoint_1\.h5 was made from"):
        load_latest(tmp_path, {"new/a.mcm": "cc", "b.mcm": "bb"})
    with pytest.raises(InputError, match=r"^b\.mcm:1:1: error: an input of checkpoint_1\.h5 is not given now"):
        load_latest(tmp_path, {"a.mcm": "aa"})


def test_a_failed_save_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="bad is a list"):
        save(tmp_path / "checkpoint_1.h5", {"x": np.arange(3), "bad": [1]})
    assert names(tmp_path) == []


def test_the_last_two_are_kept(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [Checkpointer(tmp_path, every=3)], 11)
    assert names(tmp_path) == ["checkpoint_00000009.h5", "checkpoint_00000011.h5"]
    got = load_latest(tmp_path)
    assert got is not None
    again = type(solver)()
    again.restore(got)
    assert again.step == 11
    np.testing.assert_array_equal(got["position"], solver.frame().particles["position"])


def test_an_interval_is_the_loops_to_keep(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [Checkpointer(tmp_path, interval=0.1)], 3, finish=False)
    assert names(tmp_path) == ["checkpoint_00000002.h5", "checkpoint_00000003.h5"]
    drive(type(solver)(), [Checkpointer(tmp_path)], 3, finish=False)
    assert names(tmp_path) == []  # a new run removes those of the old one, and makes none unless asked


def test_checkpoints_after_the_one_resumed_from_go(tmp_path: Path, solver: Any) -> None:
    for step in (5, 9):
        save(tmp_path / f"checkpoint_{step:08d}.h5", {"step": step})
    (tmp_path / ".17.checkpoint_00000012.h5").write_bytes(b"half")
    solver.step = 5
    Checkpointer(tmp_path).start(solver)
    assert names(tmp_path) == ["checkpoint_00000005.h5"]


def test_what_a_killed_run_left_half_written_is_removed(tmp_path: Path, solver: Any, drive: Any) -> None:
    for name in (".4711.checkpoint_3.h5", ".particles.pvd.4711.tmp"):  # of `replacing` and of `write_atomically`
        (tmp_path / name).touch()
    for name in (".gitignore", ".notes.tmp"):
        (tmp_path / name).touch()
    drive(solver, [Checkpointer(tmp_path, every=100)], 1)
    assert sorted(path.name for path in tmp_path.iterdir()) == [".gitignore", ".notes.tmp", "checkpoint_00000001.h5"]
