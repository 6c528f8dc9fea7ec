"""The writer: what goes there and back, and what it says of what is lost."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from zrno.translators import read as read_any
from zrno.translators import write as write_any
from zrno.translators.elements import TABLE
from zrno.translators.femap import read, write
from zrno.translators.femap.topology import NUMBERS, faces_of
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
    Section,
)

REALS = st.floats(allow_nan=False, allow_infinity=False)
TITLES = st.text(st.characters(codec="latin-1", exclude_categories=("Cc", "Zs", "Cf")), max_size=20)
FAMILY = {0: ["mass"], 1: ["truss", "beam", "spring"], 2: ["shell", "plane"], 3: ["solid"]}
TYPE = {"mass": 27, "truss": 1, "beam": 2, "spring": 6, "shell": 17, "plane": 19, "solid": 25}


def reals(draw, *shape: int) -> np.ndarray:
    """Doubles of all sizes, some of them drawn for their oddity."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    values = rng.integers(0, 2**63, int(np.prod(shape)) * 2).view(np.float64)
    values = np.where(rng.random(len(values)) < 0.5, values, -np.round(rng.random(len(values)), 3))
    values = values[np.isfinite(values)][: int(np.prod(shape))]
    odd = draw(st.lists(REALS, max_size=min(3, len(values))))
    values[: len(odd)] = odd
    return values.reshape(shape)


@st.composite
def models(draw) -> Model:
    """Models of all kinds of elements, of which a FEMAP file can say everything."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    count = 25
    model = Model(title=draw(TITLES), format="femap", version="4.41")
    model.node_ids = rng.choice(10**8 - 1, count, replace=False) + 1
    model.xyz = reals(draw, count, 3)
    free = iter((rng.choice(10**8 - 1, 60, replace=False) + 1).tolist())
    pairs = [(kind, family) for kind in NUMBERS for family in FAMILY[TABLE[kind].dimension]]
    for number, (kind, family) in enumerate(draw(st.lists(st.sampled_from(pairs), max_size=6, unique=True)), 1):
        size = 1 + number % 3
        rows = np.array([rng.permutation(count)[: TABLE[kind].nodes] for _ in range(size)])
        ids = np.array([next(free) for _ in range(size)])
        model.blocks.append(ElementBlock(kind, ids, rows, np.full(size, number), family))
        kind_of = TYPE[family] + (family in ("shell", "plane", "solid") and TABLE[kind].mid_edges)
        section = Section(number, draw(TITLES), family, plane="strain" if family == "plane" else "")
        section.native = {"type": int(kind_of)}
        if family in ("shell", "plane"):
            section.parameters["thickness"] = draw(REALS.filter(bool))
        model.sections[number] = section
        model.parts[number] = Part(number, section.name, 4, TABLE[kind].dimension, section=number)
        if draw(st.booleans()):
            model.element_sets.append(ElementSet(50 + number, draw(TITLES), family, ids[::-1].copy()))
    model.fixed = rng.random((count, 6)) < 0.3 if draw(st.booleans()) else None
    elastic = {"E": draw(st.floats(1e-300, 1e300)), "nu": draw(st.floats(0.01, 0.49))}
    model.materials[4] = Material(4, draw(TITLES), "elastic", draw(REALS), elastic)
    model.curves[2] = Curve(2, draw(TITLES), reals(draw, 3, 2))
    some = rng.permutation(count)[: draw(st.integers(1, 9))]
    model.node_sets.append(NodeSet(7, draw(TITLES), some))
    dofs = np.tile(np.arange(6) <= draw(st.integers(0, 5)), (len(some), 1))
    model.constraints.append(Constraint(some, dofs, 3, draw(TITLES)))
    model.equations.append(Equation(some, np.full(len(some), 2), reals(draw, len(some)), 9))
    name = draw(TITLES)
    for kind in ("force", "displacement", "velocity", "acceleration"):
        twice, both = np.repeat(some, 2), np.tile([1, draw(st.integers(2, 6))], len(some))
        model.nodal_loads.append(NodalLoad(kind, twice, both, reals(draw, len(twice)), 2, 6, name))
    model.nodal_loads.append(
        NodalLoad("temperature", some, np.zeros(len(some), int), reals(draw, len(some)), None, 6, name)
    )
    model.body_loads.append(BodyLoad((1.5, 0.0, -9.81), 2))
    return model


@given(models())
@settings(max_examples=50, deadline=None, suppress_health_check=list(HealthCheck))
def test_there_and_back(tmp_path_factory, same, model: Model) -> None:
    path = tmp_path_factory.mktemp("t") / "o.neu"
    report = write(model, path)
    assert not report.dropped
    assert all("pyramid" in item.what for item in report.approximated)
    again = read(path)
    again.dimension = model.dimension
    if not model.title:
        again.title = ""
    for name in (f.name for f in fields(Model) if f.name != "warnings"):
        assert same(getattr(again, name), getattr(model, name)), (name, getattr(again, name), getattr(model, name))


def cube() -> Model:
    """Two bricks on each other, of the parts `low` and `high`."""
    points = np.array([(x, y, z) for z in range(3) for y in range(2) for x in range(2)], float)
    model = Model(title="two", node_ids=np.arange(1, 13), xyz=points)
    nodes = np.array([[0, 1, 3, 2, 4, 5, 7, 6], [4, 5, 7, 6, 8, 9, 11, 10]])
    model.blocks.append(ElementBlock("hex8", np.array([1, 2]), nodes, np.array([1, 2]), "solid"))
    model.parts = {1: Part(1, "low", 1), 2: Part(2, "high", 1)}
    model.materials[1] = Material(1, "steel", "elastic", 7.85, {"E": 2.0, "nu": 0.3})
    return model


def there_and_back(model: Model, tmp_path: Path) -> tuple[Model, list[tuple[str, int]], list[tuple[str, int]]]:
    report = write(model, tmp_path / "o.neu")
    items = [[(item.what, item.count) for item in some] for some in (report.approximated, report.dropped)]
    return read(tmp_path / "o.neu"), items[0], items[1]


def test_the_registry(tmp_path: Path) -> None:
    assert not write_any(cube(), tmp_path / "o.neu")
    assert read_any(tmp_path / "o.neu").element_counts() == {"hex8": 2}
    assert [path.name for path in tmp_path.iterdir()] == ["o.neu"]


def test_every_sample_mesh(shared: Path, tmp_path: Path) -> None:
    """gmsh meshes of all kinds of elements keep nodes, elements and parts."""
    for path in sorted((shared / "samples/msh").glob("*_o2.msh"))[:4]:
        model = read_any(path)
        again, _, dropped = there_and_back(model, tmp_path)
        assert np.array_equal(again.xyz, model.xyz)
        assert [what for what, _ in dropped] == []
        assert {n: p.name for n, p in model.parts.items()}.items() <= {
            n: p.name for n, p in again.parts.items()
        }.items()


def test_pressures_on_faces(tmp_path: Path) -> None:
    """Each face of each brick, as it is and turned; the face between the bricks belongs to either."""
    model = cube()
    cells = model.blocks[0].nodes
    faces = np.array([cells[i][list(face)] for i in (0, 1) for face in faces_of("hex8")])
    faces = np.concatenate([faces, faces[:, [2, 1, 0, 3]], faces[:1], [[0, 1, 6, 7]]])
    values = np.arange(1.0, len(faces) + 1)[:, None]
    model.face_loads.append(FaceLoad(faces, values))
    again, _, dropped = there_and_back(model, tmp_path)
    assert dropped == [("pressures on faces", 1)]
    (load,) = again.face_loads
    assert len(load.faces) == len(faces) - 1
    normals = [np.cross(p[1] - p[0], p[2] - p[1]) for p in (again.xyz[f] for f in load.faces)]
    wanted = [np.cross(p[1] - p[0], p[2] - p[1]) for p in (model.xyz[f] for f in faces[:-1])]
    assert np.array_equal(np.array(normals) * load.values, np.array(wanted) * values[:-1])
    assert [sorted(f) for f in load.faces.tolist()] == [sorted(f) for f in faces[:-1].tolist()]


def test_pressures_on_plates_and_edges(tmp_path: Path, same) -> None:
    model = cube()
    model.blocks = [ElementBlock("quad4", np.array([5]), np.array([[0, 1, 3, 2]]), np.array([1]), "shell"),
                    ElementBlock("tri3", np.array([6]), np.array([[4, 5, 7]]), np.array([2]), "plane")]  # fmt: skip
    faces = np.array([[0, 1, 3, 2], [0, 2, 3, 1], [1, 3, -1, -1], [2, 0, -1, -1], [7, 4, -1, -1]])
    model.face_loads.append(FaceLoad(faces, np.array([[1.0], [2.0], [3.0], [4.0], [5.0]]), id=2, name="p"))
    model.format = "femap"
    again, _, dropped = there_and_back(model, tmp_path)
    assert dropped == []
    found = [sorted(zip(load.faces.tolist(), load.values.tolist(), strict=True)) for load in again.face_loads]
    faces[1] = [0, 2, 3, 1]
    assert found == [sorted(zip(faces.tolist(), [[1.0], [2.0], [3.0], [4.0], [5.0]], strict=True))]


def test_what_other_formats_have(tmp_path: Path) -> None:
    model = cube()
    model.node_ids = np.zeros(12, np.int64)
    block = model.blocks[0]
    block.data["thickness"] = np.array([0.0, 2.0])
    model.blocks.append(ElementBlock("quad4", np.array([1]), np.array([[0, 1, 3, 2]]), np.array([0]), "shell"))
    model.blocks.append(ElementBlock("point1", np.array([1]), np.array([[0]]), np.array([1]), "sph"))
    model.sections[1] = Section(1, "s", "shell", {"thickness_1": 1.0, "thickness_2": 3.0, "shear_factor": 0.8})
    model.parts[0] = Part(0, "zero", 1, section=1)
    model.materials[2] = Material(2, "", "cap", 1.0, {"K": 1.0, "G": 1.0, "alpha": 1.0})
    model.materials[3] = Material(3, "", "", native={"MAT_999": 1})
    model.materials[4] = Material(4, "", "von_mises", 1.0, {"E": 10.0, "nu": 0.2, "yield_stress": 1.0,
                                                           "tangent_modulus": 2.0, "beta": 0.2})  # fmt: skip
    model.materials[5] = Material(5, "", "rigid", 1.0, {"E": 10.0, "nu": 0.2})
    nodes = np.arange(4)
    held = np.zeros((4, 6), bool)
    held[:, 0] = True
    model.constraints = [Constraint(nodes, held, 10, "a"), Constraint(nodes[:2], np.roll(held[:2], 1, 1), 11, "b"),
                         Constraint(nodes, held, 12, system=77)]  # fmt: skip
    model.nodal_loads = [NodalLoad("force", nodes, np.full(4, 3), np.ones(4), 1, 5, birth=1.0),
                         NodalLoad("temperature", nodes, np.zeros(4, np.int64), np.arange(4.0))]  # fmt: skip
    model.face_loads = [FaceLoad(np.array([[0, 1, 3, 2]]), np.array([[1.0, 3.0]])),
                        FaceLoad(np.array([[0, 1, 3, 2]]), np.array([[1.0]]), 3)]  # fmt: skip
    model.body_loads = [BodyLoad((0.0, 0.0, 1.0)), BodyLoad((1.0, 0.0, 0.0), parts=(1,)), BodyLoad((0.0, 2.0, 0.0))]
    model.curves[1] = Curve(1, "ramp", np.array([[0.0, 0.0], [1.0, 1.0]]))
    model.initial_velocities = [InitialVelocity(nodes, np.ones((4, 3)))]
    model.contacts = [Contact("automatic", ("part", 1), ("part", 2))]
    model.node_sets = [NodeSet(1, "a", nodes), NodeSet(1, "b", nodes[:1])]
    model.element_sets = [ElementSet(1, "a", "solid", np.array([2, 99]))]
    again, approximated, dropped = there_and_back(model, tmp_path)
    assert sorted(approximated) == [
        ("element numbers", 3), ("hardening", 1), ("loads on nodes", 4),
        ("material law", 1), ("node numbers", 12), ("numbers of sets", 1), ("part numbers", 1),
        ("pressures on faces", 1), ("thicknesses", 1),
    ]  # fmt: skip
    assert sorted(dropped) == [
        ("body loads", 1), ("constraints", 4), ("contacts", 1), ("element thickness", 1), ("initial velocities", 1),
        ("material laws", 1), ("material laws", 1),
        ("material numbers that the source's format alone has", 1), ("members of element sets", 1),
        ("section parameters", 1), ("sph elements", 1), ("tractions on faces", 1),
    ]  # fmt: skip
    assert [b.ids.tolist() for b in again.blocks] == [[1, 2], [3]]
    assert again.element_sets[0].elements.tolist() == [2]
    assert {n: s.parameters.get("thickness") for n, s in again.sections.items()}[3] == 2.0
    assert [m.law for m in again.materials.values()] == ["elastic", "", "", "von_mises", "elastic"]
    assert again.materials[4].parameters["tangent_modulus"] == pytest.approx(2.0, rel=1e-15)
    # constraints of other formats act together: they are one set, and a node stands in it once
    assert [(c.id, c.nodes.tolist(), c.dofs[0].nonzero()[0].tolist()) for c in again.constraints] == [
        (1, [0, 1], [0, 1]),
        (1, [2, 3], [0]),
    ]
    assert [(n.kind, n.id, n.curve) for n in again.nodal_loads] == [("force", 1, 1), ("temperature", 1, None)]
    assert [b.acceleration for b in again.body_loads] == [(0.0, 0.0, 1.0), (0.0, 2.0, 0.0)]
    assert {(s.id, s.name) for s in again.node_sets} == {(1, "a"), (2, "b")}


@pytest.mark.parametrize(("kind", "written"), [("hex27", "hex20"), ("quad9", "quad8"), ("wedge18", "wedge15")])
def test_kinds_that_are_simplified(tmp_path: Path, kind: str, written: str) -> None:
    count = TABLE[kind].nodes
    model = Model(node_ids=np.arange(1, count + 1), xyz=np.random.default_rng(1).random((count, 3)))
    model.blocks = [ElementBlock(kind, np.array([1]), np.arange(count)[None], np.array([1]))]
    again, approximated, _ = there_and_back(model, tmp_path)
    assert approximated == [(f"{kind} elements", 1)]
    assert [(b.kind, b.nodes.tolist()) for b in again.blocks] == [(written, [list(range(TABLE[written].nodes))])]


def test_beams_and_plates(tmp_path: Path, same) -> None:
    model = cube()
    model.format = "femap"
    line = np.array([[0, 1], [1, 3]])
    beam = ElementBlock("line2", np.array([3, 4]), line, np.array([3, 3]), "beam")
    beam.data = {"orientation": np.array([[0.0, 1e-5, 1.0], [0.0, 0.0, 0.0]]), "orientation_node": np.array([-1, 7])}
    plate = ElementBlock("quad4", np.array([9]), np.array([[0, 1, 3, 2]]), np.array([4]), "shell")
    plate.data = {"angle": np.array([12.5])}
    model.blocks += [beam, plate]
    model.sections[3] = Section(3, "", "beam", {"area": 1e-4, "izz": 2.0, "iyy": 3.0, "iyz": 4.0, "j": 5.0})
    model.sections[3].native = {"type": 5, "values": {7: 0.5, 20: 1.0}, "flags": [0, 1, 0, 0], "layer": 2}
    model.parts |= {3: Part(3, "", 1, 1, section=3), 4: Part(4, "", 1, 2)}
    again, approximated, dropped = there_and_back(model, tmp_path)
    assert (approximated, dropped) == ([], [])
    assert same(again.blocks, model.blocks)
    assert same(again.sections[3], model.sections[3])


@pytest.mark.parametrize("title", ["-1", "$COM a", "a\nb", "x" * 100, "Grüße", "日本", "<NULL>", " padded "])
def test_titles(tmp_path: Path, title: str) -> None:
    model = cube()
    model.title = model.parts[1].name = title
    again, approximated, _ = there_and_back(model, tmp_path)
    assert again.element_counts() == {"hex8": 2}
    good = title in ("Grüße", " padded ", "<NULL>")
    assert (approximated == []) == good
    if good and title != "<NULL>":
        assert again.parts[1].name == title.strip()


def test_models_that_are_no_mesh(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no nodes"):
        write(Model(), tmp_path / "o.neu")
    model = cube()
    model.xyz[3, 1] = np.nan
    with pytest.raises(ValueError, match="not finite"):
        write(model, tmp_path / "o.neu")
    assert list(tmp_path.iterdir()) == []
