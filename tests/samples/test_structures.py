"""The samples of structures: their scenes from mesh to result, against their references."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from zrno.pipelines import load, run
from zrno.pipelines.measures import Cloud, at
from zrno.pipelines.samples import copy


def _moved(name: str, folder: Path, scene: str, point: tuple[float, float, float], field: str) -> float:
    copy(name, folder / name)
    result = run([folder / name / scene], output=folder / "out", options={"render": []})
    assert result["status"] == "done"
    assert result["energy"]["balance_error"] < 0.005
    return at(Cloud(load(folder / "out").arrays()), point=point, field=field)


def test_scordelis_lo(tmp_path: Path) -> None:
    edge = (16.0697, 0.0, 19.1511)
    deflection = _moved("scordelis_lo", tmp_path, "scene.yaml", edge, "displacement_z")
    assert deflection == pytest.approx(-0.3024, rel=0.005)
    history = load(tmp_path / "out").history
    assert history["reaction_z"][-1] == pytest.approx(90.0 * 25.0 * 25.0 * np.radians(40.0), rel=0.002)
    names = load(tmp_path / "out").series
    assert names == ["elements", "mat01"]  # a .dat deck has no names


def test_hemisphere(tmp_path: Path) -> None:
    out = _moved("hemisphere", tmp_path, "scene.yaml", (10.0, 0.0, 0.0), "displacement_x")
    assert out == pytest.approx(0.0940, rel=0.01)


def test_hemisphere_in_large_displacement(tmp_path: Path) -> None:
    pinched = _moved("hemisphere", tmp_path, "large.yaml", (10.0, 0.0, 0.0), "displacement_x")
    assert pinched == pytest.approx(-5.90, rel=0.01)
    pulled = at(Cloud(load(tmp_path / "out").arrays()), point=(0.0, 10.0, 0.0), field="displacement_y")
    assert pulled == pytest.approx(3.41, rel=0.01)


def test_thick_cylinder(tmp_path: Path) -> None:
    outside = _moved("thick_cylinder", tmp_path, "scene.yaml", (200.0, 0.0, 0.0), "displacement_x")
    assert outside == pytest.approx(0.15330, rel=0.006)
    frames = load(tmp_path / "out")
    at_120 = at(Cloud(frames.arrays(None, 12)), point=(200.0, 0.0, 0.0), field="displacement_x")
    assert frames.times[12] == pytest.approx(120.0)
    assert at_120 == pytest.approx(0.07040330516559817, rel=0.006)


def test_le11(tmp_path: Path) -> None:
    assert _moved("le11", tmp_path, "scene.yaml", (1.0, 0.0, 0.0), "stress_zz") == pytest.approx(-105e6, rel=0.01)


def test_plate(tmp_path: Path) -> None:
    clamped = _moved("plate", tmp_path / "clamped", "scene.yaml", (0.0, 0.0, 0.0), "displacement_z")
    assert clamped == pytest.approx(-0.6579664, rel=1e-3)
    assert load(tmp_path / "clamped/out").history["reaction_z"][-1] == pytest.approx(2.5, rel=1e-7)
    held = _moved("plate", tmp_path / "supported", "supported_scene.yaml", (0.0, 0.0, 0.0), "displacement_z")
    assert held == pytest.approx(-2.11224, rel=5e-4)


def test_elastoplastic_bar(tmp_path: Path) -> None:
    _moved("elastoplastic_bar", tmp_path, "pulled_scene.yaml", (0.0, 0.0, 0.0), "displacement_x")
    strain = (2.1e5 * 0.01 - 250.0) / (2.1e5 + 2000.0)
    assert _root_force(tmp_path / "out", 0) == pytest.approx(-100.0 * (250.0 + 2000.0 * strain), rel=1e-6)
    options = {"numbers.n": 2, "fem.dilatation": "plain", "render": []}
    run([tmp_path / "elastoplastic_bar/scene.yaml"], output=tmp_path / "bent", options=options)
    assert _root_force(tmp_path / "bent", 2) == pytest.approx(1285.292, rel=2e-6)  # CalculiX 2.20, C3D8, same mesh


def _bearing(folder: Path, frame: int, cohesion: float) -> float:
    """Load under the footing's half over its cohesion."""
    arrays = load(folder).arrays(None, frame)
    place = Cloud(arrays).x - arrays["displacement"]
    under = (np.abs(place[:, 1]) < 1e-6) & (place[:, 0] < 1.0 + 1e-6)
    return -float(arrays["reaction"][under, 1].sum()) / cohesion


def test_strip_footing(tmp_path: Path) -> None:
    """Prandtl's c Nc, from above, on elements of four nodes with mean dilatation; it flows."""
    copy("strip_footing", tmp_path / "sample")
    options = {"numbers.linear": 1, "fem.dilatation": "mean", "output.every": 0.5, "render": []}
    result = run([tmp_path / "sample/scene.yaml"], output=tmp_path / "out", options=options)
    assert result["status"] == "done"
    bearing = [_bearing(tmp_path / "out", k, 490e3) for k in (1, 2)]
    assert np.pi + 2 < bearing[1] < 1.03 * (np.pi + 2)
    assert bearing[1] == pytest.approx(bearing[0], rel=2e-3)


@pytest.mark.parametrize("points", [2, 3])
def test_strip_footing_with_friction(tmp_path: Path, points: int) -> None:
    """Prandtl's 14.83 for phi 20, from above; with the deck's own 3 x 3 points too, which are stiffer."""
    sample = copy("strip_footing", tmp_path / "sample")
    settings = (sample / "friction_soil.yaml").read_text()
    assert "points: 2}" in settings
    (sample / "friction_soil.yaml").write_text(settings.replace("points: 2}", f"points: {points}}}"))
    options = {"output.every": 0.5, "render": []}
    result = run([sample / "friction.yaml"], output=tmp_path / "out", options=options)
    assert result["status"] == "done"
    bearing = [_bearing(tmp_path / "out", k, 490e3) for k in (1, 2)]
    assert 14.8347 < bearing[1] < 14.8347 * (1.015 if points == 2 else 1.025)
    assert bearing[1] == pytest.approx(bearing[0], rel=2e-3)


@pytest.mark.slow
def test_strip_footing_with_a_cap(tmp_path: Path) -> None:
    """Softer than without a cap, then between the limits of associated flow and of flow without dilation."""
    sample = copy("strip_footing", tmp_path / "sample")
    result = run([sample / "cap.yaml"], output=tmp_path / "out", options={"output.every": 0.25, "render": []})
    assert result["status"] == "done"
    bearing = [_bearing(tmp_path / "out", k, 10e3) for k in (1, 2, 3, 4)]
    assert bearing == pytest.approx([10.25, 13.13, 13.98, 14.08], rel=5e-3)
    assert 13.0 < bearing[3] < 14.8347


def _pressed(rate: float, end: float, steps: int) -> float:
    """Stress of one element of the sample's visco-plastic law under a rate of axial strain, its sides free."""
    young, k, slope, flow, gamma, hardening = 1000.0, 0.05, 0.05, 0.01, 0.01, 20.0
    along, up = 1.0 / np.sqrt(3.0) - flow, 1.0 / np.sqrt(3.0) - slope
    stress, kappa, dt = 0.0, 0.0, end / steps
    for _ in range(steps):
        stress -= young * rate * dt
        over = -up * stress - k - hardening * kappa
        if over > 0.0:
            grown = gamma * dt / k * over / (1.0 + gamma * dt / k * (along * young * up + hardening))
            kappa += grown
            stress += young * grown * along
    return stress


def test_asphalt(tmp_path: Path) -> None:
    sample = copy("asphalt_slab", tmp_path / "sample")
    run([sample / "block_scene.yaml"], output=tmp_path / "block", options={"render": []})
    frames = load(tmp_path / "block")
    for k in (4, 10, 20):
        found = frames.arrays(None, k)["stress"][:, 2]
        np.testing.assert_allclose(found, _pressed(0.01, frames.times[k], 5000), rtol=2e-4)
    result = run([sample / "scene.yaml"], output=tmp_path / "out", options={"numbers.n": 4, "render": []})
    assert result["energy"]["balance_error"] < 0.01
    frames = load(tmp_path / "out")
    ruts = [at(Cloud(frames.arrays(None, 4 * k)), point=(0.0, 100.0, 0.0), field="displacement_y") for k in range(11)]
    grown = -np.diff(ruts)
    assert grown[0] > 0.02
    assert (grown[1:] < grown[:-1]).all()
    assert (grown > 0.0).all()


def _root_force(folder: Path, axis: int) -> float:
    frame = load(folder).arrays()
    place = Cloud(frame).x - frame["displacement"]
    return float(frame["reaction"][np.abs(place[:, 0]) < 1e-6, axis].sum())
