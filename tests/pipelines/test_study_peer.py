"""CalculiX beside our own runs of a study."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from zrno.pipelines import study_peer
from zrno.pipelines.samples import copy
from zrno.pipelines.signals import Unmeasured
from zrno.pipelines.study import study
from zrno.pipelines.study_plan import prepare as study_peer_plan

PRINTED = """
 displacements (vx,vy,vz) for set AT and time  0.5000000E+00

         1  1.000000E+00  0.000000E+00 -2.000000E+00

 displacements (vx,vy,vz) for set AT and time  0.1000000E+01

         1  1.500000E+00  0.000000E+00 -6.000000E+00
         2  0.500000E+00  0.000000E+00 -1.000000E+00
"""
ONE = {"study.vary": {"numbers.n": [2]}, "study.peer.elements": {"C3D8": {}}}


def test_the_last_block_of_the_listing_counts() -> None:
    assert study_peer.printed(PRINTED, "displacement_z") == -7.0
    assert study_peer.printed(PRINTED, "displacement_x") == 2.0
    with pytest.raises(Unmeasured, match="no force"):
        study_peer.printed(PRINTED, "reaction_z")


def test_a_peer_that_is_missing_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study_peer, "PROGRAM", "no_such_program")
    copy("elastoplastic_bar", tmp_path / "bar")
    found = study(tmp_path / "bar/study.yaml", output=tmp_path / "out", options=ONE)
    assert found["peers"] == []
    assert "is not installed" in found["peers_note"]


@pytest.mark.skipif(shutil.which(study_peer.PROGRAM) is None, reason="CalculiX (ccx) is not installed")
def test_calculix_on_the_same_mesh(tmp_path: Path) -> None:
    copy("elastoplastic_bar", tmp_path / "bar")
    options = {**ONE, "fem.enhanced": "none", "fem.dilatation": "plain"}
    found = study(tmp_path / "bar/study.yaml", output=tmp_path / "out", options=options)
    (row,) = found["peers"]
    assert row["message"] == ""
    assert row["value"] == pytest.approx(found["rows"][0]["value"], rel=2e-6)  # plain bricks are plain bricks
    assert (tmp_path / "out/peers.csv").exists()
    run = next((tmp_path / "out/runs").glob("*/run.json"))
    assert row["threads"] == json.loads(run.read_text())["threads"]
    run.write_text('{"threads": 2}')
    plan = study_peer_plan(tmp_path / "bar/study.yaml", options)
    assert study_peer.threads_of(plan, tmp_path / "out", {"numbers.n": 2}) == 2
    assert study_peer.threads_of(plan, tmp_path / "out", {"numbers.n": 3}) == 1
