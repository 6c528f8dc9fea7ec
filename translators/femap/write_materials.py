"""Materials as block 401 has them (version 4.41), and the functions that they need."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from zrno.translators.femap import materials as places
from zrno.translators.femap.text_out import line, rows, title
from zrno.translators.law_maps import as_known, hardening_table
from zrno.translators.model import Curve, Floats, Material, Model
from zrno.translators.report import Report

KNOWN = {
    "elastic": ("E", "nu"),
    "orthotropic": ("Ex", "Ey", "Ez", "nu_xy", "nu_yz", "nu_zx", "Gxy", "Gyz", "Gzx"),
    "von_mises": ("E", "nu", "yield_stress", "tangent_modulus", "beta"),
}
_ORTHOTROPIC_2D = {"Ex": 0, "Ey": 1, "nu_xy": 6, "Gxy": 3, "Gzx": 4, "Gyz": 5}
_LAST_IN_401 = sum(places.LINES_401)  # the places before are all in block 401, of those behind few
_TAIL = (5, 5, 5, 5, 1, 5)


class Materials:
    """The materials of a model; curves: those of the model, and what hardening tables add to them."""

    def __init__(self, model: Model, report: Report) -> None:
        self.model, self.report = model, report
        self.curves = dict(model.curves)
        self.of_stress: set[int] = set()  # functions of stress
        self.own = model.format == "femap"
        self.texts = [self._text(material) for material in model.materials.values()]

    def lines(self) -> Iterator[str]:
        """The body of block 401."""
        yield from self.texts

    def _text(self, material: Material) -> str:
        native = material.native if self.own else {}
        kind, values, nonlinear = int(native.get("type", 0)), dict(native.get("values", {})), (0, 0, 0, 0)
        name = f"material {material.id} {material.name}".rstrip()
        eos = self.model.equations_of_state.get(-1 if material.eos is None else material.eos)
        nearest = as_known(material, KNOWN, self.model.curves, eos, self.report, tables=True) if material.law else None
        if nearest is None:
            nonlinear = native.get("nonlinear") or nonlinear
            if material.law:
                self.report.drop("material laws", 1, f"{name}: FEMAP 4.41 has no law like {material.law}")
            elif not self.own:
                self.report.drop("material laws", 1, f"{name}: only its own format knows it")
        elif nearest.law == "orthotropic":
            kind = kind if kind == places.ORTHOTROPIC_2D else places.ORTHOTROPIC_3D
            places_of = _ORTHOTROPIC_2D if kind == places.ORTHOTROPIC_2D else dict(
                zip(KNOWN["orthotropic"], (0, 1, 2, 6, 7, 8, 3, 4, 5), strict=True))  # fmt: skip
            values |= {place: nearest.parameters.get(key, 0.0) for key, place in places_of.items()}
        else:
            kind = places.ISOTROPIC
            modulus, nu = nearest.parameters["E"], nearest.parameters["nu"]
            values |= {place: modulus for place in (0, 1, 2) if place not in values}
            values |= {place: nu for place in (6, 7, 8) if place not in values}
            if nearest.law == "von_mises":
                nonlinear = self._plastic(nearest, material, values, native.get("nonlinear") or nonlinear, name)
        values[places.DENSITY] = material.density
        return self._record(material, kind, values, nonlinear, name)

    def _plastic(
        self, m: Material, given: Material, values: dict[int, float], own: tuple[int, int, int, int], name: str
    ) -> tuple[int, int, int, int]:
        """Slope, yield stress and function; the kinds of nonlinearity."""
        p = m.parameters
        modulus, tangent, beta = p["E"], p.get("tangent_modulus", 0.0), p.get("beta", 1.0)
        hardening = min(places.BETAS, key=lambda code: abs(places.BETAS[code] - beta))
        if places.BETAS[hardening] != beta:
            self.report.approximate("hardening", 1, f"{name}: beta {beta:g} as {places.BETAS[hardening]:g}")
        slope = values.get(places.SLOPE, 0.0)
        if tangent != (modulus * slope / (modulus + slope) if modulus + slope > 0 else 0.0):
            values[places.SLOPE] = modulus * tangent / (modulus - tangent) if tangent < modulus else 0.0
            self.report.approximate("hardening", tangent >= modulus, f"{name}: no hardening, it is not less than E")
        values[places.YIELD] = p.get("yield_stress", 0.0)
        table = hardening_table(m, self.model.curves)
        if table is None or not len(table):
            return own[0] or places.BILINEAR, 0, hardening, 0
        values[places.YIELD] = float(table[0, 1])
        return places.PLASTIC, self._function(table, modulus, own[1], given), hardening, 0

    def _function(self, table: Floats, modulus: float, own: int, material: Material) -> int:
        """The number of the function of stress against strain: the one it came with, if that says the same."""
        known = places.hardening_of(self.curves.get(own), modulus)
        if known is None or not np.array_equal(known, table):
            own = 1 + max(self.curves, default=0)
            points = np.column_stack([table[:, 0] + table[:, 1] / modulus, table[:, 1]])
            self.curves[own] = Curve(
                own, f"hardening of {material.name or material.id}", np.vstack([[0.0, 0.0], points])
            )
        self.of_stress.add(own)
        return own

    def _record(
        self, material: Material, kind: int, values: dict[int, float], nonlinear: tuple[int, int, int, int], name: str
    ) -> str:
        lost = [
            p for p, v in values.items() if v and p >= _LAST_IN_401 and p not in range(places.SLOPE, places.YIELD + 2)
        ]
        self.report.drop("material values", len(lost), f"{name}: block 401 has no known place for them")
        text = [line((material.id, 55, kind, 1, 0)), title(material.name, self.report)]
        at = 0
        for size in places.LINES_401:
            text.append(line([float(values.get(place, 0.0)) for place in range(at, at + size)]))
            at += size
        text += [line([0.0] * size) for size in _TAIL]
        text.append(line([float(values.get(places.SLOPE + i, 0.0)) for i in range(3)]))
        kind_of, function, hardening, criterion = nonlinear
        text += [line([0] * 5), line((0, 0, kind_of, function, hardening, criterion)), line([0.0] * 3)]
        text += [*rows([0.0] * 7, 5), line([0] * 4), line([0] * 4)]
        return "".join(text)
