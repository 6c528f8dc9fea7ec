"""FEMAP neutral files (`.neu`), versions 4.x to 10 and their like: reader, and writer of version 4.41."""

from zrno.translators.femap.read import read
from zrno.translators.femap.write import write

__all__ = ["read", "write"]
