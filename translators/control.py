"""What rules a run: the control cards of decks, and the few settings that every format's control has in common."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(slots=True)
class Analysis:
    """What most formats say of a run, in the source's units; None where it says nothing.

    kind: "static", "dynamic" (implicit), "explicit", "eigenvalues" or ""; step_factor: on the critical time step.
    """

    kind: str = ""
    end_time: float | None = None
    initial_step: float | None = None
    step_factor: float | None = None
    output_interval: float | None = None


@dataclass(slots=True)
class ParticleControl:
    """Control cards 1-7 of a particle deck, by the deck's own terms; None or 0 mean the deck's default.

    places: line and column of what was read, by field, for messages.
    """

    dimension: int = 3
    discretisation: int = 0
    end_time: float = 0.0
    step_factor: float = 0.0
    initial_step: float = 0.0
    dynamic_relaxation: float = 0.0
    output_interval: float = 0.0
    state_option: int = 4
    history_interval: float = 0.0
    history_particles: list[int] = field(default_factory=list)
    transducers: list[tuple[float, ...]] = field(default_factory=list)
    status_interval: int = 0
    restart_interval: int = 0
    run_restart: int = 0
    keep_files: int = 1
    contact: int = 0
    step_option: int = 0
    velocity_option: int = 0
    h_option: int = 0
    kernel: int = 1
    max_neighbours: int = 0
    max_particles: int = 0
    dialect: str = "2.07"
    friction: tuple[float, float] | None = None
    fluid_friction: float | None = None
    base_acceleration: tuple[float, float, float] | None = None
    planes: list[tuple[int, float]] | None = None
    contact_option: int = 1
    contact_laws: list[tuple[float, float]] = field(default_factory=list)
    birth_death: int = 0
    plane_particle: int = 0
    birth_range: tuple[int, int] | None = None
    birth_plane: tuple[float, float, float, int] | None = None
    death_plane: tuple[float, float, float, int] | None = None
    places: dict[str, tuple[int, int]] = field(default_factory=dict, compare=False)


@dataclass(slots=True)
class FemControl:
    """Control cards 2-9 of a PAK deck, by what they say; the names in brackets are PAK's.

    periods: (steps, step length) in turn [NKDT, DTDT].
    """

    free_format: bool = False  # INDFOR 1
    wide: bool = False  # IND56: numbers in 10 columns
    suppressed: tuple[int, ...] = (0, 0, 0, 0, 0, 0)  # IOPGL: ux uy uz rx ry rz of all nodes
    dynamic: int = 0  # NDIN
    eigenvalues: int = 0  # ISOPS
    free_numbering: bool = False  # ICVEL
    periods: list[tuple[int, float]] = field(default_factory=list)
