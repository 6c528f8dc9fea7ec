"""What a particle run is asked to do: arrays, laws and options, in the terms of numerics and not of a deck."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..contact.friction import Coulomb, Drag
from ..contact.plane import Wall
from ..materials import Law
from .ghosts import PERIODIC, Plane
from .rings import AXIS, TURN
from .smoothing import shape_of
from .surface import Facets

Floats = NDArray[np.float64]

STEP_OPTIONS = {0: "length/viscous wave speed", 1: "h/(c + |v|)", 2: "nearest distance/(c + |v|)"}


@dataclass(frozen=True, slots=True)
class Body:
    """One material and the particles that own it.

    number: of the deck; law: of `zrno.solvers.materials`; density [mass/length^3]; linear, quadratic: artificial
    viscosity by the rate of volume [-]; least, most: limits of the density; strength, exponent: of the repulsive
    contact; alpha, beta: of Monaghan's pair viscosity [-]; density_diffusion: delta-SPH for fluids (0.1);
    stress_diffusion: regularised stress of grain (0.1). lagrangian: the total-Lagrangian formulation, for a body that
    stays whole; hourglass: the share of Young's modulus that resists hourglass modes, 0 .. 1. bearing: held particles
    that bear their neighbours' stress. corrected: the gradient correction, where a run has it, applies.
    """

    number: int
    name: str
    law: Law
    density: float
    linear: float = 0.06
    quadratic: float = 1.5
    least: float = 1e-10
    most: float = 1e10
    strength: float = 0.0
    exponent: float = 0.0
    alpha: float = 0.0
    beta: float = 0.0
    density_diffusion: float = 0.0
    stress_diffusion: float = 0.0
    lagrangian: bool = False
    hourglass: float = 0.8
    bearing: bool = False
    corrected: bool = True


@dataclass(frozen=True, slots=True)
class Cures:
    """Remedies of the method's known defects; off unless asked for.

    correction: gradients exact for linear fields, at free surfaces and in disorder; artificial_stress: factor against
    tension instability (0.2 .. 0.5); xsph: particles move with the mean velocity, factor 0 .. 1.
    """

    correction: bool = False
    artificial_stress: float = 0.0
    xsph: float = 0.0


@dataclass(frozen=True, slots=True)
class Problem:
    """A set of particles and how it moves.

    x, v: (n, 3) positions and velocities, unused components zero; mass, h, density, energy (specific): (n,); body: (n,)
    index into `bodies`; stress: (n, 6) at the start, xx yy zz xy yz zx, zero
    without; fixed: (n, 3) directions that do not move; id: (n,) numbers of the deck. dimension 1, 2 (plane
    strain) or 3. step_option: see STEP_OPTIONS; step_factor: of the critical step; first_step: 0 for automatic.
    potential: bodies repel by the contact potential; otherwise they are ordinary neighbours (kernel contact).
    body_force: acceleration (3,); body_curve: or times (k,) and accelerations (k, 3), linear between them. original: do
    as the original program does where that differs. kernel: a name of `smoothing.NAMES`. h_option: 0 h is constant, 1
    dh/dt = h div v / d, 2 h = h0 (rho0/rho)^(1/d). relaxation: factor of all velocities in each step (dynamic
    relaxation), 1 for none. planes: of the boundary, see `ghosts`. traced: ids of particles, transducers: places and
    indices of bodies, whose state each row of the history has. cures: see `Cures`. pinball: bodies repel by balls of
    this factor Kp (`contact.pinball`, STIFF is a good one), pinball_as_printed: by the rule as printed.
    contact_damping: fraction of a pair's critical damping, of contact and walls. friction: of bodies that repel;
    friction_between: of two bodies (indices) where that is another. walls: rigid planes. contact_by_normals: forces
    between bodies act along the normals of the contact: particles then slide over a coarse wall as over a smooth one
    (their centres turn nothing exactly). local_steps: stiff bodies take several steps within one of the others
    (`local`); None: where that goes and is worth while. axisymmetric: a plane problem whose x is the distance from the
    axis y; masses are those of whole rings (`rings`). sleep: what moves slower than this part of sqrt(g h) for a time
    is held until it is pushed (`rest`), 0 for none. birth: (n,) times before which a particle only goes straight on
    with its velocity (`births`); 0: from the start; infinite: never. driven: (n,) particles whose velocity is given
    from outside, as nodes of a structure (`driving`); facets: the surface of a structure that they touch (`facing`).
    """

    dimension: int
    x: Floats
    v: Floats
    mass: Floats
    h: Floats
    density: Floats
    body: NDArray[np.int64]
    bodies: tuple[Body, ...]
    end_time: float
    fixed: NDArray[np.bool_] | None = None
    energy: Floats | None = None
    stress: Floats | None = None
    id: NDArray[np.int64] | None = None
    step_option: int = 2
    step_factor: float = 0.8
    first_step: float = 0.0
    potential: bool = False
    body_force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    original: bool = False
    body_curve: tuple[Floats, Floats] | None = None
    kernel: str = "cubic"
    h_option: int = 0
    relaxation: float = 1.0
    planes: tuple[Plane, ...] = ()
    traced: tuple[int, ...] = ()
    transducers: tuple[tuple[float, float, float, int], ...] = ()
    cures: Cures = field(default_factory=lambda: Cures())
    title: str = field(default="")
    pinball: float | None = None
    pinball_as_printed: bool = False
    contact_damping: float = 0.0
    friction: Coulomb | Drag | None = None
    friction_between: tuple[tuple[int, int, Coulomb], ...] = ()
    walls: tuple[Wall, ...] = ()
    contact_by_normals: bool = False
    local_steps: bool | None = False
    axisymmetric: bool = False
    driven: NDArray[np.bool_] | None = None
    facets: Facets | None = None
    sleep: float = 0.0
    birth: Floats | None = None

    def __post_init__(self) -> None:
        n = len(self.x)
        if n == 0:
            raise ValueError("a particle run needs at least one particle")
        if self.dimension not in (1, 2, 3):
            raise ValueError(f"dimension {self.dimension} must be 1, 2 or 3")
        if self.step_option not in STEP_OPTIONS:
            raise ValueError(f"step option {self.step_option} must be one of {sorted(STEP_OPTIONS)}")
        if self.h_option not in (0, 1, 2):
            raise ValueError(f"h option {self.h_option} must be 0, 1 or 2")
        shape_of(self.kernel, self.dimension)
        for axis in range(3):
            sides = {plane.side for plane in self.planes if plane.axis == axis and plane.kind == PERIODIC}
            if len(sides) == 1:
                raise ValueError(f"a periodic plane across {'xyz'[axis]} needs its opposite")
        for name, value in (("mass", self.mass), ("smoothing length", self.h), ("density", self.density)):
            if value.shape != (n,) or not np.all(value > 0.0) or not np.all(np.isfinite(value)):
                raise ValueError(f"every particle needs a positive {name}")
        for name, vectors in (("position", self.x), ("velocity", self.v)):
            if vectors.shape != (n, 3) or not np.all(np.isfinite(vectors)):
                raise ValueError(f"every particle needs a finite {name} of three components")
            if np.any(vectors[:, self.dimension :]):
                raise ValueError(f"a {self.dimension}D problem has a {name} outside its {self.dimension} dimension(s)")
        if self.pinball is not None and (self.potential or not self.pinball > 0.0):
            raise ValueError(f"the pinball factor {self.pinball!r} must be positive, and excludes the potential")
        if (self.friction is not None or self.friction_between) and not self.apart:
            raise ValueError("friction between bodies needs contact by the potential or by pinballs")
        if isinstance(self.friction, Drag) and self.friction_between:
            raise ValueError("fluid friction is the same between all bodies")
        if self.contact_by_normals and not self.apart:
            raise ValueError("contact by normals needs the potential or pinballs")
        if not 0.0 <= self.contact_damping <= 1.0:
            raise ValueError(f"contact damping {self.contact_damping!r} must lie between 0 and 1")
        if self.axisymmetric:
            self._check_revolution()
        if self.driven is not None and not self.apart and self.cures.artificial_stress > 0.0:
            raise ValueError("artificial stress between grain and structure needs contact that keeps them apart")
        if self.birth is not None:
            self._check_births()
        if self.body.min() < 0 or self.body.max() >= len(self.bodies):
            raise ValueError("a particle's body is not among the bodies")

    def _check_births(self) -> None:
        """Raises ValueError for births that cannot be."""
        assert self.birth is not None
        if self.birth.shape != self.mass.shape or not np.all(self.birth >= 0.0):
            raise ValueError("every particle needs a time of birth, which is not negative")
        if np.all(self.birth > 0.0):
            raise ValueError("all particles are born later: a run begins with one at least")
        if any(b.lagrangian for b in self.bodies):
            raise ValueError("a total-Lagrangian body has the neighbours of its start: no particle is born later")
        if self.original:
            raise ValueError("the original program's arithmetic has no births")

    def _check_revolution(self) -> None:
        """Raises ValueError for what a body of revolution does not have."""
        if self.dimension != 2:
            raise ValueError("a body of revolution is a problem of 2 dimensions")
        if not np.all(self.x[:, 0] > 0.0):
            raise ValueError("a particle lies on the axis or beyond it: x is the radius, above 0")
        if AXIS not in self.planes:
            raise ValueError("a body of revolution needs its axis x = 0 among the symmetry planes")
        refused = {
            "the total-Lagrangian formulation": any(b.lagrangian for b in self.bodies),
            "contact by the potential or by pinballs": self.apart,
            "artificial stress": self.cures.artificial_stress > 0.0,
            "XSPH": self.cures.xsph > 0.0,
            "pair viscosity": any(b.alpha or b.beta for b in self.bodies),
            "a wall that bears its neighbours' stress": any(b.bearing for b in self.bodies),
            "another plane below along x than the axis": any(
                p.axis == 0 and p.side < 0 and p != AXIS for p in self.planes
            ),
            "a periodic plane across x": any(p.axis == 0 and p.kind == PERIODIC for p in self.planes),
            "a structure": self.driven is not None or self.facets is not None,
            "a rigid plane that is not normal to the axis": any(w.normal[0] != 0.0 for w in self.walls),
            "a body force across the axis": self.body_force[0] != 0.0
            or (self.body_curve is not None and bool(np.any(self.body_curve[1][:, 0]))),
            "what the original program does": self.original,
        }
        for what, asked in refused.items():
            if asked:
                raise ValueError(f"an axisymmetric run does not go with {what}")

    @property
    def held(self) -> NDArray[np.bool_]:
        """(n,) particles that no force moves: fixed in all directions, or driven."""
        held = np.zeros(len(self.x), bool)
        if self.fixed is not None:
            held |= self.fixed[:, : self.dimension].all(axis=1)
        return held if self.driven is None else held | self.driven

    @property
    def sections(self) -> Floats:
        """(n,) volumes of the particles, in as many dimensions as the sums have: of rings the areas of sections."""
        volume = self.mass / self.density
        return volume / (TURN * self.x[:, 0]) if self.axisymmetric else volume

    @property
    def apart(self) -> bool:
        """Whether bodies repel each other; otherwise they are ordinary neighbours."""
        return self.potential or self.pinball is not None
