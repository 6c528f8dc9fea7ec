"""What a run does about the known defects of the method where nobody says otherwise, by the materials in it.

Solids get no artificial stress unasked: it weakens tension at any strain, and the impact of two elastic cylinders
(sample two_cylinders, spacing 1/20) is 4.3 % off with 0.3 of it, 3.6 % without. A body that stays whole has a better
cure.
"""

from __future__ import annotations

from ..materials import OPEN, Law, cohesive, family

DENSITY_DIFFUSION = 0.1  # fluids: Molteni & Colagrossi (2009)
STRESS_DIFFUSION = 0.1  # grain: Nguyen et al. (2017)


def density_diffusion(law: Law) -> float:
    """Of one material."""
    return DENSITY_DIFFUSION if family(law) == "fluid" else 0.0


def stress_diffusion(law: Law) -> float:
    """Of one material. None with cohesion: the stress that holds a slope up is no straight line, and diffusion of it
    creeps until the slope fails (sample slope_failure)."""
    return STRESS_DIFFUSION if family(law) == "grain" and not cohesive(law) else 0.0


def correction(law: Law) -> bool:
    """Of one material whose particles move. Without it a solid that turns is strained at its free surfaces and swings
    back, and the impact of two elastic cylinders needs six times finer particles (sample two_cylinders). Grain yields
    instead, and a floor of particles repels it less with it; a fluid's surface is rough, and small steps would follow.
    """
    return family(law) == "solid"


def least_density(law: Law, density: float) -> float | None:
    """Of one material; None: no limit. Opened grain is no bigger: its volume weighs in its neighbours' sums."""
    return density * (1.0 - OPEN) if getattr(law, "gaps", False) else None
