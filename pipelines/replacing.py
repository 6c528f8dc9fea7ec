"""Files that libraries write: under a temporary name in the same folder, renamed when whole.

(Bytes that we have at hand go through `zrno.translators.text.write_atomically`.)
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(target: Path | str) -> Iterator[Path]:
    """A temporary path that takes the target's place when the block ends, and vanishes when the block raises.

    The temporary keeps the target's suffix, by which libraries choose a format, and starts with a dot.
    """
    target = Path(target)
    temporary = target.with_name(f".{os.getpid()}.{target.name}")
    try:
        yield temporary
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def remove_left_overs(directory: Path | str) -> None:
    """Remove the temporary files of processes that were killed while they wrote into a folder, whichever way."""
    for path in Path(directory).glob(".*"):
        if re.match(r"\.\d+\.|\..+\.\d+\.tmp$", path.name):
            path.unlink()
