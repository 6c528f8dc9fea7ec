"""The settings of an analysis: what a mesh does not carry. One table of keys, types, defaults and deck fields.

`load` reads a YAML file against the table; `help_settings` prints the table as a commented YAML file.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from zrno.translators import yaml_marks
from zrno.translators.text import Faults
from zrno.translators.yaml_marks import Location, Marked, Place, did_you_mean, dotted


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
        try:
            number = math.nan if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
        except OverflowError:  # an integer of more than 308 digits
            number = math.inf
        if not math.isfinite(number) or number < least or (above and number == least):
            raise ValueError(f"a number{bound}")
        return number

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
    """Settings after defaults. values: by key, groups as dicts; document: what was set, with places."""

    values: dict[str, Any]
    document: Marked

    def __getitem__(self, key: str) -> Any:
        return self.values[key]

    def gives(self, *key: str) -> bool:
        """Whether a key was set."""
        return key in self.document.keys

    def place(self, *key: str, value: bool = False) -> Place:
        """Where a key or its value was set, or the nearest above it."""
        return self.document.place(key, key=not value)

    def fault(self, key: Location, message: str, text: object, expected: str) -> None:
        """Note a fault at a key or the nearest above it."""
        self.document.fault(key, message, expected, text=str(text), key=True)

    def stop(self) -> None:
        """Raise InputError when there are faults."""
        self.document.stop()


def load(
    path: Path | str | None = None,
    *,
    overrides: Mapping[str, Any] | None = None,
    places: Mapping[str, tuple[Place, Place]] | None = None,
) -> Settings:
    """Read settings; without a file, the defaults.

    overrides: values by dotted key ("materials.plate.E"), stronger than the file's. places: where the key and the value
    of an override stand; that of "" is for faults of settings that are given nowhere. Raises InputError with every
    fault.
    """
    said = str(path or "--settings")
    document = Marked(said, {}, Faults(said)) if path is None else yaml_marks.load(path)
    if document.data is None:
        document.data = {}
    settings = Settings(defaults(), document)
    where = places or {}
    if path is None and "" in where:
        document.values[()] = where[""][1]
    if isinstance(document.data, dict):
        for name, value in (overrides or {}).items():
            key, place = where.get(name, (Place(said, 1, 1, name), Place(said, 1, 1, str(value))))
            document.override(tuple(name.split(".")), value, place, key)
    _take(TABLE, document.data, (), settings.values, document)
    _check(settings)
    settings.stop()
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
    table: tuple[Setting | Group, ...], data: Any, above: Location, values: dict[str, Any], document: Marked
) -> None:
    """Values of a mapping into `values`, against the table."""
    if not isinstance(data, dict):
        document.fault(
            above, f"{dotted(above) or 'the file'} is not a mapping", "key: value", text=_said(document, above, data)
        )
        return
    known = {item.key: item for item in table}
    for key, value in data.items():
        location = (*above, key)
        item = known.get(key)
        if item is None:
            document.fault(location, f"unknown key {dotted(location)}", did_you_mean(key, known), text=key, key=True)
        elif isinstance(item, Setting):
            try:
                values[key] = item.parse(value)
            except ValueError as error:
                message = f"{dotted(location)} is not what it should be"
                document.fault(location, message, str(error), text=_said(document, location, value))
        elif not item.named:
            _take(item.items, value, location, values[key], document)
        elif not isinstance(value, dict):
            said, expected = _said(document, location, value), "the name of a part, and its values below"
            document.fault(location, f"{key} is not a mapping", expected, text=said)
        else:
            for name, entry in value.items():
                own = values[key].setdefault(name, _defaults_of(item))
                _take(item.items, entry, (*location, name), own, document)


def _said(document: Marked, location: Location, value: Any) -> str:
    """The text of a value, as it stands in the file where it is one word."""
    return document.place(location).text or ("null" if value is None else str(value))


def _check(settings: Settings) -> None:
    """What single keys cannot show."""
    friction = settings["friction"]
    static, kinetic = friction["static"], friction["kinetic"]
    if (static is None) != (kinetic is None):
        missing = "static" if static is None else "kinetic"
        settings.fault(("friction",), f"friction.{missing} is missing", "null", "static and kinetic")
    elif static is not None and kinetic > static:
        settings.fault(
            ("friction", "kinetic"), "friction.kinetic is above friction.static", kinetic, f"at most {static:g}"
        )
    for name in settings["materials"]:
        _check_material(settings, name)


def _check_material(settings: Settings, name: str) -> None:
    material = settings["materials"][name]

    def wrong(key: str, message: str, expected: str) -> None:
        settings.fault(("materials", name, key), f"materials.{name}.{key} is {message}", material[key], expected)

    for key in ("density", "E", "nu"):
        if not settings.gives("materials", name, key):
            settings.fault(("materials", name), f"materials.{name}.{key} is missing", name, f"a value of {key}")
    if material["nu"] >= 0.5:
        wrong("nu", "too large", "less than 0.5")
    if material["beta"] > 1:
        wrong("beta", "too large", "0 to 1")
    if material["law"] == "von_mises":
        if material["yield_stress"] <= 0:
            wrong("yield_stress", "not positive", "a stress")
        if material["tangent_modulus"] >= material["E"]:
            wrong("tangent_modulus", "too large", "less than E")
