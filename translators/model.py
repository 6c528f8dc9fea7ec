"""The model: what every reader fills and every writer drains.

Plain dataclasses over numpy arrays, in the units of the file they came from. Elements point at nodes by index
(0-based, VTK order); parts, materials and particles keep the numbers of their file. What no common name covers stands
in `native`, by the source format's own names: it is written back into the same format, and reported as dropped else.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.conditions import BodyLoad as BodyLoad
from zrno.translators.conditions import Constraint as Constraint
from zrno.translators.conditions import Contact as Contact
from zrno.translators.conditions import CoordinateSystem as CoordinateSystem
from zrno.translators.conditions import Curve as Curve
from zrno.translators.conditions import ElementSet as ElementSet
from zrno.translators.conditions import Equation as Equation
from zrno.translators.conditions import FaceLoad as FaceLoad
from zrno.translators.conditions import Floats as Floats
from zrno.translators.conditions import InitialVelocity as InitialVelocity
from zrno.translators.conditions import Ints as Ints
from zrno.translators.conditions import NodalLoad as NodalLoad
from zrno.translators.conditions import NodeSet as NodeSet
from zrno.translators.conditions import PartSet as PartSet
from zrno.translators.conditions import SegmentSet as SegmentSet
from zrno.translators.conditions import Source as Source
from zrno.translators.control import Analysis as Analysis
from zrno.translators.control import FemControl as FemControl
from zrno.translators.control import ParticleControl as ParticleControl

PARTICLE_FAMILIES = ("sph", "sphere")


@dataclass(slots=True)
class ElementBlock:
    """Elements of one shape.

    kind: name in `elements.TABLE` ("hex8", "quad4", ...); ids: (n,), which are unique in a family; nodes: (n, k)
    indices into `Model.xyz`, in VTK order; part: (n,) part ids. family: "solid", "shell", "tshell" (thick shell: a
    volume that is computed as a shell), "plane" (an area in a plane problem), "beam", "truss", "spring", "mass", "sph",
    "sphere" (of discrete elements), "rigid"; "" where the source does not say: then the dimension alone tells.
    data: what elements have of their own, (n, ...) each, 0 or NaN where the part's section rules:
      thickness (n,) or (n, corners); orientation (n, 3), a beam's; orientation_node (n,), index or -1; angle (n,), of
      the material axes [degrees]; offset (n,); mass, volume, radius, inertia (n,); birth, death (n,).
    """

    kind: str
    ids: Ints
    nodes: Ints
    part: Ints
    family: str = ""
    data: dict[str, NDArray[Any]] = field(default_factory=dict)


@dataclass(slots=True)
class Part:
    """A named group of elements: one body, one material, one section. eos: number of the equation of state."""

    id: int
    name: str = ""
    material: int | None = None
    dimension: int | None = None
    source: Source | None = None
    section: int | None = None
    eos: int | None = None
    native: dict[str, Any] = field(default_factory=dict)


@dataclass(slots=True)
class Section:
    """What the elements of parts have in common beside the material.

    kind: as `ElementBlock.family`. parameters, those that the kind has: thickness (or thickness_1 .. thickness_4),
    area, iyy, izz, iyz, j (of torsion), shear_factor, shear_area_y, shear_area_z, integration_points, h_factor, h_min,
    h_max, h (smoothing length), mass, stiffness, damping. plane: "stress", "strain" or "axisymmetric".
    """

    id: int
    name: str = ""
    kind: str = ""
    parameters: dict[str, float] = field(default_factory=dict)
    plane: str = ""
    native: dict[str, Any] = field(default_factory=dict)
    source: Source | None = None


@dataclass(slots=True)
class Eos:
    """An equation of state: a row of `laws.EQUATIONS_OF_STATE`, and its parameters by name."""

    id: int
    name: str = ""
    law: str = ""
    parameters: dict[str, float] = field(default_factory=dict)
    native: dict[str, Any] = field(default_factory=dict)
    source: Source | None = None


@dataclass(slots=True)
class Material:
    """A material and, for a particle deck, what its block says of the particles that own it.

    law: a row of `laws.LAWS`, or "" for one that only its format knows (`native`); parameters: the law's numbers by
    name, in the units of the deck; tables: (n, 2) arrays by name ("hardening": effective plastic strain, stress);
    curves: numbers of curves that stand for parameters or tables, by name; eos: its equation of state, where the
    material names one itself. mass: total mass of the material; h: smoothing length; viscosity_quadratic,
    viscosity_linear: artificial viscosity; rho_min, rho_max: density limits. None means "the deck's default", so that a
    deck is written back as it was read.
    """

    id: int
    name: str = ""
    law: str = "elastic"
    density: float = 0.0
    parameters: dict[str, float] = field(default_factory=dict)
    mass: float = 0.0
    h: float = 0.0
    rho_min: float | None = None
    rho_max: float | None = None
    viscosity_quadratic: float | None = None
    viscosity_linear: float | None = None
    source: Source | None = None
    tables: dict[str, Floats] = field(default_factory=dict)
    curves: dict[str, int] = field(default_factory=dict)
    eos: int | None = None
    native: dict[str, Any] = field(default_factory=dict)


@dataclass(slots=True)
class Particles:
    """Particles of a deck, numbered 1..n in this order.

    x: positions (n, 3), unused components zero; material: (n,) material numbers; bc: (n,) boundary codes (0 free, 1 x,
    2 y, 3 z, 4 xy, 5 yz, 6 xz, 7 all fixed). Optional, one value a particle: mass, h, rho, e (n,); velocity (n, 3).
    """

    x: Floats
    material: Ints
    bc: Ints
    velocity: Floats | None = None
    mass: Floats | None = None
    h: Floats | None = None
    rho: Floats | None = None
    e: Floats | None = None

    def __len__(self) -> int:
        return len(self.x)


@dataclass(slots=True)
class Model:
    """Everything that a mesh or a deck says."""

    title: str = ""
    format: str = ""
    version: str = ""
    dimension: int = 3  # of the space: 2 where all is flat (constant z) and no volume or shell in space is meant
    node_ids: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    xyz: Floats = field(default_factory=lambda: np.empty((0, 3)))
    node_data: dict[str, NDArray[Any]] = field(default_factory=dict)  # (n, ...) each, by the source format's own names
    blocks: list[ElementBlock] = field(default_factory=list)
    parts: dict[int, Part] = field(default_factory=dict)
    sections: dict[int, Section] = field(default_factory=dict)
    materials: dict[int, Material] = field(default_factory=dict)
    equations_of_state: dict[int, Eos] = field(default_factory=dict)
    curves: dict[int, Curve] = field(default_factory=dict)
    systems: dict[int, CoordinateSystem] = field(default_factory=dict)
    node_sets: list[NodeSet] = field(default_factory=list)
    element_sets: list[ElementSet] = field(default_factory=list)
    part_sets: list[PartSet] = field(default_factory=list)
    segment_sets: list[SegmentSet] = field(default_factory=list)
    fixed: NDArray[np.bool_] | None = None  # (n, 6): degrees of freedom that the node cards themselves hold
    constraints: list[Constraint] = field(default_factory=list)
    equations: list[Equation] = field(default_factory=list)
    nodal_loads: list[NodalLoad] = field(default_factory=list)
    face_loads: list[FaceLoad] = field(default_factory=list)
    body_loads: list[BodyLoad] = field(default_factory=list)
    initial_velocities: list[InitialVelocity] = field(default_factory=list)
    contacts: list[Contact] = field(default_factory=list)
    analysis: Analysis = field(default_factory=Analysis)
    fem_control: FemControl | None = None
    particles: Particles | None = None
    particle_control: ParticleControl | None = None
    velocity_overrun: int = 0  # velocity cards past the last particle: a coupled deck's finite element nodes
    includes: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    incomplete: list[str] = field(default_factory=list)  # what is named but not there: no target can be made of it
    native: dict[str, Any] = field(default_factory=dict)  # by format: what only its own writer understands

    def element_counts(self) -> dict[str, int]:
        """Elements of each kind, in all blocks; particles of a mesh are not among them."""
        counts: Counter[str] = Counter()
        for block in self.blocks:
            if block.family not in PARTICLE_FAMILIES:
                counts[block.kind] += len(block.ids)
        return dict(counts)

    def particle_count(self) -> int:
        """Particles of a deck, and of a mesh (smoothed particles and discrete spheres)."""
        own = 0 if self.particles is None else len(self.particles)
        return own + sum(len(block.ids) for block in self.blocks if block.family in PARTICLE_FAMILIES)

    def bounding_box(self) -> list[list[float]] | None:
        """[[min], [max]] over nodes and particles; None of an empty model."""
        points = [
            a for a in (self.xyz, None if self.particles is None else self.particles.x) if a is not None and len(a)
        ]
        if not points:
            return None
        return [
            np.min([a.min(axis=0) for a in points], axis=0).tolist(),
            np.max([a.max(axis=0) for a in points], axis=0).tolist(),
        ]

    def summary(self) -> dict[str, Any]:
        """The keys of `zrno info --json`."""
        return {
            "format": self.format,
            "version": self.version,
            "dimension": self.dimension,
            "nodes": len(self.xyz),
            "elements": self.element_counts(),
            "particles": self.particle_count(),
            "parts": {str(i): p.name for i, p in self.parts.items()},
            "materials": {
                str(i): {"name": m.name, "law": m.law, "density": m.density} for i, m in self.materials.items()
            },
            "sets": self._set_sizes(),
            "bounding_box": self.bounding_box(),
            "includes": list(self.includes),
            "warnings": list(self.warnings),
        }

    def _set_sizes(self) -> dict[str, int]:
        """Members of each set by its name, or by its kind and number; a name that stands twice gets the number too."""
        sets = [
            *((s.name, s.id, "node", len(s.nodes)) for s in self.node_sets),
            *((s.name, s.id, s.family or "element", len(s.elements)) for s in self.element_sets),
            *((s.name, s.id, "part", len(s.parts)) for s in self.part_sets),
            *((s.name, s.id, "segment", len(s.segments)) for s in self.segment_sets),
        ]
        names = Counter(name for name, *_ in sets)
        sizes: dict[str, int] = {}
        for name, number, kind, size in sets:
            if name:
                sizes[name if names[name] == 1 else f"{name} ({kind} {number})"] = size
            else:
                sizes[str(number) if kind == "node" else f"{kind} {number}"] = size
        return sizes
