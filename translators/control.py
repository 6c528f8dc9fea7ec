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

    places: line and column of what was read, by field, for messages. axisymmetric: option 4, of two dimensions, x the
    radius and y the axis; masses are of whole rings.
    """

    dimension: int = 3
    axisymmetric: bool = False
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
    """Control cards 2-9 of a PAK deck by what they say; PAK's names in the comments. The defaults are what is written.

    Blocks of steps: (first, increment, last, what); what: 0 all, 1 displacements, 2 stresses.
    """

    free_format: bool = False  # INDFOR 1: numbers between blanks; decks are written in columns
    wide: bool = False  # IND56: numbers of nodes and elements in 10 columns, coordinates in 15
    options: tuple[int, int, int, int] = (0, 0, 0, 0)  # IDJERDAP, IOPIT, ISPRESEK, IRPRIT
    suppressed: tuple[int, ...] | None = None  # IOPGL: ux uy uz rx ry rz of all nodes; None: by what the elements have
    mixed_suppressed: tuple[int, ...] = (0, 0, 0, 0, 0, 0)  # IOPGS
    dynamic: int = 0  # NDIN
    eigenvalues: int = 0  # ISOPS
    free_numbering: bool = False  # ICVEL
    echo: int = 0  # NULAZ: of the input, 0 and 1 all, 2 images of the cards, 3 data, -1 none
    printed: int = -1  # NBLPR where there are no blocks: 0 every step, -1 none
    print_blocks: list[tuple[int, int, int, int]] = field(default_factory=list)
    plotted: int = 0  # NBLGR where there are no blocks
    plot_blocks: list[tuple[int, int, int, int]] = field(default_factory=list)
    list_per_step: int = 0  # ISTKO
    graph_temperatures: int = 0  # ISTEM: -1 no; so the three that follow
    graph_normals: int = 0  # ISTVN
    graph_forces: int = 0  # ISTSI
    list_strains: int = 0  # ISTDE
    list_stresses: int = 0  # ISTNA: 0 at Gauss points, 1 at the centre, 2 the largest
    ideas: int = 0  # IDEAS: version of the graphics file
    restart: int = 0  # IREST: 0 run, 1 restart, 2 check of the input
    imperfections: list[tuple[int, int, int, float]] = field(default_factory=list)  # MODE, node number, dof, SCIM
    solver: int = 0  # ICCGG: 0 skyline symmetric, 2 unsymmetric, -1 and 1 conjugate gradients, -11 and -12 MUMPS
    solver_tolerance: float = 0.0  # TOLG
    solver_factor: float = 0.0  # ALFAG
    solver_parallel: int = 0  # IPAR
    subtracted_step: int = 0  # KODUZ
    periods: list[tuple[int, float]] = field(default_factory=list)  # NKDT, DTDT: steps and their length, in turn
    mass: int = 1  # IMASS: 1 consistent, 2 lumped
    damping: int = 0  # IDAMP: 3 Rayleigh
    damping_vector: int = 0  # INDVB
    integration: int = 2  # MDVI: 1 Wilson, 2 Newmark, -2 Newmark in acceleration, 3 central differences
    integration_parameters: tuple[float, float] = (0.5, 0.25)  # PIP, DIP: Newmark's delta and alpha, or Wilson's theta
    rayleigh: tuple[float, float] = (0.0, 0.0)  # ALFAM, BETAK
    damping_factor: float = 0.0  # DAMPC
    eigen_method: int = 1  # ISTYP: 1, 2 subspace, 3 Lanczos
    eigen_count: int = 1  # NSOPV
    iteration: int = 1  # METOD: 1 modified Newton, 3 full, 4 with line search, 5 BFGS, 61 .. 73 loading by itself
    max_iterations: int = 50  # MAXIT
    converge_on: tuple[int, int, int] = (1, 0, 0)  # KONVE, KONVS, KONVM: energy, force, moment
    tolerances: tuple[float, float, float, float] = (0.001, 0.0, 0.0, 1e-7)  # TOLE, TOLS, TOLM, TOLA
    matrix_updates: int = 2  # NBRCR
    loading: tuple[float, ...] = ()  # ITEOPT, KPNOD, KPDIR, DTUK, ALFG, DELS, DELUM, DELFM: of METOD 60 and above
    initial_prints: tuple[int, int, int] = (0, 0, 0)  # ISUU, ISUV, ISUA: 0 prints displacement, velocity, acceleration
    instability_zones: int = 0  # ICERNE
