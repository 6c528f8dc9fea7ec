"""The settings of an analysis, what a mesh does not carry: one table of keys, types, defaults and deck fields."""

from __future__ import annotations

from zrno.translators.laws import EQUATIONS_OF_STATE, LAWS
from zrno.translators.setting_types import (
    BOUNDARY_CODES,
    Group,
    Setting,
    count,
    dofs,
    field,
    law_parameters,
    maybe,
    number,
    numbers,
    one_of,
    pairs,
    place,
    plane,
    rows,
    scalar,
    some_vector,
    vector,
    word,
)

TABLE: tuple[Setting | Group, ...] = (
    Setting(
        "dimension",
        one_of(None, 2, 3),
        None,
        "2 plane strain, 3 (a flat mesh is then of shells); null: the mesh's",
        "card 1 axopt",
    ),
    Setting(
        "axisymmetric",
        one_of(False, True),
        False,
        "a flat mesh turns round the axis x = 0: x is the radius; the original program refuses it",
        "card 1 axopt 4",
    ),
    Setting("end_time", number(0.0), 1.0, "end of the analysis", "card 2 endtime"),
    Setting("step_factor", number(0.0), 0.8, "factor on the critical time step", "card 2 tssf"),
    Setting("initial_step", number(0.0), 0.0, "first time step; 0: automatic", "card 2 itss"),
    Setting(
        "output_interval",
        number(0.0, optional=True),
        None,
        "time between frames; null: end_time / 20",
        "card 3 stpltime",
    ),
    Setting(
        "history_interval",
        number(0.0, optional=True),
        None,
        "of the histories; null: end_time / 200",
        "card 3 thpltime",
    ),
    Setting("kernel", one_of("cubic_spline"), "cubic_spline", "smoothing kernel, support 2h", "card 6 kernel"),
    Setting(
        "step_option",
        one_of(0, 1, 2),
        1,
        "critical step: 0 DYNA's, 1 h/(c+v), 2 nearest distance/(c+v)",
        "card 5 tcrit",
    ),
    Setting("h_option", one_of(0, 1, 2), 0, "smoothing length: 0 constant, 1 by div v, 2 by density", "card 6 h_opt"),
    Setting("h_factor", number(0.0, above=True), 1.2, "smoothing length in spacings", "material card h"),
    Setting("xsph", one_of(False, True), False, "particles move with a smoothed velocity", "card 5 veloc_opt"),
    Setting("discretisation", one_of(0, 1), 0, "0 basic SPH, 1 mixed-correction SPH", "card 1 disctype"),
    Setting(
        "dynamic_relaxation",
        number(0.0),
        0.0,
        "factor on the velocities in each step; used between 0.1 and 1",
        "card 2 drelax_scale",
    ),
    Setting("max_neighbours", count, 400, "of a particle: the original stops past it", "card 6 maxnbr"),
    Setting("history_particles", rows(count), [], "numbers of particles", "history cards"),
    Setting(
        "transducers",
        rows(numbers("x", "y", "z", "material", whole=(3,))),
        [],
        "of pressure: [x, y, z, number of the material], ..",
        "transducer cards",
    ),
    Group(
        "planes",
        tuple(
            Setting(f"{axis}{end}", plane, None, "null: none" if axis == "x" else "", f"plane cards {axis}{end}")
            for axis in "xyz"
            for end in ("min", "max")
        ),
        "[symmetry, 0.0]: a plane and its coordinate; periodic ones stand on both sides; limit: particles end there",
    ),
    Group(
        "birth_death",
        (
            Setting("option", one_of(0, 1, 2, 3), 0, "0 none, 1 birth, 2 death, 3 both", "card 7 birth_death"),
            Setting("particles", numbers("first", "last", whole=(0, 1)), None, "[first, last] that are born"),
            Setting(
                "birth_plane",
                numbers("x", "y", "z", "orientation", whole=(3,)),
                None,
                "[x, y, z, orientation]",
                "card 7 plane_particle",
            ),
            Setting("death_plane", numbers("x", "y", "z", "orientation", whole=(3,)), None, "[x, y, z, orientation]"),
        ),
        "particles that are born and die (dialect 2019-10)",
    ),
    Setting(
        "gravity",
        vector,
        [0.0, 0.0, 0.0],
        "base acceleration x, y, z; of a FEM deck body loads",
        "base acceleration card",
    ),
    Setting(
        "contact",
        one_of("kernel", "potential"),
        "kernel",
        "between bodies: kernel, or potential (repulsive force)",
        "card 5 contact",
    ),
    Group(
        "contact_laws",
        (
            Setting("strength", number(0.0), 0.0, "K, pressure / density^2", "contact card K"),
            Setting("exponent", number(0.0), 4.0, "n", "contact card n"),
        ),
        'of contact: potential, by part, "*": any other',
        named=True,
    ),
    Group(
        "structure",
        (
            Setting("nodes", maybe(count), None, "of the .dat deck beside it; null: it has none", "velocity cards"),
            Setting("E", number(0.0), 2.1e5, "of the material that the original programs give its nodes"),
            Setting("nu", number(0.0), 0.3, "of the same"),
            Setting("density", number(0.0), 7.8e-3, "of the same"),
            Setting("mass", number(0.0, optional=True), None, "of all nodes; null: as heavy as the particles, each"),
            Setting("h", number(0.0, optional=True), None, "their smoothing length; null: the particles'"),
            Setting("strength", number(0.0), 0.0, "of contact: potential, K", "contact card K"),
            Setting("exponent", number(0.0), 4.0, "and n", "contact card n"),
        ),
        "particle deck of a coupled pair: the nodes that stand behind its particles",
    ),
    Group(
        "viscosity",
        (
            Setting(
                "quadratic", number(0.0, optional=True), None, "Q; null or 0: the deck's 1.5", "material card av_q"
            ),
            Setting("linear", number(0.0, optional=True), None, "L; null or 0: the deck's 0.06", "material card av_l"),
        ),
        "artificial viscosity",
    ),
    Group(
        "friction",
        (
            Setting("static", number(0.0, optional=True), None, "null: no friction", "friction card"),
            Setting("kinetic", number(0.0, optional=True), None, "at most static", "friction card"),
            Setting("fluid", number(0.0, optional=True), None, "of a fluid, in place of the two", "friction card"),
        ),
        "between bodies",
    ),
    Group(
        "materials",
        (
            Setting("law", one_of(None, *LAWS), None, "null: the mesh's own, or elastic", "material card model"),
            Setting("density", number(0.0, above=True, optional=True), None, "", "material card density"),
            *(Setting(name, parse, None, ", ".join(laws)) for name, (parse, laws) in law_parameters().items()),
            Setting("hardening", pairs, None, "von_mises: [[plastic strain, yield stress], ..]"),
            Group(
                "eos",
                (
                    Setting(
                        "type",
                        one_of(None, *EQUATIONS_OF_STATE),
                        None,
                        "null: the mesh's own. 1 4 13 28 41: " + " ".join(EQUATIONS_OF_STATE),
                        "material card eos",
                    ),
                    *(
                        Setting(name, parse, None, ", ".join(laws))
                        for name, (parse, laws) in law_parameters(EQUATIONS_OF_STATE).items()
                    ),
                ),
                "equation of state, which the laws fluid and hydro need",
            ),
            Setting(
                "velocity",
                field,
                [0.0, 0.0, 0.0],
                "initial velocity: numbers, or formulas of the place: -2*x/(x**2 + y**2)",
                "velocity cards",
            ),
            Setting("h_factor", number(0.0, above=True, optional=True), None, "null: the h_factor of all"),
            Setting("quadratic", number(0.0, optional=True), None, "viscosity Q; null: that of all", "av_q"),
            Setting("linear", number(0.0, optional=True), None, "viscosity L; null: that of all", "av_l"),
            Setting("rho_min", number(0.0, optional=True), None, "null: the deck's 1e-10", "material card rho_min"),
            Setting("rho_max", number(0.0, optional=True), None, "null: the deck's 1e10", "material card rho_max"),
            Setting(
                "bc",
                one_of(*BOUNDARY_CODES),
                "",
                "directions in which it is held: x y z xy yz xz xyz",
                "particle cards",
            ),
            Setting("bc_where", place, None, "and there alone: x < 0; null: everywhere"),
            Setting("thickness", number(0.0, above=True, optional=True), None, "of shells; null: the mesh's own"),
            Setting("area", number(0.0, above=True, optional=True), None, "of trusses and beams"),
        ),
        'by part: its name or number, "*": any other; what is null is the mesh\'s own',
        named=True,
    ),
    Group(
        "sets",
        (
            Setting("fixed", dofs, "", "held: all, or words of x y z rx ry rz", "node cards"),
            Setting("displacement", some_vector, None, "[x, y, z], null: free in that direction", "card 15-8"),
            Setting("force", vector, [0.0, 0.0, 0.0], "on each node", "card 15-1"),
            Setting("temperature", scalar, None, "of the nodes: a number, or a formula of the place", "card 15-7"),
            Setting("pressure", number(), 0.0, "against the faces whose nodes are all in the set", "card 15-3"),
            Setting(
                "traction",
                vector,
                [0.0, 0.0, 0.0],
                "force by area on those faces; on edges in the plane as forces on nodes",
                "card 15-3",
            ),
            Setting("function", word, None, "of time, for all of these; null: a ramp to 1 at the end"),
        ),
        "FEM deck: by set of nodes: its name in the mesh, or its number",
        named=True,
    ),
    Group(
        "functions",
        (Setting("points", pairs, [[0.0, 0.0], [1.0, 1.0]], "[time, value], ..", "card 14"),),
        "FEM deck: functions of time by name",
        named=True,
    ),
    Group(
        "fem",
        (
            Setting("analysis", one_of("static", "dynamic", "eigenvalues"), "static", "", "card 4"),
            Setting("steps", count, 1, "of equal length, to end_time", "card 8"),
            Setting(
                "kinematics",
                one_of("linear", "total_lagrange", "updated_lagrange"),
                "linear",
                "linear: small displacements, whatever the material",
                "card 13 IATYP",
            ),
            Setting(
                "method",
                one_of("modified_newton", "aitken", "newton", "line_search", "bfgs"),
                "newton",
                "of iteration, where something is not linear",
                "card 9 METOD",
            ),
            Setting("max_iterations", count, 50, "", "card 9 MAXIT"),
            Setting("energy_tolerance", number(0.0), 1e-6, "relative; 0: not asked", "card 9 TOLE"),
            Setting("force_tolerance", number(0.0), 0.0, "relative; 0: not asked", "card 9 TOLS"),
            Setting("mass", one_of("consistent", "lumped"), "consistent", "", "card 8-1"),
            Setting("eigenvalues", count, 10, "how many", "card 8-3"),
            Setting("shells", one_of("bathe_dvorkin", "isoparametric"), "bathe_dvorkin", "four-node shells", "card 13"),
            Setting(
                "points",
                one_of(None, 1, 2, 3, 4, 5),
                None,
                "of integration along each axis of hexahedra and plane quadrilaterals; null: 2, quadratic ones 3",
                "card 13 NGAUSX",
            ),
            Setting("thickness_points", count, 2, "of integration through a shell", "card 13 a"),
        ),
        "FEM deck: the analysis",
    ),
)
