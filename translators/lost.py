"""What a target without a place for it loses: every filled field that a writer does not name, counted."""

from __future__ import annotations

from collections.abc import Iterable, Sized
from dataclasses import MISSING, fields
from typing import Any

from zrno.translators.report import Report

_SAID_AS = {"native": "numbers that the source's format alone has"}


def report_lost(items: Iterable[Any], said: set[str], what: str, where: str, report: Report) -> None:
    """Note what dataclass items hold beyond the fields `said`: a field that the model gets later is noted of itself.

    A collection counts by its length, anything else that is not its default as one. what: put before the field's name.
    """
    counts: dict[str, int] = {}
    for item in items:
        for f in fields(item):
            default = f.default if f.default_factory is MISSING else f.default_factory()
            if f.name not in said and _is_filled(value := getattr(item, f.name), default):
                counts[f.name] = counts.get(f.name, 0) + (len(value) if _is_list(value) else 1)
    for name, count in counts.items():
        said_as = _SAID_AS.get(name, name.replace("_", " "))
        report.drop(f"{what} {said_as}".strip(), count, where)


def _is_list(value: Any) -> bool:
    return isinstance(value, Sized) and not isinstance(value, str)


def _is_filled(value: Any, default: Any) -> bool:
    if value is None:
        return False
    if _is_list(value):
        return len(value) > 0
    return bool(value) if default is MISSING else bool(value != default)
