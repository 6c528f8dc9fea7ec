"""Cards of parts and sections, one place for reader and writer: their fields, and what they say."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

PARTS_CARD = "pid/i secid/i mid/i eosid/i hgid/i grav/i adpopt/i tmid/i"
_LARGEST = 1e60  # its fourth power is a number still
Fields = Mapping[str, Any]

_PLANES = {12: "stress", 13: "strain", 14: "axisymmetric", 15: "axisymmetric"}
# Second cards of beams by element formulation; 1 stands for those that are not named.
_BEAM_CARDS = {
    1: "ts1 ts2 tt1 tt2 nsloc ntloc",
    2: "a iss itt j sa ist",
    3: "a rampt stress",
    6: "vol iner cid/i ca offset rrcon srcon trcon",
    9: "ts1 ts2 tt1 tt2 print unused itoff",
    12: "a iss itt j sa ist",
}


@dataclass(frozen=True, slots=True)
class SectionRow:
    """A kind of section. names: model parameter -> field; powers: of a length, for changes of units."""

    keyword: str
    kind: str
    cards: tuple[str, ...]
    names: Mapping[str, str] = field(default_factory=dict)
    powers: Mapping[str, int] = field(default_factory=dict)

    def cards_of(self, elform: int) -> tuple[str, ...]:
        """Layouts of its cards for an element formulation."""
        if self.kind == "beam":
            return (self.cards[0], _BEAM_CARDS.get(elform, _BEAM_CARDS[1]))
        return self.cards

    def parameters(self, fields: Fields) -> dict[str, float]:
        """The parameters of `model.Section`."""
        found = {name: float(fields[key]) for name, key in self.names.items() if fields.get(key)}
        if self.kind == "shell":
            found |= _thicknesses(fields)
        elif self.kind == "beam":
            found |= _beam(fields)
        return found

    def plane(self, fields: Fields) -> str:
        """Which plane problem a shell's formulation is of."""
        return _PLANES.get(int(fields.get("elform", 0)), "") if self.kind == "shell" else ""

    def family(self, fields: Fields) -> str:
        """The family of its elements."""
        return "truss" if self.kind == "beam" and fields.get("elform") == 3 else self.kind


def _thicknesses(fields: Fields) -> dict[str, float]:
    given = [float(fields.get(f"t{i}", 0.0)) for i in range(1, 5)]
    values = [value or given[0] for value in given]
    if not any(values):
        return {}
    if len(set(values)) == 1:
        return {"thickness": values[0]}
    return {f"thickness_{i}": value for i, value in enumerate(values, 1)}


def _beam(fields: Fields) -> dict[str, float]:
    names = {"area": "a", "iyy": "iss", "izz": "itt", "j": "j", "shear_area_y": "sa"}
    found = {name: float(fields[key]) for name, key in names.items() if fields.get(key)}
    s, t = float(fields.get("ts1", 0.0)), float(fields.get("tt1", 0.0))
    if 0 < s < _LARGEST and t < _LARGEST and "area" not in found:
        if fields.get("cst") == 1:  # a tube: outer and inner diameter
            second = math.pi / 64 * (s**4 - t**4)
            found |= {"area": math.pi / 4 * (s**2 - t**2), "iyy": second, "izz": second, "j": 2 * second}
        elif t > 0 and not fields.get("cst"):
            found |= {"area": s * t, "iyy": s * t**3 / 12, "izz": t * s**3 / 12}
    return found


_LENGTHS = dict.fromkeys(("t1", "t2", "t3", "t4", "ts1", "ts2", "tt1", "tt2", "sphini", "ca"), 1)
_SHELL_CARD = "secid/i elform/i shrf nip/i propt qr/a icomp/i setyp/i"

_ROWS = (
    SectionRow("SECTION_SOLID", "solid", ("secid/i elform/i aet/i unused*3 cohoff gaskeit",)),
    SectionRow("SECTION_SHELL", "shell", (_SHELL_CARD, "t1 t2 t3 t4 nloc marea idof edgset/i"),
               {"shear_factor": "shrf", "integration_points": "nip"}, _LENGTHS),
    SectionRow("SECTION_TSHELL", "tshell", ("secid/i elform/i shrf nip/i propt qr/a icomp/i tshear/i",),
               {"shear_factor": "shrf", "integration_points": "nip"}),
    SectionRow("SECTION_BEAM", "beam", ("secid/i elform/i shrf qr/a cst scoor nsm naupd/i", ""),
               {"shear_factor": "shrf"}, _LENGTHS | {"a": 2, "sa": 2, "iss": 4, "itt": 4, "ist": 4, "j": 4, "vol": 3}),
    SectionRow("SECTION_SPH", "sph", ("secid/i cslh hmin hmax sphini death start sphkern/i",),
               {"h_factor": "cslh", "h_min": "hmin", "h_max": "hmax", "h": "sphini"}, _LENGTHS),
    SectionRow("SECTION_DISCRETE", "spring", ("secid/i dro/i kd v0 cl fd", "cdl tdl")),
)  # fmt: skip
SECTIONS = {row.keyword.removeprefix("SECTION_"): row for row in _ROWS}
SECTION_OF_KIND = {row.kind: row for row in _ROWS}
