"""Numbers, titles and blocks as a FEMAP neutral file has them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from zrno.translators.model import Ints
from zrno.translators.report import Report

_LONGEST_TITLE = 79
_POINTLESS = re.compile(r"(?<![.\d])(\d+)e")  # 1e-05: the format's reals have a point
CHUNK = 20_000  # records formatted at a time


def real(value: float) -> str:
    """The shortest text that reads back as the same double, with a point."""
    return pointed(repr(float(value)))


def pointed(text: str) -> str:
    """A text of numbers, in which those without a point get one."""
    return _POINTLESS.sub(r"\1.e", text) if "e" in text else text


def line(values: Iterable[object]) -> str:
    """Numbers, each with a comma behind it."""
    return "".join(f"{real(v) if isinstance(v, float) else v}," for v in values) + "\n"


def rows(values: list[float] | list[int], width: int) -> Iterator[str]:
    """Numbers, `width` a line."""
    for first in range(0, len(values), width):
        yield line(values[first : first + width])


def title(text: str, report: Report) -> str:
    """A title's line."""
    plain = "".join(letter if letter.isprintable() else " " for letter in text).strip()
    plain = plain.encode("latin-1", "replace").decode("latin-1")[:_LONGEST_TITLE].strip()
    if plain == "-1" or plain[:4].upper() == "$COM":  # else it would end a block, or be a comment
        plain = f"_{plain}"
    if plain != text.strip():
        report.approximate("titles", 1, f"one line of at most {_LONGEST_TITLE} characters of Latin-1")
    return (plain or "<NULL>") + "\n"


def block(number: int, body: Iterable[str]) -> Iterator[bytes]:
    """A block; nothing where it has no records."""
    head = f"   -1\n   {number}\n"
    for piece in body:
        yield (head + piece).encode("latin-1")
        head = ""
    if not head:
        yield b"   -1\n"


def formatted(row: str, values: Ints) -> Iterator[str]:
    """Rows of whole numbers as lines."""
    for first in range(0, len(values), CHUNK):
        some = values[first : first + CHUNK]
        yield (row * len(some)) % tuple(some.ravel().tolist())


def set_numbers(given: list[int]) -> list[int]:
    """Numbers from 1 that differ: the given ones where they can be had."""
    taken: set[int] = set()
    found = []
    top = max(given, default=0)
    for number in given:
        if number < 1 or number in taken:
            top = max(top, 0) + 1
            number = top
        taken.add(number)
        found.append(number)
    return found
