"""YAML whose every key and value knows its line and column, so that a fault found later can say where it stands.

Settings and scenes are read through here.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from zrno.translators.text import MAX_FAULTS, Fault, Faults, InputError, read_bytes

Location = tuple[str | int, ...]
MOST_BYTES = 1 << 20  # of a file: YAML takes a hundred times its size to read
MOST_VALUES = 50_000  # aliases of aliases multiply
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$|[-+]?\.(inf|Inf|INF)$|\.(nan|NaN|NAN)$")

# What the constructors of scalars raise for a text that its tag cannot be, as `!!int x` or the date 2024-13-01.
_WRONG = (ValueError, LookupError, AttributeError, TypeError, ArithmeticError, RecursionError)


@cache
def _loader() -> Any:
    """The class that reads YAML. YAML 1.1 takes `1e-3` for a text; here it is the number that an engineer means."""
    import yaml

    class Loader(yaml.SafeLoader):
        pass

    Loader.add_implicit_resolver("tag:yaml.org,2002:float", _FLOAT, list("-+0123456789."))
    return Loader


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

    def place(self, location: Location, *, key: bool = False) -> Place:
        """The place of a value or of its key; the nearest around it where it has none of its own."""
        while location and location not in self.values:
            location = location[:-1]
        places = self.keys if key and location in self.keys else self.values
        return places.get(location, Place(self.path, 1, 1))

    def fault(
        self, location: Location, message: str, expected: str = "", *, text: str | None = None, key: bool = False
    ) -> None:
        """Note a fault at a value or at its key. text: the offending one, where it is not all that stands there."""
        place = self.place(location, key=key)
        said = place.text if text is None else text
        self.faults.found.append(Fault(place.path, place.line, place.column, message, said, expected))
        if len(self.faults.found) >= MAX_FAULTS:
            self.stop()

    def stop(self) -> None:
        """Raise InputError when there are faults."""
        if self.faults.found:
            raise InputError(sorted(set(self.faults.found))[:MAX_FAULTS])

    def override(self, location: Location, value: Any, place: Place, key: Place | None = None) -> None:
        """Put a value that comes from elsewhere, e.g. the command line; mappings on the way are made.

        place, key: where the value and its key stand there.
        """
        here: Any = self.data
        at = key or place
        for i, step in enumerate(location[:-1]):
            if isinstance(here, dict):
                here = here.setdefault(step, {})
                self.values.setdefault(location[: i + 1], place)
                self.keys.setdefault(location[: i + 1], at)
            elif isinstance(here, list) and isinstance(step, int) and step < len(here):
                here = here[step]
        last: Any = location[-1]
        if isinstance(here, dict) or (isinstance(here, list) and isinstance(last, int) and last < len(here)):
            here[last] = value
        else:
            self.faults.found.append(Fault(at.path, at.line, at.column, f"there is no {dotted(location)}", place.text))
            self.stop()
        self.values[location], self.keys[location] = place, at


def dotted(location: Location) -> str:
    """A location as a person writes it: `coupling.friction.static`."""
    return ".".join(str(step) for step in location)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """What a fault of an unknown name says it expected: the nearest known name, or all of them."""
    names = list(known)
    near = difflib.get_close_matches(name, names, n=1)
    return f"{near[0]} (did you mean that?)" if near else "one of " + ", ".join(names)


def parse_value(text: str) -> Any:
    """A value as it stands in YAML. Raises ValueError."""
    import yaml

    try:
        return yaml.load(text, _loader())
    except (yaml.YAMLError, *_WRONG) as error:
        raise ValueError(f"not YAML: {text}") from error


def load(path: Path | str) -> Marked:
    """Read a YAML file; `data` is None where it holds nothing but comments.

    Raises InputError for a missing file and for text that is no YAML; what is wrong with single values is noted among
    the document's faults.
    """
    import yaml

    raw = read_bytes(path)
    document = Marked(str(path), None, Faults(str(path)))
    faults = document.faults
    if len(raw) > MOST_BYTES:
        faults.add(1, 1, f"{len(raw)} bytes are too many for a scene or settings", expected=f"at most {MOST_BYTES}")
        faults.stop()
    try:
        loader = _loader()(raw)
        node = loader.get_single_node()
        document.data = _build(document, loader, node, (), ())
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        faults.add(line, column, f"not YAML: {error.problem}", expected=error.context or "key: value")
    except yaml.reader.ReaderError as error:
        line = raw[: error.position].count(b"\n") + 1
        faults.add(line, 1, f"not YAML: {error.reason}", expected="a text file in UTF-8")
    except UnicodeDecodeError as error:
        faults.add(raw[: error.start].count(b"\n") + 1, 1, "not YAML", expected="a text file in UTF-8")
    except RecursionError:
        faults.add(1, 1, "nested too deeply", expected="a scene or settings")
    else:
        return document
    raise InputError(faults.found)


def _build(document: Marked, loader: Any, node: Any, location: Location, around: tuple[Any, ...]) -> Any:
    """The plain value of a node; notes its place and those of all below it."""
    import yaml

    if node is None:
        return None
    faults = document.faults
    line, column = node.start_mark.line + 1, node.start_mark.column + 1
    text = node.value if isinstance(node, yaml.ScalarNode) else ""
    document.values[location] = Place(document.path, line, column, text)
    if len(document.values) > MOST_VALUES:
        faults.add(line, column, f"more than {MOST_VALUES} values", expected="a scene or settings")
        faults.stop()
    if isinstance(node, yaml.ScalarNode):
        try:
            return loader.construct_object(node)
        except _WRONG:
            faults.add(line, column, f"not a value of the kind {node.tag.rpartition(':')[2]}", text)
            return None
    if node in around:
        faults.add(line, column, f"{dotted(location)} contains itself", expected="no such alias")
        return None
    around = (*around, node)
    if isinstance(node, yaml.SequenceNode):
        return [_build(document, loader, child, (*location, i), around) for i, child in enumerate(node.value)]
    data: dict[str, Any] = {}
    for key, child in node.value:
        at = key.start_mark.line + 1, key.start_mark.column + 1
        if not isinstance(key, yaml.ScalarNode):
            faults.add_at(at, "a key is a list or a mapping", expected="a word")
            continue
        name = str(key.value)
        if name in data:
            faults.add_at(at, "the key stands twice", name, "each key once")
        data[name] = _build(document, loader, child, (*location, name), around)
        document.keys[*location, name] = Place(document.path, *at, name)
    return data
