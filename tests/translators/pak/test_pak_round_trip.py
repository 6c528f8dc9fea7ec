"""Models of all elements, materials and loads at random: what is read from their deck is what was written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from zrno.translators.columns import integers, reals
from zrno.translators.laws import LAWS
from zrno.translators.model import (
    BodyLoad,
    Curve,
    FaceLoad,
    FemControl,
    InitialVelocity,
    Material,
    Model,
    NodalLoad,
    Part,
    Section,
)
from zrno.translators.pak import read, write
from zrno.translators.pak.laws import OF_LAW
from zrno.translators.text import parse_real

# numbers that stand in ten columns, and in eight digits with any sign and power
NUMBERS = st.builds(lambda m, e: float(f"{m}e{e}"), st.integers(-9999, 9999), st.integers(-20, 20))
POSITIVE = st.builds(lambda m, e: float(f"{m}e{e}"), st.integers(1, 9999), st.integers(-20, 20))
RATIO = st.integers(0, 49).map(lambda n: n / 100)
KINDS = st.lists(
    st.sampled_from(
        [("solid", kind) for kind in ("hex8", "hex20", "tet4", "wedge6", "pyramid5")]
        + [("shell", kind) for kind in ("quad4", "quad8", "quad9", "tri3", "tri6")]
        + [("truss", "line2"), ("beam", "line2")]
    ),
    min_size=1,
    max_size=7,
)


@st.composite
def materials(draw: st.DrawFn, number: int) -> Material:
    law = draw(st.sampled_from(sorted(OF_LAW)))
    parameters = {name: draw(NUMBERS) for name in LAWS[law].parameters}
    parameters |= {name: draw(POSITIVE) for name in ("E", "K", "G") if name in parameters}
    parameters |= {name: draw(RATIO) for name in ("nu",) if name in parameters}
    if law == "von_mises":
        parameters = {"E": 5.0, "nu": 0.25, "yield_stress": draw(POSITIVE), "tangent_modulus": draw(RATIO), "beta": 1.0}
    if law in ("cap", "drucker_prager"):
        parameters = {k: v for k, v in parameters.items() if k not in ("C", "N", "ftype", "vec")}
    if law == "cap":
        parameters |= {"K": 2.5 * parameters["G"]}
    return Material(number, "", law, draw(POSITIVE), parameters)


@st.composite
def models(draw: st.DrawFn, mesh: Callable[..., Model]) -> Model:
    kinds = draw(KINDS)
    model = mesh(*(kind for _, kind in kinds))
    count = draw(st.integers(1, 3))
    model.materials = {k: draw(materials(k)) for k in range(1, count + 1)}
    model.parts.clear()
    model.sections.clear()
    for number, (block, (family, _)) in enumerate(zip(model.blocks, kinds, strict=True), 1):
        block.family = family
        model.sections[number] = Section(number, kind=family, parameters={
            name: draw(POSITIVE) for name in ("thickness", "area", "iyy", "izz", "j")})  # fmt: skip
        model.parts[number] = Part(number, material=draw(st.integers(1, count)), section=number)
        block.part[:] = number
        if family == "beam":
            block.data["orientation"] = np.array([[0.0, 0.0, 4.0]])
    nodes = len(model.xyz)
    if draw(st.booleans()):
        model.node_ids = np.sort(draw(st.permutations(range(1, 200))))[:nodes] * draw(st.sampled_from([1, 3, 7000]))
    model.fixed = np.array(draw(st.lists(st.booleans(), min_size=6 * nodes, max_size=6 * nodes))).reshape(-1, 6)
    model.curves = {1: Curve(1, "", np.array([(0.0, draw(NUMBERS)), (9.0, draw(NUMBERS)), (9.0, 0.0), (99.0, 1.0)]))}
    model.fem_control = FemControl(
        suppressed=(0, 0, 0, 0, 0, draw(st.integers(0, 1))),
        dynamic=draw(st.integers(0, 1)),
        wide=draw(st.booleans()),
        periods=draw(st.lists(st.tuples(st.integers(1, 5), st.just(0.25)), min_size=1, max_size=3)),
        rayleigh=(draw(NUMBERS), draw(NUMBERS)),
        plot_blocks=draw(st.lists(st.tuples(*[st.integers(0, 9)] * 4), max_size=2)),
    )
    some = np.array(draw(st.lists(st.integers(0, nodes - 1), min_size=1, max_size=5, unique=True)))
    dofs = np.array([draw(st.integers(1, 6)) for _ in some])
    values = np.array([draw(NUMBERS) for _ in some])
    model.nodal_loads = [NodalLoad("force", some, dofs, values, 1)]
    model.fixed[some, dofs - 1] = False
    model.nodal_loads.append(NodalLoad("displacement", some, dofs, values[::-1].copy(), 1))
    if draw(st.booleans()):
        model.nodal_loads[1].native = {"incremental": True}
    model.face_loads = [FaceLoad(np.array([[0, 1, 2, 3]]) % nodes, np.array([[draw(NUMBERS)]]), draw(st.integers(0, 3)),
                                 1)]  # fmt: skip
    if len(np.unique(model.face_loads[0].faces)) < 4:
        model.face_loads.clear()
    model.body_loads = [BodyLoad((draw(NUMBERS), 0.0, draw(NUMBERS)), 1)]
    if model.fem_control.dynamic:
        near = np.sort(some[model.node_ids[some] < 99_999])
        if len(near):
            velocity = np.array([[draw(NUMBERS) for _ in range(3)] for _ in near])
            model.initial_velocities = [InitialVelocity(near, velocity)]
    return model


@settings(
    max_examples=120, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
@given(data=st.data())
def test_write_read_write(
    tmp_path: Path, mesh: Callable[..., Model], strict: ModuleType, same: Callable, data: st.DataObject
) -> None:
    model = data.draw(models(mesh))
    report = write(model, tmp_path / "a.dat")
    again = read(tmp_path / "a.dat")
    deck = strict.read(tmp_path / "a.dat")
    assert not report.dropped
    assert {item.what for item in report.approximated} <= {f"material {m.id}" for m in model.materials.values()
                                                           if m.law == "cap"}  # fmt: skip
    write(again, tmp_path / "b.dat")
    assert (tmp_path / "a.dat").read_bytes() == (tmp_path / "b.dat").read_bytes()
    assert again.fem_control.periods == model.fem_control.periods
    for name in ("xyz", "node_ids", "nodal_loads", "face_loads", "body_loads", "initial_velocities", "fixed"):
        assert same(getattr(again, name), getattr(model, name)), name
    by_number = {(block.family, int(block.ids[0])): block for block in model.blocks}
    found = 0
    for block in again.blocks:
        for number, nodes, part in zip(block.ids, block.nodes, block.part, strict=True):
            if (block.family, int(number)) not in by_number:
                continue  # numbered anew
            own = by_number[block.family, int(number)]
            assert own.kind == block.kind
            assert sorted(own.nodes[0]) == sorted(nodes)
            section, material = (model.parts[int(own.part[0])].section, model.parts[int(own.part[0])].material)
            law = again.materials[again.parts[int(part)].material]
            assert law.law == model.materials[material].law
            if law.law != "cap":
                assert law.parameters == model.materials[material].parameters
            if block.family == "shell":
                assert block.data["thickness"][0] == model.sections[section].parameters["thickness"]
            found += 1
    assert found == len(model.blocks)
    for number, (netip, _, _) in enumerate(deck.groups):
        if netip == 3:
            assert strict.jacobians(deck, number).min() > 0


REALS = st.floats(-1e300, 1e300) | NUMBERS | st.floats(-1000, 1000)


@settings(max_examples=300, deadline=None)
@given(st.lists(REALS, min_size=1, max_size=20), st.sampled_from([10, 15, 20]))
@example([-0.01171875], 10)
def test_columns_of_reals(values: list[float], width: int) -> None:
    text, said = reals(np.array(values), width)
    for value, row, number in zip(values, text, said.tolist(), strict=True):
        word = bytes(row).decode().strip()
        read_back = parse_real(word, 3)
        assert read_back is not None
        assert "." in word
        assert abs(read_back - number) <= 4e-16 * abs(number)
        digits = min(width - 3, 15) if 1e-2 <= abs(value) < 1e6 else min(width - 7, 14)  # at least so many
        digits -= 1e-2 <= abs(value) < 0.1  # one column has the zero behind the point
        assert abs(read_back - value) <= 10.0 ** (1 - digits) * max(abs(value), 1e-300)


@given(st.lists(st.integers(-9999, 99999), min_size=1))
def test_columns_of_integers(values: list[int]) -> None:
    assert [int(bytes(row)) for row in integers(np.array(values), 5)] == values
