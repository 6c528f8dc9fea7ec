"""Readers against mutated files: a model or placed faults, in time and in little memory. `fuzzing.py` runs longer."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest


def _fuzzing() -> ModuleType:
    spec = importlib.util.spec_from_file_location("fuzzing", Path(__file__).with_name("fuzzing.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["fuzzing"] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("count", [600, pytest.param(20_000, marks=pytest.mark.slow)])
def test_mutated_files(count: int) -> None:
    fuzzing = _fuzzing()
    assert fuzzing.fuzz(fuzzing.all_seeds(), count) == {}


def test_the_fuzzer_sees_what_goes_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """A reader that crashes, hangs, takes memory or says no place is found out."""
    fuzzing = _fuzzing()
    from zrno.translators import formats

    def crash(path: object, **_: object) -> None:
        raise IndexError("seven")

    def hoard(path: object, **_: object) -> None:
        bytearray(1 << 30)

    def hang(path: object, **_: object) -> None:
        while True:
            pass

    seeds = [fuzzing.Seed("a.mcm", b"1 2 3\n" * 10)]
    monkeypatch.setattr(fuzzing, "LIMIT_SECONDS", 0.25)
    for reader, said in ((crash, "IndexError: seven"), (hoard, "out of memory"), (hang, "hangs")):
        monkeypatch.setattr(formats, "read", reader)
        assert said in fuzzing.fuzz(seeds, 1)[0]
