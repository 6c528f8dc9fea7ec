"""From a mesh and settings to a finite element model: what `zrno convert` does before it writes a .dat deck."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators import fem_loads, held
from zrno.translators.conditions import InitialVelocity
from zrno.translators.convert import equation_of
from zrno.translators.elements import TABLE
from zrno.translators.fem_control import control_of, is_plastic, native_of
from zrno.translators.law_maps import as_known
from zrno.translators.laws import LAWS
from zrno.translators.materials import materials_of, settings_of
from zrno.translators.model import PARTICLE_FAMILIES, ElementBlock, Material, Model, Section
from zrno.translators.particles import chosen_parts
from zrno.translators.report import Report
from zrno.translators.rewire import keep_parts
from zrno.translators.sections import thickness_of
from zrno.translators.settings import Settings

_FAMILIES = ("solid", "shell", "plane", "beam", "truss")  # that a .dat deck can say
_FIRST_ORDER = {"wedge15": "wedge6", "wedge18": "wedge6", "pyramid13": "pyramid5"}
_BENDING = ("shell", "beam")  # with rotations at their nodes
_LAWS: dict[str, tuple[str, ...]] = {  # of a .dat deck, with the parameters that its cards have
    "elastic": ("E", "nu"),
    "thermo_elastic": tuple(LAWS["thermo_elastic"].parameters),
    "orthotropic": tuple(LAWS["orthotropic"].parameters),
    "von_mises": ("E", "nu", "yield_stress", "tangent_modulus", "beta"),
    "von_mises_power": ("E", "nu", "yield_stress", "Cy", "n", "M"),
    "cap": ("K", "G", "alpha", "beta", "gamma", "theta", "R", "D", "W", "X0", "tension_cutoff"),
    "drucker_prager": ("E", "nu", "k", "alpha", "tension_cutoff", "X0", "W", "D", "R"),
    "mohr_coulomb": ("E", "nu", "c", "phi", "psi"),
    "cam_clay": tuple(LAWS["cam_clay"].parameters),
}


def to_fem(model: Model, settings: Settings) -> tuple[Model, Report]:
    """Make a finite element model of a mesh, as a .dat deck can say it.

    Each part keeps its material, by a law of the deck, and gets a section; what holds nodes goes to the node cards;
    loads and motions get functions of time; the settings say what the mesh does not, and overrule it.
    Raises InputError for settings that the mesh cannot take, ValueError for a mesh that cannot become a deck.
    """
    report = Report()
    if settings["dimension"] is not None:  # a flat mesh may be a plate in space
        model = replace(model, dimension=settings["dimension"])
    blocks = _blocks(model, report)
    if not blocks:
        raise ValueError("the mesh has no elements that a .dat deck can say")
    whole = replace(model, blocks=blocks)
    chosen = chosen_parts(whole)
    massless = settings["fem"]["analysis"] == "static" and not model.body_loads and not any(settings["gravity"])
    materials = materials_of(whole, chosen, settings, report, massless=massless)
    chosen = _with_laws(whole, chosen, materials, report)
    target = keep_parts(whole, np.array(chosen))
    target.warnings, target.format, target.version = [], "pak", ""
    target.materials = {}
    for part in chosen:
        own = materials[part]
        target.materials[own.id] = own
        target.parts[part] = replace(target.parts[part], material=own.id, native={})
    _sections(target, settings)
    target.fixed = _fixed(target, settings, report)
    _velocities(target, settings)
    fem_loads.of_settings(target, settings)
    fem_loads.as_the_deck_says(target, settings, report)
    target.fem_control = control_of(target, settings)
    _report_lost(model, target, report)
    return target, report


def _blocks(model: Model, report: Report) -> list[ElementBlock]:
    """The blocks that a deck can say, each with its family; the others are reported."""
    kept = []
    for given in model.blocks:
        block = given
        family = block.family or _family(model, block)
        if family == "tshell":
            report.approximate(f"thick shells ({block.kind})", len(block.ids), "written as solids")
            family = "solid"
        if block.kind in _FIRST_ORDER:
            what = f"{block.kind} elements"
            report.approximate(what, len(block.ids), "of first order: a .dat deck has no others of this shape")
            kind = _FIRST_ORDER[block.kind]
            block = replace(block, kind=kind, nodes=block.nodes[:, : TABLE[kind].nodes])
        mine = np.isin(block.part, list(model.parts))
        if family in PARTICLE_FAMILIES:
            report.drop("particles", len(block.ids), "a .dat deck has none: write them to an .mcm deck")
        elif family not in _FAMILIES:
            report.drop(f"{family or block.kind} elements", len(block.ids), "a .dat deck has none")
        elif not mine.any():
            report.drop(f"{block.kind} elements", len(block.ids), "of lower dimension than the parts")
        else:
            kept.append(replace(block, family=family))
    return kept


def _family(model: Model, block: ElementBlock) -> str:
    """What elements are whose source does not say: by their dimension, in a plane or in space."""
    dimension = TABLE[block.kind].dimension
    return ("", "truss", "plane" if model.dimension == 2 else "shell", "solid")[dimension]


def _with_laws(model: Model, chosen: list[int], materials: dict[int, Material], report: Report) -> list[int]:
    """The parts whose law the deck has, or one near it, which then stands in `materials`; the others are dropped."""
    kept: list[int] = []
    used: dict[int, tuple[str, float, dict[str, float]]] = {}
    for part in chosen:
        own = materials[part]
        eos = equation_of(model, part, own)
        takes = dict(_LAWS)
        if own.law == "von_mises" and own.parameters.get("beta", 1.0) != 1.0:
            del takes["von_mises"]  # PAK's bilinear law hardens isotropically; its power law does as beta says
        nearest = as_known(own, takes, model.curves, eos, report)
        name = model.parts[part].name or str(part)
        if nearest is None:
            count = sum(int((block.part == part).sum()) for block in model.blocks)
            report.drop(f"elements of part {name}", count, f"a .dat deck has no law like {own.law or 'its material'}")
            continue
        said = (nearest.law, nearest.density, nearest.parameters)
        key = nearest.id if used.setdefault(nearest.id, said) == said else max(used) + 1  # the settings of one part
        used[key] = said
        materials[part] = replace(nearest, id=key, eos=None, native={})
        kept.append(part)
    if not kept:
        laws = ", ".join(sorted({materials[part].law or "none known" for part in chosen}))
        raise ValueError(f"no part is left: a .dat deck has no law like {laws}; settings `materials` can give one")
    return kept


def _sections(target: Model, settings: Settings) -> None:
    """A section for each part, with what its family needs; parts of one section keep it together."""
    made: dict[int, Section] = {}
    numbers: dict[tuple[Any, ...], int] = {}
    parts = dict(target.parts)
    for number, part in target.parts.items():
        families = {block.family for block in target.blocks if (block.part == number).any()}
        own = target.sections.get(part.section or 0)
        for family in sorted(families):
            parameters = {} if own is None else dict(own.parameters)
            plane = own.plane if own is not None and own.plane else "strain"
            if family == "shell" and not _own_thickness(target, number):
                parameters["thickness"] = thickness_of(target, number, settings)
            elif family == "plane":
                entry = settings_of(settings, target, number)[1]
                thickness = entry["thickness"] if entry and entry["thickness"] else parameters.get("thickness")
                parameters["thickness"] = thickness or 1.0
            elif family in ("truss", "beam"):
                parameters["area"] = _area(target, number, parameters, settings)
            plane = plane if family == "plane" else ""
            plastic = is_plastic(target.materials[part.material or 0])
            key = (family, tuple(sorted(parameters.items())), plane, plastic)
            section = numbers.setdefault(key, len(numbers) + 1)
            made[section] = Section(
                section, own.name if own else part.name, family, parameters, plane, native_of(family, plastic, settings)
            )
            parts[number] = replace(part, section=section)
    target.parts, target.sections = parts, made


def _own_thickness(target: Model, part: int) -> bool:
    """Whether all shells of a part have a thickness of their own."""
    mine = [b for b in target.blocks if b.family == "shell" and (b.part == part).any()]
    return all("thickness" in b.data and (b.data["thickness"][b.part == part] > 0).all() for b in mine)


def _area(target: Model, part: int, parameters: dict[str, float], settings: Settings) -> float:
    name, entry = settings_of(settings, target, part)
    area = entry["area"] if entry is not None and entry["area"] else parameters.get("area", 0.0)
    if not area > 0:
        message = f"the bars of part {name} have no cross-section"
        settings.fault(("materials", name), message, name, f"materials: {{{name}: {{area: ...}}}}")
        settings.stop()
    return float(area)


def _fixed(model: Model, settings: Settings, report: Report) -> NDArray[np.bool_]:
    """What is held at each node, (n, 6): by the mesh, by the settings, and where no element has stiffness."""
    fixed = held.fixed_dofs(model, report)
    for name, entry in settings["sets"].items():
        nodes = fem_loads.node_set(model, settings, name)
        for dof in entry["fixed"]:
            fixed[nodes, dof - 1] = True
    bending = np.zeros(len(model.xyz), bool)
    for block in model.blocks:
        if block.family in _BENDING:
            bending[block.nodes.ravel()] = True
    fixed[~bending, 3:] = True
    if model.dimension == 2:
        fixed[:, 2] = True
    return fixed


def _velocities(target: Model, settings: Settings) -> None:
    """What the settings say of the parts' velocities at the start, beside the mesh's own."""
    for part in target.parts:
        entry = settings_of(settings, target, part)[1]
        if entry is None or not any(entry["velocity"]):
            continue
        mine = [block.nodes[block.part == part].ravel() for block in target.blocks]
        nodes = np.unique(np.concatenate(mine))
        places = target.xyz[nodes]
        columns = [np.broadcast_to(held.values_at(v, places, "velocity"), len(nodes)) for v in entry["velocity"]]
        target.initial_velocities.append(InitialVelocity(nodes, np.column_stack(columns).astype(float)))


def _report_lost(model: Model, target: Model, report: Report) -> None:
    """What of the mesh is not in the finite element model."""
    every: list[Any] = [*model.nodal_loads, *model.constraints, *model.face_loads]
    used = {load.set for load in every}
    for what, items in (
        ("element sets", model.element_sets),
        ("part sets", model.part_sets),
        ("segment sets", model.segment_sets),
        ("node sets", model.node_sets),
        ("contacts", model.contacts),
    ):
        names = [item.name or str(item.id) for item in items if item.id not in used]
        report.drop(what, len(names), "a .dat deck has none: " + ", ".join(names[:20]))
    report.drop("equations of state", len(model.equations_of_state), "a .dat deck has none")
    target.node_sets, target.element_sets, target.part_sets, target.segment_sets = [], [], [], []
    target.contacts, target.equations_of_state, target.systems = [], {}, {}
