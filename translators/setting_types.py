"""What a key of the settings can be: its parsers, each from a YAML value to a value or ValueError(what is expected)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from zrno.translators.formula import Formula, formula, region
from zrno.translators.laws import LAWS, Law


@dataclass(frozen=True, slots=True)
class Setting:
    """A key. parse: value -> value or ValueError(what is expected); default: as YAML shows it; deck: its field."""

    key: str
    parse: Callable[[Any], Any]
    default: Any
    comment: str
    deck: str = ""


@dataclass(frozen=True, slots=True)
class Group:
    """A key with keys below it. named: the keys right below are names of the user's (parts), each with these keys."""

    key: str
    items: tuple[Setting | Group, ...]
    comment: str
    named: bool = False


def number(least: float = -math.inf, *, above: bool = False, optional: bool = False) -> Callable[[Any], Any]:
    bound = "" if least == -math.inf else f" {'above' if above else 'of at least'} {least:g}"

    def parse(value: Any) -> float | None:
        if value is None and optional:
            return None
        if isinstance(value, str):  # YAML takes 1e-3 for text
            try:
                value = float(value)
            except ValueError:
                value = None
        try:
            number = math.nan if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
        except OverflowError:  # an integer of more than 308 digits
            number = math.inf
        if not math.isfinite(number) or number < least or (above and number == least):
            raise ValueError(f"a number{bound}")
        return number

    return parse


def one_of(*choices: Any) -> Callable[[Any], Any]:
    def parse(value: Any) -> Any:
        for choice in choices:
            if value == choice and isinstance(value, bool) == isinstance(choice, bool):
                return choice
        raise ValueError("one of " + ", ".join("null" if c is None else str(c).lower() for c in choices))

    return parse


def vector(value: Any) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("a list of three numbers")
    parse = number()
    try:
        x, y, z = (parse(item) for item in value)
    except ValueError:
        raise ValueError("a list of three numbers") from None
    return x, y, z


def field(value: Any) -> tuple[float | Formula, ...]:
    """A vector whose components may be formulas of the place."""
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("a list of three numbers or formulas")
    parse = number()
    found: list[float | Formula] = []
    for item in value:
        try:
            found.append(parse(item))
        except ValueError:
            if not isinstance(item, str):
                raise ValueError("a list of three numbers or formulas") from None
            found.append(formula(item))
    return tuple(found)


def scalar(value: Any) -> float | Formula | None:
    """A number or a formula of the place, or null."""
    if value is None:
        return None
    if isinstance(value, str):
        return formula(value)
    parsed: float = number()(value)
    return parsed


def place(value: Any) -> Formula | None:
    """A region, by a formula."""
    if value is None:
        return None
    return region(value if isinstance(value, str) else "")


def some_vector(value: Any) -> tuple[float | None, ...] | None:
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("a list of three numbers, null where free")
    parse = number(optional=True)
    try:
        return tuple(parse(item) for item in value)
    except ValueError:
        raise ValueError("a list of three numbers, null where free") from None


def plane(value: Any) -> tuple[int, float] | None:
    """A boundary plane: its code in the deck and its place."""
    if value is None:
        return None
    try:
        kind, at = value
        return PLANES[kind], number()(at)
    except (ValueError, TypeError, KeyError):
        raise ValueError("[symmetry, periodic or limit, the coordinate], or null") from None


def numbers(*what: str, whole: tuple[int, ...] = ()) -> Callable[[Any], Any]:
    """A list of numbers by their names; whole: places of those that are whole numbers."""
    expected = f"[{', '.join(what)}]"

    def parse(value: Any) -> tuple[float, ...] | None:
        if value is None:
            return None
        if not isinstance(value, list) or len(value) != len(what):
            raise ValueError(expected)
        try:
            found = [number()(item) for item in value]
        except ValueError:
            raise ValueError(expected) from None
        if any(not found[k].is_integer() for k in whole):
            raise ValueError(f"{expected}, whole: {', '.join(what[k] for k in whole)}")
        return tuple(int(x) if k in whole else x for k, x in enumerate(found))

    return parse


def rows(parse: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """A list of values, each as `parse` wants it."""

    def parse_rows(value: Any) -> list[Any]:
        if not isinstance(value, list):
            raise ValueError("a list")
        return [parse(item) for item in value]

    return parse_rows


def pairs(value: Any) -> list[tuple[float, float]] | None:
    if value is None:
        return None
    parse = number()
    try:
        points = [(parse(x), parse(y)) for x, y in value]
    except (ValueError, TypeError):
        raise ValueError("a list of pairs of numbers") from None
    if not points or any(b[0] < a[0] for a, b in itertools.pairwise(points)):
        raise ValueError("pairs of numbers, the first ones increasing")
    return points


def dofs(value: Any) -> tuple[int, ...]:
    words = ["x", "y", "z", "rx", "ry", "rz"] if value == "all" else str(value).split()
    if any(word not in DOFS for word in words):
        raise ValueError("all, or words of " + " ".join(DOFS))
    return tuple(sorted({DOFS[word] for word in words}))


def word(value: Any) -> str | None:
    if value is None or isinstance(value, str):
        return value
    raise ValueError("a name")


def count(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 < value < 1 << 31:
        raise ValueError("a whole number of at least 1")
    return value


def maybe(parse: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """null, or what `parse` takes."""
    return lambda value: None if value is None else parse(value)


def law_parameters(table: Mapping[str, Law] = LAWS) -> dict[str, tuple[Callable[[Any], Any], list[str]]]:
    """Parameters of all laws, or equations of state: how each is parsed, and the laws that have it."""
    laws: dict[str, list[str]] = {}
    for law, row in table.items():
        for name in row.parameters:
            laws.setdefault(name, []).append(law)
    return {name: (number(**_BOUNDS.get(name, {}), optional=True), users) for name, users in laws.items()}


_BOUNDS: dict[str, dict[str, Any]] = {
    "nu": {"least": -1.0, "above": True},
    **{key: {"least": 0.0, "above": True} for key in ("E", "K", "G")},
    **{key: {"least": 0.0} for key in ("yield_stress", "tangent_modulus", "beta", "failure_strain")},
}
PLANES = {"symmetry": 1, "periodic": 2, "limit": 3}
DOFS = {"x": 1, "y": 2, "z": 3, "rx": 4, "ry": 5, "rz": 6}
BOUNDARY_CODES = {"": 0, "x": 1, "y": 2, "z": 3, "xy": 4, "yz": 5, "xz": 6, "xyz": 7}
