"""listing.lst: a structure's displacements, reactions and stresses step by step as text, for who reads PAK's .lst.

What stands in it is what PAK lists: nodes with six degrees of freedom, elements with stresses XX YY ZZ XY YZ ZX, in
columns of fixed width; no listing of PAK's was at hand to copy its lines. Stresses are an element's mean (of a shell at
its bottom, middle and top) in global axes, not those of Gauss points in its own, and reactions stand for nodal forces.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.observing import Solver
from zrno.translators.text import write_atomically

FILE = "listing.lst"
_STEP = "STEP NUMBER ="
_SOME = 4096  # rows made to text at once
_STRESSES = ("STRESS-XX", "STRESS-YY", "STRESS-ZZ", "STRESS-XY", "STRESS-YZ", "STRESS-ZX")


class Listing:
    """Observer: a block a step. title: of the deck; resume: keep the blocks up to the solver's step."""

    interval: float | None = None
    exact = False

    def __init__(self, directory: Path | str, title: str, *, resume: bool = False) -> None:
        self._path = Path(directory) / FILE
        self._title = title
        self._resume = resume
        self._last = 0

    def start(self, solver: Solver) -> None:
        """The head, or after a resume what holds of the file."""
        self._last = solver.step
        kept = _until(self._path, solver.step) if self._resume else b""
        write_atomically(self._path, [kept or _head(self._title)])

    def observe(self, solver: Solver) -> None:
        """The block of a step, unless it has one."""
        if solver.step == self._last:
            return
        self._last = solver.step
        with self._path.open("a", encoding="utf-8") as out:
            out.writelines(_block(solver))

    def finish(self, solver: Solver) -> None:
        """The last block."""
        self.observe(solver)


def _head(title: str) -> bytes:
    lines = ["zrno: listing in the manner of PAK", "", title, "",
             "stresses: means of elements (shells: bottom, middle, top), global axes", ""]  # fmt: skip
    return ("\n".join(lines) + "\n").encode()


def _until(path: Path, step: int) -> bytes:
    """What a file holds up to the end of a step; nothing where there is none."""
    if not path.exists():
        return b""
    kept = []
    with path.open("rb") as file:
        for line in file:
            text = line.strip()
            if text.startswith(_STEP.encode()) and int(text.split()[3]) > step:
                break
            kept.append(line)
    return b"".join(kept)


def _block(solver: Solver) -> Iterator[str]:
    frame = solver.frame()
    yield f"\n {_STEP}{solver.step:8d}     TIME ={solver.time:17.9E}\n"
    ids = frame.nodes["id"]
    six = [np.column_stack([frame.nodes[a], _or_zero(frame.nodes, b)])
           for a, b in (("displacement", "rotation"), ("reaction", "moment"))]  # fmt: skip
    yield "\n     D I S P L A C E M E N T S   A N D   R O T A T I O N S\n\n"
    yield from _table("NODE", ("X", "Y", "Z", "ROT-X", "ROT-Y", "ROT-Z"), ids[:, None], six[0])
    held = six[1].any(axis=1)
    yield "\n     R E A C T I O N S\n\n"
    yield from _table("NODE", ("X", "Y", "Z", "MOM-X", "MOM-Y", "MOM-Z"), ids[held][:, None], six[1][held])
    for number, cells in enumerate(frame.cells, 1):
        data = cells.data
        yield f"\n     S T R E S S E S   O F   G R O U P {number:4d}   ({cells.kind})\n\n"
        faces = [name for name in ("stress_bottom", "stress", "stress_top") if name in data]
        rows = np.concatenate([data[name] for name in faces]) if faces else np.zeros((0, 6))
        order = np.arange(len(rows)).reshape(len(faces) or 1, -1).T.ravel()
        place = np.repeat(np.arange(1, len(faces) + 1)[None], len(data["id"]), axis=0).ravel()
        heads = np.column_stack([np.repeat(data["id"], len(faces)), place]) if len(faces) > 1 else data["id"][:, None]
        yield from _table("ELEMENT" + (" LAYER" if len(faces) > 1 else ""), _STRESSES, heads, rows[order])


def _or_zero(arrays: dict[str, NDArray[Any]], name: str) -> NDArray[Any]:
    return arrays.get(name, np.zeros((len(arrays["id"]), 3)))


def _table(first: str, names: Iterable[str], heads: NDArray[Any], values: NDArray[Any]) -> Iterator[str]:
    """A header, then a line a row: whole numbers (n, k) and reals (n, 6)."""
    widths = [10] + [6] * (heads.shape[1] - 1)
    yield first.rjust(sum(widths)) + "".join(name.rjust(15) for name in names) + "\n"
    line = "".join(f"%{w}d" for w in widths) + "%15.6E" * values.shape[1] + "\n"
    for a in range(0, len(values), _SOME):
        some = np.concatenate([heads[a : a + _SOME], values[a : a + _SOME] + 0.0], axis=1)  # no minus before zero
        yield line * len(some) % tuple(some.ravel().tolist())
