"""What can go wrong in a pipeline beyond bad input and a run that diverges."""

from __future__ import annotations


class Missing(RuntimeError):
    """Something optional is not installed; the message says what to install (exit code 3)."""


class RunFailed(RuntimeError):
    """A run that ended before its time for a reason other than divergence (exit code 1)."""
