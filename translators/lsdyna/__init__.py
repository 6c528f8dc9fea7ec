"""LS-DYNA keyword decks (.k, .key, .dyn): reader and writer."""

from zrno.translators.lsdyna.read import read
from zrno.translators.lsdyna.write import write

__all__ = ["read", "write"]
