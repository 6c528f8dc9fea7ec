"""The settings of an analysis: what a mesh does not carry.

`load` reads a YAML file against the table of keys; `help_settings` prints the table as a commented YAML file.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from zrno.translators import yaml_marks
from zrno.translators.setting_table import TABLE
from zrno.translators.setting_types import Group, Setting
from zrno.translators.text import Faults
from zrno.translators.yaml_marks import Location, Marked, Place, did_you_mean, dotted


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
            document.override(tuple(name.split(".")), copy.deepcopy(value), place, key)
    _take(TABLE, document.data, (), settings.values, document)
    _check(settings)
    settings.stop()
    return settings


def defaults() -> dict[str, Any]:
    """Every key's default; groups by name are empty."""
    return _defaults_of(TABLE)


def _defaults_of(items: tuple[Setting | Group, ...]) -> dict[str, Any]:
    return {
        item.key: item.parse(copy.copy(item.default))
        if isinstance(item, Setting)
        else ({} if item.named else _defaults_of(item.items))
        for item in items
    }


def help_settings() -> str:
    """All settings as a YAML file: each with its default, what it is and the deck's field."""
    lines = ["# Settings of `zrno convert --settings FILE.yaml`, with their defaults. Units are the mesh's."]

    def line(item: Setting, indent: str) -> str:
        comment = ", ".join(filter(None, [item.comment, f"[{item.deck}]" if item.deck else ""]))
        return f"{indent + item.key + ': ' + _yaml(item.default):<44}# {comment}"

    def walk(items: tuple[Setting | Group, ...], indent: str) -> None:
        for item in items:
            if isinstance(item, Setting):
                lines.append(line(item, indent))
                continue
            lines.append(f"{indent + item.key + ':':<44}# {item.comment}")
            if item.named:
                lines.append(f"{indent}  NAME:")
            walk(item.items, indent + ("    " if item.named else "  "))

    walk(TABLE, "")
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
                own = values[key].setdefault(name, _defaults_of(item.items))
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
    if friction["fluid"] is not None and static is not None:
        settings.fault(
            ("friction", "fluid"), "friction of a fluid and of solids", friction["fluid"], "one or the other"
        )
    birth = settings["birth_death"]
    for field, needed in (("death_plane", birth["option"] >= 2), ("particles", birth["option"] in (1, 3))):
        if needed and birth[field] is None:
            message = f"birth_death.{field} is missing for option {birth['option']}"
            settings.fault(("birth_death",), message, "null", f"a value of {field}")
    for name, material in settings["materials"].items():
        if material["nu"] is not None and material["nu"] >= 0.5:
            key = ("materials", name, "nu")
            settings.fault(key, f"{dotted(key)} is too large", material["nu"], "less than 0.5")
    for name, entry in settings["sets"].items():
        function = entry["function"]
        if function is not None and function not in settings["functions"]:
            known = ", ".join(settings["functions"]) or "a function below `functions`"
            settings.fault(("sets", name, "function"), "no such function", function, known)
