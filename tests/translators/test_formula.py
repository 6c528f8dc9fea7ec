"""Formulas of the place: what they compute, what they let in, and what they make of hostile text."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zrno.translators.formula import formula, region

PLACES = np.array([[1.0, 2.0, 3.0], [-0.5, 0.25, 0.0], [4.0, 0.0, -1.0]])


@pytest.mark.parametrize(
    ("text", "exact"),
    [
        ("-80 * x / (x**2 + y**2)", lambda x, y, z: -80.0 * x / (x**2 + y**2)),
        (
            "max(x, 0) * sinh(2*y) - min(z, 1e-3)",
            lambda x, y, z: np.maximum(x, 0) * np.sinh(2 * y) - np.minimum(z, 1e-3),
        ),
        ("atan2(y, x) + pi + +abs(-z)", lambda x, y, z: np.arctan2(y, x) + np.pi + np.abs(z)),
        (" 3 ", lambda x, y, z: np.full(3, 3.0)),
    ],
)
def test_a_formula_is_what_it_says(text: str, exact: object) -> None:
    assert np.allclose(formula(text).at(PLACES), exact(*PLACES.T), rtol=1e-14)  # type: ignore[operator]


def test_a_region() -> None:
    assert region("x < 0 or (x > 2 and z <= -1)").at(PLACES).tolist() == [False, True, True]


@pytest.mark.parametrize(
    "text",
    ["", "x y", "t", "x.real", "x[0]", "f(x)", "sqrt(x, y)", "min(x)", "__import__('os')", "x if x else y", "lambda: 1",
     "True", "1j", "'a'", "x < 1", "x // 2", "-" * 400 + "x", "(" * 250 + "x" + ")" * 250, "9" * 400, "x" * 501,
     "x\0", "sqrt(x=1)", "[x]", "1e400"],
)  # fmt: skip
def test_nothing_else_is_let_in(text: str) -> None:
    with pytest.raises(ValueError, match="a formula of numbers"):
        formula(text)
    with pytest.raises(ValueError, match="a region such as"):
        region("x" if text == "x < 1" else text)


def test_a_value_that_is_no_number_is_told_with_its_place() -> None:
    with pytest.raises(ValueError, match=r"1/y is no number at 4, 0, -1"):
        formula("1/y").at(PLACES)
    with pytest.raises(ValueError, match="is no number"):
        formula("sqrt(x)").at(PLACES)


@given(st.text(alphabet="xyz0123456789.eE+-*/(), <>=sqrtcoinhamlgpd&|_'\"[]{}:;\\\n", max_size=60))
def test_no_text_raises_anything_but_a_value_error(text: str) -> None:
    for make in (formula, region):
        try:
            made = make(text)
        except ValueError:
            continue
        try:
            values = made.at(PLACES)
        except ValueError:
            continue
        assert values.shape == (3,)
        assert np.all(np.isfinite(values))
