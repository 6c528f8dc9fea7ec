"""What energy a run began with and has handled: the balance is taken of the largest, not of the little that is left."""

from __future__ import annotations

from typing import Any

import numpy as np

from .state import Floats

# what the fixed columns do not have, each a column of its own at the end of the history
STORED = ("contact_energy", "contact_dissipated", "artificial_energy", "relaxation_dissipated")


def total(energies: dict[str, float]) -> float:
    """What stays constant."""
    stored = sum(energies[name] for name in STORED)
    return energies["kinetic"] + energies["internal"] + stored - energies["external_work"] + energies.get("absent", 0.0)


class Ledger:
    """Energies at the start, and the largest since: what leaves a run takes its own along, not the errors it has made.

    largest: kinetic, internal or work from outside; work: from outside alone. Energies are those of `measures`.
    """

    def __init__(self, start: dict[str, float]) -> None:
        self.start = start
        self.work = 0.0
        self.largest = start["kinetic"]

    def note(self, now: dict[str, float]) -> None:
        """Energies of another moment."""
        self.work = max(self.work, abs(now["external_work"]))
        self.largest = self._scale(now)

    def _scale(self, now: dict[str, float]) -> float:
        return max(self.largest, now["kinetic"], abs(now["internal"]), abs(now["external_work"]))

    def made(self, now: dict[str, float]) -> float:
        """What has come from nowhere."""
        return total(now) - total(self.start)

    def report(self, now: dict[str, float]) -> dict[str, float]:
        """Energies at the start and now.

        balance_error is relative to the largest of kinetic, internal and external work so far.
        """
        return {
            "initial": total(self.start) + self.start["external_work"],
            "final": total(now) + now["external_work"],
            "kinetic": now["kinetic"],
            "internal": now["internal"],
            "external_work": now["external_work"],
            "dissipated": now["dissipated"],
            "balance_error": abs(self.made(now)) / max(self._scale(now), 1e-300),
        }

    def kept(self) -> dict[str, Any]:
        """What a checkpoint holds of it."""
        start = np.array([self.start[name] for name in sorted(self.start)])
        return {"start_energy": start, "handled": np.array([self.work, self.largest])}

    def restore(self, data: dict[str, Any]) -> None:
        """Go on from a checkpoint."""
        values: Floats = np.asarray(data["start_energy"])
        self.start = dict(zip(sorted(self.start), values.tolist(), strict=True))
        self.work, self.largest = np.asarray(data["handled"]).tolist()
