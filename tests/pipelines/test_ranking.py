"""What a study concludes from its rows."""

from __future__ import annotations

from typing import Any

import pytest

from zrno.pipelines import ranking


def row(wall: float, error: float | None, **options: Any) -> dict[str, Any]:
    balance = options.pop("balance_error", 0.0)
    return {"run": f"{wall}", "options": options, "error": error, "wall_seconds": wall, "balance_error": balance}


def test_the_front_and_the_cheapest_that_is_good_enough() -> None:
    rows = [row(4, 0.01), row(1, 0.5), row(3, 0.02), row(2, 0.6), row(3.5, 0.02), row(0.1, None), row(5, 0.3)]
    result = ranking.rank(rows, 0.02)
    assert result["front"] == ["1", "3", "4"]
    assert result["recommended"] is rows[2]
    assert [r["front"] for r in rows] == [True, True, True, False, False, False, False]
    assert [r["recommended"] for r in rows].count(True) == 1
    assert ranking.rank(rows, 0.001)["recommended"] is None


def test_a_run_that_lost_its_energy_is_not_recommended() -> None:
    rows = [row(1, 0.001, balance_error=0.3), row(2, 0.01)]
    assert ranking.rank(rows, 0.1)["front"] == ["2"]


def test_order_of_convergence_is_one_slope_for_all_groups() -> None:
    rows = [row(1, c * h**1.7, step_factor=s, spacing=h) for s, c in ((0.8, 1.0), (0.4, 30.0)) for h in (1, 0.5, 0.2)]
    rows.append(row(1, None, step_factor=0.8, spacing=0.1))
    assert ranking.resolution(rows) == "spacing"
    assert ranking.order_of_convergence(rows) == pytest.approx(1.7)


def test_without_a_spacing_the_step_is_refined_and_without_both_nothing() -> None:
    rows = [row(1, 3 * s**2, step_factor=s, contact=c) for s in (0.8, 0.4) for c in ("kernel", "potential")]
    assert ranking.resolution(rows) == "step_factor"
    assert ranking.order_of_convergence(rows) == pytest.approx(2.0)
    rows = [row(1, 0.1, contact="kernel"), row(1, 0.2, contact="potential")]
    assert (ranking.resolution(rows), ranking.order_of_convergence(rows)) == (None, None)
    assert ranking.order_of_convergence([row(1, 0.1, spacing=1), row(1, None, spacing=2)]) is None
