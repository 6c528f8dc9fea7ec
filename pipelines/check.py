"""Validate meshes, decks and scenes: every fault with its place, of all the files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from zrno.pipelines.drafts import drafts
from zrno.pipelines.method import Sph
from zrno.pipelines.prepare import check_decks
from zrno.pipelines.scene import SUFFIXES
from zrno.pipelines.scene import load as load_scene
from zrno.pipelines.study_plan import reference_of
from zrno.translators import InputError, Model, read
from zrno.translators.text import Fault
from zrno.translators.yaml_marks import Place


def check(paths: Sequence[Path], *, allow_outside: bool = False) -> list[dict[str, Any]]:
    """A row a file: {file, kind, faults, warnings}; a fault is {path, line, column, message, text, expected}.

    A .mcm that is checked together with a .dat is read as half of a coupled pair. The decks of a scene are checked with
    it, also those that it makes; nothing is written. What is sound and cannot be run yet is a warning.
    allow_outside: files that a deck includes may stand outside its folder.
    """
    suffixes = {path.suffix.lower() for path in paths}
    rows = []
    for path in paths:
        if path.suffix.lower() in SUFFIXES:
            rows += _scene(path, allow_outside)
        else:
            rows.append(_file(path, allow_outside, None, paired={".mcm", ".dat"} <= suffixes))
    return rows


def check_text(rows: Sequence[dict[str, Any]]) -> str:
    """A line a file: sound, or how many faults; warnings below."""
    lines = []
    for row in rows:
        count = len(row["faults"])
        lines.append(f"{row['file']}: {'ok' if not count else f'{count} fault' + 's' * (count > 1)}")
        lines += [f"  warning: {warning}" for warning in row["warnings"]]
    return "\n".join(lines)


def fault_lines(rows: Sequence[dict[str, Any]]) -> list[str]:
    """All faults of all files, a line each."""
    return [str(Fault(**fault)) for row in rows for fault in row["faults"]]


def _file(path: Path, allow_outside: bool, method: Sph | None, *, paired: bool) -> dict[str, Any]:
    try:
        model = read(path, paired=paired, allow_outside=allow_outside)
    except InputError as error:
        return _row(path, path.suffix.lstrip("."), error.faults)
    return _sound(path, model, method, paired=paired)


def _scene(path: Path, allow_outside: bool) -> list[dict[str, Any]]:
    """The scene, the decks that it makes (from a folder of temporary files), and those that are there."""
    try:
        scene = load_scene(path)
    except InputError as error:
        return [_row(path, "scene", error.faults)]
    decks = [path.parent / deck for deck in scene.decks]
    row = _row(path, "scene")
    if scene.study is not None:
        try:
            reference_of(scene, path.parent)
        except InputError as error:
            row["faults"] += map(asdict, error.faults)
    try:
        paired = check_decks(decks)
    except InputError as error:
        row["faults"] += map(asdict, error.faults)
        return [row]
    made = {path.parent / mesh.target for mesh in scene.meshes}
    rows = [row, *(_file(deck, allow_outside, scene.sph, paired=paired) for deck in decks if deck not in made)]
    try:
        with drafts(scene, path.parent, publishing=False, allow_outside=allow_outside) as found:
            for draft in found:
                model = draft.read(paired=paired)
                rows.append(_sound(draft.target, model, scene.sph, draft.places(model), paired=paired))
                rows[-1]["warnings"] += [
                    f"dropped: {i['count']} {i['what']} - {i['where']}" for i in draft.result["dropped"]
                ]
    except InputError as error:
        row["faults"] += map(asdict, error.faults)
    except ImportError as error:
        row["warnings"].append(f"the decks that it makes are not checked: {error}")
    return rows


def _sound(
    path: Path, model: Model, method: Sph | None, places: Mapping[str, Place] | None = None, *, paired: bool = False
) -> dict[str, Any]:
    """The row of a file that can be read. method: of the scene; places: see `build.refusals`."""
    row = _row(path, model.format)
    row["warnings"] += model.warnings
    if model.particle_control is not None:
        from zrno.pipelines.build import particle_problem, refusals
        from zrno.solvers.sph import refuse

        wrong, missing = refusals(model, str(path), places, method)
        row["faults"] += map(asdict, sorted(wrong))
        row["warnings"] += map(_not_yet, sorted(missing))
        if not wrong and not missing and not paired:
            try:
                refuse(particle_problem(model, str(path), method=method))
            except ValueError as error:
                row["warnings"].append(f"{path}: cannot be run: {error}")
    if model.fem_control is not None:
        from zrno.pipelines.fem_method import Fem
        from zrno.pipelines.fem_refusals import refusals as of_structure

        row["warnings"] += map(_not_yet, sorted(of_structure(model, str(path), Fem())))
    return row


def _not_yet(fault: Fault) -> str:
    said = f" ({fault.text})" if fault.text else ""
    return f"{fault.path}:{fault.line}:{fault.column}: cannot be run yet: {fault.message}{said}"


def _row(path: Path, kind: str, faults: Sequence[Fault] = ()) -> dict[str, Any]:
    return {"file": str(path), "kind": kind, "faults": [asdict(fault) for fault in faults], "warnings": []}
