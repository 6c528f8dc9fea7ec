"""The rows of a study as a file and as a person reads them."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from typing import Any

from zrno.pipelines import ranking
from zrno.pipelines.study_plan import said
from zrno.pipelines.study_scene import Study

_COLUMNS = (
    "status", "error", "value", "wall_seconds", "compile_seconds", "repeats", "particles", "steps", "time",
    "particle_steps_per_second", "balance_error", "front", "recommended", "message", "run",
)  # fmt: skip


def table(study: Study, rows: Sequence[Mapping[str, Any]]) -> str:
    """study.csv: a column for each option that varies, then those of every study."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*study.vary, *_COLUMNS])
    for row in rows:
        writer.writerow([*map(said, row["options"].values()), *(_cell(row.get(name)) for name in _COLUMNS)])
    return out.getvalue()


def peer_table(study: Study, rows: Sequence[Mapping[str, Any]]) -> str:
    """peers.csv: as study.csv, of another program on the same meshes."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    keys = [key for key in study.vary if key in rows[0]["options"]]
    columns = ("program", "element", "error", "value", "wall_seconds", "repeats", "nodes", "message", "run")
    writer.writerow([*keys, *columns])
    for row in rows:
        writer.writerow([*map(said, row["options"].values()), *(_cell(row[name]) for name in columns)])
    return out.getvalue()


def _cell(value: Any) -> Any:
    return repr(value) if isinstance(value, float) else "" if value is None else value


def study_text(result: Mapping[str, Any]) -> str:
    """The table of a study, for a person: dearest last; `*` is on the front, `>` is recommended."""
    rows = sorted(result["rows"], key=lambda row: math.inf if math.isnan(row["wall_seconds"]) else row["wall_seconds"])
    keys = list(rows[0]["options"])
    cells = [["", *keys, "error", "wall s", "particles", "steps", "Mp-steps/s", ""]]
    for row in rows:
        mark = ">" if row["recommended"] else "*" if row["front"] else ""
        speed = row["particle_steps_per_second"] or 0.0
        shown = f"{row['error']:.3g}" if row["error"] is not None else "-"
        cells.append([
            mark, *(ranking.plain(v) for v in row["options"].values()), shown, f"{row['wall_seconds']:.2f}",
            str(row["particles"]), str(row["steps"]), f"{speed / 1e6:.2f}",
            row["message"] or ("" if row["status"] == "done" else row["status"]),
        ])  # fmt: skip
    widths = [max(len(line[i]) for line in cells) for i in range(len(cells[0]) - 1)]
    lines = [
        "  ".join([*(c.rjust(w) for c, w in zip(line, widths, strict=False)), line[-1]]).rstrip() for line in cells
    ]
    for row in sorted(result["peers"], key=lambda row: float(row["wall_seconds"])):
        shown = f"error {row['error']:.3g}" if row["error"] is not None else row["message"]
        lines.append(
            f"{row['program']} {row['element']}, {ranking.label(row['options'])}: {shown}, {row['wall_seconds']:.2f} s"
        )
    if result["peers_note"]:
        lines.append(result["peers_note"])
    lines.append(f"error: relative, of {result['quantity']}; tolerance {result['tolerance']:g}")
    if result["order_of_convergence"] is not None:
        lines.append(f"order of convergence in {result['resolution']}: {result['order_of_convergence']:.2f}")
    best = result["recommended"]
    lines.append(
        f"recommended: {ranking.label(best['options'])}" if best else "recommended: none is within the tolerance"
    )
    return "\n".join([*lines, result["picture"]])
