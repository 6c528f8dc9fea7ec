"""What the sections of a scene share: unknown keys are faults, numbers have ranges, faults say what was expected."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, field_validator
from pydantic_core import PydanticCustomError

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class Section(BaseModel):
    """A part of the scene: unknown keys are faults."""

    model_config = ConfigDict(extra="forbid", frozen=True)


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
