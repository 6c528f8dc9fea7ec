"""The section `study` of a scene: what varies, what is measured, what it is measured against."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, ValidationInfo, field_validator

from zrno.pipelines.measures import MEASURES, parameters
from zrno.pipelines.quantities import quantity as label
from zrno.pipelines.sections import NotNegative, Positive, Section, wrong
from zrno.pipelines.signals import TAKES
from zrno.solvers.exact import SOLUTIONS
from zrno.translators.calculix import TYPES
from zrno.translators.yaml_marks import Location, did_you_mean

MOST_RUNS = 1000
OF_NODES = ("at", "total")  # measures of nodes that another program prints
Finite = Annotated[float, Field(allow_inf_nan=False)]


def _spelled(value: Any) -> Any:
    """`kinetic` and `kinetic.max` as mappings."""
    if not isinstance(value, str):
        return value
    column, dot, take = value.partition(".")
    return {"column": column} | ({"take": take} if dot else {})


def _named(value: Any) -> Any:
    return {"name": value} if isinstance(value, str) else value


class Quantity(Section):
    """What is measured: a column of history.csv, or a measure of frames (`measures.MEASURES`) with its parameters.

    time: of a measure `last` (default), a time, or `all`, which makes a curve in time; of a column `all` (default),
    `last` or a time. take: a number from the curve in time (`signals.TAKES`). norm: of the difference of two curves.
    """

    column: str | None = None
    measure: str | None = None
    time: NotNegative | Literal["last", "all"] | None = None
    take: str | None = None
    norm: Literal["l2", "max"] = "l2"
    material: int | None = None
    against: int | None = None
    axis: Literal["x", "y", "z"] | None = None
    about: tuple[Finite, Finite, Finite] | None = None
    field: str | None = None
    point: tuple[Finite, Finite, Finite] | None = None
    place: Finite | None = None
    fraction: Annotated[float, Field(gt=0, le=1)] | None = None
    heap: bool | None = None
    link: Positive | None = None
    depth: Positive | None = None
    window: Positive | None = None
    sector: Annotated[float, Field(gt=0, le=360)] | None = None
    bins: Annotated[int, Field(ge=1, le=10_000)] | None = None

    @property
    def given(self) -> dict[str, Any]:
        """The measure's parameters."""
        known = parameters(self.measure) if self.measure in MEASURES else {}
        values = {key: getattr(self, key) for key in known}
        return {key: value for key, value in values.items() if value is not None}

    @property
    def when(self) -> float | str:
        """The time, with its default: all where a curve in time is asked for."""
        return self.time if self.time is not None else "all" if self.column or self.take else "last"

    @property
    def abscissa(self) -> str | None:
        """What the curve is over: `time`, or an axis of a profile; None of a number."""
        if self.measure == "profile":
            return self.axis
        return "time" if self.when == "all" and self.take is None else None

    @property
    def of_nodes(self) -> bool:
        """Whether it is a displacement or reaction of nodes in the last frame, which other programs print, too."""
        known = re.fullmatch(r"(displacement|reaction)_[xyz]", self.field or "")
        return self.measure in OF_NODES and known is not None and self.when == "last" and self.take is None

    @property
    def name(self) -> str:
        """Of the column that a reference file has for it."""
        if self.column:
            return self.column
        return str(self.field if self.measure == "profile" else self.measure)

    def __str__(self) -> str:
        words = [label(self.column or str(self.measure)).label, *(f"{k} {v}" for k, v in self.given.items())]
        words += [f"at t = {self.time:g}"] if isinstance(self.time, float) else []
        return ", ".join([*words, *([self.take] if self.take else [])]).replace("_", " ")

    def faults(self) -> Iterator[tuple[Location, str, str]]:
        """What is wrong with the keys together: location, message, what was expected."""
        if (self.column is None) == (self.measure is None):
            yield (), "a quantity is a column or a measure", "one of the two"
            return
        known: dict[str, bool] = {}
        if self.measure is not None:
            if self.measure not in MEASURES:
                yield ("measure",), f"no measure {self.measure}", did_you_mean(self.measure, MEASURES)
                return
            known = parameters(self.measure)
        for key in sorted(self.model_fields_set - {"column", "measure", "time", "take", "norm", *known}):
            takes = ", ".join(known) or "time and take alone"
            yield (key,), f"{key} is no parameter of {self.measure or 'a column'}", takes
        for key, needed in known.items():
            if needed and getattr(self, key) is None:
                yield (), f"study.quantity.{key} is missing", f"{key}, which {self.measure} needs"
        if self.take is not None and self.take not in TAKES:
            yield ("take",), f"no such number of a curve: {self.take}", did_you_mean(self.take, TAKES)
        if self.take is not None and self.when != "all":
            yield ("time",), "take is of a curve in time", "all, or no time"
        if self.measure == "profile" and self.when == "all":
            yield ("time",), "a profile is of one time", "last or a time"


class Analytic(Section):
    """A closed-form solution (`zrno.solvers.exact`): its name, which of its results, and its parameters."""

    model_config = Section.model_config | {"extra": "allow"}

    name: str
    of: str | None = None

    @property
    def result(self) -> str:
        """The result that is asked for; without a word the first."""
        solution = SOLUTIONS[self.name]
        return self.of or (*solution.SCALARS, *solution.CURVES)[0]

    def solution(self) -> Any:
        """The solution. Raises ValueError for its parameters."""
        given = (self.model_extra or {}).items()
        try:
            return SOLUTIONS[self.name](**{k: v if isinstance(v, str) else float(v) for k, v in given})
        except OverflowError as error:
            raise ValueError(str(error)) from error

    def faults(self) -> Iterator[tuple[Location, str, str]]:
        """As `Quantity.faults`."""
        from dataclasses import MISSING, fields

        if self.name not in SOLUTIONS:
            yield ("name",), f"no closed-form solution {self.name}", did_you_mean(self.name, SOLUTIONS)
            return
        solution, given = SOLUTIONS[self.name], self.model_extra or {}
        results = (*solution.SCALARS, *solution.CURVES)
        if self.result not in results:
            yield ("of",), f"{self.name} has no result {self.of}", did_you_mean(self.result, results)
        known = {f.name: f for f in fields(solution)}
        bad = False
        for key, value in given.items():
            words = "str" in str(known[key].type) if key in known else False
            if key not in known:
                yield (key,), f"{key} is no parameter of {self.name}", did_you_mean(key, known)
            elif words != isinstance(value, str) or not isinstance(value, (int, float, str)):
                yield (key,), f"{key} has a wrong value", "a word" if words else "a number"
            else:
                continue
            bad = True
        for key, own in known.items():
            if own.default is MISSING and key not in given:
                yield (), f"study.analytic.{key} is missing", f"{key}, which {self.name} needs"
                bad = True
        if not bad:
            try:
                self.solution()
            except ValueError as error:
                message, _, expected = str(error).partition("; expected ")
                yield (message.partition(" ")[0],), message, expected


class Peer(Section):
    """Another program on the same meshes, beside ours. ccx: an input file of CalculiX beside the scene, which includes
    `mesh.inp` and prints what is measured at the set AT; elements: types that the meshes are given, one by one, each
    with parameters of the .geo script that its mesh needs.
    """

    ccx: str
    elements: Annotated[dict[str, dict[str, float] | None], Field(min_length=1)]

    def faults(self) -> Iterator[tuple[Location, str, str]]:
        """As `Quantity.faults`."""
        for name in self.elements:
            if name not in TYPES:
                yield ("elements", name), f"no type of elements {name}", did_you_mean(name, TYPES)


class Study(Section):
    """Speed against error: what varies, and what the answers are measured against.

    vary: lists of values by the keys of `--set`; every combination is run, or with `paired` the first values together,
    the second ones together, and so on. reference: a file of columns, or the number itself.
    """

    quantity: Annotated[Quantity, BeforeValidator(_spelled)]
    vary: Annotated[dict[str, Annotated[list[Any], Field(min_length=1)]], Field(min_length=1)]
    tolerance: Positive
    paired: bool = False
    reference: Finite | str | None = None
    analytic: Annotated[Analytic | None, BeforeValidator(_named)] = None
    peer: Peer | None = None

    @field_validator("analytic")
    @classmethod
    def _one_of_two(cls, value: Analytic | None, info: ValidationInfo) -> Analytic | None:
        if value is not None and info.data.get("reference") is not None:
            raise wrong("stands beside study.reference", "one of the two")
        return value

    def faults(self) -> Iterator[tuple[Location, str, str]]:
        """As `Quantity.faults`, of the whole section."""
        for part in ("quantity", "analytic", "peer"):
            section = getattr(self, part)
            for location, message, expected in section.faults() if section is not None else ():
                yield (part, *location), message, expected
        if self.reference is None and self.analytic is None:
            yield (), "nothing to measure against", "reference or analytic"
        if self.peer is not None:
            yield from self._beside()
        yield from self._against()
        yield from self._design()

    def _beside(self) -> Iterator[tuple[Location, str, str]]:
        """What another program can be asked."""
        if not self.quantity.of_nodes:
            yield (
                ("peer",),
                "another program cannot be asked for this quantity",
                "at or total, of displacement_x, reaction_x, ...",
            )
        for key in self.vary:
            if not key.startswith(("numbers.", "meshes.0.numbers.", "fem.")):
                yield ("vary", key), f"the peer's input file cannot follow {key}", "numbers of the mesh, keys of fem"

    def _against(self) -> Iterator[tuple[Location, str, str]]:
        """A number is measured against a number, a curve against a curve."""
        curve = self.quantity.abscissa is not None
        number = "a number: take: last, max, ..." if self.quantity.abscissa == "time" else "a number"
        if isinstance(self.reference, float) and curve:
            yield ("reference",), "a number stands against a curve", f"a file, or a quantity that is {number}"
        if self.analytic is not None and self.analytic.name in SOLUTIONS:
            solution, result = SOLUTIONS[self.analytic.name], self.analytic.result
            if curve and result in solution.SCALARS:
                yield ("analytic",), f"{result} is a number and the quantity a curve", f"a quantity that is {number}"
            if not curve and result in solution.CURVES:
                yield ("analytic",), f"{result} is a curve and the quantity a number", "a quantity that is a curve"

    def _design(self) -> Iterator[tuple[Location, str, str]]:
        """The lists make a design of runs."""
        counts = [len(values) for values in self.vary.values()]
        if self.paired and len(set(counts)) > 1:
            yield ("paired",), f"the lists of vary have {', '.join(map(str, counts))} values", "as many values in each"
        total = 1
        for count in counts:
            total *= 1 if self.paired else count
        if total > MOST_RUNS:
            yield ("vary",), f"{total} runs are too many", f"at most {MOST_RUNS}"
        for key, values in self.vary.items():
            for i, value in enumerate(values):
                if value in values[:i]:
                    yield ("vary", key, i), "the value stands twice", "each value once"
            steps = key.split(".")
            if steps[0] in ("study", "render", "decks") or (steps[0] == "meshes" and len(steps) < 3):
                yield ("vary", key), f"{key} cannot vary", "a key that changes the run"

    def combinations(self) -> list[dict[str, Any]]:
        """The options of each run, the last key fastest."""
        from itertools import product

        lists = self.vary.values()
        rows = zip(*lists, strict=True) if self.paired else product(*lists)
        return [dict(zip(self.vary, row, strict=True)) for row in rows]
