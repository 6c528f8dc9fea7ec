"""The shipped samples: what there is, and a copy of one to work in."""

from __future__ import annotations

import shutil
from pathlib import Path


def root() -> Path:
    """The folder of the shipped samples."""
    import zrno.samples

    return Path(zrno.samples.__path__[0])


def names() -> dict[str, str]:
    """Every sample's name and, from its README, what it is: the text of the first heading."""
    titles = {}
    for readme in sorted(root().glob("*/README.md")):
        with readme.open(encoding="utf-8") as lines:
            titles[readme.parent.name] = lines.readline().lstrip("# ").strip()
    return titles


def copy(name: str, directory: Path | None = None) -> Path:
    """Copy a sample's files to a folder, by default one of the sample's name here; returns it.

    Raises ValueError where there is no such sample, or where the folder holds something already.
    """
    known = names()
    if name not in known:
        raise ValueError(f"there is no sample {name}; expected one of {', '.join(known)}")
    target = Path(name) if directory is None else directory
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise ValueError(f"{target} is there already; give another folder, or remove it")
    shutil.copytree(root() / name, target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    return target
