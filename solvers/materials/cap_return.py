"""The cap model's hardening and its return to the surfaces; `cap` tells the model and its names.

An implicit step (backward Euler) in I and J, by one unknown in each region ([T] 4.6.3.22-44), each found by Newton
inside a bracket, so that any increment has an answer:
- beyond T: the cut-off; the envelope first where I = T keeps shear
- I(trial) <= L: on the envelope; the unknown is I, of I - I(trial) = 9 K/G (J(trial) - Fe(I)) Fe'(I). Where dilation
  would move the cap's corner past I, the stress stays with the corner
- I(trial) > L and R > 0: on the ellipse; the unknown is L, which grows by the compaction. [T] sends the points above
  the envelope to the corner; but the ellipse's normal there has no compaction, so that its flow ends on the ellipse,
  and for small steps only this agrees with the rate equations
- the corner I = L, of flat caps and of retracting ones: L - I(trial) + 3 K (epv(L) - epv(old)) = 0, J = Fe(L)
A tangent can be had from the same residuals.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..jit import kernel
from .law import dispatched, law_body

ITERATIONS = 100  # bisection alone needs fewer
CLOSE = 1e-8  # relative: Newton's error after a step of that size is of the order of its square


class CapHardening(NamedTuple):
    """epv = W (1 - exp(-D (X - X0))) (4.6.3.4); limit: W [-], decay: D [1/pressure], first: X0 [pressure]."""

    limit: float
    decay: float
    first: float


class CapHardeningGeneral(NamedTuple):
    """epv = W (1 - exp(-D x) - a D x exp(-D1 x - D2 x^2)) + W1 x^2 exp(-D3 x), x = X - X0 (4.6.3.14).

    The printed sign of the term in a is not legible; this one makes the first compaction stiffer.
    """

    limit: float
    decay: float
    first: float
    a: float
    d1: float
    d2: float
    w1: float
    d3: float


@dispatched
def compaction(hardening, edge):
    """epv and d epv/dX of the cap's end X = edge."""
    raise NotImplementedError("no hardening of that class")


@law_body(compaction, CapHardening)
def _simple(hardening, edge):
    left = hardening.limit * math.exp(-hardening.decay * (edge - hardening.first))
    return hardening.limit - left, hardening.decay * left


@law_body(compaction, CapHardeningGeneral)
def _general(hardening, edge):
    x = edge - hardening.first
    left = math.exp(-hardening.decay * x)
    bend = hardening.a * hardening.decay * math.exp(-x * (hardening.d1 + hardening.d2 * x))
    tail = hardening.w1 * math.exp(-hardening.d3 * x)
    slope = hardening.decay * left - bend * (1.0 - x * (hardening.d1 + 2.0 * hardening.d2 * x))
    return (
        hardening.limit * (1.0 - left - bend * x) + tail * x * x,
        hardening.limit * slope + tail * x * (2.0 - hardening.d3 * x),
    )


@kernel
def envelope(law, first):
    """Fe and its slope at I."""
    fall = law.gamma * math.exp(-law.decay * first)
    return law.k - fall + law.theta * first, law.decay * fall + law.theta


@kernel
def inside(law, first, root, centre):
    """Whether (I, J) is elastic with the cap's centre at L."""
    if not first >= law.tension:
        return False
    strength, _ = envelope(law, min(first, centre))
    if first <= centre:
        return root <= strength
    return (first - centre) ** 2 + (law.ratio * root) ** 2 <= (law.ratio * strength) ** 2


@kernel
def cap_return(law, shear, first, root, centre):
    """I, J, L of the new stress; (first, root) is the trial, not `inside`."""
    bulk = law.lame + 2.0 / 3.0 * law.shear
    if first < law.tension and not law.keeps_shear:
        return law.tension, 0.0, centre
    if first <= centre:
        new, centre = _on_envelope(law, bulk, shear, first, root, centre)
        strength, _ = envelope(law, new)
        left = min(root, strength)
    elif law.ratio > 0.0:
        new, left, centre = _on_ellipse(law, bulk, shear, first, root, centre)
    else:
        epv, _ = _compacted(law, centre)
        centre = _centre(law, 1.0, 3.0 * bulk, first + 3.0 * bulk * epv, centre, centre, first)
        new = centre
        strength, _ = envelope(law, new)
        left = min(root, strength)
    return new, left, centre


@kernel
def _compacted(law, centre):
    """epv and d epv/dL."""
    strength, slope = envelope(law, centre)
    epv, rise = compaction(law.hardening, centre + law.ratio * strength)
    return epv, rise * (1.0 + law.ratio * slope)


@kernel
def _centre(law, share, stiffness, target, guess, low, high):
    """L between low and high where share L + stiffness epv(L) = target."""
    x = guess
    least = 1e-16 * (abs(low) + abs(high))
    for _ in range(ITERATIONS):
        epv, slope = _compacted(law, x)
        value = share * x + stiffness * epv - target
        if value > 0.0:
            high = x
        else:
            low = x
        new = x - value / (share + stiffness * slope)
        newton = low <= new <= high
        if not newton:
            new = 0.5 * (low + high)
        change = abs(new - x)
        x = new
        if change <= least or (newton and change <= CLOSE * abs(x)):
            break
    return x


@kernel
def _on_envelope(law, bulk, shear, first, root, centre):
    """I and L of a return from I(trial) <= L."""
    old, _ = _compacted(law, centre)
    scale = 9.0 * bulk / shear
    strength, slope = envelope(law, centre)
    corner = centre - first - scale * (root - strength) * slope < 0.0
    x = max(first, law.tension)
    dilated = 0.0
    cut = False
    if first < law.tension:
        strength, slope = envelope(law, law.tension)
        dilated = scale * max(0.0, root - strength) * slope
        cut = law.tension - first > dilated
    if cut:
        corner = False
    elif not corner:
        low, high = x, centre
        for _ in range(ITERATIONS):
            strength, slope = envelope(law, x)
            value = x - first - scale * (root - strength) * slope
            if value > 0.0:
                high = x
            else:
                low = x
            curvature = -law.decay * (slope - law.theta)
            new = x - value / (1.0 + scale * (slope * slope - (root - strength) * curvature))
            newton = low <= new <= high
            if not newton:
                new = 0.5 * (low + high)
            change = abs(new - x)
            x = new
            if change <= 1e-16 * (abs(first) + abs(centre)) or (newton and change <= CLOSE * abs(x)):
                break
        dilated = x - first
    if not law.soil:
        return (centre if corner else x), centre
    if centre == 0.0:
        return (0.0 if corner else x), 0.0
    if not corner:
        target = old - dilated / (3.0 * bulk)
        least = max(x, 0.0)
        there, _ = _compacted(law, least)
        if there <= target:
            return x, _centre(law, 0.0, 1.0, target, centre, least, centre)
        if x <= 0.0:
            return x, 0.0
    # the corner holds the stress: L and I are one
    least = max(first, 0.0)
    there, _ = _compacted(law, least)
    target = first + 3.0 * bulk * old
    if least + 3.0 * bulk * there >= target:
        return least, least
    x = _centre(law, 1.0, 3.0 * bulk, target, centre, least, centre)
    return x, x


@kernel
def _on_ellipse(law, bulk, shear, first, root, centre):
    """I, J and L of a return from I(trial) > L to the elliptic cap."""
    old, _ = _compacted(law, centre)
    ratio = law.ratio
    square = ratio * ratio
    low, high = centre, first
    x = centre
    d = first - centre
    left = root
    size = 0.0
    for _ in range(ITERATIONS):
        strength, slope = envelope(law, x)
        size = ratio * strength
        epv, rise = compaction(law.hardening, x + size)
        rise *= 1.0 + ratio * slope
        flow = max(0.0, epv - old)
        d = first - 3.0 * bulk * flow - x
        if d > 0.0:
            multiplier = flow / (6.0 * d)
            shrink = 1.0 + 2.0 * shear * square * multiplier
            left = root / shrink
            radius = math.sqrt(d * d + square * left * left)
            value = radius - size
            fall = -3.0 * bulk * rise - 1.0
            growth = (rise * d - flow * fall) / (6.0 * d * d)
            new = x - value / (
                (d * fall - square * left * left * 2.0 * shear * square * growth / shrink) / radius - ratio * slope
            )
            if abs(value) <= 1e-12 * radius:
                break
        else:
            value = -1.0
            new = high
        if value > 0.0:
            low = x
        else:
            high = x
        if not low < new < high:
            new = 0.5 * (low + high)
        if new <= low or new >= high:
            break
        x = new
    # the last digits: onto the ellipse along the radius
    d = max(d, 0.0)
    radius = math.sqrt(d * d + square * left * left)
    scale = size / radius if radius > 0.0 else 0.0
    return x + d * scale, left * scale, x


@kernel
def cap_slopes(law, shear, first, root, centre):
    """J of the new stress, and dI/dI*, dI/dJ*, dJ/dI*, dJ/dJ*; arguments as of `cap_return`."""
    if first < law.tension and not law.keeps_shear:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    bulk = law.lame + 2.0 / 3.0 * law.shear
    new, left, after = cap_return(law, shear, first, root, centre)
    if first > centre and law.ratio > 0.0:
        return _ellipse_slopes(law, bulk, shear, first, root, left, centre, after)
    strength, slope = envelope(law, new)
    by_first, by_root = 0.0, 0.0
    if new == after and (first > centre or after < centre):  # the corner: flat caps, and caps that give way
        if new > max(first, 0.0) or first > centre:
            by_first = 1.0 / (1.0 + 3.0 * bulk * _compacted(law, new)[1])
        elif first >= 0.0:
            by_first = 1.0
    elif new < centre and not (new == law.tension and first < new):
        scale = 9.0 * bulk / shear
        curvature = -law.decay * (slope - law.theta)
        by_first = 1.0 / (1.0 + scale * (slope * slope - (root - strength) * curvature))
        by_root = scale * slope * by_first
    if left == root:
        return left, by_first, by_root, 0.0, 1.0
    return left, by_first, by_root, slope * by_first, slope * by_root


@kernel
def _ellipse_slopes(law, bulk, shear, first, root, left, centre, after):
    _, slope = envelope(law, after)
    epv, rise = _compacted(law, after)
    flow = max(0.0, epv - _compacted(law, centre)[0])
    square = law.ratio * law.ratio
    d = first - 3.0 * bulk * flow - after
    fall = -3.0 * bulk * rise - 1.0
    if not d > 0.0:
        return left, 0.0, 0.0, 0.0, 0.0
    push = 2.0 * shear * square
    shrink = 1.0 + push * flow / (6.0 * d)
    growth = (rise * d - flow * fall) / (6.0 * d * d)
    j_after, j_first = -left / shrink * push * growth, left / shrink * push * flow / (6.0 * d * d)
    radius = math.sqrt(d * d + square * left * left)
    by_after = (d * fall + square * left * j_after) / radius - law.ratio * slope
    by_first = (d + square * left * j_first) / radius
    by_root = square * left / (shrink * radius)
    l_first, l_root = -by_first / by_after, -by_root / by_after
    return (
        left,
        1.0 - 3.0 * bulk * rise * l_first,
        -3.0 * bulk * rise * l_root,
        j_first + j_after * l_first,
        1.0 / shrink + j_after * l_root,
    )
