"""Validate meshes, decks and scenes: every fault with its place, of all the files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from zrno.pipelines.scene import load as load_scene
from zrno.translators import InputError, read
from zrno.translators.text import Fault

SCENES = (".yaml", ".yml")


def check(paths: Sequence[Path]) -> list[dict[str, Any]]:
    """A row a file: {file, kind, faults, warnings}; a fault is {path, line, column, message, text, expected}.

    A .mcm that is checked together with a .dat is read as half of a coupled pair. Decks that a scene names, and does
    not make itself, are checked with it.
    """
    suffixes = {path.suffix.lower() for path in paths}
    rows = []
    for path in paths:
        if path.suffix.lower() in SCENES:
            rows += _scene(path)
        else:
            rows.append(_file(path, paired={".mcm", ".dat"} <= suffixes))
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


def _file(path: Path, *, paired: bool) -> dict[str, Any]:
    try:
        model = read(path, paired=paired)
    except InputError as error:
        return _row(path, path.suffix.lstrip("."), error)
    return _row(path, model.format, None) | {"warnings": list(model.warnings)}


def _scene(path: Path) -> list[dict[str, Any]]:
    try:
        scene = load_scene(path)
    except InputError as error:
        return [_row(path, "scene", error)]
    made = {mesh.target for mesh in scene.meshes}
    decks = [path.parent / deck for deck in scene.decks if deck not in made]
    return [_row(path, "scene", None), *(_file(deck, paired=len(scene.decks) == 2) for deck in decks)]


def _row(path: Path, kind: str, error: InputError | None) -> dict[str, Any]:
    faults = [] if error is None else [asdict(fault) for fault in error.faults]
    return {"file": str(path), "kind": kind, "faults": faults, "warnings": []}
