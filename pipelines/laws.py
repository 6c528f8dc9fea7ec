"""From a material's law by name to the solvers' law: names and numbers change hands, nothing is computed.

The names are `translators.laws`'s. ValueError: constants that make no sense. Unsupported: a law, or a part of one,
that the solvers do not compute. A cut-off of the pressure is a tension, whichever its sign: decks have both.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from zrno.pipelines.fem_method import Overstress
from zrno.pipelines.method import Soil
from zrno.solvers import materials as laws
from zrno.solvers.errors import Unsupported
from zrno.solvers.materials import Law
from zrno.translators.law_maps import hardening_table, with_defaults
from zrno.translators.laws import EQUATIONS_OF_STATE, LAWS, bulk_and_shear
from zrno.translators.model import Curve, Eos, Floats, Material

Values = Mapping[str, float]


def structural_law_of(material: Material, curves: Mapping[int, Curve], axes: Any) -> Law:
    """As `law_of`, of finite elements: what a cut-off of tension cuts keeps its shear.

    axes: (3, 3) directions of an orthotropic law's, or None: the coordinates'.
    """
    if material.law != "orthotropic":
        return laws.continuous(law_of(material, None, curves))
    p = {name: material.parameters.get(name, math.nan) for name in LAWS["orthotropic"].parameters}
    values = list(p.values())
    return laws.orthotropic(values[:3], values[3:6], values[6:], axes)


def law_of(material: Material, eos: Eos | None, curves: Mapping[int, Curve]) -> Law:
    """The law that a material names. eos: its equation of state; curves: by number, for what it gives by a curve."""
    build = _BUILDERS.get(material.law)
    if build is None:
        raise Unsupported(f"the law {material.law} is not computed yet; {', '.join(_BUILDERS)} are")
    material = with_defaults(material)
    for name in LAWS[material.law].parameters:
        if not math.isfinite(material.parameters.get(name, math.nan)):
            raise ValueError(f"{name} is missing from the {material.law} law")
    state = None
    if material.law in ("fluid", "hydro"):
        state = _equation_of_state(eos, material)
    return build(material.parameters, hardening_table(material, curves), state)


def overstress_of(material: Material, said: Overstress) -> Law:
    """The visco-plastic law that a scene says, with the moduli of the deck's elastic material."""
    if material.law != "elastic":
        raise ValueError(f"{said.law} takes E and nu of an elastic material, this one is {material.law}")
    return laws.perzyna(
        material.parameters["E"], material.parameters["nu"], said.k, said.alpha,
        rate=said.rate, power=said.power, hardening=said.hardening, flow=said.flow,
    )  # fmt: skip


def soil_of(material: Material, said: Soil, *, automatic: bool = True) -> Law:
    """The soil that a scene says, with the moduli of the deck's elastic material. automatic: cures by material."""
    if material.law != "elastic":
        raise ValueError(f"a soil takes E and nu of an elastic material, this one is {material.law}")
    young, poisson = material.parameters["E"], material.parameters["nu"]
    if said.law == "mohr_coulomb":
        if said.tension is not None:
            raise ValueError("a cut-off of tension is for drucker_prager_soil")
        return laws.mohr_coulomb(young, poisson, said.c, said.phi, said.psi)
    gaps = automatic and said.c == 0.0 if said.gaps is None else said.gaps
    tension = -math.inf if said.tension is None else -3.0 * said.tension  # I, compression positive
    return laws.drucker_prager_soil(
        young, poisson, said.c, said.phi, said.psi, match=said.match, gaps=gaps, tension=tension
    )


def initial_energy(eos: Eos | None, density: float) -> float:
    """Energy per unit mass that an equation of state starts with: E0 is per unit of the initial volume."""
    return 0.0 if eos is None else eos.parameters.get("E0", 0.0) / density


def _equation_of_state(eos: Eos | None, material: Material) -> laws.Eos:
    if eos is None:
        raise ValueError(f"the {material.law} law needs an equation of state")
    p = {name: 0.0 if value is None else value for name, value in EQUATIONS_OF_STATE[eos.law].parameters.items()}
    p |= eos.parameters
    rho = material.density
    if not rho > 0.0:
        raise ValueError(f"an equation of state needs a density, not {rho!r}")
    if p["V0"] not in (0.0, 1.0):
        raise Unsupported(f"an initial relative volume V0 of {p['V0']:g} is not computed yet")
    match eos.law:
        case "linear_polynomial":
            c = [p[f"C{k}"] for k in range(7)]
            if not (c[1] >= 0.0 and (c[1] > 0.0 or c[4] > 0.0 or c[5] > 0.0)):
                raise ValueError("a linear polynomial needs a stiffness: C1, or C4 or C5 with an energy")
            return laws.LinearPolynomial(rho, *c)
        case "gruneisen":
            _positive(p, "C")
            return laws.Gruneisen(rho, p["C"], p["S1"], p["S2"], p["S3"], p["gamma0"], p["a"])
        case "perfect_gas":
            if not p["gamma"] > 1.0:
                raise ValueError(f"the gamma {p['gamma']!r} of a perfect gas must be greater than 1")
            return laws.PerfectGas(p["gamma"])
        case "murnaghan":
            _positive(p, "B", "gamma")
            return laws.Tait(rho, p["B"], p["gamma"])
        case "mie_gruneisen":
            _positive(p, "C")
            return laws.MieGruneisen(rho, p["C"], p["S"], p["gamma0"], p["b"])
    raise Unsupported(f"the equation of state {eos.law} is not computed yet")


def _positive(p: Values, *names: str) -> None:
    for name in names:
        if not p[name] > 0.0:
            raise ValueError(f"{name} {p[name]!r} must be positive")


def _hardening(p: Values, points: Floats | None, shear: float, modulus: float) -> laws.Linear | laws.Table:
    return laws.Linear(p["yield_stress"], modulus) if points is None else laws.table(points, shear)


def _elastic(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    return laws.Elastic.from_engineering(p["E"], p["nu"])


def _thermo_elastic(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    return laws.Elastic.from_engineering(p["E"], p["nu"])


def _von_mises(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    law: Law = laws.von_mises(p["E"], p["nu"], p["yield_stress"], p["tangent_modulus"], p["beta"])
    if points is not None or p["rate_C"]:
        modulus = p["E"] * p["tangent_modulus"] / (p["E"] - p["tangent_modulus"])
        hardening = _hardening(p, points, bulk_and_shear(p["E"], p["nu"])[1], modulus)
        rate, beta = p["rate_C"] or math.inf, p["beta"]
        if rate < math.inf and beta != 1.0:
            if points is not None or p["tangent_modulus"]:
                raise Unsupported("kinematic hardening with a strain rate is not computed yet")
            beta = 1.0  # nothing hardens
        law = laws.von_mises_curve(p["E"], p["nu"], hardening, beta, rate=rate, exponent=p["rate_p"] or 1.0)
    return laws.failing(law, p["failure_strain"]) if p["failure_strain"] else law


def _von_mises_power(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    if points is not None:
        return laws.von_mises_curve(p["E"], p["nu"], laws.table(points, bulk_and_shear(p["E"], p["nu"])[1]), p["M"])
    if p["n"] != 1.0 and p["Cy"]:
        return laws.von_mises_curve(p["E"], p["nu"], laws.power(p["yield_stress"], p["Cy"], p["n"]), p["M"])
    tangent = p["E"] * p["Cy"] / (p["E"] + p["Cy"])
    return laws.von_mises(p["E"], p["nu"], p["yield_stress"], tangent, p["M"])


def _hydro(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    return laws.hydro(
        p["G"],
        _hardening(p, points, p["G"], p["hardening_modulus"]),
        eos,
        a1=p["a1"],
        a2=p["a2"],
        cutoff=-abs(p["pressure_cutoff"]) or -math.inf,
        spall=int(p["spall"] or 1) if p["spall"] in (0.0, 1.0, 2.0, 3.0) else -1,
        failure=p["failure_strain"] or math.inf,
    )


def _fluid(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    return laws.fluid(eos, viscosity=p["viscosity"], cutoff=-abs(p["pressure_cutoff"]))


def _cap(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    if p["ftype"] not in (0.0, 1.0, 2.0):
        raise ValueError(f"ftype {p['ftype']:g} must be 1 (soil) or 2 (rock)")
    return laws.cap(
        p["K"],
        p["G"],
        p["alpha"],
        hardening=laws.CapHardening(p["W"], p["D"], p["X0"]),
        theta=p["theta"],
        gamma=p["gamma"],
        decay=p["beta"],
        ratio=p["R"],
        tension=_tension(p),
        soil=p["ftype"] != 2.0,
        rate=p["C"],
        size=p["N"],
    )


def _tension(p: Values) -> float:
    """Greater than 0 it would be a pressure without any load; decks have it so for a NaN of the original program's."""
    return min(0.0, p["tension_cutoff"])


def _drucker_prager(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    if p["D"] == 0.0 and p["W"] == 0.0:
        return laws.drucker_prager(p["E"], p["nu"], p["k"], p["alpha"], tension=_tension(p))
    laws.Elastic.from_engineering(p["E"], p["nu"])  # refuses what has no moduli
    bulk, shear = bulk_and_shear(p["E"], p["nu"])
    hardening = laws.CapHardening(p["W"], p["D"], p["X0"])
    return laws.cap(bulk, shear, p["k"], hardening=hardening, theta=p["alpha"], ratio=p["R"], tension=_tension(p))


def _drucker_prager_soil(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    if p["shape"] not in (0.0, 1.0):
        raise Unsupported(f"a cone that is not round (shape {p['shape']:g}) is not computed yet")
    return laws.drucker_prager_soil(p["E"], p["nu"], p["c"], p["phi"], p["psi"])


def _mohr_coulomb(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    return laws.mohr_coulomb(p["E"], p["nu"], p["c"], p["phi"], p["psi"])


def _cam_clay(p: Values, points: Floats | None, eos: laws.Eos | None) -> Law:
    return laws.cam_clay(p["E"], p["nu"], p["M"], p["lambda"], p["kappa"], p["pc"], p["e0"])


_BUILDERS: dict[str, Callable[[Values, Floats | None, laws.Eos | None], Law]] = {
    "elastic": _elastic,
    "thermo_elastic": _thermo_elastic,
    "von_mises": _von_mises,
    "von_mises_power": _von_mises_power,
    "hydro": _hydro,
    "fluid": _fluid,
    "cap": _cap,
    "drucker_prager": _drucker_prager,
    "drucker_prager_soil": _drucker_prager_soil,
    "mohr_coulomb": _mohr_coulomb,
    "cam_clay": _cam_clay,
}
