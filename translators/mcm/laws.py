"""Material laws and equations of state on the cards of an .mcm deck: numbers to parameters and back."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from zrno.translators.mcm import cards as layouts
from zrno.translators.model import Eos, Material, Model, Source
from zrno.translators.report import Report
from zrno.translators.text import Block, Cards, Layout

Values = NDArray[np.float64]  # of the six property cards, (6, 8)


def read_law(model: Model, material: Material, law: str, properties: Block) -> None:
    """A law's parameters and tables from its property cards, into the material; warnings into the model.

    What stands where the law has no parameter goes to `native`, so that the deck is written back as it was.
    """
    values = np.column_stack([properties[f"value_{k}"] for k in range(1, 9)])
    row = layouts.LAWS[law]
    material.law = law
    material.parameters = {name: float(values[card - 1, k - 1]) for name, (card, k) in row.positions.items()}
    used = np.zeros(values.shape, bool)
    for card, k in row.positions.values():
        used[card - 1, k - 1] = True
    path = "" if material.source is None else material.source.file

    def warn(card: int, text: str) -> None:
        model.warnings.append(f"{path}:{properties.line(card - 1)}: {text}")

    def take(position: tuple[int, int]) -> float:
        used[position[0] - 1, position[1] - 1] = True
        return float(values[position[0] - 1, position[1] - 1])

    match law:
        case "von_mises":
            strain, on = take(layouts.FAILURE_STRAIN), take(layouts.FAILURE_SWITCH) == 1.0
            if on:
                material.parameters["failure_strain"] = strain
            elif strain:
                warn(
                    6,
                    f"the failure strain {strain:g} is not used: failure is switched off (first number of the card)",
                )
        case "cap":
            start = take(layouts.CAP_START)
            if start != material.parameters["X0"]:
                warn(5, f"X0 of card 5 ({start:g}) differs from card 4's ({material.parameters['X0']:g}), which counts")
            if material.parameters["tension_cutoff"] > 0:
                cutoff = material.parameters["tension_cutoff"]
                warn(1, f"the tension cut-off {cutoff:g} is a pressure (compression is positive): a run here takes 0")
        case "hydro":
            material.tables |= _table(values, used)
        case "fluid" if material.id > 1 and material.id <= layouts.PROPERTY_CARDS:
            own = values[material.id - 1, :2]
            used[material.id - 1, :2] = True
            if (own != values[0, :2]).any():
                warn(
                    material.id, f"the original program takes a fluid's numbers from card {material.id}, we from card 1"
                )
    kept = np.arange(8) < (8 if law == "hydro" else layouts.KEPT)
    spare = [(int(c), int(k)) for c, k in np.argwhere((values != 0) & ~used)]
    material.native = {f"card {c + 1} value {k + 1}": float(values[c, k]) for c, k in spare}
    for c, k in spare:
        if kept[k]:
            warn(c + 1, f"value {k + 1} ({values[c, k]:g}) is no parameter of the {law} law: kept as it is")


def _table(values: Values, used: NDArray[np.bool_]) -> dict[str, Values]:
    """The hydro law's hardening table: up to 16 pairs of strain and stress, where a stress is given."""
    columns = []
    for first, last in layouts.TABLE_CARDS.values():
        used[first - 1 : last] = True
        columns.append(values[first - 1 : last].ravel())
    table = np.column_stack(columns)
    count = int(np.flatnonzero(table.any(axis=1)).max(initial=-1)) + 1
    return {"hardening": table[:count]} if count else {}


def property_values(material: Material, report: Report) -> Values:
    """The six property cards of a material, (6, 8); what they cannot say goes to the report."""
    row = layouts.LAWS[material.law]
    values = np.zeros((layouts.PROPERTY_CARDS, 8))

    def put(position: tuple[int, int], value: float) -> None:
        values[position[0] - 1, position[1] - 1] = value

    for key, value in material.native.items():
        words = key.split()
        if len(words) == 4 and words[0] == "card":
            put((int(words[1]), int(words[3])), value)
    p = material.parameters
    for name, position in row.positions.items():
        put(position, p.get(name, 0.0))
    said, what = set(row.parameters), f"material {material.id}"
    tables = dict(material.tables)
    match material.law:
        case "von_mises" if "failure_strain" in p:
            put(layouts.FAILURE_SWITCH, 1.0)
            put(layouts.FAILURE_STRAIN, p["failure_strain"])
        case "cap":
            put(layouts.CAP_START, p.get("X0", 0.0))
        case "fluid" if material.id <= layouts.PROPERTY_CARDS:
            values[material.id - 1, :2] = values[0, :2]
        case "hydro" if "hardening" in tables:
            table = tables.pop("hardening")
            most = 16
            report.drop(f"points of the hardening table of {what}", max(len(table) - most, 0), f"past the {most}th")
            for (first, last), column in zip(layouts.TABLE_CARDS.values(), table[:most].T, strict=True):
                values[first - 1 : last].ravel()[: len(column)] = column
    lost = sorted(set(p) - said)
    report.drop(f"parameters of {what}", len(lost), ", ".join(lost))
    report.drop(f"tables of {what}", len(tables), ", ".join(tables))
    return values


def read_eos(cards: Cards, law: str, number: int) -> Eos:
    """An equation of state: its title and its cards."""
    line = cards.next_line
    title = cards.card(layouts.MATERIAL_TITLE, f"title of the equation of state of material {number}")
    parameters: dict[str, float] = {}
    for layout in layouts.EQUATIONS_OF_STATE[law].cards:
        card = cards.card(layout, f"card of the equation of state of material {number}")
        parameters |= {name: card[name] for name in layout.fields}
    name = title.text("material_title")
    return Eos(number, name, law, parameters, source=Source(cards.faults.path, line))


def eos_rows(eos: Eos) -> Iterator[tuple[Layout, dict[str, float]]]:
    """The cards of an equation of state, and their values."""
    for layout in layouts.EQUATIONS_OF_STATE[eos.law].cards:
        yield layout, {name: eos.parameters.get(name, 0.0) for name in layout.fields}
