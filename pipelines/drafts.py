"""The decks that a scene makes of its meshes: under temporary names until all that can be checked is sound."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from zrno.pipelines.convert import convert
from zrno.pipelines.options import control_places
from zrno.pipelines.scene import Scene
from zrno.translators import Model, load_settings, read
from zrno.translators.settings import Settings
from zrno.translators.text import MAX_FAULTS, InputError
from zrno.translators.yaml_marks import Place


@dataclass(frozen=True, slots=True)
class Draft:
    """A deck that a scene made. path: where it lies now; target: where it belongs; result: what `convert` returns.

    settings: what it was made by; None of a target that is no particle deck.
    """

    path: Path
    target: Path
    result: dict[str, Any]
    settings: Settings | None

    def publish(self) -> None:
        """Put the deck in its place."""
        self.path.replace(self.target)

    def read(self, *, paired: bool = False) -> Model:
        """The deck, as if it were at its place; paired: see `translators.read`. Raises InputError."""
        there, here = str(self.target), str(self.path)
        try:
            model = read(self.path, paired=paired)
        except InputError as error:
            raise InputError([replace(fault, path=there) for fault in error.faults]) from error
        model.warnings = [warning.replace(here, there) for warning in model.warnings]
        return model

    def places(self, model: Model) -> dict[str, Place]:
        """Where what the deck asks was said, for `build.refusals`: in the settings, the scene, or an option."""
        if self.settings is None:
            return {}
        materials = {}
        for number, material in model.materials.items():
            name = (
                material.name
                if self.settings.gives("materials", material.name)
                else material.name.removeprefix("part ")
            )
            materials[f"material {number}"] = self.settings.place("materials", name, "law", value=True)
        return materials | control_places(self.settings)


@contextmanager
def drafts(scene: Scene, folder: Path, *, publishing: bool, allow_outside: bool = False) -> Iterator[list[Draft]]:
    """Every deck that a scene makes, for the time of the block; what is not published then is gone after it.

    folder: of the scene; publishing: whether they are to be published, and so lie on the same disk as their targets;
    allow_outside: see `convert`.
    Raises InputError with the faults of all meshes, up to 20.
    """
    with ExitStack() as stack:
        made: list[Draft] = []
        faults = []
        for i, mesh in enumerate(scene.meshes):
            target = folder / mesh.target
            where = tempfile.TemporaryDirectory(prefix=".zrno-", dir=target.parent if publishing else None)
            path = Path(stack.enter_context(where)) / target.name
            try:
                settings = _settings(scene, i, folder)
                result = convert(
                    [folder / mesh.source],
                    path,
                    particles=mesh.particles,
                    spacing=mesh.spacing,
                    parts=mesh.part,
                    settings=settings,
                    numbers=mesh.numbers,
                    dialect=mesh.dialect,
                    allow_outside=allow_outside,
                )
            except InputError as error:
                faults += error.faults
            except ValueError as error:
                faults.append(scene.fault(("meshes", i), str(error).replace(str(path), str(target))))
            else:
                made.append(Draft(path, target, result, settings))
        if faults:
            raise InputError(sorted(set(faults))[:MAX_FAULTS])
        yield made


def _settings(scene: Scene, i: int, folder: Path) -> Settings | None:
    """The settings of a mesh's deck; None where the scene gives none, and none are needed."""
    mesh = scene.meshes[i]
    file = None if mesh.settings is None else folder / mesh.settings
    fills = mesh.target.lower().endswith(".mcm") and not mesh.source.lower().endswith(".mcm")
    if file is None and not mesh.set and not fills:
        return None
    return load_settings(file, overrides=mesh.set, places=scene.places(i))
