"""Parts, sections, laws, curves, constraints, loads, motions, velocities, contacts: what the cards say in the model."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from zrno.translators import laws as vocabulary
from zrno.translators.lsdyna import laws
from zrno.translators.model import Model
from zrno.translators.text import InputError

Read = Callable[..., Model]


def test_the_deck_of_everything(deck: Read, everything: str) -> None:
    model = deck(everything)
    assert model.title == "All of it"
    assert (model.analysis.end_time, model.analysis.output_interval) == (12.5, 0.25)
    assert (model.analysis.initial_step, model.analysis.step_factor, model.analysis.kind) == (1e-5, 0.9, "explicit")
    assert {p.id: (p.name, p.section, p.material, p.eos, p.dimension) for p in model.parts.values()} == {
        1: ("a block, of steel", 1, 1, None, 3), 2: ("shell", 2, 2, None, 2), 3: ("beam", 3, 3, None, 1),
        4: ("sand", 4, 4, None, 0), 5: ("balls", 4, 5, 1, 0), 6: ("spring", 6, 6, None, 1),
    }  # fmt: skip
    assert [warning.partition(": ")[2] for warning in model.warnings] == [
        "*CONTROL_SPH: not read (1), kept for .k alone",
        "*MAT_SPRING_ELASTIC: the law of 1 materials is not read, kept for .k alone",
        "*HOURGLASS: not read (1), kept for .k alone",
        "1 motions of rigid parts stand on the nodes of the parts",
    ]


def test_sections(deck: Read, everything: str) -> None:
    sections = deck(everything).sections
    assert {n: (s.kind, s.parameters) for n, s in sections.items()} == {
        1: ("solid", {}),
        2: ("shell", {"shear_factor": 0.8, "integration_points": 5.0, "thickness": 2.0}),
        3: ("beam", {"area": 1.5, "iyy": 0.25, "izz": 0.5, "j": 0.75}),
        4: ("sph", {"h_factor": 1.1, "h_min": 0.3, "h_max": 2.5, "h": 9.0}),
        6: ("spring", {}),
    }


def test_beams_of_a_rectangle_and_of_a_tube(deck: Read) -> None:
    model = deck("*SECTION_BEAM\n1,1\n2.,2.,3.,3.\n2,1,,,1\n4.,4.,2.,2.\n3,3\n5.\n")
    assert model.sections[1].parameters == {"area": 6.0, "iyy": 2 * 27 / 12, "izz": 3 * 8 / 12}
    second = math.pi / 64 * (4**4 - 2**4)
    assert model.sections[2].parameters == {"area": math.pi * 3, "iyy": second, "izz": second, "j": 2 * second}
    assert model.sections[3].parameters == {"area": 5.0}


def test_laws_have_the_vocabularys_parameters_alone() -> None:
    for row in laws.MATERIALS.values():
        said = row.said({key: 1.0 for key in row.names.values()})
        assert set(said.parameters) <= set(vocabulary.LAWS[row.law].parameters)
        needed = {name for name, default in vocabulary.LAWS[row.law].parameters.items() if default is None}
        assert needed <= set(row.said({}).parameters)
    for row in laws.EQUATIONS.values():
        assert set(row.said({}).parameters) <= set(vocabulary.EQUATIONS_OF_STATE[row.law].parameters)


@pytest.mark.parametrize("row", [*laws.MATERIALS.values(), *laws.EQUATIONS.values()], ids=lambda row: str(row.keyword))
def test_a_laws_fields_and_words_say_the_same(row: laws.LawRow) -> None:
    fields = {key: 0.25 + i / 8 for i, key in enumerate(row.names.values())}
    for table in row.points.values():
        fields |= {key: [1.0, 2.0] for key in table}
    back, lost = row.fields(row.said(fields))
    assert not lost
    again = row.said(back)
    for name, value in row.said(fields).parameters.items():
        assert again.parameters[name] == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("keyword", "law"),
    [
        ("MAT_001", "elastic"), ("MAT_1", "elastic"), ("MAT_003", "von_mises"), ("MAT_005", "soil_foam"),
        ("MAT_009", "fluid"), ("MAT_010", "hydro"), ("MAT_010_SPALL", "hydro"), ("MAT_020", "rigid"),
        ("MAT_024", "von_mises"), ("MAT_025", "cap"), ("MAT_173", "mohr_coulomb"), ("MAT_193", "drucker_prager_soil"),
        ("EOS_001", "linear_polynomial"), ("EOS_004", "gruneisen"),
    ],
)  # fmt: skip
def test_numbered_names(keyword: str, law: str) -> None:
    row = laws.find(keyword)
    assert row is not None
    assert row.law == law
    assert laws.find(keyword + "_NONE") is None


def test_soils(deck: Read) -> None:
    model = deck(
        "*MAT_193\n1,2e-9,100.,.25,,.5,3.,.1\n\n\n*MAT_SOIL_AND_FOAM\n2,1.,10.,20.,.1,.2,.3,-4.\n1.,0.,7\n0.,-.1\n\n0.,5.\n\n"
    )
    soil = model.materials[1]
    assert soil.law == "drucker_prager_soil"
    assert soil.parameters == {"E": 250.0, "nu": 0.25, "c": 3.0, "phi": math.degrees(0.5), "psi": math.degrees(0.1)}
    foam = model.materials[2]
    assert foam.parameters == {
        "G": 10.0, "K": 20.0, "a0": 0.1, "a1": 0.2, "a2": 0.3, "pressure_cutoff": -4.0, "vcr": 1.0,
    }  # fmt: skip
    assert foam.tables["pressure"].tolist() == [[0.0, 0.0], [-0.1, 5.0]]
    assert foam.curves == {"pressure": 7}


def test_the_cap_model_of_a_deck(deck: Read, everything: str) -> None:
    cap = deck(everything).materials[4]
    assert (cap.law, cap.density) == ("cap", 1.85e-9)
    assert cap.parameters["tension_cutoff"] == -0.02
    assert [cap.parameters[n] for n in ("K", "G", "R", "D", "W", "X0", "ftype")] == [
        30.6,
        8.23,
        2.0,
        7.25,
        0.18,
        0.1,
        2,
    ]


def test_equations_of_state(deck: Read) -> None:
    model = deck(
        "*EOS_LINEAR_POLYNOMIAL\n1,0.,1.,2.,3.,4.,5.,6.\n7.,8.\n*EOS_IDEAL_GAS\n2,718.,1005.\n\n*EOS_MURNAGHAN\n3,7.,2.2e9\n"
        "*EOS_TABULATED\n4,1.\n"
    )
    found = model.equations_of_state
    assert found[1].parameters == {**{f"C{i}": float(i) for i in range(1, 7)}, "E0": 7.0, "V0": 8.0}
    assert (found[2].law, found[2].parameters) == ("perfect_gas", {"gamma": 1005.0 / 718.0})
    assert (found[3].law, found[3].parameters) == ("murnaghan", {"gamma": 7.0, "B": 2.2e9})
    assert (found[4].law, found[4].native["cards"]) == ("", ["4,1."])


def test_several_items_under_one_keyword_and_cards_that_are_not_there(deck: Read) -> None:
    model = deck(
        "*MAT_ELASTIC\n1,2.,3.,.1\n2,3.,4.,.2\n*MAT_RIGID\n3,1.,2.,.3\n*SECTION_SHELL\n1,2\n.5\n2,2\n.25\n*PART\na\n1\n\n2\n"
    )
    assert [m.density for m in model.materials.values()] == [2.0, 3.0, 1.0]
    assert [s.parameters["thickness"] for s in model.sections.values()] == [0.5, 0.25]
    assert {p.id: p.name for p in model.parts.values()} == {1: "a", 2: ""}


def test_parts_with_options(deck: Read) -> None:
    inertia = "0.,0.,0.,5.,1\n1.,0.,0.,1.,0.,1.\n0.,0.,0.\n0.,0.,1.\n"
    model = deck("*PART_INERTIA\nbody\n1,2,3\n" + inertia + "next\n4,5,6\n" + inertia)
    assert {p.id: (p.name, p.section, len(p.native["cards"])) for p in model.parts.values()} == {
        1: ("body", 2, 4), 4: ("next", 5, 4),
    }  # fmt: skip


def test_curves(deck: Read, everything: str) -> None:
    curves = deck(everything).curves
    assert (curves[7].name, curves[7].points.tolist()) == ("up and down", [[2.0, 1.5], [22.0, 4.5]])
    assert curves[8].points.tolist() == [[0.0, 1.0], [1.0, 2.5]]


def test_systems(deck: Read, everything: str) -> None:
    model = deck(everything)
    system = model.systems[3]
    assert (system.name, system.origin.tolist()) == ("turned", [0.0, 0.0, 1.0])
    assert system.axes.tolist() == [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    by_nodes = deck("*NODE\n1,1,0,0\n2,1,0,5\n3,4,0,0\n*DEFINE_COORDINATE_NODES\n7,1,2,3\n").systems[7]
    assert by_nodes.origin.tolist() == [1.0, 0.0, 0.0]
    assert by_nodes.axes.tolist() == [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]


def test_constraints(deck: Read, everything: str) -> None:
    held, local, limited = deck(everything).constraints
    assert (held.id, held.name, held.set, held.nodes.tolist()) == (101, "held below", 10, [0, 1, 2, 3])
    assert held.dofs.tolist() == [[True, True, True, False, False, False]] * 4
    assert (local.system, local.nodes.tolist(), local.dofs[:, :2].tolist()) == (3, [4, 5], [[1, 0], [0, 1]])
    assert (limited.birth, limited.death, limited.nodes.tolist()) == (0.5, 20.0, [6])


def test_motions_and_forces(deck: Read, everything: str) -> None:
    moved, along, rigid, forces, of_set = deck(everything).nodal_loads
    assert (moved.kind, moved.set, moved.dofs.tolist(), moved.values.tolist()) == (
        "displacement",
        10,
        [3] * 4,
        [2.0] * 4,
    )
    # along the vector (0, 0, -1) by 1.5: -1.5 in z
    assert (along.kind, along.dofs.tolist(), along.values.tolist()) == ("velocity", [3], [-1.5])
    assert (along.birth, along.death, along.curve) == (1.0, 10.0, 8)
    assert (rigid.kind, rigid.dofs[0], rigid.native["rigid_part"]) == ("acceleration", 4, 2)
    assert (forces.kind, forces.nodes.tolist(), forces.dofs.tolist()) == ("force", [6, 7], [3, 5])
    assert forces.values.tolist() == [-5.0, 2.5]
    assert (of_set.set, of_set.system, of_set.nodes.tolist()) == (10, 3, [0, 1, 2, 3])


def test_motions_that_are_not_read_are_kept(deck: Read, cube: str) -> None:
    model = deck(cube + "*BOUNDARY_PRESCRIBED_MOTION_NODE\n1,8,0,1,1.,5\n1,1,0,1\n")
    assert len(model.nodal_loads) == 1
    assert "motions of vad 0, dof 8 are not read (1), kept for .k alone" in model.warnings[0]


def test_gravity_turns_its_sign(deck: Read, everything: str) -> None:
    (load,) = deck(everything).body_loads
    assert (load.acceleration, load.curve, load.parts) == ((0.0, 0.0, -9.81), 8, None)
    limited = deck("*LOAD_BODY_Y\n1,-2.\n*LOAD_BODY_PARTS\n4\n*SET_PART\n4\n1,2\n").body_loads[0]
    assert (limited.acceleration, limited.parts) == ((0.0, 2.0, 0.0), (1, 2))
    assert deck("*LOAD_BODY_X\n1\n").body_loads[0].acceleration == (-1.0, 0.0, 0.0)


def test_pressures_keep_their_sign(deck: Read, everything: str) -> None:
    of_set, one = deck(everything).face_loads
    assert (of_set.set, of_set.curve, of_set.values.tolist()) == (13, 7, [[4.0], [4.0]])
    assert of_set.faces.tolist() == [[4, 5, 6, 7], [4, 5, 6, -1]]
    assert (one.faces.tolist(), one.values.tolist()) == ([[0, 3, 2, 1]], [[0.5]])


def test_initial_velocities(deck: Read, everything: str, cube: str) -> None:
    of_set, node, turning = deck(everything).initial_velocities
    assert (of_set.set, of_set.velocity.tolist()) == (10, [[1.0, 2.0, 3.0]] * 4)
    assert (node.nodes.tolist(), node.velocity.tolist()) == ([6], [[0.5, 0.0, 0.0]])
    place = {0: (0, 0), 1: (1, 0), 2: (1, 1)}
    for n, (x, y) in place.items():  # omega x r with omega = 2 about z
        assert turning.velocity[turning.nodes == n].tolist() == [[-2.0 * y, 2.0 * x, 0.0]]
    assert turning.rotation is not None
    model = deck(cube + "*INITIAL_VELOCITY\n0,9\n1.,0.,0.\n0.,5.,0.\n*SET_NODE\n9\n8,7\n")
    left, rest = model.initial_velocities
    assert (left.nodes.tolist(), left.velocity[0].tolist()) == ([6, 7], [0.0, 5.0, 0.0])
    assert (rest.nodes.tolist(), rest.velocity[0].tolist()) == ([0, 1, 2, 3, 4, 5], [1.0, 0.0, 0.0])


def test_contacts(deck: Read, everything: str) -> None:
    (contact,) = deck(everything).contacts
    assert (contact.kind, contact.id, contact.name) == ("AUTOMATIC_SURFACE_TO_SURFACE", 9, "between them")
    assert (contact.a, contact.b, contact.static, contact.kinetic) == (("part", 1), ("part set", 12), 0.25, 0.2)
    alone = deck("*CONTACT_AUTOMATIC_SINGLE_SURFACE\n0\n\n").contacts[0]
    assert (alone.a, alone.static) == (("all", 0), 0.0)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("*CONTROL_IMPLICIT_GENERAL\n1,.1\n", "static"),
        ("*CONTROL_IMPLICIT_GENERAL\n1,.1\n*CONTROL_IMPLICIT_DYNAMICS\n1\n", "dynamic"),
        ("*CONTROL_TERMINATION\n1.\n*CONTROL_IMPLICIT_EIGENVALUE\n5\n", "eigenvalues"),
        ("*CONTROL_TERMINATION\n1.\n", "explicit"),
        ("", ""),
    ],
)
def test_the_kind_of_analysis(deck: Read, text: str, kind: str) -> None:
    assert deck("*KEYWORD\n" + text).analysis.kind == kind


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("*BOUNDARY_SPC_SET\n7,0,1\n", ":11:1: error: there is no node set of this number (7)"),
        ("*LOAD_SEGMENT_SET\n7,1\n", ":11:1: error: there is no segment set of this number (7)"),
        ("*PART\nalone\n", ":11:1: error: a part without its card (alone)"),
        ("*PART\na\n0,1,1\n", ":12:1: error: a part's number is not positive (0)"),
        ("*DEFINE_COORDINATE_SYSTEM\n1,0.,0.,0.,1.,0.,0.\n2.,0.,0.\n", ":11:1: error: the axes of the coordinate"),
        ("*DEFINE_CURVE\n1,0,1e300,1e300\n1e300,1e300\n", "a curve's points are not finite"),
        ("*SECTION_BEAM\n1,1\n1e200,1e200,1e200,1e200\n*MAT_193\n1,1.,1e308,.3\n",
         ":14:1: error: E cannot be worked out"),
        ("*MAT_ELASTIC\n1,dense\n", ":11:3: error: ro is not a number (dense)"),
    ],
)  # fmt: skip
def test_faults_have_their_place(deck: Read, cube: str, text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        deck(cube + text)
    assert message in str(caught.value)


def test_velocities_of_many_nodes_are_arrays(deck: Read) -> None:
    nodes = "".join(f"{i},{i}.\n" for i in range(1, 201))
    speeds = "".join(f"{i:10d}{i / 10:10.1f}\n$ between\n" for i in range(1, 201))
    (one,) = deck(f"*NODE\n{nodes}*INITIAL_VELOCITY_NODE\n{speeds}").initial_velocities
    assert np.array_equal(one.velocity[:, 0], np.arange(1, 201) / 10)
