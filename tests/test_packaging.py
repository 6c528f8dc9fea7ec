"""What is installed is what stands in the repository."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
TREES = ("translators", "solvers", "pipelines", "samples")


def _setuptools() -> dict[str, object]:
    with (ROOT / "pyproject.toml").open("rb") as file:
        tool = tomllib.load(file)["tool"]["setuptools"]
    assert isinstance(tool, dict)
    return tool


def test_the_package_list_names_every_folder() -> None:
    folders = {init.parent.relative_to(ROOT) for tree in TREES for init in (ROOT / tree).rglob("__init__.py")}
    expected = {"zrno." + ".".join(folder.parts): str(folder) for folder in folders}
    tool = _setuptools()
    assert sorted(tool["packages"]) == sorted(expected)  # type: ignore[call-overload]
    assert tool["package-dir"] == expected


def test_every_python_file_is_in_a_package() -> None:
    files = {path.parent for tree in TREES for path in (ROOT / tree).rglob("*.py")}
    assert [str(folder) for folder in files if not (folder / "__init__.py").exists()] == []


def test_package_data_takes_every_file_of_the_samples() -> None:
    patterns = _setuptools()["package-data"]["zrno.samples"]  # type: ignore[index]
    tracked = subprocess.run(
        ["git", "-C", str(ROOT), "ls-files", "samples"], capture_output=True, text=True, check=False
    ).stdout.split()
    if not tracked:
        pytest.skip("not a git checkout")
    shipped = {path for pattern in patterns for path in (ROOT / "samples").glob(pattern)}
    assert [name for name in tracked if not name.endswith(".py") and ROOT / name not in shipped] == []


@pytest.mark.parametrize("package", ["translators", "solvers", "pipelines"])
def test_a_bare_import_is_refused(package: str) -> None:
    spec = importlib.util.spec_from_file_location(package, ROOT / package / "__init__.py")
    assert spec is not None
    assert spec.loader is not None
    with pytest.raises(ImportError, match=f"zrno.{package}"):
        spec.loader.exec_module(importlib.util.module_from_spec(spec))


def test_importing_the_packages_loads_nothing_heavy() -> None:
    code = (
        "import sys, zrno.translators, zrno.solvers, zrno.pipelines, zrno.pipelines.cli;"
        "print([m for m in ('numpy', 'numba', 'vtk', 'vtkmodules', 'pyvista', 'gmsh', 'scipy', 'h5py', 'matplotlib',"
        " 'meshio', 'pydantic', 'rich') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
