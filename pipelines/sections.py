"""What the sections of a scene share: unknown keys are faults, numbers have ranges, faults say what was expected."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, ValidationInfo, field_validator
from pydantic_core import PydanticCustomError

from zrno.translators.text import Fault, InputError

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class Section(BaseModel):
    """A part of the scene: unknown keys are faults."""

    model_config = ConfigDict(extra="forbid", frozen=True)


Kind = TypeVar("Kind", bound=Section)


def section_of_options(section: type[Kind], name: str, options: Mapping[str, Any]) -> Kind:
    """The section that the keys `NAME.*` of `--set` make. Raises InputError."""
    data: dict[str, Any] = {}
    for key, value in options.items():
        *above, last = key.split(".")[1:]
        place = data
        for step in above:
            place = place.setdefault(step, {})
        place[last] = value
    try:
        return section.model_validate(data)
    except ValidationError as error:
        faults = []
        for detail in error.errors():
            at = ".".join([name, *(str(step) for step in detail["loc"])])
            known = detail["type"] != "extra_forbidden"
            message = f"{at} has a wrong value" if known else f"unknown key {at}"
            expected = detail["msg"].removeprefix("Input should be ") if known else ", ".join(section.model_fields)
            faults.append(Fault("--set", 1, 1, message, str(detail["input"]) if known else at, expected))
        raise InputError(faults) from error


def wrong(message: str, expected: str) -> PydanticCustomError:
    """A fault of a value, for a validator to raise."""
    return PydanticCustomError("scene", "{what}", {"what": message, "expected": expected})


class Friction(Section):
    """Coulomb friction: coefficients at rest and in motion."""

    kinetic: NotNegative
    static: NotNegative

    @field_validator("static")
    @classmethod
    def _at_least_kinetic(cls, value: float, info: ValidationInfo) -> float:
        kinetic = info.data.get("kinetic", 0.0)
        if value < kinetic:
            raise wrong("must be >= kinetic", f"at least {kinetic:g}")
        return value
