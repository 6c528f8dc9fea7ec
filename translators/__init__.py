"""Translators: mesh files and decks to the model, and the model to decks; no numerics, no solver."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if __name__ != "zrno.translators":
    raise ImportError(
        f"import this package as zrno.translators, not as {__name__}: a bare import poisons numba's cache"
    )

if TYPE_CHECKING:
    from zrno.translators.convert import to_particles
    from zrno.translators.formats import read, write
    from zrno.translators.model import Model
    from zrno.translators.report import Report
    from zrno.translators.settings import help_settings
    from zrno.translators.settings import load as load_settings
    from zrno.translators.text import InputError

__all__ = ["InputError", "Model", "Report", "help_settings", "load_settings", "read", "to_particles", "write"]

_HOME = {
    "InputError": ("text", "InputError"),
    "Model": ("model", "Model"),
    "Report": ("report", "Report"),
    "help_settings": ("settings", "help_settings"),
    "load_settings": ("settings", "load"),
    "read": ("formats", "read"),
    "to_particles": ("convert", "to_particles"),
    "write": ("formats", "write"),
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    module, attribute = _HOME[name]
    return getattr(import_module(f"{__name__}.{module}"), attribute)
