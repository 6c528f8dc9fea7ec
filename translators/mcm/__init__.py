"""The particle deck of MCM (Cranfield SPH), `.mcm`: reader and writer."""

from zrno.translators.mcm.read import read
from zrno.translators.mcm.write import write

__all__ = ["read", "write"]
