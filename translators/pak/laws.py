"""Material models of a PAK deck (cards 11 and 12): their cards, and the laws that they are."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from zrno.translators.laws import bulk_and_shear, engineering
from zrno.translators.model import Floats, Material
from zrno.translators.report import Report
from zrno.translators.text import Block, Card, Cards, Layout

_PAIR = Layout("7e10.0", "x y a_3 a_4 a_5 a_6 a_7")
_COUNT = Layout("2i5", "NTFUN INDEP")
_RAW = Layout("a80", "line")
_CLAY = Layout("3e10.0,2i5,3e10.0", "E nu AT IEL IKRIT m s Sc")
_CLAY_STATE = Layout("5e10.0,i5", "AEM ALAM AKA P0 AEE0 KADMB")
_ELASTIC = Layout("7e10.0", "E nu E_3 E_4 E_5 E_6 E_7")
_CAP_ELASTIC = Layout("6e10.0,i5", "E nu E_3 E_4 E_5 E_6 E_7")
_CAP_FAILURE = Layout("7e10.0", "A B C TETA AT AI1A0 F_7")
_CAP_HARDENING = Layout("7e10.0", "W D R H_4 H_5 H_6 H_7")
_YIELD = Layout("7e10.0", "TAUY CY DUM Y_4 Y_5 Y_6 Y_7")
_POWER = Layout("7e10.0", "AN EM P_3 P_4 P_5 P_6 P_7")
_PLASTIC = (5, 6)


@dataclass(frozen=True, slots=True)
class Fixed:
    """A model whose cards are always the same. names: the law's parameter of a field; other numbers are native."""

    law: str
    cards: tuple[Layout, ...]
    names: dict[str, str]


def _card(names: str) -> Layout:
    words = names.split()
    spare = [f"{words[-1]}_{k}" for k in range(len(words) + 1, 8)]
    return Layout("7e10.0", " ".join([*words, *spare]))


def _same(*names: str) -> dict[str, str]:
    return {name: name for name in " ".join(names).split()}


_ORTHOTROPIC = ("Ex Ey Ez", "nu_xy nu_yz nu_zx", "Gxy Gyz Gzx")
_DRUCKER_PRAGER = Fixed(
    "drucker_prager",
    (_ELASTIC, _CAP_FAILURE, _CAP_HARDENING),
    {**_same("E nu W D R"), "A": "k", "TETA": "alpha", "AT": "tension_cutoff", "AI1A0": "X0"},
)
FIXED = {
    1: Fixed("elastic", (_card("E"), _card("nu")), _same("E nu")),
    2: Fixed("orthotropic", tuple(map(_card, _ORTHOTROPIC)), _same(*_ORTHOTROPIC)),
    7: Fixed(
        "cap",
        (_CAP_ELASTIC, _CAP_FAILURE, _CAP_HARDENING),
        {**_same("E nu W D R"), "A": "alpha", "B": "beta", "C": "gamma", "TETA": "theta", "AT": "tension_cutoff",
         "AI1A0": "X0"},
    ),
    41: _DRUCKER_PRAGER,
    42: Fixed("mohr_coulomb", (_ELASTIC, _card("c phi psi")), _same("E nu c phi psi")),
    49: _DRUCKER_PRAGER,
}  # fmt: skip
# PAK's first position of the cap is an invariant that is positive in tension
_TURNED = ("AI1A0",)
ORTHOTROPIC = (2, 4, 10)  # models with material axes: their groups of solids have a card of axes
_RAW_CARDS = {8: 2, 10: 5, 28: 3, 44: 2, 56: 3, 61: 2}  # models of which the number of cards is all that is known here
_TABLES = {3: 3, 4: 12}  # thermo-elastic: tables, after which a reference temperature stands
MODELS = sorted({*FIXED, *_PLASTIC, *_RAW_CARDS, *_TABLES, 9, 20})
WARM = 3
_WARM_TABLES = ("E", "nu", "expansion")
_WARM_PAIR = Layout("2e10.0", "T value")
_REFERENCE = Layout("7e10.0", "TREF a_2 a_3 a_4 a_5 a_6 a_7")
OF_LAW = {row.law: model for model, row in reversed(FIXED.items())}
CLAY = 9
_CLAY_NAMES = {"AEM": "M", "ALAM": "lambda", "AKA": "kappa", "P0": "pc", "AEE0": "e0"}
OF_LAW |= {"thermo_elastic": WARM, "cam_clay": CLAY, "von_mises": 5, "von_mises_power": 6}


def read_law(cards: Cards, material: Material, model: int, points: int, warn: Callable[[str], None]) -> None:
    """A material's own cards. points: the most that a curve may have (card 11)."""
    if model in FIXED:
        _read_fixed(cards, material, model)
    elif model in _PLASTIC:
        _read_plastic(cards, material, model, warn)
    elif model == WARM:
        _read_warm(cards, material)
    elif model == CLAY:
        _read_clay(cards, material)
    else:
        material.law = ""
        material.native["cards"] = [line.whole().rstrip() for line in _raw_cards(cards, model)]


def _read_fixed(cards: Cards, material: Material, model: int) -> None:
    row = FIXED[model]
    material.law = row.law
    for layout in row.cards:
        card = cards.card(layout, f"a card of material model {model}")
        for name in layout.fields:
            value = card[name]
            if name in row.names:
                material.parameters[row.names[name]] = -value if name in _TURNED and value else value
            elif value:
                material.native[name] = value
    if row.law == "cap":
        E, nu = material.parameters.pop("E"), material.parameters.pop("nu")
        cards.faults.stop()
        if not -1 < nu < 0.5:
            cards.faults.add(material.source.line if material.source else 1, 1, "no such material",
                             f"nu = {nu:g}", "Poisson's ratio between -1 and 0.5")  # fmt: skip
            cards.faults.stop()
        material.native |= {"E": E, "nu": nu}
        K, G = bulk_and_shear(E, nu)
        material.parameters = {"K": K, "G": G, **material.parameters}


def _read_plastic(cards: Cards, material: Material, model: int, warn: Callable[[str], None]) -> None:
    head = cards.card(_COUNT, f"the number of points of material model {model}")
    head.check("NTFUN", head["NTFUN"] > 0, "no points", "1, or the number of points of a table")
    cards.faults.stop()
    elastic = cards.card(_ELASTIC, "E and nu")
    material.law = "von_mises" if model == 5 else "von_mises_power"
    material.parameters = {"E": elastic["E"], "nu": elastic["nu"]}
    material.native |= {name: elastic[name] for name in list(_ELASTIC.fields)[2:] if elastic[name]}
    if head["INDEP"]:
        material.native["INDEP"] = head["INDEP"]
    if head["NTFUN"] > 1:
        count = head["NTFUN"] + (model == 5)  # PAK takes one more than it is told
        block = cards.block(_PAIR, count, "a point of strain and stress")
        cards.faults.stop()
        points = np.column_stack([block["x"], block["y"]])
        material.native |= {"NTFUN": head["NTFUN"], "points": points}
        material.tables["hardening"] = hardening(points, head["INDEP"], elastic["E"])
        material.parameters["yield_stress"] = float(points[0, 1])
        warn("a stress-strain table: PAK ran such a material as if it were elastic; write model 6, or one point")
        if model == 6:
            power = cards.card(_POWER, "exponent and mixed hardening")
            material.native |= {name: power[name] for name in ("AN", "EM") if power[name]}
        return
    stress = cards.card(_YIELD, "yield stress and hardening")
    third = list(_YIELD.fields)[2:]
    material.native |= {name: stress[name] for name in third if stress[name]}
    material.parameters["yield_stress"] = stress["TAUY"]
    if model == 5:
        material.parameters |= {"tangent_modulus": stress["CY"], "beta": 1.0}
        return
    power = cards.card(_POWER, "exponent and mixed hardening")
    material.native |= {name: power[name] for name in list(_POWER.fields)[2:] if power[name]}
    material.parameters |= {"Cy": stress["CY"], "n": power["AN"], "M": power["EM"]}
    if stress["DUM"]:
        warn("a third number on the card of yield stress: PAK takes the law of Simo, of which we know no formula")


def _read_warm(cards: Cards, material: Material) -> None:
    """Tables of E, nu and expansion over temperature, and the reference. Only constants make a law with a name here."""
    what = f"a card of material model {WARM}"
    lines: list[str] = []
    values = {}
    for name in _WARM_TABLES:
        head = cards.card(_COUNT, what)
        head.check("NTFUN", 0 < head["NTFUN"] <= cards.left, "no such number of points", "as many as follow")
        cards.faults.stop()
        block = cards.block(_WARM_PAIR, head["NTFUN"], what)
        cards.faults.stop()
        lines += [head.block.whole().rstrip(), *(block.whole(i).rstrip() for i in range(head["NTFUN"]))]
        values[name] = np.unique(block["value"])
        material.native["NTFUN"] = max(material.native.get("NTFUN", 1), head["NTFUN"])
    last = cards.card(_REFERENCE, what)
    material.native["cards"] = [*lines, last.block.whole().rstrip()]
    material.law = ""
    if all(len(own) == 1 for own in values.values()):
        material.law = "thermo_elastic"
        material.parameters = {name: float(own[0]) for name, own in values.items()}
        material.parameters["reference_temperature"] = last["TREF"]
        material.native["said"] = dict(material.parameters)


def _read_clay(cards: Cards, material: Material) -> None:
    """Cam-clay's two cards. What its switches mean is not known here: with any of them there is no law with a name."""
    what = f"a card of material model {CLAY}"
    first, second = cards.card(_CLAY, what), cards.card(_CLAY_STATE, what)
    blocks = [first.block, second.block]
    if first["IKRIT"] == 1:
        head = cards.card(_COUNT, what)
        blocks += [head.block, *_lines(cards, head, "NTFUN", what)]
    cards.faults.stop()
    material.native["cards"] = [block.whole().rstrip() for block in blocks]
    material.law = ""
    if not any(first[name] for name in ("AT", "IEL", "IKRIT", "m", "s", "Sc")) and not second["KADMB"]:
        material.law = "cam_clay"
        material.parameters = {"E": first["E"], "nu": first["nu"]}
        material.parameters |= {own: second[name] for name, own in _CLAY_NAMES.items()}
        material.native["said"] = dict(material.parameters)


def _raw_cards(cards: Cards, model: int) -> Iterator[Block]:
    """The cards of a model that is kept as it is."""
    what = f"a card of material model {model}"
    if model in _RAW_CARDS:
        for _ in range(_RAW_CARDS[model]):
            yield cards.block(_RAW, 1, what)
    elif model in _TABLES:
        for _ in range(_TABLES[model]):
            head = cards.card(_COUNT, what)
            yield head.block
            yield from _lines(cards, head, "NTFUN", what)
        yield cards.block(_RAW, 1, what)
    elif model == 20:
        head = cards.card(_COUNT, what)
        head.check("NTFUN", head["NTFUN"] == 1, "tables of model 20 are not read", "1")
        cards.faults.stop()
        yield head.block
        for _ in range(4):
            yield cards.block(_RAW, 1, what)


def _lines(cards: Cards, head: Card, name: str, what: str) -> Iterator[Block]:
    head.check(name, 0 < head[name] <= cards.left, "no such number of points", "as many as follow")
    cards.faults.stop()
    for _ in range(head[name]):
        yield cards.block(_RAW, 1, what)


def hardening(points: Floats, kind: int, E: float) -> Floats:
    """A table of strain and stress as effective plastic strain and stress. kind: INDEP, 1: the strain is the total."""
    table = points.copy()
    if kind == 1 and E:
        with np.errstate(over="ignore"):
            table[:, 0] -= table[:, 1] / E
    return table


# Writing


def model_of(material: Material) -> int:
    """The number of PAK's model that says a material; ValueError where none does."""
    native = material.native.get("MOD")
    if material.law == "" and native is not None and "cards" in material.native:
        return int(native)
    if material.law == "von_mises" and material.parameters.get("beta", 1.0) != 1.0:
        return 6
    if material.law not in OF_LAW:
        raise ValueError(f"material {material.id} {material.name}: a PAK deck cannot say the law {material.law!r}")
    if native == 49 and material.law == "drucker_prager":
        return 49
    return OF_LAW[material.law]


def law_rows(material: Material, model: int, report: Report) -> Iterator[tuple[Layout, dict[str, Any]] | str]:
    """A material's own cards: layout and values, or a line as it is; what they cannot say goes to the report."""
    if material.law == "":
        yield from material.native["cards"]
        return
    p, native = dict(material.parameters), material.native
    if model in (WARM, CLAY) and native.get("said") == p:
        yield from native["cards"]
        return
    tables = dict(material.tables)
    what = f"material {material.id} {material.name}".strip()
    if model in _PLASTIC:
        yield from _plastic_rows(material, model, p, what)
        said = {"E", "nu", "yield_stress", "tangent_modulus", "beta", "Cy", "n", "M"}
        tables.pop("hardening", None)
    elif model == WARM:
        yield from _warm_rows(p, what)
        said = {*_WARM_TABLES, "reference_temperature"}
    elif model == CLAY:
        said = {"E", "nu", *_CLAY_NAMES.values()}
        yield _CLAY, {name: _given(p, name, what) for name in ("E", "nu")}
        yield _CLAY_STATE, {name: _given(p, own, what) for name, own in _CLAY_NAMES.items()}
    else:
        row = FIXED[model]
        said = set(row.names.values())
        if material.law == "cap":
            K, G = _given(p, "K", what), _given(p, "G", what)
            E, nu = native.get("E", 0.0), native.get("nu", 0.0)
            p["E"], p["nu"] = (E, nu) if E and bulk_and_shear(E, nu) == (K, G) else engineering(K, G)
            said |= {"K", "G"}
        for layout in row.cards:
            values = {name: native.get(name, 0) for name in layout.fields}
            for name in layout.fields:
                if name in row.names:
                    value = p.get(row.names[name], 0.0)
                    values[name] = -value if name in _TURNED and value else value
            yield layout, values
        for name in ("E", "nu"):
            if name in row.names.values():
                _given(p, name, what)
    lost = sorted(name for name, value in p.items() if name not in said and value and not _is_default(name, value))
    report.drop(f"parameters of {what}", len(lost), ", ".join(lost))
    report.drop(f"tables of {what}", len(tables), ", ".join(tables))


def _plastic_rows(
    material: Material, model: int, p: dict[str, float], what: str
) -> Iterator[tuple[Layout, dict[str, Any]]]:
    native = material.native
    kind, points = native.get("INDEP", 0), native.get("points")
    E = _given(p, "E", what)
    table = material.tables.get("hardening")
    if table is not None and (points is None or not np.array_equal(table, hardening(points, kind, E))):
        raise ValueError(f"{what}: PAK runs a hardening table as if elastic: give it as von_mises_power")
    yield _COUNT, {"NTFUN": native["NTFUN"] if table is not None else 1, "INDEP": kind}
    yield _ELASTIC, {**native, "E": E, "nu": _given(p, "nu", what)}
    if table is not None:
        for strain, stress in native["points"].tolist():
            yield _PAIR, {"x": strain, "y": stress}
        if model == 6:
            yield _POWER, {name: native.get(name, 0.0) for name in ("AN", "EM")}
        return
    yield_stress = _given(p, "yield_stress", what)
    spare = {name: native[name] for name in (*_YIELD.fields, *_POWER.fields) if name in native}
    if material.law == "von_mises":
        tangent = p.get("tangent_modulus", 0.0)
        if model == 5:
            yield _YIELD, {**spare, "TAUY": yield_stress, "CY": tangent}
            return
        if not tangent < E:
            raise ValueError(f"{what}: the tangent modulus is not below E")
        power = {"CY": E * tangent / (E - tangent), "AN": 1.0, "EM": p.get("beta", 1.0)}
    else:
        power = {"CY": p.get("Cy", 0.0), "AN": p.get("n", 1.0), "EM": p.get("M", 1.0)}
    yield _YIELD, {**spare, "TAUY": yield_stress, "CY": power["CY"]}
    yield _POWER, {**spare, "AN": power["AN"], "EM": power["EM"]}


def _warm_rows(p: dict[str, float], what: str) -> Iterator[tuple[Layout, dict[str, Any]]]:
    """Tables of one value each: at two temperatures, so that PAK has something to interpolate between."""
    for name in _WARM_TABLES:
        yield _COUNT, {"NTFUN": 2, "INDEP": 0}
        for temperature in (-1e5, 1e5):
            yield _WARM_PAIR, {"T": temperature, "value": _given(p, name, what)}
    yield _REFERENCE, {"TREF": p.get("reference_temperature", 0.0)}


def _given(p: dict[str, float], name: str, what: str) -> float:
    if name not in p:
        raise ValueError(f"{what}: {name} is not given")
    return p[name]


def _is_default(name: str, value: float) -> bool:
    return name == "ftype" and value == 1.0
