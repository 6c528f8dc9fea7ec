"""The settings of an analysis: what a mesh does not carry. One table of keys, types, defaults and deck fields.

`load` reads a YAML file against the table; `help_settings` prints the table as a commented YAML file.
"""

from __future__ import annotations

import copy
import difflib
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from zrno.translators.text import Faults, read_bytes
from zrno.translators.yaml_marks import Node, compose

Key = tuple[str, ...]


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
    items: tuple[Setting, ...]
    comment: str
    named: bool = False


def _number(least: float = -math.inf, *, above: bool = False, optional: bool = False) -> Callable[[Any], Any]:
    bound = "" if least == -math.inf else f" {'above' if above else 'of at least'} {least:g}"

    def parse(value: Any) -> float | None:
        if value is None and optional:
            return None
        if isinstance(value, str):  # YAML takes 1e-3 for text
            try:
                value = float(value)
            except ValueError:
                value = None
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise ValueError(f"a number{bound}")
        if value < least or (above and value == least):
            raise ValueError(f"a number{bound}")
        return float(value)

    return parse


def _one_of(*choices: Any) -> Callable[[Any], Any]:
    def parse(value: Any) -> Any:
        for choice in choices:
            if value == choice and isinstance(value, bool) == isinstance(choice, bool):
                return choice
        raise ValueError("one of " + ", ".join("null" if c is None else str(c).lower() for c in choices))

    return parse


def _vector(value: Any) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("a list of three numbers")
    parse = _number()
    try:
        x, y, z = (parse(item) for item in value)
    except ValueError:
        raise ValueError("a list of three numbers") from None
    return x, y, z


BOUNDARY_CODES = {"": 0, "x": 1, "y": 2, "z": 3, "xy": 4, "yz": 5, "xz": 6, "xyz": 7}

TABLE: tuple[Setting | Group, ...] = (
    Setting("dimension", _one_of(None, 2, 3), None, "2 plane strain, 3; null: the mesh's", "card 1 axopt"),
    Setting("end_time", _number(0.0), 1.0, "end of the analysis", "card 2 endtime"),
    Setting("step_factor", _number(0.0), 0.8, "factor on the critical time step", "card 2 tssf"),
    Setting("initial_step", _number(0.0), 0.0, "first time step; 0: automatic", "card 2 itss"),
    Setting(
        "output_interval",
        _number(0.0, optional=True),
        None,
        "time between frames; null: end_time / 20",
        "card 3 stpltime",
    ),
    Setting(
        "history_interval",
        _number(0.0, optional=True),
        None,
        "of the histories; null: end_time / 200",
        "card 3 thpltime",
    ),
    Setting("kernel", _one_of("cubic_spline"), "cubic_spline", "smoothing kernel, support 2h", "card 6 kernel"),
    Setting(
        "step_option",
        _one_of(0, 1, 2),
        1,
        "critical step: 0 DYNA's, 1 h/(c+v), 2 nearest distance/(c+v)",
        "card 5 tcrit",
    ),
    Setting("h_option", _one_of(0, 1, 2), 0, "smoothing length: 0 constant, 1 by div v, 2 by density", "card 6 h_opt"),
    Setting("h_factor", _number(0.0, above=True), 1.2, "smoothing length in spacings", "material card h"),
    Setting("xsph", _one_of(False, True), False, "particles move with a smoothed velocity", "card 5 veloc_opt"),
    Setting("gravity", _vector, [0.0, 0.0, 0.0], "base acceleration x, y, z", "base acceleration card"),
    Setting(
        "contact",
        _one_of("kernel", "potential"),
        "kernel",
        "between bodies: kernel, or potential (repulsive force)",
        "card 5 contact",
    ),
    Group(
        "contact_laws",
        (
            Setting("strength", _number(0.0), 0.0, "K, pressure / density^2", "contact card K"),
            Setting("exponent", _number(0.0), 4.0, "n", "contact card n"),
        ),
        "of contact: potential, by part",
        named=True,
    ),
    Group(
        "viscosity",
        (
            Setting(
                "quadratic", _number(0.0, optional=True), None, "Q; null or 0: the deck's 1.5", "material card av_q"
            ),
            Setting("linear", _number(0.0, optional=True), None, "L; null or 0: the deck's 0.06", "material card av_l"),
        ),
        "artificial viscosity",
    ),
    Group(
        "friction",
        (
            Setting("static", _number(0.0, optional=True), None, "null: no friction", "friction card"),
            Setting("kinetic", _number(0.0, optional=True), None, "at most static", "friction card"),
        ),
        "between bodies",
    ),
    Group(
        "materials",
        (
            Setting("law", _one_of("elastic", "von_mises"), "elastic", "elastic or von_mises", "material card model"),
            Setting("density", _number(0.0, above=True), 1.0, "", "material card density"),
            Setting("E", _number(0.0, above=True), 1.0, "Young's modulus", "property card 1"),
            Setting("nu", _number(-1.0, above=True), 0.3, "Poisson's ratio, below 0.5", "property card 2"),
            Setting("yield_stress", _number(0.0), 0.0, "von_mises", "property card 3"),
            Setting(
                "tangent_modulus",
                _number(0.0),
                0.0,
                "von_mises: slope of the curve beyond yield, below E",
                "property card 4",
            ),
            Setting("beta", _number(0.0), 1.0, "von_mises: hardening, 0 kinematic to 1 isotropic", "property card 5"),
            Setting(
                "failure_strain",
                _number(0.0, optional=True),
                None,
                "von_mises: plastic strain at failure; null: none",
                "property card 6",
            ),
            Setting("velocity", _vector, [0.0, 0.0, 0.0], "initial velocity", "velocity cards"),
            Setting(
                "bc",
                _one_of(*BOUNDARY_CODES),
                "",
                "directions in which it is held: x y z xy yz xz xyz",
                "particle cards",
            ),
        ),
        "by part: its name in the mesh, or its number",
        named=True,
    ),
)


@dataclass(slots=True)
class Settings:
    """Settings after defaults. values: by key, groups as dicts; given: the keys that were set, with their places."""

    path: str
    values: dict[str, Any]
    given: dict[Key, tuple[int, int]] = field(default_factory=dict)

    def __getitem__(self, key: str) -> Any:
        return self.values[key]

    def faults(self) -> Faults:
        """A collector of faults of this file."""
        return Faults(self.path)

    def place(self, *key: str) -> tuple[int, int]:
        """Line and column of a key, or of the nearest above it."""
        while key and key not in self.given:
            key = key[:-1]
        return self.given.get(key, (1, 1))


def load(path: Path | str | None = None, *, overrides: Mapping[str, Any] | None = None) -> Settings:
    """Read settings; without a file, the defaults.

    overrides: values by dotted key ("materials.plate.E"), stronger than the file's. Raises InputError with every fault.
    """
    settings = Settings("settings" if path is None else str(path), defaults())
    faults = settings.faults()
    if path is not None:
        tree = compose(read_bytes(path), faults)
        if tree is not None:
            _take(TABLE, tree, (), settings.values, settings, faults)
    for dotted, value in (overrides or {}).items():
        nested: Any = value
        for word in reversed(dotted.split(".")):
            nested = Node({word: (Node(nested) if not isinstance(nested, Node) else nested, (1, 1))})
        _take(TABLE, nested, (), settings.values, settings, faults)
    _check(settings, faults)
    faults.stop()
    return settings


def defaults() -> dict[str, Any]:
    """Every key's default; groups by name are empty."""
    return {
        item.key: item.parse(copy.copy(item.default))
        if isinstance(item, Setting)
        else ({} if item.named else _defaults_of(item))
        for item in TABLE
    }


def _defaults_of(group: Group) -> dict[str, Any]:
    return {item.key: item.parse(copy.copy(item.default)) for item in group.items}


def help_settings() -> str:
    """All settings as a YAML file: each with its default, what it is and the deck's field."""
    lines = ["# Settings of `zrno convert --settings FILE.yaml`, with their defaults. Units are the mesh's."]

    def line(item: Setting, indent: str) -> str:
        comment = ", ".join(filter(None, [item.comment, f"[{item.deck}]" if item.deck else ""]))
        return f"{indent + item.key + ': ' + _yaml(item.default):<44}# {comment}"

    for item in TABLE:
        if isinstance(item, Setting):
            lines.append(line(item, ""))
            continue
        lines.append(f"{item.key + ':':<44}# {item.comment}")
        indent = "    " if item.named else "  "
        if item.named:
            lines.append("  NAME:")
        lines += [line(below, indent) for below in item.items]
    return "\n".join(lines) + "\n"


def _yaml(value: Any) -> str:
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return '""' if value == "" else str(value)


def _take(
    table: tuple[Setting | Group, ...],
    node: Node,
    above: Key,
    values: dict[str, Any],
    settings: Settings,
    faults: Faults,
) -> None:
    """Values of a mapping into `values`, against the table."""
    if not isinstance(node.value, dict):
        faults.add_at(node.place, f"{'.'.join(above) or 'the file'} is not a mapping", str(node.value), "key: value")
        return
    known = {item.key: item for item in table}
    for key, (below, place) in node.value.items():
        path = (*above, key)
        item = known.get(key)
        if item is None:
            near = difflib.get_close_matches(key, known, 1)
            expected = f"{near[0]}?" if near else "one of " + ", ".join(known)
            faults.add_at(place, f"unknown key {'.'.join(path)}", key, expected)
            continue
        settings.given[path] = place
        if isinstance(item, Setting):
            try:
                values[key] = item.parse(below.value)
            except ValueError as error:
                said = "null" if below.value is None else str(below.value)
                faults.add_at(below.place, f"{'.'.join(path)} is not what it should be", said, str(error))
        elif not item.named:
            _take(item.items, below, path, values[key], settings, faults)
        elif not isinstance(below.value, dict):
            faults.add_at(
                below.place, f"{key} is not a mapping", str(below.value), "the name of a part, and its values below"
            )
        else:
            for name, (entry, at) in below.value.items():
                settings.given[(*path, name)] = at
                own = values[key].setdefault(name, _defaults_of(item))
                _take(item.items, entry, (*path, name), own, settings, faults)


def _check(settings: Settings, faults: Faults) -> None:
    """What single keys cannot show."""

    def wrong(key: Key, message: str, said: object, expected: str) -> None:
        faults.add_at(settings.place(*key), message, str(said), expected)

    friction = settings["friction"]
    static, kinetic = friction["static"], friction["kinetic"]
    if (static is None) != (kinetic is None):
        missing = "static" if static is None else "kinetic"
        wrong(("friction",), f"friction.{missing} is missing", "null", "static and kinetic")
    elif static is not None and kinetic > static:
        wrong(("friction", "kinetic"), "friction.kinetic is above friction.static", kinetic, f"at most {static:g}")
    for name, material in settings["materials"].items():
        at = ("materials", name)
        for key in ("density", "E", "nu"):
            if (*at, key) not in settings.given:
                wrong(at, f"materials.{name}.{key} is missing", name, f"a value of {key}")
        if material["nu"] >= 0.5:
            wrong((*at, "nu"), f"materials.{name}.nu is too large", material["nu"], "less than 0.5")
        if material["beta"] > 1:
            wrong((*at, "beta"), f"materials.{name}.beta is too large", material["beta"], "0 to 1")
        if material["law"] == "von_mises":
            if material["yield_stress"] <= 0:
                wrong(
                    (*at, "yield_stress"),
                    f"materials.{name}.yield_stress is not positive",
                    material["yield_stress"],
                    "a stress",
                )
            slope = material["tangent_modulus"]
            if slope >= material["E"]:
                wrong((*at, "tangent_modulus"), f"materials.{name}.tangent_modulus is too large", slope, "less than E")
