"""Parameters: definitions, scopes, expressions; and that none of it can be made to hang or to run code."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zrno.translators.lsdyna.expressions import BadExpression, evaluate
from zrno.translators.model import Model
from zrno.translators.text import InputError

Read = Callable[..., Model]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1+2*3", 7), ("7/2", 3), ("-7/2", -3), ("7./2", 3.5), ("2**3**2", 512), ("2^3", 8), ("-2**2", -4),
        ("2**-1", 0.5), ("(1+2)*-3", -9), ("max(1, 2.5, 2)", 2.5), ("mod(-7, 3)", -1), ("sign(3, -1)", -3),
        ("sqrt(2.)", math.sqrt(2)), ("atan2(1.,1.)", math.pi / 4), ("pi", math.pi), ("1.5D+3", 1500.0),
        ("nint(2.5)", 3), ("int(-2.7)", -2), ("&a * b", 12.0), ("A/B", 0.75), ("--3", 3),
        ("cos(0.)", 1.0), ("min(a,b)", 3.0),
    ],
)  # fmt: skip
def test_expressions(text: str, value: float) -> None:
    assert evaluate(text, {"a": 3.0, "b": 4}) == value


@pytest.mark.parametrize(
    "text",
    [
        "", "1/0", "1./0.", "(1", "1)", "1 2", "sqrt(-1.)", "log(0.)", "10.**999", "x", "__import__('os')", "a.b",
        "f(1)", "9**9**9**9", "(" * 100 + "1" + ")" * 100, "1" + "+1" * 5000, "2" + "**2" * 200, "(-8)**0.5", "1e999",
        "max(1)", "lambda: 0", "exp(1000)",
    ],
)  # fmt: skip
def test_bad_expressions(text: str) -> None:
    with pytest.raises(BadExpression):
        evaluate(text, {})


@given(st.text(alphabet="0123456789+-*/^(),.eEdD abcsinmx&<>", max_size=60))
def test_any_text_is_a_number_or_a_bad_expression(text: str) -> None:
    with suppress(BadExpression):
        assert math.isfinite(evaluate(text, {"a": 2, "x": -1.5}))


def _e(model: Model) -> float:
    return model.materials[1].parameters["E"]


MATERIAL = "*MAT_ELASTIC\n         1     1E-09{:>10}       0.3\n"


@pytest.mark.parametrize(
    ("definition", "field"),
    [
        ("*PARAMETER\nR      val     210.0\n", "&val"),
        ("*PARAMETER\nRval,210.\n", "&VAL"),
        ("*PARAMETER\nR    other       1.0R      val      210.\n", "&val"),
        ("*PARAMETER\nI      val      -210\n", "-&val"),
        ("*PARAMETER_LOCAL\nR      val      210.\n", "&val"),
        ("*PARAMETER_EXPRESSION\nR      val  2*(100+5.)\n", "&val"),
        ("*PARAMETER_EXPRESSION\nR      val  2*(100+\n            5.)\n", "&val"),
        ("*PARAMETER\nR        a      70.0\n*PARAMETER_EXPRESSION\nR      val  a*3\n", "&val"),
        ("*PARAMETER\nR        a      70.0\n", "<a*3>"),
        ("*PARAMETER\nR   vals   210.0\n", "&vals"),
        ("*PARAMETER\nR dt     2.1e2\n", "&dt"),
    ],
)  # fmt: skip
def test_a_parameter_stands_for_its_value(deck: Read, definition: str, field: str) -> None:
    assert _e(deck(definition + MATERIAL.format(field))) == 210.0


def test_parameters_in_cards_of_the_mesh(deck: Read) -> None:
    text = "*PARAMETER\nI        n        42R        x       2.5\n*NODE\n" \
        "      &n              &x             -&x         <x*2.>\n*SET_NODE_LIST\n         1\n        &n\n"  # fmt: skip
    model = deck(text)
    assert model.node_ids.tolist() == [42]
    assert model.xyz.tolist() == [[2.5, -2.5, 5.0]]
    assert model.node_sets[0].nodes.tolist() == [0]


def test_an_included_files_parameters_are_seen_after_it_but_not_its_local_ones(deck: Read) -> None:
    part = "*PARAMETER\nR    outer     210.0\n*PARAMETER_LOCAL\nR    inner       1.0\n"
    assert _e(deck("*INCLUDE\npart.k\n" + MATERIAL.format("&outer"), files={"part.k": part})) == 210.0
    with pytest.raises(InputError, match="parameter inner is not defined before this line"):
        deck("*INCLUDE\npart.k\n" + MATERIAL.format("&inner"))


@pytest.mark.parametrize(("flag", "value"), [(None, 1.0), (1, 1.0), (2, 2.0), (4, 2.0), (5, 1.0)])
def test_what_counts_of_a_parameter_that_is_defined_twice(deck: Read, flag: int | None, value: float) -> None:
    policy = "" if flag is None else f"*PARAMETER_DUPLICATION\n{flag:10d}\n"
    text = policy + "*PARAMETER\nR        a       1.0\n*PARAMETER\nR        a       2.0\n"
    model = deck(text + MATERIAL.format("&a"))
    assert _e(model) == value
    assert "parameter a is defined again" in model.warnings[0]


def test_a_parameter_that_may_not_be_defined_twice(deck: Read) -> None:
    with pytest.raises(InputError, match=r":5:.*parameter a is defined twice"):
        deck("*PARAMETER_DUPLICATION\n         3\n*PARAMETER\nR        a       1.0\nR        a       2.0\n")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("*PARAMETER\nR        a        &a\n", "parameter a: parameter a is not defined before this line"),
        ("*PARAMETER_EXPRESSION\nR        a  b\nR        b  a\n", "parameter b is not defined before this line"),
        ("*PARAMETER_EXPRESSION\nR        a  1/0\n", "parameter a:"),
        ("*PARAMETER\nX        a       1.0\n", "a parameter begins with R, I or C"),
        ("*PARAMETER\nR        a      text\n", "parameter a: not a number"),
        (MATERIAL.format("&none"), "parameter none is not defined before this line"),
        (MATERIAL.format("<1/0>"), "a division by zero"),
        ("*PARAMETER\nC        a      text\n" + MATERIAL.format("&a"), "e is not a number"),
    ],
)
def test_faults(deck: Read, text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        deck(text)
    assert message in str(caught.value)
    assert "deck.k:" in str(caught.value)
