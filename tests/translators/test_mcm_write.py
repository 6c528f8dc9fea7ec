from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from zrno.translators.mcm import read, write
from zrno.translators.mcm.cards import EQUATIONS_OF_STATE, LAWS
from zrno.translators.model import Eos, Material, Model, NodeSet, ParticleControl, Particles

CODES = st.integers(0, 7)
# numbers as they can stand in 10 and in 20 columns
TEN = st.builds(lambda m, e: float(f"{m}e{e}"), st.integers(-99999, 99999), st.integers(-30, 30))
TEN_POSITIVE = st.builds(lambda m, e: float(f"{m}e{e}"), st.integers(1, 99999), st.integers(-30, 30))
TWENTY = st.builds(lambda m, e: float(f"{m}e{e}"), st.integers(-(10**13), 10**13), st.integers(-40, 40))
TWENTY_POSITIVE = st.builds(lambda m, e: float(f"{m}e{e}"), st.integers(1, 10**13), st.integers(-40, 40))
TITLES = st.text("abcdefgh $*,.-0123456789", max_size=70).map(lambda text: text.strip())


@st.composite
def models(draw: st.DrawFn) -> Model:
    dimension = draw(st.integers(1, 3))
    nummat = draw(st.integers(1, 3))
    count = draw(st.integers(nummat, 12))
    material = [*range(1, nummat + 1), *(draw(st.integers(1, nummat)) for _ in range(count - nummat))]
    materials: dict[int, Material] = {}
    equations: dict[int, Eos] = {}
    for number in range(1, nummat + 1):
        law = draw(st.sampled_from(sorted(LAWS)))
        names = list(LAWS[law].positions)
        if law == "von_mises" and draw(st.booleans()):
            names.append("failure_strain")
        materials[number] = Material(
            number, draw(TITLES), law, draw(TEN_POSITIVE), {name: draw(TEN) for name in names},
            draw(TEN_POSITIVE), draw(TEN_POSITIVE),
            *(draw(st.none() | TEN_POSITIVE) for _ in range(4)),
        )  # fmt: skip
        if law == "hydro" and draw(st.booleans()):
            table = np.array([[draw(TEN), draw(TEN_POSITIVE)] for _ in range(draw(st.integers(1, 16)))])
            materials[number].tables["hardening"] = table
        if LAWS[law].eos:
            materials[number].eos = number
            kind = draw(st.sampled_from(sorted(EQUATIONS_OF_STATE)))
            fields = [name for card in EQUATIONS_OF_STATE[kind].cards for name in card.fields]
            equations[number] = Eos(number, draw(TITLES), kind, {name: draw(TEN) for name in fields})

    def column(values: st.SearchStrategy[float]) -> np.ndarray:
        return np.array([draw(values) for _ in range(count)])

    x = np.zeros((count, 3))
    velocity = np.zeros((count, 3))
    for axis in range(dimension):
        x[:, axis] = column(TWENTY)
        velocity[:, axis] = column(st.sampled_from([0.0, draw(TEN)]))
    particles = Particles(x, np.array(material), np.array([draw(CODES) for _ in range(count)]))
    if draw(st.booleans()):
        particles.velocity = velocity
    particles.mass, particles.h = (column(TWENTY_POSITIVE) if draw(st.booleans()) else None for _ in range(2))
    if draw(st.booleans()):
        particles.rho, particles.e = column(TWENTY_POSITIVE), column(TEN)
    overrun = draw(st.integers(0, 3)) if particles.velocity is not None else 0
    dialect = draw(st.sampled_from(["2.07", "2019-08", "2019-10"]))
    base = tuple(draw(TWENTY) for _ in range(3))
    friction = (abs(draw(TEN)), abs(draw(TEN))) if dialect != "2.07" else None
    fluid = draw(TEN) if dialect == "2019-10" and draw(st.booleans()) else None
    contact = draw(st.integers(0, 1))
    positive = TEN.map(abs)
    control = ParticleControl(
        dimension=dimension,
        axisymmetric=dimension == 2 and draw(st.booleans()),
        discretisation=draw(st.integers(0, 1)),
        end_time=draw(positive),
        step_factor=draw(positive),
        initial_step=draw(positive),
        dynamic_relaxation=draw(positive),
        output_interval=draw(positive),
        state_option=draw(st.integers(0, 4)),
        history_interval=draw(positive),
        history_particles=draw(st.lists(st.integers(1, count), max_size=23)),
        transducers=[
            (*(draw(TEN) for _ in range(dimension)), draw(st.integers(1, nummat)))
            for _ in range(draw(st.integers(0, 2)))
        ],
        status_interval=draw(st.integers(0, 10**6)),
        contact=contact,
        step_option=draw(st.integers(0, 2)),
        velocity_option=draw(st.integers(0, 1)),
        h_option=draw(st.integers(0, 2)),
        max_neighbours=draw(st.integers(0, 999)),
        max_particles=draw(st.sampled_from([0, count + 100])),
        dialect=dialect,
        friction=None if fluid is not None else friction,
        fluid_friction=fluid,
        base_acceleration=base if any(base) else None,
        planes=[(flag, draw(TEN)) for flag in (1, 0, 2, 2, 3, 0)] if draw(st.booleans()) else None,
        contact_laws=[(draw(TEN), draw(TEN)) for _ in range(nummat)] if contact else [],
    )
    if dialect == "2019-10" and draw(st.booleans()):
        control.birth_death, control.plane_particle = draw(st.integers(1, 3)), draw(st.integers(0, 1))
        control.birth_range = (draw(st.integers(0, 3)), draw(st.integers(3, 10**9)))
        planes = [(draw(TWENTY), draw(TWENTY), draw(TWENTY), draw(st.integers(0, 9))) for _ in range(2)]
        control.birth_plane = planes[0] if control.plane_particle else None
        control.death_plane = planes[1] if control.birth_death >= 2 else None
    return Model(
        title=draw(TITLES), format="mcm", version="2", dimension=dimension, materials=materials, particles=particles,
        particle_control=control, velocity_overrun=overrun, equations_of_state=equations,
    )  # fmt: skip


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
@given(models())
def test_write_read_write(tmp_path: Path, same, model: Model) -> None:
    report = write(model, tmp_path / "a.mcm")
    assert not report
    again = read(tmp_path / "a.mcm", paired=True)
    assert same(model, again)
    write(again, tmp_path / "b.mcm")
    first = (tmp_path / "a.mcm").read_bytes()
    assert first == (tmp_path / "b.mcm").read_bytes()
    assert max(map(len, first.splitlines())) <= 80


DECKS = [
    *(f"reference/mcm/{name}.mcm" for name in ("block20k", "kupa1f", "newhop3f")),
    "reference/coupled/cplate.mcm", "samples/mcm/kupa1.mcm", "samples/mcm/newhope3.mcm",
]  # fmt: skip


@pytest.mark.parametrize(("name", "dialect"), list(itertools.product(DECKS, ["2.07", "2019-10"])))
def test_read_write_read_of_real_decks(shared: Path, tmp_path: Path, same, name: str, dialect: str) -> None:
    model = read(shared / name, paired=True)
    report = write(model, tmp_path / "a.mcm", dialect=dialect)
    again = read(tmp_path / "a.mcm", paired=True)
    assert not report
    assert again.particle_control.dialect == dialect
    again.particle_control.dialect = model.particle_control.dialect
    assert same(model, again)


@pytest.fixture
def model(tmp_path: Path, deck) -> Model:
    (tmp_path / "source.mcm").write_text(deck())
    return read(tmp_path / "source.mcm")


def test_the_dialect_written(tmp_path: Path, model: Model) -> None:
    target = tmp_path / "a.mcm"
    write(model, target)
    assert "$ control card 7: blank\n\n" in target.read_text()
    model.particle_control.friction = (0.3, 0.2)
    write(model, target)
    assert read(target).particle_control.dialect == "2019-10"
    report = write(model, target, dialect="2.07")
    assert [item.what for item in report.dropped] == ["friction"]
    assert read(target).particle_control.friction is None
    assert not write(model, target, dialect="2019-08")
    assert read(target).particle_control.friction == (0.3, 0.2)
    with pytest.raises(ValueError, match="no such dialect"):
        write(model, target, dialect="2020")


def test_what_columns_cannot_hold_is_counted(tmp_path: Path, model: Model) -> None:
    model.particles.x[0, 0] = -1.2345678901234567e-21
    model.particles.velocity[0] = [1 / 3, 0, 0]
    model.materials[1].parameters["E"] = 0.12345678901
    report = write(model, tmp_path / "a.mcm")
    assert {item.what: item.count for item in report.approximated} == {
        "particle coordinates": 1, "initial velocities": 1, "material 1": 1,
    }  # fmt: skip
    again = read(tmp_path / "a.mcm")
    assert again.particles.x[0, 0] == pytest.approx(-1.2345678901234567e-21, rel=1e-14, abs=0)
    assert again.particles.velocity[0, 0] == pytest.approx(1 / 3, rel=1e-7)


def test_what_a_deck_cannot_say_is_reported(tmp_path: Path, model: Model) -> None:
    model.node_sets.append(NodeSet(1, "edge", np.array([0])))
    model.materials[1].parameters["yield_stress"] = 1.0
    model.title = "š" * 90
    report = write(model, tmp_path / "much_too_long_a_name.mcm")
    assert [item.what for item in report.dropped] == ["node sets", "parameters of material 1"]
    assert [item.what for item in report.approximated] == ["title"]
    assert "at most 12 characters" in report.notes[0]
    assert (tmp_path / "much_too_long_a_name.mcm").read_bytes().isascii()


@pytest.mark.parametrize("title", ["* star", "$ dollar"])
def test_a_title_is_never_a_comment(tmp_path: Path, model: Model, title: str) -> None:
    model.title = model.materials[1].name = title
    write(model, tmp_path / "a.mcm")
    again = read(tmp_path / "a.mcm")
    assert (again.title, again.materials[1].name) == (title, title)


def break_material(model: Model) -> None:
    model.materials[1].law = "soil_foam"


def break_equation(model: Model) -> None:
    model.materials[1].law = "fluid"


def break_number(model: Model) -> None:
    model.materials[1].id = 7


def break_contact(model: Model) -> None:
    model.particle_control.contact = 1


def break_position(model: Model) -> None:
    model.particles.x[1, 1] = np.nan


def break_owner(model: Model) -> None:
    model.particles.material[0] = 3


def break_particles(model: Model) -> None:
    model.particles = None


@pytest.mark.parametrize(
    "damage",
    [break_material, break_equation, break_number, break_contact, break_position, break_owner, break_particles],
)
def test_no_file_of_a_model_that_no_deck_can_hold(tmp_path: Path, model: Model, damage) -> None:
    damage(model)
    before = set(tmp_path.iterdir())
    with pytest.raises(ValueError, match=r"\w"):
        write(model, tmp_path / "a.mcm")
    assert set(tmp_path.iterdir()) == before


def test_nothing_is_left_of_a_write_that_failed(tmp_path: Path, model: Model) -> None:
    model.particle_control.max_neighbours = 10**9  # too wide for its field, met in mid-file
    with pytest.raises(ValueError, match="maxnbr = 1000000000 does not fit 5 columns"):
        write(model, tmp_path / "a.mcm")
    assert [path.name for path in tmp_path.iterdir()] == ["source.mcm"]
