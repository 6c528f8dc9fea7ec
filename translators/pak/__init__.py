"""The finite element deck of PAK (its structural part, PAKS), `.dat`: reader and writer."""

from zrno.translators.pak.read import read
from zrno.translators.pak.write import write

__all__ = ["read", "write"]
