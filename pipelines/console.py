"""What every command does alike: one JSON object or text on stdout, messages on stderr, exit codes, no traceback."""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

FAILED, BAD_INPUT, NOT_INSTALLED, INTERRUPTED = 1, 2, 3, 130
_STATUS = {FAILED: "failed", BAD_INPUT: "bad input", NOT_INSTALLED: "not installed", INTERRUPTED: "interrupted"}

_answers: list[dict[str, Any]] = []  # of this process: --json promises exactly one


def answered() -> bool:
    """Whether a command has given its result, also where its exit code tells of a fault."""
    return bool(_answers)


@dataclass(slots=True)
class Console:
    """The streams of one command.

    json, verbose, quiet: its options of these names; code: its exit code; known: what of its result is known already,
    told with the errors of a command that fails on its way.
    """

    json: bool = False
    verbose: bool = False
    quiet: bool = False
    code: int = 0
    known: dict[str, Any] = field(default_factory=dict)

    @property
    def progress(self) -> bool:
        """Whether progress may be shown: on a terminal only, and not when asked to be quiet."""
        return sys.stderr.isatty() and not self.quiet

    def note(self, text: str) -> None:
        """A message for the person, not part of the result."""
        if not self.quiet:
            print(text, file=sys.stderr)

    def answer(self, data: dict[str, Any], text: str = "") -> None:
        """The result: `data` as one JSON object with --json, else `text`. Once a command."""
        _answers.append(data)
        if self.json:
            # nan and infinities are not JSON: they become null
            plain = json.loads(json.dumps(data, default=str), parse_constant=lambda _: None)
            print(json.dumps(plain))
        elif text:
            print(text)


@contextmanager
def command(stop: Callable[[int], Exception], *, json: bool, verbose: bool, quiet: bool) -> Iterator[Console]:
    """Run the body of a command: its exceptions become messages and exit codes.

    stop: makes the exception that ends the program with an exit code (`typer.Exit`).
    """
    console = Console(json, verbose, quiet)
    try:
        yield console
    except KeyboardInterrupt:
        _fail(console, INTERRUPTED, ["interrupted"])
    except BrokenPipeError:  # of `zrno info mesh.k | head`: who reads has enough, and what is left goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        console.code = FAILED
    except Exception as error:
        code, lines = explain(error)
        if verbose:
            traceback.print_exc()
        _fail(console, code, lines)
    if console.code:
        raise stop(console.code)


def explain(error: Exception) -> tuple[int, list[str]]:
    """Exit code and message lines of an exception."""
    from zrno.pipelines.errors import Missing, RunFailed
    from zrno.solvers.errors import Diverged
    from zrno.translators.text import InputError

    match error:
        case InputError():
            return BAD_INPUT, [str(fault) for fault in error.faults]
        case Missing():
            return NOT_INSTALLED, [f"error: {error}"]
        case Diverged() | RunFailed():
            return FAILED, [f"error: {error}"]
        case OSError() if error.filename is not None:
            return BAD_INPUT, [f"{error.filename}: error: {(error.strerror or str(error)).lower()}"]
        case ImportError():
            return NOT_INSTALLED, [f"error: {error}"]
        case ValueError():  # what the translators and solvers raise for a request that they cannot meet
            return BAD_INPUT, [f"error: {error}"]
    return FAILED, [f"internal error: {type(error).__name__}: {error} (-v shows where)"]


def _fail(console: Console, code: int, lines: list[str]) -> None:
    console.code = code
    print("\n".join(lines), file=sys.stderr)
    if console.json and not answered():
        known = console.known if code in (FAILED, INTERRUPTED) else {}
        console.answer({**known, "status": _STATUS[code], "errors": lines})
