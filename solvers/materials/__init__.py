"""Material laws: one law a file, a stress update at one point, used by particles and finite elements alike."""

from __future__ import annotations

from .elastic import Elastic
from .law import PLASTIC_STRAIN, sound_speed
from .von_mises import VonMisesIsotropic, VonMisesMixed, von_mises

Law = Elastic | VonMisesIsotropic | VonMisesMixed


def state_rows(law: Law) -> int:
    """History variables that a law keeps at a point."""
    return law.rows


__all__ = [
    "PLASTIC_STRAIN",
    "Elastic",
    "Law",
    "VonMisesIsotropic",
    "VonMisesMixed",
    "sound_speed",
    "state_rows",
    "von_mises",
]
