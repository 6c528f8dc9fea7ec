"""Expressions of parameters: Fortran's arithmetic and functions, by a parser of its own whose work is bounded.

Integers stay integers as in Fortran (1/2 = 0); `**` and `^` are powers; trigonometry is in radians.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping

Value = int | float
_MOST_TOKENS = 2000
_DEEPEST = 40
_LARGEST_INTEGER = 2**63

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+)?)|(?P<name>&?[A-Za-z_]\w*)|(?P<sign>\*\*|[-+*/^(),]))"
)


class BadExpression(ValueError):
    """What is wrong with an expression, for a fault."""


def _sign(a: Value, b: Value) -> Value:
    return abs(a) if b >= 0 else -abs(a)


def _mod(a: Value, b: Value) -> Value:
    rest = math.fmod(a, b)
    return rest if isinstance(a, float) or isinstance(b, float) else int(rest)


def _nearest(x: float) -> int:
    return math.floor(x + 0.5) if x >= 0 else math.ceil(x - 0.5)


_ONE: dict[str, Callable[[Value], Value]] = {
    "abs": abs, "int": int, "nint": _nearest, "aint": lambda x: float(int(x)), "anint": lambda x: float(_nearest(x)),
    "real": float, "float": float, "dble": float, "sqrt": math.sqrt, "exp": math.exp, "log": math.log,
    "ln": math.log, "log10": math.log10, "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin,
    "acos": math.acos, "atan": math.atan, "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh,
    "floor": math.floor, "ceil": math.ceil, "ceiling": math.ceil,
}  # fmt: skip
_TWO: dict[str, Callable[[Value, Value], Value]] = {
    "mod": _mod,
    "atan2": math.atan2,
    "sign": _sign,
    "pow": lambda a, b: _power(a, b),
}
_MANY: dict[str, Callable[..., Value]] = {"min": min, "max": max}


def evaluate(text: str, names: Mapping[str, Value | str]) -> Value:
    """The value of an expression; names: parameters by lower-case name. Raises BadExpression."""
    parser = _Parser(_tokens(text), names)
    try:
        value = parser.sum(0)
        if parser.next() is not None:
            raise BadExpression(f"{parser.next()!r} is not expected there")
        if isinstance(value, complex) or not math.isfinite(value):
            raise BadExpression("the value is not a finite number")
    except ZeroDivisionError as error:
        raise BadExpression("a division by zero") from error
    except (ArithmeticError, ValueError, TypeError) as error:
        raise BadExpression(str(error) or type(error).__name__) from error
    return value


def _tokens(text: str) -> list[tuple[str, str]]:
    found: list[tuple[str, str]] = []
    place, text = 0, text.rstrip()
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None:
            raise BadExpression(f"{text[place:].strip()[:20]!r} is not part of an expression")
        if len(found) == _MOST_TOKENS:
            raise BadExpression("the expression is too long")
        found.append((str(match.lastgroup), match[match.lastgroup or 0]))
        place = match.end()
    if not found:
        raise BadExpression("the expression is empty")
    return found


def _power(a: Value, b: Value) -> Value:
    if isinstance(a, int) and isinstance(b, int) and b >= 0:
        if a not in (-1, 0, 1) and b * abs(a).bit_length() > 128:  # no number that takes long to work out
            return float(float(a) ** float(b))
        return int(a**b)
    result = float(a) ** float(b)
    if isinstance(result, complex):
        raise BadExpression("a root of a negative number")
    return float(result)


class _Parser:
    """Precedence as in Fortran: sums, products, one sign, powers (from the right)."""

    def __init__(self, tokens: list[tuple[str, str]], names: Mapping[str, Value | str]) -> None:
        self.tokens = tokens
        self.names = names
        self.place = 0

    def next(self) -> str | None:
        return self.tokens[self.place][1] if self.place < len(self.tokens) else None

    def take(self, *signs: str) -> str | None:
        sign = self.next()
        if sign in signs:
            self.place += 1
            return sign
        return None

    def sum(self, depth: int) -> Value:
        if depth > _DEEPEST:
            raise BadExpression("too many parentheses")
        value = self.product(depth)
        while sign := self.take("+", "-"):
            right = self.product(depth)
            value = _bounded(value + right if sign == "+" else value - right)
        return value

    def product(self, depth: int) -> Value:
        value = self.signed(depth)
        while sign := self.take("*", "/"):
            right = self.signed(depth)
            if sign == "*":
                value = _bounded(value * right)
            elif isinstance(value, int) and isinstance(right, int):
                quotient = abs(value) // abs(right)
                value = quotient if (value < 0) == (right < 0) else -quotient
            else:
                value = value / right
        return value

    def signed(self, depth: int) -> Value:
        negative = False
        while sign := self.take("+", "-"):
            negative ^= sign == "-"
        value = self.power(depth)
        return -value if negative else value

    def power(self, depth: int) -> Value:
        value = self.atom(depth)
        if self.take("**", "^"):
            if depth > _DEEPEST:
                raise BadExpression("too many powers")
            negative = bool(self.take("-"))
            exponent = self.power(depth + 1)
            value = _bounded(_power(value, -exponent if negative else exponent))
        return value

    def atom(self, depth: int) -> Value:
        if self.place >= len(self.tokens):
            raise BadExpression("the expression ends too early")
        kind, text = self.tokens[self.place]
        self.place += 1
        if kind == "number":
            return int(text) if text.isdigit() and len(text) < 19 else float(text.lower().replace("d", "e"))
        if text == "(":
            value = self.sum(depth + 1)
            self.expect(")")
            return value
        if kind != "name":
            raise BadExpression(f"{text!r} is not expected there")
        name = text.lower().lstrip("&")
        if self.next() == "(" and not text.startswith("&"):
            return self.function(name, depth)
        known = self.names.get(name)
        if isinstance(known, str):
            raise BadExpression(f"parameter {name} is a text")
        if known is None:
            if name == "pi":
                return math.pi
            raise BadExpression(f"parameter {name} is not defined before this line")
        return known

    def function(self, name: str, depth: int) -> Value:
        self.expect("(")
        arguments = [self.sum(depth + 1)]
        while self.take(","):
            arguments.append(self.sum(depth + 1))
        self.expect(")")
        if name in _ONE and len(arguments) == 1:
            return _ONE[name](arguments[0])
        if name in _TWO and len(arguments) == 2:
            return _TWO[name](*arguments)
        if name in _MANY and len(arguments) >= 2:
            return _MANY[name](*arguments)
        raise BadExpression(f"there is no function {name} of {len(arguments)} argument(s)")

    def expect(self, sign: str) -> None:
        if not self.take(sign):
            raise BadExpression(f"{sign!r} is missing")


def _bounded(value: Value) -> Value:
    """An integer that outgrows 64 bits goes on as a real."""
    return float(value) if isinstance(value, int) and abs(value) >= _LARGEST_INTEGER else value
