"""What a finite element run is given: arrays and numbers, no files.

Degrees of freedom are 0..5: ux uy uz rx ry rz. Nodes are indices. Units are those of the deck.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SMALL, TOTAL, UPDATED = "small", "total", "updated"


@dataclass(frozen=True, slots=True)
class Elements:
    """Elements of one kind, one material and one formulation.

    kind: of `shapes.NODES`, or "spring", "mass"; family: "solid", "plane", "shell", "truss", "beam", "spring", "mass";
    nodes: (e, n); ids: (e,) of the deck; material: its number in the deck. geometry: SMALL strain, TOTAL or UPDATED
    Lagrangian. gauss: points by direction, 0 the usual; modes: number of enhanced strains; mean: whether dilatation is
    the element's mean; plane: "strain", "stress", "axisymmetric"; thickness: (e,) or (e, n); layers: points through a
    shell's thickness; section: a beam's or truss's numbers by name (area, iyy, izz, j, shear_y, shear_z);
    orientation: (e, 3) a beam's; value: (e, ...) stiffness of springs, mass of masses; birth, death: (e,) times;
    expansion: strain in all directions by a degree of temperature above `reference`.
    """

    kind: str
    family: str
    nodes: Ints
    ids: Ints
    material: int
    law: Any
    density: float = 0.0
    geometry: str = SMALL
    gauss: tuple[int, ...] = ()
    modes: int = 0
    mean: bool = False
    plane: str = ""
    thickness: Floats | None = None
    layers: int = 2
    shear_factor: float = 5.0 / 6.0
    section: dict[str, float] = field(default_factory=dict)
    orientation: Floats | None = None
    value: Floats | None = None
    birth: Floats | None = None
    death: Floats | None = None
    expansion: float = 0.0
    reference: float = 0.0


@dataclass(frozen=True, slots=True)
class Curve:
    """A function of time, piecewise linear; at a jump the left value counts. times, values: (m,)."""

    times: Floats
    values: Floats

    def __call__(self, t: float) -> float:
        i = int(np.searchsorted(self.times, t, side="left"))
        if i == 0:
            return float(self.values[0])
        if i == len(self.times):
            return float(self.values[-1])
        t0, t1 = self.times[i - 1], self.times[i]
        return float(self.values[i - 1] + (self.values[i] - self.values[i - 1]) * (t - t0) / (t1 - t0))


@dataclass(frozen=True, slots=True)
class NodalLoad:
    """Forces or moments. nodes, dofs, values: (m,); curve: index or None; shift: added to the curve's time."""

    nodes: Ints
    dofs: Ints
    values: Floats
    curve: int | None = None
    shift: float = 0.0


@dataclass(frozen=True, slots=True)
class Motion:
    """Prescribed displacements. incremental: the curve's value is added in each step, not the total."""

    nodes: Ints
    dofs: Ints
    values: Floats
    curve: int | None = None
    incremental: bool = False


@dataclass(frozen=True, slots=True)
class Temperature:
    """Temperatures of nodes. nodes, values: (m,)."""

    nodes: Ints
    values: Floats
    curve: int | None = None


@dataclass(frozen=True, slots=True)
class FaceLoad:
    """Pressure (direction 0, against the right-hand normal) or traction along an axis (1, 2, 3) on faces.

    kind: of the faces' shape; nodes: (f, n); values: (f, n) at the nodes; follows: whether pressure turns with the
    face; thickness: (f,) of edges of plane elements; plane: theirs.
    """

    kind: str
    nodes: Ints
    values: Floats
    direction: int = 0
    curve: int | None = None
    follows: bool = False
    thickness: Floats | None = None
    plane: str = ""


@dataclass(frozen=True, slots=True)
class BodyLoad:
    """Acceleration (3,) of the material of all elements, or of those of some materials."""

    acceleration: Floats
    curve: int | None = None
    materials: tuple[int, ...] | None = None


@dataclass(frozen=True, slots=True)
class Relation:
    """A linear relation: a dependent degree of freedom is the sum of coefficients times others.

    nodes, dofs, coefficients: (k,).
    """

    node: int
    dof: int
    nodes: Ints
    dofs: Ints
    coefficients: Floats


@dataclass(frozen=True, slots=True)
class Stop:
    """A rigid smooth plane that nodes cannot pass: a point of it, its normal towards them, and how stiff it is, in
    multiples of the structure's own stiffness at each node."""

    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    stiffness: float = 3.0


@dataclass(frozen=True, slots=True)
class Path:
    """Loads that are found. node, dof: whose first increment is `first` (its sign is the way to go); controlled: each
    step is as long there, else the length of arc that this makes."""

    node: int
    dof: int
    first: float
    controlled: bool = False


@dataclass(frozen=True, slots=True)
class Iteration:
    """How equilibrium is found.

    method: "newton" (factors in each iteration), "adaptive" (where the last one did not leave less than a tenth of the
    residual, and in each where nodes turn) or "modified" (of the step's start alone); search: line search; most:
    iterations; energy, force, displacement: relative tolerances, 0 not asked; cuts: how often a step is halved that
    does not converge.
    """

    method: str = "adaptive"
    search: bool = False
    most: int = 20
    energy: float = 0.0
    force: float = 1e-6
    displacement: float = 0.0
    cuts: int = 8


@dataclass(frozen=True, slots=True)
class Dynamics:
    """method: "newmark", "hht", "wilson", "central"; parameters as named there; lumped: the mass; mass_damping,
    stiffness_damping: Rayleigh's."""

    method: str = "newmark"
    beta: float = 0.25
    gamma: float = 0.5
    alpha: float = 0.0
    theta: float = 1.4
    lumped: bool = False
    mass_damping: float = 0.0
    stiffness_damping: float = 0.0


@dataclass(frozen=True, slots=True)
class Problem:
    """A structure and what is done to it.

    x: (n, 3); node_ids: (n,) of the deck; fixed: (n, 6) held at zero; free: (n, 6) False where the deck suppresses
    a degree of freedom of all nodes; steps: (periods, 2) number and length; modes: eigenvalues asked for, 0 none.
    displacement, velocity: (n, 6) at the start, or None. rigid: nothing is solved, see `guided`.
    """

    title: str
    dimension: int
    x: Floats
    node_ids: Ints
    elements: tuple[Elements, ...]
    fixed: NDArray[np.bool_]
    curves: tuple[Curve, ...] = ()
    nodal_loads: tuple[NodalLoad, ...] = ()
    motions: tuple[Motion, ...] = ()
    face_loads: tuple[FaceLoad, ...] = ()
    body_loads: tuple[BodyLoad, ...] = ()
    temperatures: tuple[Temperature, ...] = ()
    relations: tuple[Relation, ...] = ()
    stops: tuple[Stop, ...] = ()
    steps: tuple[tuple[int, float], ...] = ((1, 1.0),)
    iteration: Iteration = field(default_factory=Iteration)
    path: Path | None = None
    dynamics: Dynamics | None = None
    modes: int = 0
    displacement: Floats | None = None
    velocity: Floats | None = None
    solver: str = "auto"
    rigid: bool = False

    def ends(self) -> Floats:
        """(steps + 1,) when each step ends, the start first."""
        found = [0.0]
        for count, length in self.steps:
            found += (found[-1] + length * np.arange(1, count + 1)).tolist()
        return np.array(found)

    @property
    def end_time(self) -> float:
        """When the last step ends."""
        return float(self.ends()[-1])
