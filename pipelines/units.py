"""Consistent systems of units by name: their labels, and gravity in them. The solvers know none of this."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Units:
    """Labels of a consistent system, and standard gravity in it."""

    length: str
    time: str
    mass: str
    stress: str
    force: str
    energy: str
    gravity: float

    def labels(self, dimension: int = 3) -> dict[str, str]:
        """The unit of every quantity of the result folder that has one, by its name in frames and in the history.

        dimension: of the run. In plane strain masses, energies and forces are those of a slice of unit thickness, in
        one dimension those of a bar of unit cross-section.
        """
        per = {3: "", 2: f"/{self.length}", 1: f"/{self.length}^2"}[dimension]
        speed = f"{self.length}/{self.time}"
        momentum = f"{self.mass}{per} {speed}"
        force = f"{self.force}{per}"
        energies = (
            "kinetic", "internal", "dissipated", "external_work", "contact_energy", "contact_dissipated",
            "artificial_energy", "relaxation_dissipated", "absent_energy", "interface_energy",
        )  # fmt: skip
        stresses = ("pressure", "stress", "stress_top", "stress_bottom", "von_mises", "contact_pressure")
        lengths = ("position", "displacement", "max_displacement", "radius", "thickness")
        return {
            **dict.fromkeys(("time", "dt", "particle_dt"), self.time),
            **dict.fromkeys(lengths, self.length),
            "velocity": speed,
            "density": f"{self.mass}/{self.length}^3",
            "mass": f"{self.mass}{per}",
            **dict.fromkeys(stresses, self.stress),
            **dict.fromkeys(energies, f"{self.energy}{per}"),
            **{f"{name}_{axis}": momentum for name in ("momentum", "pending_impulse") for axis in "xyz"},
            **dict.fromkeys(("contact_force", "reaction"), force),
            **{f"{name}_{axis}": force for name in ("contact_force", "structure_force", "reaction") for axis in "xyz"},
        }


SYSTEMS = {
    "mm-ms-g": Units("mm", "ms", "g", "MPa", "N", "mJ", 9.80665e-3),
    "cm-us-g": Units("cm", "us", "g", "Mbar", "Mbar cm^2", "Mbar cm^3", 9.80665e-10),
    "m-s-kg": Units("m", "s", "kg", "Pa", "N", "J", 9.80665),
    "mm-s-t": Units("mm", "s", "t", "MPa", "N", "mJ", 9806.65),
}
