"""What is done to a mesh: sets, constraints, loads, motions, curves, contacts. Plain dataclasses over numpy arrays.

Nodes are indices into `Model.xyz`. Degrees of freedom are 1..6: ux uy uz rx ry rz, in the global system unless `system`
names another. Values are in the units of the file; a curve's number says how they change in time, None: they do not.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Source:
    """Where an item was read, for messages."""

    file: str
    line: int


@dataclass(slots=True)
class NodeSet:
    """A named group of nodes. nodes: (n,) indices into `Model.xyz`, in the order of the file."""

    id: int
    name: str
    nodes: Ints
    source: Source | None = None


@dataclass(slots=True)
class ElementSet:
    """A named group of elements. family: whose numbers they are (`ElementBlock.family`); elements: (n,) element ids."""

    id: int
    name: str
    family: str
    elements: Ints
    source: Source | None = None


@dataclass(slots=True)
class PartSet:
    """A named group of parts. parts: (n,) part ids."""

    id: int
    name: str
    parts: Ints
    source: Source | None = None


@dataclass(slots=True)
class SegmentSet:
    """A named group of element faces. segments: (n, 4) indices into `Model.xyz`; a triangle repeats its third node."""

    id: int
    name: str
    segments: Ints
    source: Source | None = None


@dataclass(slots=True)
class Curve:
    """A function of time, or of another abscissa. points: (n, 2) abscissa and ordinate, scales and offsets applied.

    At a jump (two points of the same abscissa) the left value counts.
    """

    id: int
    name: str
    points: Floats
    source: Source | None = None


@dataclass(slots=True)
class CoordinateSystem:
    """A local system. kind: "rectangular", "cylindrical" or "spherical"; axes: (3, 3), a unit vector a row."""

    id: int
    name: str
    kind: str
    origin: Floats
    axes: Floats
    source: Source | None = None


@dataclass(slots=True)
class Constraint:
    """Degrees of freedom held at zero. nodes: (n,); dofs: (n, 6) bool; set: the node set that it was given by.

    birth, death: when it holds; None: from the start, for ever.
    """

    nodes: Ints
    dofs: NDArray[np.bool_]
    id: int = 0
    name: str = ""
    set: int | None = None
    system: int = 0
    source: Source | None = None
    birth: float | None = None
    death: float | None = None


@dataclass(slots=True)
class Equation:
    """A linear relation: the sum of coefficients times degrees of freedom is zero; the first term is the dependent one.

    nodes, dofs, coefficients: (k,).
    """

    nodes: Ints
    dofs: Ints
    coefficients: Floats
    id: int = 0
    source: Source | None = None


@dataclass(slots=True)
class NodalLoad:
    """Forces on nodes, or motions that they are given.

    kind: "force" (dof 4-6: moment), "displacement", "velocity", "acceleration", "temperature" (dof 0); nodes, dofs,
    values: (n,); curve: of all of them; set: the node set that it was given by; birth, death: when it acts.
    """

    kind: str
    nodes: Ints
    dofs: Ints
    values: Floats
    curve: int | None = None
    id: int = 0
    name: str = ""
    set: int | None = None
    system: int = 0
    birth: float | None = None
    death: float | None = None
    native: dict[str, Any] = field(default_factory=dict)
    source: Source | None = None


@dataclass(slots=True)
class FaceLoad:
    """Pressure or traction on faces of elements, or on edges of plane ones.

    faces: (n, k) indices into `Model.xyz`, corners first, -1 where there is none; values: (n, c), at the corners or one
    for all; direction: 0 pressure (positive: against the right-hand normal of the face's nodes), 1, 2, 3: traction
    along x, y, z; set: the segment set that it was given by.
    """

    faces: Ints
    values: Floats
    direction: int = 0
    curve: int | None = None
    id: int = 0
    name: str = ""
    set: int | None = None
    native: dict[str, Any] = field(default_factory=dict)
    source: Source | None = None


@dataclass(slots=True)
class BodyLoad:
    """Acceleration of the material by gravity and the like: force = mass x acceleration (3,). parts: None means all.

    LS-DYNA's base acceleration has the other sign: readers and writers turn it.
    """

    acceleration: tuple[float, float, float]
    curve: int | None = None
    parts: tuple[int, ...] | None = None
    source: Source | None = None


@dataclass(slots=True)
class InitialVelocity:
    """Velocities at the start. nodes: (n,); velocity: (n, 3), rotation: (n, 3) or None; later ones overrule."""

    nodes: Ints
    velocity: Floats
    rotation: Floats | None = None
    set: int | None = None
    source: Source | None = None


@dataclass(slots=True)
class Contact:
    """Contact between surfaces.

    kind: the format's own name of it; a, b: slave and master, what and which: ("part" | "part set" | "segment set" |
    "node set" | "shell set" | "all" | "other parts" | "other", id); static, kinetic: friction.
    """

    kind: str
    a: tuple[str, int]
    b: tuple[str, int]
    static: float = 0.0
    kinetic: float = 0.0
    id: int = 0
    name: str = ""
    native: dict[str, Any] = field(default_factory=dict)
    source: Source | None = None
