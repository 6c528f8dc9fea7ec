"""Translators: mesh files and decks to the model, and the model to decks; no numerics, no solver."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if __name__ != "zrno.translators":
    raise ImportError(
        f"import this package as zrno.translators, not as {__name__}: a bare import poisons numba's cache"
    )

if TYPE_CHECKING:
    from zrno.translators.formats import read, write
    from zrno.translators.model import Model
    from zrno.translators.report import Report
    from zrno.translators.text import InputError

__all__ = ["InputError", "Model", "Report", "read", "write"]

_HOME = {"read": "formats", "write": "formats", "Model": "model", "Report": "report", "InputError": "text"}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
