"""Labels and units of the quantities that frames and histories hold: the one place for both."""

from __future__ import annotations

from dataclasses import dataclass

_LABELS = {  # name of an array or a column: its label and the kind of quantity
    "id": ("particle number", ""),
    "material": ("material", ""),
    "velocity": ("velocity", "velocity"),
    "density": ("density", "density"),
    "mass": ("mass", "mass"),
    "radius": ("radius", "length"),
    "pressure": ("pressure", "stress"),
    "stress": ("stress", "stress"),
    "von_mises": ("von Mises stress", "stress"),
    "plastic_strain": ("plastic strain", ""),
    "displacement": ("displacement", "length"),
    "time": ("time", "time"),
    "dt": ("time step", "time"),
    "kinetic": ("kinetic energy", "energy"),
    "internal": ("internal energy", "energy"),
    "dissipated": ("dissipated energy", "energy"),
    "external_work": ("external work", "energy"),
    "momentum": ("momentum", "momentum"),
    "contact_force": ("contact force", "force"),
    "active": ("active particles", ""),
}

# Consistent systems: length, time, mass; the powers of ten that take each to m, s, kg.
_SYSTEMS = {
    "mm-ms-g": ("mm", "ms", "g"),
    "cm-us-g": ("cm", "µs", "g"),
    "m-s-kg": ("m", "s", "kg"),
    "mm-s-t": ("mm", "s", "t"),
}
_POWER = {"mm": -3, "cm": -2, "m": 0, "ms": -3, "µs": -6, "s": 0, "g": -3, "kg": 0, "t": 3}
_DERIVED = {  # kind: exponents of length, time, mass; name of the SI unit where it has one
    "length": (1, 0, 0, ""),
    "time": (0, 1, 0, ""),
    "mass": (0, 0, 1, ""),
    "velocity": (1, -1, 0, ""),
    "density": (-3, 0, 1, ""),
    "stress": (-1, -2, 1, "Pa"),
    "force": (1, -2, 1, "N"),
    "energy": (2, -2, 1, "J"),
    "momentum": (1, -1, 1, ""),
}
_PREFIX = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
_SUPERSCRIPT = {1: "", 2: "²", 3: "³"}
_AXES = ("x", "y", "z", "xx", "yy", "zz", "xy", "yz", "zx")
SYSTEMS = tuple(_SYSTEMS)


@dataclass(frozen=True, slots=True)
class Quantity:
    """label: words for a person; unit: "" where there is none or the system is not known."""

    label: str
    unit: str

    def __str__(self) -> str:
        return f"{self.label} [{self.unit}]" if self.unit else self.label


def unit(kind: str, system: str | None) -> str:
    """The unit of a kind of quantity ("stress") in a consistent system ("mm-ms-g" -> "MPa"); "" when not known."""
    if not kind or system not in _SYSTEMS:
        return ""
    *exponents, name = _DERIVED[kind]
    symbols = _SYSTEMS[system]
    power = sum(int(n) * _POWER[symbol] for n, symbol in zip(exponents, symbols, strict=True))
    if name and power in _PREFIX:
        return _PREFIX[power] + name
    if name == "Pa" and power == 11:
        return "Mbar"
    length, time, mass = symbols
    ordered = list(zip((mass, length, time), (exponents[2], exponents[0], exponents[1]), strict=True))
    above = " ".join(symbol + _SUPERSCRIPT[int(n)] for symbol, n in ordered if int(n) > 0)
    below = " ".join(symbol + _SUPERSCRIPT[-int(n)] for symbol, n in ordered if int(n) < 0)
    return f"{above}/{below}" if below else above


def quantity(name: str, system: str | None = None) -> Quantity:
    """Label and unit of an array, a component of one (`velocity_x`) or a column; unknown names label themselves."""
    base, _, axis = name.rpartition("_")
    if name in _LABELS:
        label, kind = _LABELS[name]
    elif axis in _AXES and base in _LABELS:
        label, kind = _LABELS[base]
        label = f"{label} {axis}"
    else:
        label, kind = name.replace("_", " "), ""
    return Quantity(label, unit(kind, system))
