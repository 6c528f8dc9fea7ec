"""Cards of materials and equations of state, one place for reader and writer: fields, and laws in the model's words.

A row knows both ways: what its fields say (`said`), and which fields say it (`fields`). LS-DYNA's angles of MAT_173 and
MAT_193 are in radians, the model's in degrees; their shear modulus becomes Young's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from zrno.translators import laws as vocabulary
from zrno.translators.model import Floats

Fields = dict[str, Any]
Parameters = dict[str, float]

# Powers of mass, length, time of the parameters that have units.
_STRESS, _PER_STRESS = (1, -1, -2), (-1, 1, 2)
DIMENSIONS: dict[str, dict[str, tuple[int, int, int]]] = {
    "": dict.fromkeys(
        ("E", "G", "K", "yield_stress", "tangent_modulus", "hardening_modulus", "pressure_cutoff", "c",
         "tension_cutoff", "C0", "C1", "C2", "C3", "E0", "B"), _STRESS,
    ) | {"viscosity": (1, -1, -1), "rate_C": (0, 0, -1)},
    "cap": {"alpha": _STRESS, "gamma": _STRESS, "beta": _PER_STRESS, "D": _PER_STRESS, "X0": _STRESS, "C": _STRESS},
    "soil_foam": {"a0": (2, -2, -4), "a1": _STRESS},
    "gruneisen": {"C": (0, 1, -1), "E0": _STRESS},
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Said:
    """What a material's or an equation's cards say."""

    law: str
    parameters: Parameters
    tables: dict[str, Floats] = field(default_factory=dict)
    curves: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class LawRow:
    """A keyword. number: its other name; cards: layouts; names: parameter -> field; points: table -> its columns;
    curves: parameter -> field of a curve's number; always: parameters that are said where the field is blank too."""

    keyword: str
    number: int
    law: str
    cards: tuple[str, ...]
    names: Mapping[str, str]
    points: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    curves: Mapping[str, str] = field(default_factory=dict)
    always: tuple[str, ...] = ()
    there: Callable[[Parameters], Parameters] | None = None  # after reading
    back: Callable[[Parameters], Parameters] | None = None  # before writing

    def said(self, fields: Fields) -> Said:
        """The model's words for fields."""
        table = vocabulary.LAWS.get(self.law) or vocabulary.EQUATIONS_OF_STATE[self.law]
        parameters: Parameters = {}
        for name, key in self.names.items():
            value = float(fields.get(key, 0.0))
            if value or name in self.always or table.parameters.get(name, 0.0) is None:
                parameters[name] = value
        if self.there is not None:
            parameters = self.there(parameters)
        tables = {}
        for name, (abscissas, ordinates) in self.points.items():
            count = max(len(fields.get(key, ())) for key in (abscissas, ordinates))
            x, y = (np.array(fields.get(key) or [0.0] * count) for key in (abscissas, ordinates))
            used = np.flatnonzero((x != 0) | (y != 0))
            if len(used):
                tables[name] = np.column_stack([x, y])[: used[-1] + 1].astype(float)
        curves = {name: int(fields[key]) for name, key in self.curves.items() if fields.get(key)}
        return Said(self.law, parameters, tables, curves)

    def fields(self, said: Said) -> tuple[Fields, list[str]]:
        """Fields that say it, and the names of what they cannot say."""
        parameters = dict(said.parameters)
        if self.back is not None:
            parameters = self.back(parameters)
        fields: Fields = {key: parameters.pop(name) for name, key in self.names.items() if name in parameters}
        lost = [name for name, value in parameters.items() if value != self._default(name)]
        for name, table in said.tables.items():
            room = self._room(name)
            if len(table) > room:
                lost.append(f"table {name}")
                continue
            for key, column in zip(self.points[name], table.T, strict=True):
                fields[key] = column.tolist() + [0.0] * (room - len(table))
        for name, number in said.curves.items():
            if name in self.curves:
                fields[self.curves[name]] = number
            else:
                lost.append(f"curve {name}")
        return fields, lost

    def _default(self, name: str) -> float | None:
        table = vocabulary.LAWS.get(self.law) or vocabulary.EQUATIONS_OF_STATE[self.law]
        return table.parameters.get(name)

    def _room(self, name: str) -> int:
        """How many points a table may have."""
        if name not in self.points:
            return 0
        key = self.points[name][0]
        return sum(int(item.partition("*")[2] or 1) for card in self.cards for item in card.split()
                   if item.split("*")[0] == key)  # fmt: skip


def _from_shear(parameters: Parameters) -> Parameters:
    """G and angles in radians -> E and angles in degrees."""
    found = dict(parameters)
    found["E"] = 2.0 * found.get("E", 0.0) * (1.0 + found.get("nu", 0.0))
    return found | {name: math.degrees(found[name]) for name in ("phi", "psi") if name in found}


def _to_shear(parameters: Parameters) -> Parameters:
    found = dict(parameters)
    found["E"] = found.get("E", 0.0) / (2.0 * (1.0 + found.get("nu", 0.0)))
    return found | {name: math.radians(found[name]) for name in ("phi", "psi") if name in found}


def _gas(parameters: Parameters) -> Parameters:
    """The heat capacities of an ideal gas -> its exponent."""
    volume, pressure = parameters.pop("gamma", 0.0), parameters.pop("second", 0.0)
    gamma = pressure / volume if volume else 0.0
    return {"gamma": gamma if math.isfinite(gamma) else 0.0} | parameters


def _capacities(parameters: Parameters) -> Parameters:
    found = dict(parameters)
    return found | {"gamma": 1.0, "second": found.get("gamma", 0.0)}


_EN = {"E": "e", "nu": "pr"}
_POINTS_8 = ("eps*8", "es*8")
_SOIL_CARDS = ("eps*8", "eps*2", "p*8", "p*2")

_MATERIALS = (
    LawRow("MAT_ELASTIC", 1, "elastic", ("mid/i ro e pr da db unused",), _EN),
    LawRow("MAT_PLASTIC_KINEMATIC", 3, "von_mises",
           ("mid/i ro e pr sigy etan beta", "src srp fs vp"),
           {**_EN, "yield_stress": "sigy", "tangent_modulus": "etan", "beta": "beta", "failure_strain": "fs",
            "rate_C": "src", "rate_p": "srp"}, always=("beta",)),
    LawRow("MAT_SOIL_AND_FOAM", 5, "soil_foam",
           ("mid/i ro g bulk a0 a1 a2 pc", "vcr ref lcid/i", *_SOIL_CARDS),
           {"G": "g", "K": "bulk", "a0": "a0", "a1": "a1", "a2": "a2", "pressure_cutoff": "pc", "vcr": "vcr",
            "ref": "ref"}, {"pressure": ("eps", "p")}, {"pressure": "lcid"}),
    LawRow("MAT_NULL", 9, "fluid", ("mid/i ro pc mu terod cerod ym pr",),
           {"pressure_cutoff": "pc", "viscosity": "mu", "E": "ym", "nu": "pr"}),
    LawRow("MAT_ELASTIC_PLASTIC_HYDRO", 10, "hydro",
           ("mid/i ro g sigy eh pc fs charl", "eps*8", "eps*8", "es*8", "es*8"),
           {"G": "g", "yield_stress": "sigy", "hardening_modulus": "eh", "pressure_cutoff": "pc",
            "failure_strain": "fs"}, {"hardening": ("eps", "es")}),
    LawRow("MAT_ELASTIC_PLASTIC_HYDRO_SPALL", 10, "hydro",
           ("mid/i ro g sigy eh pc fs charl", "a1 a2 spall", "eps*8", "eps*8", "es*8", "es*8"),
           {"G": "g", "yield_stress": "sigy", "hardening_modulus": "eh", "pressure_cutoff": "pc",
            "failure_strain": "fs", "a1": "a1", "a2": "a2", "spall": "spall"}, {"hardening": ("eps", "es")}),
    LawRow("MAT_RIGID", 20, "rigid",
           ("mid/i ro e pr n couple m alias/a", "cmo con1 con2", "lco a2 a3 v1 v2 v3"), _EN),
    LawRow("MAT_PIECEWISE_LINEAR_PLASTICITY", 24, "von_mises",
           ("mid/i ro e pr sigy etan fail tdel", "c p lcss/i lcsr/i vp", *_POINTS_8),
           {**_EN, "yield_stress": "sigy", "tangent_modulus": "etan", "failure_strain": "fail", "rate_C": "c",
            "rate_p": "p"}, {"hardening": ("eps", "es")}, {"hardening": "lcss", "rate": "lcsr"}),
    LawRow("MAT_GEOLOGIC_CAP_MODEL", 25, "cap",
           ("mid/i ro bulk g alpha theta gamma beta", "r d w x0 c n", "plot ftype vec toff"),
           {"K": "bulk", "G": "g", "alpha": "alpha", "theta": "theta", "gamma": "gamma", "beta": "beta", "R": "r",
            "D": "d", "W": "w", "X0": "x0", "C": "c", "N": "n", "ftype": "ftype", "vec": "vec",
            "tension_cutoff": "toff"}),
    LawRow("MAT_MOHR_COULOMB", 173, "mohr_coulomb",
           ("mid/i ro gmod rnu unused phi cval psi",
            "novoid/i nplanes/i extra/i lccpdr/i lccpt/i lccjdr/i lccjt/i lcsfac/i",
            "gmoddp gmodgr lcgmep lcphiep lcpsiep lcgmst cvalgr aniso", "lcgmt lccvt lcpht epdam1 epdam2"),
           {"E": "gmod", "nu": "rnu", "c": "cval", "phi": "phi", "psi": "psi"}, there=_from_shear, back=_to_shear),
    LawRow("MAT_DRUCKER_PRAGER", 193, "drucker_prager_soil",
           ("mid/i ro gmod rnu rkf phi cval psi", "str_lim", "gmoddp phidp cvaldp psidp gmodgr phigr cvalgr psigr"),
           {"E": "gmod", "nu": "rnu", "shape": "rkf", "c": "cval", "phi": "phi", "psi": "psi"},
           there=_from_shear, back=_to_shear),
)  # fmt: skip

_EQUATIONS = (
    LawRow("EOS_LINEAR_POLYNOMIAL", 1, "linear_polynomial", ("eosid/i c0 c1 c2 c3 c4 c5 c6", "e0 v0"),
           {**{f"C{i}": f"c{i}" for i in range(7)}, "E0": "e0", "V0": "v0"}),
    LawRow("EOS_GRUNEISEN", 4, "gruneisen", ("eosid/i c s1 s2 s3 gamao a e0", "v0 unused lcid/i"),
           {"C": "c", "S1": "s1", "S2": "s2", "S3": "s3", "gamma0": "gamao", "a": "a", "E0": "e0", "V0": "v0"}),
    LawRow("EOS_IDEAL_GAS", 12, "perfect_gas", ("eosid/i cv0 cp0 cl cq t0 v0 vc0", "adiab"),
           {"gamma": "cv0", "second": "cp0", "V0": "v0"}, there=_gas, back=_capacities),
    LawRow("EOS_MURNAGHAN", 19, "murnaghan", ("eosid/i gamma k0 v0",), {"gamma": "gamma", "B": "k0", "V0": "v0"}),
)  # fmt: skip

MATERIALS = {row.keyword: row for row in _MATERIALS}
EQUATIONS = {row.keyword: row for row in _EQUATIONS}


def find(keyword: str) -> LawRow | None:
    """The row of a keyword, also of a numbered one: MAT_024, EOS_1, MAT_010_SPALL."""
    rows = MATERIALS if keyword.startswith("MAT_") else EQUATIONS
    if keyword in rows:
        return rows[keyword]
    _, _, rest = keyword.partition("_")
    number, _, option = rest.partition("_")
    if not (number.isdigit() and number.isascii() and len(number) <= 4):
        return None
    for row in rows.values():
        if (
            row.number == int(number)
            and row.keyword.endswith("_SPALL") == (option == "SPALL")
            and option in ("", "SPALL")
        ):
            return row
    return None


def scaled(said: Said, scale: Callable[[int, int, int], float]) -> Said:
    """The same in other units; scale: the factor of powers of mass, length and time."""
    own = DIMENSIONS.get(said.law, {})
    found = {}
    for name, value in said.parameters.items():
        powers = own.get(name) or (DIMENSIONS[""].get(name) if name not in own else None)
        if said.law in ("cap", "gruneisen", "soil_foam") and name in ("C", "R", "W", "N", "a2") and name not in own:
            powers = None
        found[name] = value * scale(*powers) if powers else value
    tables = {name: table * np.array([1.0, scale(*_STRESS)]) for name, table in said.tables.items()}
    return Said(said.law, found, tables, dict(said.curves))
