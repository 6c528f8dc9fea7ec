"""*INCLUDE and its kin: which file a name means, what its frame is, and that it may be read.

A name is sought beside the including file, beside the main deck, then in the folders of *INCLUDE_PATH and
*INCLUDE_PATH_RELATIVE. Files outside the folder of the main deck are refused unless that is allowed.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from zrno.translators.lsdyna.cards import Card
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.expressions import BadExpression
from zrno.translators.lsdyna.frames import KINDS, Frame
from zrno.translators.lsdyna.lexer import Block

_DEEPEST = 30
_MOST_FILES = 2000
_ROOM, _REPEATS = 64 << 20, 20  # bytes that may be read again: so many, and so many times what is there
_LONGEST_NAME = 2000


@dataclass(slots=True)
class Includes:
    """The files of a deck. root: the folder that they may not leave; open: those being read, outermost first."""

    root: Path
    outside: bool
    folders: list[Path] = field(default_factory=list)
    open: list[Path] = field(default_factory=list)
    sizes: dict[Path, int] = field(default_factory=dict)
    files: int = 0
    read: int = 0

    def names(self, block: Block) -> list[tuple[int, str]]:
        """The names under a keyword, with the line of each: one a line, a line that ends with ` +` goes on."""
        found: list[tuple[int, str]] = []
        so_far, start = "", 0
        for row in block.rows(blank=False).tolist():
            text = block.file.words(row).strip()
            if not so_far:
                start = row
            more = text.endswith(" +")
            so_far += text[:-2].rstrip() if more else text
            if not more or len(so_far) > _LONGEST_NAME:
                found.append((start, so_far))
                so_far = ""
        if so_far:
            found.append((start, so_far))
        return found

    def find(self, deck: Deck, block: Block, row: int, name: str) -> Path | None:
        """The file that a name means; None, and a fault, where there is none or it may not be read."""
        folder = self.open[-1].parent
        given = Path(name.strip("\"'").replace("\\", "/"))
        try:
            tried = dict.fromkeys(base / given for base in (folder, self.root, *self.folders))
            path = next((p for p in tried if p.is_file()), None)
        except (OSError, ValueError):
            path = None
        if path is None:
            where = ", ".join(
                dict.fromkeys(str(p.parent) for p in [folder / given, *(b / given for b in self.folders)])
            )
            if deck.partial:
                deck.lacks(f"{block.file.shown}:{row + 1}: the file {name} that is included here is not there")
            else:
                deck.fault(block.file, row, 0, "there is no such file to include", name, f"a file in {where}")
            return None
        real = path.resolve()
        if not self.outside and not real.is_relative_to(self.root.resolve()):
            deck.fault(block.file, row, 0, "an included file is outside the folder of the deck", name,
                       "a file in it (--allow-outside reads it all the same)")  # fmt: skip
            return None
        if real in [p.resolve() for p in self.open]:
            deck.fault(block.file, row, 0, "the file includes itself", name, "files that do not go round in a circle")
            return None
        return self._within_bounds(deck, block, row, path, real)

    def _within_bounds(self, deck: Deck, block: Block, row: int, path: Path, real: Path) -> Path | None:
        """Includes that double at each level would never end: files, levels and bytes are counted."""
        self.files += 1
        size = real.stat().st_size
        self.sizes[real] = size
        self.read += size
        total = sum(self.sizes.values()) if self.read > _ROOM else 0
        if len(self.open) > _DEEPEST or self.files > _MOST_FILES or self.read > _ROOM + _REPEATS * total:
            deck.fault(block.file, row, 0, "too many files are included", path.name,
                       f"at most {_MOST_FILES}, {_DEEPEST} deep")  # fmt: skip
            deck.stop()
        return path

    def add_folders(self, deck: Deck, block: Block, *, relative: bool) -> None:
        """*INCLUDE_PATH: folders to look in; relative ones are beside the main deck."""
        for _, name in self.names(block):
            folder = Path(name.strip("\"'").replace("\\", "/"))
            self.folders.append(self.root / folder if relative or not folder.is_absolute() else folder)


def transformed(deck: Deck, block: Block) -> tuple[int, str, Frame] | None:
    """*INCLUDE_TRANSFORM: line and name of the file, and the frame that it is read in."""
    rows = block.rows().tolist()
    if not rows:
        return None
    name, line = "", rows[0]
    while rows:
        text = block.file.words(rows.pop(0)).strip()
        name += text[:-2].rstrip() if text.endswith(" +") else text
        if not text.endswith(" +"):
            break

    def card(spec: str) -> Card:
        return Card(deck, block, rows.pop(0) if rows else None, spec)

    first = card("off/i*7")
    offsets = dict(zip(KINDS, first.values("off"), strict=False))
    second = card("idroff/i unused prefix/a suffix/a")
    offsets["other"] = second["idroff"]
    if second["prefix"] or second["suffix"]:
        deck.warn(block, "*INCLUDE_TRANSFORM: prefix and suffix of titles are not used")
    third = card("mass time length temperature/a incout/i charge")
    mass, time, length = (third.real(name, 1.0) or 1.0 for name in ("mass", "time", "length"))
    if third["temperature"] not in ("", "0", "0.0", "1", "1.0", "1.") and third["temperature"].strip("0.") != "1":
        deck.warn(block, f"*INCLUDE_TRANSFORM: temperatures are not changed ({third['temperature']})")
    tranid = card("tranid/i").id("tranid", "define")
    if min(mass, time, length) <= 0:
        third.fault("mass", "a factor of *INCLUDE_TRANSFORM is not positive", "positive factors")
        return None
    try:
        frame = deck.frame.inside({k: int(v) for k, v in offsets.items()}, mass, time, length, tranid)
    except BadExpression as error:
        first.fault("off", str(error))
        return None
    return line, name, frame


def shown(path: Path) -> str:
    """A path as messages give it: without the steps back of nested includes."""
    return os.path.normpath(path)
