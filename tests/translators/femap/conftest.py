"""Small FEMAP neutral files, built by hand."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from zrno.translators.femap import read
from zrno.translators.model import Model

CUBE = [
    tuple(map(float, p))
    for p in [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
]


def block(number: int, *lines: str) -> str:
    """A block of lines."""
    return "\n".join(["   -1", f"   {number}", *lines, "   -1", ""])


def nodes(points: list[tuple[float, ...]], systems: dict[int, int] | None = None) -> str:
    """A block of nodes 1, 2, 3, ..."""
    systems = systems or {}
    return block(
        403,
        *(f"{i},0,{systems.get(i, 0)},1,46,0,0,0,0,0,0,{x!r},{y!r},{z!r}," for i, (x, y, z) in enumerate(points, 1)),
    )


def element(number: int, kind: int, topology: int, places: dict[int, int] | list[int], part: int = 1,
            orient: str = "0.,0.,0.,", node: int = 0, flag: int = 0, flags: str = "0," * 16) -> list[str]:  # fmt: skip
    """An element's seven lines; places: node numbers by their places among the 20."""
    filled = [0] * 20
    for place, value in enumerate(places) if isinstance(places, list) else places.items():
        filled[place] = value
    return [f"{number},124,{part},{kind},{topology},1,{node},{flag},", "".join(f"{n}," for n in filled[:10]),
            "".join(f"{n}," for n in filled[10:]), orient, "0.,0.,0.,", "0.,0.,0.,", flags]  # fmt: skip


BRICK = element(1, 25, 8, [1, 2, 3, 4, 5, 6, 7, 8])
MESH = nodes(CUBE) + block(404, *BRICK)


def head(version: str = "4.41") -> str:
    """The first block."""
    return block(100, "<NULL>", f"{version},")


@pytest.fixture(scope="session")
def neu() -> SimpleNamespace:
    """What builds a file's text: `block`, `nodes`, `element`, `head`; a unit cube, a brick, the mesh of both."""
    return SimpleNamespace(block=block, nodes=nodes, element=element, head=head, CUBE=CUBE, BRICK=BRICK, MESH=MESH)


@pytest.fixture
def load(tmp_path: Path) -> Callable[..., Model]:
    """The model of a text: `load(text)` is the text behind the first block; `load(text, "10.0")` of a version."""

    def of(text: str, version: str = "4.41") -> Model:
        (tmp_path / "m.neu").write_bytes((head(version) + text).encode("latin-1"))
        model = read(tmp_path / "m.neu")
        model.warnings = [warning.replace(f"{tmp_path}/", "") for warning in model.warnings]
        return model

    return of
