"""The shipped samples: listed, copied, and sound as they are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import samples, scene
from zrno.pipelines.drafts import drafts
from zrno.translators import Model

SCENES = ["scene", "elastic", "text_10ms", "aluminium", "potential", "study"]


def test_every_sample_has_a_title() -> None:
    assert samples.names()["two_cylinders"] == "Two cylinders that meet"
    assert all(samples.names().values())


def test_a_copy_has_every_file_and_overwrites_nothing(tmp_path: Path) -> None:
    folder = samples.copy("two_cylinders", tmp_path / "here")
    assert {"scene.yaml", "cylinders.geo", "cylinders.yaml", "README.md"} <= {p.name for p in folder.iterdir()}
    with pytest.raises(ValueError, match="is there already"):
        samples.copy("two_cylinders", folder)
    with pytest.raises(ValueError, match=r"there is no sample three_cylinders; expected one of .*two_cylinders"):
        samples.copy("three_cylinders", tmp_path / "there")


def _deck(folder: Path, name: str, **options: object) -> Model:
    loaded = scene.load(folder / f"{name}.yaml", {key.replace("__", "."): value for key, value in options.items()})
    with drafts(loaded, folder, publishing=False) as made:
        return next(draft.read() for draft in made if draft.target == folder / loaded.decks[0])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the sample."""
    return samples.copy("two_cylinders", tmp_path / "cylinders")


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_of_the_cylinders_makes_its_deck(folder: Path, name: str) -> None:
    deck = _deck(folder, name)
    assert deck.particles is not None
    assert deck.dimension == 2
    assert np.bincount(deck.particles.material).tolist() == [0, 2700, 2700]
    assert [m.mass for m in deck.materials.values()] == [pytest.approx(8.1, rel=1e-12)] * 2
    assert [m.law for m in deck.materials.values()] == ["elastic" if name in ("elastic", "study") else "von_mises"] * 2
    speed = 1e-2 if name in ("scene", "aluminium", "potential") else 1e-3
    velocity = deck.particles.velocity
    assert velocity is not None
    assert np.unique(velocity, axis=0).tolist() == [[-speed, 0, 0], [speed, 0, 0]]
    assert deck.materials[1].parameters["E"] == (0.7 if name == "aluminium" else 1.656)


def test_faces_touch(folder: Path) -> None:
    particles = _deck(folder, "scene").particles
    assert particles is not None
    left, right = (particles.x[particles.material == m, 0] for m in (1, 2))
    assert right.min() - left.max() == pytest.approx(1 / 30, rel=1e-9)
    assert np.diff(np.unique(left.round(9))) == pytest.approx(1 / 30, rel=1e-6)


def test_slender_cylinders_by_one_number(folder: Path) -> None:
    deck = _deck(folder, "scene", numbers__length=6)
    assert deck.particles is not None
    assert len(deck.particles) == 10800
    box = deck.bounding_box()
    assert box is not None
    assert box[1][0] == pytest.approx(6 - 1 / 60)


def test_repulsive_contact(folder: Path) -> None:
    control = _deck(folder, "potential").particle_control
    assert control is not None
    assert (control.contact, control.contact_laws) == (1, [(0.1, 4.0)] * 2)
