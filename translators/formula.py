"""Formulas of the place in settings: `-80 * x / (x**2 + y**2)` for a velocity, `x < 0` for a region.

They are Python expressions of numbers, x, y, z, pi and the functions below, read as a tree and computed on whole
arrays; nothing else of Python is let in.
"""

from __future__ import annotations

import ast
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.model import Floats

LONGEST = 500  # characters
DEEPEST = 250  # operations within each other
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "sin": np.sin, "cos": np.cos, "tan": np.tan, "sinh": np.sinh,
    "cosh": np.cosh, "tanh": np.tanh, "atan2": np.arctan2, "abs": np.abs, "min": np.minimum, "max": np.maximum,
}  # fmt: skip
_TWO = ("atan2", "min", "max")  # functions of two
_NAMES = ("x", "y", "z", "pi")
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide, ast.Pow: np.power,
    ast.USub: np.negative, ast.UAdd: np.positive,
}  # fmt: skip
_COMPARISONS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Lt: np.less, ast.LtE: np.less_equal, ast.Gt: np.greater, ast.GtE: np.greater_equal,
    ast.And: np.logical_and, ast.Or: np.logical_or,
}  # fmt: skip
EXPECTED = f"a formula of numbers, {', '.join(_NAMES)}, + - * / **, and {', '.join(FUNCTIONS)}"
EXPECTED_REGION = "a region such as x < 0 or (x > 1 and y <= 2), its sides formulas of x, y and z"


@dataclass(frozen=True, slots=True)
class Formula:
    """A formula as it was said. Made by `formula` or `region`, which know that it is one."""

    text: str

    def __str__(self) -> str:
        return self.text

    def at(self, x: Floats) -> NDArray[Any]:
        """Its values at places x (n, 3), shape (n,): numbers, or of a region whether they lie in it.

        Raises ValueError where a value is no finite number.
        """
        places = {"x": x[:, 0], "y": x[:, 1], "z": x[:, 2], "pi": np.pi}
        with np.errstate(all="ignore"):
            values = np.broadcast_to(_value(_tree(self.text), places), (len(x),))
        wrong = np.flatnonzero(~np.isfinite(values))
        if len(wrong):
            where = ", ".join(f"{coordinate:.6g}" for coordinate in x[wrong[0]])
            raise ValueError(f"{self.text} is no number at {where}")
        return values


def formula(text: str) -> Formula:
    """A formula whose values are numbers. Raises ValueError(what is expected)."""
    try:
        _check(_tree(text), boolean=False)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError(EXPECTED) from None
    return Formula(text)


def region(text: str) -> Formula:
    """A formula that says of a place whether it belongs to a region. Raises ValueError(what is expected)."""
    try:
        _check(_tree(text), boolean=True)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError(EXPECTED_REGION) from None
    return Formula(text)


def _tree(text: str) -> ast.expr:
    if len(text) > LONGEST:
        raise ValueError
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ast.parse(text.strip(), mode="eval").body


def _check(node: ast.expr, *, boolean: bool, depth: int = DEEPEST) -> None:
    """ValueError for what is neither a number nor, where boolean, a comparison."""
    if depth == 0:
        raise ValueError
    below = depth - 1
    match node:
        case ast.BoolOp(values=values) if boolean:
            for value in values:
                _check(value, boolean=True, depth=below)
        case ast.Compare(left=left, ops=[op], comparators=[right]) if boolean and type(op) in _COMPARISONS:
            _check(left, boolean=False, depth=below)
            _check(right, boolean=False, depth=below)
        case _ if boolean:
            raise ValueError
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool) and abs(value) < 1e300:
            pass
        case ast.Name(id=name) if name in _NAMES:
            pass
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
            _check(operand, boolean=False, depth=below)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            _check(left, boolean=False, depth=below)
            _check(right, boolean=False, depth=below)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in FUNCTIONS:
            if len(args) != (2 if name in _TWO else 1):
                raise ValueError
            for arg in args:
                _check(arg, boolean=False, depth=below)
        case _:
            raise ValueError


def _value(node: Any, places: dict[str, Any]) -> Any:
    """Of a tree that was checked."""
    match node:
        case ast.BoolOp(op=op, values=values):
            found = _value(values[0], places)
            for value in values[1:]:
                found = _COMPARISONS[type(op)](found, _value(value, places))
            return found
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            return _COMPARISONS[type(op)](_value(left, places), _value(right, places))
        case ast.Constant(value=int() | float() as value):
            return np.float64(value)
        case ast.Name(id=name):
            return places[name]
        case ast.UnaryOp(op=op, operand=operand):
            return _OPERATORS[type(op)](_value(operand, places))
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATORS[type(op)](_value(left, places), _value(right, places))
        case ast.Call(func=ast.Name(id=name), args=args):
            return FUNCTIONS[name](*(_value(arg, places) for arg in args))
    raise AssertionError(ast.dump(node))
