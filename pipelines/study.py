"""Speed against error: runs a scene over the values that its study varies, and says what is cheap and good enough."""

from __future__ import annotations

import json
import math
import statistics
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from zrno.pipelines import ranking
from zrno.pipelines.balance import LIMIT
from zrno.pipelines.load import load
from zrno.pipelines.manifest import plain
from zrno.pipelines.reference import error, measure
from zrno.pipelines.signals import Unmeasured
from zrno.pipelines.study_peer import compare
from zrno.pipelines.study_plan import Plan, prepare
from zrno.pipelines.study_plot import draw
from zrno.pipelines.study_runs import digest, stamp_of, timed, warm_up
from zrno.pipelines.study_table import peer_table, table
from zrno.translators.text import InputError, write_atomically


def study(
    path: Path | str,
    *,
    output: Path | str | None = None,
    repeat: int = 1,
    threads: int | None = None,
    options: Mapping[str, Any] | None = None,
    allow_outside: bool = False,
    progress: bool = False,
    known: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Run the study of a scene; returns what study.json holds: {rows, front, order_of_convergence, recommended, ...}.

    output: folder (default: the scene's name and `_study`, in the working folder): study.csv, study.json, study.png, in
    `runs` a result folder a run; what is there already, of the same inputs, is not run again. repeat: times that each
    run is timed, the median counts. options: for all runs, as `--set` takes them. known: takes the rows as they come.

    Raises InputError for bad input, also for what a run of the study turns out not to have; a run that diverges is a
    row without an error.
    """
    plan = prepare(Path(path), options or {})
    directory = Path(output) if output is not None else Path(f"{Path(path).stem}_study")
    rows: list[dict[str, Any]] = []
    known = {} if known is None else known
    known |= {"rows": rows, "output": str(directory)}
    warm = False
    for i, (name, chosen) in enumerate(plan.runs.items()):
        where = directory / "runs" / name
        stamp = stamp_of(where, digest(plan, chosen, threads))
        missing = 0 if stamp.get("status") == "failed" else repeat - len(stamp["walls"])
        if progress:
            what = f"{missing} to run" if missing > 0 else "done before"
            print(f"[{i + 1}/{len(plan.runs)}] {name}: {what}", file=sys.stderr)
        if missing > 0 and not warm:
            warm_up(plan, chosen, threads, allow_outside)
            warm = True
        for _ in range(missing):
            timed(plan, chosen, where, stamp, threads=threads, allow_outside=allow_outside, progress=progress)
        rows.append(_row(plan, name, chosen, where, stamp))
        write_atomically(directory / "study.csv", [table(plan.study, rows).encode()])
    peers, note = compare(
        plan, directory, repeat=repeat, threads=threads, allow_outside=allow_outside, progress=progress
    )
    result = ranking.rank(rows, plan.study.tolerance) | {
        "resolution": ranking.resolution(rows),
        "peers": peers,
        "peers_note": note,
        "title": plan.scene.title,
        "quantity": str(plan.study.quantity),
        "tolerance": plan.study.tolerance,
        "output": str(directory),
        "picture": str(directory / "study.png"),
    }
    write_atomically(directory / "study.csv", [table(plan.study, rows).encode()])
    if peers:
        write_atomically(directory / "peers.csv", [peer_table(plan.study, peers).encode()])
    text = json.dumps(plain(result), indent=2, ensure_ascii=False, allow_nan=False)
    write_atomically(directory / "study.json", [text.encode(), b"\n"])
    draw(directory / "study.png", result)
    return result


def _row(plan: Plan, name: str, chosen: Mapping[str, Any], where: Path, stamp: Mapping[str, Any]) -> dict[str, Any]:
    """A row of the study: what varies, how it ended, its error and its time."""
    walls = [wall for wall in stamp["walls"] if wall is not None]
    wall = statistics.median(walls) if walls else math.nan
    done = stamp["status"] == "done"
    row: dict[str, Any] = {
        "run": name,
        "options": dict(chosen),
        "status": stamp["status"],
        "error": None,
        "value": None,
        "reference": plan.against.number,
        "wall_seconds": wall,
        "compile_seconds": stamp["compile_seconds"],
        "repeats": len(walls),
        "particles": stamp["particles"],
        "steps": stamp["steps"],
        "time": stamp["time"],
        "particle_steps_per_second": (stamp["particles"] or 0) * (stamp["steps"] or 0) / wall if wall else None,
        "balance_error": stamp["balance_error"],
        "message": stamp.get("message", ""),
        "output": str(where),
    }
    if (stamp["balance_error"] or 0.0) > LIMIT and not row["message"]:
        row["message"] = f"the energy balance is out by {stamp['balance_error']:.0%}"
    if done:
        try:
            value = measure(load(where), plan.study.quantity)
            row["value"] = None if isinstance(value, tuple) else value
            row["error"] = error(value, plan.against, plan.study.quantity.norm)
            if not math.isfinite(row["error"]):
                row["error"], row["message"] = None, "the quantity is no finite number"
        except Unmeasured as missing:
            row["message"] = str(missing)
        except ValueError as bad:  # what one run lacks, all lack
            raise InputError([plan.scene.fault(("study", "quantity"), str(bad))]) from bad
    return row
