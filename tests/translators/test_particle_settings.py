"""Decks of particles of which a mesh gives the shape alone and the settings all else."""

from __future__ import annotations

from pathlib import Path

import pytest

from zrno.translators import InputError, load_settings, read, to_particles, write
from zrno.translators.laws import EQUATIONS_OF_STATE
from zrno.translators.mcm.cards import EQUATIONS_OF_STATE as NUMBERS
from zrno.translators.model import Model

pytest.importorskip("gmsh")

TANK = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 0.5};
Mesh.MeshSizeMax = 0.1;
Physical Surface("water", 1) = {1};
"""
WATER = {
    "end_time": 0.5,
    "gravity": [0, -9.81, 0],
    "materials": {
        "water": {
            "law": "fluid",
            "density": 1000.0,
            "viscosity": 1e-3,
            "eos": {"type": "murnaghan", "B": 5e4, "gamma": 7},
        }
    },
    "planes": {"xmin": ["symmetry", 0.0], "xmax": ["symmetry", 1.0], "ymin": ["symmetry", 0.0]},
}


@pytest.fixture(scope="module")
def tank(tmp_path_factory: pytest.TempPathFactory) -> Model:
    path = tmp_path_factory.mktemp("tank") / "tank.geo"
    path.write_text(TANK)
    return read(path)


def made(tank: Model, given: dict, path: Path) -> Model:
    """The deck of a tank, read again. given: settings, groups as dicts."""
    deck, _ = to_particles(tank, load_settings(overrides=given), spacing=0.05)
    write(deck, path)
    return read(path)


def test_a_fluid_block_in_a_box(tank: Model, tmp_path: Path) -> None:
    deck = made(tank, WATER, tmp_path / "tank.mcm")
    water = deck.materials[1]
    assert (water.law, water.density, water.parameters["viscosity"]) == ("fluid", 1000.0, 1e-3)
    assert deck.equations_of_state[water.eos].law == "murnaghan"
    assert deck.equations_of_state[water.eos].parameters == {"B": 5e4, "gamma": 7.0, "E0": 0.0, "V0": 0.0}
    assert deck.particle_control.planes == [(1, 0.0), (1, 1.0), (1, 0.0), (0, 0.0), (0, 0.0), (0, 0.0)]
    assert deck.particle_control.base_acceleration == (0.0, -9.81, 0.0)
    assert len(deck.particles) == 200
    assert water.mass == pytest.approx(500.0, rel=1e-12)


@pytest.mark.parametrize("kind", EQUATIONS_OF_STATE)
@pytest.mark.parametrize("law", ["fluid", "hydro"])
def test_every_equation_of_state(tank: Model, tmp_path: Path, law: str, kind: str) -> None:
    values = {name: 0.5 + k for k, name in enumerate(EQUATIONS_OF_STATE[kind].parameters)}
    material = {"law": law, "density": 1000.0, "eos": {"type": kind, **values}} | ({"G": 5.0} if law == "hydro" else {})
    deck = made(tank, {"materials": {"water": material}}, tmp_path / "tank.mcm")
    eos = deck.equations_of_state[deck.materials[1].eos]
    assert (deck.materials[1].law, eos.law, eos.parameters) == (law, kind, values)
    assert f"{NUMBERS[kind].number:5d}" in (tmp_path / "tank.mcm").read_text()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"materials.water.eos": {}}, "the law fluid of water needs an equation of state"),
        ({"materials.water.eos": {"type": "murnaghan", "B": 1}}, "materials.water.eos.gamma is missing"),
        ({"materials.water.eos": {"type": "perfect_gas", "gamma": 1, "B": 2}}, "perfect_gas has no B"),
        ({"materials.water.law": "elastic"}, "the law elastic of water takes no equation of state"),
        ({"materials.water.eos": {"type": "tait"}}, "materials.water.eos.type is not what it should be"),
        ({"materials.water.eos": {"kind": "murnaghan"}}, "unknown key materials.water.eos.kind"),
        ({"planes.xmax": ["periodic", 1]}, "periodic on one side alone"),
        ({"planes.xmax": ["symmetry", -1]}, "the plane xmax is not above xmin"),
        ({"planes.zmax": ["symmetry", 1]}, "planes of z in a flat mesh"),
        ({"planes.xmax": ["wall", 1]}, "planes.xmax is not what it should be"),
        ({"history_particles": [201]}, "no such particle"),
        ({"transducers": [[0, 0, 0, 2]]}, "no such material"),
        ({"transducers": [[0, 0, 1]]}, "transducers is not what it should be"),
        ({"birth_death": {"option": 2}}, "birth_death.death_plane is missing"),
        ({"birth_death": {"option": 1}}, "birth_death.particles is missing"),
        ({"friction": {"static": 1, "kinetic": 1, "fluid": 1}}, "friction of a fluid and of solids"),
    ],
)
def test_settings_that_do_not_fit(tank: Model, tmp_path: Path, change: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        made(tank, WATER | {"materials.water.E": 1, "materials.water.nu": 0} | change, tmp_path / "tank.mcm")
    assert not (tmp_path / "tank.mcm").exists()


def test_every_field_of_the_control_cards(tank: Model, tmp_path: Path) -> None:
    given = {
        "step_factor": 0.7, "initial_step": 1e-4, "dynamic_relaxation": 0.9, "discretisation": 1, "step_option": 2,
        "h_option": 2, "xsph": True, "max_neighbours": 90, "contact": "potential", "history_interval": 0.01,
        "contact_laws": {"*": {"strength": 10.0, "exponent": 2.0}}, "friction": {"fluid": 0.25},
        "history_particles": [1, 200], "transducers": [[0.5, 0.25, 0, 1]],
        "birth_death": {"option": 3, "particles": [1, 10], "birth_plane": [0, 0, 0, 1], "death_plane": [1, 0, 0, 1]},
    }  # fmt: skip
    own = {"quadratic": 2.0, "linear": 0.5, "h_factor": 1.5, "rho_min": 900.0, "rho_max": 1100.0, "velocity": [1, 2, 0]}
    material = WATER["materials"]["water"] | own
    deck = made(tank, WATER | given | {"materials": {"water": material}}, tmp_path / "tank.mcm")
    c, water = deck.particle_control, deck.materials[1]
    assert (c.step_factor, c.initial_step, c.dynamic_relaxation, c.discretisation) == (0.7, 1e-4, 0.9, 1)
    assert (c.step_option, c.h_option, c.velocity_option, c.max_neighbours) == (2, 2, 1, 90)
    assert (c.contact, c.contact_laws, c.fluid_friction, c.history_interval) == (1, [(10.0, 2.0)], 0.25, 0.01)
    assert (c.history_particles, c.transducers) == ([1, 200], [(0.5, 0.25, 1)])
    assert (c.birth_death, c.plane_particle, c.birth_range) == (3, 1, (1, 10))
    assert (c.birth_plane, c.death_plane) == ((0.0, 0.0, 0.0, 1), (1.0, 0.0, 0.0, 1))
    assert (water.viscosity_quadratic, water.viscosity_linear, water.rho_min, water.rho_max) == (2.0, 0.5, 900, 1100)
    assert water.h == pytest.approx(1.5 * 0.05)
    assert (deck.particles.velocity == [1, 2, 0]).all()


def test_velocities_and_what_is_held_by_formulas_of_the_place(tank: Model, tmp_path: Path) -> None:
    own = {"velocity": ["-2 * x / (1 + y**2)", 0.5, "0"], "bc": "xyz", "bc_where": "x < 0.2 and y > 0.1"}
    deck = made(tank, WATER | {"materials": {"water": WATER["materials"]["water"] | own}}, tmp_path / "tank.mcm")
    x, y, _ = deck.particles.x.T
    assert deck.particles.velocity[:, 0] == pytest.approx(-2.0 * x / (1.0 + y**2), rel=1e-7)
    assert (deck.particles.velocity[:, 1:] == [0.5, 0.0]).all()
    assert deck.particles.bc.tolist() == [7 if a < 0.2 and b > 0.1 else 0 for a, b in zip(x, y, strict=True)]


@pytest.mark.parametrize(
    ("own", "wrong"),
    [
        ({"velocity": ["t", 0, 0]}, "velocity is not what it should be .*a formula of numbers"),
        ({"velocity": [None, 0, 0]}, "a list of three numbers or formulas"),
        ({"bc_where": "x"}, "bc_where is not what it should be .*a region such as"),
        ({"bc_where": 3}, "a region such as"),
    ],
)
def test_formulas_that_are_none(own: dict, wrong: str) -> None:
    with pytest.raises(InputError, match=wrong):
        load_settings(overrides={"materials": {"water": own}})


def test_a_formula_without_a_value_somewhere(tank: Model) -> None:
    given = {"materials": {"water": WATER["materials"]["water"] | {"velocity": ["sqrt(x - 0.5)", 0, 0]}}}
    with pytest.raises(ValueError, match=r"velocity: sqrt\(x - 0.5\) is no number at 0.025, 0.025, 0"):
        to_particles(tank, load_settings(overrides=given), spacing=0.05)


def test_the_equation_of_a_keyword_deck(tmp_path: Path) -> None:
    (tmp_path / "a.k").write_text(
        "*KEYWORD\n*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT_SPH\n1,1,1.0\n2,1,1.0\n*PART\nwater\n1,0,1,1\n"
        "*MAT_NULL\n1,1000.0\n*EOS_GRUNEISEN\n1,1500.0,1.9\n*END\n"
    )
    write(to_particles(read(tmp_path / "a.k"), load_settings())[0], tmp_path / "a.mcm")
    deck = read(tmp_path / "a.mcm")
    eos = deck.equations_of_state[deck.materials[1].eos]
    assert (eos.law, eos.parameters["C"], eos.parameters["S1"]) == ("gruneisen", 1500.0, 1.9)
