"""Materials and equations of state as cards: those they were read from where these still say what the model says."""

from __future__ import annotations

from typing import Any

import numpy as np

from zrno.translators.lsdyna import laws
from zrno.translators.lsdyna.cards_out import Card, Writer
from zrno.translators.lsdyna.lexer import Widths
from zrno.translators.model import Eos, Material
from zrno.translators.report import Report

_OF_LAW = {
    "elastic": "MAT_ELASTIC", "rigid": "MAT_RIGID", "soil_foam": "MAT_SOIL_AND_FOAM", "fluid": "MAT_NULL",
    "cap": "MAT_GEOLOGIC_CAP_MODEL", "mohr_coulomb": "MAT_MOHR_COULOMB", "drucker_prager_soil": "MAT_DRUCKER_PRAGER",
    "linear_polynomial": "EOS_LINEAR_POLYNOMIAL", "gruneisen": "EOS_GRUNEISEN", "perfect_gas": "EOS_IDEAL_GAS",
    "murnaghan": "EOS_MURNAGHAN",
}  # fmt: skip


def material(material: Material, writer: Writer, report: Report) -> bytes:
    """A material's keyword; nothing, and an item of the report, where there is none."""
    said = laws.Said(material.law, material.parameters, material.tables, material.curves)
    head = {"mid": material.id, "ro": material.density}
    return _cards(material, said, head, f"material {material.id}", "materials", writer, report)


def equation(eos: Eos, writer: Writer, report: Report) -> bytes:
    """An equation of state's keyword."""
    said = laws.Said(eos.law, eos.parameters)
    return _cards(eos, said, {"eosid": eos.id}, f"equation of state {eos.id}", "equations of state", writer, report)


def _cards(
    item: Material | Eos, said: laws.Said, head: dict[str, Any], place: str, what: str, writer: Writer, report: Report
) -> bytes:
    native = item.native
    keyword = str(native.get("keyword", ""))
    title: list[Card] = [item.name[:80]] if item.name else []
    name_end = "_TITLE" if item.name else ""
    if not said.law and "cards" in native:
        lines = [_with_id(native["cards"][0], item.id, native["widths"]), *native["cards"][1:]]
        return writer.raw(keyword + name_end, native["widths"], [*map(str, title), *lines])
    row = laws.find(keyword) if keyword else None
    if row is not None and "fields" in native and _same(row.said(native["fields"]), said):
        fields = dict(native["fields"])
    else:
        said = _in_dyna(said, place, report)
        row = _row(said, row)
        if row is None:
            report.drop(what, 1, f"{place}: a keyword deck has no law {said.law or 'without a name'}")
            return b""
        fields, lost = row.fields(said)
        if lost:
            report.drop("material parameters", len(lost), f"{place}: {', '.join(lost)}")
    fields |= head
    cards = [*title]
    used: dict[str, int] = {}
    for spec in row.cards:
        own = dict(fields)
        for word in spec.split():
            name, _, count = word.partition("*")
            if isinstance(own.get(name), list):  # a list goes on over several cards
                start = used.get(name, 0)
                own[name] = own[name][start : start + int(count or 1)]
                used[name] = start + int(count or 1)
        cards.append((spec, own))
    while len(cards) > 1 + len(title) and not _given(cards[-1]):
        cards.pop()
    if len(cards) < len(row.cards) + len(title):  # readers count cards: blank ones stand too
        cards += [""] * (len(row.cards) + len(title) - len(cards))
    return writer.keyword(row.keyword + name_end, cards)


def _given(card: Card) -> bool:
    return isinstance(card, str) or any(word.split("/")[0].split("*")[0] in card[1] for word in card[0].split())


def _row(said: laws.Said, own: laws.LawRow | None) -> laws.LawRow | None:
    if own is not None and own.law == said.law and not own.fields(said)[1]:
        return own
    rows = laws.MATERIALS | laws.EQUATIONS
    if said.law == "von_mises":
        isotropic = said.parameters.get("beta", 1.0) == 1.0
        return rows["MAT_PIECEWISE_LINEAR_PLASTICITY" if said.tables or said.curves or isotropic else
                    "MAT_PLASTIC_KINEMATIC"]  # fmt: skip
    if said.law == "hydro":
        spall = any(said.parameters.get(name) for name in ("a1", "a2")) or said.parameters.get("spall", 1.0) != 1.0
        return rows["MAT_ELASTIC_PLASTIC_HYDRO" + ("_SPALL" if spall else "")]
    return rows.get(_OF_LAW.get(said.law, ""))


def _in_dyna(said: laws.Said, place: str, report: Report) -> laws.Said:
    """Laws that LS-DYNA has not, by such as it has."""
    p = said.parameters
    if said.law == "drucker_prager":
        # the cap model without its exponential: sqrt(J2) = alpha + theta I1
        nu = p.get("nu", 0.0)
        found = {
            "K": p["E"] / (3 * (1 - 2 * nu)),
            "G": p["E"] / (2 * (1 + nu)),
            "alpha": p["k"],
            "theta": p.get("alpha", 0.0),
        }
        found |= {name: p[name] for name in ("tension_cutoff", "X0", "W", "D", "R") if name in p}
        report.notes.append(
            f"{place}: Drucker-Prager is written as MAT_GEOLOGIC_CAP_MODEL with alpha = k, theta = alpha"
        )
        return laws.Said("cap", found)
    if said.law == "von_mises_power":
        strain = np.array([0.0, 0.002, 0.01, 0.03, 0.1, 0.2, 0.5, 1.0])
        stress = p["yield_stress"] + p.get("Cy", 0.0) * strain ** p.get("n", 1.0)
        report.approximate("materials", 1, f"{place}: the power of hardening by eight points up to strain 1")
        found = {name: p[name] for name in ("E", "nu", "yield_stress")}
        return laws.Said("von_mises", found, {"hardening": np.column_stack([strain, stress])})
    if said.law == "mie_gruneisen":
        report.approximate("equations of state", 1, f"{place}: as EOS_GRUNEISEN, without cv and T0")
        names = {"C": "C", "S": "S1", "gamma0": "gamma0", "b": "a", "E0": "E0", "V0": "V0"}
        return laws.Said("gruneisen", {new: p[old] for old, new in names.items() if old in p})
    return said


def _same(a: laws.Said, b: laws.Said) -> bool:
    return (
        a.law == b.law
        and a.parameters == b.parameters
        and a.curves == b.curves
        and a.tables.keys() == b.tables.keys()
        and all(np.array_equal(a.tables[name], b.tables[name]) for name in a.tables)
    )


def _with_id(line: str, number: int, widths: str) -> str:
    """A first card with the item's number, which an include may have moved."""
    if "," in line:
        return ",".join([str(number), *line.split(",")[1:]])
    width = Widths(widths).of(10)
    return str(number).rjust(width) + line[width:]
