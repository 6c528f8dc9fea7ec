"""The watch on the energy balance: since when it has been out, also of a run that was resumed so."""

from __future__ import annotations

import re
from typing import Any

import pytest

from zrno.pipelines.balance import Balance


class Made:
    """A solver whose energy balance error is given step by step."""

    def __init__(self, *errors: float, interface: float = 0.0) -> None:
        self.errors = errors
        self.interface = interface
        self.step = 0

    @property
    def time(self) -> float:
        return 0.1 * self.step

    def advance(self) -> None:
        self.step += 1

    def energy_report(self) -> dict[str, float]:
        error = self.errors[self.step]
        return {"balance_error": error, "initial": 1.0, "final": 1.0 + error, "external_work": 0.0}

    def history(self) -> dict[str, float]:
        return {"interface_energy": self.interface}


@pytest.mark.parametrize(
    ("errors", "said"),
    [
        ((0.0, 0.01, 0.05), None),
        ((0.0, 0.01, 0.06, 0.5), "out by 50% of the largest .* it passed 5% at t = 0.2: "),
        ((0.0, 0.06, 0.02, 0.07), "out by 7% of the largest .* it passed 5% at t = 0.3: "),
        ((0.0, 0.06, 0.02), None),
        ((0.0, 0.06, 12.34), "out by 12.3 times the largest .* it passed 5% at t = 0.1: "),
        ((0.1, 0.2), r"it was above 5% when the run was resumed at t = 0:"),
        ((0.1, 0.0, 0.2), "it passed 5% at t = 0.2:"),
        ((0.0, float("nan")), None),
    ],
)
def test_since_when_it_has_been_out(drive: Any, errors: tuple[float, ...], said: str | None) -> None:
    solver = Made(*errors)
    balance = Balance(interval=0.1, step_factor=2.0)
    drive(solver, [balance], len(errors) - 1)
    warning = balance.warning(solver)  # type: ignore[arg-type]
    if said is None:
        assert warning is None
    else:
        assert warning is not None
        assert re.search(said, warning), warning
        assert "step_factor below 2" in warning


@pytest.mark.parametrize(
    ("made", "original", "cause"),
    [
        (0.09, False, "lag between structure and particles"),
        (0.01, False, "step_factor"),
        (0.01, True, "compat=original"),
    ],
)
def test_an_interface_that_makes_the_energy_is_blamed(made: float, original: bool, cause: str) -> None:
    solver = Made(0.1, interface=made)
    balance = Balance(interval=0.1, step_factor=0.8, original=original)
    balance.start(solver)  # type: ignore[arg-type]
    assert cause in (balance.warning(solver) or "")  # type: ignore[arg-type]
