"""Plots of histories: drawn from what is there, told in words when it is not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.history import History
from zrno.pipelines.manifest import Manifest
from zrno.pipelines.plot import plot
from zrno.translators.text import InputError


@pytest.fixture
def folder(tmp_path: Path, solver: Any, drive: Any) -> Path:
    drive(solver, [History(tmp_path)], 20)
    Manifest(tmp_path, inputs={}, options={}, threads=1, title="Two bodies", units="mm-ms-g")
    return tmp_path


@pytest.fixture(autouse=True)
def letters_as_text(monkeypatch: pytest.MonkeyPatch) -> None:
    import matplotlib

    monkeypatch.setitem(matplotlib.rcParams, "svg.fonttype", "none")


def test_default_panels_with_labels_and_units(folder: Path) -> None:
    text = plot(folder, output=folder / "deep" / "h.svg").read_text()
    said = ("Two bodies", "energy [mJ]", "kinetic energy", "external work", "momentum [g mm/ms]", "momentum z")
    for words in (*said, "contact force [N]", "contact force x", "time [ms]"):
        assert f">{words}<" in text, words


def test_default_panels_are_those_that_are_there(folder: Path) -> None:
    """A structure has no force of contact; with grain on it there is one that it feels."""
    history = folder / "history.csv"
    rows = history.read_text().replace("contact_force", "reaction")
    history.write_text(rows)
    assert "contact force" not in plot(folder, output=folder / "h.svg").read_text()
    history.write_text(rows.replace("reaction", "structure_force"))
    text = plot(folder, output=folder / "h.svg").read_text()
    assert ">force on the structure [N]<" in text
    assert ">structure force z<" in text


def test_plane_strain_is_per_length(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [History(tmp_path)], 3)
    Manifest(tmp_path, inputs={}, options={}, threads=1, units="mm-ms-g", dimension=2)
    text = plot(tmp_path, output=tmp_path / "h.svg").read_text()
    for words in ("energy [mJ/mm]", "momentum [g/mm mm/ms]", "contact force [N/mm]", "time [ms]"):
        assert f">{words}<" in text, words


def test_chosen_columns(folder: Path) -> None:
    text = plot(folder, output=folder / "h.svg", quantities=["dt", "neighbours"]).read_text()
    assert ">time step [ms]<" in text
    assert ">neighbours<" in text
    assert "kinetic" not in text


def test_the_picture_is_drawn_in_the_folder(folder: Path) -> None:
    from matplotlib.image import imread

    path = plot(folder)
    assert path == folder / "history.png"
    image = imread(path)
    assert image.shape[1] == 1200
    assert np.ptp(image) > 0.5


def test_a_history_of_one_row(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [History(tmp_path)], 0)
    assert plot(tmp_path).stat().st_size > 0


def test_what_is_not_there_is_named(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no quantity heat; there are: energy, momentum, contact_force, struct"):
        plot(folder, quantities=["heat"])
    with pytest.raises(ValueError, match=r"is not a plot: give \.png, \.pdf, \.svg"):
        plot(folder, output=folder / "h.mp4")
    (folder / "history.csv").unlink()
    with pytest.raises(InputError, match="no history in this folder"):
        plot(folder)
