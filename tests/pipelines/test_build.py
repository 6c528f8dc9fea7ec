"""What a particle deck asks and the solver does not do: each refusal stands where the deck, or an option, asks."""

from __future__ import annotations

from pathlib import Path

import pytest

from zrno.pipelines import options
from zrno.pipelines.build import particle_problem, refusals
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
PLANES = f"{1:10d}{0:10d}{0:10d}{0:10d}{0:10d}{0:10d}\n" + f"{0.0:10}" * 6 + "\n"


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
        ([("    2    0         1", "    2    1         1")], "3:10", "the corrected discretisation", "disctype 1"),
        ([("0.8       0.0       0.0", "0.8       0.0       0.5")], "4:38", "dynamic relaxation", "drelax 0.5"),
        ([("    0    2    0    0", "    0    2    1    0")], "7:15", "XSPH", "veloc_opt 1"),
        ([("    0    2    0    0", "    0    2    0    1"), ("", PLANES)], "7:20", "boundary planes", "symmetry 1"),
        ([("    0    1   60", "    2    1   60")], "8:5", "a smoothing length that changes", "h_opt 2"),
        ([("   60\n\n", "   60\n       0.3       0.2\n")], "9:8", "contact friction", "friction (0.3, 0.2)"),
        ([("   60\n\n", "   60\n    0    1    0\n       0.3       0.2\n")], "9:10", "contact friction", "friction ("),
        ([("   60\n\n", "   60\n    0    2    0\n       0.4\n")], "9:10", "fluid friction", "friction 0.4"),
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


def test_an_option_that_asks_is_the_place(tmp_path: Path) -> None:
    model = _read(tmp_path, ("    0    1   60", "    2    1   60"))
    places = options.apply({"xsph": True, "h_option": 1}, model)
    _, missing = refusals(model, "deck.mcm", places)
    assert [str(fault).partition(" is not")[0] for fault in missing] == [
        "--set:1:10: error: a smoothing length that changes",
        "--set:1:6: error: XSPH",
    ]


def test_all_refusals_are_said_and_a_mesh_is_no_deck(tmp_path: Path) -> None:
    model = _read(tmp_path, ("    0    2    0    0", "    0    2    1    0"), ("      0.33", "      0.55"))
    with pytest.raises(InputError) as caught:
        particle_problem(model, "deck.mcm")
    assert [(fault.line, fault.column) for fault in caught.value.faults] == [(7, 15), (10, 1)]
    with pytest.raises(InputError, match=r"plate\.msh:1:1: error: not a particle deck \(msh\)"):
        particle_problem(Model(format="msh"), "plate.msh")
