"""Material laws: one law a file, a stress update at one point, used by particles and finite elements alike.

The table of laws, what each is a model of and what it costs, is in README.md beside this file.
"""

from __future__ import annotations

from .cap import Cap, KinematicCap, cap
from .cap_return import CapHardening, CapHardeningGeneral
from .drucker_prager import DruckerPrager, drucker_prager, drucker_prager_soil
from .elastic import Elastic
from .eos import Gruneisen, LinearPolynomial, MieGruneisen, Monaghan, PerfectGas, Tait
from .failing import Failing, failing
from .fluid import Fluid, fluid
from .hardening import Linear, Table, table
from .hydro import Hydro, hydro
from .law import OPEN, PLASTIC_STRAIN, constant_wave, sound_speed, state_rows
from .mohr_coulomb import MohrCoulomb, mohr_coulomb
from .von_mises import VonMisesCurve, VonMisesIsotropic, VonMisesMixed, von_mises, von_mises_curve

Eos = Gruneisen | LinearPolynomial | MieGruneisen | Monaghan | PerfectGas | Tait
Law = (
    Cap
    | DruckerPrager
    | Elastic
    | Failing
    | Fluid
    | Hydro
    | KinematicCap
    | MohrCoulomb
    | VonMisesCurve
    | VonMisesIsotropic
    | VonMisesMixed
)

_FAMILIES: dict[type, str] = {
    Fluid: "fluid", Cap: "grain", KinematicCap: "grain", DruckerPrager: "grain", MohrCoulomb: "grain",
}  # fmt: skip


def family(law: Law) -> str:
    """What a law is a model of, for the numerics' defaults: "solid", "grain" or "fluid"."""
    return _FAMILIES.get(type(law), "solid")


def cohesive(law: Law) -> bool:
    """Whether grain of a soil's law holds together by itself."""
    return (isinstance(law, DruckerPrager) and law.k > 0.0) or (isinstance(law, MohrCoulomb) and law.cohesive > 0.0)


__all__ = [
    "OPEN",
    "PLASTIC_STRAIN",
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
    "PerfectGas",
    "Table",
    "Tait",
    "VonMisesCurve",
    "VonMisesIsotropic",
    "VonMisesMixed",
    "cap",
    "cohesive",
    "constant_wave",
    "drucker_prager",
    "drucker_prager_soil",
    "failing",
    "family",
    "fluid",
    "hydro",
    "mohr_coulomb",
    "sound_speed",
    "state_rows",
    "table",
    "von_mises",
    "von_mises_curve",
]
