"""The sample's physics: the bounce keeps its energy, the slide its acceleration; and the pairs of decks run."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy, root
from zrno.translators import read, write

PAIRS = ("msh", "k", "neu", "edited")


def test_the_block_bounces(tmp_path: Path) -> None:
    folder = copy("block_on_plate", tmp_path / "drop")
    result = run([folder / "scene.yaml"], output=folder / "out", options={"render": []})
    assert result["energy"]["balance_error"] < 0.005
    found = load(folder / "out")
    speed = found.arrays("particles", len(found.times) - 1)["velocity"][:, 2].mean()
    assert speed == pytest.approx(1.6521, rel=0.01)
    assert abs(found.history["interface_energy"][-1]) < 0.01 * found.history["kinetic"][-1]


def test_the_block_slides(tmp_path: Path) -> None:
    folder = copy("block_on_plate", tmp_path / "slide")
    run([folder / "incline.yaml"], output=folder / "out", options={"render": []})
    found = load(folder / "out")
    arrays = found.arrays("particles", len(found.times) - 1)
    assert arrays["velocity"][:, 0].mean() == pytest.approx(0.0753358, rel=0.01)
    weight = arrays["mass"].sum() * 0.00849571
    assert -found.history["structure_force_z"][-20:].mean() == pytest.approx(weight, rel=1e-3)


@pytest.mark.parametrize("name", PAIRS)
def test_the_pairs_are_read_and_written_to_the_same_bytes(name: str, tmp_path: Path) -> None:
    for suffix in ("dat", "mcm"):
        source = root() / "pairs" / f"{name}.{suffix}"
        target = tmp_path / source.name
        write(read(source, paired=True), target)
        assert target.read_bytes() == source.read_bytes()


def test_the_pairs_by_different_meshes_are_the_same() -> None:
    bodies = []
    for name in PAIRS[:3]:
        decks = [(root() / "pairs" / f"{name}.{suffix}").read_text().splitlines() for suffix in ("dat", "mcm")]
        bodies.append([line for deck in decks for line in deck[2:]])
    assert bodies[0] == bodies[1] == bodies[2]


def test_a_pair_runs(tmp_path: Path) -> None:
    pair = [root() / "pairs" / f"edited.{suffix}" for suffix in ("dat", "mcm")]
    result = run(pair, output=tmp_path / "out", until=0.05)
    assert result["status"] == "done"
    assert (result["particles"], result["nodes"], result["elements"]) == (125, 121, 100)
    assert sorted(f.name for f in (tmp_path / "out").glob("*.pvd")) == [
        "elements.pvd", "mat01_block.pvd", "mat02_structure.pvd", "particles.pvd",
    ]  # fmt: skip


def test_a_killed_pair_goes_on_from_its_checkpoint(tmp_path: Path) -> None:
    """SIGKILL in the middle; --resume ends in the same state as an unbroken run.

    All by kernels from the cache: a process that compiles them may differ from one that loads them in a last digit.
    """
    pair = [str(root() / "pairs" / f"msh.{suffix}") for suffix in ("dat", "mcm")]
    run(pair, output=tmp_path / "compiled", until=0.01)
    command = [sys.executable, "-c", "from zrno.pipelines.cli import main; main()", "run", *pair]
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    subprocess.run([*command, "-o", str(whole)], check=True, capture_output=True)
    process = subprocess.Popen([*command, "-o", str(broken)], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    while process.poll() is None and not list(broken.glob("checkpoint_*.h5")):
        time.sleep(0.01)
    process.kill()
    process.wait()
    subprocess.run([*command, "-o", str(broken), "--resume"], check=True, capture_output=True)
    assert "resumed at t = " in (broken / "run.log").read_text()
    one, two = load(whole), load(broken)
    assert np.array_equal(one.times, two.times)
    last = len(one.times) - 1
    for series in ("particles", "elements"):
        first, second = one.arrays(series, last), two.arrays(series, last)
        for name, values in first.items():
            assert np.array_equal(values, second[name]), name
    for name, values in one.history.items():
        assert np.array_equal(values, two.history[name]), name
