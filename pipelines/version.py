"""Which zrno this is: its version, and the commit where the source is a git checkout."""

from __future__ import annotations

import subprocess
from pathlib import Path


def version() -> str:
    """The installed version, e.g. "0.1.0"."""
    from importlib import metadata

    return metadata.version("zrno")


def git_hash() -> str | None:
    """The commit of the checkout that runs, with "-dirty" when tracked files differ; None of an installed copy."""
    root = Path(__file__).resolve().parents[1]
    if not (root / ".git").exists():
        return None
    describe = ["git", "-C", str(root), "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    try:
        return subprocess.run(describe, capture_output=True, text=True, check=True, timeout=10).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return None  # no git on this machine, or the checkout belongs to another user: a run does not fail for that
