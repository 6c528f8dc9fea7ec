"""Meshes into particles: lattice filling, shells covered, nodes as particles, and the particles that a mesh has."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import TABLE
from zrno.translators.geometry import edge_lengths, measures, simplices
from zrno.translators.model import PARTICLE_FAMILIES, ElementBlock, Floats, Ints, Model
from zrno.translators.surfaces import cover

_CANDIDATES = 2_000_000  # lattice points tested at a time
_TOLERANCE = 1e-9  # of a simplex: a point on the face between two belongs to the part


@dataclass(slots=True)
class Filling:
    """Particles of some parts, the parts one after the other.

    x: (n, 3); part: (n,) part numbers; volume: (n,) each particle's share of its part's volume (area in 2D, times the
    unit depth); volumes: of each part, exactly; spacing: mean distance of neighbours by part; node: (n,) the node that
    a particle is, or -1; mass: (n,) where the mesh gives it, NaN where not.
    """

    x: Floats
    part: Ints
    volume: Floats
    volumes: dict[int, float]
    spacing: dict[int, float]
    node: Ints
    mass: Floats | None = None


def default_spacing(model: Model, parts: Sequence[int] | None = None) -> float:
    """The median edge length of the parts' elements."""
    blocks = [block for part in chosen_parts(model, parts) for block in _blocks_of(model, part, (2, 3))]
    return float(np.median(np.concatenate([edge_lengths(block, model.xyz) for block in blocks])))


def chosen_parts(model: Model, parts: Sequence[int] | None = None) -> list[int]:
    """The part numbers asked for, or all; ValueError for one that the mesh does not have or that has no elements."""
    filled = {int(number) for block in model.blocks for number in np.unique(block.part)}
    chosen = [number for number in model.parts if number in filled] if parts is None else list(parts)
    for number in chosen:
        if number not in filled or number not in model.parts:
            known = ", ".join(f"{i} {p.name}".strip() for i, p in model.parts.items())
            raise ValueError(f"the mesh has no part {number} with elements; it has: {known or 'none'}")
    if not chosen:
        raise ValueError("the mesh has no part to make particles of")
    return chosen


def fill(model: Model, spacing: float | None = None, *, parts: Sequence[int] | None = None) -> Filling:
    """Fill parts with particles on a square or cubic lattice.

    Each part has its own lattice, aligned with its bounding box: the spacing is adjusted in each direction so that a
    whole number of cells spans the box, and the first particle lies half a cell inside. A part's volume is shared
    equally among its particles. spacing: by default the median edge length of the mesh. A particle on the border of
    two parts belongs to the first. Raises ValueError for parts that are no areas or volumes, and for a spacing too
    coarse to put a particle into a part.
    """
    chosen = chosen_parts(model, parts)
    spacing = default_spacing(model, chosen) if spacing is None else spacing
    if not spacing > 0:
        raise ValueError(f"the spacing of particles is {spacing}; expected a positive length")
    pieces = []
    for number in chosen:
        blocks = _blocks_of(model, number)
        x, step = _lattice(blocks, model.xyz, spacing, model.dimension)
        pieces.append((number, x, step, _volume(blocks, model.xyz)))
    if len(pieces) > 1:
        pieces = _without_doubles(pieces, spacing)
    for number, x, _, _ in pieces:
        if not len(x):
            name = model.parts[number].name or str(number)
            raise ValueError(f"part {name}: no particle fits at a spacing of {spacing:g}; expected a finer spacing")
    x = np.concatenate([x for _, x, _, _ in pieces])
    return Filling(
        x,
        np.concatenate([np.full(len(x), number) for number, x, _, _ in pieces]),
        np.concatenate([np.full(len(x), volume / len(x)) for _, x, _, volume in pieces]),
        {number: volume for number, _, _, volume in pieces},
        {number: step for number, _, step, _ in pieces},
        np.full(len(x), -1),
    )


def on_shells(
    model: Model, spacing: float | None = None, *, parts: Sequence[int], thickness: Mapping[int, float]
) -> Filling:
    """Cover the shells of parts with particles, whose volume is their share of the area times the part's thickness."""
    spacing = default_spacing(model, parts) if spacing is None else spacing
    if not spacing > 0:
        raise ValueError(f"the spacing of particles is {spacing}; expected a positive length")
    found = [(number, *cover(_blocks_of(model, number, (2,)), model.xyz, spacing)) for number in parts]
    x = np.concatenate([x for _, x, _ in found])
    return Filling(
        x,
        np.concatenate([np.full(len(x), number) for number, x, _ in found]),
        np.concatenate([areas * thickness[number] for number, _, areas in found]),
        {number: math.fsum(areas) * thickness[number] for number, _, areas in found},
        {number: math.sqrt(math.fsum(areas) / len(areas)) for number, _, areas in found},
        np.full(len(x), -1),
    )


def own_particles(model: Model, parts: Sequence[int]) -> Filling:
    """The particles that the mesh itself has, part by part, with their masses and volumes (NaN where it says none)."""
    from scipy.spatial import cKDTree

    nodes: list[Ints] = []
    part: list[Ints] = []
    mass: list[Floats] = []
    volume: list[Floats] = []
    spacing, volumes = {}, {}
    for number in parts:
        for block in (b for b in model.blocks if b.family in PARTICLE_FAMILIES):
            mine = block.part == number
            nodes.append(block.nodes[mine, 0])
            part.append(block.part[mine])
            for name, values in (("mass", mass), ("volume", volume)):
                given = block.data.get(name)
                own = np.full(int(mine.sum()), np.nan) if given is None else given[mine].astype(float)
                values.append(np.where(own > 0, own, np.nan))
        x = model.xyz[np.concatenate([n for n, p in zip(nodes, part, strict=True) if len(p) and p[0] == number])]
        distance = cKDTree(x).query(x, k=2)[0][:, 1] if len(x) > 1 else np.zeros(1)
        spacing[number] = float(np.median(distance)) or 1.0
        volumes[number] = np.nan
    index = np.concatenate(nodes)
    return Filling(
        model.xyz[index].copy(), np.concatenate(part), np.concatenate(volume), volumes, spacing, index,
        np.concatenate(mass),
    )  # fmt: skip


def copy_nodes(
    model: Model, parts: Sequence[int] | None = None, thickness: Mapping[int, float] | None = None
) -> Filling:
    """The nodes of parts as particles, each with its share of the volume of the part's elements round it.

    An element's volume is shared equally by its nodes; a shell's in space is its area times the part's thickness. A
    node that several parts share belongs to the first of them; the others' shares grow in proportion, so that each part
    keeps its volume. The spacing is the median edge length.
    """
    chosen = chosen_parts(model, parts)
    owner = np.full(len(model.xyz), -1)
    shares = np.zeros(len(model.xyz))
    volumes, spacing = {}, {}
    for order, number in enumerate(chosen):
        blocks = _blocks_of(model, number, None if thickness is None else (2, 3))
        around, whole = np.zeros(len(model.xyz)), 0.0
        for block in blocks:
            deep = thickness is not None and TABLE[block.kind].dimension == 2 and model.dimension == 3
            volume = measures(block, model.xyz) * (thickness[number] if deep and thickness else 1.0)
            whole += math.fsum(volume)
            share = volume / block.nodes.shape[1]
            around += np.bincount(block.nodes.ravel(), np.repeat(share, block.nodes.shape[1]), len(model.xyz))
        volumes[number] = whole
        spacing[number] = float(np.median(np.concatenate([edge_lengths(block, model.xyz) for block in blocks])))
        own = (around > 0) & (owner < 0)
        if not own.any():
            raise ValueError(f"part {model.parts[number].name or number}: all its nodes belong to earlier parts")
        owner[own] = order
        shares[own] = around[own] * (volumes[number] / around[own].sum())
    nodes = np.flatnonzero(owner >= 0)
    nodes = nodes[np.argsort(owner[nodes], kind="stable")]
    return Filling(model.xyz[nodes].copy(), np.array(chosen)[owner[nodes]], shares[nodes], volumes, spacing, nodes)


def _volume(blocks: list[ElementBlock], xyz: Floats) -> float:
    return math.fsum(float(measures(block, xyz).sum()) for block in blocks)


def _blocks_of(model: Model, part: int, dimensions: tuple[int, ...] | None = None) -> list[ElementBlock]:
    """The elements of a part, block by block; of `dimensions`, by default areas in a flat mesh or volumes."""
    blocks = []
    for block in model.blocks:
        mask = block.part == part
        if mask.any():
            blocks.append(ElementBlock(block.kind, block.ids[mask], block.nodes[mask], block.part[mask]))
    wanted = dimensions or ((2,) if model.dimension == 2 else (3,))
    for block in blocks:
        if TABLE[block.kind].dimension not in wanted:
            name = model.parts[part].name or str(part)
            raise ValueError(
                f"part {name} is made of {block.kind}: particles fill volumes, and areas of a flat mesh (constant z); "
                "--particles shells covers shells in space, --particles nodes takes the nodes"
            )
    return blocks


def _lattice(blocks: list[ElementBlock], xyz: Floats, spacing: float, dimension: int) -> tuple[Floats, float]:
    """Lattice points inside the elements, x running slowest, and the mean spacing."""
    points = np.concatenate([xyz[np.unique(block.nodes)] for block in blocks])
    low, high = points.min(axis=0), points.max(axis=0)
    size = (high - low)[:dimension]
    # a spacing given in a few digits (0.0333 for 1/30) means the nearest whole number of cells
    cells = np.maximum(np.rint(size / spacing), 1).astype(np.int64)
    step = size / cells
    inside = np.zeros(int(cells.prod()), bool)
    for block in blocks:
        for corners in simplices(block, xyz):
            _mark(inside, cells, (corners[..., :dimension] - low[:dimension]) / step - 0.5)
    index = np.stack(np.unravel_index(np.flatnonzero(inside), tuple(cells)), axis=1)
    x = np.zeros((len(index), 3))
    x[:, :dimension] = low[:dimension] + (index + 0.5) * step
    # digits past the 15th of the largest coordinate are round-off: without them a deck's columns hold each exactly
    largest = max(float(np.abs(low).max()), float(np.abs(high).max()))
    x[:, :dimension] = np.round(x[:, :dimension], max(0, 14 - int(np.floor(np.log10(largest)))))
    return x, float(step.prod() ** (1.0 / dimension))


def _mark(inside: NDArray[np.bool_], cells: Ints, corners: Floats) -> None:
    """Mark the lattice points within simplices. corners: (n, d + 1, d) in lattice units, point (i, j, k) at i, j, k."""
    dimension = corners.shape[2]
    first = np.maximum(np.ceil(corners.min(axis=1) - _TOLERANCE), 0).astype(np.int64)
    last = np.minimum(np.floor(corners.max(axis=1) + _TOLERANCE), cells - 1).astype(np.int64)
    extent = np.maximum(last - first + 1, 0)
    counts = extent.prod(axis=1)
    edges = corners[:, 1:] - corners[:, :1]
    solid = (counts > 0) & (np.abs(np.linalg.det(edges)) > 0)
    first, extent, counts, edges, origin = first[solid], extent[solid], counts[solid], edges[solid], corners[solid, 0]
    inverse = np.linalg.inv(edges)
    ends = np.cumsum(counts)
    start = 0
    while start < len(counts):
        taken = ends[start - 1] if start else 0
        stop = max(int(np.searchsorted(ends, taken + _CANDIDATES, side="right")), start + 1)
        which = np.repeat(np.arange(start, stop), counts[start:stop])
        within = np.arange(len(which)) - np.repeat(ends[start:stop] - counts[start:stop] - taken, counts[start:stop])
        point = np.empty((len(which), dimension), np.int64)
        for axis in range(dimension - 1, -1, -1):
            within, point[:, axis] = np.divmod(within, extent[which, axis])
        point += first[which]
        natural = np.einsum("nd,nde->ne", point - origin[which], inverse[which])
        good = (natural >= -_TOLERANCE).all(axis=1) & (natural.sum(axis=1) <= 1 + _TOLERANCE)
        inside[np.ravel_multi_index(tuple(point[good].T), tuple(cells))] = True
        start = stop


_Piece = tuple[int, Floats, float, float]


def _without_doubles(pieces: list[_Piece], spacing: float) -> list[_Piece]:
    """Parts without the particles that lie where an earlier part has one: on the border that both share."""
    place = np.rint(np.concatenate([x for _, x, _, _ in pieces]) / (1e-6 * spacing)).astype(np.int64)
    _, first = np.unique(place, axis=0, return_index=True)
    keep = np.zeros(len(place), bool)
    keep[first] = True
    kept, start = [], 0
    for number, x, step, volume in pieces:
        kept.append((number, x[keep[start : start + len(x)]], step, volume))
        start += len(x)
    return kept
