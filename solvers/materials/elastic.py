"""Isotropic linear elasticity (Hooke): sigma' = lambda tr(e') I + 2 G e'."""

from __future__ import annotations

from typing import NamedTuple

from .law import lame_constants, law_body, stress_update


class Elastic(NamedTuple):
    """lame, shear: Lame's constants lambda and G [pressure]."""

    lame: float
    shear: float

    @classmethod
    def from_engineering(cls, young: float, poisson: float) -> Elastic:
        """From Young's modulus [pressure] and Poisson's ratio [-]."""
        return cls(*lame_constants(young, poisson))


@law_body(stress_update, Elastic)
def _update(law, de_xx, de_yy, de_zz, de_xy, de_yz, de_zx, s_xx, s_yy, s_zz, s_xy, s_yz, s_zx, rho, e, dt, state, i):
    g2 = 2.0 * law.shear
    volumetric = law.lame * (de_xx + de_yy + de_zz)
    return (
        s_xx + volumetric + g2 * de_xx,
        s_yy + volumetric + g2 * de_yy,
        s_zz + volumetric + g2 * de_zz,
        s_xy + g2 * de_xy,
        s_yz + g2 * de_yz,
        s_zx + g2 * de_zx,
        0.0,
    )
