"""Materials of both generations, functions, coordinate systems and groups."""

from __future__ import annotations

import numpy as np
import pytest

from zrno.translators.femap import read, write
from zrno.translators.femap.tables import angles_of, rotation


def material_401(
    values: dict[int, float],
    kind: int = 0,
    codes: str = "0,0,0,0,0,0,",
    plastic: str = "0.,0.,0.,",
    name: str = "steel",
    functions: bool = False,
    extra: bool = False,
    number: int = 1,
) -> list[str]:
    """The 32 lines of a material: values by their places in order."""
    lines, at = [f"{number},55,{kind},1,{int(functions)},", name], 0
    sizes = (3, 3, 3, 5, 5, 5, 5, 1, 5, 1, 5, 1, 5, 1, 4, 5)
    for size in sizes:
        lines.append("".join(f"{values.get(place, 0.0)!r}," for place in range(at, at + size)))
        at += size
    if functions:
        lines += ["7," + "0," * (size - 1) for size in sizes]
    lines += ["0.," * 5] * 4 + ["0.,", "0.," * 5, plastic] + ["0.,"] * extra + ["0," * 5, codes, "0.," * 3]
    return [*lines, "0.," * 5, "0.," * 2, "0," * 4, "0," * 4]


def material_601(values: dict[int, float], kind: int = 0, codes: str = "0,0,0,0,0", function: int = 0,
                 own: tuple[str, ...] = ()) -> list[str]:  # fmt: skip
    """A material of version 10."""

    def rows(numbers: list[str]) -> list[str]:
        return [",".join(numbers[i : i + 10]) + "," for i in range(0, len(numbers), 10)]

    reals = [f"{values.get(place, 0.0)!r}" for place in range(200)]
    ids = ["0"] * 50
    ids[5] = str(function)
    return [f"1,-601,55,{kind},0,1,{1 if own else 0},", "steel", "10,", *rows(["0"] * 10), "25,",
            *rows(codes.split(",") + ["0"] * 20), "200,", *rows(reals), "50,", *rows(ids), "70,", *rows(["0"] * 70),
            *own]  # fmt: skip


STEEL = {0: 2.1e11, 1: 2.1e11, 2: 2.1e11, 6: 0.3, 7: 0.3, 8: 0.3, 49: 7850.0, 36: 1.2e-05}
BOTH = pytest.mark.parametrize("block", [401, 601])


def of(block: int, values: dict[int, float], kind: int = 0, codes: tuple[int, int, int, int] = (0, 0, 0, 0),
       plastic: tuple[float, float] = (0.0, 0.0)) -> tuple[list[str], str]:  # fmt: skip
    """A material's lines in either block, and a version that has it. codes: kind, function, hardening, criterion."""
    if block == 401:
        text = "0,0," + "".join(f"{code}," for code in codes)
        return material_401(values, kind, text, f"{plastic[0]!r},{plastic[1]!r},0.,"), "4.41"
    text = f"0,0,{codes[0]},{codes[2]},{codes[3]}"
    return material_601(values | {84: plastic[0], 85: plastic[1]}, kind, text, codes[1]), "10.0"


@BOTH
def test_elastic(neu, load, block: int) -> None:
    lines, version = of(block, STEEL)
    material = load(neu.MESH + neu.block(block, *lines), version).materials[1]
    assert (material.name, material.law, material.density) == ("steel", "elastic", 7850.0)
    assert material.parameters == {"E": 2.1e11, "nu": 0.3}
    assert material.native == {"values": {36: 1.2e-05}}


@BOTH
def test_poissons_ratio_by_the_shear_modulus(neu, load, block: int) -> None:
    lines, version = of(block, {0: 2.5, 3: 1.0})
    model = load(neu.MESH + neu.block(block, *lines), version)
    assert model.materials[1].parameters == {"E": 2.5, "nu": 0.25}
    assert "has no Poisson's ratio: 0.25 by its shear modulus" in model.warnings[-1]


@BOTH
def test_bilinear(neu, load, block: int) -> None:
    lines, version = of(block, STEEL, codes=(2, 0, 1, 0), plastic=(1e9, 2.5e8))
    material = load(neu.MESH + neu.block(block, *lines), version).materials[1]
    assert (material.law, material.native["nonlinear"]) == ("von_mises", (2, 0, 1, 0))
    assert material.parameters == {
        "E": 2.1e11, "nu": 0.3, "yield_stress": 2.5e8, "tangent_modulus": 2.1e11 * 1e9 / 2.11e11, "beta": 0.0,
    }  # fmt: skip


@BOTH
def test_hardening_by_a_function(neu, load, tmp_path, same, block: int) -> None:
    curve = neu.block(420, "4,4,", "stress and strain", "1,0.,0.,", "2,0.001,200.,", "3,0.0035,300.,", "-1,0.,0.,")
    lines, version = of(block, {0: 2e5, 6: 0.3}, codes=(3, 4, 0, 0))
    model = load(neu.MESH + neu.block(block, *lines) + curve, version)
    material = model.materials[1]
    assert (material.law, material.parameters["yield_stress"]) == ("von_mises", 200.0)
    assert material.tables["hardening"] == pytest.approx(np.array([[0.0, 200.0], [0.002, 300.0]]))
    assert model.curves[4].points.tolist() == [[0.0, 0.0], [0.001, 200.0], [0.0035, 300.0]]
    assert not write(model, tmp_path / "o.neu")
    again = read(tmp_path / "o.neu")
    assert same(again.materials, model.materials)
    assert same(again.curves, model.curves)


@BOTH
def test_orthotropic(neu, load, tmp_path, same, block: int) -> None:
    values = {0: 10.0, 1: 20.0, 2: 30.0, 3: 1.0, 4: 2.0, 5: 3.0, 6: 0.1, 7: 0.2, 8: 0.3}
    lines, version = of(block, values, kind=2)
    model = load(neu.MESH + neu.block(block, *lines), version)
    assert (model.materials[1].law, model.materials[1].parameters) == (
        "orthotropic",
        {
            "Ex": 10.0,
            "Ey": 20.0,
            "Ez": 30.0,
            "nu_xy": 0.1,
            "nu_yz": 0.2,
            "nu_zx": 0.3,
            "Gxy": 1.0,
            "Gyz": 2.0,
            "Gzx": 3.0,
        },
    )
    assert "its third Poisson's ratio is taken as nu_zx" in model.warnings[-1]
    lines, version = of(block, {0: 10.0, 1: 20.0, 3: 1.0, 4: 2.0, 5: 3.0, 6: 0.1}, kind=1)
    flat = load(neu.MESH + neu.block(block, *lines), version)
    parameters = flat.materials[1].parameters
    assert [parameters[key] for key in ("Ex", "Ey", "Gxy", "Gzx", "Gyz")] == [10.0, 20.0, 1.0, 2.0, 3.0]
    for one in (model, flat):
        assert not write(one, tmp_path / "o.neu")
        assert same(read(tmp_path / "o.neu").materials, one.materials)


@BOTH
@pytest.mark.parametrize(
    ("kind", "codes", "said"),
    [
        (4, (0, 0, 0, 0), "is 3-D anisotropic"),
        (7, (0, 0, 0, 0), "is of kind 7"),
        (0, (1, 0, 0, 0), "is nonlinear elastic"),
        (0, (2, 0, 0, 2), "is nonlinear (kind 2, yield criterion 2)"),
        (0, (2, 0, 0, 0), "is plastic without a yield stress"),
    ],
)
def test_laws_that_are_kept_as_they_stand(neu, load, tmp_path, same, block, kind, codes, said) -> None:
    lines, version = of(block, STEEL | {9: 1.5, 29: 2.5}, kind, codes)
    model = load(neu.MESH + neu.block(block, *lines), version)
    material = model.materials[1]
    assert (material.law, material.native["values"][9], material.density) == ("", 1.5, 7850.0)
    assert said in model.warnings[-1]
    assert not write(model, tmp_path / "o.neu")
    assert same(read(tmp_path / "o.neu").materials, model.materials)


def test_functions_of_temperature(neu, load) -> None:
    text = material_401(STEEL, functions=True) + material_401({0: 1.0}, name="<NULL>", number=2)
    model = load(neu.MESH + neu.block(401, *text))
    assert [m.name for m in model.materials.values()] == ["steel", ""]
    assert "has 16 function(s) of temperature or the like, which are not carried" in model.warnings[-1]
    own = ("3,2,", "own", "1,0.,1.,", "2,1.,2.,", "-1,0.,0.,", *material_601({0: 1.0})[:0])
    model = load(neu.MESH + neu.block(601, *material_601(STEEL, own=own), *material_601({0: 5.0})), "10.0")
    assert model.materials[1].parameters["E"] == 5.0
    assert "material 1 has 1 function(s)" in model.warnings[-1]


def test_an_extra_line_from_version_4_5(neu, load) -> None:
    text = material_401(STEEL, codes="0,0,2,0,2,0,", plastic="0.,7.,0.,", extra=True)
    material = load(neu.MESH + neu.block(401, *text), "4.5").materials[1]
    assert (material.law, material.parameters["yield_stress"], material.parameters["beta"]) == ("von_mises", 7.0, 0.5)


def test_systems(neu, load, tmp_path) -> None:
    text = neu.block(405, "3,0,1,60,1,", "hub", "1.,2.,3.,", "0.,0.,90.,", "4,0,0,60,1,", "<NULL>", "0.,0.,0.,",
                     "10.,20.,30.,")  # fmt: skip
    model = load(neu.MESH + text)
    hub = model.systems[3]
    assert (hub.name, hub.kind, hub.origin.tolist()) == ("hub", "cylindrical", [1.0, 2.0, 3.0])
    assert hub.axes == pytest.approx(np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1.0]]))
    assert "1 coordinate system(s) turn about more than one axis" in model.warnings[0]
    assert not write(model, tmp_path / "o.neu")
    for number, system in read(tmp_path / "o.neu").systems.items():
        assert system.axes == pytest.approx(model.systems[number].axes, abs=1e-12)


@pytest.mark.parametrize("angles", [(0, 0, 0), (10, -20, 170), (0, 90, 25), (30, -90, 0), (180, 0, 0), (1e-9, 0, 0)])
def test_rotations(angles) -> None:
    axes = rotation(np.array(angles, float))
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-15)
    assert rotation(angles_of(axes)) == pytest.approx(axes, abs=1e-12)


CLIP = ["0,0,0,", "0,0,0,0,0.,0.,", "0,0,", *(["0,0,", "0.,0.,0.,", "0.,0.,0.,"] * 6)]


def test_groups(neu, load, tmp_path, same) -> None:
    wall = ["3,1,0,", "wall", *CLIP, "133,", "-1,", "28,", "7,", "4,", "2,", "9,", "-1,", "8,", "2,", "1,", "-1,",
            "1,", "5,", "-1,", "-1,"]  # fmt: skip
    rules = ["4,1,0,", "by rules", *CLIP, "133,", "17,", "1,7,2,1,", "5,5,1,0,", "-1,-1,-1,-1,", "30,", "1,1,1,1,",
             "-1,-1,-1,-1,", "-1,", "28,", "-1,"]  # fmt: skip
    mesh = neu.nodes(neu.CUBE) + neu.block(404, *neu.BRICK, *neu.element(2, 17, 4, [1, 2, 3, 4], part=2))
    model = load(mesh + neu.block(408, *wall, *rules))
    assert [(s.id, s.name, model.node_ids[s.nodes].tolist()) for s in model.node_sets] == [
        (3, "wall", [4, 2]),
        (4, "by rules", [1, 3, 7]),
    ]
    assert [(s.id, s.name, s.family, s.elements.tolist()) for s in model.element_sets] == [
        (3, "wall", "shell", [2]),
        (3, "wall", "solid", [1]),
    ]
    assert model.warnings[1:] == [
        "m.neu: 1 lists of kind 1 of groups are not read",
        "m.neu: 1 rules of kind 30 of groups are not read",
        "m.neu: 1 members of groups are not read: they are not in the mesh",
    ]
    assert not write(model, tmp_path / "o.neu")
    again = read(tmp_path / "o.neu")
    assert same(again.node_sets, model.node_sets)
    assert same(again.element_sets, model.element_sets)


def test_groups_of_another_form(neu, load) -> None:
    model = load(
        neu.MESH + neu.block(408, "3,1,0,", "wall", *CLIP[:5], "what") + neu.block(420, "1,1,", "f", "-1,0.,0.,")
    )
    assert model.node_sets == []
    assert "m.neu:37:4: the groups from here on are not read: block 408 ends here" in model.warnings[0]
    assert list(model.curves) == [1]
