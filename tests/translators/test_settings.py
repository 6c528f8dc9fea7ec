from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from zrno.translators.setting_table import TABLE
from zrno.translators.setting_types import Group
from zrno.translators.settings import defaults, help_settings, load
from zrno.translators.text import InputError

PLATE = "materials: {plate: {density: 1, E: 1, nu: 0.3}}\n"


def test_the_help_is_the_defaults() -> None:
    shown = yaml.safe_load(help_settings())
    assert list(shown) == [item.key for item in TABLE]
    for item in TABLE:
        if isinstance(item, Group):
            values = shown[item.key]["NAME"] if item.named else shown[item.key]
            assert list(values) == [below.key for below in item.items]
        else:
            assert item.parse(shown[item.key]) == defaults()[item.key]


def test_the_help_is_a_settings_file(tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(help_settings().replace("NAME", "plate"))
    settings = load(tmp_path / "s.yaml")
    assert settings["materials"]["plate"]["E"] is None
    assert {key: settings[key] for key in ("viscosity", "friction")} == {
        key: defaults()[key] for key in ("viscosity", "friction")
    }


def test_values_and_defaults(tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("end_time: 1e-2\ngravity: [0, -9.81, 0]\nxsph: true\n" + PLATE)
    settings = load(tmp_path / "s.yaml")
    assert (settings["end_time"], settings["gravity"], settings["xsph"]) == (0.01, (0.0, -9.81, 0.0), True)
    assert settings["h_factor"] == 1.2
    assert settings["materials"]["plate"]["beta"] is None
    places = [settings.place("materials", "plate", key) for key in ("E", "beta")]
    assert [(place.line, place.column) for place in places] == [(4, 33), (4, 13)]


def test_overrides_are_stronger(tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(PLATE)
    settings = load(
        tmp_path / "s.yaml", overrides={"materials.plate.E": 7, "viscosity.linear": 0.5, "gravity": [1, 2, 3]}
    )
    assert settings["materials"]["plate"]["E"] == 7.0
    assert settings["materials"]["plate"]["nu"] == 0.3
    assert settings["viscosity"]["linear"] == 0.5
    assert settings["gravity"] == (1.0, 2.0, 3.0)
    with pytest.raises(InputError, match=r"unknown key end_tme \(end_tme\); expected end_time \(did you mean that"):
        load(overrides={"end_tme": 1})


def test_empty_and_missing_files(faults, tmp_path: Path) -> None:
    assert load()["end_time"] == 1.0
    (tmp_path / "s.yaml").write_text("# nothing but a comment\n")
    assert load(tmp_path / "s.yaml")["end_time"] == 1.0
    with pytest.raises(InputError, match="no such file"):
        load(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("end_tim: 3\n", "s.yaml:1:1: error: unknown key end_tim (end_tim); expected end_time (did you"),
        ("step_option: 7\n", "s.yaml:1:14: error: step_option is not what it should be (7); expected one of 0, 1, 2"),
        ("step_option: true\n", "(true); expected one of 0, 1, 2"),
        ("end_time: .inf\n", "(.inf); expected a number of at least 0"),
        ("end_time: true\n", "(true); expected a number"),
        ("end_time: 1\nend_time: 2\n", "s.yaml:2:1: error: the key stands twice (end_time)"),
        (f"end_time: {'9' * 400}\n", "expected a number of at least 0"),
        ("h_factor: 0\n", "expected a number above 0"),
        (
            "gravity: [1, 2]\n",
            "s.yaml:1:10: error: gravity is not what it should be ([1, 2]); expected a list of three",
        ),
        ("gravity: [1, 2, x]\n", "expected a list of three numbers"),
        ("viscosity: 3\n", "s.yaml:1:12: error: viscosity is not a mapping (3)"),
        ("materials: 3\n", "materials is not a mapping (3); expected the name of a part"),
        ("materials: {a: 3}\n", "s.yaml:1:16: error: materials.a is not a mapping (3)"),
        ("- 1\n", "s.yaml:1:1: error: the file is not a mapping"),
        ("a: [1\n", "s.yaml:2:1: error: not YAML"),
        ("a: \x00\n", "s.yaml:1:1: error: not YAML"),
        ("friction: {static: 0.1}\n", "friction.kinetic is missing"),
        (
            "friction: {static: 0.1, kinetic: 0.2}\n",
            "s.yaml:1:25: error: friction.kinetic is above friction.static (0.2)",
        ),
        (PLATE.replace("0.3", "0.5"), "materials.plate.nu is too large (0.5); expected less than 0.5"),
        (PLATE.replace("0.3", "0.3, bc: zx"), "(zx); expected one of"),
    ],
)
def test_faults(faults, text: str, said: str) -> None:
    lines = faults(load, text, name="s.yaml")
    assert any(said in line for line in lines), lines


def test_all_faults_are_said(faults) -> None:
    text = "end_tim: 3\nstep_option: 7\nviscosity: {a: 1}\nkernel: cubic_spline\nkernel: other\n"
    assert len(faults(load, text, name="s.yaml")) == 5
