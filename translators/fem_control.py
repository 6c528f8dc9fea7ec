"""What rules a finite element run: the control cards of a .dat deck by the settings."""

from __future__ import annotations

from typing import Any

from zrno.translators.model import FemControl, Material, Model
from zrno.translators.settings import Settings

_LINEAR_LAWS = ("elastic", "orthotropic")
_KINEMATICS = {"total_lagrange": 2, "updated_lagrange": 3}
_METHODS = {"modified_newton": 1, "aitken": 2, "newton": 3, "line_search": 4, "bfgs": 5}
_SHELLS = {"isoparametric": 8, "bathe_dvorkin": 84}


def is_plastic(material: Material) -> bool:
    """Whether a law is not linear."""
    return material.law not in _LINEAR_LAWS


def native_of(family: str, plastic: bool, settings: Settings) -> dict[str, Any]:
    """What a group of elements is told beside its section, by PAK's names: kinematics, kind of shell, points."""
    fem = settings["fem"]
    native: dict[str, Any] = {"IATYP": _KINEMATICS.get(fem["kinematics"], int(plastic))}
    if family in ("solid", "plane") and fem["points"]:
        native["points"] = fem["points"]  # of a mixed part: its triangles and tetrahedra have their own
    if family == "shell":
        native["NGAUSZ"] = max(fem["thickness_points"], 5 if plastic else 2)
        native["quadrilaterals"] = _SHELLS[fem["shells"]]  # of a mixed part: its triangles have a type of their own
    return native


def is_linear(model: Model) -> bool:
    """Whether every group is linear, so that each step is a solution of its own."""
    return all(section.native.get("IATYP", 0) == 0 for section in model.sections.values())


def control_of(model: Model, settings: Settings) -> FemControl:
    """The control cards that the settings ask for."""
    fem, end = settings["fem"], settings["end_time"]
    energy, force = fem["energy_tolerance"], fem["force_tolerance"]
    return FemControl(
        dynamic=int(fem["analysis"] == "dynamic"),
        eigenvalues=int(fem["analysis"] == "eigenvalues"),
        eigen_count=fem["eigenvalues"],
        periods=[(fem["steps"], end / fem["steps"])],
        mass={"consistent": 1, "lumped": 2}[fem["mass"]],
        iteration=1 if is_linear(model) else _METHODS[fem["method"]],
        max_iterations=fem["max_iterations"],
        converge_on=(int(energy > 0), int(force > 0), 0),
        tolerances=(energy, force, 0.0, 1e-7),
    )
