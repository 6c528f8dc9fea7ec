"""The cards of an .mcm deck, one place for reader and writer: columns, field names, and where a law's numbers stand.

Formats as MCM's Fortran reads them. A law is a row of `LAWS`; a further model is a further row.
"""

from __future__ import annotations

from dataclasses import dataclass

from zrno.translators.text import Layout

TITLE = Layout("a78,i2", "title version")

CONTROL = (
    Layout("2i5,5i10", "axopt disctype nummat np max_np nstressp nvelocp"),
    Layout("4e10.0", "endtime tssf itss drelax"),
    Layout(
        "e10.0,i5,e10.0,i10,i5,i10,2i5",
        "stpltime state_opt thpltime thnode transducers status restart run_restart",
    ),
    Layout("5i5", "keep_files init_v massopt init_h init_rhoe"),
    Layout("8i5", "contact tcrit veloc_opt symmetry nlcur nthpx nthpy nthpz"),
    Layout("3i5", "h_opt kernel maxnbr"),
)
# Card 7 is blank in dialect 2.07, friction itself in 2019-08, options in 2019-10 (friction then has a card of its own).
CARD_7_TEXT = Layout("a20,a60", "card_7 rest")
CARD_7_OPTIONS = Layout("3i5", "birth_death contact_option plane_particle")
FRICTION = Layout("2e10.0", "static_friction dynamic_friction")
FLUID_FRICTION = Layout("e10.0", "fluid_friction")
DIALECTS = ("2.07", "2019-08", "2019-10")

CONTROL_VERSION_1 = (
    Layout("2i5,4i10", "axopt disctype nummat np nstressp nvelocp"),
    Layout("3e10.0", "endtime tssf itss"),
    Layout("2e10.0,i10,2i5", "stpltime thpltime thnode transducers state_opt"),
    Layout("i10,2i5", "kernel init_h maxnbr"),
    Layout("6i5", "contact massopt tcrit veloc_opt h_opt symmetry"),
)

MATERIAL = Layout(
    "2i5,e10.0,2i5,e10.0,i5,2e10.0",
    "number model density eos ihq qh visc_type quadratic linear",
)
MATERIAL_PARTICLES = Layout("4e10.0", "mass h rho_min rho_max")
MATERIAL_TITLE = Layout("a72", "material_title")
PROPERTY_CARDS = 6
PROPERTIES = Layout("8e10.0", "value_1 value_2 value_3 value_4 value_5 value_6 value_7 value_8")

# MCM's format is i8,4e20.0 on lines of 80 columns: of the energy it sees the first 12.
EXTRA = Layout("i8,3e20.0,e12.0", "number mass h rho e")
PAST_LINE = Layout("a80,a80", "line past")
HISTORY = Layout("10i8", " ".join(f"id_{i}" for i in range(1, 11)))
VELOCITY = Layout("i8,3e10.0", "number vx vy vz")
PLANE_FLAGS = Layout("6i10", "xmin xmax ymin ymax zmin zmax")
PLANE_POSITIONS = Layout("6e10.0", "xmin xmax ymin ymax zmin zmax")
PLANE_CODES_VERSION_1 = Layout("6i5", "xmin xmax ymin ymax zmin zmax")
CONTACT = Layout("2i5", "materials option")
CONTACT_LAW = Layout("2e10.5", "K n")
BASE_ACCELERATION = Layout("3e20.0", "ax ay az")


def particle(dimension: int) -> Layout:
    """The particle card of a 1, 2 or 3 dimensional deck."""
    return Layout(f"i8,i5,{dimension}e20.0,i7", f"number bc {' '.join('xyz'[:dimension])} material")


def transducer(dimension: int) -> Layout:
    """The pressure transducer's card."""
    return Layout(f"{dimension}e10.0,i5", f"{' '.join('xyz'[:dimension])} material")


@dataclass(frozen=True, slots=True)
class Law:
    """A material law in the deck. positions: parameter -> (property card, value), both from 1."""

    model: int
    positions: dict[str, tuple[int, int]]


LAWS = {
    "elastic": Law(1, {"E": (1, 1), "nu": (2, 1)}),
    "von_mises": Law(3, {"E": (1, 1), "nu": (2, 1), "yield_stress": (3, 1), "tangent_modulus": (4, 1), "beta": (5, 1)}),
}
FAILURE_SWITCH, FAILURE_STRAIN = (6, 1), (6, 2)  # von_mises: the strain counts only where the switch is 1

# What MCM knows beyond LAWS: named in messages, and their cards are skipped so that later faults are found too.
OTHER_MODELS = {4: "generalised cap", 9: "fluid", 10: "elastic-plastic hydrodynamic"}
EOS_CARDS = {1: 2, 4: 1, 13: 1, 28: 1, 41: 1}
