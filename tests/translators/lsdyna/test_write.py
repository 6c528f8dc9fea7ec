"""The writer: what is read again is the same; columns, long format, what a deck cannot say."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from zrno.translators.elements import TABLE
from zrno.translators.lsdyna import read, write
from zrno.translators.lsdyna.cards_out import int_grid, real_grid
from zrno.translators.model import (
    Analysis,
    BodyLoad,
    Constraint,
    Curve,
    ElementBlock,
    ElementSet,
    Eos,
    FaceLoad,
    InitialVelocity,
    Material,
    Model,
    NodalLoad,
    NodeSet,
    Part,
    PartSet,
    Section,
    SegmentSet,
)

Read = Callable[..., Model]
Same = Callable[[Any, Any], bool]


def again(model: Model, folder: Path, name: str = "out.k") -> Model:
    """A model that is written without loss, and read."""
    report = write(model, folder / name)
    assert not report, report
    back = read(folder / name)
    back.includes, back.native = list(model.includes), dict(model.native)
    return back


def test_the_deck_of_everything_comes_back(deck: Read, everything: str, tmp_path: Path, same: Same) -> None:
    model = deck(everything)
    back = again(model, tmp_path)
    assert same(model, back)
    text = (tmp_path / "out.k").read_text()
    write(back, tmp_path / "second.k")
    assert (tmp_path / "second.k").read_text() == text
    assert "*CONTROL_SPH\n         1         0   1.0E20         3\n" in text
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.parametrize(
    "name",
    ["ball_plate.k", "bird.k", "birdball.k", "bracket.k", "elementary_transform.k", "ex13_thick_shell.k", "frf_solid.k",
     "dynakw_joint_revolute.k", "taylor_bar_mesh.k", "topalovic_kupa1.k", "weldform_2el.k", "gen/i10_y.k",
     "gen/long_y.k", "bolt_a/control_explicit.k", "isph.k", "expand_test/fol/mesh.k"],
)  # fmt: skip
def test_decks_of_others_come_back(shared: Path, tmp_path: Path, same: Same, name: str) -> None:
    model = read(shared / "samples/lsdyna" / name)
    assert same(model, again(model, tmp_path))


# up to twelve digits: sixteen columns do not hold all of them, twenty do
NUMBERS = st.builds(
    lambda digits, power: float(f"{digits}e{power}"), st.integers(-(10**12), 10**12), st.integers(-20, 9)
)
COUNT = 12


def solid(kind: str) -> st.SearchStrategy[tuple[str, str, dict[str, Any]]]:
    return st.just(("solid", kind, {}))


def with_data(family: str, kind: str, **data: tuple[int, ...]) -> st.SearchStrategy[tuple[str, str, dict[str, Any]]]:
    """A family with some of its data, of the shape of each."""

    def draw(names: list[str]) -> st.SearchStrategy[tuple[str, str, dict[str, Any]]]:
        return st.fixed_dictionaries({name: st.just(data[name]) for name in names}).map(lambda d: (family, kind, d))

    return st.lists(st.sampled_from(sorted(data)), unique=True).flatmap(draw) if data else solid(kind)


ELEMENTS = st.one_of(
    *(solid(kind) for kind in ("hex8", "tet4", "pyramid5", "wedge6", "tet10", "hex20", "hex27")),
    with_data("shell", "quad4", thickness=(4,), offset=()),
    with_data("shell", "tri3", angle=(), offset=()),
    st.sampled_from([("shell", "quad8", {}), ("shell", "tri6", {}), ("tshell", "hex8", {}), ("tshell", "wedge6", {})]),
    with_data("beam", "line2", orientation=(3,), section_values=(5,)),
    with_data("spring", "line2", offset=()),
    st.sampled_from([
        ("mass", "point1", {"mass": ()}), ("sph", "point1", {"mass": ()}), ("sph", "point1", {"volume": ()}),
        ("sphere", "point1", {"mass": (), "inertia": (), "radius": ()}), ("spring", "point1", {}),
    ]),
)  # fmt: skip


@st.composite
def meshes(draw: Any) -> Model:
    """Models of one family, random places and numbers."""
    family, kind, shapes = draw(ELEMENTS)
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    nodes = TABLE[kind].nodes
    total = nodes + COUNT
    wide = draw(st.booleans())
    ids = np.sort(rng.choice(9_999_999_999 if wide else 99_999_999, total, replace=False) + 1)
    point = family in ("sph", "sphere")
    rows = np.array([rng.permutation(total)[:nodes] for _ in range(1 if point else 3)])
    if point:
        rows = rng.permutation(total)[:3, None]
    count = len(rows)
    data = {}
    for name, shape in shapes.items():
        values = rng.choice([0.5, 1.25, 1e-7, 123456.75, 0.1], (count, *shape))
        data[name] = values
    numbers = ids[rows[:, 0]] if point else np.sort(rng.choice(99_999_999, count, replace=False) + 1)
    xyz = np.array([[draw(NUMBERS) for _ in range(3)] for _ in range(4)])[rng.integers(0, 4, total)]
    if kind in ("hex20", "hex27"):
        xyz = np.zeros((total, 3))  # places would tell another order
    part = np.full(count, int(rng.integers(1, 1000)))
    fixed = rng.random((total, 6)) < 0.2 if draw(st.booleans()) else None
    if fixed is not None and not fixed.any():
        fixed = None
    block = ElementBlock(kind, numbers, rows.astype(np.int64), part, family, data)
    number = int(part[0])
    return Model(
        title="a mesh", format="lsdyna", version="keyword", node_ids=ids, xyz=xyz, blocks=[block], fixed=fixed,
        parts={number: Part(number, "p", dimension=TABLE[kind].dimension)},
    )  # fmt: skip


@given(meshes())
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_mesh_comes_back(tmp_path: Path, same: Same, model: Model) -> None:
    back = again(model, tmp_path)
    assert same(model.blocks, back.blocks)
    assert np.array_equal(model.xyz, back.xyz)
    assert np.array_equal(model.node_ids, back.node_ids)
    assert same(model.fixed, back.fixed)
    assert same(model.parts, back.parts)


REALS = st.floats(-1e12, 1e12, allow_nan=False).filter(lambda x: x == 0 or abs(x) > 1e-12)


@given(st.lists(REALS, min_size=5, max_size=5), st.integers(1, 9_999_999))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_numbers_of_cards_come_back_to_the_twenty_columns_of_the_long_format(
    tmp_path: Path, numbers: list[float], number: int
) -> None:
    e, nu, density, x, y = numbers
    model = Model(
        node_ids=np.array([1]), xyz=np.array([[x, y, 0.0]]), curves={3: Curve(3, "", np.array([[0.0, x], [1.0, y]]))},
        materials={number: Material(number, "m", "elastic", density, {"E": e, "nu": nu})},
    )  # fmt: skip
    write(model, tmp_path / "out.k")
    back = read(tmp_path / "out.k")
    material = back.materials[number]
    found = [material.parameters["E"], material.parameters["nu"], material.density, *back.xyz[0, :2].tolist()]
    assert found == pytest.approx(numbers, rel=1e-12, abs=0)


def test_long_format_only_where_a_number_needs_it(tmp_path: Path) -> None:
    third = 1.0 / 3.0  # sixteen digits: 18 columns
    model = Model(
        node_ids=np.array([1]), xyz=np.array([[third, 0.0, 0.0]]),
        materials={1: Material(1, "", "elastic", 1.0, {"E": 2.0, "nu": 0.25}),
                   2: Material(2, "", "elastic", third, {"E": 2.0, "nu": 0.25})},
    )  # fmt: skip
    assert not write(model, tmp_path / "a.k")
    text = (tmp_path / "a.k").read_text()
    assert "*NODE +\n                   1  0.3333333333333333                 0.0" in text
    assert "*MAT_ELASTIC\n         1       1.0" in text
    assert "*MAT_ELASTIC +\n                   2  0.3333333333333333" in text
    back = read(tmp_path / "a.k")
    assert back.xyz[0, 0] == back.materials[2].density == third


def test_numbers_that_no_format_holds_are_approximated_and_counted(tmp_path: Path) -> None:
    model = Model(node_ids=np.array([1]), xyz=np.array([[-1.2345678901234567e-201, 0.0, 0.0]]))
    report = write(model, tmp_path / "a.k")
    assert [(item.what, item.count) for item in report.approximated] == [("numbers", 1)]
    assert read(tmp_path / "a.k").xyz[0, 0] == pytest.approx(-1.2345678901234567e-201, rel=1e-12)


def test_ids_of_ten_columns(tmp_path: Path) -> None:
    ids = np.array([100_000_000, 9_999_999_999])
    model = Model(node_ids=ids, xyz=np.zeros((2, 3)), node_sets=[NodeSet(1, "", np.array([1, 0]))])
    write(model, tmp_path / "a.k")
    assert (tmp_path / "a.k").read_text().startswith("*KEYWORD I10=Y\n")
    back = read(tmp_path / "a.k")
    assert back.node_ids.tolist() == ids.tolist()
    assert back.node_sets[0].nodes.tolist() == [1, 0]
    with pytest.raises(ValueError, match="more than ten digits"):
        write(Model(node_ids=ids * 10, xyz=np.zeros((2, 3))), tmp_path / "b.k")
    with pytest.raises(ValueError, match="the number 10000000000 has"):
        write(Model(part_sets=[PartSet(1, "", np.array([10**10]))]), tmp_path / "b.k")
    assert not (tmp_path / "b.k").exists()


@given(st.lists(st.integers(-99_999_999, 999_999_999), min_size=1, max_size=20))
def test_grids_of_integers(values: list[int]) -> None:
    grid, lost = int_grid(np.array(values)[:, None], 8)
    texts = [bytes(row).decode() for row in grid]
    assert lost == sum(len(str(v)) > 8 for v in values)
    assert all(text == f"{v:8d}" for text, v in zip(texts, values, strict=True) if len(str(v)) <= 8)


def test_grids_of_reals() -> None:
    grid, lost = real_grid(np.array([[0.5, -1e-20], [1 / 3, 2.0]]), 10)
    assert [bytes(row).decode() for row in grid] == ["       0.5   -1.E-20", ".333333333       2.0"]
    assert lost == 1


def mesh() -> Model:
    """A cube and a triangle, of no format."""
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
    return Model(
        title="made", format="msh", node_ids=np.arange(1, 9), xyz=xyz,
        blocks=[ElementBlock("hex8", np.array([1]), np.arange(8)[None], np.array([1])),
                ElementBlock("tri3", np.array([2]), np.array([[0, 1, 2]]), np.array([2]))],
        parts={1: Part(1, "body", 1, section=1, dimension=3), 2: Part(2, "skin", 2, section=2, dimension=2)},
        materials={1: Material(1, "steel", "elastic", 7.8, {"E": 210.0, "nu": 0.3}),
                   2: Material(2, "", "von_mises", 7.8, {"E": 210.0, "nu": 0.3, "yield_stress": 0.2})},
        sections={1: Section(1, "", "solid"), 2: Section(2, "", "shell", {"thickness": 0.5})},
    )  # fmt: skip


def test_a_model_of_another_format(tmp_path: Path) -> None:
    model = mesh()
    top = SegmentSet(4, "top", np.array([[4, 5, 6, 7]]))
    model.node_sets = [NodeSet(3, "base", np.array([0, 1, 2, 3])), NodeSet(3, "twice", np.array([4]))]
    model.part_sets, model.segment_sets = [PartSet(1, "", np.array([2]))], [top]
    model.element_sets = [ElementSet(5, "", "solid", np.array([1])), ElementSet(6, "", "rigid", np.array([1]))]
    held = np.zeros((4, 6), bool)
    held[:, 2] = True
    model.constraints = [Constraint(np.arange(4), held, set=3)]
    model.nodal_loads = [NodalLoad("force", np.array([5, 6]), np.array([1, 6]), np.array([2.0, 3.0]))]
    model.face_loads = [
        FaceLoad(top.segments, np.array([[2.5]]), set=4),
        FaceLoad(np.array([[0, 1, 2, -1]]), np.array([[1.0, 2.0, 3.0]])),
        FaceLoad(top.segments, np.array([[1.0]]), direction=3),
    ]  # fmt: skip
    model.body_loads = [BodyLoad((0.0, 0.0, -9.81), parts=(1,))]
    model.initial_velocities = [InitialVelocity(np.arange(8), np.tile([1.0, 0.0, 0.0], (8, 1)))]
    model.analysis = Analysis("dynamic", 2.0, output_interval=0.5)
    report = write(model, tmp_path / "a.k")
    assert {(i.what, i.count) for i in report.dropped} == {("element sets", 1), ("tractions on faces", 1)}
    assert {(i.what, i.count) for i in report.approximated} == {("pressures", 1)}
    assert any("set twice is numbered 4" in note for note in report.notes)
    back = read(tmp_path / "a.k")
    assert {b.family: b.kind for b in back.blocks} == {"solid": "hex8", "shell": "tri3"}
    assert back.constraints[0].nodes.tolist() == [0, 1, 2, 3]
    assert back.constraints[0].dofs.tolist() == held.tolist()
    assert (back.nodal_loads[0].dofs.tolist(), back.nodal_loads[0].values.tolist()) == ([1, 6], [2.0, 3.0])
    constant = back.curves[back.nodal_loads[0].curve or 0]
    assert constant.points[:, 1].tolist() == [1.0, 1.0]
    assert [load.values.tolist() for load in back.face_loads] == [[[2.5]], [[2.0]]]
    assert (back.body_loads[0].acceleration, back.body_loads[0].parts) == ((0.0, 0.0, -9.81), (1,))
    assert back.initial_velocities[0].velocity.tolist() == [[1.0, 0.0, 0.0]] * 8
    assert (back.analysis.kind, back.analysis.end_time, back.analysis.output_interval) == ("dynamic", 2.0, 0.5)
    assert back.materials[2].parameters == {"E": 210.0, "nu": 0.3, "yield_stress": 0.2}
    assert back.sections[2].parameters == {"thickness": 0.5}


@pytest.mark.parametrize(
    ("law", "parameters", "expected"),
    [
        ("drucker_prager", {"E": 9.0, "nu": 0.125, "k": 0.1, "alpha": 0.2},
         ("cap", {"K": 4.0, "G": 4.0, "alpha": 0.1, "theta": 0.2})),
        ("mohr_coulomb", {"E": 10.0, "nu": 0.25, "phi": 45.0, "c": 1.0}, None),
        ("hydro", {"G": 1.0, "a1": 2.0, "spall": 3.0}, None),
        ("von_mises", {"E": 1.0, "nu": 0.5, "yield_stress": 2.0, "beta": 0.5}, None),
        ("soil_foam", {"G": 1.0, "K": 2.0, "a0": 3.0}, None),
        ("rigid", {"E": 1.0, "nu": 0.5}, None),
    ],
)  # fmt: skip
def test_laws_of_other_formats(tmp_path: Path, law: str, parameters: dict[str, float], expected: Any) -> None:
    model = Model(format="mcm", materials={1: Material(1, "m", law, 2.0, parameters)})
    assert not write(model, tmp_path / "a.k")
    found = read(tmp_path / "a.k").materials[1]
    assert found.law == (expected or (law,))[0]
    wanted = expected[1] if expected else parameters
    for name, value in wanted.items():
        assert found.parameters[name] == pytest.approx(value, rel=1e-12)


def test_laws_that_are_approximated_or_dropped(tmp_path: Path) -> None:
    power = {"E": 1.0, "nu": 0.3, "yield_stress": 2.0, "Cy": 3.0, "n": 0.5}
    model = Model(
        format="pak",
        materials={1: Material(1, "", "von_mises_power", 1.0, power),
                   2: Material(2, "", "orthotropic", 1.0, {"Ex": 1.0})},
        equations_of_state={3: Eos(3, "", "mie_gruneisen", {"C": 1.0, "S": 2.0})},
    )  # fmt: skip
    report = write(model, tmp_path / "a.k")
    assert [(i.what, i.count) for i in report.dropped] == [("materials", 1)]
    assert [i.what for i in report.approximated] == ["materials", "equations of state"]
    back = read(tmp_path / "a.k")
    table = back.materials[1].tables["hardening"]
    assert table[:, 1] == pytest.approx(2.0 + 3.0 * np.sqrt(table[:, 0]), rel=1e-12)
    assert back.equations_of_state[3].parameters["S1"] == 2.0


def test_elements_that_a_deck_has_not(tmp_path: Path) -> None:
    nodes = np.arange(15)
    model = Model(
        node_ids=np.arange(1, 16), xyz=np.random.default_rng(1).random((15, 3)), parts={1: Part(1)},
        blocks=[ElementBlock("wedge15", np.array([1]), nodes[None], np.array([1])),
                ElementBlock("line2", np.array([1]), nodes[None, :2], np.array([0])),
                ElementBlock("point1", np.array([1]), nodes[None, :1], np.array([1])),
                ElementBlock("tri3", np.array([5, 5]), np.array([[0, 1, 2], [1, 2, 3]]), np.array([1, 1]))],
    )  # fmt: skip
    report = write(model, tmp_path / "a.k")
    assert [(i.what, i.count) for i in report.approximated if i.what != "numbers"] == [("wedge15 elements", 1)]
    assert {i.what for i in report.dropped} == {"line2 elements", "point1 elements"}
    assert any("numbered anew" in note for note in report.notes)
    assert read(tmp_path / "a.k").element_counts() == {"wedge6": 1, "tri3": 2}


def test_particles_become_a_mesh(tmp_path: Path, shared: Path) -> None:
    from zrno.translators import read as read_any

    shutil.copyfile(shared / "samples/mcm/kipkupa.mcm", tmp_path / "a.mcm")
    source = read_any(tmp_path / "a.mcm", paired=True)
    write(source, tmp_path / "a.k")
    model = read(tmp_path / "a.k")
    particles = source.particles
    assert particles is not None
    assert np.array_equal(model.xyz, particles.x)
    assert model.particle_count() == len(particles)
    sph = [b for b in model.blocks if b.family == "sph"]
    mass = sum(float(b.data["mass"].sum()) for b in sph)
    owned = [m for n, m in source.materials.items() if (particles.material == n).any()]
    assert mass == pytest.approx(sum(m.mass for m in owned), rel=1e-12)
    assert {m.law for m in model.materials.values()} == {m.law for m in source.materials.values()}
    held = model.fixed[:, :3].all(axis=1) if model.fixed is not None else np.zeros(len(particles), bool)
    assert np.array_equal(held, particles.bc == 7)


def test_what_changed_in_the_model_is_what_is_written(deck: Read, everything: str, tmp_path: Path) -> None:
    model = deck(everything)
    model.materials[2].parameters["E"] = 5.0
    model.sections[2].parameters["thickness"] = 3.0
    model.analysis.end_time = 99.0
    model.materials[6] = replace(model.materials[6], id=60)
    write(model, tmp_path / "a.k")
    back = read(tmp_path / "a.k")
    assert back.materials[2].parameters["E"] == 5.0
    assert back.sections[2].parameters["thickness"] == 3.0
    assert back.analysis.end_time == 99.0
    assert back.analysis.step_factor == 0.9
    assert any(m.native.get("keyword") == "MAT_SPRING_ELASTIC" for m in back.materials.values() if m.id == 60)


def test_titles_cannot_become_keywords(tmp_path: Path) -> None:
    names = ["*END", "$ gone", "two\nlines", "Grüße", "a, b"]
    model = Model(
        title="*NODE", parts={i: Part(i, name) for i, name in enumerate(names, 1)},
        materials={i: Material(i, name, "elastic", 1.0, {"E": 1.0, "nu": 0.0}) for i, name in enumerate(names, 1)},
    )  # fmt: skip
    write(model, tmp_path / "a.k")
    back = read(tmp_path / "a.k")
    assert back.title == "*NODE"
    expected = ["*END", "$ gone", "two lines", "Grüße", "a, b"]
    assert [p.name for p in back.parts.values()] == expected
    assert [m.name for m in back.materials.values()] == expected


def test_a_model_that_lacks_what_it_names_is_refused(deck: Read, tmp_path: Path) -> None:
    model = deck("*ELEMENT_SHELL\n1,1,1,2,3,4\n")
    with pytest.raises(ValueError, match="1 element points at nodes"):
        write(model, tmp_path / "a.k")
    assert not (tmp_path / "a.k").exists()
