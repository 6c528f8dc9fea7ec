"""Eight-node shells computed as nine-node ones: each gets a node at its centre, which the run keeps to itself."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from .elements.shapes import functions
from .problem import Elements, Problem


def with_centres(problem: Problem) -> Problem:
    """The problem with a ninth node in each eight-node shell, behind all others; the problem itself without such.

    The node lies on the surface that the eight span; it is held along what all eight are held along, and starts as they
    do on average.
    """
    if not any(_lacks(e) for e in problem.elements):
        return problem
    n = len(problem.x)
    share = functions("quad8", np.zeros((1, 2)))[0][0]
    elements: list[Elements] = []
    places: list[NDArray[np.float64]] = []
    owners = []
    for e in problem.elements:
        if not _lacks(e):
            elements.append(e)
            continue
        first = n + sum(map(len, places))
        centres = first + np.arange(len(e.nodes))
        places.append(np.einsum("k,ekc->ec", share, problem.x[e.nodes]))
        owners.append(e.nodes)
        thickness = e.thickness
        if thickness is not None and thickness.ndim == 2:
            thickness = np.column_stack([thickness, thickness @ share])
        elements.append(
            dataclasses.replace(e, kind="quad9", nodes=np.column_stack([e.nodes, centres]), thickness=thickness)
        )
    nodes = np.concatenate(owners)
    last = int(problem.node_ids.max())
    return dataclasses.replace(
        problem,
        x=np.concatenate([problem.x, *places]),
        node_ids=np.concatenate([problem.node_ids, last + 1 + np.arange(len(nodes))]),
        elements=tuple(elements),
        fixed=np.concatenate([problem.fixed, problem.fixed[nodes].all(axis=1)]),
        displacement=None if problem.displacement is None else _extended(problem.displacement, nodes, share),
        velocity=None if problem.velocity is None else _extended(problem.velocity, nodes, share),
    )


def _lacks(elements: Elements) -> bool:
    return elements.family == "shell" and elements.kind == "quad8"


def _extended(values: NDArray[np.float64], nodes: NDArray[np.int64], share: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.concatenate([values, np.einsum("k,ekc->ec", share, values[nodes])])
