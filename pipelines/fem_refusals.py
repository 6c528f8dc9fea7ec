"""What a finite element deck asks and is not computed, each with its place; and the laws of its groups."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from zrno.pipelines.fem_method import Fem
from zrno.pipelines.laws import overstress_of, structural_law_of
from zrno.solvers.errors import Unsupported
from zrno.solvers.materials import axes_of
from zrno.translators.model import Material, Model, Section
from zrno.translators.text import Fault

_SHELLS = ("tri3", "quad4", "quad8", "quad9")
_COMPUTED = ("solid", "plane", "truss", "beam", "shell", "spring", "mass")


def refusals(model: Model, path: str, method: Fem) -> list[Fault]:
    """What a deck asks and is not computed, each with its place. path: of the deck; method: the scene's."""
    control = model.fem_control
    assert control is not None
    known = ", ".join(map(str, model.materials))
    faults = [
        Fault(path, 1, 1, "fem.laws: no such material", str(number), known)
        for number in method.laws
        if number not in model.materials
    ]
    if method.integration != "deck" and not control.dynamic:
        message = "fem.integration is of motion, and the deck is static"
        faults.append(Fault(path, 1, 1, message, method.integration, "a dynamic analysis (NDIN 1)"))
    central = method.integration == "central" or (method.integration == "deck" and control.integration == 3)
    if control.dynamic and not control.eigenvalues and central and control.damping == 3 and control.rayleigh[1]:
        message = "damping by the stiffness in explicit steps is not computed"
        faults.append(Fault(path, 1, 1, message, f"BETAK {control.rayleigh[1]:g}", "damping by the mass, or newmark"))
    for part in model.parts.values():
        section = model.sections.get(part.section or -1)
        line = section.source.line if section and section.source else 1
        if section and section.kind not in _COMPUTED:
            faults.append(Fault(path, line, 1, f"elements of the family {section.kind} are not computed yet", "",
                                ", ".join(_COMPUTED)))  # fmt: skip
        material = model.materials.get(part.material or -1)
        if material is None:
            continue
        at = material.source.line if material.source else 1
        try:
            law_of_group(model, material, None if section is None else axes_of_group(section), method)
        except (Unsupported, ValueError) as error:
            known = "constant E, nu and expansion" if material.native.get("MOD") == 3 else "a law that is computed"
            faults.append(Fault(path, at, 1, f"material {material.id}: {error}", "", known))
    moving = control.dynamic or control.eigenvalues or control.iteration >= 60
    for block in model.blocks:
        timed = [name for name in ("birth", "death") if np.any(block.data.get(name, 0.0))]
        if timed and moving:
            said = f"{' and '.join(timed)} of {block.kind} elements in motion, vibration or on a path that is found"
            faults.append(Fault(path, 1, 1, f"{said} is not computed", "", "statics with loads that are given"))
        if block.family == "shell" and block.kind not in _SHELLS:
            message = f"shells of the kind {block.kind} are not computed yet"
            faults.append(Fault(path, 1, 1, message, "", "three, four, eight or nine nodes"))
    for load in model.face_loads:
        if load.native.get("IPRAV") == -1:
            at = load.source.line if load.source else 1
            faults.append(Fault(path, at, 1, "shear along edges is not computed: its sign is not known", "IPRAV -1",
                                "pressure, or forces on nodes"))  # fmt: skip
    faults += _of_heat(model, path)
    if control.restart == 1:
        faults.append(Fault(path, 1, 1, "a restart of PAK's own files is not read", "IREST 1", "--resume"))
    return list(dict.fromkeys(faults))


def heated(model: Model) -> bool:
    """Whether temperatures are given to a material that expands by them."""
    given = any(load.kind == "temperature" for load in model.nodal_loads)
    return given and any(material.parameters.get("expansion") for material in model.materials.values())


def _of_heat(model: Model, path: str) -> list[Fault]:
    """Temperatures where expansion is not computed."""
    control = model.fem_control
    assert control is not None
    if not heated(model):
        return []
    at = next((a.source.line for a in model.nodal_loads if a.kind == "temperature" and a.source), 1)
    faults = []
    central = control.dynamic and control.integration == 3
    if central or control.eigenvalues or control.iteration >= 60:
        faults.append(Fault(path, at, 1, "temperatures in vibration, in explicit steps or on a path that is found are "
                            "not computed", "", "implicit steps with loads that are given"))  # fmt: skip
    for block in model.blocks:
        materials = [model.materials.get(model.parts[part].material or -1) for part in np.unique(block.part).tolist()]
        if not any(m is not None and m.parameters.get("expansion") for m in materials):
            continue
        if any(np.any(block.data.get(name, 0.0)) for name in ("birth", "death")):
            message = f"{block.kind} elements that expand with temperature and are born or die are not computed"
            faults.append(Fault(path, at, 1, message, "", "elements that are there in all steps"))
    return faults


def law_of_group(model: Model, material: Material, axes: Any, method: Fem) -> Any:
    """The law of a group's material: what the scene says, or the deck's."""
    said = method.laws.get(material.id)
    return structural_law_of(material, model.curves, axes) if said is None else overstress_of(material, said)


def axes_of_group(section: Section) -> Any:
    """Axes of the material of a group: of solids by its card, of plane elements by its angle BETA; None without."""
    if "axes" in section.native and any(section.native["axes"]):
        axes = section.native["axes"]
        return axes_of(axes[:3], axes[3:])
    if section.kind == "plane" and (angle := math.radians(section.native.get("BETA", 0.0))):
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return None
