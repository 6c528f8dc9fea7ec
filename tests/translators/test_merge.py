"""Several models as one, and parts of one: what points at nodes still points at the same places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from zrno.translators.merge import merge
from zrno.translators.model import (
    BodyLoad,
    Constraint,
    Contact,
    Curve,
    ElementBlock,
    ElementSet,
    Equation,
    FaceLoad,
    InitialVelocity,
    Material,
    Model,
    NodalLoad,
    NodeSet,
    Part,
    Particles,
    PartSet,
    Section,
    SegmentSet,
)
from zrno.translators.rewire import keep_parts


def two_quads() -> Model:
    """Two quads side by side in two parts, with one of everything that points at nodes on each of the quads."""
    xyz = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], float)
    quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])
    model = Model(node_ids=np.arange(10, 16), xyz=xyz, parts={2: Part(2, "a", 1, section=1), 5: Part(5, "b", 1)})
    model.blocks = [ElementBlock("quad4", np.array([7, 9]), quads, np.array([2, 5]), "shell", {"offset": np.ones(2)})]
    model.sections = {1: Section(1, "", "shell", {"thickness": 0.5})}
    model.materials = {1: Material(1, "steel", curves={"hardening": 3})}
    model.curves = {3: Curve(3, "", np.zeros((2, 2)))}
    model.node_sets = [NodeSet(1, "left", np.array([0, 3])), NodeSet(2, "middle", np.array([1, 4]))]
    model.element_sets = [ElementSet(1, "all", "shell", np.array([7, 9]))]
    model.part_sets = [PartSet(3, "both", np.array([2, 5]))]
    model.segment_sets = [SegmentSet(4, "faces", quads.copy())]
    model.fixed = np.zeros((6, 6), bool)
    model.fixed[0] = True
    held = np.array([0, 2])
    model.constraints = [Constraint(held, np.ones((2, 6), bool), set=1)]
    model.equations = [Equation(np.array([0, 1]), np.array([1, 1]), np.array([1.0, -1.0])),
                       Equation(np.array([1, 2]), np.array([1, 1]), np.array([1.0, -1.0]))]  # fmt: skip
    model.nodal_loads = [NodalLoad("force", held, np.array([1, 2]), np.array([5.0, 6.0]), 3, set=2)]
    model.face_loads = [FaceLoad(np.column_stack([quads, [-1, -1]]), np.ones((2, 1)), curve=3)]
    model.body_loads = [BodyLoad((0.0, 0.0, -9.8), 3, (5,))]
    model.initial_velocities = [InitialVelocity(held, np.array([[1.0, 0, 0], [2.0, 0, 0]]))]
    model.contacts = [Contact("single", ("part", 2), ("node set", 1))]
    return model


def test_merged_numbers_do_not_meet() -> None:
    a, b = two_quads(), two_quads()
    b.xyz[:, 2] = 5.0
    both = merge([a, b])
    assert both.node_ids.tolist() == [*range(10, 16), *range(25, 31)]
    assert sorted(both.parts) == [2, 5, 7, 10]
    assert [block.ids.tolist() for block in both.blocks] == [[7, 9], [16, 18]]
    assert [block.part.tolist() for block in both.blocks] == [[2, 5], [7, 10]]
    second = both.parts[7]
    assert (second.material, second.section) == (2, 2)
    assert both.materials[2].curves == {"hardening": 6}
    pointed = [both.blocks[1].nodes, both.node_sets[2].nodes, both.segment_sets[1].segments, both.equations[2].nodes]
    pointed += [item[1].nodes for item in (both.constraints, both.nodal_loads, both.initial_velocities)]
    assert all((both.xyz[nodes][..., 2] == 5).all() for nodes in pointed)
    assert both.face_loads[1].faces[:, 4].tolist() == [-1, -1]
    assert (both.constraints[1].set, both.nodal_loads[1].set, both.nodal_loads[1].curve) == (5, 6, 6)
    assert both.node_sets[2].id == both.constraints[1].set
    assert (both.body_loads[1].curve, both.body_loads[1].parts) == (6, (10,))
    assert (both.contacts[1].a, both.contacts[1].b) == (("part", 7), ("node set", 5))
    assert both.fixed.sum() == 12
    assert both.fixed[6].all()
    assert (both.element_sets[1].elements.tolist(), both.part_sets[1].parts.tolist()) == ([16, 18], [7, 10])


def test_one_model_is_itself() -> None:
    model = two_quads()
    assert merge([model]) is model


def test_particle_decks_are_not_merged() -> None:
    deck = Model(particles=Particles(np.zeros((1, 3)), np.ones(1, int), np.zeros(1, int)))
    with pytest.raises(ValueError, match="a particle deck cannot be one of them"):
        merge([two_quads(), deck])


def test_some_parts_keep_what_stands_on_them() -> None:
    model = two_quads()
    part = keep_parts(model, np.array([5]))
    assert part.node_ids.tolist() == [11, 12, 14, 15]
    assert part.xyz[part.blocks[0].nodes].tolist() == model.xyz[model.blocks[0].nodes[1:]].tolist()
    assert (part.blocks[0].ids.tolist(), part.blocks[0].data["offset"].tolist()) == ([9], [1.0])
    assert list(part.parts) == [5]
    assert [(s.name, s.nodes.tolist()) for s in part.node_sets] == [("middle", [0, 2])]
    assert part.segment_sets[0].segments.tolist() == [[0, 1, 3, 2]]
    assert part.constraints[0].nodes.tolist() == [1]
    assert [e.nodes.tolist() for e in part.equations] == [[0, 1]]
    load = part.nodal_loads[0]
    assert (load.nodes.tolist(), load.dofs.tolist(), load.values.tolist()) == ([1], [2], [6.0])
    assert part.face_loads[0].faces.tolist() == [[0, 1, 3, 2, -1]]
    assert part.initial_velocities[0].velocity.tolist() == [[2.0, 0.0, 0.0]]
    assert (part.element_sets[0].elements.tolist(), part.part_sets[0].parts.tolist()) == ([9], [5])
    assert not part.fixed.any()
    assert model.node_ids.tolist() == list(range(10, 16))  # the whole is as it was


def test_nothing_left_of_what_stood_elsewhere() -> None:
    model = replace(two_quads(), constraints=[Constraint(np.array([2]), np.ones((1, 6), bool))])
    assert keep_parts(model, np.array([2])).constraints == []
