"""Nodes of a PAK deck: cards 10 (coordinates and what is held), 10-4 (linear relations) and 10-1 (initial values)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.translators.control import FemControl
from zrno.translators.model import Equation, Floats, InitialVelocity, Ints, Model, NodalLoad, Source
from zrno.translators.pak import cards as layouts
from zrno.translators.pak.generate import Series, read_series
from zrno.translators.text import Block, Cards

_MOST_TERMS = 6  # independent degrees of freedom of a relation
_SLAVE = -1
_LARGEST = 10**10  # number of a node
_CHUNK = 250_000  # node cards read at a time


@dataclass(frozen=True, slots=True)
class Numbering:
    """Node numbers to indices. sorted: the numbers in order; order: where each of them stands in the model."""

    sorted: Ints
    order: Ints

    @classmethod
    def of(cls, numbers: Ints) -> Numbering:
        """The numbering of a model's nodes."""
        order = np.argsort(numbers, kind="stable")
        return cls(numbers[order], order)

    def indices(self, numbers: Ints) -> Ints:
        """Indices of nodes; -1 of a number that no node has."""
        count = len(self.sorted)
        if not count:
            return np.full(numbers.shape, -1)
        first = int(self.sorted[0])
        if int(self.sorted[-1]) - first == count - 1:  # no gaps
            place = np.clip(numbers - first, 0, count - 1)
        else:
            place = np.minimum(np.searchsorted(self.sorted, numbers), count - 1)
        return np.where(self.sorted[place] == numbers, self.order[place], -1)

    def checked(self, block: Block, name: str, *, absent: bool = False) -> Ints:
        """Indices of the nodes in a field of cards; faults for nodes that are not there. absent: 0 is none: -1."""
        indices = self.indices(block[name])
        good = (indices >= 0) | (absent & (block[name] == 0))
        if not good.all():
            block.check(name, good, "no such node", "the number of a node of card 10")
        return indices


def read_nodes(cards: Cards, model: Model, control: FemControl, count: int, size: int) -> Numbering:
    """Card 10: node numbers, coordinates and held degrees of freedom, and the relations of dependent ones."""
    layout = layouts.node(control.wide)
    path = cards.faults.path
    if cards.probe(layout.only("KORC"), count)["KORC"].any():
        series = read_series(cards, [layout], count, "node card", key=(0, "N"), size=size)
        numbers, xyz, codes, lj, polar = _card_values(series.blocks[0], control, count)
        xyz, polar = _between(series, xyz, polar)
        numbers, codes, lj = series.numbers(numbers), codes[series.card], lj[series.card]
        owner, used = series.card, len(series.blocks[0]["N"])
        model.warnings.append(f"{path}: {count - used} nodes are generated (KORC)")
    else:
        pieces = []
        for start in range(0, count, _CHUNK):
            block = cards.block(layout, min(_CHUNK, count - start), "node card")
            pieces.append(_card_values(block, control, count))
        numbers, xyz, codes, lj, polar = (np.concatenate(some) for some in zip(*pieces, strict=True))
        owner, used = np.arange(count), count
        del pieces

    def line(node: int) -> int:
        return cards.line_of(int(owner[node]) - used)

    if polar.any():
        angle = np.radians(xyz[polar, 1])
        xyz[polar, :2] = xyz[polar, :1] * np.column_stack([np.cos(angle), np.sin(angle)])
        model.warnings.append(
            f"{path}:{line(int(np.argmax(polar)))}: {int(polar.sum())} nodes in polar coordinates, turned into "
            "Cartesian ones"
        )
    numbering = Numbering.of(numbers)
    twice = np.flatnonzero(np.diff(numbering.sorted) == 0)
    for node in numbering.order[twice[:5] + 1].tolist():
        cards.faults.add(line(node), 1, "this node stands twice", str(numbers[node]), "another number")
    cards.faults.stop()
    if not control.free_numbering and not (numbers[1:] > numbers[:-1]).all():
        order = numbering.order
        numbers, xyz, codes, lj = numbers[order], xyz[order], codes[order], lj[order]
        numbering = Numbering(numbers, np.arange(count))
    model.node_ids, model.xyz = numbers, xyz
    model.fixed = codes == 1
    if lj.any():
        model.node_data["LJ"] = lj
    slaves = codes == _SLAVE
    slaves[:, np.array(control.suppressed) == 1] = False
    if slaves.any():
        _relations(cards, model, control, numbering, slaves)
    return numbering


def _card_values(block: Block, control: FemControl, count: int) -> tuple[Ints, Floats, Any, Ints, NDArray[np.bool_]]:
    """Numbers, coordinates, codes (n, 6), LJ and marks of polar coordinates of node cards, checked."""
    numbers = block["N"]
    top = count if not control.free_numbering else _LARGEST
    block.check("N", (numbers > 0) & (numbers <= top), "node number out of range",
                f"1 to {count}" if top == count else "a positive number")  # fmt: skip
    codes = np.empty((len(numbers), 6), np.int8)
    for k, name in enumerate(layouts.DOFS):
        own = block[name]
        block.check(name, (own >= -1) & (own <= 1), "no such code", "0 free, 1 held or -1 dependent")
        codes[:, k] = own
    block.stop()
    mark = "CH" if control.free_numbering or control.wide else "CH_0"
    letters = block.letters(block.layout.fields[mark].start)
    polar = (letters == ord("p")) | (letters == ord("P"))  # r, angle in degrees, z
    return numbers, np.column_stack([block[axis] for axis in "xyz"]), codes, block["LJ"], polar


def _between(series: Series, xyz: Floats, polar: NDArray[np.bool_]) -> tuple[Floats, NDArray[np.bool_]]:
    """Coordinates of all nodes: generated ones divide the line between the cards of their run.

    A run is polar where the card that ends it is.
    """
    ends = series.last
    share = (series.place / np.maximum(np.bincount(series.card)[series.card], 1))[:, None]
    half, other = xyz[series.card] / 2, xyz[ends] / 2  # the whole difference may be past the largest double
    points = 2 * (half + share * (other - half))
    in_run = series.step != 0
    return points, np.where(in_run, polar[ends], polar[series.card])


def _relations(
    cards: Cards, model: Model, control: FemControl, numbering: Numbering, slaves: NDArray[np.bool_]
) -> None:
    """Card 10-4: a dependent degree of freedom is a sum of coefficients times others."""
    head = cards.card(layouts.RELATIONS, "card 10-4 (some degree of freedom is dependent: -1)")
    head.check("MMP", head["MMP"] > 0, "no coefficients", "the number of sets of coefficients")
    head.check("NEZAV", 0 <= head["NEZAV"] <= _MOST_TERMS, "too many terms", f"1 to {_MOST_TERMS}")
    cards.faults.stop()
    sets, terms = head["MMP"], head["NEZAV"] or 1
    block = cards.block(layouts.COEFFICIENTS, sets, "a set of coefficients")
    block.check("IRB", (block["IRB"] >= 1) & (block["IRB"] <= sets), "no such set", f"1 to {sets}")
    cards.faults.stop()
    coefficients = np.zeros((sets, terms))
    coefficients[block["IRB"] - 1] = np.column_stack([block[f"c{k}"] for k in range(1, terms + 1)])
    count = int(slaves.sum())
    relations = cards.block(layouts.relation(control.wide), count, "the card of a dependent degree of freedom")
    which = relations["IRB"]
    relations.check("IRB", (which >= 1) & (which <= sets), "no such set", f"1 to {sets}")
    nodes = [numbering.checked(relations, f"node_{k}", absent=k > 1) for k in range(terms + 1)]
    dofs = [relations[f"dof_{k}"] for k in range(terms + 1)]
    for k in range(terms + 1):
        relations.check(f"dof_{k}", (nodes[k] < 0) | ((dofs[k] >= 1) & (dofs[k] <= 6)), "no such direction", "1 to 6")
    cards.faults.stop()
    marked = slaves[nodes[0], dofs[0] - 1]
    relations.check("dof_0", marked, "this degree of freedom is not marked as dependent", "one with code -1 on card 10")
    cards.faults.stop()
    for i in range(count):
        row = coefficients[which[i] - 1]
        used = [k for k in range(1, terms + 1) if nodes[k][i] >= 0 and row[k - 1] != 0]
        model.equations.append(
            Equation(
                np.array([nodes[k][i] for k in (0, *used)]),
                np.array([dofs[k][i] for k in (0, *used)]),
                np.array([1.0, *(-row[k - 1] for k in used)]),
                i + 1,
                Source(cards.faults.path, relations.line(i)),
            )
        )


def read_initial(cards: Cards, model: Model, control: FemControl, numbering: Numbering, size: int) -> None:
    """Card 10-1: displacements, velocities and accelerations at the start; a dynamic analysis alone has it."""
    if not control.dynamic or control.eigenvalues:
        return
    head = cards.card(layouts.INITIAL, "card 10-1 (initial values of a dynamic analysis)")
    for name in ("IPUU", "IPUV", "IPUA"):
        head.check(name, head[name] >= 0, f"{name} is negative", "how many cards follow")
    cards.faults.stop()
    control.initial_prints = (head["ISUU"], head["ISUV"], head["ISUA"])
    for name, kind in (("IPUU", "displacement"), ("IPUV", "velocity"), ("IPUA", "acceleration")):
        if not head[name]:
            continue
        what = f"an initial {kind}"
        series = read_series(cards, [layouts.INITIAL_VALUES], head[name], what, key=(0, "N"), size=size)
        block = series.blocks[0]
        numbering.checked(block, "N")
        cards.faults.stop()
        values = np.column_stack([block[f"v{k}"] for k in range(1, 7)])
        if series.generated:
            values, _ = _between(series, values, np.zeros(len(values), bool))
        nodes = numbering.indices(series.numbers(block["N"]))
        if (nodes < 0).any():
            block.fault(int(series.card[np.argmax(nodes < 0)]), "KORC", "a node that this card makes is not there")
        cards.faults.stop()
        source = Source(cards.faults.path, block.line(0))
        if kind == "velocity":
            rotation = values[:, 3:] if values[:, 3:].any() else None
            model.initial_velocities.append(InitialVelocity(nodes, values[:, :3], rotation, source=source))
        else:
            dofs = np.tile(np.arange(1, 7), len(nodes))
            model.nodal_loads.append(
                NodalLoad(kind, np.repeat(nodes, 6), dofs, values.ravel(), native={"initial": True}, source=source)
            )
