"""The registry of formats: a file's format by its name and its content, and `read` and `write` of any of them."""

from __future__ import annotations

import importlib
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from zrno.translators.model import Model
from zrno.translators.report import Report
from zrno.translators.text import Fault, InputError, read_bytes


@dataclass(frozen=True, slots=True)
class Format:
    """A format.

    reader, writer: modules with a `read` and a `write` function, imported when called; missing: what to say of a format
    that is not read.
    """

    name: str
    extensions: tuple[str, ...]
    reader: str = ""
    writer: str = ""
    missing: str = ""


FORMATS = (
    Format("mcm", (".mcm",), "zrno.translators.mcm", "zrno.translators.mcm"),
    Format("msh", (".msh",), "zrno.translators.gmsh.read", "zrno.translators.gmsh.write"),
    Format("geo", (".geo",), "zrno.translators.gmsh.geo"),
    Format("lsdyna", (".k", ".key", ".dyn"), "zrno.translators.lsdyna", "zrno.translators.lsdyna"),
    Format("neu", (".neu", ".fno"), "zrno.translators.neu", "zrno.translators.femap"),
    Format("pak", (".dat",), "zrno.translators.pak", "zrno.translators.pak"),
    Format("vtu", (".vtu",), "zrno.translators.meshio_bridge", "zrno.translators.meshio_bridge"),
)
_MESHIO = Format("meshio", (), "zrno.translators.meshio_bridge")


def find(path: Path | str) -> Format:
    """The format of a file: by plain content, else by extension; what is left is meshio's to try."""
    where = Path(path)
    by_extension = next((f for f in FORMATS if where.suffix.lower() in f.extensions), _MESHIO)
    if where.is_file():
        with where.open("rb") as file:
            head = file.read(4096).lstrip()
        # a gmsh mesh under another name, say .neu
        if head.startswith(b"$MeshFormat") and by_extension.name != "msh":
            return next(f for f in FORMATS if f.name == "msh")
        # pieces of keyword decks have other extensions too: .inc, .asc
        if by_extension is _MESHIO and re.search(rb"^\*KEYWORD\b", head, re.MULTILINE):
            return next(f for f in FORMATS if f.name == "lsdyna")
    return by_extension


def read(path: Path | str, *, paired: bool = False, allow_outside: bool = False, partial: bool = False) -> Model:
    """Read a mesh or a deck, whatever its format.

    paired: a particle deck belongs to a coupled run (see `mcm.read`). allow_outside: files that the deck includes may
    stand outside its folder. partial: what is missing of a deck of several files is no fault, and stands in
    `Model.incomplete`. Raises InputError with every fault, up to 20.
    """
    kind = find(path)
    if not kind.reader:
        read_bytes(path)  # a missing or an empty file is said first
        raise InputError([Fault(str(path), 1, 1, kind.missing, expected="one of " + ", ".join(_readable()))])
    module = importlib.import_module(kind.reader)
    options: dict[str, bool] = {
        "mcm": {"paired": paired},
        "lsdyna": {"allow_outside": allow_outside, "partial": partial},
    }.get(kind.name, {})
    model: Model = module.read(path, **options)
    return model


def write(model: Model, path: Path | str, **options: Any) -> Report:
    """Write a model in the format of the target's extension; options are the format's own (`dialect` of .mcm).

    Returns what the target cannot say. Raises ValueError for a format that is not written, or a model it cannot hold.
    """
    if model.incomplete:
        raise ValueError("nothing can be made of a model that lacks what it names: " + "; ".join(model.incomplete[:5]))
    kind = next((f for f in FORMATS if Path(path).suffix.lower() in f.extensions), None)
    if kind is None or not kind.writer:
        targets = ", ".join(e for f in FORMATS if f.writer for e in f.extensions)
        raise ValueError(f"{path}: files of this kind are not written; expected one of {targets}")
    report: Report = importlib.import_module(kind.writer).write(model, path, **options)
    return report


def _readable() -> list[str]:
    return [e for f in FORMATS if f.reader for e in f.extensions]
