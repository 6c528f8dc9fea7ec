"""Shape functions and quadrature: what any isoparametric element rests on."""

from __future__ import annotations

from math import factorial

import numpy as np
import pytest

from zrno.solvers.fem.elements import shapes

VOLUME = {"line": 2.0, "tri": 0.5, "quad": 4.0, "tet": 1 / 6, "pyramid": 4 / 3, "wedge": 1.0, "hex": 8.0}
KINDS = list(shapes.NODES)


def _volume(kind: str) -> float:
    return VOLUME[kind.rstrip("0123456789")]


@pytest.mark.parametrize("kind", KINDS)
def test_functions_are_one_at_their_node_and_sum_to_one(kind: str) -> None:
    values, slopes = shapes.functions(kind, np.array(shapes.NODES[kind], dtype=float))
    np.testing.assert_allclose(values, np.eye(len(values)), atol=1e-14)
    inside = shapes.table(kind).points
    values, slopes = shapes.functions(kind, inside)
    np.testing.assert_allclose(values.sum(axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(slopes.sum(axis=1), 0.0, atol=1e-13)


@pytest.mark.parametrize("kind", KINDS)
def test_slopes_are_derivatives(kind: str) -> None:
    at = np.random.default_rng(3).uniform(0.1, 0.25, (4, shapes.dimension(kind)))
    _, slopes = shapes.functions(kind, at)
    for d in range(at.shape[1]):
        step = np.zeros_like(at)
        step[:, d] = 1e-6
        difference = (shapes.functions(kind, at + step)[0] - shapes.functions(kind, at - step)[0]) / 2e-6
        np.testing.assert_allclose(slopes[:, :, d], difference, atol=1e-8)


@pytest.mark.parametrize("full", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_weights_sum_to_the_volume(kind: str, full: bool) -> None:
    assert shapes.table(kind, full=full).weights.sum() == pytest.approx(_volume(kind), rel=1e-14)


@pytest.mark.parametrize(("kind", "degree"), [("tri3", 2), ("tri6", 4), ("tet4", 3), ("tet10", 5)])
def test_simplex_rules_are_of_their_degree(kind: str, degree: int) -> None:
    points, weights = shapes.rule(kind, full=True)
    d = points.shape[1]
    for powers in np.ndindex(*(degree + 1,) * d):
        if sum(powers) <= degree:
            exact = np.prod([factorial(p) for p in powers]) / factorial(sum(powers) + d)
            found = weights @ np.prod(points ** np.array(powers), axis=1)
            assert found == pytest.approx(exact, rel=1e-12), powers


@pytest.mark.parametrize("kind", [k for k in KINDS if shapes.table(k).count > shapes.dimension(k)])
def test_extrapolation_gives_linear_fields_back(kind: str) -> None:
    t = shapes.table(kind)
    slope = np.arange(1.0, 1 + shapes.dimension(kind))
    np.testing.assert_allclose(shapes.extrapolation(kind) @ (t.points @ slope), t.nodes @ slope, atol=1e-12)


def test_points_by_direction_run_along_the_first_first() -> None:
    points, _ = shapes.rule("hex8", (3, 2, 1))
    assert len(points) == 6
    assert points[0, 0] < points[1, 0] < points[2, 0]
    assert points[0, 1] == points[2, 1]
