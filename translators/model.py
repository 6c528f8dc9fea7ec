"""The model: what every reader fills and every writer drains.

Plain dataclasses over numpy arrays, in the units of the file they came from. Elements point at nodes by index
(0-based, VTK order); parts, materials and particles keep the numbers of their file.
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
class ElementBlock:
    """Elements of one shape.

    kind: name in `elements.TABLE` ("hex8", "quad4", ...); ids: (n,); nodes: (n, k) indices into `Model.xyz`, in VTK
    order; part: (n,) part ids.
    """

    kind: str
    ids: Ints
    nodes: Ints
    part: Ints


@dataclass(slots=True)
class Part:
    """A named group of elements: one body, one material."""

    id: int
    name: str = ""
    material: int | None = None
    dimension: int | None = None
    source: Source | None = None


@dataclass(slots=True)
class NodeSet:
    """A named group of nodes. nodes: (n,) indices into `Model.xyz`."""

    id: int
    name: str
    nodes: Ints
    source: Source | None = None


@dataclass(slots=True)
class Material:
    """A material and, for a particle deck, what its block says of the particles that own it.

    law: "elastic", "von_mises", ...; parameters: the law's numbers by name, in the units of the deck. mass: total mass
    of the material; h: smoothing length; viscosity_quadratic, viscosity_linear: artificial viscosity; rho_min, rho_max:
    density limits. None means "the deck's default", so that a deck is written back as it was read.
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
class ParticleControl:
    """Control cards 1-7 of a particle deck, by the deck's own terms; None or 0 mean the deck's default.

    places: line and column of what was read, by field, for messages.
    """

    dimension: int = 3
    discretisation: int = 0
    end_time: float = 0.0
    step_factor: float = 0.0
    initial_step: float = 0.0
    dynamic_relaxation: float = 0.0
    output_interval: float = 0.0
    state_option: int = 4
    history_interval: float = 0.0
    history_particles: list[int] = field(default_factory=list)
    transducers: list[tuple[float, ...]] = field(default_factory=list)
    status_interval: int = 0
    restart_interval: int = 0
    run_restart: int = 0
    keep_files: int = 1
    contact: int = 0
    step_option: int = 0
    velocity_option: int = 0
    h_option: int = 0
    kernel: int = 1
    max_neighbours: int = 0
    max_particles: int = 0
    dialect: str = "2.07"
    friction: tuple[float, float] | None = None
    fluid_friction: float | None = None
    base_acceleration: tuple[float, float, float] | None = None
    planes: list[tuple[int, float]] | None = None
    contact_option: int = 1
    contact_laws: list[tuple[float, float]] = field(default_factory=list)
    places: dict[str, tuple[int, int]] = field(default_factory=dict, compare=False)


@dataclass(slots=True)
class Model:
    """Everything that a mesh or a deck says."""

    title: str = ""
    format: str = ""
    version: str = ""
    dimension: int = 3
    node_ids: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    xyz: Floats = field(default_factory=lambda: np.empty((0, 3)))
    blocks: list[ElementBlock] = field(default_factory=list)
    parts: dict[int, Part] = field(default_factory=dict)
    node_sets: list[NodeSet] = field(default_factory=list)
    materials: dict[int, Material] = field(default_factory=dict)
    particles: Particles | None = None
    particle_control: ParticleControl | None = None
    velocity_overrun: int = 0  # velocity cards past the last particle: a coupled deck's finite element nodes
    includes: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def element_counts(self) -> dict[str, int]:
        """Elements of each kind, in all blocks."""
        counts: dict[str, int] = {}
        for block in self.blocks:
            counts[block.kind] = counts.get(block.kind, 0) + len(block.ids)
        return counts

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
            "particles": 0 if self.particles is None else len(self.particles),
            "parts": {str(i): p.name for i, p in self.parts.items()},
            "materials": {
                str(i): {"name": m.name, "law": m.law, "density": m.density} for i, m in self.materials.items()
            },
            "sets": {s.name or str(s.id): len(s.nodes) for s in self.node_sets},
            "bounding_box": self.bounding_box(),
            "includes": list(self.includes),
            "warnings": list(self.warnings),
        }
