"""Control cards 2-9 of a PAK deck: into `FemControl` and back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from zrno.translators.control import Analysis, FemControl
from zrno.translators.pak import cards as layouts
from zrno.translators.text import Card, Cards, Layout

_FIRST_AUTOMATIC = 60  # METOD
_OTHER_DECKS = "a deck of PAKS; those of PAK-F and PAK-KTM (fluid, transport) have other cards and are not read"
_UNREAD = {  # fields of card 3 that ask for cards of their own
    "NKRT": "rigid bodies", "MIXED": "mixed formulations", "NCRACK": "cracks", "NCXFEM": "extended finite elements",
    "IGBM": "meshless cracks",
}  # fmt: skip
_OUTPUT_FIELDS = {
    "NULAZ": "echo", "ISTKO": "list_per_step", "ISTEM": "graph_temperatures", "ISTVN": "graph_normals",
    "ISTSI": "graph_forces", "ISTDE": "list_strains", "ISTNA": "list_stresses", "IDEAS": "ideas",
}  # fmt: skip
_SOLVER_FIELDS = {
    "IREST": "restart", "ICCGG": "solver", "TOLG": "solver_tolerance", "ALFAG": "solver_factor",
    "IPAR": "solver_parallel", "KODUZ": "subtracted_step",
}  # fmt: skip


def read_control(cards: Cards) -> tuple[FemControl, Card]:
    """Cards 2-9, and card 3, which says how many nodes, groups and material models come."""
    c = FemControl()
    first = cards.card(layouts.FORMATS, "card 2")
    first.check("INDFOR", first["INDFOR"] in (0, 1, 2), "no such input format", "2 (columns) or 1 (free)")
    first.check("IND56", first["IND56"] in (0, 1), "no such width of numbers", "0 or 1")
    first.check("INDFOR", first["INDFOR"] != 1, "free input format is not read", "2: numbers in columns")
    cards.faults.stop()
    c.wide = first["IND56"] == 1
    c.options = (first["IDJERDAP"], first["IOPIT"], first["ISPRESEK"], first["IRPRIT"])
    basics = cards.card(layouts.basics(c.wide), "card 3")
    basics.check("NP", basics["NP"] > 0, "no nodes", f"the number of nodes in {_OTHER_DECKS}")
    for name in ("NGELEM", "NMATM", "NPER"):
        basics.check(name, basics[name] >= 0, f"{name} is negative", "a number from 1")
    basics.check("JPS", basics["JPS"] in (0, 1), "substructures are not read", "0 or 1")
    for name, what in _UNREAD.items():
        basics.check(name, basics[name] == 0, f"{what} are not read", "0")
    cards.faults.stop()
    _switches(cards, c)
    _output(cards, c)
    solver = cards.card(layouts.SOLVER, "card 7")
    for name, attribute in _SOLVER_FIELDS.items():
        setattr(c, attribute, solver[name])
    solver.check("NMODS", solver["NMODS"] >= 0, "NMODS is negative", "0 or more")
    cards.faults.stop()
    modes = cards.block(layouts.IMPERFECTION, solver["NMODS"], "card 7-1, an imperfection")
    c.imperfections = list(zip(*(modes[name].tolist() for name in layouts.IMPERFECTION.fields), strict=True))
    periods = cards.block(layouts.PERIOD, basics["NPER"] or 1, "card 8, a period")
    periods.check("NKDT", periods["NKDT"] > 0, "no steps", "the number of steps, 1 or more")
    periods.check("DTDT", periods["DTDT"] > 0, "the step is not positive", "the length of a step")
    c.periods = list(zip(periods["NKDT"].tolist(), periods["DTDT"].tolist(), strict=True))
    _dynamics(cards, c)
    _iteration(cards, c)
    cards.faults.stop()
    return c, basics


def analysis_of(c: FemControl) -> Analysis:
    """What the control cards say in every format's terms."""
    kind = "eigenvalues" if c.eigenvalues else "dynamic" if c.dynamic else "static"
    return Analysis(kind, end_time(c), c.periods[0][1])


def end_time(c: FemControl) -> float:
    """The accumulated end of all periods."""
    return float(sum(steps * length for steps, length in c.periods))


def _switches(cards: Cards, c: FemControl) -> None:
    card = cards.card(layouts.SWITCHES, "card 4")
    card.check("NDIN", card["NDIN"] in (0, 1), "no such analysis", "0 (static) or 1 (dynamic)")
    card.check("ISOPS", card["ISOPS"] in (-1, 0, 1), "no such eigenvalue analysis", f"0, 1 or -1 in {_OTHER_DECKS}")
    card.check("ICVEL", card["ICVEL"] in (0, 1), "no such numbering", f"0 or 1 (free) in {_OTHER_DECKS}")
    c.suppressed = tuple(card[name] for name in layouts.DOFS)
    c.mixed_suppressed = tuple(card[f"m{name}"] for name in layouts.DOFS)
    c.dynamic, c.eigenvalues, c.free_numbering = card["NDIN"], card["ISOPS"], card["ICVEL"] == 1
    cards.faults.stop()


def _output(cards: Cards, c: FemControl) -> None:
    card = cards.card(layouts.OUTPUT, "card 5")
    card.check("NCVPR", card["NCVPR"] == 0, "prints of chosen nodes are not read", "0 (all nodes)")
    for name in ("NBLPR", "NBLGR"):
        card.check(name, card[name] >= -1, f"{name} is negative", "-1, 0 or the number of step blocks")
    cards.faults.stop()
    for name, attribute in _OUTPUT_FIELDS.items():
        setattr(c, attribute, card[name])
    for name, blocks, otherwise in (("NBLPR", "print_blocks", "printed"), ("NBLGR", "plot_blocks", "plotted")):
        block = cards.block(layouts.STEP_BLOCK, max(card[name], 0), "card 6, a block of steps")
        columns = [block[key].tolist() for key in ("first", "increment", "last", "what")]
        setattr(c, blocks, list(zip(*columns, strict=True)))
        if card[name] <= 0:
            setattr(c, otherwise, card[name])


def _dynamics(cards: Cards, c: FemControl) -> None:
    if c.dynamic:
        card = cards.card(layouts.DYNAMICS, "card 8-1")
        c.mass, c.damping, c.damping_vector = card["IMASS"], card["IDAMP"], card["INDVB"]
        if not c.eigenvalues:
            card = cards.card(layouts.INTEGRATION, "card 8-2")
            c.integration = card["MDVI"]
            c.integration_parameters = (card["PIP"], card["DIP"])
            c.rayleigh = (card["ALFAM"], card["BETAK"])
            c.damping_factor = card["DAMPC"]
    if c.eigenvalues > 0:
        card = cards.card(layouts.EIGENVALUES, "card 8-3")
        c.eigen_method, c.eigen_count = card["ISTYP"], card["NSOPV"]


def _iteration(cards: Cards, c: FemControl) -> None:
    card = cards.card(layouts.ITERATION, "card 9")
    c.iteration, c.max_iterations, c.matrix_updates = card["METOD"], card["MAXIT"], card["NBRCR"]
    c.converge_on = (card["KONVE"], card["KONVS"], card["KONVM"])
    c.tolerances = (card["TOLE"], card["TOLS"], card["TOLM"], card["TOLA"])
    if not card.sound("METOD"):
        cards.faults.stop()
    if c.iteration >= _FIRST_AUTOMATIC:
        automatic = cards.card(layouts.LOADING, "card 9-1")
        c.loading = tuple(automatic[name] for name in layouts.LOADING.fields)


def control_rows(
    c: FemControl, nodes: int, groups: int, models: int, suppressed: tuple[int, ...]
) -> Iterator[tuple[str, Layout, dict[str, Any]]]:
    """Cards 2-9: a heading, a layout and its values each."""
    options = dict(zip(("IDJERDAP", "IOPIT", "ISPRESEK", "IRPRIT"), c.options, strict=True))
    yield "/2/", layouts.FORMATS, {"INDFOR": 2, "IND56": c.wide, **options}
    yield "/3/", layouts.basics(c.wide), {"NP": nodes, "NGELEM": groups, "NMATM": models, "NPER": len(c.periods),
                                          "JPS": 1}  # fmt: skip
    switches = {"NDIN": c.dynamic, "ISOPS": c.eigenvalues, "ICVEL": c.free_numbering}
    mixed = {f"m{name}": value for name, value in zip(layouts.DOFS, c.mixed_suppressed, strict=True)}
    yield "/4/", layouts.SWITCHES, dict(zip(layouts.DOFS, suppressed, strict=True)) | mixed | switches
    output = {name: getattr(c, attribute) for name, attribute in _OUTPUT_FIELDS.items()}
    output |= {"NBLPR": len(c.print_blocks) or c.printed, "NBLGR": len(c.plot_blocks) or c.plotted}
    yield "/5/", layouts.OUTPUT, output
    for blocks in (c.print_blocks, c.plot_blocks):
        for number, block in enumerate(blocks, 1):
            yield "/6/", layouts.STEP_BLOCK, dict(zip(layouts.STEP_BLOCK.fields, (number, *block), strict=True))
    solver = {name: getattr(c, attribute) for name, attribute in _SOLVER_FIELDS.items()}
    yield "/7/", layouts.SOLVER, {**solver, "NMODS": len(c.imperfections)}
    for mode in c.imperfections:
        yield "/7-1/", layouts.IMPERFECTION, dict(zip(layouts.IMPERFECTION.fields, mode, strict=True))
    for number, (steps, length) in enumerate(c.periods, 1):
        yield "/8/", layouts.PERIOD, {"I": number, "NKDT": steps, "DTDT": length}
    if c.dynamic:
        yield "/8-1/", layouts.DYNAMICS, {"IMASS": c.mass, "IDAMP": c.damping, "INDVB": c.damping_vector}
        if not c.eigenvalues:
            values = (c.integration, *c.integration_parameters, *c.rayleigh, c.damping_factor)
            yield "/8-2/", layouts.INTEGRATION, dict(zip(layouts.INTEGRATION.fields, values, strict=True))
    if c.eigenvalues > 0:
        yield "/8-3/", layouts.EIGENVALUES, {"ISTYP": c.eigen_method, "NSOPV": c.eigen_count}
    numbers = (c.iteration, c.max_iterations, *c.converge_on, *c.tolerances, c.matrix_updates)
    yield "/9/", layouts.ITERATION, dict(zip(layouts.ITERATION.fields, numbers, strict=True))
    if c.iteration >= _FIRST_AUTOMATIC:
        yield "/9-1/", layouts.LOADING, dict(zip(layouts.LOADING.fields, c.loading or (0,) * 8, strict=True))
