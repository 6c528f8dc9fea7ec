"""The sample's tests of the cap model at a point, against closed forms and rate equations."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from zrno.pipelines.samples import copy


def test_the_script_meets_its_references_and_draws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = copy("cap_point", tmp_path / "cap")
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.delitem(sys.modules, "cap_point", raising=False)
    import cap_point

    found = cap_point.differences()
    assert len(found) == 6
    bounds = {"hydrostatic": 1e-10, "uniaxial": 1e-4, "triaxial": 1e-9}
    for test, difference in found.items():
        assert difference < bounds[test.split()[0].rstrip(",")], test
    (folder / "cap_point.png").unlink()
    cap_point.draw(folder / "cap_point.png")
    assert (folder / "cap_point.png").stat().st_size > 10_000
    del sys.modules["cap_point"]
