"""Grain in an elastic silo: what the floor and the walls get, against the weight of a column."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.samples import copy

RHO_G = 2.099e-3 * 0.00981


@pytest.mark.slow
def test_walls_and_floor_bear_the_weight_of_the_grain(tmp_path: Path) -> None:
    folder = tmp_path / "silo"
    copy("hopper_load", folder)
    run([folder / "scene.yaml"], output=folder / "out", options={"render": []})
    found = load(folder / "out")
    nodes = found.arrays("elements", len(found.times) - 1)
    force = nodes["contact_force"]
    weight = RHO_G * 48.0**2 * 240.0
    assert -force[:, 2].sum() == pytest.approx(weight, rel=5e-3)
    assert force.sum(axis=0)[2] == pytest.approx(found.history["structure_force_z"][-1], rel=1e-6)
    start = nodes["position"] - nodes["displacement"]
    walls = start[:, 2] > 1.0
    assert 0.02 * weight < -force[walls, 2].sum() < 0.4 * np.abs(force[walls, :2]).sum()


def of_yielding_grain(friction: float, phi: float) -> float:
    """Wall pressure over vertical stress where grain yields and slips along the wall: Walker (1966)."""
    along = np.arctan(friction)
    c = np.sin(phi) * np.cos(np.arcsin(np.sin(along) / np.sin(phi)) - along)
    return float((1.0 - c) / (1.0 + c))


@pytest.mark.slow
def test_the_walls_bear_what_janssen_says(tmp_path: Path) -> None:
    """While the floor sinks: the mean of 51 frames in half a second, some seven swings of the column."""
    friction, radius, ring = 0.4, 16.0, 32.0  # radius: area over perimeter
    folder = tmp_path / "silo"
    copy("hopper_load", folder)
    run([folder / "janssen.yaml"], output=folder / "out", options={"render": []})
    found = load(folder / "out")
    frames = np.flatnonzero(np.array(found.times) > 499.0)
    assert len(frames) == 51
    nodes = [found.arrays("elements", k) for k in frames]
    grain = [found.arrays("particles", k) for k in frames]
    force = np.mean([n["contact_force"] for n in nodes], axis=0)
    x = nodes[0]["position"] - nodes[0]["displacement"]
    wall = nodes[0]["displacement"][:, 2] > -0.1  # the floor has sunk by more
    weight = grain[0]["mass"].sum() * 0.00981
    assert -force[:, 2].sum() == pytest.approx(weight, rel=5e-3)
    half = 0.5 * (grain[0]["mass"] / grain[0]["density"]).mean() ** (1 / 3)
    top = np.mean([g["position"][:, 2].max() for g in grain]) + half
    length = radius / (friction * of_yielding_grain(friction, np.radians(30.0)))

    def to(depth: float) -> float:  # what the wall presses on each mm of its breadth, from the top down to a depth
        return RHO_G * radius / friction * (depth - length * (1.0 - np.exp(-depth / length)))

    pressure = np.abs(force[:, :2]).sum(axis=1)
    rubbed = -force[wall, 2].sum()
    assert rubbed / pressure[wall].sum() == pytest.approx(friction, rel=0.02)
    assert rubbed / weight == pytest.approx(friction * to(top - 0.5) / (RHO_G * radius * (top - 0.5)), rel=0.03)
    for low in np.arange(30.0, 222.0, ring):  # not the rings at the floor and at the top
        rows = wall & (x[:, 2] > low) & (x[:, 2] < low + ring)
        wanted = (to(top - low) - to(top - low - ring)) / ring
        assert pressure[rows].sum() / (2.0 * 32.0 * ring) == pytest.approx(wanted, rel=0.05)
