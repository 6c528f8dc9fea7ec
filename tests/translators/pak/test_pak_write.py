from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from zrno.translators import load_settings
from zrno.translators import read as read_any
from zrno.translators.elements import TABLE
from zrno.translators.fem import to_fem
from zrno.translators.geometry import measures
from zrno.translators.model import (
    BodyLoad,
    Constraint,
    Contact,
    Curve,
    Equation,
    FaceLoad,
    FemControl,
    InitialVelocity,
    Model,
    NodalLoad,
)
from zrno.translators.pak import read, write

Mesh = Callable[..., Model]
SOLIDS = ["hex8", "hex20", "tet4", "tet10", "wedge6", "pyramid5"]
FLAT = ["quad4", "quad8", "quad9", "tri3", "tri6"]


def there_and_back(model: Model, path: Path) -> tuple[Model, list[str]]:
    """The model as it is read from its deck, which is written again with the same bytes; what the first write noted."""
    report = write(model, path / "a.dat")
    again = read(path / "a.dat")
    write(again, path / "b.dat")
    assert (path / "a.dat").read_bytes() == (path / "b.dat").read_bytes()
    return again, [item.what for item in (*report.approximated, *report.dropped)]


def faces(model: Model) -> list[tuple[str, list[list[float]]]]:
    """Kind and node positions of each element, in the order of their numbers."""
    rows = [
        (int(i), block.kind, model.xyz[nodes].tolist())
        for block in model.blocks
        for i, nodes in zip(block.ids, block.nodes, strict=True)
    ]
    return [(kind, points) for _, kind, points in sorted(rows)]


@pytest.mark.parametrize("kinds", [*[(kind,) for kind in SOLIDS], tuple(SOLIDS), ("wedge6", "hex8", "wedge6")])
def test_solids(tmp_path: Path, mesh: Mesh, strict: ModuleType, kinds: tuple[str, ...]) -> None:
    model = mesh(*kinds)
    again, notes = there_and_back(model, tmp_path)
    deck = strict.read(tmp_path / "a.dat")
    assert set(notes) <= {"tet10 elements"}
    assert sorted(map(str, faces(again))) == sorted(map(str, faces(model)))
    for number, (netip, _, _) in enumerate(deck.groups):
        assert netip == (33 if len(next(iter(deck.elements[number].values()))) == 10 else 3)
        if netip == 3:
            assert strict.jacobians(deck, number).min() > 0
        else:
            assert strict.tetrahedra(deck, number).min() > 0
    for block in again.blocks:
        assert (measures(block, again.xyz) > 0).all()


def test_mid_side_nodes_lie_on_the_edges_of_pak_s_own_numbering(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    write(mesh("hex20", "hex27"), tmp_path / "a.dat")
    deck = strict.read(tmp_path / "a.dat")
    edges = [(1, 2), (2, 3), (3, 4), (4, 1), (5, 6), (6, 7), (7, 8), (8, 5), (1, 5), (2, 6), (3, 7), (4, 8)]
    for nodes, count in zip(itertools.chain(*(e.values() for e in deck.elements)), (20, 21), strict=True):
        points = np.array([deck.xyz[node] for node in nodes if node])
        assert len(points) == count
        for k, (a, b) in enumerate(edges):
            assert np.allclose(points[8 + k], (points[a - 1] + points[b - 1]) / 2)
        if count == 21:
            assert np.allclose(points[20], points[:8].mean(axis=0))


def test_hexahedra_of_21_nodes_are_hex20_and_a_node(tmp_path: Path, mesh: Mesh) -> None:
    model = mesh("hex20", "hex27")
    again, notes = there_and_back(model, tmp_path)
    assert notes == ["hex27 elements"]
    assert again.element_counts() == {"hex20": 2}
    (other,) = (block for block in again.blocks if "node_21" in block.data)
    assert np.array_equal(again.xyz[other.data["node_21"][0]], model.xyz[model.blocks[1].nodes[0, 26]])
    assert not again.warnings


def test_a_hexahedron_s_first_face_is_the_upper_one(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    write(mesh("hex8"), tmp_path / "a.dat")
    assert next(iter(strict.read(tmp_path / "a.dat").elements[0].values()))[:8] == [5, 6, 7, 8, 1, 2, 3, 4]
    lines = (tmp_path / "a.dat").read_text().splitlines()
    at = lines.index("    5    6    7    8    1    2    3    4")
    assert lines[at + 1] == ""  # the second line of nodes is always there


@pytest.mark.parametrize("family", ["shell", "plane"])
@pytest.mark.parametrize("kinds", [*[(kind,) for kind in FLAT], tuple(FLAT)])
def test_shells_and_planes(tmp_path: Path, mesh: Mesh, strict: ModuleType, family: str, kinds: tuple[str, ...]) -> None:
    model = mesh(*kinds, family=family)
    model.dimension = 2 if family == "plane" else 3
    if family == "plane":
        model.sections[1].kind, model.sections[1].plane = "plane", "strain"
    again, notes = there_and_back(model, tmp_path)
    assert not notes
    assert sorted(map(str, faces(again))) == sorted(map(str, faces(model)))
    assert {block.family for block in again.blocks} == {family}
    assert again.dimension == model.dimension
    assert all((block.data["thickness"] == 0.5).all() for block in again.blocks)
    allowed = {"shell": {84, 8, 81}, "plane": {2, 21}}[family]
    assert {netip for netip, _, _ in strict.read(tmp_path / "a.dat").groups} <= allowed
    if family == "plane":
        assert {section.plane for section in again.sections.values()} == {"strain"}


@pytest.mark.parametrize(("asked", "types"), [(84, [84, 8, 84]), (8, [8, 8, 8]), (81, [84, 8, 81])])
def test_a_section_may_ask_for_a_type_of_shell(
    tmp_path: Path, mesh: Mesh, strict: ModuleType, asked: int, types: list[int]
) -> None:
    for kind, netip in zip(("quad4", "quad8", "tri3"), types, strict=True):
        model = mesh(kind)
        model.sections[1].native["NETIP"] = asked
        again, _ = there_and_back(model, tmp_path)
        assert strict.read(tmp_path / "a.dat").groups[0][0] == netip
        assert again.element_counts() == {kind: 1}


@pytest.mark.parametrize(("shells", "quadrilateral"), [("bathe_dvorkin", 84), ("isoparametric", 8)])
def test_triangles_of_a_shell_part_are_of_the_triangular_type(
    tmp_path: Path, mesh: Mesh, strict: ModuleType, shells: str, quadrilateral: int
) -> None:
    model, _ = to_fem(mesh("quad4", "tri3"), load_settings(overrides={"fem.shells": shells}))
    again, _ = there_and_back(model, tmp_path)
    deck = strict.read(tmp_path / "a.dat")
    corners = {group[0]: len(set(e[n]) - {0}) for group, e in zip(deck.groups, deck.elements, strict=True) for n in e}
    assert corners == {quadrilateral: 4, 81: 3}
    assert again.element_counts() == {"quad4": 1, "tri3": 1}


def test_trusses_and_beams(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    model = mesh("line2", "line2")
    model.blocks[1].family = "beam"
    model.blocks[1].data["orientation"] = np.array([[0.0, 0.0, 7.5]])
    again, notes = there_and_back(model, tmp_path)
    strict.read(tmp_path / "a.dat")
    assert not notes
    truss, beam = again.blocks
    assert (truss.family, beam.family) == ("truss", "beam")
    assert beam.data["orientation"].tolist() == [[0.0, 0.0, 7.5]]
    assert again.sections[1].parameters == {"area": 2.0}
    assert again.sections[2].parameters == {"area": 2.0, "iyy": 1.0, "izz": 1.0, "j": 0.5}


def test_tetrahedra_have_one_point_and_wedges_no_incompatible_modes(tmp_path: Path, mesh: Mesh) -> None:
    again, _ = there_and_back(mesh("hex8", "tet4", "wedge6"), tmp_path)
    by_kind = {b.kind: again.sections[again.parts[int(b.part[0])].section].native for b in again.blocks}
    assert [by_kind[kind]["NETIP"] for kind in ("hex8", "tet4", "wedge6")] == [3, 33, 3]
    assert [by_kind[kind]["NGAUSX"] for kind in ("hex8", "tet4", "wedge6")] == [2, 1, 2]
    assert [by_kind[kind]["IALFA"] for kind in ("hex8", "tet4", "wedge6")] == [0, -1, -1]


@pytest.mark.parametrize(
    ("law", "parameters", "model", "tables"),
    [
        ("elastic", {"E": 200.0, "nu": 0.3}, 1, 0),
        ("thermo_elastic", {"E": 200.0, "nu": 0.3, "expansion": 1.5e-5, "reference_temperature": 20.0}, 3, 3),
        ("orthotropic", dict(zip("Ex Ey Ez nu_xy nu_yz nu_zx Gxy Gyz Gzx".split(),  # noqa: SIM905
                                 [1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 4.0, 5.0, 6.0], strict=True)), 2, 0),
        ("von_mises", {"E": 200.0, "nu": 0.3, "yield_stress": 0.2, "tangent_modulus": 2.0, "beta": 1.0}, 5, 0),
        ("von_mises_power", {"E": 200.0, "nu": 0.3, "yield_stress": 0.2, "Cy": 0.5, "n": 0.7, "M": 0.5}, 6, 0),
        ("drucker_prager", {"E": 100.0, "nu": 0.25, "k": 0.25, "alpha": 0.05, "tension_cutoff": 0.5, "X0": 2.0,
                            "W": 0.1, "D": 0.2, "R": 3.0}, 41, 0),
        ("mohr_coulomb", {"E": 100.0, "nu": 0.25, "c": 1.0, "phi": 30.0, "psi": 15.0}, 42, 0),
        ("cam_clay", {"E": 100.0, "nu": 0.25, "M": 1.1, "lambda": 0.15, "kappa": 0.03, "pc": 0.2, "e0": 0.9}, 9, 0),
    ],
)  # fmt: skip
def test_laws(
    tmp_path: Path, mesh: Mesh, strict: ModuleType, law: str, parameters: dict, model: int, tables: int
) -> None:
    m = mesh("hex8")
    m.materials[1].law, m.materials[1].parameters = law, dict(parameters)
    again, notes = there_and_back(m, tmp_path)
    assert not notes
    assert (again.materials[1].law, again.materials[1].parameters) == (law, parameters)
    assert strict.read(tmp_path / "a.dat").groups == [(3, 0 if model < 3 else 1, model)]


def test_the_cap_keeps_the_digits_of_its_moduli(tmp_path: Path, mesh: Mesh) -> None:
    m = mesh("hex8")
    m.materials[1].law = "cap"
    m.materials[1].parameters = {"K": 2 / 3, "G": 0.4, "alpha": 1.0, "beta": 0.5, "gamma": 0.25, "theta": 0.1,
                                 "X0": 2.5, "W": 0.5, "D": 0.25, "R": 4.0, "tension_cutoff": 0.5}  # fmt: skip
    again, _ = there_and_back(m, tmp_path)
    read_back = again.materials[1].parameters
    assert read_back == pytest.approx(m.materials[1].parameters, rel=1e-7)
    assert (read_back["X0"], read_back["gamma"]) == (2.5, 0.25)
    text = (tmp_path / "a.dat").read_text()
    assert "       1.0       0.5      0.25       0.1       0.5      -2.5" in text  # A B C TETA AT AI1A0


def test_mixed_hardening_is_model_6(tmp_path: Path, mesh: Mesh) -> None:
    m = mesh("hex8", law="von_mises", yield_stress=0.2, tangent_modulus=40.0, beta=0.5)
    again, _ = there_and_back(m, tmp_path)
    assert again.materials[1].law == "von_mises_power"
    assert again.materials[1].parameters == {"E": 200.0, "nu": 0.3, "yield_stress": 0.2, "Cy": 50.0, "n": 1.0, "M": 0.5}


def loaded(mesh: Mesh) -> Model:
    m = mesh("hex8", "hex8")
    m.curves[1] = Curve(1, "", np.array([(0.0, 0.0), (5.0, 1.0), (50.0, 1.0)]))
    m.curves[2] = Curve(2, "", np.array([(0.0, 1.0), (5.0, 1.0), (5.0, 0.0), (50.0, 0.0)]))
    m.fem_control = FemControl(periods=[(10, 0.5), (5, 1.0)])
    n = np.arange(4)
    m.nodal_loads = [
        NodalLoad("force", n, np.full(4, 3), np.array([1.0, 2.0, 1 / 3, -4.0]), 1),
        NodalLoad("force", n[:1], np.array([1]), np.array([1.0]), 2, native={"FPOM": 0.25}),
        NodalLoad("temperature", n, np.zeros(4, np.int64), np.full(4, 20.0), 1),
        NodalLoad("displacement", n + 8, np.array([1, 2, 3, 1]), np.array([0.1, 0.0, -2.5, 1e-9]), 2),
    ]
    m.face_loads = [
        FaceLoad(np.array([[0, 1, 2, 3], [4, 5, 6, -1]]), np.array([[0.01]]*2), 0, 1),
        FaceLoad(np.array([[0, 1, 2, 3]]), np.array([[1.0, 2.0, 3.0, 4.0]]), 2, 2),
    ]  # fmt: skip
    m.body_loads = [BodyLoad((0.0, 0.0, -9.81), 1)]
    return m


def test_loads(tmp_path: Path, mesh: Mesh, strict: ModuleType, same: Callable) -> None:
    m = loaded(mesh)
    again, notes = there_and_back(m, tmp_path)
    assert notes == ["forces of nodes"]  # a third is rounded
    again.nodal_loads[0].values[2] = 1 / 3
    assert same(again.nodal_loads, m.nodal_loads)
    assert same(again.face_loads, m.face_loads)
    assert same(again.body_loads, m.body_loads)
    assert same([c.points for c in again.curves.values()], [c.points for c in m.curves.values()])
    assert again.fem_control.periods == [(10, 0.5), (5, 1.0)]
    assert again.analysis.end_time == 10.0
    deck = strict.read(tmp_path / "a.dat")
    assert deck.loads == {"NCF": 5, "NPP2": 0, "NPP3": 3, "NPGR": 0, "NPLJ": 0, "NTEMP": 4, "NZADP": 4, "INDZS": 1,
                          "ICERNE": 0}  # fmt: skip


@pytest.mark.parametrize(("law", "sign"), [("elastic", 1), ("von_mises_power", -1)])
@pytest.mark.parametrize("incremental", [False, True])
def test_the_sign_of_prescribed_displacements(
    tmp_path: Path, mesh: Mesh, strict: ModuleType, law: str, sign: int, incremental: bool
) -> None:
    m = mesh("hex8", law=law, **({"yield_stress": 1.0} if sign < 0 else {}))
    native = {"incremental": True} if incremental else {}
    m.nodal_loads = [NodalLoad("displacement", np.array([6, 7]), np.array([1, 2]), np.array([0.5, 1.0]), native=native)]
    m.constraints = [Constraint(np.array([6, 0]), np.array([[True] * 3 + [False] * 3] * 2))]
    again, notes = there_and_back(m, tmp_path)
    deck = strict.read(tmp_path / "a.dat")
    assert deck.loads["NZADP"] == 2 * sign * (-1 if incremental else 1)
    assert again.nodal_loads[0].native == native
    assert [w for w in again.warnings if "prescribed displacements are" in w] or not incremental
    assert notes == ["held degrees of freedom"]
    assert deck.codes[7][:3] == (0, 1, 1)  # free where the displacement is prescribed
    assert deck.codes[1][:3] == (1, 1, 1)


def test_time_functions_reach_past_the_end(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    m = loaded(mesh)
    m.curves[1].points = np.array([(0.0, 0.0), (10.0, 1.0)])
    report = write(m, tmp_path / "a.dat")
    assert "holds on to 11" in report.notes[0]
    deck = strict.read(tmp_path / "a.dat")
    assert deck.functions[1] == [(0.0, 0.0), (10.0, 1.0), (11.0, 1.0)]
    assert all(points[-1][0] > deck.end for points in deck.functions.values())
    m.curves[1].points = m.curves[1].points[::-1]
    with pytest.raises(ValueError, match="curve 1 : a time function needs points in the order of time"):
        write(m, tmp_path / "b.dat")
    m.nodal_loads[0].curve = 9
    with pytest.raises(ValueError, match="a load names curve 9"):
        write(m, tmp_path / "b.dat")


def test_loads_without_a_curve_are_constant(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    m = mesh("hex8")
    m.nodal_loads = [NodalLoad("force", np.array([0]), np.array([1]), np.array([1.0]))]
    again, _ = there_and_back(m, tmp_path)
    assert again.curves[1].points[:, 1].tolist() == [1.0, 1.0]
    assert again.nodal_loads[0].curve == 1


def test_a_triangle_s_pressure_repeats_its_third_node(tmp_path: Path, mesh: Mesh) -> None:
    m = mesh("tet4")
    m.face_loads = [FaceLoad(np.array([[0, 1, 2]]), np.array([1.0]))]
    again, _ = there_and_back(m, tmp_path)
    assert again.face_loads[0].faces.tolist() == [[0, 1, 2]]
    assert "\n    1    2    3    3\n" in (tmp_path / "a.dat").read_text().replace(" " * 25 + "\n", "\n")


def test_tractions_on_edges_are_forces_on_their_nodes(tmp_path: Path, mesh: Mesh) -> None:
    """A curved edge of three nodes and a straight one whose traction grows; nothing on the axis, nothing along z."""
    m = mesh("quad4", "quad8", family="plane")
    m.dimension = 2
    m.sections[1].plane = "stress"
    m.xyz[8] += (0.0, -0.1, 0.0)
    m.face_loads = [FaceLoad(np.array([[4, 5, 8]]), np.array([[3.0]]), 2),
                    FaceLoad(np.array([[0, 1]]), np.array([[1.0, 2.0]]), 2),
                    FaceLoad(np.array([[0, 1]]), np.array([[1.0]]), 3)]  # fmt: skip
    again, notes = there_and_back(m, tmp_path)
    assert notes.count("tractions on edges") == 3  # two by forces, one dropped
    chord = np.linalg.norm(m.xyz[5] - m.xyz[4])
    bow = 4 * 0.1 / chord  # the edge is a parabola: its slope at its ends
    arc = chord * (0.5 * np.hypot(1.0, bow) + np.arcsinh(bow) / (2 * bow))
    by_node = {n: v for f in again.nodal_loads for n, v in zip(f.nodes.tolist(), f.values.tolist(), strict=True)}
    assert sum(by_node[k] for k in (4, 5, 8)) == pytest.approx(0.5 * 3.0 * arc, rel=1e-4)
    assert by_node[8] > 3.0 * by_node[4] == pytest.approx(3.0 * by_node[5])
    straight = 0.5 * np.linalg.norm(m.xyz[1] - m.xyz[0]) / 6
    assert [by_node[0], by_node[1]] == pytest.approx([4 * straight, 5 * straight])
    m.sections[1].plane = "axisymmetric"
    m.xyz[:, 0] -= m.xyz[0, 0]
    m.face_loads = m.face_loads[1:2]
    again, notes = there_and_back(m, tmp_path)
    assert "forces of tractions" in notes
    assert again.nodal_loads[0].nodes.tolist() == [1]


def test_loads_on_edges_of_planes(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    m = mesh("quad4", "quad8", family="plane")
    m.dimension = 2
    m.sections[1].plane = "axisymmetric"
    m.face_loads = [FaceLoad(np.array([[0, 1], [4, 5]]), np.array([[1.0, 2.0]] * 2)),
                    FaceLoad(np.array([[4, 5, 8]]), np.array([[3.0]]), native={"IPRAV": -1, "ITIPE": 1}),
                    FaceLoad(np.array([[0, 1]]), np.array([[1.0]]), 1)]  # fmt: skip
    again, notes = there_and_back(m, tmp_path)
    assert set(notes) == {"tractions on edges", "forces of nodes"}  # the forces' last digits
    assert strict.read(tmp_path / "a.dat").loads["NPP2"] == 3
    (r0, r1), length = m.xyz[:2, 0], np.linalg.norm(m.xyz[1] - m.xyz[0])
    force = again.nodal_loads[0]
    assert (force.nodes.tolist(), force.dofs.tolist()) == ([0, 1], [1, 1])
    assert force.values == pytest.approx([length * (2 * r0 + r1) / (6 * r0), length * (r0 + 2 * r1) / (6 * r1)])
    assert [load.faces.tolist() for load in again.face_loads] == [[[0, 1], [4, 5]], [[4, 5, 8]]]
    assert again.face_loads[0].native == {"ITIPE": 1, "THICV": 0.5}


def test_linear_relations(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    m = mesh("hex8")
    one = np.array

    def relation(*terms: tuple[int, int, float]) -> Equation:
        nodes, dofs, factors = zip(*terms, strict=True)
        return Equation(one(nodes), one(dofs), one(factors, float))

    m.fixed = np.zeros((8, 6), bool)
    m.fixed[0, 0] = True
    m.equations = [
        relation((7, 1, 2.0), (6, 1, -2.0)),
        relation((7, 2, 1.0), (6, 2, -0.5), (5, 2, -0.25)),
        relation((7, 3, 1.0), (0, 1, 3.0)),  # of a held one: held itself
        relation((4, 1, 1.0), (7, 1, 3.0)),  # of a dependent one: not sayable
        relation((0, 1, 1.0), (6, 3, 3.0)),  # of a held dependent one
        relation((4, 2, 1.0), *((k, 3, 1.0) for k in range(7))),  # too many terms
    ]
    again, notes = there_and_back(m, tmp_path)
    assert notes == ["linear relations"] * 3
    first, second = again.equations
    assert (first.nodes.tolist(), first.dofs.tolist(), first.coefficients.tolist()) == ([7, 6], [1, 1], [1.0, -1.0])
    assert (second.nodes.tolist(), second.coefficients.tolist()) == ([7, 6, 5], [1.0, -0.5, -0.25])
    assert again.fixed[7].tolist() == [False, False, True, False, False, False]
    assert strict.read(tmp_path / "a.dat").codes[8][:3] == (-1, -1, 1)


def test_initial_values_of_a_dynamic_analysis(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    m = mesh("hex8")
    m.initial_velocities = [InitialVelocity(np.array([0, 3]), np.array([[1.0, 0.0, -2.5], [0.0, 0.0, 0.125]]))]
    m.nodal_loads = [NodalLoad("acceleration", np.array([1, 1]), np.array([1, 3]), np.array([5.0, 6.0]),
                               native={"initial": True})]  # fmt: skip
    m.fem_control = FemControl(dynamic=1)
    again, notes = there_and_back(m, tmp_path)
    strict.read(tmp_path / "a.dat")
    assert not notes
    assert again.initial_velocities[0].nodes.tolist() == [0, 3]
    assert again.initial_velocities[0].velocity.tolist() == [[1.0, 0.0, -2.5], [0.0, 0.0, 0.125]]
    assert again.nodal_loads[0].values.tolist() == [5.0, 0.0, 6.0, 0.0, 0.0, 0.0]
    m.fem_control = FemControl()
    assert [(i.what, i.count) for i in write(m, tmp_path / "a.dat").dropped] == [("initial values of nodes", 3)]


def test_nodes_without_stiffness_are_held(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    m = mesh("hex8", "quad4")
    m.xyz = np.vstack([m.xyz, [9.0, 9.0, 9.0]])
    m.node_ids = np.arange(1, len(m.xyz) + 1)
    write(m, tmp_path / "a.dat")
    deck = strict.read(tmp_path / "a.dat")
    assert [deck.codes[node] for node in (1, 9, 13)] == [(0, 0, 0, 1, 1, 1), (0, 0, 0, 0, 0, 0), (1, 1, 1, 1, 1, 1)]
    again = read(tmp_path / "a.dat")
    assert again.fem_control.suppressed == (0, 0, 0, 0, 0, 1)
    write(mesh("hex8"), tmp_path / "a.dat")
    assert read(tmp_path / "a.dat").fem_control.suppressed == (0, 0, 0, 1, 1, 1)


@pytest.mark.parametrize(
    ("nodes", "elements", "wide", "free"),
    [(1, 1, False, False), (100, 1, False, True), (1, 50, False, True), (99_990, 1, False, True),
     (99_999, 1, True, True), (1, 123_456, True, True)],
)  # fmt: skip
def test_numbers_decide_columns_and_numbering(
    tmp_path: Path, mesh: Mesh, strict: ModuleType, nodes: int, elements: int, wide: bool, free: bool
) -> None:
    m = mesh("hex8")
    m.node_ids = np.arange(nodes, nodes + 8)
    m.blocks[0].ids = np.array([elements])
    again, _ = there_and_back(m, tmp_path)
    assert (again.fem_control.wide, again.fem_control.free_numbering) == (wide, free)
    assert again.node_ids.tolist() == m.node_ids.tolist()
    assert again.blocks[0].ids.tolist() == [elements]
    strict.read(tmp_path / "a.dat")


def test_coordinates_that_do_not_fit_ten_columns(tmp_path: Path, mesh: Mesh, strict: ModuleType) -> None:
    m = mesh("hex8")
    m.xyz += 1e6 + 1 / 3
    again, notes = there_and_back(m, tmp_path)
    assert again.fem_control.wide
    assert notes == ["coordinates"]
    assert np.abs(again.xyz - m.xyz).max() < 1e-6
    strict.read(tmp_path / "a.dat")
    m.xyz = np.round(m.xyz - 1e6, 3)
    again, _ = there_and_back(m, tmp_path)
    assert not again.fem_control.wide


def test_element_numbers_of_several_groups_without_numbers_of_their_own(tmp_path: Path, mesh: Mesh) -> None:
    m = mesh("hex8", "tet4")
    again, _ = there_and_back(m, tmp_path)
    assert not again.fem_control.free_numbering
    assert [block.ids.tolist() for block in again.blocks] == [[1], [2]]


def test_what_a_deck_cannot_say_is_reported(tmp_path: Path, mesh: Mesh) -> None:
    m = mesh("hex8", "wedge15", "pyramid13", "hex27", "line2")
    m.blocks[-1].family = "spring"
    m.contacts.append(Contact("nodes", ("part", 1), ("part", 1)))
    m.constraints.append(Constraint(np.array([0]), np.ones((1, 6), bool), system=7))
    m.nodal_loads.append(NodalLoad("velocity", np.array([0]), np.array([1]), np.array([1.0])))
    m.materials[2] = type(m.materials[1])(2, "block", "rigid", 1.0, {"E": 1.0, "nu": 0.1})
    m.body_loads.append(BodyLoad((1.0, 0.0, 0.0), parts=(3,)))
    m.title = "š" * 90
    report = write(m, tmp_path / "a_name_that_is_too_long.dat")
    assert {(i.what, i.count) for i in report.dropped} == {
        ("wedge15 elements", 1), ("pyramid13 elements", 1), ("spring line2 elements", 1), ("contacts", 1),
        ("constraints in a local system", 1), ("prescribed velocity of nodes", 1), ("materials of no element", 1),
        ("body loads of some parts", 1),
    }  # fmt: skip
    assert {i.what for i in report.approximated} == {"hex27 elements", "title"}
    assert any("at most 20 characters" in note for note in report.notes)


@pytest.mark.parametrize("title", ["C title", "c* x", "C", "C-14"])
def test_a_title_is_never_a_comment(tmp_path: Path, mesh: Mesh, strict: ModuleType, title: str) -> None:
    m = mesh("hex8")
    m.title = title
    again, _ = there_and_back(m, tmp_path)
    assert again.title == title
    strict.read(tmp_path / "a.dat")


def no_material(m: Model) -> None:
    m.parts[1].material = None


def unknown_law(m: Model) -> None:
    m.materials[1].law = "soil_foam"


def hardening_table(m: Model) -> None:
    m.materials[1].law, m.materials[1].tables = "von_mises", {"hardening": np.array([(0.0, 1.0), (0.1, 2.0)])}


def no_thickness(m: Model) -> None:
    m.sections[1].parameters.clear()


def not_finite(m: Model) -> None:
    m.xyz[0, 0] = np.nan


def wrong_analysis(m: Model) -> None:
    m.sections[1].native["IATYP"] = 1


def no_modulus(m: Model) -> None:
    del m.materials[1].parameters["E"]


def element_number(m: Model) -> None:
    m.blocks[0].ids = np.array([0])


def no_elements(m: Model) -> None:
    m.blocks.clear()


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (no_material, "part 1 body: a PAK deck needs a material"),
        (unknown_law, "material 1 steel: a PAK deck cannot say the law 'soil_foam'"),
        (hardening_table, "material 1 steel: PAK runs a hardening table as if elastic"),
        (no_thickness, "part 1 body: elements without thickness"),
        (not_finite, "a node's coordinate is not finite"),
        (wrong_analysis, "part 1 body: material model 1 does not go with the analysis IATYP = 1"),
        (no_modulus, "material 1 steel: E is not given"),
        (element_number, "an element's number is not positive: 0"),
        (no_elements, "no finite elements"),
    ],
)
def test_models_that_no_deck_can_hold(tmp_path: Path, mesh: Mesh, damage: Callable, said: str) -> None:
    m = mesh("quad4")
    damage(m)
    with pytest.raises(ValueError, match=said):
        write(m, tmp_path / "a.dat")
    assert not list(tmp_path.iterdir())


def decks(shared: Path) -> list[Path]:
    folders = ("samples/pak-dat", "reference/pak", "reference/coupled")
    return [path for folder in folders for path in sorted((shared / folder).glob("*.dat"))]


def test_real_decks_there_and_back(shared: Path, tmp_path: Path, strict: ModuleType, same: Callable) -> None:
    assert len(decks(shared)) == 25
    for path in decks(shared):
        model = read_any(path)
        original = strict.read(path, points=False)
        again, notes = there_and_back(model, tmp_path)
        assert not notes, path
        if model.curves[1].points[-1, 0] <= original.end:  # PAK would not run it: lengthened
            assert path.stem in ("cant_TL", "pr1_3DMM")
            again.curves[1].points = again.curves[1].points[:-1]
        assert same(model, again), path
        written = strict.read(tmp_path / "a.dat")
        for name in ("xyz", "codes", "groups", "elements", "materials", "loads", "displacements"):
            assert getattr(written, name) == getattr(original, name), (path, name)
        for number, (netip, _, _) in enumerate(written.groups):
            if netip == 3:
                assert strict.jacobians(written, number).min() > 0
            elif netip == 33:
                assert strict.tetrahedra(written, number).min() > 0


@pytest.mark.slow
def test_a_million_hexahedra_in_three_seconds(tmp_path: Path) -> None:
    import time

    from zrno.translators.model import ElementBlock, Material, Part

    grid = np.arange(101)
    z, y, x = np.meshgrid(grid, grid, grid, indexing="ij")
    k, j, i = np.meshgrid(grid[:-1], grid[:-1], grid[:-1], indexing="ij")
    base = (i + 101 * (j + 101 * k)).ravel()
    corners = base[:, None] + np.array([0, 1, 102, 101, 10201, 10202, 10303, 10302])
    m = Model(
        node_ids=np.arange(1, 101**3 + 1),
        xyz=0.01 * np.column_stack([x.ravel(), y.ravel(), z.ravel()]),
        blocks=[ElementBlock("hex8", np.arange(1, 10**6 + 1), corners, np.ones(10**6, np.int64), "solid")],
        parts={1: Part(1, material=1)},
        materials={1: Material(1, law="elastic", density=1.0, parameters={"E": 1.0, "nu": 0.3})},
    )
    write(m, tmp_path / "a.dat")
    read(tmp_path / "a.dat")  # the kernels are loaded
    start = time.perf_counter()
    write(m, tmp_path / "a.dat")
    written = time.perf_counter()
    again = read(tmp_path / "a.dat")
    assert written - start < 3
    assert time.perf_counter() - written < 3
    assert np.array_equal(again.blocks[0].nodes, corners)
    assert np.allclose(again.xyz, m.xyz, rtol=0, atol=1e-14)


def test_every_kind_of_the_table_is_written_or_dropped_with_a_reason(tmp_path: Path, mesh: Mesh) -> None:
    for kind, element in TABLE.items():
        if element.dimension == 0 or kind in ("line3", "wedge18"):
            continue
        model = mesh("hex8", kind)
        report = write(model, tmp_path / "a.dat")
        dropped = {item.what: item.where for item in report.dropped}
        assert all(dropped.values())
        elements = sum(read(tmp_path / "a.dat").element_counts().values())
        assert elements == 2 - (f"{kind} elements" in dropped)
