"""The blocks of a FEMAP neutral file.

A block is a line `-1`, its number, records, a line `-1`. A line `-1` also ends lists inside some blocks: what ends a
block is followed by the next block's `-1` and number, or by nothing.
Source: FEMAP neutral file format, versions 4.41 and later (file structure).
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from zrno.translators.femap.lines import Lines

_LONE = re.compile(rb"\d{3,5}")
_KNOWN = {100, *range(401, 500), 506, 507, 533, 601, 615, 822, 918, 919, 1007, 1051}
_WITH_LISTS = {404, 406, 407, 408, 420, 506, 507, 1007}  # whose lists may end with lines that are -1 alone


@dataclass(frozen=True, slots=True)
class Block:
    """number: which kind of data; head: the line of the number; first..last (excluded): its lines, from 0."""

    number: int
    head: int
    first: int
    last: int

    def whole(self, lines: Lines) -> bool:
        """Whether a line -1 ends it, and not the end of the file."""
        return self.last < len(lines)


def blocks(lines: Lines) -> list[Block]:
    """The blocks of a file in its order; notes what is wrong between them."""
    filled = np.flatnonzero(~lines.blank)
    marks = np.flatnonzero(np.isin(filled, lines.marks(), assume_unique=True)).tolist()
    is_mark = np.zeros(len(filled) + 2, bool)
    is_mark[marks] = True
    if not marks or marks[0] != 0:
        lines.fault(int(filled[0]) if len(filled) else 0, 1, "not the start of a block", expected="a line -1")
        lines.faults.stop()
    found: list[Block] = []
    number, head = 0, 0  # of the block that is open: 0 where none is
    skip = -1

    def number_at(place: int) -> int:
        words = lines.words(int(filled[place])) if place < len(filled) and not is_mark[place] else []
        match = _LONE.fullmatch(words[0]) if len(words) == 1 else None
        return int(match[0]) if match else 0

    for at in marks:
        if at <= skip:
            continue
        begin = at  # the place of the -1 that starts the next block
        if number:
            here = int(filled[at])
            twice = is_mark[at + 1] and (number_at(at + 2) > 0 or number not in _WITH_LISTS)
            if at + 1 == len(filled) or twice:
                begin = at + 1
            elif number_at(at + 1) in _KNOWN and not is_mark[at - 1]:
                lines.fault(here, 1, f"block {number} does not end", expected="a line -1 before this one")
            else:
                continue
            found.append(Block(number, head, head + 1, here))
            number = 0
        if begin >= len(filled):
            break
        number, skip = number_at(begin + 1), begin
        head = int(filled[begin + 1]) if begin + 1 < len(filled) else len(lines)
        if not number:
            said = lines.text(head) if head < len(lines) else ""
            lines.fault(head, 1, "not the number of a block", said, "100, 401, 403, ...")
    if number:
        found.append(Block(number, head, head + 1, len(lines)))
    return found
