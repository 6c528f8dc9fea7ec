"""history.csv: fixed columns first, exact numbers, readable at any moment, whole after a resume."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.history import COLUMNS, History, read_history


def test_columns_units_and_exact_numbers(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [History(tmp_path, units={"time": "ms", "kinetic": "mJ"})], 3)
    columns, units = read_history(tmp_path / "history.csv")
    assert list(columns) == [*COLUMNS, "neighbours"]
    assert units == {"time": "ms", "kinetic": "mJ"}
    np.testing.assert_array_equal(columns["time"], [0.0, 0.1, 0.2, 3 * 0.1])
    np.testing.assert_array_equal(columns["kinetic"], [1 / 3, 4 / 3, 1 / 3 + 2, 1 / 3 + 3])


def test_without_units_and_with_one_row(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [History(tmp_path)], 0)
    columns, units = read_history(tmp_path / "history.csv")
    assert units == {}
    assert columns["active"].tolist() == [40.0]


def test_each_row_is_there_at_once_and_half_a_row_is_passed_over(tmp_path: Path, solver: Any, drive: Any) -> None:
    history = History(tmp_path)
    drive(solver, [history], 2, finish=False)
    path = tmp_path / "history.csv"
    assert len(read_history(path)[0]["time"]) == 3
    with path.open("a") as out:
        out.write("0.30000000000000004,0.1,3.")
    assert len(read_history(path)[0]["time"]) == 3
    history.finish(solver)


def test_a_resumed_run_leaves_the_file_of_an_unbroken_one(tmp_path: Path, solver: Any, drive: Any) -> None:
    drive(solver, [History(tmp_path / "whole")], 6)
    broken, again = type(solver)(), type(solver)()
    first = History(tmp_path / "broken")
    drive(broken, [first], 4, finish=False)
    with (tmp_path / "broken" / "history.csv").open("a") as out:
        out.write("0.5,0.1,")
    again.step = 2
    drive(again, [History(tmp_path / "broken", resume=True)], 4)
    assert (tmp_path / "broken" / "history.csv").read_bytes() == (tmp_path / "whole" / "history.csv").read_bytes()
    first.finish(again)


def test_a_column_that_the_solver_does_not_give_is_nan(tmp_path: Path, solver: Any, drive: Any) -> None:
    solver.history = lambda: {"kinetic": 2.0}
    drive(solver, [History(tmp_path)], 1)
    columns, _ = read_history(tmp_path / "history.csv")
    assert columns["time"].tolist() == [0.0, 0.1]
    assert columns["kinetic"].tolist() == [2.0, 2.0]
    assert np.isnan(columns["internal"]).all()


@pytest.mark.parametrize("text", ["", "time,dt\n", "time,dt\n,\n1,2,3\n", "time,dt\n,\n1,x\n"])
def test_a_file_that_is_no_history_is_named(tmp_path: Path, text: str) -> None:
    path = tmp_path / "history.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"history\.csv"):
        read_history(path)
