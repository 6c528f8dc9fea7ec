"""The scene file: which decks run, how they are made, what is written and drawn. Every fault with its place."""

from __future__ import annotations

import types
import typing
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PrivateAttr, ValidationError, field_validator
from pydantic_core import ErrorDetails

from zrno.pipelines.coupling_method import Coupling
from zrno.pipelines.fem_method import Fem
from zrno.pipelines.method import Sph
from zrno.pipelines.sections import Positive, Section, wrong
from zrno.pipelines.study_scene import Study
from zrno.pipelines.units import SYSTEMS, Units
from zrno.pipelines.view import LEAST_PIXELS, MOST_PIXELS, VIEWS, is_view
from zrno.translators import settings as analysis
from zrno.translators import yaml_marks
from zrno.translators.text import Fault, Faults, InputError
from zrno.translators.yaml_marks import Location, Marked, Place, did_you_mean, dotted

SUFFIXES = (".yaml", ".yml")
Pixels = Annotated[int, Field(ge=LEAST_PIXELS, le=MOST_PIXELS)]


def _as_list(value: Any) -> Any:
    return value if isinstance(value, list) else [value]


def _flat(value: Any, above: str = "") -> Any:
    """Nested mappings as one, by dotted key."""
    if not isinstance(value, dict):
        return value
    flat: dict[str, Any] = {}
    for key, below in value.items():
        flat |= _flat(below, f"{above}{key}.") if isinstance(below, dict) else {f"{above}{key}": below}
    return flat


class Mesh(Section):
    """A mesh that is made into a deck before the run, by the rules of `zrno convert`.

    set: settings in place, by dotted key or nested, stronger than those of the file.
    numbers: values for the parameters of a .geo script.
    """

    source: str
    target: str
    settings: str | None = None
    set: Annotated[dict[str, Any], BeforeValidator(_flat)] = Field(default_factory=dict)
    particles: Literal["solids", "shells", "nodes"] | None = None
    spacing: Positive | None = None
    part: Annotated[list[str | int], BeforeValidator(_as_list)] = Field(default_factory=list)
    dialect: Literal["2.07", "2019-08", "2019-10"] | None = None
    numbers: dict[str, float] = Field(default_factory=dict)


class Output(Section):
    """Frames. every: simulated time between them (the deck's interval where it is left out)."""

    every: Positive | None = None
    format: Literal["vtp", "vtk", "vtkhdf"] = "vtp"


class Picture(Section):
    """A picture to draw after the run. of: what has the colours, else all that has the field; most: where they end."""

    field: str = "von_mises"
    of: Literal["particles", "elements"] | None = None
    most: float | None = None
    time: float | str = "last"
    view: str = "iso"
    size: tuple[Pixels, Pixels] = (1280, 720)

    @field_validator("time")
    @classmethod
    def _time_or_word(cls, value: float | str) -> float | str:
        if isinstance(value, str) and value not in ("last", "all"):
            raise wrong("is no time", "a time, last or all")
        return value

    @field_validator("view")
    @classmethod
    def _known_view(cls, value: str) -> str:
        if not is_view(value):
            raise wrong("is no view", "one of " + ", ".join(VIEWS) + ", or a direction as 1,-2,0.5")
        return value


class Checkpoint(Section):
    """Checkpoints. every: simulated time between them."""

    every: Positive


class Scene(Section):
    """A scene. decks: one .mcm (particles), one .dat (finite elements), or both (coupled)."""

    decks: Annotated[list[str], Field(min_length=1, max_length=2)]
    title: str = ""
    meshes: list[Mesh] = Field(default_factory=list)
    units: Literal["mm-ms-g", "cm-us-g", "m-s-kg", "mm-s-t"] | None = None
    coupling: Coupling | None = None
    output: Output = Field(default_factory=Output)
    render: list[Picture] = Field(default_factory=list)
    checkpoint: Checkpoint | None = None
    study: Study | None = None
    sph: Sph = Field(default_factory=Sph)
    fem: Fem = Field(default_factory=Fem)
    _document: Marked = PrivateAttr(default_factory=lambda: Marked("scene", {}, Faults("scene")))

    @field_validator("decks")
    @classmethod
    def _one_of_a_kind(cls, value: list[str]) -> list[str]:
        kinds = [Path(deck).suffix.lower() for deck in value]
        if set(kinds) - {".mcm", ".dat"} or len(set(kinds)) < len(kinds):
            raise wrong(f"{', '.join(value)} do not make a run", "one .mcm, one .dat, or one of each")
        return value

    @property
    def system(self) -> Units | None:
        """The labels of the scene's units; None where it names none."""
        return None if self.units is None else SYSTEMS[self.units]

    def fault(self, location: Location, message: str, expected: str = "", *, key: bool = False) -> Fault:
        """A fault at a place of the scene's file: at a value, or at its key."""
        place = self._document.place(location, key=key)
        return Fault(place.path, place.line, place.column, message, place.text, expected)

    def places(self, mesh: int) -> dict[str, tuple[Place, Place]]:
        """Where the settings of a mesh stand that the scene itself gives: key and value, by dotted key; "" its own."""
        whole = self._document.place(("meshes", mesh))
        given = self._document.data["meshes"][mesh].get("set", {})
        return {"": (whole, whole), **_places(self._document, ("meshes", mesh, "set"), given)}


def _places(
    document: Marked, above: Location, data: Mapping[str, Any], dots: str = ""
) -> dict[str, tuple[Place, Place]]:
    """The places of the leaves of nested mappings, by dotted key; the same keys as `_flat` gives."""
    found: dict[str, tuple[Place, Place]] = {}
    for key, value in data.items():
        location = (*above, key)
        if isinstance(value, dict):
            found |= _places(document, location, value, f"{dots}{key}.")
        else:
            found[f"{dots}{key}"] = document.place(location, key=True), document.place(location)
    return found


# What `--set KEY=VALUE` may name of a mesh without saying which: it holds for all of them.
OF_EVERY_MESH = ("spacing", "particles", "dialect", "numbers")


def load(path: Path | str, options: Mapping[str, Any] | None = None) -> Scene:
    """Read a scene file. options: by dotted key, stronger than the file's (`options.split` says what they may be).

    A key of the scene replaces that key; a key of `OF_EVERY_MESH` and one of the settings is for all meshes.
    Raises InputError with every fault, up to 20, also for files that the scene names and that are not there.
    """
    document = yaml_marks.load(path)
    if not isinstance(document.data, dict):
        document.fault((), "a scene is a mapping of keys", "title, decks, ...")
        document.stop()
    for key, value in (options or {}).items():
        at, place = option_places(key, value)
        targets = _targets(document.data, key)
        if not targets:
            message, expected = (
                f"{key}: this scene makes no deck from a mesh",
                "a scene with meshes, or the deck itself",
            )
            document.faults.found.append(Fault(place.path, 1, 1, message, place.text, expected))
        for location in targets:
            document.override(location, value, place, at)
    try:
        scene = Scene.model_validate(document.data)
    except ValidationError as error:
        for detail in error.errors():
            _note(document, detail)
        document.stop()
        raise
    scene._document = document
    _check_files(document, scene, Path(path).parent)
    _check_settings(document, scene, Path(path).parent)
    for location, message, expected in scene.study.faults() if scene.study else ():
        document.fault(("study", *location), message, expected)
    document.stop()
    return scene


def option_places(key: str, value: Any) -> tuple[Place, Place]:
    """Where the key and the value of a `--set` stand."""
    return Place("--set", 1, 1, key), Place("--set", 1, len(key) + 2, str(value))


def _targets(data: dict[str, Any], key: str) -> list[Location]:
    """The places in a scene that an option by dotted key replaces."""
    steps: Location = tuple(int(step) if step.isdigit() else step for step in key.split("."))
    if steps[0] in Scene.model_fields:
        return [steps]
    meshes = data.get("meshes")
    below = steps if steps[0] in OF_EVERY_MESH else ("set", key)
    return [("meshes", i, *below) for i in range(len(meshes) if isinstance(meshes, list) else 0)]


def _note(document: Marked, detail: ErrorDetails) -> None:
    """One of pydantic's errors as a fault in the file."""
    loc = detail["loc"]
    location = loc if detail["type"] == "missing" else _in_file(document, loc)
    name = dotted(location)
    match detail["type"]:
        case "extra_forbidden":
            expected = did_you_mean(str(location[-1]), _keys_at(Scene, location[:-1]))
            document.fault(location, f"unknown key {name}", expected, key=True)
        case "missing":
            document.fault(location[:-1], f"{name} is missing", f"the key {location[-1]}")
        case "scene":
            context = detail["ctx"]
            document.fault(location, f"{name}: {context['what']}", context["expected"])
        case _:
            expected = detail["msg"].removeprefix("Input should be ").removeprefix("Value should be ")
            expected = "a value " + expected if expected.startswith(("greater", "less")) else expected
            document.fault(location, f"{name} has a wrong value", expected[:1].lower() + expected[1:])


def _in_file(document: Marked, loc: Location) -> Location:
    """pydantic's location, cut where the file has no such place: behind it come the names of a union's members."""
    while loc and loc not in document.values:
        loc = loc[:-1]
    return loc


def _keys_at(section: Any, location: Location) -> list[str]:
    """The keys that a section of the scene knows."""
    for step in location:
        if isinstance(step, str) and _is_section(section):
            section = section.model_fields[step].annotation
        while not _is_section(section):
            inner = [a for a in typing.get_args(section) if a is not types.NoneType]
            if not inner:
                return []
            section = inner[0]
    return list(section.model_fields)


def _is_section(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, Section)


def _check_files(document: Marked, scene: Scene, folder: Path) -> None:
    """Files that the scene names: sources, settings and references are there; decks are there or made."""
    named: list[tuple[Location, str]] = []
    for i, mesh in enumerate(scene.meshes):
        named.append((("meshes", i, "source"), mesh.source))
        if mesh.settings is not None:
            named.append((("meshes", i, "settings"), mesh.settings))
    made = {mesh.target for mesh in scene.meshes}
    named += [(("decks", i), deck) for i, deck in enumerate(scene.decks) if deck not in made]
    if scene.study is not None and isinstance(scene.study.reference, str):
        named.append((("study", "reference"), scene.study.reference))
    if scene.study is not None and scene.study.peer is not None:
        named.append((("study", "peer", "ccx"), scene.study.peer.ccx))
    for i, mesh in enumerate(scene.meshes):
        target = folder / mesh.target
        if target.is_dir() or not target.parent.is_dir():
            message = "a folder" if target.is_dir() else "in a folder that there is not"
            document.fault(("meshes", i, "target"), f"meshes.{i}.target: {message}", "the name of a file to make")
    for location, name in named:
        if not (folder / name).is_file():
            expected = "a file beside the scene" + (", or a target of meshes" if location[0] == "decks" else "")
            document.fault(location, f"{dotted(location)}: no such file", expected)


def _check_settings(document: Marked, scene: Scene, folder: Path) -> None:
    """The settings of every mesh, those of its file with their place there, those in the scene with theirs here."""
    for i, mesh in enumerate(scene.meshes):
        file = None if mesh.settings is None else folder / mesh.settings
        if file is not None and not file.is_file():
            continue
        try:
            analysis.load(file, overrides=mesh.set, places=scene.places(i))
        except InputError as error:
            document.faults.found += error.faults
