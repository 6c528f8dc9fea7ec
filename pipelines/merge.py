"""Several meshes as one: ids are offset so that none stands twice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from zrno.translators.model import ElementBlock, Model


def merge(models: Sequence[Model]) -> Model:
    """The meshes of several models in one. Raises ValueError for decks, whose materials and control cannot be added.

    Ids of nodes, elements, parts and sets of each further model start past the largest of those before it.
    """
    if len(models) == 1:
        return models[0]
    if any(model.particles is not None for model in models):
        raise ValueError("several sources are merged as meshes; a particle deck cannot be one of them")
    whole = Model(title=models[0].title, format=models[0].format, dimension=max(m.dimension for m in models))
    whole.warnings = [warning for model in models for warning in model.warnings]
    elements = 0
    for model in models:
        nodes, start = len(whole.xyz), int(whole.node_ids.max(initial=0))
        part = max(whole.parts, default=0)
        sets = max((s.id for s in whole.node_sets), default=0)
        whole.node_ids = np.concatenate([whole.node_ids, model.node_ids + start])
        whole.xyz = np.concatenate([whole.xyz, model.xyz])
        whole.parts |= {number + part: replace(p, id=number + part) for number, p in model.parts.items()}
        whole.node_sets += [replace(s, id=s.id + sets, nodes=s.nodes + nodes) for s in model.node_sets]
        whole.includes += model.includes
        whole.incomplete += model.incomplete
        whole.blocks += [
            ElementBlock(block.kind, block.ids + elements, block.nodes + nodes, block.part + part)
            for block in model.blocks
        ]
        elements = max((int(block.ids.max(initial=0)) for block in whole.blocks), default=0)
    return whole
