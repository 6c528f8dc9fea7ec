"""What is in a mesh or a deck."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from zrno.translators import read


def info(path: Path, *, allow_outside: bool = False) -> dict[str, Any]:
    """The keys of `zrno info --json`. A particle deck of a coupled run is read as such, with a warning; a piece of a
    deck as what it is.

    allow_outside: files that it includes may stand outside its folder.
    """
    model = read(path, paired=True, allow_outside=allow_outside, partial=True)
    summary = model.summary()
    if model.velocity_overrun:
        count = model.velocity_overrun
        summary["warnings"].append(f"{count} velocity cards past the particles: half of a pair, cannot run alone")
    return summary


def info_text(path: Path, summary: Mapping[str, Any]) -> str:
    """The same for a person: a line a fact."""
    box = summary["bounding_box"]
    rows = {
        "format": f"{summary['format']} {summary['version']}".strip(),
        "dimension": summary["dimension"],
        "nodes": summary["nodes"] or None,
        "elements": ", ".join(f"{count} {kind}" for kind, count in summary["elements"].items()),
        "particles": summary["particles"] or None,
        "parts": ", ".join(f"{number} {name}".strip() for number, name in summary["parts"].items()),
        "materials": ", ".join(
            f"{number} {m['name']} ({m['law']}, density {m['density']:g})" for number, m in summary["materials"].items()
        ),
        "sets": ", ".join(f"{name} ({count})" for name, count in summary["sets"].items()),
        "box": None if box is None else " to ".join("(" + ", ".join(f"{x:g}" for x in p) + ")" for p in box),
        "includes": ", ".join(summary["includes"]),
    }
    lines = [f"  {name + ':':<12}{value}" for name, value in rows.items() if value not in (None, "")]
    return "\n".join([str(path), *lines, *(f"  warning: {warning}" for warning in summary["warnings"])])
