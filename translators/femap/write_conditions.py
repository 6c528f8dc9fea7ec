"""Constraints and groups as blocks 406 and 408 have them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from zrno.translators.femap.groups import CLIP_LINES, ELEMENT_LIST, ELEMENT_RULE, NODE_LIST, NODE_RULE
from zrno.translators.femap.text_out import formatted, line, set_numbers, title
from zrno.translators.femap.write_mesh import Mesh
from zrno.translators.model import Constraint, Ints, Model
from zrno.translators.report import Report

_CLIPPING = ["0,0,0,0,0.,0.,\n", "0,0,\n", *(["0,0,\n", "0.,0.,0.,\n", "0.,0.,0.,\n"] * 6)]
assert len(_CLIPPING) == CLIP_LINES


class Conditions:
    """What is done to the mesh."""

    def __init__(self, model: Model, mesh: Mesh, report: Report) -> None:
        self.model, self.mesh, self.report = model, mesh, report
        self.constraints = self._constraints()

    def _constraints(self) -> dict[tuple[int, str], list[Constraint]]:
        """Constraints by set; nodes get the systems that these are in.

        Sets are as a FEMAP file had them, else all is one, since it acts together.
        """
        own = self.model.format == "femap"
        sets: dict[tuple[int, str], list[Constraint]] = {}
        for constraint in self.model.constraints:
            system = self.mesh.system
            if constraint.system and constraint.system not in self.model.systems:
                self.report.drop("constraints", len(constraint.nodes), f"system {constraint.system} is not there")
                continue
            other = (system[constraint.nodes] != constraint.system) & (system[constraint.nodes] != 0)
            if constraint.system and other.any():
                self.report.drop("constraints", int(other.sum()), "nodes have one output system alone")
            system[constraint.nodes[~other]] = constraint.system or system[constraint.nodes[~other]]
            sets.setdefault((constraint.id, constraint.name) if own else (1, ""), []).append(constraint)
        return sets

    def constraint_lines(self) -> Iterator[str]:
        """The body of block 406."""
        sets = self.constraints
        if not sets and self.model.equations:
            sets = {(1, ""): []}
        numbers = set_numbers([number for number, _ in sets])
        for i, ((_, name), constraints) in enumerate(sets.items()):
            yield f"{numbers[i]},\n" + title(name, self.report)
            nodes = np.concatenate([np.zeros(0, np.int64), *(c.nodes for c in constraints)])
            dofs = np.concatenate([np.zeros((0, 6), bool), *(c.dofs for c in constraints)])
            first, inverse = np.unique(nodes, return_index=True, return_inverse=True)[1:]
            if len(first) < len(nodes):  # a node that stands twice: held in all that either says
                together = np.zeros((len(first), 6), bool)
                np.logical_or.at(together, inverse, dofs)
                order = np.argsort(first, kind="stable")
                nodes, dofs = nodes[first[order]], together[order]
            rows = np.column_stack([self.mesh.node_ids[nodes], dofs.astype(np.int64)])
            yield from formatted("%d,120,1,%d,%d,%d,%d,%d,%d,\n", rows)
            yield "-1,-1,-1,0,0,0,0,0,0,\n"
            if i == 0:
                for number, equation in enumerate(self.model.equations, 1):
                    yield f"{equation.id if equation.id > 0 else number},120,1,\n{len(equation.nodes)},\n"
                    ids = self.mesh.node_ids[equation.nodes].tolist()
                    terms = zip(ids, equation.dofs.tolist(), equation.coefficients.tolist(), strict=True)
                    yield "".join([line(term) for term in terms])
            yield "-1,-1,-1,\n"

    def group_lines(self) -> Iterator[str]:
        """The body of block 408: a group a set; sets of nodes and elements of one number and name are one group."""
        groups: dict[tuple[int, str], tuple[list[Ints], list[Ints]]] = {}
        for nodes in self.model.node_sets:
            groups.setdefault((nodes.id, nodes.name), ([], []))[0].append(self.mesh.node_ids[nodes.nodes])
        for elements in self.model.element_sets:
            ids = self.mesh.numbers_of(elements.family, elements.elements)
            self.report.drop("members of element sets", len(elements.elements) - len(ids), "that are not written")
            groups.setdefault((elements.id, elements.name), ([], []))[1].append(ids)
        numbers = set_numbers([number for number, _ in groups])
        changed = sum(given != number for (given, _), number in zip(groups, numbers, strict=True))
        self.report.approximate("numbers of sets", changed, "other ones: a group's differ and are from 1")
        for number, ((_, name), members) in zip(numbers, groups.items(), strict=True):
            yield f"{number},1,\n" + title(name, self.report) + "0,0,0,\n" + "".join(_CLIPPING)
            lists = [np.concatenate([np.zeros(0, np.int64), *some]) for some in members]
            yield f"{ELEMENT_RULE + 1},\n"
            for rule, ids in zip((NODE_RULE, ELEMENT_RULE), lists, strict=True):
                if len(ids):
                    yield f"{rule},\n"
                    yield from formatted("%d,%d,1,1,\n", _runs(ids))
                    yield "-1,-1,-1,-1,\n"
            yield f"-1,\n{ELEMENT_LIST + 1},\n"
            for kind, ids in zip((NODE_LIST, ELEMENT_LIST), lists, strict=True):
                if len(ids):
                    yield f"{kind},\n"
                    yield from formatted("%d,\n", ids[:, None])
                    yield "-1,\n"
            yield "-1,\n"


def _runs(ids: Ints) -> Ints:
    """First and last of runs of consecutive numbers, (n, 2), ascending."""
    ordered = np.unique(ids)
    breaks = np.flatnonzero(np.diff(ordered) > 1)
    return np.column_stack([ordered[np.append(0, breaks + 1)], ordered[np.append(breaks, len(ordered) - 1)]])
