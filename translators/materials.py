"""The material of each part: what the settings say of it, over what the mesh itself says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from zrno.translators.law_maps import with_defaults
from zrno.translators.laws import EQUATIONS_OF_STATE, LAWS
from zrno.translators.model import Eos, Material, Model
from zrno.translators.report import Report
from zrno.translators.settings import Settings
from zrno.translators.yaml_marks import dotted

NEED_EQUATION = ("fluid", "hydro")
ANY = "*"  # in place of a part's name: all parts that have no entry of their own


def settings_of(settings: Settings, model: Model, part: int) -> tuple[str, dict[str, Any] | None]:
    """The name by which the settings know a part (its name, its number, or * for any), and their entry of it."""
    entries = settings["materials"]
    for name in (model.parts[part].name, str(part), ANY):
        if name in entries:
            return name, entries[name]
    return model.parts[part].name or str(part), None


def materials_of(
    model: Model, parts: Sequence[int], settings: Settings, report: Report, *, massless: bool = False
) -> dict[int, Material]:
    """The material of each part; what the settings give and a law does not take is a remark of the report.

    massless: a density may be missing. Raises InputError with all that is missing or wrong in the settings.
    """
    names = {key for number, part in model.parts.items() for key in (part.name, str(number)) if key}
    for group in ("materials", "contact_laws"):
        for name in settings[group]:
            if name not in names and name != ANY:
                expected = "one of " + ", ".join(sorted(names)[:20])
                settings.fault((group, name), f"{group} of a part that the mesh does not have", name, expected)
    found: dict[int, Material] = {}
    for part in parts:
        own = model.materials.get(model.parts[part].material or 0)
        name, entry = settings_of(settings, model, part)
        if own is None and entry is None:
            settings.fault(
                ("materials",), "a part has no material", name, f"materials: {{{name}: {{law: elastic, ...}}}}"
            )
            continue
        material = _merged(own, entry or {}, part, name)
        _check(settings, name, material, report, massless=massless)
        found[part] = with_defaults(material)
    settings.stop()
    return found


def _merged(own: Material | None, entry: dict[str, Any], part: int, name: str) -> Material:
    """The mesh's material with what the settings say; a law that they name makes it wholly theirs."""
    if own is None or entry.get("law"):
        own = Material(own.id if own else part, name, entry.get("law") or "elastic", own.density if own else 0.0)
    given = {key: entry[key] for key in LAWS.get(own.law, LAWS["elastic"]).parameters if entry.get(key) is not None}
    tables = dict(own.tables)
    if entry.get("hardening"):
        tables["hardening"] = np.array(entry["hardening"], float)
    density = own.density if entry.get("density") is None else entry["density"]
    return replace(own, density=density, parameters=own.parameters | given, tables=tables)


def _check(settings: Settings, name: str, material: Material, report: Report, *, massless: bool) -> None:
    """What a law needs and has not, at the settings' keys, and what the settings give that it does not take."""
    law = LAWS.get(material.law)
    if law is None:
        message = f"the mesh's law of {name} is not known here"
        settings.fault(("materials", name), message, material.law or "none", "law: ...")
        return
    p = material.parameters
    if material.density <= 0 and not massless:
        settings.fault(("materials", name), f"materials.{name}.density is missing", name, "a value of density")
    for key, default in law.parameters.items():
        if default is None and key not in p and not (key == "yield_stress" and instead_of_yield(material)):
            settings.fault(("materials", name), f"materials.{name}.{key} is missing", name, f"a value of {key}")
    given = {key for key, value in settings["materials"].get(name, {}).items() if value is not None}
    others = {key for other in LAWS.values() for key in other.parameters} - set(law.parameters)
    left = ", ".join(sorted(given & others))
    if left:  # not wrong: an override may have exchanged the law
        report.notes.append(f"materials.{name}: the law {material.law} does not take {left}")
    if material.law == "von_mises":
        for key, bad, message, wanted in (
            ("beta", p.get("beta", 1.0) > 1, "too large", "0 to 1"),
            ("yield_stress", p.get("yield_stress", 1.0) <= 0, "not positive", "a stress"),
            ("tangent_modulus", p.get("tangent_modulus", 0.0) >= p.get("E", np.inf), "too large", "less than E"),
        ):
            if bad and not (key == "yield_stress" and instead_of_yield(material)):
                settings.fault(("materials", name, key), f"materials.{name}.{key} is {message}", f"{p[key]:g}", wanted)


def equation_of_state(settings: Settings, model: Model, part: int, material: Material) -> Eos | None:
    """The equation of state of a part: what the settings say, over its own or its material's.

    What is missing or not wanted is a fault of the settings.
    """
    number = model.parts[part].eos or material.eos
    own = None if number is None else model.equations_of_state.get(number)
    name, entry = settings_of(settings, model, part)
    said = {} if entry is None else {key: value for key, value in entry["eos"].items() if value is not None}
    wanted = material.law in NEED_EQUATION
    kind = said.pop("type", "" if own is None else own.law)
    place = ("materials", name, "eos")
    if not kind:
        if wanted or said:
            expected = f"materials: {{{name}: {{eos: {{type: murnaghan, ...}}}}}}"
            settings.fault(place, f"the law {material.law} of {name} needs an equation of state", name, expected)
        return None
    if not wanted and said:
        expected = f"a law that has one: {', '.join(NEED_EQUATION)}"
        settings.fault(place, f"the law {material.law} of {name} takes no equation of state", kind, expected)
    known = EQUATIONS_OF_STATE[kind].parameters if kind in EQUATIONS_OF_STATE else {}
    for key in sorted(set(said) - set(known)):
        expected = "one of " + ", ".join(known)
        settings.fault((*place, key), f"the equation of state {kind} has no {key}", f"{said[key]:g}", expected)
    given = (dict(own.parameters) if own is not None and own.law == kind else {}) | said
    for key, default in known.items():
        if default is None and key not in given:
            settings.fault(place, f"{dotted((*place, key))} is missing", name, f"a value of {key}")
    return Eos(number or 0, own.name if own is not None else "", kind, given)


def instead_of_yield(material: Material) -> bool:
    """Whether a table or a curve says what yield_stress and tangent_modulus would."""
    return "hardening" in material.tables or "hardening" in material.curves
