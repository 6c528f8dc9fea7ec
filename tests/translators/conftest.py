"""Helpers of the translators' tests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.translators.text import InputError


def _same(a: Any, b: Any) -> bool:
    if is_dataclass(a):
        names = [f.name for f in fields(a) if f.compare and f.name not in ("source", "warnings")]
        return type(a) is type(b) and all(_same(getattr(a, name), getattr(b, name)) for name in names)
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and np.array_equal(a, b)
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, list | tuple):
        return len(a) == len(b) and all(map(_same, a, b))
    return bool(a == b)


@pytest.fixture(scope="session")
def same() -> Callable[[Any, Any], bool]:
    """Equality of models: everything but where items were read and what was remarked."""
    return _same


@pytest.fixture
def faults(tmp_path: Path) -> Callable[..., list[str]]:
    """The faults of a text: `faults(read, text)`, as lines without the file's folder."""

    def of(read: Callable[..., Any], text: str | bytes, name: str = "deck.mcm", **options: Any) -> list[str]:
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        with pytest.raises(InputError) as caught:
            read(path, **options)
        return str(caught.value).replace(f"{tmp_path}/", "").splitlines()

    return of


DECK = """\
{title:78}{version:2}
$ a comment
    {axopt}    0         2         4         4
       1.0       0.8       0.0       0.0
       0.1    4      0.01         0    0       100    0    0
    1    1    0    0    0
    {contact}    2    0    0    0    0    0    0
    0    1   60
{card_7}
* material
    1    1       2.7    0    0       0.0    0       2.0       0.5
       5.4      0.12
elastic
       0.7
      0.33




    2    3       2.7    0    0       0.0    0       0.0       0.0
       5.4      0.12
plastic
       0.7
      0.33
     0.003
      0.01
       0.5
       1.0      0.25
       1    0                 0.0                 0.0                 0.0      1
       2    0                 0.1                 0.0                 0.0      1
       3    7                 0.2                 0.0                 0.0      2
       4    0                 0.3                 0.0             0.1D+00      2
       1      0.01       0.0       0.0
       2      0.01       0.0       0.0
       3       0.0       0.0       0.0
       4       0.0       0.0       0.0
"""


@pytest.fixture
def deck() -> Callable[..., str]:
    """A small deck: `deck()`, or with other values, or with a text replaced: `deck(("old", "new"))`."""

    def make(*replace: tuple[str, str], title: str = "four particles", version: int = 2, axopt: int = 3,
             contact: int = 0, card_7: str = "", end: str = "") -> str:  # fmt: skip
        text = DECK.format(title=title, version=version, axopt=axopt, contact=contact, card_7=card_7)
        for old, new in replace:
            assert text.count(old) >= 1, old
            text = text.replace(old, new, 1)
        return text + end

    return make
