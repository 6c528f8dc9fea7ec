from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from zrno.translators.mcm import read
from zrno.translators.text import InputError

Faults = Callable[..., list[str]]
Deck = Callable[..., str]


@pytest.fixture
def model(tmp_path: Path) -> Callable:
    def of(text: str, **options: bool):
        (tmp_path / "deck.mcm").write_text(text)
        return read(tmp_path / "deck.mcm", **options)

    return of


def test_a_deck(model, deck) -> None:
    m = model(deck())
    c = m.particle_control
    assert (m.title, m.version, m.dimension) == ("four particles", "2", 3)
    assert (c.end_time, c.step_factor, c.output_interval, c.history_interval) == (1.0, 0.8, 0.1, 0.01)
    assert (c.step_option, c.max_neighbours, c.state_option, c.status_interval, c.dialect) == (2, 60, 4, 100, "2.07")
    elastic, plastic = m.materials.values()
    assert (elastic.law, elastic.density, elastic.mass, elastic.h) == ("elastic", 2.7, 5.4, 0.12)
    assert elastic.parameters == {"E": 0.7, "nu": 0.33}
    assert (elastic.viscosity_quadratic, elastic.viscosity_linear) == (2.0, 0.5)
    assert plastic.viscosity_quadratic is None
    assert plastic.parameters == {
        "E": 0.7, "nu": 0.33, "yield_stress": 0.003, "tangent_modulus": 0.01, "beta": 0.5, "failure_strain": 0.25,
    }  # fmt: skip
    assert m.particles.x[3].tolist() == [0.3, 0.0, 0.1]
    assert m.particles.material.tolist() == [1, 1, 2, 2]
    assert m.particles.bc.tolist() == [0, 0, 7, 0]
    assert m.particles.velocity[:, 0].tolist() == [0.01, 0.01, 0.0, 0.0]
    assert m.warnings == []


def test_a_failure_strain_that_is_switched_off_is_said(model, deck) -> None:
    m = model(deck(("       1.0      0.25", "       0.0      0.25")))
    assert "failure_strain" not in m.materials[2].parameters
    assert "failure is switched off" in m.warnings[0]


def test_gaps_between_equal_velocities_are_filled(model, deck) -> None:
    cards = "       2      0.01       0.0       0.0\n       3       0.0       0.0       0.0\n"
    m = model(deck((cards, "       3      0.01       0.0       0.0\n")))
    assert m.particles.velocity[:, 0].tolist() == [0.01, 0.01, 0.01, 0.0]


@pytest.mark.parametrize(
    ("card_7", "dialect", "friction", "fluid"),
    [
        ("", "2.07", None, None),
        ("       0.3       0.2", "2019-08", (0.3, 0.2), None),
        ("   1E-01   1E-02", "2019-08", (0.1, 0.01), None),
        ("    0    0    0", "2019-10", None, None),
        ("    0    1    0\n       0.3       0.2", "2019-10", (0.3, 0.2), None),
        ("    0    1    0\n", "2019-10", (0.5, 0.02), None),
        ("    0    2    0\n       0.4", "2019-10", None, 0.4),
    ],
)
def test_dialects_are_told_apart_by_card_7(model, deck, card_7, dialect, friction, fluid) -> None:
    c = model(deck(card_7=card_7)).particle_control
    assert (c.dialect, c.friction, c.fluid_friction) == (dialect, friction, fluid)


def test_planes_contact_and_base_acceleration(model, deck) -> None:
    end = (
        f"{1:10d}{0:10d}{2:10d}{2:10d}{0:10d}{3:10d}\n{-1.0:10}{0.0:10}{-2.0:10}{2.0:10}{0.0:10}{9.0:10}\n"
        f"   -1    1\n     200.0       4.0\n      1000       4.0\n{0.0:20}{5.0:20}{-9.81:20}\n"
    )
    m = model(
        deck(
            ("    1    2    0    0    0    0    0    0", "    1    2    0    1    0    0    0    1"), contact=1, end=end
        )
    )
    c = m.particle_control
    assert c.planes == [(1, -1.0), (0, 0.0), (2, -2.0), (2, 2.0), (0, 0.0), (3, 9.0)]
    assert c.contact_laws == [(200.0, 4.0), (0.01, 4.0)]
    assert c.base_acceleration == (0.0, 0.0, -9.81)
    assert any("1000 has no decimal point" in w for w in m.warnings)
    assert any("base acceleration in y is not used" in w for w in m.warnings)


def test_history_particles_transducers_and_extra_cards(model, deck) -> None:
    extra = "".join(f"{i:8d}{0.5 * i:20}{0.1:20}{2.5:20}{0.25:<20}\n" for i in range(1, 5))
    end = extra + f"{1:8d}{4:8d}\n{0.1:10}{0.2:10}{0.3:10}    2\n"
    velocities = deck()[deck().index("       1      0.01") :]
    text = deck(
        ("      0.01         0    0", "      0.01         2    1"),
        ("    1    1    0    0    0", "    1    1    1    1    1"),
    )
    m = model(text.replace(velocities, end + velocities))
    assert m.particle_control.history_particles == [1, 4]
    assert m.particle_control.transducers == [(0.1, 0.2, 0.3, 2)]
    assert m.particles.mass.tolist() == [0.5, 1.0, 1.5, 2.0]
    assert m.particles.h.tolist() == [0.1] * 4
    assert m.particles.rho.tolist() == [2.5] * 4
    assert m.particles.e.tolist() == [0.25] * 4


def test_version_1(model) -> None:
    text = (
        f"{'old deck':78} 1\n    2    5         1         2         0         0\n       3.0       0.7       0.1\n"
        "       0.5      0.05         0    0    4\n         1    0    0\n    0    0    1    0    2    1    0\n"
        "    1    1       2.0    0    0       0.0    0\n       1.0       0.1\nmat\n       1.0\n       0.2\n\n\n\n\n"
        "       1    0                 0.0                 1.0      1\n"
        "       2    0                 1.0                 1.0      1\n"
        "       1       0.5       0.0\n       2       0.5       0.0\n"
        "      -1.0       2.0      -3.0       4.0\n    0    1    0    1\n"
    )
    m = model(text)
    c = m.particle_control
    assert (m.version, m.dimension, c.discretisation, c.end_time, c.state_option) == ("1", 2, 1, 3.0, 4)
    assert (c.step_option, c.h_option, c.initial_step) == (1, 2, 0.1)
    assert c.planes[:4] == [(1, -1.0), (0, 2.0), (1, -3.0), (0, 4.0)]
    assert m.particles.velocity[:, 0].tolist() == [0.5, 0.5]


def first(lines: list[str]) -> str:
    return lines[0]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("                 0.2", "                 0.x", "deck.mcm:31:31: error: x is not a number (0.x); expected"),
        ("0.0      2\n       4", "0.0      9\n       4", "31:80: error: material number out of range (9)"),
        ("       3    7", "       5    7", "deck.mcm:31:8: error: particle number out of order (5); expected 3"),
        ("       3    7", "       3    9", "deck.mcm:31:13: error: no such boundary code (9); expected 0 to 7"),
        ("       2.7    0", "       0.0    0", "density is not positive (0.0)"),
        ("      0.12\nelastic", "       0.0\nelastic", "smoothing length is not positive (0.0)"),
        ("       5.4      0.12\nelastic", "      -5.4      0.12\nelastic", "mass is not positive (-5.4)"),
        ("    1    1       2.7", "    1   10       2.7", "the hydro law needs an equation of state (0)"),
        ("    1    1       2.7", "    1   77       2.7", "no such material model (77)"),
        ("    1    1       2.7", "    2    1       2.7", "material number out of order (2); expected 1"),
        ("       1      0.01", "       2      0.01", "do not begin with particle 1 (2)"),
        ("       4       0.0       0.0", "       5       0.0       0.0", "past the last particle 4 (5)"),
        ("       4       0.0       0.0", "       x       0.0       0.0", "number is not an integer (x)"),
        ("                 0.2", "           1.0E+999", "deck.mcm:31:25: error: x is not a finite number"),
        ("       1.0       0.8", "      -1.0       0.8", "endtime is negative (-1.0)"),
        ("    0    1   60", "    5    1   60", "no such smoothing length option (5)"),
        ("    0    1   60", "    0    3   60", "no such kernel (3)"),
    ],
)  # fmt: skip
def test_faults(faults: Faults, deck: Deck, old: str, new: str, said: str) -> None:
    lines = faults(read, deck((old, new)))
    assert any(said in line for line in lines), lines


def test_all_faults_are_said_in_order(faults: Faults, deck: Deck) -> None:
    lines = faults(
        read, deck(("       0.7", "       abc"), ("      2\n       4", "      8\n       4"), ("0.1D+00", "  1.0.0"))
    )
    assert [line.split(":")[1] for line in lines] == ["14", "31", "32"]


def test_velocities_without_a_gap_filler(faults: Faults, deck: Deck) -> None:
    lines = faults(read, deck(("       2      0.01       0.0       0.0\n", "")))
    assert "the particles from 2 to 2 have no velocity (3)" in first(lines)


@pytest.mark.parametrize("keep", range(1, 36))
def test_a_truncated_deck_says_where_it_ends(faults: Faults, deck: Deck, keep: int) -> None:
    lines = faults(read, "".join(deck().splitlines(keepends=True)[:keep]))
    assert f"deck.mcm:{keep + 1}:1: error: the file ends here" in lines[-1]


def test_files_that_are_no_decks(faults: Faults, tmp_path: Path) -> None:
    assert faults(read, b"") == ["deck.mcm:1:1: error: the file is empty; expected a mesh or a deck"]
    assert "binary file" in first(faults(read, b"\x00\x01\x02" * 99))
    assert "deck.mcm:1:" in first(faults(read, "some words\n" * 9))
    with pytest.raises(InputError, match="no such file"):
        read(tmp_path / "none.mcm")
    with pytest.raises(InputError, match="error"):
        read(tmp_path)


def test_a_material_without_particles_is_a_fault_alone(faults: Faults, model, deck: Deck) -> None:
    text = deck(("0.0      2\n       4", "0.0      1\n       4"), ("0.1D+00      2", "0.1D+00      1"))
    assert "deck.mcm:20:1: error: material 2 owns no particle" in first(faults(read, text))
    assert model(text, paired=True).materials[2].law == "von_mises"


def test_velocity_cards_of_a_coupled_deck_run_on(model, faults: Faults, deck: Deck) -> None:
    text = deck(end="       5       0.0       0.0       0.0\n      12       0.0       0.0       0.0\n")
    lines = faults(read, text)
    assert len(lines) == 2
    assert "deck.mcm:37:8: error: velocity card past the last particle 4 (5)" in lines[0]
    m = model(text, paired=True)
    assert (m.velocity_overrun, len(m.particles.velocity)) == (8, 4)


def test_an_acceleration_is_no_velocity_card(model, deck) -> None:
    text = deck(("    0    2    0    0    0    0    0    0", "    0    2    0    0    0    1    0    0"))
    m = model(text + f"{100000000000.0:20}{0.0:20}{0.0:20}\n")  # its first eight columns are a 10
    assert m.particle_control.base_acceleration == (1e11, 0.0, 0.0)
    assert m.velocity_overrun == 0


def test_cards_left_over_are_said(model, deck) -> None:
    assert "37: 1 cards left over" in model(deck(end="   -1    1\n")).warnings[0]


@pytest.mark.parametrize(("name", "count"), [("block20k", 20000), ("kupa1f", 802), ("newhop3f", 4295)])
def test_reference_decks(shared: Path, name: str, count: int) -> None:
    m = read(shared / "reference/mcm" / f"{name}.mcm")
    stored = np.load(shared / "reference/mcm" / f"{name}.npz")
    assert len(m.particles) == count
    assert np.array_equal(m.particles.material, stored["mat"])
    assert m.warnings == []


def test_reference_decks_of_other_laws(shared: Path) -> None:
    deck = read(shared / "reference/mcm/cap3d.mcm")
    cap = deck.materials[1]
    assert [w.partition(": ")[2] for w in deck.warnings] == [
        "the tension cut-off 0.01 is a pressure (compression is positive): a run here takes 0"
    ]
    assert (cap.law, cap.parameters["K"], cap.parameters["R"], cap.parameters["tension_cutoff"]) == (
        "cap", 30.62, 2.0, 0.01,
    )  # fmt: skip
    water = read(shared / "reference/mcm/water2d.mcm")
    assert (water.materials[1].law, water.equations_of_state[1].law) == ("fluid", "murnaghan")


def test_the_dissertations_deck(shared: Path) -> None:
    m = read(shared / "samples/mcm/kipkupa.mcm", paired=True)
    cap, steel = m.materials.values()
    expected = {
        "K": 88.62,
        "G": 29.23,
        "alpha": 0.02138,
        "theta": 0.292,
        "W": 0.0313,
        "D": 0.752,
        "R": 3.0,
        "ftype": 1.0,
    }
    assert {name: value for name, value in cap.parameters.items() if value} == expected
    assert (steel.law, steel.native) == ("von_mises", {"card 1 value 5": 2.5})
    assert (m.particle_control.dialect, m.particle_control.friction) == ("2019-08", (0.1, 0.1))
    assert m.particle_control.base_acceleration == (0.0, 0.0, -0.0981)
    assert sum("kept as it is" in warning for warning in m.warnings) == 2


def test_the_generators_wrong_velocities(shared: Path) -> None:
    with pytest.raises(InputError, match=r"kupa1.mcm:869:5: error: velocity card past the last particle 802 \(2700\)"):
        read(shared / "samples/mcm/kupa1.mcm")
    assert read(shared / "samples/mcm/kupa1.mcm", paired=True).velocity_overrun == 5400 - 802


def test_the_coupled_deck(shared: Path) -> None:
    assert read(shared / "reference/coupled/cplate.mcm", paired=True).velocity_overrun == 121
    with pytest.raises(InputError) as caught:
        read(shared / "reference/coupled/cplate.mcm")
    assert [fault.line for fault in caught.value.faults] == [27, 165, 166]


def test_energies_past_column_80_are_not_read(model, deck) -> None:
    extra = "".join(f"{i:8d}{0.5:20}{0.1:20}{2.5:20}{0.25:20}\n" for i in range(1, 5))
    text = deck(("    1    1    0    0    0", "    1    0    0    0    1"))
    m = model(text[: text.index("       1      0.01")] + extra)
    assert m.particles.e.tolist() == [0.0] * 4
    assert ":33: text past column 80" in m.warnings[0]
