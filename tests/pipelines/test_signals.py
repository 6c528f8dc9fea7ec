"""Numbers of a curve in time, against curves that have them in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zrno.pipelines.signals import TAKES, Unmeasured

TIME = np.linspace(0.0, 10.0, 2001)
PULSE = np.clip(np.minimum((TIME - 2.0) / 0.5, (6.0 - TIME) / 1.0), 0.0, 1.0)  # rises 2 .. 2.5, falls 5 .. 6


def test_ends_extremes_and_mean() -> None:
    uneven = np.array([0.0, 1.0, 4.0])
    value = np.array([0.0, 2.0, -4.0])
    found = {name: TAKES[name](uneven, value) for name in ("last", "max", "min", "mean")}
    assert found == {"last": -4.0, "max": 2.0, "min": -4.0, "mean": pytest.approx((1.0 - 3.0) / 4.0)}
    assert TAKES["mean"](np.zeros(1), np.array([3.0])) == 3.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_pulse_comes_lasts_and_levels(sign: float) -> None:
    assert TAKES["arrival"](TIME, sign * PULSE) == pytest.approx(2.25)
    assert TAKES["duration"](TIME, sign * PULSE) == pytest.approx(5.5 - 2.25)
    overshoot = PULSE + 0.4 * np.exp(-(((TIME - 2.6) / 0.05) ** 2))
    assert TAKES["plateau"](TIME, sign * overshoot) == pytest.approx(sign, abs=0.02)


def test_a_front_that_is_there_from_the_start() -> None:
    assert TAKES["arrival"](TIME, np.cos(TIME / 10.0)) == 0.0


def test_an_oscillation_has_its_period_and_loses_its_amplitude() -> None:
    swing = np.sin(2.0 * math.pi * TIME / 1.25 - 0.3)
    assert TAKES["period"](TIME, 5.0 + swing) == pytest.approx(1.25, rel=1e-3)
    assert TAKES["loss"](TIME, swing) == pytest.approx(0.0, abs=1e-4)
    assert TAKES["loss"](TIME, swing * 0.9 ** (TIME / 1.25)) == pytest.approx(0.1, abs=2e-3)


@pytest.mark.parametrize(
    ("name", "value"),
    [("arrival", 0.0 * TIME), ("duration", TIME), ("period", TIME), ("period", np.ones_like(TIME)), ("loss", TIME)],
)
def test_what_a_run_does_not_show(name: str, value: np.ndarray) -> None:
    with pytest.raises(Unmeasured):
        TAKES[name](TIME, value)
