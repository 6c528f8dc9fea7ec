"""Sleepers and the facets that they lean on (`rest`): how fast those are, and the force that a sleeper exerts.

It is what it was in the mean before it fell asleep, until it wakes: a structure that swings a little under a sleeper
feels its weight, and not the stiffness of what is held. The mean is one over time, of a few passages of a wave: contact
that still trembles would leave the force of a moment.
"""

from __future__ import annotations

from ..jit import kernel


@kernel
def pace(i, faces, touched):
    """Speed of the fastest node of the facets listed with a particle, or of those that it touches."""
    fastest = 0.0
    for pair in range(faces.first[i], faces.first[i] + faces.count[i]):
        speed = faces.pace[faces.rows[pair]]
        if speed > fastest:
            near = not touched
            for c in range(faces.thrust.shape[1]):
                near = near or faces.thrust[pair, c] != 0.0
            if near:
                fastest = speed
    return fastest


@kernel
def remember(i, part, faces, bears):
    """Takes the mean force of the facets on a particle a part of the way to that of now."""
    d = len(bears)
    for k in range(d):
        force = 0.0
        for pair in range(faces.first[i], faces.first[i] + faces.count[i]):
            for q in range(d):
                force -= faces.thrust[pair, d * q + k]
        bears[k, i] += part * (force - bears[k, i])


@kernel
def lean(i, pair, weights, f0, f1, f2, faces, bears):
    """Makes what the facets feel of a sleeper, f now, what it bears, by way of one pair. weights: of its nodes."""
    d = len(bears)
    for k in range(d):
        force = f0 if k == 0 else f1 if k == 1 else f2
        missing = bears[k, i] - force
        for q in range(d):
            faces.thrust[pair, d * q + k] -= weights[q] * missing
