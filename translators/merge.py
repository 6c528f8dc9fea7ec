"""Several models as one: numbers are offset so that none stands twice."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from zrno.translators.model import Model
from zrno.translators.rewire import rewire


def merge(models: Sequence[Model]) -> Model:
    """The meshes of several models in one, with all that is done to them.

    Numbers of nodes, elements, parts and all other items of each further model start past the largest of those before
    it; what rules the run (control cards, times) is the first one's that says something. Raises ValueError for particle
    decks, whose particles cannot be added.
    """
    whole = models[0]
    if len(models) > 1 and any(model.particles is not None for model in models):
        raise ValueError("several sources are merged as meshes; a particle deck cannot be one of them")
    for model in models[1:]:
        whole = _both(whole, model)
    return whole


@dataclass(frozen=True, slots=True)
class _Offsets:
    """What is added to each kind of number of the second model."""

    node: int
    element: int
    part: int
    section: int
    material: int
    eos: int
    curve: int
    system: int
    set: int
    condition: int


def _both(a: Model, b: Model) -> Model:
    o = _Offsets(
        node=int(a.node_ids.max(initial=0)),
        element=max((int(block.ids.max(initial=0)) for block in a.blocks), default=0),
        part=_largest(a.parts, (int(block.part.max(initial=0)) for block in a.blocks)),
        section=_largest(a.sections),
        material=_largest(a.materials),
        eos=_largest(a.equations_of_state),
        curve=_largest(a.curves),
        system=_largest(a.systems),
        set=_largest_id(a.node_sets, a.element_sets, a.part_sets, a.segment_sets),
        condition=_largest_id(a.constraints, a.nodal_loads, a.face_loads, a.equations, a.contacts),
    )
    first = len(a.xyz)
    moved = _moved(rewire(b, np.arange(len(b.xyz)) + first), o)
    fixed = None
    if a.fixed is not None or b.fixed is not None:
        fixed = np.concatenate([np.zeros((len(m.xyz), 6), bool) if m.fixed is None else m.fixed for m in (a, b)])
    lists = (
        "blocks", "node_sets", "element_sets", "part_sets", "segment_sets", "constraints", "equations", "nodal_loads",
        "face_loads", "body_loads", "initial_velocities", "contacts", "includes", "warnings",
    )  # fmt: skip
    maps = ("parts", "sections", "materials", "equations_of_state", "curves", "systems")
    joined: dict[str, Any] = {name: [*getattr(a, name), *getattr(moved, name)] for name in lists}
    joined |= {name: getattr(a, name) | getattr(moved, name) for name in maps}
    return replace(
        a,
        dimension=max(a.dimension, b.dimension),
        node_ids=np.concatenate([a.node_ids, b.node_ids + o.node]),
        xyz=np.concatenate([a.xyz, b.xyz]),
        fixed=fixed,
        analysis=a.analysis if a.analysis.end_time is not None else b.analysis,
        fem_control=a.fem_control or b.fem_control,
        **joined,
    )


def _largest(*numbers: Iterable[int]) -> int:
    return max((number for some in numbers for number in some), default=0)


def _largest_id(*lists: Sequence[Any]) -> int:
    return _largest(item.id for items in lists for item in items)


def _moved(model: Model, o: _Offsets) -> Model:
    """The model with all its numbers offset."""

    def number(value: int | None, offset: int) -> int | None:
        return None if value is None else value + offset

    def conditions(items: Iterable[Any]) -> list[Any]:
        return [
            replace(
                item,
                id=item.id + o.condition,
                **({"set": number(item.set, o.set)} if hasattr(item, "set") else {}),
                **({"curve": number(item.curve, o.curve)} if hasattr(item, "curve") else {}),
                **({"system": item.system and item.system + o.system} if hasattr(item, "system") else {}),
            )
            for item in items
        ]

    surfaces = {"part": o.part, "all": 0}
    return replace(
        model,
        blocks=[
            replace(b, ids=b.ids + o.element, part=np.where(b.part > 0, b.part + o.part, b.part))
            for b in model.blocks
        ],
        parts={
            n + o.part: replace(
                p, id=n + o.part, material=number(p.material, o.material), section=number(p.section, o.section),
                eos=number(p.eos, o.eos),
            )
            for n, p in model.parts.items()
        },
        sections={n + o.section: replace(s, id=n + o.section) for n, s in model.sections.items()},
        materials={
            n + o.material: replace(
                m, id=n + o.material, eos=number(m.eos, o.eos), curves={k: c + o.curve for k, c in m.curves.items()}
            )
            for n, m in model.materials.items()
        },
        equations_of_state={n + o.eos: replace(e, id=n + o.eos) for n, e in model.equations_of_state.items()},
        curves={n + o.curve: replace(c, id=n + o.curve) for n, c in model.curves.items()},
        systems={n + o.system: replace(s, id=n + o.system) for n, s in model.systems.items()},
        node_sets=[replace(s, id=s.id + o.set) for s in model.node_sets],
        element_sets=[replace(s, id=s.id + o.set, elements=s.elements + o.element) for s in model.element_sets],
        part_sets=[replace(s, id=s.id + o.set, parts=s.parts + o.part) for s in model.part_sets],
        segment_sets=[replace(s, id=s.id + o.set) for s in model.segment_sets],
        constraints=conditions(model.constraints),
        equations=conditions(model.equations),
        nodal_loads=conditions(model.nodal_loads),
        face_loads=conditions(model.face_loads),
        body_loads=[
            replace(load, curve=number(load.curve, o.curve),
                    parts=None if load.parts is None else tuple(p + o.part for p in load.parts))
            for load in model.body_loads
        ],
        initial_velocities=[replace(v, set=number(v.set, o.set)) for v in model.initial_velocities],
        contacts=[
            replace(c, id=c.id + o.condition, a=(c.a[0], c.a[1] + surfaces.get(c.a[0], o.set)),
                    b=(c.b[0], c.b[1] + surfaces.get(c.b[0], o.set)))
            for c in model.contacts
        ],
    )  # fmt: skip
