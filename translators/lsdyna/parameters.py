"""*PARAMETER: names that stand for numbers, their scopes, and their values in fields.

A parameter of a file is seen by all that is read after it, a `_LOCAL` one by its own file and what that includes.
Values are worked out where they are defined: a definition cannot refer to itself or to what follows it.
"""

from __future__ import annotations

from collections.abc import Mapping

from zrno.translators.lsdyna.expressions import BadExpression, Value, evaluate
from zrno.translators.text import parse_real

_KINDS = "RIC"
_KEEP, _REPLACE, _ERROR = (1, 5), (2, 4), (3,)


class Parameters:
    """The parameters in scope, by lower-case name. duplication: *PARAMETER_DUPLICATION's DFLAG."""

    def __init__(self) -> None:
        self.duplication = 1
        self._global: dict[str, Value | str] = {}
        self._local: list[dict[str, Value | str]] = []

    def enter(self) -> None:
        """A file begins."""
        self._local.append({})

    def leave(self) -> None:
        """It ends: its local parameters are forgotten."""
        self._local.pop()

    @property
    def names(self) -> Mapping[str, Value | str]:
        """All that can be seen here; the innermost file's own come first."""
        seen = dict(self._global)
        for scope in self._local:
            seen |= scope
        return seen

    def define(self, field: str, value: str, *, local: bool, expression: bool) -> str | None:
        """Define a parameter by its name field (type letter and name) and its value's text.

        Returns a remark where it was defined before with another value. Raises BadExpression.
        """
        field = field.strip()
        if field[:1].upper() not in _KINDS or not field[1:].strip():
            raise BadExpression("a parameter begins with R, I or C and has a name")
        kind, name = field[0].upper(), field[1:].strip().lower()
        if len(name.split()) > 1:
            raise BadExpression("a parameter's name has no blanks")
        known = self.names
        worth: Value | str
        if kind == "C":
            worth = value.strip()
        else:
            number = evaluate(value, known) if expression else self.value(value)
            if isinstance(number, str):
                raise BadExpression(f"parameter {name} is to be a number, not a text")
            worth = round(number) if kind == "I" and not expression else int(number) if kind == "I" else float(number)
        scope = self._local[-1] if local and self._local else self._global
        if name in scope and scope[name] != worth:
            if self.duplication in _ERROR:
                raise BadExpression(f"parameter {name} is defined twice")
            if self.duplication not in _REPLACE:
                return f"parameter {name} is defined again: the first value counts"
            scope[name] = worth
            return f"parameter {name} is defined again: the last value counts"
        scope[name] = worth
        return None

    def value(self, text: str) -> Value | str:
        """What a field stands for: a number, `&name`, `-&name`, or `<expression>`. Raises BadExpression."""
        text = text.strip()
        negative = text.startswith("-&")
        if negative or text.startswith("&"):
            name = text.lstrip("-&").strip().lower()
            known = self.names
            if name not in known:
                raise BadExpression(f"parameter {name} is not defined before this line")
            found = known[name]
            if negative:
                if isinstance(found, str):
                    raise BadExpression(f"parameter {name} is a text")
                return -found
            return found
        if text.startswith("<") or text.startswith("-<"):
            body = text.removeprefix("-")
            if not body.endswith(">"):
                raise BadExpression("an expression ends with >")
            number = evaluate(body[1:-1], self.names)
            return -number if text.startswith("-") else number
        whole = text[1:] if text[:1] in ("+", "-") else text
        if whole.isascii() and whole.isdigit() and len(whole) < 19:
            return int(text)
        real = parse_real(text)
        if real is None or real in (float("inf"), float("-inf")):
            raise BadExpression("not a number")
        return real


def is_reference(text: str) -> bool:
    """Whether a field, blanks cut off, stands for a parameter or an expression."""
    return text.startswith(("&", "-&", "<", "-<"))
