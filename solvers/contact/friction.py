"""Friction between bodies in contact: traction against the tangential slip of a point ([T] 5.4.4-9).

Coulomb friction with stick: a point that touches another body carries a spring of stiffness k and its elastic slip e,
with a dashpot c beside it. T = k e + c s, s the slip velocity, resists as long as |T| <= mu N; beyond it slides with
|T| = mu N, and e is what the spring then holds. Stick is the spring at rest: no creep. mu is mu_s and comes down to
mu_k while the point slides a small distance; it is mu_s again as soon as the slip turns. (A sudden drop would let a
body go as soon as its worst point does.) As of rough surfaces k grows with N (Archard 1957; Greenwood & Williamson
1966), up to what the time step bears: the points of a stiff body reach their limits together, however unequal their
loads.

The N of friction follows the normal force with a delay of some passages of sound through a particle (`follow`; Prakash
& Clifton 1993): elastic bodies that slide under Coulomb's law as it stands are unstable, the more so the shorter the
wave (Adams 1995; Ranjith & Rice 2001).

Drag is ours for what the deck calls fluid friction and does not describe: a shear stress of `coefficient` times the
slip velocity over the surface in contact, that of a thin film.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..jit import kernel

ELASTIC = 1e-3  # elastic slip, in units of h, at which the traction would be the normal force
WEAKENING = 0.01  # slip, in units of h, over which a point at rest comes down to the friction of motion
DELAY = 10.0  # of friction behind the normal force, in passages of sound through h
FORGET = 0.1  # of the pace at which the load rises: that at which it is forgotten out of contact
STICK = 0.5  # the spring's largest stiffness in units of the softer body's own, rho c^2
DASHPOT = 0.25  # the dashpot beside it in units of the impedance rho c


@dataclass(frozen=True, slots=True)
class Coulomb:
    """Coefficients at rest and in motion [-]; static >= kinetic >= 0."""

    static: float
    kinetic: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.kinetic <= self.static < math.inf:
            raise ValueError(f"friction needs static >= kinetic >= 0, not {self.static!r} and {self.kinetic!r}")


@dataclass(frozen=True, slots=True)
class Drag:
    """Fluid friction; coefficient: shear stress by slip velocity [pressure time/length]."""

    coefficient: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.coefficient < math.inf:
            raise ValueError(f"the coefficient {self.coefficient!r} of fluid friction must not be negative")


@kernel
def follow(load, force, dt, wave, h):
    """The load that friction knows of, one step on towards the normal force; wave: speed of sound."""
    return load + (force - load) * min(1.0, dt * wave / (DELAY * h))


@kernel
def turned_into(ex, ey, ez, nx, ny, nz):
    """A tangential vector (elastic slip) brought into the plane across n, a unit vector, at its old length."""
    along = ex * nx + ey * ny + ez * nz
    before = ex * ex + ey * ey + ez * ez
    ex -= along * nx
    ey -= along * ny
    ez -= along * nz
    after = ex * ex + ey * ey + ez * ez
    scale = math.sqrt(before / after) if after > 0.0 else 0.0
    return ex * scale, ey * scale, ez * scale


@kernel
def stick_or_slide(ex, ey, ez, sx, sy, sz, dt, k, c, at_rest, in_motion, weakening, slid):
    """One step of Coulomb friction: the traction that resists, the new elastic slip, how far it slid, and the heat.

    e: elastic slip; s: slip velocity, both tangential; k, c: stiffness and dashpot; at_rest, in_motion: mu N of both
    kinds; slid: how far it has slid since it last turned, over `weakening` of which the one becomes the other. Heat is
    the work done on the traction less what the spring stores. Without a load (k = 0, as where bodies part as soon as
    they have met) nothing resists.
    """
    if k <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, slid, 0.0
    stored = 0.5 * k * (ex * ex + ey * ey + ez * ez)
    ex += sx * dt
    ey += sy * dt
    ez += sz * dt
    tx = k * ex + c * sx
    ty = k * ey + c * sy
    tz = k * ez + c * sz
    size = math.sqrt(tx * tx + ty * ty + tz * tz)
    limit = in_motion + (at_rest - in_motion) * max(0.0, 1.0 - slid / weakening)
    if size > limit:
        scale = limit / size
        slid += (size - limit) / k
        tx *= scale
        ty *= scale
        tz *= scale
        ex = tx / k
        ey = ty / k
        ez = tz / k
    elif tx * sx + ty * sy + tz * sz <= 0.0:
        slid = 0.0
    work = (tx * sx + ty * sy + tz * sz) * dt
    heat = work + stored - 0.5 * k * (ex * ex + ey * ey + ez * ez)
    return tx, ty, tz, ex, ey, ez, slid, heat


@kernel
def rub(ex, ey, ez, sx, sy, sz, dt, load, force, k, mass, h, static, kinetic, slid):
    """`stick_or_slide` of a particle on a wall, whose normal stiffness k, mass and h make the spring and the dashpot.

    load: the normal force that friction knows of (`follow`), force: that now; static, kinetic: coefficients.
    """
    return stick_or_slide(
        ex, ey, ez, sx, sy, sz, dt, min(max(load, 1e-6 * force) / (ELASTIC * h), STICK * k),
        DASHPOT * math.sqrt(k * mass), static * load, kinetic * load, WEAKENING * h, slid,
    )  # fmt: skip
