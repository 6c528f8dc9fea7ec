"""What a particle deck asks and the solver does not do: each refusal stands where the deck, or an option, asks."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from zrno.pipelines import options
from zrno.pipelines.build import particle_problem, refusals
from zrno.pipelines.method import Contact, Sph, Wall, of_options
from zrno.pipelines.sections import Friction
from zrno.solvers.contact import plane
from zrno.solvers.contact.friction import Coulomb
from zrno.solvers.materials import drucker_prager_soil
from zrno.solvers.sph import Cures, Plane
from zrno.solvers.sph.ghosts import LIMIT, SYMMETRY
from zrno.translators import InputError, Model, read

DECK = """\
{title:78} 2
$ a comment
    2    0         1         2         0
       1.0       0.8       0.0       0.0
       0.1    4      0.01         0    0         0    0    0
    1    1    0    0    0
    0    2    0    0    0    0    0    0
    0    1   60

    1    3       2.7    0    0       0.0    0       2.0       0.5
       5.4      0.12
steel
       0.7
      0.33
     0.003
      0.01
       0.5
       0.0
       1    0                 0.0                 0.0      1
       2    0                 0.1                 0.0      1
       1      0.01       0.0       0.0
       2      0.01       0.0       0.0
""".format(title="two particles")
MATERIAL_2 = DECK[DECK.index("    1    3       2.7") : DECK.index("       1    0  ")].replace(
    "    1    3", "    2    3", 1
)
FLOOR = Wall(position=(0.0, -1.0, 0.0), normal=(0.0, 1.0, 0.0), friction=Friction(static=0.4, kinetic=0.3))
BIRTH = f"{1:10d}{1:10d}\n"


def _plane(x: float, orientation: int) -> str:
    return f"{x:20}{0.0:20}{0.0:20}{orientation:5d}\n"


CAP = (
    "       0.7\n      0.33\n     0.003\n      0.01\n       0.5\n       0.0\n",
    "       0.7       4.0\n       0.3       0.5\n     0.003       0.1\n"
    "       0.1       0.0\n       0.0      0.01\n       0.0       1.0\n",
)
PLANES = f"{1:10d}{0:10d}{0:10d}{0:10d}{0:10d}{0:10d}\n" + f"{0.0:10}" * 6 + "\n"


TWO = (
    DECK.replace("    2    0         1         2", "    2    0         2         2")
    .replace("   60\n\n", "   60\n       0.3       0.2\n")
    .replace("    0    2    0    0    0    0    0    0", "    1    2    0    0    0    0    0    0")
    .replace("       1    0  ", MATERIAL_2 + "       1    0  ")
    .replace("0.1                 0.0      1", "0.1                 0.0      2")
    + "   -1    0\n      10.0       2.0\n      10.0       2.0\n"
)


def _read(folder: Path, *changes: tuple[str, str]) -> Model:
    text = DECK
    for old, new in changes:
        assert text.count(old) == 1 or not old, old
        text = text.replace(old, new) if old else text + new
    (folder / "deck.mcm").write_text(text)
    return read(folder / "deck.mcm")


def test_the_deck_is_computed_as_it_is(tmp_path: Path) -> None:
    problem = particle_problem(_read(tmp_path), "deck.mcm")
    assert (problem.dimension, len(problem.x)) == (2, 2)


@pytest.mark.parametrize(
    ("changes", "place", "what", "said"),
    [
        ([("    1    3       2.7    0", "    1    9       2.7   28"),
          ("       0.5\n       0.0", "       0.5\n       0.0\nwater\n      1e-3       7.0       0.0       0.5")],
         "10:1", "material 1: an initial relative volume V0 of 0.5", "expected a deck without it"),
    ],
)  # fmt: skip
def test_what_is_not_computed_stands_where_the_deck_asks(
    tmp_path: Path, changes: list[tuple[str, str]], place: str, what: str, said: str
) -> None:
    model = _read(tmp_path, *changes)
    wrong, (fault,) = refusals(model, "deck.mcm")
    assert wrong == []
    assert str(fault).startswith(f"deck.mcm:{place}: error: {what} is not computed yet"), fault
    assert said in str(fault)
    with pytest.raises(InputError, match="is not computed yet"):
        particle_problem(model, "deck.mcm")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("      0.33", "      0.55"), "Poisson's ratio 0.55 must lie between -1 and 0.5"),
        (("     0.003", "       0.0"), "yield stress 0.0 must be positive"),
        (("       0.5\n       0.0", "       1.5\n       0.0"), "hardening parameter beta 1.5 must lie between"),
    ],
)
def test_constants_that_no_law_can_have_are_wrong(tmp_path: Path, change: tuple[str, str], said: str) -> None:
    (fault,), missing = refusals(_read(tmp_path, change), "deck.mcm")
    assert missing == []
    assert str(fault).startswith(f"deck.mcm:10:1: error: material 1: {said}"), fault


def test_what_the_control_cards_ask_for_reaches_the_solver(tmp_path: Path) -> None:
    model = _read(
        tmp_path,
        ("    2    0         1", "    2    1         1"),
        ("0.8       0.0       0.0", "0.8       0.0       0.5"),
        ("    0    2    0    0", "    0    2    1    1"),
        ("    0    1   60", "    2    1   60"),
        ("", PLANES),
    )
    problem = particle_problem(model, "deck.mcm")
    assert problem.cures == Cures(correction=True, xsph=0.1)
    assert (problem.relaxation, problem.h_option) == (0.5, 2)
    assert problem.planes == (Plane(0, -1, SYMMETRY, 0.0),)
    options.apply({"xsph": False, "h_option": 1}, model)
    problem = particle_problem(model, "deck.mcm")
    assert (problem.cures.xsph, problem.h_option) == (0.0, 1)


def test_the_method_beyond_the_deck_is_by_material_or_as_it_is_said(tmp_path: Path) -> None:
    model = _read(tmp_path)
    assert particle_problem(model, "deck.mcm").cures == Cures(correction=True)
    assert particle_problem(model, "deck.mcm", method=Sph(cures="none")).cures == Cures()
    asked = Sph(artificial_stress=0.3, correction=False)
    assert particle_problem(model, "deck.mcm", method=asked).cures == Cures(artificial_stress=0.3)
    assert particle_problem(model, "deck.mcm", method=asked, original=True).cures == Cures()
    grain = _read(tmp_path, ("    1    3       2.7", "    1    4       2.7"), CAP)
    assert not particle_problem(grain, "deck.mcm").cures.correction
    assert particle_problem(grain, "deck.mcm", method=Sph(correction=True)).cures.correction
    assert particle_problem(grain, "deck.mcm").bodies[0].stress_diffusion == 0.0  # it has cohesion: k above gamma
    grain.materials[1].parameters["gamma"] = grain.materials[1].parameters["alpha"]
    assert particle_problem(grain, "deck.mcm").bodies[0].stress_diffusion == 0.1
    assert particle_problem(grain, "deck.mcm", method=Sph(cures="none")).bodies[0].stress_diffusion == 0.0
    said = of_options({
        "sph.kernel": "wendland_c2", "sph.artificial_stress": 0.1, "sph.stress_diffusion": 0.2,
        "sph.pair_viscosity.alpha": 0.4, "sph.acceleration": [[0, 0, 0, 0], [1, 0, -9.81, 0]],
    })  # fmt: skip
    problem = particle_problem(model, "deck.mcm", method=said)
    assert (problem.kernel, problem.cures.artificial_stress) == ("wendland_c2", 0.1)
    assert (problem.bodies[0].alpha, problem.bodies[0].stress_diffusion) == (0.4, 0.2)
    assert problem.body_curve is not None
    assert problem.body_curve[1][1].tolist() == [0.0, -9.81, 0.0]


def test_the_gradient_correction_is_of_the_solids_that_move(tmp_path: Path) -> None:
    """Grain beside them has none; where nothing that moves is solid, or all that is stays whole, the run has none."""
    model = _read(tmp_path)
    model.materials[2] = dataclasses.replace(model.materials[1], id=2, name="sand", law="elastic")
    assert model.particles is not None
    model.particles.material[1:] = 2
    soil = of_options({"sph.laws": {"sand": {"law": "drucker_prager_soil", "c": 0, "phi": 30}}})
    problem = particle_problem(model, "deck.mcm", method=soil)
    assert [b.corrected for b in problem.bodies] == [True, False]
    assert problem.cures.correction
    whole = soil.model_copy(update={"total_lagrangian": [model.materials[1].name]})
    assert not particle_problem(model, "deck.mcm", method=whole).cures.correction
    everywhere = soil.model_copy(update={"correction": True})
    assert all(b.corrected for b in particle_problem(model, "deck.mcm", method=everywhere).bodies)
    model.particles.bc[:1] = 7
    assert not particle_problem(model, "deck.mcm", method=soil).cures.correction


CONTACT = (("    0    2    0    0", "    1    2    0    0"), ("", "   -1    0\n      10.0       2.0\n"))


def test_the_friction_of_a_deck_needs_bodies_that_repel(tmp_path: Path) -> None:
    card = ("   60\n\n", "   60\n       0.3       0.2\n")
    model = _read(tmp_path, card)
    assert particle_problem(model, "deck.mcm").friction is None
    assert model.warnings[-1].startswith("the friction of card 7 does nothing")
    pinball = particle_problem(model, "deck.mcm", method=Sph(contact=Contact(law="pinball", pinball=2.0)))
    assert (pinball.pinball, pinball.potential, pinball.friction) == (2.0, False, None)  # one body meets nobody
    repelling = particle_problem(_read(tmp_path, card, *CONTACT), "deck.mcm")
    assert repelling.potential
    assert repelling.bodies[0].strength == 10.0


def test_bodies_that_stay_whole_are_named(tmp_path: Path) -> None:
    model = _read(tmp_path)
    assert not particle_problem(model, "deck.mcm").bodies[0].lagrangian
    body = particle_problem(model, "deck.mcm", method=Sph(total_lagrangian=["steel"], hourglass=0.3)).bodies[0]
    assert (body.lagrangian, body.hourglass) == (True, 0.3)
    assert particle_problem(model, "deck.mcm", method=Sph(total_lagrangian=True)).bodies[0].lagrangian
    assert not particle_problem(model, "deck.mcm", method=Sph(total_lagrangian=["brass"])).bodies[0].lagrangian


def test_two_bodies_have_the_friction_that_deck_or_scene_says(tmp_path: Path) -> None:
    (tmp_path / "two.mcm").write_text(TWO)
    model = read(tmp_path / "two.mcm")
    assert particle_problem(model, "two.mcm").friction == Coulomb(0.3, 0.2)
    said = Sph(contact=Contact(law="potential", friction=Friction(static=0.6, kinetic=0.5)), walls=[FLOOR])
    problem = particle_problem(model, "two.mcm", method=said)
    assert problem.friction == Coulomb(0.6, 0.5)
    assert problem.walls == (plane.Wall((0.0, -1.0, 0.0), (0.0, 1.0, 0.0), Coulomb(0.4, 0.3)),)
    kernel = particle_problem(model, "two.mcm", method=Sph(contact=Contact(law="kernel")))
    assert (kernel.potential, kernel.friction) == (False, None)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("sph.kernle", "cubic", r"unknown key sph.kernle"),
        ("sph.kernel", "cubc", r"sph.kernel has a wrong value \(cubc\); expected 'cubic', 'quintic'"),
        ("sph.artificial_stress", 2, "sph.artificial_stress has a wrong value"),
        ("sph.pair_viscosity.gamma", 2, "unknown key sph.pair_viscosity.gamma"),
    ],
)
def test_a_method_that_there_is_not_is_bad_input(key: str, value: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        of_options({key: value})


def test_grain_without_cohesion_remembers_its_gaps_unless_told_otherwise(tmp_path: Path) -> None:
    model = _read(tmp_path)
    name = model.materials[1].name
    model.materials[1].law = "elastic"
    density = model.materials[1].density
    for more, gaps, least in (({}, True, 0.7 * density), ({"gaps": False}, False, 1e-10)):
        soil = {"law": "drucker_prager_soil", "phi": 30, **more}
        body = particle_problem(model, "deck.mcm", method=of_options({f"sph.laws.{name}": soil})).bodies[0]
        assert getattr(body.law, "gaps", None) is gaps
        assert body.least == pytest.approx(least)
        assert body.stress_diffusion == 0.1
    soil = {"law": "drucker_prager_soil", "phi": 30}
    off = of_options({f"sph.laws.{name}": soil, "sph.cures": "none"})
    assert getattr(particle_problem(model, "deck.mcm", method=off).bodies[0].law, "gaps", None) is False


def test_grain_that_may_sink_through_its_floor_is_warned_of(tmp_path: Path) -> None:
    model = _read(tmp_path)
    name = model.materials[1].name
    model.materials[1].law = "elastic"
    assert model.particles is not None
    model.particles.bc[:] = 7
    said = {f"sph.laws.{name}": {"law": "drucker_prager_soil", "phi": 30}, "sph.bearing": [name]}
    particle_problem(model, "deck.mcm", method=of_options({**said, "sph.correction": False}))
    assert not any("sink" in line for line in model.warnings)
    particle_problem(model, "deck.mcm", method=of_options({**said, "sph.correction": True}))
    assert sum("sink" in line for line in model.warnings) == 1


def test_a_soil_takes_the_moduli_of_the_deck_and_a_wall_is_held(tmp_path: Path) -> None:
    model = _read(tmp_path)
    name = model.materials[1].name
    model.materials[1].law = "elastic"
    assert model.particles is not None
    soil = {"law": "drucker_prager_soil", "phi": 30, "c": 2.0, "match": "plane_strain"}
    model.particles.bc[:] = 7
    body = particle_problem(
        model, "deck.mcm", method=of_options({f"sph.laws.{name}": soil, "sph.bearing": [name]})
    ).bodies[0]
    own = model.materials[1].parameters
    assert body.law == drucker_prager_soil(own["E"], own["nu"], 2.0, 30.0, match="plane_strain")
    assert body.bearing
    assert body.stress_diffusion == 0.0  # with cohesion it creeps
    model.particles.bc[0] = 0
    said = of_options({"sph.laws.clay": soil, "sph.bearing": [name, "rock"]})
    with pytest.raises(InputError) as caught:
        particle_problem(model, "deck.mcm", method=said)
    assert sorted(fault.message for fault in caught.value.faults) == [
        "sph.bearing: a wall moves", "sph.bearing: no such material", "sph.laws: no such material",
    ]  # fmt: skip


@pytest.mark.parametrize(("said", "given"), [(True, True), (False, False), ("auto", None)])
def test_local_steps(tmp_path: Path, said: object, given: bool | None) -> None:
    problem = particle_problem(_read(tmp_path), "deck.mcm", method=of_options({"sph.local_steps": said}))
    assert problem.local_steps is given
    assert particle_problem(_read(tmp_path), "deck.mcm").local_steps is None


def test_all_refusals_are_said_and_a_mesh_is_no_deck(tmp_path: Path) -> None:
    model = _read(
        tmp_path, ("   60\n\n", "   60\n    1    0    1\n"), ("      0.33", "      0.55"), ("", BIRTH + _plane(0.05, 3))
    )
    with pytest.raises(InputError) as caught:
        particle_problem(model, "deck.mcm")
    assert [(fault.line, fault.column) for fault in caught.value.faults] == [(9, 5), (10, 1)]
    with pytest.raises(InputError, match=r"plate\.msh:1:1: error: not a particle deck \(msh\)"):
        particle_problem(Model(format="msh"), "plate.msh")


def test_birth_and_death(tmp_path: Path) -> None:
    """Particle 1 comes from x = 0 at 0.01 and is born at 0.05; what is below -1 in y has left."""
    both = BIRTH + _plane(0.05, 1) + f"{0.0:20}{-1.0:20}{0.0:20}{-2:5d}\n"
    problem = particle_problem(_read(tmp_path, ("   60\n\n", "   60\n    3    0    1\n"), ("", both)), "deck.mcm")
    assert problem.birth is not None
    assert problem.birth.tolist() == pytest.approx([5.0, 0.0])
    assert problem.planes == (Plane(1, -1, LIMIT, -1.0),)


@pytest.mark.parametrize(
    ("card", "cards", "said"),
    [
        ("    1    0    1", BIRTH + _plane(0.05, -1), None),  # it is past a plane that is passed towards -x
        ("    1    0    0", BIRTH, None),  # and so without a plane, with a warning
        ("    1    0    1", BIRTH + _plane(-0.05, -1), "never get to the plane of birth"),
        ("    1    0    1", BIRTH + _plane(0.05, 3), "no such orientation of the plane of birth"),
        ("    1    0    1", BIRTH.replace("1\n", "3\n") + _plane(0.05, 1), "no such particles to be born"),
        ("    1    0    1", BIRTH.replace("1\n", "2\n") + _plane(0.5, 1), "all particles are to be born"),
        ("    2    0    0", BIRTH + _plane(0.05, 0), "no such orientation of the plane of death"),
    ],
)
def test_births_that_are_none(tmp_path: Path, card: str, cards: str, said: str | None) -> None:
    model = _read(tmp_path, ("   60\n\n", f"   60\n{card}\n"), ("", cards))
    if said is None:
        assert particle_problem(model, "deck.mcm").birth is None
        assert any("without a plane of birth" in w for w in model.warnings) == (cards == BIRTH)
    else:
        with pytest.raises(InputError, match=said):
            particle_problem(model, "deck.mcm")


def test_sleep(tmp_path: Path) -> None:
    assert particle_problem(_read(tmp_path), "deck.mcm").sleep == 0.0
    assert particle_problem(_read(tmp_path), "deck.mcm", method=of_options({"sph.sleep": 0.01})).sleep == 0.01
