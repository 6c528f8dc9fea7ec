"""What the doctor finds, and says of what is missing."""

from __future__ import annotations

import subprocess
import sys

import pytest

from zrno.pipelines import cli, doctor, egl


def test_findings_name_what_was_looked_at() -> None:
    findings = {f.name: f for f in doctor.examine()}
    assert {"zrno", "python", "rendering", "meshing", "threads", "films", "numba", "vtk"} <= set(findings)
    assert findings["threads"].ok
    assert "workqueue" in findings["threads"].detail
    assert findings["numpy"].detail == __import__("numpy").__version__


def test_missing_egl_is_exit_code_3_with_the_line_to_run(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(egl, "can_draw", lambda: False)
    monkeypatch.setattr(sys, "argv", ["zrno", "doctor"])
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert stop.value.code == 3
    assert egl.INSTALL in capsys.readouterr().out
    assert not doctor.as_dict(doctor.examine())["ok"]


def test_a_crash_of_gmsh_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    crash = subprocess.CompletedProcess([], -11, "", "")
    monkeypatch.setattr(subprocess, "run", lambda *_args, **_kwargs: crash)
    found = doctor._meshing()
    assert not found.ok
    assert "the process crashed" in found.detail
    assert "libglu1-mesa" in found.hint


def test_what_is_optional_fails_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda _name: None)
    found = doctor._films()
    assert (found.ok, found.required) == (False, False)
    assert doctor.as_dict([found])["ok"]
    text = doctor.doctor_text([found])
    assert text.startswith("absent")
    assert found.hint in text
