"""*DEFINE_TRANSFORMATION: rows that scale, turn, mirror and move the nodes of an included file, from top to bottom."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zrno.translators.lsdyna.cards import Card
from zrno.translators.lsdyna.deck import Deck
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block
from zrno.translators.model import Floats

PLACING = Registry()
Matrix = NDArray[np.float64]
_ROWS = ("SCALE", "ROTATE", "TRANSL", "MIRROR", "POINT")


@PLACING("DEFINE_TRANSFORMATION")
def _transformation(deck: Deck, block: Block, options: list[str]) -> bool:
    title = take(options, "TITLE")
    if options:
        return False
    rows = block.rows()[int(title) :].tolist()
    if not rows:
        return True
    number = Card(deck, block, rows[0], "tranid/i").id("tranid", "define")
    found = []
    for row in rows[1:]:
        card = Card(deck, block, row, "option/a a*7")
        option = card["option"].upper()
        if not option and card.blank():
            continue
        if option not in _ROWS:
            card.fault("option", "this row of a transformation is not read", "one of " + ", ".join(_ROWS))
            continue
        found.append((option, [float(a) for a in card.values("a")], block, row))
    deck.transformations[number] = found
    return True


def place_nodes(deck: Deck) -> None:
    """Apply the transformations of included files to their nodes, those of the innermost include first."""
    said: set[int] = set()
    for run in deck.nodes:
        for number in run.transformations:
            rows = deck.transformations.get(number)
            if rows is None:
                if number not in said:
                    message = "a file is placed by a transformation that is not there"
                    expected = "a *DEFINE_TRANSFORMATION of this number"
                    deck.fault(run.block.file, run.block.line, 0, message, str(number), expected)
                said.add(number)
                continue
            matrix = _matrix(deck, number, rows, said)
            with np.errstate(all="ignore"):
                run.xyz = run.xyz @ matrix[:3, :3].T + matrix[:3, 3]


def _matrix(deck: Deck, number: int, rows: list[tuple[str, list[float], Block, int]], said: set[int]) -> Matrix:
    whole = np.eye(4)
    points: dict[int, Floats] = {}
    steps = []
    for option, a, block, row in rows:
        if option == "POINT":
            points[int(a[0])] = np.array(a[1:4])
            continue
        try:
            step = _step(option, a, points)
        except (ValueError, OverflowError) as error:
            deck.fault(block.file, row, 0, str(error), option)
            continue
        steps.append(step)
        whole = step @ whole
    with np.errstate(all="ignore"):
        commute = all(np.allclose(p @ q, q @ p, rtol=1e-12, atol=0) for i, p in enumerate(steps) for q in steps[:i])
    if rows and number not in said and not commute:
        deck.warn(rows[0][2], f"transformation {number}: its rows are applied from top to bottom; their order matters")
    said.add(number)
    return whole


def _step(option: str, a: list[float], points: dict[int, Floats]) -> Matrix:
    step = np.eye(4)
    if option == "SCALE":  # blank: as it is
        step[[0, 1, 2], [0, 1, 2]] = [factor or 1.0 for factor in a[:3]]
    elif option == "TRANSL":
        step[:3, 3] = a[:3]
    elif option == "MIRROR":
        normal = np.array(a[3:6]) - a[:3]
        length = np.linalg.norm(normal)
        if not length > 0:
            raise ValueError("the mirror's normal has no length")
        normal = normal / length
        step[:3, :3] -= 2 * np.outer(normal, normal)
        step[:3, 3] = 2 * normal * (normal @ a[:3])
    else:
        step = _rotation(a, points)
    return step


def _rotation(a: list[float], points: dict[int, Floats]) -> Matrix:
    """About an axis and a point by an angle in degrees, or about two POINTs (a1 a2) by a3."""
    axis, origin, angle = np.array(a[:3]), np.array(a[3:6]), a[6]
    if not any(a[3:]):
        first, second = points.get(int(a[0])), points.get(int(a[1]))
        if first is None or second is None or a[0] != int(a[0]) or a[1] != int(a[1]):
            raise ValueError("the rotation has no angle, and its points are not there")
        axis, origin, angle = second - first, first, a[2]
    length = np.linalg.norm(axis)
    if not length > 0:
        raise ValueError("the axis of the rotation has no length")
    x, y, z = axis / length
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, cosine = _exact(np.sin, angle), _exact(np.cos, angle)
    step = np.eye(4)
    step[:3, :3] = np.eye(3) + sine * cross + (1 - cosine) * cross @ cross
    step[:3, 3] = origin - step[:3, :3] @ origin
    return step


def _exact(function: np.ufunc, degrees: float) -> float:
    """Sine or cosine; of right angles exactly."""
    value = float(function(np.deg2rad(degrees % 360.0)))
    return float(round(value)) if degrees % 90.0 == 0 else value
