"""Each numeric field of a deck in turn replaced by letters: one fault, at its line and column, whatever it decides."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from zrno.translators.mcm import cards, read
from zrno.translators.text import Field, InputError, Layout

CONTACT = """\
{title:78} 2
    3    0         2         4         4
       1.0       0.8       0.0       0.0
       0.1    4      0.01         2    1       100    0    0
    1    1    1    1    1
    1    2    0    1    0    1    0    1
    0    1   60
    0    1    0
       0.5       0.2
    1    1       2.7    0    0       0.0    0       2.0       0.5
       0.0       0.0
elastic
       0.7
      0.33




    2    3       2.7    0    0       0.0    0       0.0       0.0
       5.4      0.12
plastic
       0.7
      0.33
     0.003
      0.01
       0.5
       1.0      0.25
       1    0                 0.0                 0.0                 0.0      1
       2    0                 0.1                 0.0                 0.0      1
       3    7                 0.2                 0.0                 0.0      2
       4    0                 0.3                 0.0                 0.1      2
       1                 1.0                0.12                 2.7         0.0
       2                 1.0                0.12                 2.7         0.0
       3                 1.0                0.12                 2.7         0.0
       4                 1.0                0.12                 2.7         0.0
       1       4
       0.1       0.2       0.3    2
       1      0.01       0.0       0.0
       2      0.01       0.0       0.0
       3       0.0       0.0       0.0
       4       0.0       0.0       0.0
         1         0         2         2         0         3
      -1.0       0.0      -2.0       2.0       0.0       9.0
   -1    1
     200.0       4.0
     200.0       4.0
                 1.0                 0.0                -9.8
""".format(title="every section")

VERSION_1 = """\
{title:78} 1
    2    5         1         2         0         0
       3.0       0.7       0.1
       0.5      0.05         1    1    4
         1    1    0
    0    1    1    0    2    1
    1    1       2.0    0    0       0.0    0
       1.0       0.1
mat
       1.0
       0.2




       1    0                 0.0                 1.0      1
       2    0                 1.0                 1.0      1
       1                 0.5                 0.1
       2                 0.5                 0.1
       1
       0.1       0.2    1
       1       0.5       0.0
       2       0.5       0.0
      -1.0       2.0      -3.0       4.0
    0    1    0    1
""".format(title="an old deck")

PROPERTIES = [cards.PROPERTIES] * cards.PROPERTY_CARDS
MATERIAL = [cards.MATERIAL, cards.MATERIAL_PARTICLES, cards.MATERIAL_TITLE, *PROPERTIES]
DECKS: dict[str, tuple[str, list[Layout]]] = {
    "version 2": (
        CONTACT,
        [
            cards.TITLE, *cards.CONTROL, cards.CARD_7_OPTIONS, cards.FRICTION, *MATERIAL, *MATERIAL,
            *[cards.particle(3)] * 4, *[cards.EXTRA] * 4, cards.HISTORY, cards.transducer(3), *[cards.VELOCITY] * 4,
            cards.PLANE_FLAGS, cards.PLANE_POSITIONS, cards.CONTACT, *[cards.CONTACT_LAW] * 2, cards.BASE_ACCELERATION,
        ],
    ),
    "version 1": (
        VERSION_1,
        [
            cards.TITLE, *cards.CONTROL_VERSION_1, *MATERIAL, *[cards.particle(2)] * 2, *[cards.EXTRA] * 2,
            cards.HISTORY, cards.transducer(2), *[cards.VELOCITY] * 2, cards.PLANE_POSITIONS,
            cards.PLANE_CODES_VERSION_1,
        ],
    ),
}  # fmt: skip
CASES = [pytest.param(name, line, id=f"{name}:{line + 1}") for name in DECKS for line in range(len(DECKS[name][1]))]


def replaced(name: str, line: int, word: str) -> Iterator[tuple[str, Field, str]]:
    """The deck with a word in each numeric field of a line in turn; the field, and as much of the word as it holds."""
    text, layouts = DECKS[name]
    for where in layouts[line].fields.values():
        if where.kind != "a":
            lines = text.splitlines()
            card, width = lines[line].ljust(where.end), where.end - where.start
            lines[line] = card[: where.start] + word[:width].rjust(width) + card[where.end :]
            yield "\n".join(lines) + "\n", where, word[:width]


@pytest.mark.parametrize("name", DECKS)
def test_the_decks_are_sound_as_they_are(tmp_path: Path, name: str) -> None:
    text, layouts = DECKS[name]
    assert len(layouts) == text.count("\n")
    (tmp_path / "deck.mcm").write_text(text)
    assert read(tmp_path / "deck.mcm").particles is not None


@pytest.mark.parametrize(("name", "line"), CASES)
def test_letters_in_a_number_are_one_fault_at_their_place(
    faults: Callable[..., list[str]], name: str, line: int
) -> None:
    for word in ("x", "oops"):
        for text, field, cut in replaced(name, line, word):
            said = faults(read, text)
            assert len(said) == 1, (field.name, said)
            assert said[0].startswith(f"deck.mcm:{line + 1}:{field.end - len(cut) + 1}: error: "), (field.name, said)
            assert f"({cut})" in said[0], (field.name, said)


@pytest.mark.parametrize(("name", "line"), CASES)
def test_any_number_is_read_or_a_fault(tmp_path: Path, name: str, line: int) -> None:
    for number in ("-9", "77", "9" * 9):
        for text, _, _ in replaced(name, line, number):
            (tmp_path / "deck.mcm").write_text(text)
            with contextlib.suppress(InputError):
                read(tmp_path / "deck.mcm")
