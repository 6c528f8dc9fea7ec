"""The repository's own commands: ./demo, ./test, .ci/run and the bootstrap below them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SCRIPTS = ("demo", "test", ".ci/run", ".ci/bootstrap")


def _fake_python(path: Path, version: str) -> None:
    """A python that says it has a version, and can do nothing else."""
    path.write_text(f'#!/bin/sh\n[ "$1" = --version ] && echo Python {version} && exit 0\nexit 1\n')
    path.chmod(0o755)


def _clone(folder: Path) -> Path:
    """What the bootstrap needs of the repository, in a fresh folder."""
    (folder / ".ci").mkdir(parents=True)
    shutil.copy(ROOT / ".ci" / "bootstrap", folder / ".ci" / "bootstrap")
    shutil.copy(ROOT / "pyproject.toml", folder / "pyproject.toml")
    return folder


@pytest.mark.parametrize("name", SCRIPTS)
def test_scripts_are_posix_shell_and_can_be_run(name: str) -> None:
    script = ROOT / name
    assert script.read_text().startswith("#!/bin/sh\n")
    assert os.access(script, os.X_OK)
    subprocess.run(["sh", "-n", str(script)], check=True)


def test_bootstrap_says_that_python_is_too_old(tmp_path: Path) -> None:
    clone = _clone(tmp_path / "clone")
    programs = tmp_path / "bin"
    programs.mkdir()
    for name in ("python3", "python3.11"):
        _fake_python(programs / name, "3.9.2")
    path = f"{programs}:/usr/bin:/bin"
    environment = {"PATH": path, "PYTHON": "python3"}
    done = subprocess.run(
        ["sh", ".ci/bootstrap"], cwd=clone, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "3.11, 3.12 or 3.13" in done.stderr
    assert "Python 3.9.2" in done.stderr
    assert not (clone / ".venv").exists()


def test_bootstrap_ends_at_once_when_its_stamp_is_right(tmp_path: Path) -> None:
    clone = _clone(tmp_path / "clone")
    programs = clone / ".venv" / "bin"
    programs.mkdir(parents=True)
    (programs / "python").symlink_to(sys.executable)
    (programs / "zrno").symlink_to("/bin/true")
    files = (clone / "pyproject.toml").read_bytes() + (clone / ".ci" / "bootstrap").read_bytes()
    total = subprocess.run(["cksum"], input=files, capture_output=True, check=True).stdout.decode().strip()
    python = subprocess.run([sys.executable, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    (clone / ".venv" / "stamp").write_text(f"{total} {python} {clone}")
    done = subprocess.run(["sh", ".ci/bootstrap"], cwd=clone, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_bootstrap_prints_the_line_to_run_where_it_may_not_install(tmp_path: Path) -> None:
    clone = _clone(tmp_path / "clone")
    programs = tmp_path / "bin"
    programs.mkdir()
    for name, body in {"id": "echo 1000", "dpkg-query": "exit 1"}.items():
        (programs / name).write_text(f"#!/bin/sh\n{body}\n")
        (programs / name).chmod(0o755)
    environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}", "PYTHON": sys.executable}
    done = subprocess.run(
        ["sh", ".ci/bootstrap"], cwd=clone, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 3
    assert "sudo apt-get install -y --no-install-recommends libegl1 libgl1-mesa-dri" in done.stderr
    assert not (clone / ".venv").exists()
