"""Material laws: one law a file, a stress update at one point, used by particles and finite elements alike.

The table of laws, what each is a model of and what it costs, is in README.md beside this file.
"""

from __future__ import annotations

from . import hexagon_tangent, metal_tangent, soil_tangent  # noqa: F401  # they register the bodies of `tangent`
from .cam_clay import CamClay, cam_clay
from .cap import Cap, KinematicCap, cap
from .cap_return import CapHardening, CapHardeningGeneral
from .drucker_prager import DruckerPrager, drucker_prager, drucker_prager_soil
from .elastic import Elastic
from .eos import Gruneisen, LinearPolynomial, MieGruneisen, Monaghan, PerfectGas, Tait
from .failing import Failing, failing
from .fluid import Fluid, fluid
from .hardening import Linear, Power, Table, power, ramberg_osgood, table
from .hydro import Hydro, hydro
from .law import OPEN, PLASTIC_STRAIN, constant_wave, sound_speed, state_rows
from .mohr_coulomb import MohrCoulomb, mohr_coulomb
from .orthotropic import Orthotropic, axes_of, orthotropic
from .perzyna import Perzyna, perzyna, perzyna_yield
from .von_mises import (
    VonMisesCurve,
    VonMisesIsotropic,
    VonMisesMixed,
    VonMisesMixedCurve,
    von_mises,
    von_mises_curve,
)

Eos = Gruneisen | LinearPolynomial | MieGruneisen | Monaghan | PerfectGas | Tait
Law = (
    CamClay
    | Cap
    | DruckerPrager
    | Elastic
    | Failing
    | Fluid
    | Hydro
    | KinematicCap
    | MohrCoulomb
    | Orthotropic
    | Perzyna
    | VonMisesCurve
    | VonMisesIsotropic
    | VonMisesMixed
    | VonMisesMixedCurve
)

_FAMILIES: dict[type, str] = {
    Fluid: "fluid", CamClay: "grain", Cap: "grain", KinematicCap: "grain", DruckerPrager: "grain",
    MohrCoulomb: "grain",
}  # fmt: skip


def family(law: Law) -> str:
    """What a law is a model of, for the numerics' defaults: "solid", "grain" or "fluid"."""
    return _FAMILIES.get(type(law), "solid")


def continuous(law: Law) -> Law:
    """The law with a cut-off of tension that leaves shear, so that stresses are continuous in the strain."""
    if isinstance(law, KinematicCap):
        return law._replace(cap=law.cap._replace(keeps_shear=True))
    return law._replace(keeps_shear=True) if isinstance(law, Cap | DruckerPrager) else law


def cohesive(law: Law) -> bool:
    """Whether grain of a soil's law holds together by itself."""
    if isinstance(law, KinematicCap):
        return cohesive(law.cap)
    if isinstance(law, Cap):
        return law.k > law.gamma
    return (isinstance(law, DruckerPrager) and law.k > 0.0) or (isinstance(law, MohrCoulomb) and law.cohesive > 0.0)


__all__ = [
    "OPEN",
    "PLASTIC_STRAIN",
    "CamClay",
    "Cap",
    "CapHardening",
    "CapHardeningGeneral",
    "DruckerPrager",
    "Elastic",
    "Eos",
    "Failing",
    "Fluid",
    "Gruneisen",
    "Hydro",
    "KinematicCap",
    "Law",
    "Linear",
    "LinearPolynomial",
    "MieGruneisen",
    "MohrCoulomb",
    "Monaghan",
    "Orthotropic",
    "PerfectGas",
    "Perzyna",
    "Power",
    "Table",
    "Tait",
    "VonMisesCurve",
    "VonMisesIsotropic",
    "VonMisesMixed",
    "VonMisesMixedCurve",
    "axes_of",
    "cam_clay",
    "cap",
    "cohesive",
    "constant_wave",
    "continuous",
    "drucker_prager",
    "drucker_prager_soil",
    "failing",
    "family",
    "fluid",
    "hydro",
    "mohr_coulomb",
    "orthotropic",
    "perzyna",
    "perzyna_yield",
    "power",
    "ramberg_osgood",
    "sound_speed",
    "state_rows",
    "table",
    "von_mises",
    "von_mises_curve",
]
