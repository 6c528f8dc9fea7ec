"""YAML whose every value knows its line and column, so that a fault found later can say where it stands."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from zrno.translators.text import Fault, Faults, read_bytes

Location = tuple[str | int, ...]
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$|[-+]?\.(inf|Inf|INF)$|\.(nan|NaN|NAN)$")


class _Loader(yaml.SafeLoader):
    """YAML 1.1 takes `1e-3` for a text; here it is the number that an engineer means."""


_Loader.add_implicit_resolver("tag:yaml.org,2002:float", _FLOAT, list("-+0123456789."))


@dataclass(frozen=True, slots=True)
class Place:
    """Where a value or a key stands, and its text."""

    path: str
    line: int
    column: int
    text: str = ""


@dataclass(slots=True)
class Marked:
    """A YAML document. data: its plain value; values, keys: places by location, e.g. ("meshes", 0, "source")."""

    path: str
    data: Any
    faults: Faults
    values: dict[Location, Place] = field(default_factory=dict)
    keys: dict[Location, Place] = field(default_factory=dict)

    def fault(self, location: Location, message: str, expected: str = "", *, key: bool = False) -> None:
        """Note a fault at a value or at its key; at the nearest place around it where it has none of its own."""
        while location and location not in self.values:
            location = location[:-1]
        places = self.keys if key and location in self.keys else self.values
        place = places.get(location, Place(self.path, 1, 1))
        self.faults.found.append(Fault(place.path, place.line, place.column, message, place.text, expected))

    def override(self, location: Location, value: Any, place: Place) -> None:
        """Put a value that comes from elsewhere, e.g. the command line; mappings on the way are made."""
        here: Any = self.data
        for step in location[:-1]:
            if isinstance(here, dict):
                here = here.setdefault(step, {})
            elif isinstance(here, list) and isinstance(step, int) and step < len(here):
                here = here[step]
        last: Any = location[-1]
        if isinstance(here, dict) or (isinstance(here, list) and isinstance(last, int) and last < len(here)):
            here[last] = value
        else:
            self.faults.found.append(Fault(place.path, place.line, 1, f"there is no {dotted(location)}", place.text))
            self.faults.stop()
        self.values[location] = self.keys[location] = place


def dotted(location: Location) -> str:
    """A location as a person writes it: `coupling.friction.static`."""
    return ".".join(str(step) for step in location)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """What a fault of an unknown name says it expected: the nearest known name, or all of them."""
    names = sorted(known)
    near = difflib.get_close_matches(name, names, n=1)
    return f"{near[0]} (did you mean that?)" if near else "one of " + ", ".join(names)


def parse_value(text: str) -> Any:
    """A value as it stands in YAML; raises yaml.YAMLError."""
    return yaml.load(text, _Loader)


def load(path: Path | str) -> Marked:
    """Read a YAML file. Raises InputError for a missing file and for text that is no YAML."""
    raw = read_bytes(path)
    document = Marked(str(path), None, Faults(str(path)))
    try:
        loader = _Loader(raw)
        node = loader.get_single_node()
        document.data = _build(document, loader, node, (), ())
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        document.faults.add(line, column, f"not YAML: {error.problem}", expected=error.context or "")
    except yaml.reader.ReaderError as error:
        line = raw[: error.position].count(b"\n") + 1
        document.faults.add(line, 1, f"not YAML: {error.reason}", expected="a text file in UTF-8")
    except UnicodeDecodeError as error:
        document.faults.add(raw[: error.start].count(b"\n") + 1, 1, "not YAML", expected="a text file in UTF-8")
    document.faults.stop()
    return document


def _build(document: Marked, loader: Any, node: Any, location: Location, around: tuple[Any, ...]) -> Any:
    """The plain value of a node; notes its place and those of all below it."""
    if node is None:
        return None
    line, column = node.start_mark.line + 1, node.start_mark.column + 1
    text = node.value if isinstance(node, yaml.ScalarNode) else ""
    document.values[location] = Place(document.path, line, column, text)
    if isinstance(node, yaml.ScalarNode):
        return loader.construct_object(node)
    if node in around:
        document.faults.add(line, column, f"{dotted(location)} contains itself", expected="no such alias")
        return None
    around = (*around, node)
    if isinstance(node, yaml.SequenceNode):
        return [_build(document, loader, child, (*location, i), around) for i, child in enumerate(node.value)]
    data: dict[str, Any] = {}
    for key, child in node.value:
        name = str(key.value)
        place = Place(document.path, key.start_mark.line + 1, key.start_mark.column + 1, name)
        if name in data:
            document.faults.add(place.line, place.column, "the key stands twice", name, "each key once")
        data[name] = _build(document, loader, child, (*location, name), around)
        document.keys[*location, name] = place
    return data
