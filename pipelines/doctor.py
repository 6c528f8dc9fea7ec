"""What this machine can do: drawing, meshing, threads, libraries; with a hint where something is missing."""

from __future__ import annotations

import importlib
import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib import metadata
from typing import Any

from zrno.pipelines import egl
from zrno.pipelines.version import git_hash, version

GMSH_INSTALL = (
    "apt-get install -y --no-install-recommends libgl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 libgomp1"
)
LAYERS = {name: f"numba.np.ufunc.{name}pool" for name in ("tbb", "omp")} | {"workqueue": "numba.np.ufunc.workqueue"}
LIBRARIES = ("numpy", "scipy", "numba", "h5py", "meshio", "gmsh", "vtk", "pyvista", "matplotlib", "pydantic", "typer")


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing looked at. hint: what to do where it is not ok; required: whether runs or pictures need it."""

    name: str
    ok: bool
    detail: str
    hint: str = ""
    required: bool = False


def examine() -> list[Finding]:
    """Look at this machine. What may crash (VTK without EGL, gmsh without X libraries) is tried in a child process."""
    commit = git_hash()
    return [
        Finding("zrno", True, version() + (f", commit {commit}" if commit else "")),
        Finding("python", True, f"{platform.python_version()} on {platform.platform()}"),
        _rendering(),
        _meshing(),
        _threads(),
        _films(),
        *map(_library, LIBRARIES),
    ]


def as_dict(findings: Sequence[Finding]) -> dict[str, Any]:
    """The JSON of `zrno doctor`."""
    return {"ok": all(f.ok for f in findings if f.required), "findings": [asdict(f) for f in findings]}


def doctor_text(findings: Sequence[Finding]) -> str:
    """A line a finding, a hint below where there is one."""
    lines = []
    for f in findings:
        lines.append(f"{'ok' if f.ok else 'MISSING' if f.required else 'absent':<8}{f.name + ':':<12}{f.detail}")
        lines += [f"{'':<8}{'':<12}{f.hint}"] if f.hint and not f.ok else []
    return "\n".join(lines)


def _rendering() -> Finding:
    ok = egl.can_draw()
    detail = "pictures without a screen, through EGL" if ok else "VTK cannot draw through EGL"
    return Finding("rendering", ok, detail, egl.INSTALL, required=True)


def _meshing() -> Finding:
    tried = subprocess.run([sys.executable, "-c", "import gmsh"], capture_output=True, text=True, check=False)
    if tried.returncode == 0:
        return Finding("meshing", True, "gmsh loads: .geo scripts can be meshed")
    last = (tried.stderr.strip().splitlines() or ["the process crashed"])[-1]
    return Finding("meshing", False, f"gmsh does not load ({last}); .msh files are read all the same", GMSH_INSTALL)


def _threads() -> Finding:
    import numba

    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    layers = [name for name, module in LAYERS.items() if _loads(module)]
    detail = f"{numba.get_num_threads()} of {usable} processors; layers: {', '.join(layers) or 'none'}"
    hint = "numba's wheel brings workqueue: reinstall it with pip install --force-reinstall numba"
    return Finding("threads", bool(layers), detail, hint, required=True)


def _loads(module: str) -> bool:
    try:
        importlib.import_module(module)
    except ImportError:  # also where the layer's own library is missing
        return False
    return True


def _films() -> Finding:
    found = shutil.which("ffmpeg")
    return Finding("films", found is not None, found or "no ffmpeg: no .mp4", "apt-get install -y ffmpeg")


def _library(name: str) -> Finding:
    try:
        return Finding(name, True, metadata.version(name), required=True)
    except metadata.PackageNotFoundError:
        return Finding(name, False, "not installed", f"pip install {name}", required=True)
