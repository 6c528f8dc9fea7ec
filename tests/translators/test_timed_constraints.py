"""Constraints that hold for a time: no target says so, and the report does."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from zrno.translators import Report, write
from zrno.translators.held import fixed_dofs
from zrno.translators.model import Constraint, ElementBlock, Model, Part


def timed() -> Model:
    """A triangle whose first node is held from t = 1 on."""
    model = Model(node_ids=np.arange(1, 4), xyz=np.eye(3), parts={1: Part(1, "a")})
    model.blocks = [ElementBlock("tri3", np.array([1]), np.array([[0, 1, 2]]), np.array([1]), "shell")]
    model.constraints = [Constraint(np.array([0]), np.ones((1, 6), bool), birth=1.0)]
    return model


def test_decks_hold_all_the_time() -> None:
    report = Report()
    assert fixed_dofs(timed(), report)[0].all()
    assert [(i.what, i.count) for i in report.approximated] == [("constraints", 1)]


def test_femap(tmp_path: Path) -> None:
    lost = [i.what for i in write(timed(), tmp_path / "a.neu").dropped]
    assert "constraint birth" in lost
