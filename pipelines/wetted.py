"""The wetted surface of a structure: the outer faces of its solids, its shells, the outer edges of plane elements."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.elements import TABLE
from zrno.translators.model import ElementBlock, Model

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Wetted:
    """nodes: (m,) indices into the model's; x: (m, 3) their places; facets: (f, 3) triangles
    or (f, 2) segments, indices into `nodes`.

    half: (f,) half the thickness of shells, 0 elsewhere; closed: (f,) whether the facet bounds a solid, whose outside
    is where its normal points (of a segment: to the right of its way); area: (m,) of each node, a length in the plane.
    """

    nodes: Ints
    x: Floats
    facets: Ints
    half: Floats
    closed: NDArray[np.bool_]
    area: Floats


def wetted(model: Model, parts: Collection[int] | None = None) -> Wetted:
    """The surface of a structure, or of some of its parts. Raises ValueError where there is none."""
    flat = model.dimension == 2
    facets: list[Ints] = []
    half: list[Floats] = []
    closed: list[NDArray[np.bool_]] = []
    chosen = [(block, np.ones(len(block.ids), bool) if parts is None else np.isin(block.part, list(parts)))
              for block in model.blocks if block.kind in TABLE]  # fmt: skip
    for block, rows in chosen:
        if TABLE[block.kind].dimension == 2 and not flat and rows.any():
            pieces = _split(block, [_cycle(block.kind, 0)], rows)
            found = np.concatenate(pieces)
            thickness = _thickness(model, block)[rows]
            facets.append(found)
            half.append(np.tile(0.5 * thickness, len(pieces)))
            closed.append(np.zeros(len(found), bool))
    bodies = [
        (block, rows) for block, rows in chosen if TABLE[block.kind].dimension == (2 if flat else 3) and rows.any()
    ]
    outer = _outer_edges(model, bodies) if flat else _outer_faces(model, bodies)
    facets.append(outer)
    half.append(np.zeros(len(outer)))
    closed.append(np.ones(len(outer), bool))
    every = np.concatenate([f.reshape(-1, 2 if flat else 3) for f in facets])
    if not len(every):
        raise ValueError("the structure has no surface that grain could touch")
    nodes, inverse = np.unique(every, return_inverse=True)
    every = inverse.reshape(every.shape)
    x = model.xyz[nodes]
    sides = x[every[:, 1:]] - x[every[:, :1]]
    size = (
        np.linalg.norm(sides[:, 0], axis=1)
        if flat
        else 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    )
    corners = len(every[0])
    area: Floats = np.bincount(every.ravel(), np.repeat(size / corners, corners), minlength=len(nodes)).astype(float)
    return Wetted(nodes, x, every, np.concatenate(half), np.concatenate(closed), area)


def _cycle(kind: str, face: int) -> list[tuple[int, int, int]]:
    """The triangles of a face, by the places of its nodes in the element."""
    border, centre = TABLE[kind].face_cycle(face)
    n = len(border)
    if centre is not None:
        return [(border[k], border[(k + 1) % n], centre) for k in range(n)]
    match n:
        case 3:
            return [(border[0], border[1], border[2])]
        case 4:
            return [(border[0], border[1], border[2]), (border[0], border[2], border[3])]
        case 6:
            a, b, c, d, e, f = border
            return [(a, b, f), (b, c, d), (d, e, f), (b, d, f)]
        case _:
            a, b, c, d, e, f, g, h = border
            return [(a, b, h), (b, c, d), (d, e, f), (f, g, h), (b, d, h), (d, f, h)]


def _split(block: ElementBlock, cycles: list[list[tuple[int, int, int]]], rows: Any) -> list[Ints]:
    """(elements, 3) of each triangle."""
    return [block.nodes[rows][:, list(triangle)] for cycle in cycles for triangle in cycle]


def _thickness(model: Model, block: ElementBlock) -> Floats:
    own = block.data.get("thickness")
    if own is not None:
        return np.asarray(own, dtype=float) if own.ndim == 1 else own.mean(axis=1)
    of_part = {
        number: float(model.sections[part.section].parameters.get("thickness", 0.0) if part.section else 0.0)
        for number, part in model.parts.items()
    }
    return np.array([of_part.get(p, 0.0) for p in block.part.tolist()])


def _once(corners: list[Ints]) -> NDArray[np.bool_]:
    """Which of these faces (each padded with -1 to the same width) are no other's."""
    key = np.sort(np.concatenate(corners), axis=1)
    _, inverse, count = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    out: NDArray[np.bool_] = count[inverse.ravel()] == 1
    return out


def _outer_faces(model: Model, bodies: list[tuple[ElementBlock, Any]]) -> Ints:
    """(f, 3) triangles of the faces that only one solid has, their normals out of it."""
    corners, pieces, centres = [], [], []
    for block, rows in bodies:
        nodes = block.nodes[rows]
        middle = model.xyz[nodes].mean(axis=1)
        for face, own in enumerate(TABLE[block.kind].shape.faces):
            key = nodes[:, list(own)]
            corners.append(np.pad(key, ((0, 0), (0, 4 - key.shape[1])), constant_values=-1))
            pieces.append([nodes[:, list(t)] for t in _cycle(block.kind, face)])
            centres.append(middle)
    if not corners:
        return np.empty((0, 3), np.int64)
    outer = np.split(_once(corners), np.cumsum([len(c) for c in corners])[:-1])
    found = [
        _turned(model, triangles[mine], centre[mine])
        for mine, own, centre in zip(outer, pieces, centres, strict=True)
        for triangles in own
    ]
    return np.concatenate(found)


def _turned(model: Model, triangles: Ints, centre: Floats) -> Ints:
    """Triangles with their normals away from the centres of their elements."""
    a, b, c = (model.xyz[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), (a + b + c) / 3.0 - centre) < 0.0
    triangles = triangles.copy()
    triangles[inward] = triangles[inward][:, [0, 2, 1]]
    return triangles


def _outer_edges(model: Model, bodies: list[tuple[ElementBlock, Any]]) -> Ints:
    """(f, 2) segments of the edges that only one element of the plane has, the element to the left of their way."""
    corners, pieces = [], []
    for block, rows in bodies:
        nodes = block.nodes[rows]
        element = TABLE[block.kind]
        x = model.xyz[nodes[:, : element.shape.corners]]
        after = np.roll(x, -1, axis=1)
        backward = (x[:, :, 0] * after[:, :, 1] - x[:, :, 1] * after[:, :, 0]).sum(axis=1) < 0.0
        for k, (a, b) in enumerate(element.shape.edges):
            path = [a, element.shape.corners + k, b] if element.mid_edges else [a, b]
            own = nodes[:, path]
            own[backward] = own[backward][:, ::-1]
            corners.append(nodes[:, [a, b]])
            pieces.append([own[:, [i, i + 1]] for i in range(len(path) - 1)])
    if not corners:
        return np.empty((0, 2), np.int64)
    outer = np.split(_once(corners), np.cumsum([len(c) for c in corners])[:-1])
    return np.concatenate([s[mine] for mine, own in zip(outer, pieces, strict=True) for s in own])
