"""Laws that a deck knows for laws that it does not: the same where it is the same, the nearest where one is near.

`as_known` goes through the rules below until it comes to a law of the target; each rule says what it changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace

import numpy as np

from zrno.translators.laws import LAWS, bulk_and_shear, engineering
from zrno.translators.model import Curve, Eos, Floats, Material
from zrno.translators.report import Report

_Found = tuple[Material, str] | None  # the nearer material, and what was lost ("" where nothing was)


def as_known(
    material: Material,
    known: Mapping[str, Collection[str]],
    curves: Mapping[int, Curve],
    eos: Eos | None,
    report: Report,
    *,
    tables: bool = False,
) -> Material | None:
    """The material by a law that the target knows, or None where there is none near; losses go to the report.

    known: the parameters of the target's laws, both by the names of `laws.LAWS`; the result has these and no others.
    tables: whether the target takes hardening tables.
    """
    name = f"material {material.id} {material.name}".rstrip()
    material = with_defaults(material)
    if not tables or material.law not in known:
        material, lost = _straight_hardening(material, curves)
        report.approximate("hardening", bool(lost), f"{name}: {lost}")
    for law in _path(material.law, known):
        found = _RULES[material.law][law](material, eos)
        if found is None:
            return None
        material, lost = found
        report.approximate("material law", bool(lost), f"{name}: {lost}")
    if material.law not in known:
        return None
    takes, defaults = known[material.law], LAWS[material.law].parameters
    left = [
        f"{key} = {value:g}"
        for key, value in material.parameters.items()
        if key not in takes and value != defaults.get(key, 0.0)
    ]
    report.approximate("material parameters", len(left), f"{name}: the deck's law has no {', '.join(left)}")
    return replace(material, parameters={key: material.parameters[key] for key in takes if key in material.parameters})


def _path(law: str, known: Collection[str]) -> list[str]:
    """The fewest rules from a law to one that is known, by their targets; empty where there are none."""
    paths = {law: list[str]()}
    for here in (queue := [law]):
        if here in known:
            return paths[here]
        for there in _RULES.get(here, ()):
            if there not in paths:
                paths[there] = [*paths[here], there]
                queue.append(there)
    return []


def with_defaults(material: Material) -> Material:
    """The material with the law's default for each parameter that it does not give."""
    law = LAWS.get(material.law)
    if law is None:
        return material
    given = {name: value for name, value in law.parameters.items() if value is not None}
    return replace(material, parameters=given | material.parameters)


def hardening_table(material: Material, curves: Mapping[int, Curve]) -> Floats | None:
    """Effective plastic strain and yield stress (n, 2), of the material's table or its curve; None without either."""
    if "hardening" in material.tables:
        return material.tables["hardening"]
    curve = curves.get(material.curves.get("hardening", -1))
    return None if curve is None else curve.points


def _straight_hardening(material: Material, curves: Mapping[int, Curve]) -> tuple[Material, str]:
    """Yield stress and tangent modulus of a hardening table: its own where it is one straight line, else the line of
    least squares, from the first point where that is a stress at all."""
    table = hardening_table(material, curves) if material.law == "von_mises" else None
    if table is None or not len(table):
        return material, ""
    strain, stress = table[:, 0] - table[0, 0], table[:, 1]
    first = float(stress[0])
    slope = float(strain @ (stress - first) / (strain @ strain)) if strain.any() else 0.0
    if first <= 0 and strain.any():
        slope, first = (float(value) for value in np.polyfit(strain, stress, 1))
    slope = max(slope, 0.0)
    E = material.parameters["E"]
    parameters = material.parameters | {"yield_stress": first, "tangent_modulus": E * slope / (E + slope)}
    straight = replace(material, parameters=parameters, tables={}, curves={})
    worst = float(np.abs(stress - first - slope * strain).max())
    if worst <= 1e-9 * float(np.abs(stress).max()):
        return straight, ""
    return straight, f"a table of {len(table)} points as a straight line, off by up to {worst:.4g} in stress"


def _power_of_von_mises(material: Material, eos: Eos | None) -> _Found:
    p = material.parameters
    E, slope = p["E"], p["tangent_modulus"]
    if slope >= E:
        return None
    new = {"E": E, "nu": p["nu"], "yield_stress": p["yield_stress"], "Cy": E * slope / (E - slope), "n": 1.0}
    new |= {"M": p["beta"], "failure_strain": p["failure_strain"], "rate_C": p["rate_C"]}  # of no power law: lost later
    return replace(material, law="von_mises_power", parameters=new), ""


def _von_mises_of_power(material: Material, eos: Eos | None) -> _Found:
    p = material.parameters
    E, plastic = p["E"], p["Cy"]
    lost = "" if p["n"] == 1.0 or plastic == 0.0 else f"hardening with exponent {p['n']:g} as a straight line to 10 %"
    if lost:
        plastic *= 0.1 ** (p["n"] - 1.0)
    new = {"E": E, "nu": p["nu"], "yield_stress": p["yield_stress"], "tangent_modulus": E * plastic / (E + plastic)}
    return with_defaults(replace(material, law="von_mises", parameters=new | {"beta": p["M"]})), lost


def _elastic_of_rigid(material: Material, eos: Eos | None) -> _Found:
    p = material.parameters
    return (
        replace(material, law="elastic", parameters={"E": p["E"], "nu": p["nu"]}),
        "a rigid body as an elastic one of its E and nu",
    )


def _elastic_of_warm(material: Material, eos: Eos | None) -> _Found:
    p = material.parameters
    lost = "without expansion by temperature" if p["expansion"] else ""
    return replace(material, law="elastic", parameters={"E": p["E"], "nu": p["nu"]}), lost


def _von_mises_of_hydro(material: Material, eos: Eos | None) -> _Found:
    p = material.parameters
    bulk = _bulk_of(eos, material.density)
    if bulk is None or bulk <= 0:
        return None
    E, nu = engineering(bulk, p["G"])
    plastic = p["hardening_modulus"]
    new = {"E": E, "nu": nu, "yield_stress": p["yield_stress"], "tangent_modulus": E * plastic / (E + plastic)}
    new |= {"failure_strain": p["failure_strain"]}
    lost = f"the equation of state as a constant bulk modulus {bulk:.4g}"
    return with_defaults(replace(material, law="von_mises", parameters=new, eos=None, tables={})), lost


def _bulk_of(eos: Eos | None, density: float) -> float | None:
    if eos is None:
        return None
    p = eos.parameters
    match eos.law:
        case "linear_polynomial":
            return p.get("C1")
        case "gruneisen" | "mie_gruneisen":
            return density * p["C"] ** 2
        case "murnaghan":
            return p["B"] * p["gamma"]
    return None


def _drucker_prager_of_soil(material: Material, eos: Eos | None) -> _Found:
    """The cone through the Mohr-Coulomb hexagon's corners of triaxial compression."""
    p = material.parameters
    sine, cosine = math.sin(math.radians(p["phi"])), math.cos(math.radians(p["phi"]))
    below = math.sqrt(3.0) * (3.0 - sine)
    new = {"E": p["E"], "nu": p["nu"], "k": 6.0 * p["c"] * cosine / below, "alpha": 2.0 * sine / below}
    lost = "cohesion and angles as the cone that meets them in triaxial compression"
    if p["psi"] != p["phi"]:
        lost += f"; dilation angle {p['psi']:g} as the friction angle's"
    return with_defaults(replace(material, law="drucker_prager", parameters=new)), lost


def _mohr_coulomb_of_soil(material: Material, eos: Eos | None) -> _Found:
    p = material.parameters
    new = {name: p[name] for name in ("E", "nu", "c", "phi", "psi")}
    return replace(material, law="mohr_coulomb", parameters=new), "the hexagon for a smooth cone of the same angles"


def _soil_of_mohr_coulomb(material: Material, eos: Eos | None) -> _Found:
    new = material.parameters | {"shape": 1.0}
    return (
        with_defaults(replace(material, law="drucker_prager_soil", parameters=new)),
        "a cone of the same angles for the hexagon",
    )


def _cap_of_drucker_prager(material: Material, eos: Eos | None) -> _Found:
    p = material.parameters
    if p["D"] <= 0 or p["W"] <= 0:  # without the cap's hardening there is no cap to write
        return None
    K, G = bulk_and_shear(p["E"], p["nu"])
    new = {"K": K, "G": G, "alpha": p["k"], "theta": p["alpha"]}
    new |= {name: p[name] for name in ("R", "D", "W", "X0", "tension_cutoff")}
    return with_defaults(replace(material, law="cap", parameters=new)), ""


_Rule = Callable[[Material, Eos | None], _Found]
_RULES: dict[str, dict[str, _Rule]] = {
    "rigid": {"elastic": _elastic_of_rigid},
    "thermo_elastic": {"elastic": _elastic_of_warm},
    "von_mises": {"von_mises_power": _power_of_von_mises},
    "von_mises_power": {"von_mises": _von_mises_of_power},
    "hydro": {"von_mises": _von_mises_of_hydro},
    "drucker_prager_soil": {"drucker_prager": _drucker_prager_of_soil, "mohr_coulomb": _mohr_coulomb_of_soil},
    "mohr_coulomb": {"drucker_prager_soil": _soil_of_mohr_coulomb},
    "drucker_prager": {"cap": _cap_of_drucker_prager},
}
