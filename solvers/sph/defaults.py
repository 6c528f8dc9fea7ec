"""What a run does about the known defects of the method where nobody says otherwise, by the materials in it."""

from __future__ import annotations

from ..materials import Law, family

ARTIFICIAL_STRESS = 0.3  # solids: Gray, Monaghan & Swift (2001)
DENSITY_DIFFUSION = 0.1  # fluids: Molteni & Colagrossi (2009)
STRESS_DIFFUSION = 0.1  # grain: Nguyen et al. (2017)


def artificial_stress(laws: list[Law]) -> float:
    """Where a solid is among the materials: it alone bears tension."""
    return ARTIFICIAL_STRESS if any(family(law) == "solid" for law in laws) else 0.0


def density_diffusion(law: Law) -> float:
    """Of one material."""
    return DENSITY_DIFFUSION if family(law) == "fluid" else 0.0


def stress_diffusion(law: Law) -> float:
    """Of one material."""
    return STRESS_DIFFUSION if family(law) == "grain" else 0.0
