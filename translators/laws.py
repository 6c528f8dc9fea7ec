"""The material laws by name: which numbers each has. One vocabulary for all formats; conversions stand here too.

Stresses are positive in tension, the cap's and Drucker-Prager's own numbers as geomechanics has them (compression
positive). Angles are in degrees. A parameter that a material does not give has the default of the table, or None: then
it must be given.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

Parameters = Mapping[str, float | None]
_NEEDED = None


@dataclass(frozen=True, slots=True)
class Law:
    """A law's parameters with their defaults, and the tables that it may have."""

    meaning: str
    parameters: Parameters
    tables: tuple[str, ...] = ()


_ISOTROPIC: Parameters = {"E": _NEEDED, "nu": _NEEDED}

LAWS: dict[str, Law] = {
    "elastic": Law("linear elastic, isotropic", _ISOTROPIC),
    "thermo_elastic": Law(
        "linear elastic, isotropic; expansion: strain by a degree of temperature above the reference",
        {**_ISOTROPIC, "expansion": _NEEDED, "reference_temperature": 0.0},
    ),
    "orthotropic": Law(
        "linear elastic, orthotropic",
        dict.fromkeys(("Ex", "Ey", "Ez", "nu_xy", "nu_yz", "nu_zx", "Gxy", "Gyz", "Gzx"), _NEEDED),
    ),
    "rigid": Law("a rigid body; E and nu serve contact alone", _ISOTROPIC),
    "von_mises": Law(
        "elastic-plastic, von Mises, mixed hardening beta (0 kinematic .. 1 isotropic); the table is effective plastic "
        "strain and yield stress and overrules yield_stress and tangent_modulus; rate_C, rate_p: Cowper-Symonds",
        {**_ISOTROPIC, "yield_stress": _NEEDED, "tangent_modulus": 0.0, "beta": 1.0, "failure_strain": 0.0,
         "rate_C": 0.0, "rate_p": 0.0},
        ("hardening",),
    ),
    "von_mises_power": Law(
        "von Mises with yield stress yield_stress + Cy ep^n and mixed hardening M (1 isotropic .. 0 kinematic)",
        {**_ISOTROPIC, "yield_stress": _NEEDED, "Cy": 0.0, "n": 1.0, "M": 1.0},
    ),
    "hydro": Law(
        "elastic-plastic with an equation of state for the pressure; spall: 1, 2, 3",
        {"G": _NEEDED, "yield_stress": 0.0, "hardening_modulus": 0.0, "pressure_cutoff": 0.0, "a1": 0.0, "a2": 0.0,
         "spall": 1.0, "failure_strain": 0.0},
        ("hardening",),
    ),
    "fluid": Law(
        "viscous fluid with an equation of state",
        {"pressure_cutoff": 0.0, "viscosity": 0.0, "E": 0.0, "nu": 0.0},
    ),
    "soil_foam": Law(
        "soil and foam: J2 = a0 + a1 p + a2 p^2, pressure by a table of volumetric strain; vcr 1: no crushing",
        {"G": _NEEDED, "K": _NEEDED, "a0": 0.0, "a1": 0.0, "a2": 0.0, "pressure_cutoff": 0.0, "vcr": 0.0, "ref": 0.0},
        ("pressure",),
    ),
    "cap": Law(
        "generalised cap: sqrt(J2) = alpha - gamma exp(-beta I1) + theta I1, elliptic cap R, hardening "
        "epv = W (1 - exp(-D (X - X0))), kinematic C and N, ftype 1 soil or 2 rock",
        {"K": _NEEDED, "G": _NEEDED, "alpha": _NEEDED, "theta": 0.0, "gamma": 0.0, "beta": 0.0, "R": 0.0, "D": 0.0,
         "W": 0.0, "X0": 0.0, "C": 0.0, "N": 0.0, "ftype": 1.0, "vec": 0.0, "tension_cutoff": 0.0},
    ),
    "drucker_prager": Law(
        "sqrt(J2) = k + alpha I1, with a tension cut-off and, where D > 0, the cap's hardening",
        {**_ISOTROPIC, "k": _NEEDED, "alpha": 0.0, "tension_cutoff": 0.0, "X0": 0.0, "W": 0.0, "D": 0.0, "R": 0.0},
    ),
    "drucker_prager_soil": Law(
        "Drucker-Prager by cohesion c and the angles phi (friction) and psi (dilation); shape: 0.5 .. 1 of the yield "
        "surface in the deviatoric plane",
        {**_ISOTROPIC, "c": 0.0, "phi": _NEEDED, "psi": 0.0, "shape": 1.0},
    ),
    "mohr_coulomb": Law(
        "cohesion c, angles phi (friction) and psi (dilation)",
        {**_ISOTROPIC, "c": 0.0, "phi": _NEEDED, "psi": 0.0},
    ),
    "cam_clay": Law(
        "modified Cam-clay: q^2/M^2 + p (p - pc) = 0, lambda and kappa slopes of the void ratio over ln p, pc and e0 "
        "at the start",
        {**_ISOTROPIC, **dict.fromkeys(("M", "lambda", "kappa", "pc", "e0"), _NEEDED)},
    ),
}  # fmt: skip

EQUATIONS_OF_STATE: dict[str, Law] = {
    "linear_polynomial": Law(
        "p = C0 + C1 mu + C2 mu^2 + C3 mu^3 + (C4 + C5 mu + C6 mu^2) E, mu = rho/rho0 - 1",
        dict.fromkeys(("C0", "C1", "C2", "C3", "C4", "C5", "C6", "E0", "V0"), 0.0),
    ),
    "gruneisen": Law(
        "shock velocity C + S1 up + .., gamma0, a; E0, V0 at the start",
        {"C": _NEEDED, "S1": 0.0, "S2": 0.0, "S3": 0.0, "gamma0": 0.0, "a": 0.0, "E0": 0.0, "V0": 0.0},
    ),
    "perfect_gas": Law("p = (gamma - 1) rho e", {"gamma": _NEEDED, "second": 0.0, "E0": 0.0, "V0": 0.0}),
    "murnaghan": Law("p = B ((rho/rho0)^gamma - 1)", {"B": _NEEDED, "gamma": _NEEDED, "E0": 0.0, "V0": 0.0}),
    "mie_gruneisen": Law(
        "Mie-Gruneisen",
        {"C": _NEEDED, "S": 0.0, "cv": 0.0, "T0": 0.0, "gamma0": 0.0, "V0": 0.0, "b": 0.0, "E0": 0.0},
    ),
}


def engineering(K: float, G: float) -> tuple[float, float]:
    """Young's modulus and Poisson's ratio of a bulk and a shear modulus."""
    return 9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G))


def bulk_and_shear(E: float, nu: float) -> tuple[float, float]:
    """Bulk and shear modulus of Young's modulus and Poisson's ratio."""
    return E / (3 * (1 - 2 * nu)), E / (2 * (1 + nu))
