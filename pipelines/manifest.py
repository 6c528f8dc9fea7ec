"""run.json: what was run, with what, on which machine, how long it took and how it ended."""

from __future__ import annotations

import hashlib
import json
import math
import os
import platform
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from zrno.pipelines.version import git_hash, version
from zrno.translators.text import write_atomically

FILE = "run.json"


def digests(paths: Iterable[Path | str]) -> dict[str, str]:
    """SHA-256 of each file, by its path as given."""
    found = {}
    for path in paths:
        with Path(path).open("rb") as file:
            found[str(path)] = hashlib.file_digest(file, "sha256").hexdigest()
    return found


class Manifest:
    """run.json of a result folder: written when the run starts (status "running") and with each `update`.

    inputs: SHA-256 by file; options: every option after defaults; units: a consistent system ("mm-ms-g") or None;
    dimension: 1, 2 or 3; axisymmetric: of two dimensions, x the distance from the axis.
    """

    def __init__(
        self,
        directory: Path | str,
        *,
        inputs: Mapping[str, str],
        options: Mapping[str, Any],
        threads: int,
        title: str = "",
        units: str | None = None,
        dimension: int = 3,
        axisymmetric: bool = False,
    ) -> None:
        self._path = Path(directory) / FILE
        self.data: dict[str, Any] = {
            "status": "running",
            "title": title,
            "units": units,
            "dimension": dimension,
            "axisymmetric": axisymmetric,
            "version": version(),
            "git_hash": git_hash(),
            "inputs": dict(inputs),
            "options": dict(options),
            "threads": threads,
            "host": {
                "name": platform.node(),
                "system": platform.platform(),
                "machine": platform.machine(),
                "processors": os.cpu_count(),
                "python": platform.python_version(),
            },
            "started": _now(),
        }
        self.update()

    def update(self, **values: Any) -> None:
        """Set keys (`status`, `wall_seconds`, `energy`, ...) and replace the file."""
        self.data.update(values)
        if self.data["status"] != "running":
            self.data["finished"] = _now()
        self._path.parent.mkdir(parents=True, exist_ok=True)
        text = json.dumps(plain(self.data), indent=2, ensure_ascii=False, allow_nan=False)
        write_atomically(self._path, [text.encode(), b"\n"])


def read_manifest(path: Path | str) -> dict[str, Any]:
    """What a run.json says. Raises ValueError when it is not JSON."""
    data = json.loads(Path(path).read_text(encoding="utf-8"))
    if not isinstance(data, dict):
        raise ValueError(f"{path} is not a manifest: expected a JSON object")
    return data


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


def plain(value: Any) -> Any:
    """A value as JSON has it: numbers of numpy as numbers, nan and infinities as null, all else as its text."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple, set)):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if isinstance(value, (str, int, bool, type(None))) else str(value)
