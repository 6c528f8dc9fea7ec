"""A ball and a facet: the nearest point, the push, and which facets a point may touch."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from zrno.solvers.contact.facet_search import candidates
from zrno.solvers.contact.facets import facet_push, nearest_on_segment, nearest_on_triangle, normal_of_triangle
from zrno.solvers.contact.plane import wall_push

Corner = st.tuples(*[st.floats(-1.0, 1.0)] * 3)


@settings(max_examples=300, deadline=None)
@given(st.tuples(Corner, Corner, Corner), Corner)
def test_no_point_of_a_triangle_is_nearer(corners, point):
    a, b, c = (np.array(corner) for corner in corners)
    if np.linalg.norm(np.cross(b - a, c - a)) < 1e-3:
        return
    p = np.array(point)
    *weights, inside = nearest_on_triangle(*p, *a, *b, *c)
    w = np.array(weights)
    assert w.min() >= -1e-12
    assert w.sum() == pytest.approx(1.0, abs=1e-12)
    assert inside == bool(w.min() > 0.0)
    found = np.linalg.norm(p - w @ np.array([a, b, c]))
    r, s = np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 1, 41))
    r, s = r[r + s <= 1], s[r + s <= 1]
    every = a + r[:, None] * (b - a) + s[:, None] * (c - a)
    assert found <= np.linalg.norm(p - every, axis=1).min() + 1e-12


def test_the_ends_of_a_segment_and_what_lies_between():
    assert nearest_on_segment(0.25, 3.0, 0.0, 0.0, 1.0, 0.0) == (0.75, 0.25, True)
    assert nearest_on_segment(-1.0, 3.0, 0.0, 0.0, 1.0, 0.0) == (1.0, 0.0, False)
    assert nearest_on_segment(2.0, 3.0, 0.0, 0.0, 1.0, 0.0) == (0.0, 1.0, False)


def test_the_normal_is_right_handed():
    assert normal_of_triangle(0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0) == (0.0, 0.0, 1.0)


def test_the_push_begins_as_a_planes_and_lets_nothing_pass():
    radius, most, k = 1.0, 1.5, 4.0
    force, stiffness = facet_push(1e-4, radius, most, k)
    plane = wall_push(1e-4, radius, k)
    assert (force, stiffness) == (pytest.approx(plane[0], rel=1e-7), pytest.approx(plane[1], rel=1e-3))
    assert facet_push(0.0, radius, most, k) == (0.0, 0.0)
    assert facet_push(1.49, radius, most, k)[0] > 50.0 * wall_push(1.49, radius, k)[0]
    assert facet_push(7.0, radius, most, k)[0] == facet_push(1.4999, radius, most, k)[0] or np.isfinite(
        facet_push(7.0, radius, most, k)[0]
    )
    for p in (0.1, 0.7, 1.3):  # the stiffness is the slope
        slope = (facet_push(p + 1e-6, radius, most, k)[0] - facet_push(p - 1e-6, radius, most, k)[0]) / 2e-6
        assert facet_push(p, radius, most, k)[1] == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("corners", [2, 3])
def test_the_search_finds_all_that_are_near(corners):
    rng = np.random.default_rng(corners)
    nodes = rng.uniform(-1.0, 1.0, (3, 60))
    nodes[:, :4] *= 20.0  # some facets are much larger than others
    facets = np.sort(rng.permuted(np.tile(np.arange(60), (80, 1)), axis=1)[:, :corners], axis=1)
    x = rng.uniform(-1.5, 1.5, (3, 200))
    if corners == 2:
        nodes[2] = x[2] = 0.0
    reach = rng.uniform(0.05, 0.2, len(facets))
    first, count, rows = candidates(x[0], x[1], None if corners == 2 else x[2], 200, nodes, facets, reach)
    low, high = nodes[:, facets].min(axis=2) - reach, nodes[:, facets].max(axis=2) + reach
    for i in range(200):
        wanted = np.flatnonzero(((low <= x[:, [i]]) & (x[:, [i]] <= high)).all(axis=0))
        assert rows[first[i] : first[i] + count[i]].tolist() == wanted.tolist()
