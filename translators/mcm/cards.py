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


BIRTH_RANGE = Layout("2i10", "first last")
BIRTH_DEATH_PLANE = Layout("3e20.0,i5", "x y z orientation")


@dataclass(frozen=True, slots=True)
class Law:
    """A material law in the deck.

    positions: parameter -> (property card, value), both from 1; more: parameters and tables that the reader and the
    writer know a place for; eos: whether the law needs an equation of state (else it takes none).
    """

    model: int
    positions: dict[str, tuple[int, int]]
    more: tuple[str, ...] = ()
    eos: bool = False

    @property
    def parameters(self) -> tuple[str, ...]:
        """All parameters of the law in the deck."""
        return (*self.positions, *self.more)


# The cap's X0 stands twice: the start of kappa is made of card 5, the hardening law of card 4.
LAWS = {
    "elastic": Law(1, {"E": (1, 1), "nu": (2, 1)}),
    "von_mises": Law(
        3,
        {"E": (1, 1), "nu": (2, 1), "yield_stress": (3, 1), "tangent_modulus": (4, 1), "beta": (5, 1)},
        ("failure_strain",),
    ),
    "cap": Law(
        4,
        {"K": (1, 1), "G": (2, 1), "alpha": (3, 1), "theta": (4, 1), "gamma": (5, 1), "beta": (6, 1), "R": (1, 2),
         "D": (2, 2), "W": (3, 2), "X0": (4, 2), "ftype": (6, 2), "tension_cutoff": (1, 3), "vec": (5, 3), "C": (6, 3),
         "N": (1, 4)},
    ),
    "fluid": Law(9, {"pressure_cutoff": (1, 1), "viscosity": (1, 2)}, eos=True),
    "hydro": Law(
        10,
        {"G": (1, 1), "yield_stress": (1, 2), "hardening_modulus": (1, 3), "pressure_cutoff": (1, 4), "a1": (1, 5),
         "a2": (1, 6), "spall": (1, 7), "failure_strain": (2, 1)},
        eos=True,
    ),
}  # fmt: skip
FAILURE_SWITCH, FAILURE_STRAIN = (6, 1), (6, 2)  # von_mises: the strain counts only where the switch is 1
CAP_START = (5, 2)  # the cap's second X0
TABLE_CARDS = {"strain": (3, 4), "stress": (5, 6)}  # hydro: 16 points of the hardening table
KEPT = 5  # values of a property card that MCM keeps, but for hydro, whose 48 numbers it takes in sequence


@dataclass(frozen=True, slots=True)
class EquationOfState:
    """An equation of state in the deck: its number, its cards, and the parameters in the order of their values."""

    number: int
    cards: tuple[Layout, ...]


def _eos(names: str) -> Layout:
    return Layout(f"{len(names.split())}e10.0", names)


EQUATIONS_OF_STATE = {
    "linear_polynomial": EquationOfState(1, (_eos("C0 C1 C2 C3 C4 C5 C6 E0"), _eos("V0"))),
    "gruneisen": EquationOfState(4, (_eos("C S1 S2 S3 gamma0 a E0 V0"),)),
    "perfect_gas": EquationOfState(13, (_eos("gamma E0 second V0"),)),
    "murnaghan": EquationOfState(28, (_eos("B gamma E0 V0"),)),
    "mie_gruneisen": EquationOfState(41, (_eos("C S cv T0 gamma0 V0 b E0"),)),
}
