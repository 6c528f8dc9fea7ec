"""The plan of a study: read, checked, its runs named; nothing has run yet."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from zrno.pipelines import options as command_options
from zrno.pipelines import scene as scenes
from zrno.pipelines.reference import Reference, reference
from zrno.pipelines.scene import Scene
from zrno.pipelines.study_scene import Study
from zrno.translators.text import MAX_FAULTS, Fault, InputError


@dataclass(frozen=True, slots=True)
class Plan:
    """A study that can begin. options: of every run, beside those of its row; runs: name and options of each."""

    path: Path
    scene: Scene
    study: Study
    against: Reference
    options: dict[str, Any]
    runs: dict[str, dict[str, Any]]


def prepare(path: Path, options: Mapping[str, Any]) -> Plan:
    """Read a study and check all that can be checked before its first run. Raises InputError."""
    if path.suffix.lower() not in scenes.SUFFIXES:
        raise InputError([Fault(str(path), 1, 1, "not a scene", path.name, "a scene (.yaml) with a section study")])
    chosen = command_options.split(options)
    scene = scenes.load(path, chosen.scene)
    if scene.study is None:
        raise InputError([Fault(str(path), 1, 1, "no study in this scene", "", "a section study")])
    faults = []
    for key, values in scene.study.vary.items():
        for i, value in enumerate(values):
            if key in options:
                faults.append(
                    scene.fault(("study", "vary", key), f"{key} is set by --set, too", "one of the two", key=True)
                )
                break
            faults += _refused(path, scene, options, key, i, value)
    if faults:
        raise InputError(sorted(set(faults))[:MAX_FAULTS])
    runs = {run_name(chosen): chosen for chosen in scene.study.combinations()}
    return Plan(path, scene, scene.study, reference_of(scene, path.parent), dict(options), runs)


def reference_of(scene: Scene, folder: Path) -> Reference:
    """What the study of a scene is measured against. Raises InputError."""
    assert scene.study is not None
    try:
        return reference(scene.study, folder)
    except InputError:
        raise
    except ValueError as error:
        raise InputError([scene.fault(("study", "analytic"), str(error), "other parameters")]) from error


def _refused(path: Path, scene: Scene, options: Mapping[str, Any], key: str, i: int, value: Any) -> Iterator[Fault]:
    """What is wrong with one of the values of vary, at its place."""
    try:
        found = command_options.split({**options, key: value})
        scenes.load(path, found.scene)
    except InputError as error:
        for fault in error.faults:
            if fault.path != "--set":
                yield fault
                continue
            of_key = fault.column == 1  # the value of a --set stands behind its key
            at = ("study", "vary", key) if of_key else ("study", "vary", key, i)
            yield scene.fault(at, fault.message, fault.expected, key=of_key)


def run_name(chosen: Mapping[str, Any]) -> str:
    """Name of a run's folder: its options, with a digest where a file's name cannot carry them."""
    whole = "_".join(f"{key}={said(value)}" for key, value in chosen.items())
    name = re.sub(r"[^A-Za-z0-9.+=_-]+", "-", whole).strip("-.")
    if name == whole and len(name) <= 100:
        return name
    return f"{name[:80]}-{hashlib.sha256(whole.encode()).hexdigest()[:8]}"


def said(value: Any) -> str:
    """A value of an option, as exactly as YAML says it."""
    return value if isinstance(value, str) else json.dumps(value, default=str)
