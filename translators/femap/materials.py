"""Materials (blocks 401 and 601): both generations have the same values, at other places.

A value's place here is its place among the 200 values of block 601. Sources: FemCon (M. Topalovic) and neu2fstr
(FrontISTR) for the places; FEMAP's manual for the kinds of nonlinearity (1 elastic, 2 bilinear, 3 by a function of
stress against strain), of hardening (0 isotropic, 1 kinematic, 2 both) and of yielding (0 von Mises).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from zrno.translators.femap.cursor import Cursor
from zrno.translators.model import Curve, Floats, Material, Model, Source

E, G, NU, DENSITY, SLOPE, YIELD = 0, 3, 6, 49, 84, 85
ISOTROPIC, ORTHOTROPIC_2D, ORTHOTROPIC_3D = 0, 1, 2
_KINDS = {0: "isotropic", 1: "2-D orthotropic", 2: "3-D orthotropic", 3: "2-D anisotropic", 4: "3-D anisotropic",
          5: "hyperelastic"}  # fmt: skip
ELASTIC, BILINEAR, PLASTIC = 1, 2, 3
BETAS = {0: 1.0, 1: 0.0, 2: 0.5}  # of hardening
# lines of block 401 between title and functions: how many numbers each has, all in order from place 0
LINES_401 = (3, 3, 3, 5, 5, 5, 5, 1, 5, 1, 5, 1, 5, 1, 4, 5)
TAIL_401 = 6  # lines behind these that are not needed, then slope and yield stresses
_EXTRA_LINE_VERSION = (4, 5)
_FORMAT_601 = -601


@dataclass(slots=True)
class Record:
    """A material as it stands. values: by place; kind: of the material; nonlinear: kind, function, hardening and yield
    criterion."""

    number: int
    name: str
    kind: int
    source: Source
    subtype: int = 0
    values: dict[int, float] = field(default_factory=dict)
    nonlinear: tuple[int, int, int, int] = (0, 0, 0, 0)
    functions: int = 0  # of temperature, and other

    def __getitem__(self, place: int) -> float:
        return self.values.get(place, 0.0)


def read_401(cursor: Cursor, version: tuple[int, int]) -> list[Record]:
    """Materials of versions 4 to 9."""
    found: list[Record] = []
    while not cursor.done:
        source = cursor.source
        number, _, kind, _, functions = cursor.integers(3, "a material's number", 1, 5)
        record = Record(number, cursor.title(), kind, source)
        values = [value for size in LINES_401 for value in cursor.numbers(size, "a material's values")[:size]]
        record.values = {place: value for place, value in enumerate(values) if value}
        if functions:
            ids = [value for size in LINES_401 for value in cursor.numbers(size, "a material's functions")[:size]]
            record.functions = int(np.count_nonzero(ids))
        cursor.skip(TAIL_401, "a material's values")
        plastic = cursor.numbers(3, "hardening slope and yield stresses")[:3]
        record.values |= {SLOPE + i: value for i, value in enumerate(plastic) if value}
        if version >= _EXTRA_LINE_VERSION:
            cursor.skip(1, "a material's values")
        cursor.skip(1, "a material's values")
        codes = cursor.integers(6, "kinds of nonlinearity")
        record.nonlinear = (codes[2], codes[3], codes[4], codes[5])
        cursor.skip(5, "a material's values")
        found.append(record)
    return found


def read_601(cursor: Cursor) -> list[Record]:
    """Materials of versions 8.1 on: counted flags, integers, values, functions, tables."""
    found: list[Record] = []
    while not cursor.done:
        source = cursor.source
        words = [word for _, word in cursor.lines.fields(cursor.at)]
        if len(words) > 1 and words[1] != b"%d" % _FORMAT_601:
            found.append(_short(cursor, source))
            continue
        number, _, _, kind, subtype, _, own = cursor.integers(4, "a material's number", 1, 7)
        record = Record(number, cursor.title(), kind, source, subtype)
        cursor.values(cursor.count("flags"), "flags")
        codes = cursor.wholes(cursor.count("integers"), "integers") + [0] * 5
        values = cursor.values(cursor.count("values"), "values")
        record.values = {place: value for place, value in enumerate(values) if value}
        functions = cursor.wholes(cursor.count("functions"), "functions") + [0] * 6
        tables = cursor.values(cursor.count("tables"), "tables")
        record.nonlinear = (codes[2], functions[5], codes[3], codes[4])
        record.functions = int(np.count_nonzero(functions) + np.count_nonzero(tables) - (functions[5] != 0)) + own
        for _ in range(min(own, cursor.block.last)):
            cursor.skip(1, "a function")
            cursor.title()
            cursor.records(1, "points")
        found.append(record)
    return found


def _short(cursor: Cursor, source: Source) -> Record:
    """EMSolution's record: numbers and the title on one line, one more line, no values."""
    words = cursor.words("a material")
    if not words[0].isdigit() or len(words[0]) > 15 or int(words[0]) < 1:
        cursor.lines.fail(cursor.at - 1, "not a material's number", words[0], "a number from 1")
    names = [word for word in words if not word.lstrip(b"+-").isdigit()]
    name = b" ".join(names).decode("latin-1")
    cursor.skip(1, "a material's second line")
    return Record(int(words[0]), "" if name == "<NULL>" else name, ISOTROPIC, source)


def fill(records: list[Record], model: Model) -> None:
    """The model's materials; what they have beyond their law stands in `native`."""
    for record in records:
        model.materials[record.number] = _material(record, model)


def _material(record: Record, model: Model) -> Material:
    said: list[str] = []
    material = Material(record.number, record.name, "", record[DENSITY], source=record.source)
    used = {DENSITY}
    if record.kind == ISOTROPIC and record[E] > 0:
        used |= _isotropic(record, material, model, said)
    elif record.kind == ISOTROPIC:
        said.append("has no modulus of elasticity: it has no law")
    elif record.kind in (ORTHOTROPIC_2D, ORTHOTROPIC_3D) and record[E] > 0:
        used |= _orthotropic(record, material, said)
    else:
        said.append(f"is {_KINDS.get(record.kind, f'of kind {record.kind}')}: its values are kept as they stand")
    if record.functions:
        said.append(f"has {record.functions} function(s) of temperature or the like, which are not carried")
    native: dict[str, Any] = {"type": record.kind, "subtype": record.subtype}
    native["values"] = {place: value for place, value in record.values.items() if place not in used}
    native["nonlinear"] = record.nonlinear if any(record.nonlinear) else ()
    material.native = {key: item for key, item in native.items() if item}
    place = f"{record.source.file}:{record.source.line}"
    model.warnings += [f"{place}: material {record.number} {text}" for text in said]
    return material


def _isotropic(record: Record, material: Material, model: Model, said: list[str]) -> set[int]:
    """An isotropic law; the places that it uses."""
    nu = record[NU]
    used = {E, E + 1, E + 2, NU, NU + 1, NU + 2} - {
        place for place in (E + 1, E + 2, NU + 1, NU + 2) if record[place] != record[place - place % 3]
    }
    if nu == 0.0 and record[G] > 0 and record[E] != 2 * record[G]:
        nu = record[E] / (2 * record[G]) - 1
        said.append(f"has no Poisson's ratio: {nu:g} by its shear modulus")
    material.law, material.parameters = "elastic", {"E": record[E], "nu": nu}
    kind, function, hardening, criterion = record.nonlinear
    if kind == 0:
        return used
    if kind == ELASTIC or kind not in (BILINEAR, PLASTIC) or criterion:
        what = "nonlinear elastic" if kind == ELASTIC else f"nonlinear (kind {kind}, yield criterion {criterion})"
        said.append(f"is {what}: its values are kept as they stand")
        material.law, material.parameters = "", {}
        return set()
    slope, stress, modulus = record[SLOPE], record[YIELD], record[E]
    material.law = "von_mises"
    tangent = modulus * slope / (modulus + slope) if modulus + slope > 0 and np.isfinite(modulus * slope) else 0.0
    material.parameters |= {"yield_stress": stress, "tangent_modulus": tangent, "beta": BETAS.get(hardening, 1.0)}
    if kind == PLASTIC and function:
        table = hardening_of(model.curves.get(function), modulus)
        if table is None:
            said.append(f"has a function of stress ({function}) that no hardening table can be made of")
        else:
            material.tables["hardening"] = table
            material.parameters["yield_stress"] = float(table[0, 1])
    if not material.parameters["yield_stress"] > 0:
        said.append("is plastic without a yield stress: its values are kept as they stand")
        material.law, material.parameters, material.tables = "", {}, {}
        return set()
    return used | {YIELD}


def hardening_of(curve: Curve | None, modulus: float) -> Floats | None:
    """Effective plastic strain and yield stress (n, 2) of a curve of strain and stress; None where it is not one."""
    if curve is None or not len(curve.points):
        return None
    points = curve.points[(curve.points != 0).any(axis=1)]
    if not len(points) or points[0, 1] <= 0 or (np.diff(points[:, 0]) <= 0).any() or modulus <= 0:
        return None
    plastic = points[:, 0] - points[:, 1] / modulus
    plastic[np.abs(plastic) <= 1e-9 * np.abs(points[:, 0])] = 0.0
    if not np.isfinite(plastic).all() or (plastic < 0).any() or (np.diff(plastic) < 0).any():
        return None
    return np.column_stack([plastic, points[:, 1]])


def _orthotropic(record: Record, material: Material, said: list[str]) -> set[int]:
    material.law = "orthotropic"
    p = material.parameters
    p |= {"Ex": record[E], "Ey": record[E + 1], "nu_xy": record[NU], "Gxy": record[G]}
    if record.kind == ORTHOTROPIC_2D:
        p |= {"Ez": record[E + 1], "nu_yz": 0.0, "nu_zx": 0.0, "Gyz": record[G + 2], "Gzx": record[G + 1]}
        said.append("is 2-D orthotropic: across the thickness it is taken as along y, without contraction")
        return {E, E + 1, NU, G, G + 1, G + 2}
    p |= {"Ez": record[E + 2], "nu_yz": record[NU + 1], "nu_zx": record[NU + 2]}
    p |= {"Gyz": record[G + 1], "Gzx": record[G + 2]}
    if record[NU + 2] and record[E] != record[E + 2]:
        said.append("is 3-D orthotropic: its third Poisson's ratio is taken as nu_zx")
    return {E, E + 1, E + 2, NU, NU + 1, NU + 2, G, G + 1, G + 2}
