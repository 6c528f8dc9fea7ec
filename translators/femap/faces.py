"""Which element's face a face of the model is: its number in FEMAP, and its sense."""

from __future__ import annotations

import numpy as np

from zrno.translators.femap.topology import faces_of
from zrno.translators.femap.write_mesh import Mesh
from zrno.translators.model import Floats, Ints


def find_faces(mesh: Mesh, faces: Ints) -> tuple[Ints, Ints, Floats]:
    """Element number (0: none), number of the face, and sign (-1: the element has it turned) of faces (n, k)."""
    wanted = np.full((len(faces), 4), -1)
    wanted[:, : min(4, faces.shape[1])] = faces[:, :4]
    distinct, inverse = np.unique(wanted, axis=0, return_inverse=True)
    n = len(distinct)
    ids, numbers, signs = np.zeros(n, np.int64), np.zeros(n, np.int64), np.ones(n)
    # both senses in one table; a face that an element has as it is goes before one that is turned
    keys = np.concatenate([_keys(distinct), _keys(_turned(distinct))])
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    marked = np.zeros(len(mesh.model.xyz) + 1, bool)
    marked[wanted] = True
    marked[-1] = False
    for block, block_ids in zip(mesh.blocks, mesh.ids, strict=True):
        for number, corners in enumerate(faces_of(block.kind), 1):
            near = np.flatnonzero(marked[block.nodes[:, list(corners)]].all(axis=1))
            if not len(near):
                continue
            cells = np.full((len(near), 4), -1)
            cells[:, : len(corners)] = block.nodes[near][:, list(corners)]
            mine = _keys(cells)
            for side in ("left", "right"):  # a face of which the model has both senses stands twice
                place = np.searchsorted(ordered, mine, side=side) - (side == "right")
                at = order[np.clip(place, 0, len(order) - 1)]
                hit = np.flatnonzero(keys[at] == mine)
                face, sign = at[hit] % n, np.where(at[hit] < n, 1.0, -1.0)
                better = (ids[face] == 0) | (sign > signs[face])
                hit, face, sign = hit[better], face[better], sign[better]
                ids[face], numbers[face], signs[face] = block_ids[near[hit]], number, sign
    inverse = inverse.reshape(-1)
    return ids[inverse], numbers[inverse], signs[inverse]


def _turned(faces: Ints) -> Ints:
    """Faces (n, 4) with their corners in the other sense; -1 stays behind."""
    turned = faces[:, [0, 3, 2, 1]]
    for count, order in ((3, [0, 2, 1, 3]), (2, [1, 0, 2, 3])):
        mine = (faces >= 0).sum(axis=1) == count
        turned[mine] = faces[mine][:, order]
    return turned


def _keys(faces: Ints) -> Ints:
    """A number for each face (n, 4) that is the same wherever its cycle begins: equal faces have equal numbers."""
    counts = (faces >= 0).sum(axis=1)
    canonical = faces.copy()
    for count in (2, 3, 4):
        mine = np.flatnonzero(counts == count)
        if count > 2:  # an edge keeps its sense
            start = np.argmin(faces[mine][:, :count], axis=1)
            order = (start[:, None] + np.arange(count)) % count
            canonical[mine[:, None], np.arange(count)] = np.take_along_axis(faces[mine], order, axis=1)
    hashed = np.zeros(len(faces), np.uint64)
    for column in canonical.T:
        hashed = (hashed ^ column.astype(np.uint64)) * np.uint64(0x9E3779B97F4A7C15)
        hashed ^= hashed >> np.uint64(29)
    return hashed.view(np.int64)
