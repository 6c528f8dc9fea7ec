"""Everything in a model that points at nodes, pointed elsewhere: for merging models and for taking parts of one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from zrno.translators.model import (
    Constraint,
    ElementBlock,
    FaceLoad,
    InitialVelocity,
    Ints,
    Model,
    NodalLoad,
    NodeSet,
    SegmentSet,
)


def rewire(model: Model, new: Ints) -> Model:
    """The model with node i as node new[i]; what stood on a node whose new[i] is -1 is gone.

    The nodes' own arrays (`node_ids`, `xyz`, `fixed`) are the caller's to arrange.
    """
    return replace(
        model,
        blocks=[_block(block, new) for block in model.blocks],
        node_sets=[_set(nodes, new) for nodes in model.node_sets],
        segment_sets=[_segments(segments, new) for segments in model.segment_sets],
        constraints=[c for c in (_constraint(c, new) for c in model.constraints) if len(c.nodes)],
        equations=[replace(e, nodes=new[e.nodes]) for e in model.equations if (new[e.nodes] >= 0).all()],
        nodal_loads=[load for load in (_load(load, new) for load in model.nodal_loads) if len(load.nodes)],
        face_loads=[load for load in (_faces(load, new) for load in model.face_loads) if len(load.faces)],
        initial_velocities=[v for v in (_velocity(v, new) for v in model.initial_velocities) if len(v.nodes)],
    )


def keep_parts(model: Model, parts: Ints) -> Model:
    """The model with the elements of these parts alone, their nodes, and what stands on them."""
    blocks = []
    for block in model.blocks:
        mine = np.isin(block.part, parts)
        if mine.any():
            data = {name: values[mine] for name, values in block.data.items()}
            blocks.append(
                replace(block, ids=block.ids[mine], nodes=block.nodes[mine], part=block.part[mine], data=data)
            )
    used = np.zeros(len(model.xyz), bool)
    for block in blocks:
        used[block.nodes.ravel()] = True
        others = block.data.get("orientation_node")
        if others is not None:
            used[others[others >= 0]] = True
    new = np.where(used, np.cumsum(used) - 1, -1)
    kept = rewire(replace(model, blocks=blocks), new)
    kept.node_ids, kept.xyz = model.node_ids[used], model.xyz[used]
    kept.fixed = None if model.fixed is None else model.fixed[used]
    kept.parts = {number: part for number, part in model.parts.items() if number in parts}
    kept.node_sets = [nodes for nodes in kept.node_sets if len(nodes.nodes)]
    kept.segment_sets = [segments for segments in kept.segment_sets if len(segments.segments)]
    ids = {block.family: np.concatenate([b.ids for b in blocks if b.family == block.family]) for block in blocks}
    kept.element_sets = [
        replace(s, elements=s.elements[np.isin(s.elements, ids[s.family])])
        for s in model.element_sets
        if s.family in ids
    ]
    kept.part_sets = [replace(s, parts=s.parts[np.isin(s.parts, parts)]) for s in model.part_sets]
    return kept


def _block(block: ElementBlock, new: Ints) -> ElementBlock:
    data = dict(block.data)
    if "orientation_node" in data:
        old = data["orientation_node"]
        data["orientation_node"] = np.where(old >= 0, new[old], -1)
    return replace(block, nodes=new[block.nodes], data=data)


def _set(nodes: NodeSet, new: Ints) -> NodeSet:
    moved = new[nodes.nodes]
    return replace(nodes, nodes=moved[moved >= 0])


def _segments(segments: SegmentSet, new: Ints) -> SegmentSet:
    moved = new[segments.segments]
    return replace(segments, segments=moved[(moved >= 0).all(axis=1)])


def _constraint(constraint: Constraint, new: Ints) -> Constraint:
    moved = new[constraint.nodes]
    return replace(constraint, nodes=moved[moved >= 0], dofs=constraint.dofs[moved >= 0])


def _load(load: NodalLoad, new: Ints) -> NodalLoad:
    moved = new[load.nodes]
    there = moved >= 0
    return replace(load, nodes=moved[there], dofs=load.dofs[there], values=load.values[there])


def _faces(load: FaceLoad, new: Ints) -> FaceLoad:
    moved = np.where(load.faces >= 0, new[load.faces], -1)
    whole = ((moved >= 0) | (load.faces < 0)).all(axis=1)
    return replace(load, faces=moved[whole], values=load.values[whole])


def _velocity(velocity: InitialVelocity, new: Ints) -> InitialVelocity:
    moved = new[velocity.nodes]
    there = moved >= 0
    rotation = None if velocity.rotation is None else velocity.rotation[there]
    return replace(velocity, nodes=moved[there], velocity=velocity.velocity[there], rotation=rotation)
