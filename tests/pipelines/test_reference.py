"""References read, quantities measured, errors of known size."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from zrno.pipelines.history import History
from zrno.pipelines.load import Result, load
from zrno.pipelines.reference import Reference, error, measure, read_columns, reference
from zrno.pipelines.series import ResultSeries
from zrno.pipelines.signals import Unmeasured
from zrno.pipelines.study_scene import Quantity, Study
from zrno.translators.text import InputError

X = np.linspace(0.0, 1.0, 101)


def test_errors_of_numbers() -> None:
    assert error(1.1, Reference(number=-1.0)) == pytest.approx(2.1)
    assert error(0.25, Reference(number=0.0)) == 0.25


def test_errors_of_curves() -> None:
    points = (X, np.sin(np.pi * X))
    fine = np.linspace(0.0, 1.0, 10001)
    off = (fine, np.sin(np.pi * fine) + 0.01)
    assert error(off, Reference(points=points)) == pytest.approx(0.01 / math.sqrt(0.5), rel=1e-3)
    assert error(off, Reference(points=points), "max") == pytest.approx(0.01, rel=1e-3)
    assert error((X, 3.0 * X), Reference(function=lambda x: 2.0 * x)) == pytest.approx(0.5)
    assert error((X[::-1], 2.0 * X[::-1]), Reference(points=(X, 2.0 * X))) == pytest.approx(0.0, abs=1e-12)


def test_a_run_that_ends_before_the_reference_is_not_measured() -> None:
    with pytest.raises(Unmeasured, match=r"the run covers 0 to 0\.5, the reference 0 to 1"):
        error((0.5 * X, X), Reference(points=(X, X)))
    assert error((X * (1 - 1e-9), X), Reference(points=(X, X))) < 1e-6


def test_a_table_with_units_comments_and_gaps(tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text("# by hand\ntime, force ,note\nms,N,\n2,4,a\n\n1,2,b\n")
    assert read_columns(path, ["force", "time"]) == [[4.0, 2.0], [2.0, 1.0]]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (b"time,forse\n1,2\n", ":1:1: error: no column force (time,forse); expected forse (did you mean that?)"),
        (b"time,force\n1,2\n3,x\n", ":3:1: error: not a row of numbers (3,x); expected time, force"),
        (b"time,force\n1,2\n3\n", ":3:1: error: not a row of numbers (3); expected time, force"),
        (b"time,force\nms,N\n", ":1:1: error: no rows; expected a row of names, then rows of numbers"),
        (b"# r\n", ":1:1: error: no column time; expected a row of names, then rows of numbers"),
        (b"\xff\xfe", ":1:1: error: not a table; expected a text file in UTF-8"),
    ],
)
def test_a_bad_table_has_its_place(tmp_path: Path, text: bytes, fault: str) -> None:
    path = tmp_path / "r.csv"
    path.write_bytes(text)
    with pytest.raises(InputError) as caught:
        read_columns(path, ["time", "force"])
    assert str(caught.value.faults[0]) == str(path) + fault


def study(quantity: Any, **keys: Any) -> Study:
    return Study(quantity=quantity, vary={"spacing": [1]}, tolerance=0.1, **keys)


def test_references_of_all_kinds(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text("time,kinetic\n2,4\n1,2\n")
    (tmp_path / "n.csv").write_text("kinetic\n3\n")
    curve = reference(study("kinetic", reference="r.csv"), tmp_path).points
    assert curve is not None
    assert [values.tolist() for values in curve] == [[1.0, 2.0], [2.0, 4.0]]
    assert reference(study("kinetic.last", reference="n.csv"), tmp_path).number == 3.0
    with pytest.raises(InputError, match="2 values of a number"):
        reference(study("kinetic.last", reference="r.csv"), tmp_path)
    assert reference(study("kinetic.max", reference=1.5), tmp_path).number == 1.5
    column = {"name": "hydrostatic", "of": "pressure", "density": 2, "gravity": 10, "height": 3}
    profile = {"measure": "profile", "axis": "z", "field": "pressure"}
    function = reference(study(profile, analytic=column), tmp_path).function
    assert function is not None
    assert function(np.array([0.0, 1.0])).tolist() == [60.0, 40.0]
    assert reference(study("kinetic.last", analytic=column | {"of": "bottom"}), tmp_path).number == 60.0


@pytest.fixture
def result(tmp_path: Path, solver: Any, drive: Any) -> Result:
    """Two bodies that fly at each other at 0.5, frames at 0, 0.1 .. 1."""
    drive(solver, [History(tmp_path), ResultSeries(tmp_path, {1: "a", 2: "b"}, interval=None)], 10)
    return load(tmp_path)


def test_quantities_of_a_run(result: Result) -> None:
    start = float(result.arrays(index=0)["position"][:, 0].max())
    mass = {"measure": "centre", "axis": "x", "material": 2}
    where = float(np.mean(result.arrays("mat02_b", 0)["position"][:, 0]))
    for given, value in (
        ("internal.last", 1.0),
        ({"column": "internal", "time": 0.25}, 0.25),
        ({"column": "internal", "time": "last"}, 1.0),
        (mass, where - 0.5),
        (mass | {"time": 0.4}, where - 0.2),
        (mass | {"take": "max"}, where),
        ({"measure": "restitution", "axis": "x", "material": 1}, -1.0),
        ({"measure": "front", "axis": "x", "time": 0.0}, start + 0.5),
    ):
        assert measure(result, study(given, reference=1.0).quantity) == pytest.approx(value, abs=1e-6), given
    time, centre = measure(result, study(mass | {"time": "all"}, reference="r.csv").quantity)  # type: ignore[misc]
    assert centre == pytest.approx(where - 0.5 * time)
    assert measure(result, study("internal", reference="r.csv").quantity)[1] == pytest.approx(time)  # type: ignore[index]


def test_what_a_run_lacks_is_named(result: Result) -> None:
    with pytest.raises(ValueError, match="no column heat; there are: time"):
        measure(result, Quantity(column="heat"))
    with pytest.raises(Unmeasured, match="no frame near t = 9"):
        measure(result, Quantity(measure="length", axis="x", time=9.0))
    with pytest.raises(Unmeasured, match="covers 0 to 1, the reference 4 to 4"):
        measure(result, Quantity(column="kinetic", time=4.0))
