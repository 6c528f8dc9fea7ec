"""Pipelines: what a person does, from mesh to picture; no physics."""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if __name__ != "zrno.pipelines":
    raise ImportError(f"import this package as zrno.pipelines, not as {__name__}: a bare import poisons numba's cache")

if TYPE_CHECKING:
    from zrno.pipelines.load import load
    from zrno.pipelines.run import run

__all__ = ["load", "run"]


def __getattr__(name: str) -> Any:
    """`run` and `load`, imported when they are asked for: a command's help needs neither."""
    if name not in __all__:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    return getattr(import_module(f"{__name__}.{name}"), name)


class _Package(ModuleType):
    """Importing the submodule `run` binds it to its name in this package; the public name is the function's."""

    def __setattr__(self, name: str, value: Any) -> None:
        if name in __all__ and isinstance(value, ModuleType):
            value = getattr(value, name)
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
