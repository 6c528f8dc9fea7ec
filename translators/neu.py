"""Neutral files (.neu): five programs call their own format so; which one it is shows in the first lines."""

from __future__ import annotations

import re
from pathlib import Path

from zrno.translators.model import Model
from zrno.translators.text import Fault, InputError, read_bytes

_BOM = b"\xef\xbb\xbf"
_INTEGER = re.compile(rb"[+-]?\d+")
_REAL = re.compile(rb"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?")
_PATRAN_FIRST = 25  # its first packet is the title
_EXPECTED = "FEMAP (-1, then 100) or Gambit (CONTROL INFO)"
_REFUSED = {
    "patran": ("this is a Patran neutral file, which is not read", "the mesh as gmsh .msh or as FEMAP neutral file"),
    "netgen": ("this is a Netgen neutral file, which is not read", 'the mesh as gmsh .msh (Netgen: "Gmsh2 Format")'),
    "": ("neither a FEMAP nor a Gambit neutral file", _EXPECTED),
}


def kind_of(head: bytes) -> str:
    """The format whose file begins with these bytes: femap, gambit, patran, netgen; empty where none is known."""
    lines = [line.split() for line in head.removeprefix(_BOM).splitlines()[:50] if line.strip()]
    if not lines:
        return ""
    first, second = lines[0], lines[1] if len(lines) > 1 else []
    if b"CONTROL INFO" in b" ".join(first).upper():
        return "gambit"
    if first == [b"-1"] and len(second) == 1 and _INTEGER.fullmatch(second[0].rstrip(b",")):
        return "femap"
    if len(first) >= 8 and all(map(_INTEGER.fullmatch, first)) and len(first[0]) < 4 and int(first[0]) == _PATRAN_FIRST:
        return "patran"
    if len(first) == 1 and first[0].isdigit() and len(second) == 3 and all(map(_REAL.fullmatch, second)):
        return "netgen"
    return ""


def read(path: Path | str) -> Model:
    """Read a neutral file of a known kind. Raises InputError, which names the kind of one that is not read."""
    kind = kind_of(read_bytes(path)[:8192])
    if kind == "gambit":
        from zrno.translators.gambit import read as read_gambit

        return read_gambit(path)
    if kind == "femap":
        from zrno.translators.femap import read as read_femap

        return read_femap(path)
    message, expected = _REFUSED[kind]
    raise InputError([Fault(str(path), 1, 1, message, expected=expected)])
