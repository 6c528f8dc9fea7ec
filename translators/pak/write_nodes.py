"""Writes the nodes of a PAK deck: cards 10, 10-4 and 10-1."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from zrno.translators.card_text import CardText
from zrno.translators.columns import integers
from zrno.translators.control import FemControl
from zrno.translators.model import Equation, Ints, Model
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.plan import Group
from zrno.translators.pak.write_elements import heading, real_column
from zrno.translators.report import Report

_CHUNK = 50_000  # nodes formatted at a time
_MOST_TERMS = 6
WIDEST_SHORT = 99_999  # number that five columns hold
Codes = Any  # (n, 6) int64: 0 free, 1 held, -1 dependent


def suppressed_of(model: Model, control: FemControl, groups: list[Group]) -> tuple[int, ...]:
    """What is switched off for all nodes: what no element has."""
    if control.suppressed is not None:
        return control.suppressed
    families = {group.family for group in groups}
    if "beam" in families:
        return (0, 0, 0, 0, 0, 0)
    if "shell" in families:  # rotations about the shell's own axes: none about the normal
        return (0, 0, 0, 0, 0, 1)
    return (0, 0, int(families == {"plane"} and model.dimension == 2), 1, 1, 1)


def codes_of(model: Model, control: FemControl, groups: list[Group], report: Report) -> Codes:
    """The codes of all nodes: held by their cards and by constraints, free where a motion is prescribed."""
    codes = np.zeros((len(model.xyz), 6), np.int64) if model.fixed is None else model.fixed.astype(np.int64)
    for constraint in model.constraints:
        if constraint.system:
            report.drop("constraints in a local system", len(constraint.nodes), "PAK holds nodes along the axes")
            continue
        codes[constraint.nodes] |= constraint.dofs
    if control.suppressed is None:
        _without_stiffness(codes, groups)
    freed = 0
    for load in model.nodal_loads:
        if load.kind == "displacement" and not load.native.get("initial") and not load.system:
            freed += int((codes[load.nodes, load.dofs - 1] == 1).sum())
            codes[load.nodes, load.dofs - 1] = 0
    report.approximate("held degrees of freedom", freed, "free in the deck, as a displacement is prescribed there")
    return codes


def _without_stiffness(codes: Codes, groups: list[Group]) -> None:
    """Hold the directions in which a node has no element."""
    moves, turns, drills = (np.zeros(len(codes) + 1, bool) for _ in range(3))  # the last for nodes that are absent
    for group in groups:
        for nodes in (piece.nodes for piece in group.pieces):
            moves[nodes] = True
            if group.family in ("shell", "beam"):
                turns[nodes] = True
            if group.family == "beam":
                drills[nodes] = True
    moves, turns, drills = moves[:-1], turns[:-1], drills[:-1]
    if turns.any():
        codes[~turns, 3:] = 1
        codes[~drills, 5] = 1 if drills.any() else codes[~drills, 5]
    codes[~moves, :3] = 1


def relations_of(
    model: Model, codes: Codes, suppressed: tuple[int, ...], report: Report
) -> list[tuple[Equation, list[tuple[int, int, float]]]]:
    """Linear relations that a deck can say; their dependent degrees of freedom are marked in the codes."""
    off = np.array(suppressed) == 1
    dependent = {(int(e.nodes[0]), int(e.dofs[0])) for e in model.equations if len(e.nodes)}
    found = []
    for equation in model.equations:
        terms = list(zip(equation.nodes.tolist(), equation.dofs.tolist(), equation.coefficients.tolist(), strict=True))
        (node, dof, factor), rest = terms[0], terms[1:]
        rest = [(n, d, -c / factor) for n, d, c in rest if c and not off[d - 1] and codes[n, d - 1] != 1]
        why = ""
        if off[dof - 1] or codes[node, dof - 1]:
            why = "the dependent degree of freedom is held, or dependent twice"
        elif len(rest) > _MOST_TERMS:
            why = f"more than {_MOST_TERMS} terms"
        elif any((n, d) in dependent for n, d, _ in rest):
            why = "a term depends itself on others"
        if why:
            report.drop("linear relations", 1, why)
        elif not rest:
            codes[node, dof - 1] = 1
        else:
            codes[node, dof - 1] = -1
            found.append((equation, rest))
    return found


def node_rows(model: Model, ids: Ints, codes: Codes, control: FemControl, text: CardText) -> Iterator[bytes]:
    """Card 10."""
    wide = control.wide
    yield f"{heading(layouts.node(wide), '/10/')}\n".encode()
    width, room = (10, 15) if wide else (5, 10)
    lj = model.node_data.get("LJ")
    for start in range(0, len(ids), _CHUNK):
        rows = slice(start, start + _CHUNK)
        count = len(ids[rows])
        blank = np.full((count, 2), np.uint8(ord(" ")))
        columns = [integers(ids[rows], width), blank[:, :1], _codes(codes[rows]), blank]
        for axis in range(3):
            columns.append(real_column(model.xyz[rows, axis], room, "coordinates", text))
        if lj is not None:
            columns += [integers(np.zeros(count, np.int64), 5), integers(lj[rows], 5)]
        columns.append(np.full((count, 1), np.uint8(ord("\n"))))
        yield np.hstack(columns).tobytes()


def _codes(codes: Codes) -> Any:
    text = np.full((len(codes), 12), np.uint8(ord(" ")))
    text[:, 1::2] = np.abs(codes) + ord("0")
    text[:, ::2][codes < 0] = ord("-")
    return text


def relation_lines(
    relations: list[tuple[Equation, list[tuple[int, int, float]]]], ids: Ints, control: FemControl, text: CardText
) -> Iterator[str]:
    """Card 10-4."""
    if not relations:
        return
    terms = max(len(rest) for _, rest in relations)
    sets: dict[tuple[float, ...], int] = {}
    rows = []
    for equation, rest in relations:
        full = rest + [(rest[-1][0], rest[-1][1], 0.0)] * (terms - len(rest))  # PAK wants nodes in all places
        number = sets.setdefault(tuple(c for _, _, c in full), len(sets) + 1)
        values: dict[str, Any] = {"IRB": number, "node_0": ids[equation.nodes[0]], "dof_0": equation.dofs[0]}
        for k, (node, dof, _) in enumerate(full, 1):
            values |= {f"node_{k}": ids[node], f"dof_{k}": dof}
        rows.append(values)
    yield heading(layouts.RELATIONS, "/10-4/")
    yield text.line(layouts.RELATIONS, {"MMP": len(sets), "NEZAV": terms}, "linear relations")
    for coefficients, number in sets.items():
        values = {"IRB": number} | {f"c{k}": c for k, c in enumerate(coefficients, 1)}
        yield text.line(layouts.COEFFICIENTS, values, "linear relations")
    layout = layouts.relation(control.wide)
    for values in rows:
        line = text.line(layout, values, "linear relations")
        yield line[: layout.fields[f"dof_{terms}"].end]


def initial_rows(model: Model, ids: Ints, control: FemControl, text: CardText) -> Iterator[bytes]:
    """Card 10-1, which a dynamic analysis alone has."""
    report = text.report
    kinds = ("displacement", "velocity", "acceleration")
    tables = {kind: (np.zeros((len(ids), 6)), np.zeros(len(ids), bool)) for kind in kinds}
    for load in model.nodal_loads:
        if load.native.get("initial") and load.kind in tables:
            values, given = tables[load.kind]
            values[load.nodes, load.dofs - 1] = load.values
            given[load.nodes] = True
    for velocity in model.initial_velocities:
        values, given = tables["velocity"]
        values[velocity.nodes, :3] = velocity.velocity
        values[velocity.nodes, 3:] = 0.0 if velocity.rotation is None else velocity.rotation
        given[velocity.nodes] = True
    if not control.dynamic or control.eigenvalues:
        count = sum(int(given.sum()) for _, given in tables.values())
        report.drop("initial values of nodes", count, "a dynamic analysis alone has them")
        return
    rows = {kind: np.flatnonzero(given & (ids <= WIDEST_SHORT)) for kind, (_, given) in tables.items()}
    far = sum(int((given & (ids > WIDEST_SHORT)).sum()) for _, given in tables.values())
    report.drop("initial values of nodes", far, "PAK reads their numbers in five columns")
    counts = (*(len(rows[kind]) for kind in kinds), *control.initial_prints)
    head = text.line(layouts.INITIAL, dict(zip(layouts.INITIAL.fields, counts, strict=True)), "initial values")
    yield f"{heading(layouts.INITIAL, '/10-1/')}\n{head}\n".encode()
    for kind in kinds:
        some = rows[kind]
        values = tables[kind][0][some]
        columns = [integers(ids[some], 5), integers(np.zeros(len(some), np.int64), 5)]
        columns += [real_column(values[:, k], 10, f"initial {kind}s", text) for k in range(6)]
        yield np.hstack([*columns, np.full((len(some), 1), np.uint8(ord("\n")))]).tobytes()
