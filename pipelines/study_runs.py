"""The runs of a study: each a result folder of its own, timed; what stands there already is not run again."""

from __future__ import annotations

import hashlib
import json
import math
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from zrno.pipelines import options as command_options
from zrno.pipelines import scene as scenes
from zrno.pipelines.load import load
from zrno.pipelines.manifest import plain
from zrno.pipelines.run import run
from zrno.pipelines.study_plan import Plan
from zrno.pipelines.version import git_hash, version
from zrno.solvers.errors import Diverged
from zrno.translators.text import write_atomically

STAMP = "study_run.json"  # in a run's folder: what it was made of and how long it took


def digest(plan: Plan, chosen: Mapping[str, Any], threads: int | None) -> str:
    """SHA-256 of all that a run is made of: program, options, the scene but for its study, the files that it names."""
    given = {**plan.options, **chosen}
    scene = scenes.load(plan.path, command_options.split(given).scene)
    made_by = [version(), git_hash(), scene.model_dump(mode="json", exclude={"study", "render"}), given, threads]
    found = hashlib.sha256(json.dumps(made_by, default=str, sort_keys=True).encode())
    folder = plan.path.parent
    made = {mesh.target for mesh in scene.meshes}
    files = [name for mesh in scene.meshes for name in (mesh.source, mesh.settings) if name is not None]
    for name in [*files, *(deck for deck in scene.decks if deck not in made)]:
        with (folder / name).open("rb") as file:
            found.update(hashlib.file_digest(file, "sha256").digest())
    return found.hexdigest()


def stamp_of(where: Path, key: str) -> dict[str, Any]:
    """What is known of a run that was made before, of the same inputs; else that nothing is."""
    try:
        stamp = json.loads((where / STAMP).read_text(encoding="utf-8"))
        if stamp["key"] == key and isinstance(stamp["walls"], list):
            return dict(stamp)
    except (OSError, ValueError, KeyError, TypeError):
        pass
    return {"key": key, "walls": [], "compile_seconds": 0.0}


def timed(
    plan: Plan,
    chosen: Mapping[str, Any],
    where: Path,
    stamp: dict[str, Any],
    *,
    threads: int | None,
    allow_outside: bool,
    progress: bool,
) -> None:
    """One run of a row; its stamp takes the time. A run that diverges is noted there."""
    if stamp.get("status") == "failed":
        return
    where.mkdir(parents=True, exist_ok=True)
    (where / STAMP).unlink(missing_ok=True)  # until the folder is whole again
    known: dict[str, Any] = {"wall_seconds": math.nan, "compile_seconds": 0.0}
    how = _options(plan, chosen, where)
    try:
        run(
            [plan.path], output=where, threads=threads, options=how, allow_outside=allow_outside, progress=progress,
            known=known,
        )  # fmt: skip
    except Diverged as diverged:
        stamp |= {"status": "failed", "message": str(diverged)}
    stamp["walls"].append(known["wall_seconds"] - known["compile_seconds"])
    stamp["compile_seconds"] += known["compile_seconds"]
    stamp |= {k: known.get(k) for k in ("particles", "steps", "time")}
    stamp |= {"status": known.get("status", "failed"), "balance_error": known.get("energy", {}).get("balance_error")}
    write_atomically(where / STAMP, [json.dumps(plain(stamp), indent=2, allow_nan=False).encode(), b"\n"])


def warm_up(plan: Plan, chosen: Mapping[str, Any], threads: int | None, allow_outside: bool) -> None:
    """No step of a run, in a folder that vanishes: loads and compiles what the first row would else be charged with."""
    with tempfile.TemporaryDirectory(prefix="zrno-") as folder:
        where = Path(folder)
        how = _options(plan, chosen, where)
        try:
            run([plan.path], output=where, threads=threads, until=0.0, options=how, allow_outside=allow_outside)
            if plan.study.quantity.measure is not None:
                load(where).arrays()
        except Diverged:
            pass


def _options(plan: Plan, chosen: Mapping[str, Any], where: Path) -> dict[str, Any]:
    """The options of a run: its own, no pictures, and the decks that it makes in its folder, not beside the scene."""
    found = {**plan.options, **chosen, "render": []}
    moved = {mesh.target: str((where / Path(mesh.target).name).resolve()) for mesh in plan.scene.meshes}
    found |= {f"meshes.{i}.target": moved[mesh.target] for i, mesh in enumerate(plan.scene.meshes)}
    if moved:
        found["decks"] = [moved.get(deck, deck) for deck in plan.scene.decks]
    return found
